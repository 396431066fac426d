//! Whole archives: those of the corpus, one written after CDWRITE's layout, and damaged ones.

use super::Ansys;
use crate::formats::reading::read;
use crate::formats::testing::{corpus, damage, detected, holds, message, own, read_bytes};
use crate::mesh::Shape;

const CORPUS: [(&str, &str); 3] = [
    ("ansys_cdb/HexBeam.cdb", "321 nodes, SOLID186:40"),
    ("ansys_cdb/TetBeam.cdb", "1041 nodes, SOLID187 of 4 nodes:3913"),
    ("ansys_cdb/sector.cdb", "655 nodes, SOLID185 (wedge):4 SOLID185:101"),
];

/// Written by hand after CDWRITE's layout.
const DEGENERATE: &str = "degenerate.cdb";

#[test]
fn corpus_files_hold_what_others_count() {
    let Some(corpus) = corpus() else { return };
    for (name, expected) in CORPUS {
        let mesh = read(&Ansys, &corpus.join(name)).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(holds(&mesh), expected, "{name}");
    }
    assert_eq!(detected(&Ansys, &corpus), CORPUS.map(|row| row.0));
}

#[test]
fn degenerate_elements_are_what_they_are() {
    let mesh = read(&Ansys, &own("ansys").join(DEGENERATE)).unwrap_or_else(|e| panic!("{e}"));
    let expected = "10 nodes, MESH200:1 SHELL181 (triangle):1 SHELL181:1 SOLID185 (pyramid):1 \
                    SOLID185 (tetrahedron):1 SOLID185 (wedge):1 SOLID185:1 SOLID186:1 SURF154:1 \
                    type 9 without ET:1";
    assert_eq!(holds(&mesh), expected);
    assert_eq!(mesh.ledger.repeated_nodes, 0);
    let corners = |label| &mesh.elements.iter().find(|e| e.0 == label).expect("an element").2;
    assert_eq!(corners(2)[3..], [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 1.0]]);
    assert_eq!(corners(4)[2..], [[1.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    assert_eq!(mesh.count(Shape::Hexahedron), 2, "SOLID186 without its middle nodes is one");
}

/// An archive of a triangle: what follows `NBLOCK,` and `EBLOCK,`.
fn archive(nodes: &str, elements: &str) -> String {
    format!("/PREP7\nET,1,SHELL181\nNBLOCK,{nodes}EBLOCK,{elements}")
}

const NODES: &str = "3\n(1i9,3e20.9e3)\n        1\n        2    1.000000000E+000\n        3    0.000000000E+000    1.000000000E+000\n-1\n";

#[test]
fn formats_are_taken_from_the_archive() {
    let text = archive(
        NODES,
        "10,,,1\n(15i8)\n       7       1       1       1       0       1       2       3\n      -1\n",
    );
    let mesh = read_bytes(&Ansys, "a.cdb", text.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(holds(&mesh), "3 nodes, SHELL181 of 3 nodes:1");
    assert_eq!(mesh.elements[0].0, 7);
    assert_eq!(mesh.elements[0].2[2], [0.0, 1.0, 0.0]);
    let block = text.replace("ET,1,SHELL181\n", "ETBLOCK,1,1\n(2i9,19a9)\n        1      181\n       -1\n");
    let mesh = read_bytes(&Ansys, "a.cdb", block.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(holds(&mesh), "3 nodes, SHELL181 of 3 nodes:1");
}

#[test]
fn what_is_wrong_is_named() {
    let row = "       7       1       1       1       0       1       2       3\n";
    let rows = [
        (archive(NODES, "2,COMPACT,1\n(19i8)\n"), "line 9: compact EBLOCKs are not read"),
        (archive(NODES, "10,,,1\n(junk)\n"), "line 10: expected a Fortran format"),
        (archive(NODES, &format!("10,,,1\n(15i8)\n{row}")), "the end mark -1 of an EBLOCK"),
        (
            archive("3\n(1i9,3e20.9e3)\n        1\n", ""),
            "expected the end mark -1 of a NBLOCK, found the end of the file",
        ),
        (
            archive(NODES, &format!("10,,,1\n(15i8)\n{}      -1\n", row.replace('3', "x"))),
            "expected a node number",
        ),
        (
            archive(NODES, &format!("10,,,1\n(15i8)\n{}      -1\n", row.replace("    3", "    4"))),
            "element 7 names node 4",
        ),
        (archive(NODES, &format!("19,SOLID\n(9i8)\n{row}")), "more than 11 integers"),
        ("/PREP7\nET,1,185\n".to_owned(), "expected a command NBLOCK, found the end of the file"),
    ];
    for (text, expected) in rows {
        let error = message(&Ansys, "a.cdb", text.as_bytes());
        assert!(error.contains(expected), "{error}\n{text}");
    }
}

#[test]
fn damaged_archives_are_read_or_refused() {
    // The last block is not needed for a mesh, the first is.
    damage(&Ansys, &own("ansys").join(DEGENERATE), |_| 2400);
}
