//! The reader against files of Gmsh and others, against hand-made files of every odd kind, and against damage.

#![expect(clippy::disallowed_methods, reason = "meshes of known size are read whole, to be cut and damaged")]

mod written;

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::Gmsh;
use crate::error::{At, Result};
use crate::formats::Format;
use crate::formats::reading::{Mesh, read};
use crate::mesh::Shape::{self, Hexahedron, Quadrilateral, Triangle, Wedge};

/// Reads `bytes` as a file.
fn read_bytes(bytes: &[u8]) -> Result<Mesh> {
    let mut file = tempfile::NamedTempFile::new().expect("a temporary file");
    file.write_all(bytes).expect("a temporary file");
    read(&Gmsh, file.path())
}

fn message(bytes: &[u8]) -> String {
    let error = read_bytes(bytes).expect_err("an error");
    let text = error.to_string();
    let path = error.path().map(|p| format!("{}: ", p.display())).unwrap_or_default();
    text.trim_start_matches(&path).to_owned()
}

/// Number of elements that are not measured, under the name `what`.
fn counted(mesh: &Mesh, what: &str) -> u64 {
    let is = |class: &crate::mesh::Class| *class == crate::mesh::Class::Counted(what.to_owned().into());
    mesh.ledger.types.iter().filter(|t| is(&t.class)).map(|t| t.count).sum()
}

fn own(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes/gmsh").join(name)
}

/// The folder that a variable of the environment names, or nothing, said aloud.
fn folder(variable: &str) -> Option<PathBuf> {
    let folder = std::env::var_os(variable).map(PathBuf::from);
    if folder.is_none() {
        eprintln!("skipped: {variable} names no folder");
    }
    folder
}

/// Two sums over all corners, by which a peer's mesh is known: see tests/peers/gmsh_encodings.py.
fn sums(mesh: &Mesh) -> (f64, f64) {
    let (mut sum, mut squares) = (0.0, 0.0);
    for (_, _, corners) in &mesh.elements {
        for (k, p) in corners.iter().enumerate() {
            let s = (k + 1) as f64 * (p[0] + 2.0 * p[1] + 3.0 * p[2]);
            sum += s;
            squares += s * s;
        }
    }
    (sum, squares)
}

type Row = (&'static str, u64, &'static [(Shape, usize)], &'static [(&'static str, u64)]);

/// File, nodes, measured elements, counted elements.
const OWN: &[Row] = &[
    ("mixed_hex_prism_41.msh", 54, &[(Quadrilateral, 36), (Triangle, 28), (Hexahedron, 8), (Wedge, 28)], &[]),
    ("pit2d_22_ascii.msh", 220, &[(Triangle, 382)], &[("line", 56)]),
    ("pit2d_22_bin.msh", 220, &[(Triangle, 382)], &[("line", 56)]),
    ("pit2d_40_ascii.msh", 220, &[(Triangle, 382)], &[("line", 56)]),
    ("pit2d_41_ascii.msh", 220, &[(Triangle, 382)], &[("line", 56)]),
    ("pit2d_41_bin.msh", 220, &[(Triangle, 382)], &[("line", 56)]),
    ("pit2d_41_parametric_bin.msh", 220, &[(Triangle, 382)], &[("line", 56)]),
    ("pit2d_o2_41_ascii.msh", 821, &[(Triangle, 382)], &[("line", 56)]),
];

const CORPUS: &[Row] = &[
    ("dealii_3d_neg_v40.msh", 8, &[(Quadrilateral, 6), (Hexahedron, 1)], &[]),
    ("dealii_3da_v41.msh", 462, &[(Quadrilateral, 460), (Hexahedron, 200)], &[]),
    ("dealii_v1.msh", 64, &[(Quadrilateral, 49)], &[("line", 28), ("point", 4)]),
    ("dealii_v2_commented.msh", 109, &[(Quadrilateral, 81)], &[]),
    ("dealii_v4_hole81.msh", 109, &[(Quadrilateral, 81)], &[]),
    ("gmsh_hybrid_part.msh", 401, &[(Triangle, 720)], &[("line", 80), ("point", 4)]),
    ("gmsh_partitions.msh", 133, &[(Triangle, 228)], &[("line", 36)]),
    ("mfem_compass.msh", 13, &[(Triangle, 8), (Quadrilateral, 4)], &[("line", 8)]),
    ("mfem_periodic-cube.msh", 125, &[(Quadrilateral, 96), (Hexahedron, 64)], &[]),
    ("palace_coaxial.msh", 3168, &[(Quadrilateral, 544), (Hexahedron, 256)], &[]),
    ("palace_cylinder_hex.msh", 801, &[(Quadrilateral, 72), (Hexahedron, 80)], &[]),
    ("palace_cylinder_prism.msh", 549, &[(Triangle, 48), (Quadrilateral, 48), (Wedge, 96)], &[]),
    ("pynastran_shelf.msh", 72, &[(Quadrilateral, 44)], &[("line", 8)]),
    ("synthetic_22_bin_no_newline.msh", 220, &[(Triangle, 382)], &[("line", 56)]),
];

fn check(folder: &Path, (name, nodes, measured, others): &Row) {
    let mesh = read(&Gmsh, &folder.join(name)).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(mesh.nodes.count(), *nodes, "{name}");
    for shape in Shape::ALL {
        let count = measured.iter().find(|m| m.0 == shape).map_or(0, |m| m.1);
        assert_eq!(mesh.count(shape), count, "{name}: {shape}");
    }
    for (what, count) in *others {
        assert_eq!(counted(&mesh, what), *count, "{name}: {what}");
    }
    let total = mesh.elements.len() as u64 + others.iter().map(|o| o.1).sum::<u64>();
    assert_eq!(mesh.ledger.types.iter().map(|t| t.count).sum::<u64>(), total, "{name}");
}

#[test]
fn own_files_hold_what_gmsh_counts() {
    OWN.iter().for_each(|row| check(&own(""), row));
    let order = read(&Gmsh, &own("pit2d_o2_41_ascii.msh")).expect("readable").ledger;
    let triangles = order.types.iter().find(|t| t.name == "Triangle 6").expect("its triangles");
    assert!(matches!(triangles.class, crate::mesh::Class::Measured { order: 2, .. }));
}

#[test]
fn one_mesh_in_six_encodings_is_one_mesh() {
    let meshes: Vec<_> = OWN[1..7].iter().map(|row| read(&Gmsh, &own(row.0)).expect("readable")).collect();
    for (mesh, row) in meshes.iter().zip(&OWN[1..7]) {
        assert_eq!(mesh.elements.len(), meshes[0].elements.len());
        for (theirs, ours) in mesh.elements.iter().zip(&meshes[0].elements) {
            assert_eq!((theirs.0, theirs.1), (ours.0, ours.1), "{}", row.0);
            for (p, q) in theirs.2.iter().flatten().zip(ours.2.iter().flatten()) {
                assert!((p - q).abs() < 1e-14, "{}: {p} {q}", row.0);
            }
        }
    }
}

#[test]
fn corpus_files_hold_what_others_count() {
    let Some(corpus) = folder("MESHGAUGE_CORPUS") else { return };
    CORPUS.iter().chain(OWN).for_each(|row| check(&corpus.join("gmsh"), row));
}

#[test]
fn only_gmsh_files_of_the_corpus_are_detected() {
    let Some(corpus) = folder("MESHGAUGE_CORPUS") else { return };
    let mut folders = vec![corpus];
    let mut detected = 0;
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder").map(|e| e.expect("an entry").path()) {
            if entry.is_dir() {
                folders.push(entry);
                continue;
            }
            let bytes = fs::read(&entry).expect("readable");
            let ours = entry.extension().is_some_and(|e| e == "msh");
            let head = &bytes[..bytes.len().min(crate::formats::HEAD_BYTES)];
            assert_eq!(Gmsh.detect(head), ours, "{}", entry.display());
            detected += usize::from(ours);
        }
    }
    assert_eq!(detected, CORPUS.len() + OWN.len());
}

#[test]
fn every_encoding_that_peers_write_is_read_as_they_see_it() {
    let Some(python) = std::env::var_os("MESHGAUGE_PYTHON") else {
        eprintln!("skipped: MESHGAUGE_PYTHON names no Python with gmsh and meshio");
        return;
    };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let folder = folder.path();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/peers/gmsh_encodings.py");
    let status = std::process::Command::new(python).arg(script).arg(folder).status();
    assert!(status.expect("Python").success());
    let rows = fs::read_to_string(folder.join("expected.jsonl")).expect("expected.jsonl");
    for row in rows.lines() {
        let row: Value = serde_json::from_str(row).expect("a row");
        let name = row["file"].as_str().expect("a name");
        let mesh = read(&Gmsh, &folder.join(name)).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(Some(mesh.nodes.count()), row["nodes"].as_u64(), "{name}");
        for shape in Shape::ALL {
            let count = row["shapes"][shape.name()].as_u64().unwrap_or(0);
            assert_eq!(mesh.count(shape) as u64, count, "{name}: {shape}");
        }
        let (sum, squares) = sums(&mesh);
        let near = |ours: f64, key: &str| (ours / row[key].as_f64().expect("a sum") - 1.0).abs() < 1e-12;
        assert!(near(sum, "sum") && near(squares, "squares"), "{name}: {sum} {squares} {row}");
    }
}

/// Numbers that are the same in every run.
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % end as u64) as usize
    }
}

fn damage(folder: &Path, row: &Row) {
    let bytes = fs::read(folder.join(row.0)).expect("readable");
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let sections = [&b"$EndElements"[..], b"$ENDELM"]
        .map(|end| memchr::memmem::rfind(&bytes, end).map(|k| k + end.len()));
    let whole = sections.into_iter().flatten().max().expect("the end of the elements");
    for _ in 0..50 {
        let cut = random.below(whole);
        let error = read_bytes(&bytes[..cut]).expect_err(&format!("{} cut at {cut}", row.0));
        assert!(
            error.path().is_some() && matches!(error.place(), Some(At::Line(_) | At::Byte(_))),
            "{error}"
        );
    }
    for _ in 0..200 {
        let mut flipped = bytes.clone();
        flipped[random.below(bytes.len())] ^= 1 << random.below(8);
        if let Err(error) = read_bytes(&flipped) {
            assert!(error.path().is_some() && error.place().is_some(), "{}: {error}", row.0);
        }
    }
}

#[test]
fn a_cut_file_is_an_error_and_a_flipped_bit_no_panic() {
    OWN.iter().for_each(|row| damage(&own(""), row));
}

#[test]
fn damaged_corpus_files_are_errors_too() {
    let Some(corpus) = folder("MESHGAUGE_CORPUS") else { return };
    CORPUS.iter().for_each(|row| damage(&corpus.join("gmsh"), row));
}
