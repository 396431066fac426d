//! The reader against meshes by meshio and laid out after the generators' manuals, against files of the generators and
//! against damage. `tests/meshes/tetgen/box` was written by meshio; the others are Gmsh's meshes in the generators' layout.

use std::path::{Path, PathBuf};

use super::{Simplex, TETGEN, TRIANGLE};
use crate::formats::Format;
use crate::formats::gmsh::Gmsh;
use crate::formats::reading::read;
use crate::formats::testing::{self, Row};
use crate::mesh::Class;
use crate::mesh::Shape::{Tetrahedron, Triangle};

type Rows = &'static [(&'static Simplex, Row)];

const OWN: Rows = &[
    (&TRIANGLE, ("triangle/pit2d.1.ele", 220, &[(Triangle, 382)], &[])),
    (&TRIANGLE, ("triangle/square_o2.1.ele", 253, &[(Triangle, 112)], &[])),
    (&TETGEN, ("tetgen/box.ele", 44, &[(Tetrahedron, 90)], &[])),
    (&TETGEN, ("tetgen/box_o2.1.ele", 219, &[(Tetrahedron, 90)], &[])),
];

const CORPUS: Rows = &[
    (&TRIANGLE, ("triangle/A.1.ele", 29, &[(Triangle, 29)], &[])),
    (&TRIANGLE, ("triangle/box.4.ele", 531, &[(Triangle, 992)], &[])),
    (&TRIANGLE, ("triangle/double_hex.1.ele", 96, &[(Triangle, 98)], &[])),
    (&TRIANGLE, ("triangle/synthetic_sq_o2.ele", 74, &[(Triangle, 29)], &[])),
    (&TETGEN, ("tetgen/pynastran_tetgen_test.1.ele", 147, &[(Tetrahedron, 288)], &[])),
    (&TETGEN, ("tetgen/synthetic_cube_o2.ele", 27, &[(Tetrahedron, 6)], &[])),
];

fn own() -> PathBuf {
    testing::own("")
}

fn check(folder: &Path, rows: Rows) {
    for (format, row) in rows {
        let mesh = testing::check(*format, folder, row);
        let second = row.0.contains("_o2");
        let order = if second { 2 } else { 1 };
        assert!(
            matches!(mesh.ledger.types[0].class, Class::Measured { order: o, .. } if o == order),
            "{}",
            row.0
        );
        assert!(mesh.elements.iter().all(|e| size(&e.2) > 0.0), "{}", row.0);
    }
}

/// Twice the area of a triangle in the plane, six times the volume of a tetrahedron, with their sign.
fn size(corners: &[[f64; 3]]) -> f64 {
    let edge = |k: usize| [0, 1, 2].map(|i| corners[k][i] - corners[0][i]);
    let (a, b) = (edge(1), edge(2));
    let c = corners.get(3).map_or([0., 0., 1.], |_| edge(3));
    let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    cross[0] * c[0] + cross[1] * c[1] + cross[2] * c[2]
}

#[test]
fn own_files_hold_what_gmsh_counts() {
    check(&own(), OWN);
    let [triangle, gmsh] = [(&TRIANGLE as &dyn Format, OWN[0].1.0), (&Gmsh, "gmsh/pit2d_22_ascii.msh")]
        .map(|(format, name)| testing::read_file(format, &own().join(name)));
    testing::same_elements(&triangle, &gmsh, 1e-15);
}

#[test]
fn corpus_files_hold_what_others_count() {
    let Some(corpus) = testing::corpus() else { return };
    check(&corpus, CORPUS);
}

#[test]
fn only_their_files_of_the_corpus_are_detected() {
    let Some(corpus) = testing::corpus() else { return };
    let files: Vec<_> = CORPUS.iter().map(|row| row.1.0).collect();
    assert_eq!(testing::detected(&TRIANGLE, &corpus), files[..4]);
    assert_eq!(testing::detected(&TETGEN, &corpus), files[4..]);
}

#[test]
fn other_tables_of_numbers_are_not_theirs() {
    let others: [&[u8]; 7] = [
        b"4 2 0 1\n1 0 0 1\n2 1 0 1\n",
        b"3 3\n1 2 3\n2 3 1\n",
        b"2 3 0\n5 1 2 3\n6 2 3 4\n",
        b"2 3 0\n1 1 2 3\n",
        b"2 3 0\n1 0.5 2 3\n2 2 3 4\n",
        b"2 3 1\n1 1 2 3\n2 2 3 4\n",
        b"",
    ];
    for head in others {
        assert!(!TRIANGLE.detect(head) && !TETGEN.detect(head), "{}", head.escape_ascii());
    }
    assert!(
        TRIANGLE.detect(b"# c\n2 3 1\n\n0 1 2 3 0.5\n1 2 3 4 1e3 # c\n")
            && TETGEN.detect(b"1 4 0\n1 1 2 3 4")
    );
}

const NODES: &str = "# nodes\n4 3 0 0\n\n1 0 0 0 # first\n2 1 0 0\n3 0 1 0\n4 0 0 1\n# end\n";
const ELE: &str = "1 4 1\n1 1 2 3 4 -7\n";

fn read_pair(ele: &str, node: &str) -> crate::error::Result<crate::formats::reading::Mesh> {
    testing::read_files(&TETGEN, "a.1.ele", &[("a.1.ele", ele.as_bytes()), ("a.1.node", node.as_bytes())])
}

fn message(ele: &str, node: &str) -> String {
    let text = read_pair(ele, node).expect_err("an error").to_string();
    text.rsplit_once("/").map_or(text.clone(), |(_, rest)| rest.to_owned())
}

#[test]
fn comments_blank_lines_and_line_ends_are_as_they_may_be() {
    for (ele, node) in [(ELE, NODES), (&ELE.replace('\n', "\r\n"), &NODES.replace('\n', "\r\n"))] {
        assert_eq!(read_pair(ele, node).expect("readable").count(Tetrahedron), 1);
    }
}

#[test]
fn what_is_wrong_is_named() {
    let rows = [
        (
            ELE.replace("1 4 1", "1 5 1"),
            NODES.into(),
            "a.1.ele: line 1: expected 4 or 10 nodes of each element, found 5",
        ),
        (
            ELE.replace("1 4 1", "9 4 1"),
            NODES.into(),
            "a.1.ele: line 3: expected 9 elements, and not only 1, found the end of the file",
        ),
        (
            format!("{ELE}2 1 2 3 4 5\n"),
            NODES.into(),
            "a.1.ele: line 3: expected the end of the file after 1 elements, found \"2 1 2 3 4 5\"",
        ),
        (
            ELE.replace("-7\n", "-7"),
            NODES.into(),
            "a.1.ele: line 2: expected the end of the line of one of the 1 elements, found the end of the file",
        ),
        (
            ELE.replace("3 4 -7", "3"),
            NODES.into(),
            "a.1.ele: line 2: expected the number of an element's node, found no number",
        ),
        (
            ELE.replace(" 4 -7", " 5 -7"),
            NODES.into(),
            "a.1.ele: line 2: element 1 names node 5, which the file does not define",
        ),
        (
            ELE.into(),
            NODES.replace("4 3 0 0", "4 1 0 0"),
            "a.1.node: line 2: expected 2 or 3 dimensions, found 1",
        ),
        (
            ELE.into(),
            NODES.replace("4 3 0 0", "4 2 0 0"),
            "a.1.node: line 1: expected nodes with 3 coordinates for tetrahedra, found 2",
        ),
        (
            ELE.into(),
            NODES.replace("4 3 0 0", "99999999999999999 3"),
            "a.1.node: line 9: expected 99999999999999999 nodes, and not only 4, found the end of the file",
        ),
        (
            ELE.into(),
            NODES.replace("0 1 0", "0 nan 0"),
            "a.1.node: line 6: expected finite coordinates, found [0.0, NaN, 0.0]",
        ),
        (
            ELE.into(),
            String::new(),
            "a.1.node: line 1: expected numbers of nodes, dimensions, found the end of the file",
        ),
    ];
    for (ele, node, expected) in rows {
        assert_eq!(message(&ele, &node), expected);
    }
}

#[test]
fn an_ele_file_without_its_nodes_says_which_file_it_needs() {
    let message = testing::message(&TETGEN, "a.1.ele", ELE.as_bytes());
    assert!(message.contains("a.1.node"), "{message}");
}

#[test]
fn a_packed_ele_file_finds_its_nodes_plain_or_packed() {
    let pack = |text: &str| zstd::encode_all(text.as_bytes(), 1).expect("zstd");
    for node in [("a.1.node", NODES.as_bytes().to_vec()), ("a.1.node.zst", pack(NODES))] {
        let files = [("a.1.ele.zst", &pack(ELE)[..]), (node.0, &node.1[..])];
        let mesh = testing::read_files(&TETGEN, "a.1.ele.zst", &files).expect("readable");
        assert_eq!(mesh.count(Tetrahedron), 1);
    }
}

#[test]
fn a_cut_file_is_an_error_and_a_flipped_bit_no_panic() {
    let damage = |folder: &Path, rows: Rows| {
        for (format, row) in rows {
            let ele = folder.join(row.0);
            let node = ele.with_extension("node");
            testing::damage_beside(*format, &ele, &[&ele, &node], testing::last_word);
            testing::damage_beside(*format, &node, &[&ele], testing::last_word);
        }
    };
    damage(&own(), OWN);
    if let Some(corpus) = testing::corpus() {
        damage(&corpus, CORPUS);
    }
}

#[test]
fn a_node_file_alone_is_no_mesh() {
    let path = own().join("tetgen/box.node");
    assert!(read(&TETGEN, &path).is_err() && read(&TRIANGLE, &path).is_err());
}
