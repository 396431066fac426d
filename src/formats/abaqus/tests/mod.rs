//! Whole decks: the corpus and our own output, the quirks, and what is wrong or damaged.

mod corpus;
mod faults;
mod made;
mod parameters;
mod quirks;

use std::path::Path;

use super::Abaqus;
use crate::error::Result;
use crate::formats::Format;
use crate::formats::reading::{Mesh, read};
use crate::formats::testing::{self, corpus, head};
use crate::mesh::Shape::{Hexahedron, Quadrilateral, Tetrahedron, Triangle, Wedge};
use crate::mesh::{Class, Shape};

/// Writes the files into one folder and reads the first.
fn read_files(files: &[(&str, &[u8])]) -> Result<Mesh> {
    testing::read_files(&Abaqus, files[0].0, files)
}

fn read_text(text: &str) -> Result<Mesh> {
    read_files(&[("deck.inp", text.as_bytes())])
}

#[track_caller]
fn mesh(text: &str) -> Mesh {
    read_text(text).unwrap_or_else(|e| panic!("{e}"))
}

/// The error without the folder.
#[track_caller]
fn error(text: &str) -> String {
    let error = read_text(text).expect_err("an error").to_string();
    error.split_once("deck.inp: ").map_or(error.clone(), |(_, rest)| rest.to_owned())
}

/// Elements by type, as `C3D8R:2 CPE4:1`.
fn types(mesh: &Mesh) -> String {
    let types = mesh.ledger.types.iter().map(|t| format!("{}:{}", t.name, t.count));
    types.collect::<Vec<_>>().join(" ")
}

const SQUARE: &str = "*NODE\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n";

const PART: &str =
    "*PART, NAME=Q\n*NODE\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n*ELEMENT, TYPE=S4\n1,1,2,3,4\n*END PART\n";
