//! MED files of several writers.

use super::Med;
use crate::formats::testing::{self, Row, check, corpus, detected, own, read_file};
use crate::mesh::Shape::{self, *};

const MIXED: &[(Shape, usize)] = &[(Triangle, 28), (Quadrilateral, 36), (Wedge, 28), (Hexahedron, 8)];

const CORPUS: &[Row] = &[
    ("med/box_o2.med", 2070, &[(Tetrahedron, 1093)], &[]),
    ("med/gmsh_level_old.med", 1393, &[(Triangle, 2652)], &[("line", 132), ("point", 4)]),
    ("med/mixed.med", 54, MIXED, &[]),
    ("med/pit2d.med", 220, &[(Triangle, 382)], &[("line", 56)]),
];

const OWN: &[Row] = &[
    ("gmsh_mixed.med", 54, MIXED, &[]),
    ("gmsh_pit2d.med", 220, &[(Triangle, 382)], &[("line", 56)]),
    ("meshio_mixed.med", 54, MIXED, &[]),
];

#[test]
fn own_files_hold_what_their_writers_count() {
    OWN.iter().for_each(|row| drop(check(&Med, &own("med"), row)));
    // meshio does not turn solids round.
    let gmsh = read_file(&crate::formats::gmsh::Gmsh, &own("gmsh").join("mixed_hex_prism_41.msh"));
    testing::same_elements(&read_file(&Med, &own("med").join("meshio_mixed.med")), &gmsh, 1e-15);
}

#[test]
fn corpus_files_hold_what_others_count() {
    let Some(corpus) = corpus() else { return };
    CORPUS.iter().for_each(|row| drop(check(&Med, &corpus, row)));
    assert_eq!(detected(&Med, &corpus), CORPUS.iter().map(|row| row.0).collect::<Vec<_>>());
}

#[test]
fn a_cut_file_is_an_error_and_a_flipped_bit_no_panic() {
    OWN.iter().for_each(|row| testing::damage(&Med, &own("med").join(row.0), <[u8]>::len));
    let Some(corpus) = corpus() else { return };
    CORPUS.iter().for_each(|row| testing::damage(&Med, &corpus.join(row.0), <[u8]>::len));
}
