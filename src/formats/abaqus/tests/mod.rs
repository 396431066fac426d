//! Whole decks: the corpus and our own output, the quirks, and what is wrong or damaged.

mod corpus;
mod faults;
mod quirks;

use std::path::{Path, PathBuf};

use super::Abaqus;
use crate::error::Result;
use crate::formats::reading::{Mesh, read};
use crate::formats::{Format, HEAD_BYTES};
use crate::input::{Input, Limits, Scratch};
use crate::mesh::Shape::{Hexahedron, Quadrilateral, Tetrahedron, Triangle, Wedge};
use crate::mesh::{Class, Shape};

/// Writes the files into one folder and reads the first.
fn read_files(files: &[(&str, &[u8])]) -> Result<Mesh> {
    let folder = tempfile::tempdir().expect("a scratch folder");
    for (name, text) in files {
        std::fs::write(folder.path().join(name), text).expect("written");
    }
    read(&Abaqus, &folder.path().join(files[0].0))
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

fn corpus() -> Option<PathBuf> {
    let folder = std::env::var_os("MESHGAUGE_CORPUS").map(PathBuf::from);
    if folder.is_none() {
        eprintln!("skipped: MESHGAUGE_CORPUS is not set");
    }
    folder
}

/// The first bytes of a file, as detection sees them.
fn head(path: &Path) -> Vec<u8> {
    let scratch = Scratch::new(&std::env::temp_dir(), 1 << 30);
    let input = Input::open(path, &Limits::default(), &scratch).expect("a file of the corpus");
    input.source.peek(0..HEAD_BYTES as u64).to_vec()
}

const SQUARE: &str = "*NODE\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n";

const PART: &str =
    "*PART, NAME=Q\n*NODE\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n*ELEMENT, TYPE=S4\n1,1,2,3,4\n*END PART\n";
