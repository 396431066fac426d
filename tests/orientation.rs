//! Which elements count as inverted: those against the rest of their mesh, whatever sense the writer follows.

#![allow(clippy::unwrap_used)]

use std::io::Write;

use meshgauge::mesh::Shape;
use meshgauge::{Options, Summary};

/// A cube with a wedge on half of its top. `wedge` are the wedge's corners among the points.
const POINTS: [[f64; 3]; 11] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [1.0, 1.0, 1.0],
    [0.0, 1.0, 1.0],
    [0.0, 0.0, 2.0],
    [1.0, 0.0, 2.0],
    [1.0, 1.0, 2.0],
];
const UPRIGHT: [usize; 6] = [4, 5, 6, 8, 9, 10];
const TURNED: [usize; 6] = [4, 6, 5, 8, 10, 9];

fn list(items: impl IntoIterator<Item = usize>, separator: &str) -> String {
    items.into_iter().map(|i| i.to_string()).collect::<Vec<_>>().join(separator)
}

fn abaqus(wedge: [usize; 6]) -> String {
    let mut text = "*NODE\n".to_owned();
    for (k, [x, y, z]) in POINTS.iter().enumerate() {
        text += &format!("{}, {x}, {y}, {z}\n", k + 1);
    }
    text += &format!("*ELEMENT, TYPE=C3D8\n1, {}\n", list(1..=8, ", "));
    text + &format!("*ELEMENT, TYPE=C3D6\n2, {}\n", list(wedge.map(|c| c + 1), ", "))
}

fn vtk(wedge: [usize; 6]) -> String {
    let mut text =
        "# vtk DataFile Version 3.0\ncube and wedge\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 11 double\n"
            .to_owned();
    for [x, y, z] in POINTS {
        text += &format!("{x} {y} {z}\n");
    }
    text += &format!("CELLS 2 16\n8 {}\n6 {}\n", list(0..8, " "), list(wedge, " "));
    text + "CELL_TYPES 2\n12\n13\n"
}

fn score(text: &str) -> Summary {
    let mut file = tempfile::NamedTempFile::new().unwrap();
    file.write_all(text.as_bytes()).unwrap();
    meshgauge::score(file.path(), &Options::default()).unwrap()
}

#[test]
fn a_wedge_against_its_mesh_is_inverted() {
    let sound = score(&abaqus(UPRIGHT));
    assert_eq!((sound.checks.inverted, sound.checks.reversed), (0, 0));
    let turned = score(&abaqus(TURNED));
    assert_eq!((turned.shapes[&Shape::Wedge].inverted, turned.shapes[&Shape::Hexahedron].inverted), (1, 0));
    assert_eq!(turned.verdict.reasons[0].element, Some(2));
    assert_eq!(turned.totals.volume, sound.totals.volume);
}

#[test]
fn wedges_of_vtk_are_sound_in_either_sense() {
    for (wedge, reversed) in [(UPRIGHT, 0), (TURNED, 1)] {
        let summary = score(&vtk(wedge));
        assert_eq!((summary.checks.inverted, summary.checks.reversed), (0, reversed));
    }
}
