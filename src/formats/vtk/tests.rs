use std::path::{Path, PathBuf};

use super::{Legacy, Vtu};
use crate::error::Result;
use crate::formats::Format;
use crate::formats::reading::{Mesh, read};
use crate::mesh::{Class, Shape};

/// The checked-in meshes: every cell type of VTK, written by VTK's own writers in several encodings.
fn own() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes/vtk");
    let mut files: Vec<_> = std::fs::read_dir(folder).expect("tests/meshes/vtk").flatten().map(|e| e.path()).collect();
    files.retain(|file| file.extension().is_some_and(|e| e == "vtk" || e == "vtu"));
    files.sort();
    assert!(files.len() >= 8, "{files:?}");
    files
}

fn read_any(path: &Path) -> Result<Mesh> {
    let format: &dyn Format = if path.extension().is_some_and(|e| e == "vtk") { &Legacy } else { &Vtu };
    read(format, path)
}

/// The text or bytes of a file, read as a mesh.
fn read_bytes(format: &dyn Format, bytes: &[u8]) -> Result<Mesh> {
    let file = tempfile::NamedTempFile::new().expect("a temporary file");
    std::fs::write(file.path(), bytes).expect("a temporary file");
    read(format, file.path())
}

/// Measured cells by shape.
fn shapes(mesh: &Mesh) -> Vec<(&'static str, usize)> {
    Shape::ALL.into_iter().map(|s| (s.name(), mesh.count(s))).filter(|row| row.1 > 0).collect()
}

fn counted(mesh: &Mesh) -> u64 {
    mesh.ledger.types.iter().filter(|t| matches!(t.class, Class::Counted(_))).map(|t| t.count).sum()
}

fn checksum(mesh: &Mesh) -> f64 {
    let corner = |p: &[f64; 3]| p[0] + 2.0 * p[1] + 3.0 * p[2];
    let cell = |label: u64, corners: &[[f64; 3]]| {
        let sum: f64 = corners.iter().enumerate().map(|(k, p)| (k + 1) as f64 * corner(p)).sum();
        (label % 7 + 1) as f64 * sum
    };
    mesh.elements.iter().map(|(label, _, corners)| cell(*label, corners)).sum()
}

/// Holds the files of a folder against its `expected.jsonl`; gives their number.
fn check_folder(folder: &Path) -> usize {
    let expected = std::fs::read_to_string(folder.join("expected.jsonl")).expect("expected.jsonl");
    let mut wrong = Vec::new();
    for line in expected.lines() {
        let row: serde_json::Value = serde_json::from_str(line).expect("JSON");
        let name = row["file"].as_str().expect("file");
        let mesh = match read_any(&folder.join(name)) {
            Ok(mesh) => mesh,
            Err(error) => {
                wrong.push(format!("{name}: {error}"));
                continue;
            }
        };
        if let Some(nodes) = row["nodes"].as_u64() {
            assert_eq!(mesh.nodes.count(), nodes, "{name}");
        }
        assert_eq!(counted(&mesh), row["counted"].as_u64().expect("counted"), "{name}");
        for shape in Shape::ALL {
            let count = row["shapes"][shape.name()].as_u64().unwrap_or(0);
            assert_eq!(mesh.count(shape) as u64, count, "{name}: {shape}");
        }
        if let Some(sum) = row["checksum"].as_f64() {
            let turned = row["checksum_of_turned_wedges"].as_f64();
            let found = checksum(&mesh);
            assert!(found == sum || Some(found) == turned, "{name}: {found}, not {sum}");
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    expected.lines().count()
}

#[test]
fn what_vtk_and_meshio_write_is_read() {
    let Some(python) = std::env::var_os("MESHGAUGE_PEERS_PYTHON") else {
        eprintln!("skipped: MESHGAUGE_PEERS_PYTHON names no Python with vtk, meshio and numpy");
        return;
    };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/peers/vtk_family.py");
    let status = std::process::Command::new(python).arg(script).arg(folder.path()).status();
    assert!(status.expect("Python").success());
    assert!(check_folder(folder.path()) > 300);
}

#[test]
fn own_files_are_read() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes/vtk");
    assert_eq!(check_folder(&folder), own().len());
}
