//! Whole files: Gmsh's, those of the corpus, and damaged ones.

use super::Unv;
use crate::formats::reading::read;
use crate::formats::testing::{corpus, damage, detected, holds, message, own, read_bytes, same_elements};

const CORPUS: [(&str, &str); 7] = [
    ("unv/dealii_3D.unv", "216 nodes, Plane Stress Linear Quadrilateral:150 Rod:60 Solid Linear Brick:125"),
    (
        "unv/dealii_salome_cube.unv",
        "216 nodes, Plane Stress Linear Quadrilateral:150 Rod:60 Solid Linear Brick:125",
    ),
    ("unv/dealii_salome_square.unv", "36 nodes, Plane Stress Linear Quadrilateral:25 Rod:20"),
    ("unv/dealii_test1427.unv", "72 nodes, Plane Stress Linear Quadrilateral:48 Rod:48"),
    ("unv/dealii_test46.unv", "81 nodes, Plane Stress Linear Quadrilateral:64 Rod:32"),
    (
        "unv/gmsh_mixed.unv",
        "54 nodes, Solid Linear Brick:8 Solid Linear Wedge:28 Thin Shell Linear Quadrilateral:36 Thin Shell Linear Triangle:28",
    ),
    ("unv/gmsh_pit2d_o2.unv", "821 nodes, Parabolic Beam:56 Thin Shell Parabolic Triangle:382"),
];

#[test]
fn corpus_files_hold_what_others_count() {
    let Some(corpus) = corpus() else { return };
    for (name, expected) in CORPUS {
        let mesh = read(&Unv, &corpus.join(name)).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(holds(&mesh), expected, "{name}");
    }
    assert_eq!(detected(&Unv, &corpus), CORPUS.map(|row| row.0));
}

#[test]
fn gmsh_writes_the_same_mesh_here_as_in_its_own_format() {
    for (name, msh) in [("mixed.unv", "mixed_hex_prism_41.msh"), ("pit2d_o2.unv", "pit2d_o2_41_ascii.msh")] {
        let mesh = read(&Unv, &own("unv").join(format!("gmsh_{name}"))).unwrap_or_else(|e| panic!("{e}"));
        let native =
            read(&crate::formats::gmsh::Gmsh, &own("gmsh").join(msh)).unwrap_or_else(|e| panic!("{e}"));
        same_elements(&mesh, &native, 1e-6);
    }
}

/// A dataset of the given number and records.
fn dataset(number: &str, records: &[&str]) -> String {
    format!("    -1\n{number:>6}\n{}\n    -1\n", records.join("\n"))
}

fn integers(values: &[u64]) -> String {
    values.iter().map(|v| format!("{v:>10}")).collect()
}

/// Nodes 1 to `count` of dataset 2411, at x = number, y = its square, z = its cube.
fn nodes(count: u64) -> String {
    let record = |k: u64| {
        let [x, y, z] = [1, 2, 3].map(|p| format!("{:25.16E}", (k as f64).powi(p)));
        format!("{}\n{x}{y}{z}", integers(&[k, 1, 1, 11]))
    };
    dataset(
        "2411",
        &(1..=count).map(record).collect::<Vec<_>>().iter().map(String::as_str).collect::<Vec<_>>(),
    )
}

#[test]
fn corners_of_parabolic_solids_stand_on_their_rings() {
    // Descriptor, number of nodes, places of the corners from 1.
    for (descriptor, count, expected) in [
        (118, 10, &[1, 3, 5, 10][..]),
        (113, 15, &[1, 3, 5, 10, 12, 14]),
        (116, 20, &[1, 3, 5, 7, 13, 15, 17, 19]),
        (95, 8, &[1, 3, 5, 7]),
    ] {
        let ids: Vec<u64> = (1..=count).collect();
        let lines: Vec<_> = ids.chunks(8).map(integers).collect();
        let mut records = vec![integers(&[1, descriptor, 1, 1, 7, count])];
        records.extend(lines);
        let records: Vec<_> = records.iter().map(String::as_str).collect();
        // Elements before nodes, and words between datasets, are legal.
        let text = format!("{}made by hand\n{}", dataset("2412", &records), nodes(20));
        let mesh = read_bytes(&Unv, "a.unv", text.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
        let corners: Vec<_> = mesh.elements[0].2.iter().map(|p| p[0] as u64).collect();
        assert_eq!(corners, expected, "{descriptor}");
    }
}

#[test]
fn old_datasets_are_read() {
    let node = |k: u64, x: &str| format!("{}{x}", integers(&[k, 0, 0, 11]));
    let old = [
        node(1, "  0.00000E+00  0.00000E+00  0.00000E+00"),
        node(2, "  1.00000E+00 -1.00000E+00  0.00000E+00"),
        node(3, "  0.00000E+00  1.00000E+00  0.00000E+00"),
    ];
    let old = dataset("15", &old.iter().map(String::as_str).collect::<Vec<_>>());
    let triangle_71 = dataset("71", &[&integers(&[7, 91, 1, 1, 1, 7, 3]), &integers(&[1, 2, 3])]);
    let triangle_780 = dataset("780", &[&integers(&[7, 91, 1, 1, 1, 1, 7, 3]), &integers(&[1, 2, 3])]);
    for elements in [triangle_71, triangle_780] {
        let mesh = read_bytes(&Unv, "a.unv", format!("{old}{elements}").as_bytes())
            .unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(holds(&mesh), "3 nodes, Thin Shell Linear Triangle:1");
        assert_eq!(mesh.elements[0].2[1], [1.0, -1.0, 0.0]);
    }
}

#[test]
fn a_count_that_its_descriptor_does_not_have_is_never_guessed() {
    let ids: Vec<u64> = (1..=27).collect();
    let lines: Vec<_> = ids.chunks(8).map(integers).collect();
    let mut records = vec![integers(&[1, 115, 1, 1, 7, 27])];
    records.extend(lines);
    records.extend([integers(&[2, 300, 1, 1, 7, 2]), integers(&[1, 2])]);
    records.extend([integers(&[3, 122, 1, 1, 7, 9]), integers(&ids[..8]), integers(&[9])]);
    let records: Vec<_> = records.iter().map(String::as_str).collect();
    let text = nodes(27) + &dataset("2412", &records);
    let mesh = read_bytes(&Unv, "a.unv", text.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(holds(&mesh), "27 nodes, Rigid Element:1 Solid Linear Brick of 27 nodes:1 descriptor 300:1");
}

#[test]
fn what_is_wrong_is_named() {
    let triangle = dataset("2412", &[&integers(&[1, 91, 1, 1, 7, 3]), &integers(&[1, 2, 3])]);
    let rows = [
        (nodes(3), "expected a dataset of elements: 2412, 780 or 71, found the end of the file"),
        (
            nodes(3) + triangle.trim_end().trim_end_matches("-1").trim_end_matches(' '),
            "the line -1 that ends a dataset",
        ),
        (
            nodes(3) + &dataset("2412", &[&integers(&[1, 91, 1, 1, 7, 9]), &integers(&[1, 2, 3])]),
            "line 14: expected 9 nodes of element 1, found \"    -1\"",
        ),
        (
            nodes(3) + &dataset("2412", &[&integers(&[1, 91, 1, 1, 7, u64::MAX >> 31])]),
            "line 12: number of nodes of an element is over the limit",
        ),
        (
            nodes(3) + &triangle.replace("         2         3\n", "         2        3x\n"),
            "expected a node number in columns 21 to 30, found \"        3x\"",
        ),
        (format!("{}    -1\n    58b     1     2\n", nodes(1)), "line 7: binary datasets (58b) are not read"),
    ];
    for (text, expected) in rows {
        let error = message(&Unv, "a.unv", text.as_bytes());
        assert!(error.contains(expected), "{error}\n{text}");
    }
}

#[test]
fn damaged_files_are_read_or_refused() {
    // Groups follow the elements.
    damage(&Unv, &own("unv").join("gmsh_mixed.unv"), |_| 16_000);
}
