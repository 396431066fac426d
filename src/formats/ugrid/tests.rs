//! The reader against files of meshio and others, against hand-made files of every variant, and against damage.

use super::{Ugrid, binary::VARIANTS};
use crate::error::Result;
use crate::formats::Format;
use crate::formats::binary::Endian;
use crate::formats::gmsh::Gmsh;
use crate::formats::reading::{Mesh, read};
use crate::formats::testing::{self, Row, check, corpus, damage, detected, own};
use crate::mesh::Shape::{self, Hexahedron, Pyramid, Quadrilateral, Tetrahedron, Triangle, Wedge};

const MIXED: &[(Shape, usize)] = &[(Triangle, 28), (Quadrilateral, 36), (Wedge, 28), (Hexahedron, 8)];

/// Written by meshio from our own mesh of Gmsh.
const OWN: &[Row] = &[("mixed.lb8.ugrid", 54, MIXED, &[]), ("mixed.ugrid", 54, MIXED, &[])];

const CORPUS: &[Row] = &[
    ("meshio_mixed.lb8.ugrid", 54, MIXED, &[]),
    ("meshio_mixed.ugrid", 54, MIXED, &[]),
    ("pynastran_box.b8.ugrid", 8000, &[(Quadrilateral, 2166), (Hexahedron, 6859)], &[]),
];

#[test]
fn own_files_are_the_mixed_mesh_of_gmsh() {
    let expected = read(&Gmsh, &own("gmsh").join("mixed_hex_prism_41.msh")).expect("readable");
    for row in OWN {
        let mesh = check(&Ugrid, &own("ugrid"), row);
        testing::same_elements(&mesh, &expected, 0.0);
        assert_eq!(mesh.elements.iter().map(|e| e.0).max(), Some(100));
    }
}

#[test]
fn corpus_files_hold_what_others_count() {
    let Some(corpus) = corpus() else { return };
    CORPUS.iter().for_each(|row| drop(check(&Ugrid, &corpus.join("ugrid"), row)));
}

#[test]
fn only_ugrid_files_of_the_corpus_are_detected() {
    let Some(corpus) = corpus() else { return };
    let expected: Vec<_> = CORPUS.iter().map(|row| format!("ugrid/{}", row.0)).collect();
    assert_eq!(detected(&Ugrid, &corpus), expected);
}

#[test]
fn a_cut_file_is_an_error_and_a_flipped_bit_no_panic() {
    // That digits of the last number of a text are missing cannot be seen.
    let whole = |bytes: &[u8]| bytes.len() - 4;
    OWN.iter().for_each(|row| damage(&Ugrid, &own("ugrid").join(row.0), whole));
    let Some(corpus) = corpus() else { return };
    damage(&Ugrid, &corpus.join("ugrid").join(CORPUS[2].0), whole);
}

/// A cube with a pyramid, a wedge and a tetrahedron on it, two of its faces, and a face of the wedge.
const COUNTS: [u64; 7] = [11, 1, 2, 1, 1, 1, 1];
const POINTS: [[f64; 3]; 11] = [
    [0., 0., 0.],
    [1., 0., 0.],
    [1., 1., 0.],
    [0., 1., 0.],
    [0., 0., 1.],
    [1., 0., 1.],
    [1., 1., 1.],
    [0., 1., 1.],
    [0.5, 0.5, 2.],
    [2., 0., 0.],
    [2., 1., 0.],
];
/// Triangle, quadrilaterals, their surface numbers, tetrahedron, pyramid (its apex third), wedge, hexahedron.
const BODY: &[&[u64]] = &[
    &[2, 10, 6],
    &[1, 4, 3, 2],
    &[1, 2, 6, 5],
    &[1, 2, 3],
    &[6, 7, 8, 9],
    &[5, 8, 9, 6, 7],
    &[2, 10, 6, 3, 11, 7],
    &[1, 2, 3, 4, 5, 6, 7, 8],
];

fn text() -> String {
    let join = |numbers: &[String]| numbers.join(" ") + "\n";
    let mut text = join(&COUNTS.map(|n| n.to_string()));
    POINTS.iter().for_each(|p| text += &join(&p.map(|x| format!("{x:?}"))));
    BODY.iter().for_each(|row| text += &join(&row.iter().map(u64::to_string).collect::<Vec<_>>()));
    text
}

fn binary(variant: &super::binary::Variant) -> Vec<u8> {
    let words = variant.words;
    let big = words.endian == Endian::Big;
    let put = |bytes: &mut Vec<u8>, value: u64, width: usize| {
        if big {
            bytes.extend(&value.to_be_bytes()[8 - width..])
        } else {
            bytes.extend(&value.to_le_bytes()[..width])
        }
    };
    let (mut head, mut body) = (Vec::new(), Vec::new());
    COUNTS.iter().for_each(|count| put(&mut head, *count, words.word));
    for x in POINTS.iter().flatten() {
        if words.real == 8 {
            put(&mut body, x.to_bits(), 8)
        } else {
            put(&mut body, (*x as f32).to_bits().into(), 4)
        }
    }
    BODY.iter().copied().flatten().for_each(|id| put(&mut body, *id, words.word));
    let mut bytes = Vec::new();
    for part in [head, body] {
        let length = part.len() as u64;
        if variant.records {
            put(&mut bytes, length, 4)
        }
        bytes.extend(part);
        if variant.records {
            put(&mut bytes, length, 4)
        }
    }
    bytes
}

fn is_the_mesh(mesh: &Mesh, name: &str) {
    let found: Vec<_> = mesh.elements.iter().map(|e| (e.0, e.1)).collect();
    let expected = [
        (1, Triangle),
        (2, Quadrilateral),
        (3, Quadrilateral),
        (4, Tetrahedron),
        (5, Pyramid),
        (6, Wedge),
        (7, Hexahedron),
    ];
    assert_eq!(found, expected, "{name}");
    // The base goes round as seen from inside, and the apex is the record's third node.
    assert_eq!(mesh.elements[4].2, [8, 5, 6, 7, 9].map(|k: usize| POINTS[k - 1]), "{name}");
}

#[test]
fn every_variant_is_told_by_its_size_whatever_its_name() {
    is_the_mesh(&testing::read_bytes(&Ugrid, "a.ugrid", text().as_bytes()).expect("readable"), "text");
    assert!(Ugrid.detect(text().as_bytes()));
    for variant in &VARIANTS {
        let bytes = binary(variant);
        assert!(Ugrid.detect(&bytes), "{}", variant.suffix);
        for suffix in ["", ".ugrid", ".b8.ugrid", &format!(".{}.ugrid", variant.suffix)] {
            let mesh =
                testing::read_bytes(&Ugrid, &format!("a{suffix}"), &bytes).unwrap_or_else(|e| panic!("{e}"));
            is_the_mesh(&mesh, variant.suffix);
        }
        for cut in 0..bytes.len() {
            assert!(
                testing::read_bytes(&Ugrid, "a.ugrid", &bytes[..cut]).is_err(),
                "{} cut at {cut}",
                variant.suffix
            );
        }
        assert!(testing::read_bytes(&Ugrid, "a.ugrid", &[&bytes[..], b"\0\0\0\0"].concat()).is_err());
    }
}

/// Reads the mesh as b8 with the four bytes at `at` replaced.
fn with(at: usize, value: i32) -> Result<Mesh> {
    let mut bytes = binary(&VARIANTS[0]);
    bytes[at..at + 4].copy_from_slice(&value.to_be_bytes());
    testing::read_bytes(&Ugrid, "a.b8.ugrid", &bytes)
}

#[test]
fn errors_name_the_byte_and_what_stood_there() {
    let ends = |done: Result<Mesh>, expected: &str| {
        let error = done.expect_err("an error").to_string();
        assert!(error.ends_with(expected), "{error}");
    };
    let sizes = "byte 0: expected 472 bytes, as the counts of 11 points and [1, 2, 1, 1, 1, 2] elements say (b8), found 440 bytes";
    ends(with(24, 2), sizes);
    ends(
        with(24, -2),
        "byte 0: expected seven counts of points and elements at the start (b8), found other numbers",
    );
    let ids = 28 + 11 * 24;
    ends(with(ids, 12), "byte 292: element 1 names node 12, which the file does not define");
    ends(with(ids, -3), "byte 292: expected the number of a node, found -3");
    let changed =
        |from: &str, to: &str| testing::message(&Ugrid, "a.ugrid", text().replacen(from, to, 1).as_bytes());
    assert_eq!(
        changed("2 10 6\n", "2 10 6 1\n"),
        "line 20: expected the end of the file after the last element, found \"8\""
    );
    assert!(
        changed("2 10 6\n", "").contains(
            "expected rows of type hexahedron, 1 in all, and not only 0, found the end of the file"
        )
    );
}
