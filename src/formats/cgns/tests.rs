//! CGNS files of several writers.

use super::Cgns;
use crate::formats::testing::{self, Row, check, corpus, detected, message, own, read_file};
use crate::mesh::Shape::{self, *};

const MIXED: &[(Shape, usize)] = &[(Triangle, 28), (Quadrilateral, 36), (Wedge, 28), (Hexahedron, 8)];

const CORPUS: &[Row] = &[
    ("cgns/box_o2.cgns", 2070, &[(Tetrahedron, 1093)], &[]),
    ("cgns/mixed.cgns", 54, MIXED, &[]),
    ("cgns/pit2d.cgns", 220, &[(Triangle, 382)], &[("line", 56)]),
];

const OWN: &[Row] = &[
    ("gmsh_mixed.cgns", 54, MIXED, &[]),
    ("gmsh_pit2d.cgns", 220, &[(Triangle, 382)], &[("line", 56)]),
    ("mixed_sections.cgns", 54, MIXED, &[]),
    ("two_zones_ngon.cgns", 24, &[(Hexahedron, 4)], &[("polygon", 9), ("polyhedron", 2)]),
];

#[test]
fn own_files_hold_what_their_writers_count() {
    OWN.iter().for_each(|row| drop(check(&Cgns, &own("cgns"), row)));
}

#[test]
fn sections_of_one_type_and_of_several_are_one_mesh_and_that_of_gmsh() {
    let gmsh = read_file(&crate::formats::gmsh::Gmsh, &own("gmsh").join("mixed_hex_prism_41.msh"));
    for name in ["gmsh_mixed.cgns", "mixed_sections.cgns"] {
        testing::same_elements(&read_file(&Cgns, &own("cgns").join(name)), &gmsh, 1e-15);
    }
}

#[test]
fn a_structured_zone_implies_hexahedra_and_zones_have_nodes_of_their_own() {
    let mesh = read_file(&Cgns, &own("cgns").join("two_zones_ngon.cgns"));
    let hexahedron = &mesh.elements[3];
    assert_eq!((hexahedron.0, hexahedron.1), (4, Hexahedron));
    let ring = |z| [[1., 1., z], [2., 1., z], [2., 2., z], [1., 2., z]];
    assert_eq!(hexahedron.2, [ring(0.), ring(1.)].concat());
    assert_eq!(mesh.nodes.unused(), 0);
}

#[test]
fn corpus_files_hold_what_others_count() {
    let Some(corpus) = corpus() else { return };
    CORPUS.iter().for_each(|row| drop(check(&Cgns, &corpus, row)));
    let known = ["cgns/box_o2.cgns", "cgns/gmsh_tut21.cgns", "cgns/mixed.cgns", "cgns/pit2d.cgns"];
    assert_eq!(detected(&Cgns, &corpus), known);
}

#[test]
fn the_older_container_is_refused_by_name() {
    let found = message(&Cgns, "a.cgns", b"@(#)ADF Database Version B02012>");
    assert_eq!(found, "byte 0: CGNS in the ADF container is not read, only in HDF5: convert it by adf2hdf");
}

#[test]
fn a_cut_file_is_an_error_and_a_flipped_bit_no_panic() {
    OWN.iter().for_each(|row| testing::damage(&Cgns, &own("cgns").join(row.0), <[u8]>::len));
    let Some(corpus) = corpus() else { return };
    CORPUS.iter().for_each(|row| testing::damage(&Cgns, &corpus.join(row.0), <[u8]>::len));
}
