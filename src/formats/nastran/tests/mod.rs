//! Whole decks: the corpus and our own output, the quirks, and what is wrong or damaged.

mod corpus;
mod faults;
mod quirks;

use std::path::Path;

use super::Nastran;
use crate::error::Result;
use crate::formats::reading::{Mesh, read};
use crate::formats::testing::{self, corpus, head};
use crate::formats::{FORMATS, Format};
use crate::input::{Input, Limits, Scratch};
use crate::mesh::Class;
use crate::mesh::Shape::{self, Hexahedron, Quadrilateral, Tetrahedron, Triangle, Wedge};

/// Writes the files into one folder and reads the first.
fn read_files(files: &[(&str, &[u8])]) -> Result<Mesh> {
    testing::read_files(&Nastran, files[0].0, files)
}

#[track_caller]
fn mesh(text: &str) -> Mesh {
    read_files(&[("deck.bdf", text.as_bytes())]).unwrap_or_else(|e| panic!("{e}"))
}

/// The error without the folder.
#[track_caller]
fn error(text: &str) -> String {
    let error = read_files(&[("deck.bdf", text.as_bytes())]).expect_err(text).to_string();
    error.split_once("deck.bdf: ").map_or(error.clone(), |(_, rest)| rest.to_owned())
}

/// Elements by card, as `CHEXA:2 CQUAD4:1`, sorted.
fn types(mesh: &Mesh) -> String {
    let mut types = std::collections::BTreeMap::<&str, u64>::new();
    for row in mesh.ledger.types.iter().filter(|row| row.count > 0) {
        *types.entry(&row.name).or_default() += row.count;
    }
    types.iter().map(|(name, count)| format!("{name}:{count}")).collect::<Vec<_>>().join(" ")
}

/// Number of measured elements of that order.
fn of_order(mesh: &Mesh, order: u8) -> u64 {
    let is = |class: &Class| matches!(class, Class::Measured { order: found, .. } if *found == order);
    mesh.ledger.types.iter().filter(|row| is(&row.class)).map(|row| row.count).sum()
}

fn node(mesh: &Mesh, id: u64) -> [f64; 3] {
    mesh.nodes.rows()[mesh.nodes.row(id).expect("a node") as usize]
}

#[track_caller]
fn assert_near(found: [f64; 3], expected: [f64; 3]) {
    for k in 0..3 {
        assert!((found[k] - expected[k]).abs() < 1e-9, "{found:?} is not {expected:?}");
    }
}

/// Six times the volume of the tetrahedron at the first corner of a solid.
fn at_first_corner(shape: Shape, c: &[[f64; 3]]) -> f64 {
    let d = |k: usize| [0, 1, 2].map(|i| c[k][i] - c[0][i]);
    let (a, b, c) = match shape {
        Hexahedron => (d(1), d(3), d(4)),
        _ => (d(1), d(2), d(3)),
    };
    a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// Four nodes of a unit square.
const SQUARE: &str = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\n";
