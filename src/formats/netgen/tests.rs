//! The reader against files of Netgen, against hand-made files, and against damage.

use super::Netgen;
use crate::error::Result;
use crate::formats::Format;
use crate::formats::gmsh::Gmsh;
use crate::formats::reading::{Mesh, read};
use crate::formats::testing::{self, Row, check, corpus, counted, damage, detected, own};
use crate::mesh::Shape::{self, Hexahedron, Quadrilateral, Tetrahedron, Triangle, Wedge};

const MIXED: &[(Shape, usize)] = &[(Triangle, 28), (Quadrilateral, 36), (Wedge, 28), (Hexahedron, 8)];

const OWN: &[Row] = &[
    ("cube_o2.vol", 122, &[(Triangle, 36), (Tetrahedron, 53)], &[("line", 48)]),
    ("from_gmsh_mixed.vol", 54, MIXED, &[("line", 0)]),
    ("square2d_quad.vol", 16, &[(Quadrilateral, 9)], &[("line", 12), ("point", 4)]),
];

const CORPUS: &[Row] = &[
    ("cube.vol", 26, &[(Triangle, 36), (Tetrahedron, 53)], &[("line", 48)]),
    ("cube_o2.vol.gz", 122, &[(Triangle, 36), (Tetrahedron, 53)], &[("line", 48)]),
    ("meshio_mixed.vol", 54, MIXED, &[]),
];

fn read_bytes(text: &str) -> Result<Mesh> {
    testing::read_bytes(&Netgen, "a.vol", text.as_bytes())
}

fn before_end(bytes: &[u8]) -> usize {
    memchr::memmem::rfind(bytes, b"endmesh").expect("its end")
}

#[test]
fn own_files_hold_what_netgen_counts() {
    let meshes: Vec<_> = OWN.iter().map(|row| check(&Netgen, &own("netgen"), row)).collect();
    let names: Vec<_> = meshes[0].ledger.types.iter().map(|t| &t.name[..]).collect();
    assert!(names.contains(&"TRIG6") && names.contains(&"TET10"), "{names:?}");
    let tetrahedra = meshes[0].elements.iter().filter(|e| e.1 == Tetrahedron);
    assert_eq!(tetrahedra.map(|e| e.0).collect::<Vec<_>>(), (37..=89).collect::<Vec<_>>());
}

#[test]
fn corpus_files_hold_what_others_count() {
    let Some(corpus) = corpus() else { return };
    CORPUS.iter().chain(OWN).for_each(|row| drop(check(&Netgen, &corpus.join("netgen"), row)));
}

#[test]
fn the_mixed_mesh_is_that_of_gmsh() {
    let Some(corpus) = corpus() else { return };
    let expected = read(&Gmsh, &corpus.join("gmsh/mixed_hex_prism_41.msh")).expect("readable");
    let mesh = read(&Netgen, &corpus.join("netgen/meshio_mixed.vol")).expect("readable");
    for shape in [Triangle, Quadrilateral] {
        assert_eq!(testing::corners(&mesh, shape), testing::corners(&expected, shape), "{shape}");
    }
}

#[test]
fn only_netgen_files_of_the_corpus_are_detected() {
    let Some(corpus) = corpus() else { return };
    let plain = CORPUS.iter().chain(OWN).filter(|row| row.0.ends_with(".vol"));
    let mut expected: Vec<_> = plain.map(|row| format!("netgen/{}", row.0)).collect();
    expected.sort();
    assert_eq!(detected(&Netgen, &corpus), expected);
}

#[test]
fn a_cut_file_is_an_error_and_a_flipped_bit_no_panic() {
    OWN.iter().for_each(|row| damage(&Netgen, &own("netgen").join(row.0), before_end));
}

const MESH: &str = "# by hand\nmesh3d\n\ndimension\n3\n\nmaterials\n1\n1 steel\n\n# surfnr ...\nsurfaceelementsgi\n2\n\
                    2 -1 1 0 3 1 2 3 7 7 7\n\n2 1 1 0 4 1 2 4 3 7 7 7 7\nvolumeelements\n2\n1 4 1 2 3 5\n\
                    1 10 1 2 4 5 1 1 1 1 1 1\nedgesegmentsgi2\n1\n1 0 1 2 3 4 5 6 7 8 9 10\n# x\npoints\n5\n\
                    0 0 0\n1 0 0\n  0 1 0\n1 1 0\n0 0 -1.5\npointelements\n0\nendmesh\ncsgsurfaces 3\nplane 6\n";

#[test]
fn orders_may_differ_from_row_to_row() {
    for text in [MESH.to_owned(), MESH.replace('\n', "\r\n")] {
        let mesh = read_bytes(&text).expect("readable");
        assert_eq!((mesh.nodes.count(), counted(&mesh, "line"), mesh.count(Tetrahedron)), (5, 1, 2));
        let labels: Vec<_> = mesh.elements.iter().map(|e| (e.0, e.1)).collect();
        assert_eq!(labels, [(1, Triangle), (2, Quadrilateral), (3, Tetrahedron), (4, Tetrahedron)]);
        assert_eq!(mesh.elements[2].2[3], [0., 0., -1.5]);
        assert!(Netgen.detect(text.as_bytes()));
    }
}

#[test]
fn errors_name_the_line_and_what_stood_there() {
    let rows = [
        (
            "volumeelements\n2",
            "volumeelements\n3",
            "line 21: expected rows of volume elements, 3 in all, and not only 2, found \"edgesegmentsgi2\"",
        ),
        (
            "volumeelements\n2",
            "volumeelements\n1",
            "line 20: expected the name of a section, found \"1 10 1 2 4 5 1 1 1 1 1 1\"",
        ),
        (
            "volumeelements\n2",
            "volumeelements\n1000000000000000000",
            "line 21: expected rows of volume elements, 1000000000000000000 in all, and not only 2, found \"edgesegmentsgi2\"",
        ),
        ("points\n5", "points\nx", "line 26: expected the number of points, found \"x\""),
        (
            "1 4 1 2 3 5",
            "1 7 1 2 3 5",
            "line 19: expected the number of an element's points (4, 5, 6, 8, 10, 12, 13, 15, 20), found 7",
        ),
        ("1 4 1 2 3 5", "1 4 1 2 3 6", "line 19: element 3 names node 6, which the file does not define"),
        ("1 4 1 2 3 5", "1 4 1 2 3", "line 19: expected the number of a point, found the end of the row"),
        ("1 4 1 2 3 5", "1 4 1 2 3 5 5", "line 19: expected the end of the row, found \"5\""),
        ("0 0 -1.5", "0 0", "line 31: expected a coordinate, found the end of the row"),
        ("endmesh\n", "", "line 36: expected endmesh, found the end of the file"),
    ];
    for (from, to, expected) in rows {
        assert_eq!(testing::message(&Netgen, "a.vol", MESH.replace(from, to).as_bytes()), expected, "{to}");
    }
    assert!(
        testing::message(&Netgen, "a.vol", b"mesh3d\nendmesh\n")
            .contains("expected a section points before endmesh")
    );
}
