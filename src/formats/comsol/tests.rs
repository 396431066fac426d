//! The reader against meshes laid out after COMSOL's file format reference, against files of COMSOL's own and against
//! damage. COMSOL is not at hand: `tests/meshes/comsol` holds Gmsh's mixed mesh in the layout of the reference. Files of
//! COMSOL's own are known for the versions 1 and 4, in text; 2 and 8 and all of the binary encoding follow documents and
//! other readers.

use std::path::PathBuf;

use super::Comsol;
use crate::formats::Format;
use crate::formats::reading::Mesh;
use crate::formats::testing::{self, Row};
use crate::mesh::Shape::{self, Hexahedron, Pyramid, Quadrilateral, Tetrahedron, Triangle, Wedge};

const MIXED: &[(Shape, usize)] = &[(Triangle, 28), (Quadrilateral, 36), (Wedge, 28), (Hexahedron, 8)];
const INTRO: &[(Shape, usize)] = &[(Triangle, 13), (Quadrilateral, 5), (Tetrahedron, 5), (Wedge, 2)];

const OWN: &[Row] = &[("mixed.mphtxt", 54, MIXED, &[]), ("mixed.mphbin", 54, MIXED, &[])];

const CORPUS: &[Row] = &[
    ("comsol/busbar_with_selections.mphtxt", 232, &[(Triangle, 510), (Tetrahedron, 638)], LINES_BUSBAR),
    ("comsol/synthetic_busbar.mphbin", 232, &[(Triangle, 510), (Tetrahedron, 638)], LINES_BUSBAR),
    ("comsol/elmer_fsi.mphtxt", 531, &[(Triangle, 1006)], &[("line", 105), ("point", 11)]),
    ("comsol/elmer_testmesh.mphtxt", 29, &[(Triangle, 48), (Tetrahedron, 58)], &[("line", 24), ("point", 8)]),
    ("comsol/mesh_1.mphtxt", 1204, &[(Triangle, 1123), (Tetrahedron, 5484)], LINES_MESH_1),
    ("compressed/mesh_1.mphtxt.zst", 1204, &[(Triangle, 1123), (Tetrahedron, 5484)], LINES_MESH_1),
    ("comsol/mesh_example_intro.mphtxt", 12, INTRO, &[("line", 19), ("point", 10)]),
    ("comsol/mesh_example_without_domain_geom_info.mphtxt", 12, &[(Tetrahedron, 5), (Wedge, 2)], &[]),
];
const LINES_BUSBAR: &[(&str, u64)] = &[("line", 177), ("point", 52)];
const LINES_MESH_1: &[(&str, u64)] = &[("line", 149), ("point", 18)];

fn own() -> PathBuf {
    testing::own("comsol")
}

fn read(text: &str) -> Mesh {
    testing::read_bytes(&Comsol, "a.mphtxt", text.as_bytes()).unwrap_or_else(|e| panic!("{e}"))
}

fn message(text: &str) -> String {
    testing::message(&Comsol, "a.mphtxt", text.as_bytes())
}

/// A file with one mesh of the version, from its space dimension on.
fn file(version: u32, body: &str) -> String {
    format!("# COMSOL\n0 1\n1\n5 mesh1\n1\n3 obj\n0 0 1\n4 Mesh # class\n{version} # version\n{body}")
}

#[test]
fn own_files_hold_what_gmsh_counts() {
    OWN.iter().for_each(|row| drop(testing::check(&Comsol, &own(), row)));
}

#[test]
fn corpus_files_hold_what_others_count() {
    let Some(corpus) = testing::corpus() else { return };
    CORPUS.iter().for_each(|row| drop(testing::check(&Comsol, &corpus, row)));
}

#[test]
fn text_and_binary_are_one_mesh_and_that_of_gmsh() {
    let [text, binary] = [0, 1].map(|k| testing::read_file(&Comsol, &own().join(OWN[k].0)));
    assert_eq!(text.elements, binary.elements);
    let gmsh = own().join("../gmsh/mixed_hex_prism_41.msh");
    let gmsh = testing::read_file(&crate::formats::gmsh::Gmsh, &gmsh);
    testing::same_elements(&text, &gmsh, 1e-15);
}

#[test]
fn tensor_order_becomes_a_ring() {
    let text = file(
        4,
        "3\n8\n0\n0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1\n3\n3 hex 8 1 0 1 2 3 4 5 6 7 0\n\
         3 pyr 5 1 0 1 2 3 4 0\n4 quad 4 1 4 5 6 7 0\n",
    );
    let mesh = read(&text);
    let corners = |shape| &mesh.elements.iter().find(|e| e.1 == shape).expect("one").2;
    let ring = |z| [[0., 0., z], [1., 0., z], [1., 1., z], [0., 1., z]];
    assert_eq!(corners(Hexahedron)[..], [ring(0.), ring(1.)].concat());
    assert_eq!(corners(Pyramid)[..4], ring(0.));
    assert_eq!(corners(Quadrilateral)[..], ring(1.));
}

#[test]
fn every_version_of_the_class_is_read() {
    let points = "3\n0\n0 0 1 0 0 1\n";
    let block = "1\n3 tri # type name\n3\n1\n0 1 2\n";
    let old = format!("2 # sdim\n{points}{block}6\n1\n1 2 3 4 5 6.5\n1\n1\n1\n0 1\n");
    for (version, body) in [
        (1, old.clone()),
        (2, old),
        (4, format!("2\n{points}{block}1\n1\n")),
        (8, format!("2\n0\n{}{block}1\n-1\n", points.replacen("\n0", "", 1))),
        (8, format!("2\n1\n3\n0\n0\n1\n0\n0\n0\n{}{block}1\n1\n", points.replacen("\n0", "", 1))),
        (8, format!("2\n1\n3\n0\n0\n1\n1\n2\n0\n0\n{}{block}1\n1\n", points.replacen("\n0", "", 1))),
    ] {
        for text in [file(version, &body), file(version, &body).replace('\n', "\r\n")] {
            let mesh = read(&text);
            assert_eq!((mesh.nodes.count(), mesh.count(Triangle)), (3, 1), "version {version}");
        }
    }
}

#[test]
fn the_lowest_index_may_be_1_and_a_file_may_hold_several_meshes() {
    let mesh = "0 0 1\n4 Mesh\n4\n2\n3\n1\n0 0 1 0 0 1\n1\n3 tri\n3\n1\n1 2 3\n0\n";
    let other = mesh.replace("0 0 1 0 0 1", "5 5 6 5 5 6");
    let text = format!("0 1\n2\n1 a\n1 b\n2\n3 obj\n3 obj\n{mesh}{other}");
    let found = read(&text);
    assert_eq!(found.nodes.count(), 6);
    assert_eq!(found.elements[0].2, [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]]);
    assert_eq!(found.elements[1].2, [[5., 5., 0.], [6., 5., 0.], [5., 6., 0.]]);
    let zero = text.replace("1 2 3", "0 1 2");
    assert_eq!(message(&zero), "line 19: element 0 names node 0, which the file does not define");
}

#[test]
fn unknown_types_are_counted_by_name() {
    let mesh = read(&file(
        4,
        "2\n3\n0\n0 0 1 0 0 1\n2\n4 blob 7 2\n1 2 3 4 5 6 7\n1 2 3 4 5 6 7\n0\n3 tri 3 1 0 1 2 0",
    ));
    assert_eq!((testing::counted(&mesh, "blob"), mesh.count(Triangle)), (2, 1));
}

#[test]
fn what_is_wrong_or_not_read_is_named() {
    let head = "2\n3\n0\n0 0 1 0 0 1\n1\n";
    let rows = [
        (file(3, head), "line 9: version 3 of COMSOL's class Mesh is not read (1, 2, 4 and 8 are)"),
        (file(4, "4"), "line 10: expected the space dimension, 0 to 3, found 4"),
        (file(4, "2\n3\n0\n0 0 1 0 0"), "line 13: expected 3 mesh vertices, found the end of the file"),
        (
            file(4, "2\n999999999999\n0\n0 0"),
            "line 13: expected 999999999999 mesh vertices, found the end of the file",
        ),
        (file(4, "2\n-3\n0\n0 0"), "line 11: expected the number of mesh vertices, found -3"),
        (file(4, "2\n3\n0\n0 0 1 0 0 x\n0"), "line 13: expected a coordinate, found \"x\""),
        (
            file(4, &format!("{head}3 tri 4 1 0 1 2 3 0")),
            "line 15: expected 3 vertices per element of the type tri, found 4",
        ),
        (
            file(4, &format!("{head}3 odd 0 1000000000 0")),
            "line 15: expected 1 to 65536 vertices per element, found 0",
        ),
        (
            file(4, &format!("{head}3 tri 3 1 0 1 -2 0")),
            "line 15: expected the number of an element's node, found \"-2\"",
        ),
        (
            file(4, &format!("{head}3 tri 3 1 0 1 3 0")),
            "line 15: element 0 names node 3, which the file does not define",
        ),
        (
            file(4, &format!("{head}3 tri 3 1 0 1 2 0 77")),
            "line 15: expected the end of the file, found \"77\"",
        ),
        (
            file(8, "2\n1\n3\n4\n4\n1\n0\n4\n"),
            "line 17: a COMSOL mesh of class version 8 with up and down domains \
            of boundaries is not read: export it without its geometric model",
        ),
        (
            file(4, head).replace("4 Mesh", "5 Geom3"),
            "line 8: a COMSOL object of class \"Geom3\" is not read (Mesh and Selection are)",
        ),
        (
            file(4, head).replace("0 1\n1\n", "0 2\n1\n"),
            "line 2: COMSOL file version 0 2 is not read (0 1 is)",
        ),
        (
            file(4, head).replace("5 mesh1", "4 mesh1"),
            "line 4: expected one of the 1 tags, 4 characters, found \"4 mesh1\"",
        ),
        (
            "0 1\n1\n5 mesh1\n0\n".to_owned(),
            "line 4: expected an object of class Mesh, found 0 objects of other classes",
        ),
    ];
    for (text, expected) in rows {
        assert_eq!(message(&text), expected, "{text}");
    }
}

#[test]
fn only_comsol_files_of_the_corpus_are_detected() {
    let Some(corpus) = testing::corpus() else { return };
    let plain = CORPUS.iter().map(|row| row.0).filter(|name| !name.ends_with(".zst"));
    let mut expected: Vec<_> = plain.collect();
    expected.sort_unstable();
    assert_eq!(testing::detected(&Comsol, &corpus), expected);
}

#[test]
fn a_cut_file_is_an_error_and_a_flipped_bit_no_panic() {
    OWN.iter().for_each(|row| testing::damage(&Comsol, &own().join(row.0), testing::last_word));
    let Some(corpus) = testing::corpus() else { return };
    for row in CORPUS.iter().filter(|row| !row.0.ends_with(".zst")) {
        testing::damage(&Comsol, &corpus.join(row.0), testing::last_word);
    }
}

#[test]
fn a_file_that_is_named_otherwise_is_known_by_its_content() {
    let text = file(4, "2\n");
    assert!(Comsol.detect(text.as_bytes()) && Comsol.detect(&[b"\xef\xbb\xbf", text.as_bytes()].concat()));
    assert!(
        !Comsol.detect(b"0 1 5 3 2 1\n") && !Comsol.detect(b"0 1\n1\n3 long\n") && !Comsol.detect(&[0; 64])
    );
}
