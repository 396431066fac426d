//! The reader against files of Gmsh and others, against hand-made files, and against damage.

use super::Su2;
use crate::error::Result;
use crate::formats::Format;
use crate::formats::gmsh::Gmsh;
use crate::formats::reading::{Mesh, read};
use crate::formats::testing::{self, Row, check, corpus, counted, damage, detected, own};
use crate::mesh::Shape::{self, Hexahedron, Pyramid, Quadrilateral, Tetrahedron, Triangle, Wedge};

const MIXED: &[(Shape, usize)] = &[(Triangle, 28), (Quadrilateral, 36), (Wedge, 28), (Hexahedron, 8)];

const OWN: &[Row] = &[("gmsh_mixed.su2", 54, MIXED, &[])];

const CORPUS: &[Row] = &[
    ("pynastran_fea_fsi.su2", 150, &[(Quadrilateral, 116)], &[("line", 66)]),
    ("pynastran_naca0012_inv.su2", 5233, &[(Triangle, 10216)], &[("line", 250)]),
];

fn read_bytes(text: &str) -> Result<Mesh> {
    testing::read_bytes(&Su2, "a.su2", text.as_bytes())
}

/// The bytes before the last row of the last marker: that some of its digits are missing cannot be seen.
fn before_last_row(bytes: &[u8]) -> usize {
    let text = bytes.trim_ascii_end();
    memchr::memrchr(b'\n', text).expect("lines") - 40
}

#[test]
fn own_files_hold_what_gmsh_counts() {
    let mesh = check(&Su2, &own("su2"), &OWN[0]);
    let mut labels: Vec<_> = mesh.elements.iter().map(|e| e.0).collect();
    labels.sort_unstable();
    assert_eq!(labels, (1..=100).collect::<Vec<_>>());
    let solid = mesh.elements.iter().filter(|e| e.1.dimension() == 3);
    assert_eq!(solid.map(|e| e.0).max(), Some(36), "NELEM comes before the markers");
}

#[test]
fn the_mixed_mesh_is_that_of_gmsh_but_for_its_wedges() {
    let expected = read(&Gmsh, &own("gmsh").join("mixed_hex_prism_41.msh")).expect("readable");
    let mesh = check(&Su2, &own("su2"), &OWN[0]);
    for shape in [Triangle, Quadrilateral, Hexahedron] {
        assert_eq!(testing::corners(&mesh, shape), testing::corners(&expected, shape), "{shape}");
    }
    assert_ne!(testing::corners(&mesh, Wedge), testing::corners(&expected, Wedge));
    assert_eq!(Su2.own_orientation(), [Wedge]);
}

#[test]
fn corpus_files_hold_what_others_count() {
    let Some(corpus) = corpus() else { return };
    CORPUS.iter().chain(OWN).for_each(|row| drop(check(&Su2, &corpus.join("su2"), row)));
}

#[test]
fn only_su2_files_of_the_corpus_are_detected() {
    let Some(corpus) = corpus() else { return };
    let mut expected: Vec<_> = CORPUS.iter().chain(OWN).map(|row| format!("su2/{}", row.0)).collect();
    expected.sort();
    assert_eq!(detected(&Su2, &corpus), expected);
}

#[test]
fn a_cut_file_is_an_error_and_a_flipped_bit_no_panic() {
    // Markers may be left out, but not those that NMARK says; before it the points may end early.
    let marked = |bytes: &[u8]| {
        let points = memchr::memmem::find(bytes, b"NPOIN").expect("points");
        let mark = memchr::memmem::find(bytes, b"NMARK").expect("markers");
        if points < mark { points } else { before_last_row(bytes) }
    };
    damage(&Su2, &own("su2").join(OWN[0].0), marked);
    let Some(corpus) = corpus() else { return };
    CORPUS.iter().for_each(|row| damage(&Su2, &corpus.join("su2").join(row.0), marked));
}

const TETRAHEDRON: &str = "% a comment\nNDIME= 3\n\nNELEM=2 % two\n10 0 1 2 3 0\n\n% between\n 10\t0 2 1 4\n\
                           NPOIN= 5 5\n0 0 0 0\n1 0 0 1\n0 1 0 2\n0 0 1 3\n0. 0. -1.d0\n\
                           NMARK = 2\nMARKER_TAG= wall\nMARKER_ELEMS= 1\n5 0 1 2\nMARKER_TAG= SEND_RECEIVE\nMARKER_ELEMS= 1\nSEND_TO= 2\n1 4 0\n";

#[test]
fn comments_blank_lines_and_missing_numbers_of_elements() {
    for text in [TETRAHEDRON.to_owned(), TETRAHEDRON.replace('\n', "\r\n"), TETRAHEDRON.trim_end().to_owned()]
    {
        let mesh = read_bytes(&text).expect("readable");
        assert_eq!((mesh.nodes.count(), mesh.count(Tetrahedron), mesh.count(Triangle)), (5, 2, 1));
        assert_eq!((mesh.elements[1].0, mesh.elements[1].2[3]), (2, [0., 0., -1.]));
        assert_eq!((counted(&mesh, "point"), mesh.elements[2].0), (1, 3));
        assert!(Su2.detect(text.as_bytes()));
    }
}

#[test]
fn keywords_that_are_not_read_may_have_rows() {
    let text = format!("{TETRAHEDRON}FFD_NBOX= 1\nFFD_TAG= box\nFFD_CORNER_POINTS= 2\n1 2 3\n4 5 6\n");
    assert!(read_bytes(&text).is_ok());
    let error = read_bytes(&format!("{TETRAHEDRON}1 2 3\n")).expect_err("rows of nothing");
    assert!(
        error.to_string().ends_with("line 23: expected a line KEYWORD= value, found \"1 2 3\""),
        "{error}"
    );
}

#[test]
fn points_of_two_dimensions_may_have_three_coordinates() {
    let text = "NDIME= 2\nNPOIN= 3\n0 0 7.5 0\n1 0 7.5 1\n0 1 7.5 2\nNELEM= 1\n5 0 1 2\n";
    let mesh = read_bytes(text).expect("readable");
    assert_eq!(mesh.elements[0].2, [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]]);
}

#[test]
fn zones_have_points_of_their_own() {
    let zone = |k: usize, x: f64| {
        format!(
            "IZONE= {k}\nNDIME= 2\nNELEM= 1\n5 0 1 2 0\nNPOIN= 3\n{x} 0\n{} 0\n{x} 1\nNMARK= 0\n",
            x + 1.0
        )
    };
    let text = format!("NZONE= 2\n{}{}", zone(1, 0.0), zone(2, 5.0));
    let mesh = read_bytes(&text).expect("readable");
    assert_eq!(mesh.elements[0], (1, Triangle, vec![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]]));
    assert_eq!(mesh.elements[1], (2, Triangle, vec![[5., 0., 0.], [6., 0., 0.], [5., 1., 0.]]));
    let error = read_bytes(&text.replacen("0 1 2 0", "0 1 3 0", 1)).expect_err("a point of the other zone");
    assert!(
        error.to_string().contains("line 5: expected the number of a point, under 3 in this zone, found 3"),
        "{error}"
    );
    let error = read_bytes(&text.replace("NZONE= 2", "NZONE= 3")).expect_err("a zone too few");
    assert!(error.to_string().contains("3 zones, as NZONE says, and not only 2"), "{error}");
}

#[test]
fn second_order_as_gmsh_writes_it() {
    let points: String = (0..27).map(|k| format!("{k} 0 0\n")).collect();
    for (code, nodes, shape) in
        [(24, 10, Tetrahedron), (29, 27, Hexahedron), (14, 13, Pyramid), (14, 5, Pyramid)]
    {
        let row: String = (0..nodes).map(|k| format!(" {k}")).collect();
        for number in ["", " 0"] {
            let text = format!("NDIME= 3\nNELEM= 1\n{code}{row}{number}\nNPOIN= 27\n{points}");
            assert_eq!(read_bytes(&text).expect("readable").count(shape), 1, "{code} {nodes}");
        }
    }
}

#[test]
fn errors_name_the_line_and_what_stood_there() {
    let rows = [
        ("NDIME= 3", "NDIME= 4", "line 2: expected NDIME= 2 or 3, found 4"),
        ("NDIME= 3\n", "", "line 8: expected NDIME before NPOIN, found none"),
        (
            "NELEM=2",
            "NELEM=3",
            "line 9: expected rows of NELEM, 3 in all, and not only 2, found \"NPOIN= 5 5\"",
        ),
        ("NELEM=2", "NELEM=1", "line 8: expected a line KEYWORD= value, found \" 10\\t0 2 1 4\""),
        (
            "NELEM=2",
            "NELEM=-2",
            "line 4: expected a keyword with a number, 0 or more, found \"NELEM=-2 % two\"",
        ),
        (
            "NPOIN= 5",
            "NPOIN= 1000000000000000000",
            "line 15: expected rows of NPOIN, 1000000000000000000 in all, and not only 5, found \"NMARK = 2\"",
        ),
        ("10 0 1 2 3 0", "10 0 1 2", "line 5: expected 4 points of a VTK_TETRA, found 3"),
        (
            "10 0 1 2 3 0",
            "11 0 1 2 3",
            "line 5: expected the number of an element type (1, 3, 5, 9, 10, 12, 13, 14, ...), found 11",
        ),
        ("10 0 1 2 3 0", "10 0 1 2 5 0", "line 5: element 1 names node 5, which the file does not define"),
        ("10 0 1 2 3 0", "10 0 1 2 -3 0", "line 5: expected the number of a point, found \"-3 0\""),
        ("1 0 0 1", "1 0", "line 11: expected a coordinate, found the end of the row"),
        ("1 0 0 1", "1 x 0 1", "line 11: expected a coordinate, found \"x 0 1\""),
        (
            "NMARK = 2",
            "NMARK= 3",
            "line 23: expected 3 markers, as NMARK says, and not 2, found the end of the file",
        ),
        (
            "NPOIN= 5 5",
            "NPOIN= 0\nPERIODIC= 0",
            "line 5: element 1 names node 0, which the file does not define",
        ),
    ];
    for (from, to, expected) in rows {
        assert_eq!(
            testing::message(&Su2, "a.su2", TETRAHEDRON.replace(from, to).as_bytes()),
            expected,
            "{to}"
        );
    }
    let long = TETRAHEDRON.replace("10 0 1 2 3 0", &"1 ".repeat(50));
    assert!(
        testing::message(&Su2, "a.su2", long.as_bytes())
            .contains("line 5: expected at most 40 numbers in a row")
    );
}
