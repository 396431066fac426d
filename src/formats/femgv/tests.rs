//! Whole files: those of the corpus, small ones written after the manual's layout, and damaged ones.

use super::{Femgv, Frd};
use crate::formats::Format;
use crate::formats::reading::read;
use crate::formats::testing::{corpus, damage, detected, holds, message, own, read_bytes};

const NEUTRAL: [(&str, &str); 2] = [
    ("femgv_frd/synthetic_femgen_neutral_10digit.neu", "220 nodes, tr3:382"),
    ("femgv_frd/synthetic_femgen_neutral_5digit.neu", "220 nodes, tr3:382"),
];
const RESULTS: [(&str, &str); 3] = [
    ("femgv_frd/ccx_fricloop.frd", "16 nodes, he8:2"),
    ("femgv_frd/ccx_pendel.frd", "40 nodes, he20:2"),
    ("femgv_frd/ccx_scheibe2f2f.frd", "1156 nodes, he8:512"),
];

/// Written by hand after the FORMATs of the FEMGV manual: no public file of FEMGV itself was found.
const SHAPES: &str = "two_shapes.neu";

#[test]
fn corpus_files_hold_what_others_count() {
    let Some(corpus) = corpus() else { return };
    for (format, rows) in [(&Femgv as &dyn Format, &NEUTRAL[..]), (&Frd, &RESULTS)] {
        for (name, expected) in rows {
            let mesh = read(format, &corpus.join(name)).unwrap_or_else(|e| panic!("{e}"));
            assert_eq!(holds(&mesh), *expected, "{name}");
        }
        let names: Vec<_> = rows.iter().map(|row| row.0).collect();
        assert_eq!(detected(format, &corpus), names, "{}", format.name());
    }
}

#[test]
fn numbers_touch_and_unknown_types_are_counted() {
    let mesh = read(&Femgv, &own("femgv").join(SHAPES)).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(holds(&mesh), "7 nodes, be2:1 qu4:1 te4:1 type 77:1");
    let tetrahedron = &mesh.elements.iter().find(|e| e.0 == 2).expect("the second element").2;
    assert_eq!(tetrahedron[3], [0.0, 0.0, -1.0], "-1.0 touches the number before");
    let small: String = [
        "    1CPIT\n    2C                                                                    1\n",
        " -1         1-1.00000E+00-2.00000E+00-3.00000E+00\n -1         2 1.00000E+00 0.00000E+00 0.00000E+00\n",
        " -1         3 0.00000E+00 1.00000E+00 0.00000E+00\n -3\n",
        "    3C                                                                    1\n",
        " -1         1    7    1    1    1    1\n -2         1         2\n -2         3\n -3\n 9999\n",
    ]
    .concat();
    let mesh = read_bytes(&Femgv, "a.femgv", small.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(holds(&mesh), "3 nodes, tr3:1", "a record over two lines of nodes");
    assert_eq!(mesh.elements[0].2[0], [-1.0, -2.0, -3.0]);
}

#[test]
fn what_is_wrong_is_named() {
    let head = "    1C\n    2C                                                                    0\n";
    let nodes = " -1    1 0.00000E+00 0.00000E+00 0.00000E+00\n -3\n";
    let elements = "    3C                                                                    0\n";
    let rows: [(String, &str); 7] = [
        (head.replace("0\n", "2\n"), "line 2: binary .frd is not read"),
        (head.replace("0\n", "7\n"), "line 2: expected the form of the data, 0 or 1, in columns 74 and 75"),
        (head.to_owned() + " -2    1\n", "line 3: expected -1 or -3 in columns 2 and 3"),
        (head.to_owned() + " -1    x 0.0\n -3\n" + elements + " -3\n", "line 3: expected a node number"),
        (head.to_owned() + nodes, "expected the data set 3C of elements, found the end of the file"),
        (
            head.to_owned() + nodes + elements + " -1    1    7    1    1\n -2    1    1\n -3\n",
            "line 6: expected 3 nodes of element 1 of type tr3, found 2",
        ),
        (
            head.to_owned() + nodes + elements + " -1    1    7    1    1\n -2    1    1    1\n",
            "expected the end mark -3 of a data set, found the end of the file",
        ),
    ];
    for (text, expected) in rows {
        let error = message(&Femgv, "a.femgv", text.as_bytes());
        assert!(error.contains(expected), "{error}\n{text}");
    }
}

#[test]
fn damaged_files_are_read_or_refused() {
    damage(&Femgv, &own("femgv").join(SHAPES), |_| 780);
}
