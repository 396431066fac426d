//! Exodus files of other people's writers: counts, orders, faults.

use super::Exodus;
use crate::formats::Format;
use crate::formats::testing::{self, Row, check, corpus, detected, message, own, read_file};
use crate::mesh::Shape::*;

const FOUR: &[(crate::mesh::Shape, usize)] = &[(Tetrahedron, 1), (Pyramid, 1), (Wedge, 1), (Hexahedron, 1)];

const CORPUS: &[Row] = &[
    ("exodus/dealii_five-3d.e", 8, &[(Quadrilateral, 5)], &[]),
    ("exodus/dealii_four-sidesets.e", 13, FOUR, &[]),
    ("exodus/dealii_four.e", 13, FOUR, &[]),
    ("exodus/dealii_lines.e", 9, &[], &[("line", 8)]),
    #[cfg(feature = "hdf5")]
    ("exodus/meshio_mixed.e", 54, MIXED, &[]),
    ("exodus/mfem_cylinder-hex-q2.gen", 2443, &[(Hexahedron, 252)], &[]),
    ("exodus/mfem_cylinder-tet-p2.gen", 2417, &[(Tetrahedron, 1478)], &[]),
];

const MIXED: &[(crate::mesh::Shape, usize)] =
    &[(Triangle, 28), (Quadrilateral, 36), (Wedge, 28), (Hexahedron, 8)];

const OWN: &[Row] = &[
    ("mixed_cdf1.e", 54, MIXED, &[]),
    ("mixed_cdf2_map.e", 54, MIXED, &[]),
    ("mixed_cdf5_results.e", 54, MIXED, &[]),
    #[cfg(feature = "hdf5")]
    ("meshio_mixed.e", 54, MIXED, &[]),
    #[cfg(feature = "hdf5")]
    ("mixed_netcdf4.e", 54, MIXED, &[]),
    #[cfg(feature = "hdf5")]
    ("mixed_netcdf4_packed.e", 54, MIXED, &[]),
    #[cfg(feature = "hdf5")]
    ("mixed_hdf5_earliest.e", 54, MIXED, &[]),
    #[cfg(feature = "hdf5")]
    ("mixed_hdf5_latest.e", 54, MIXED, &[]),
];

#[test]
fn own_files_hold_the_mixed_mesh() {
    let gmsh = read_file(&crate::formats::gmsh::Gmsh, &own("gmsh").join("mixed_hex_prism_41.msh"));
    for row in OWN {
        let mesh = check(&Exodus, &own("exodus"), row);
        testing::same_elements(&mesh, &gmsh, 1e-15);
    }
}

#[test]
fn corpus_files_hold_what_others_count() {
    let Some(corpus) = corpus() else { return };
    CORPUS.iter().for_each(|row| drop(check(&Exodus, &corpus, row)));
}

#[test]
fn elements_have_the_numbers_of_their_map() {
    let plain = read_file(&Exodus, &own("exodus").join("mixed_cdf1.e"));
    let mapped = read_file(&Exodus, &own("exodus").join("mixed_cdf2_map.e"));
    assert!(plain.elements.iter().map(|e| e.0).eq(1..=100));
    assert!(mapped.elements.iter().map(|e| e.0).eq((1..=100).map(|k| 1000 + 7 * k)));
}

#[test]
fn only_exodus_files_of_the_corpus_are_detected() {
    let Some(corpus) = corpus() else { return };
    let mut expected: Vec<_> = CORPUS.iter().map(|row| row.0).collect();
    expected.sort_unstable();
    assert_eq!(detected(&Exodus, &corpus), expected);
}

#[test]
fn a_cut_file_is_an_error_and_a_flipped_bit_no_panic() {
    OWN.iter().for_each(|row| testing::damage(&Exodus, &own("exodus").join(row.0), data_bytes));
    let Some(corpus) = corpus() else { return };
    CORPUS.iter().for_each(|row| testing::damage(&Exodus, &corpus.join(row.0), data_bytes));
}

/// All but the padding behind the last variable.
fn data_bytes(bytes: &[u8]) -> usize {
    if bytes.starts_with(b"CDF") { bytes.len() - 3 } else { bytes.len() }
}

/// A file in CDF-1 with one block of triangles; `edit` may change its words.
fn file(edit: impl Fn(&mut Vec<u32>)) -> Vec<u8> {
    let name = |text: &str| {
        let mut bytes = text.as_bytes().to_vec();
        bytes.resize(text.len().next_multiple_of(4), 0);
        let words = bytes.chunks(4).map(|b| u32::from_be_bytes(b.try_into().expect("4 bytes")));
        [vec![text.len() as u32], words.collect()].concat()
    };
    let mut words = vec![0x4344_4601, 0, 10, 4];
    for (dimension, len) in [("num_nodes", 3), ("num_dim", 2), ("num_el_in_blk1", 1), ("num_nod_per_el1", 3)]
    {
        words.extend(name(dimension));
        words.push(len);
    }
    words.extend([0, 0, 11, 3]);
    let places: Vec<_> = [("coordx", &[0][..], 6), ("coordy", &[0], 6), ("connect1", &[2, 3], 4)]
        .into_iter()
        .map(|(variable, dimensions, kind)| {
            words.extend(name(variable));
            words.push(dimensions.len() as u32);
            words.extend(dimensions);
            match kind {
                4 => words.extend([vec![12, 1], name("elem_type"), vec![2], name("TRI3")].concat()),
                _ => words.extend([0, 0]),
            }
            words.extend([kind, 24, 0]);
            words.len() - 1
        })
        .collect();
    let mut at = 4 * words.len() as u32;
    for (place, bytes) in places.into_iter().zip([24, 24, 12]) {
        words[place] = at;
        at += bytes;
    }
    for x in [0.0f64, 1.0, 0.0, 0.0, 0.0, 1.0] {
        words.extend([(x.to_bits() >> 32) as u32, x.to_bits() as u32]);
    }
    words.extend([1, 2, 3]);
    edit(&mut words);
    words.into_iter().flat_map(u32::to_be_bytes).collect()
}

#[test]
fn what_is_wrong_with_a_file_is_said() {
    let len = file(|_| ()).len();
    let last = len / 4 - 1;
    let mesh = testing::read_bytes(&Exodus, "a.e", &file(|_| ())).expect("a mesh");
    assert_eq!((mesh.nodes.count(), mesh.count(Triangle)), (3, 1));
    type Row<'a> = (&'a dyn Fn(&mut Vec<u32>), &'a str);
    let rows: &[Row<'_>] = &[
        (&|words| words[last] = 4, "element 1 names node 4, which the file does not define"),
        (&|words| words[last] = u32::MAX, "expected a node's number, 0 or more, in element 1, found -1"),
        (&|words| words[2] = 7, "byte 8: expected the list of dimensions (tag 10), found tag 7"),
        (&|words| words[3] = u32::MAX, "byte 12: expected the list of dimensions, found a negative number"),
        (&|words| words[3] = 1 << 30, "byte 12: the list of dimensions is over the limit of 1048576"),
        (&|words| words[8] = 1 << 30, "expected the variable coord"),
        (&|words| words.truncate(last), "expected the variable connect1, up to byte"),
        (&|words| words.truncate(5), "expected a name, found the end of the file"),
    ];
    for (edit, expected) in rows {
        let found = message(&Exodus, "a.e", &file(edit));
        assert!(found.contains(expected), "{found}\n  lacks {expected}");
    }
}

#[test]
fn free_words_name_types() {
    let rows = [
        ("HEX", 8, 3, "hexahedron 1"),
        ("hex27", 27, 3, "hexahedron 2"),
        ("Tetra10", 10, 3, "tetrahedron 2"),
        ("SHELL", 4, 3, "quadrilateral 1"),
        ("SHELL3", 3, 3, "triangle 1"),
        ("SHELL2", 2, 2, "line"),
        ("TRUSS", 2, 3, "line"),
        ("SPHERE", 1, 3, "point"),
        ("HEX8", 5, 3, "HEX8 of 5 nodes"),
        ("blob", 4, 3, "blob of 4 nodes"),
    ];
    for (text, nodes, axes, expected) in rows {
        let kind = super::types::of_block(text, nodes, axes);
        let found = match &kind.class {
            crate::mesh::Class::Measured { shape, order, .. } => format!("{shape} {order}"),
            crate::mesh::Class::Counted(what) => what.to_string(),
        };
        assert_eq!(found, expected, "{text}");
    }
}

#[test]
fn a_results_file_of_another_kind_is_not_taken() {
    assert!(!Exodus.detect(b"CDF\x01\0\0\0\0\0\0\0\x0atime latitude"));
}
