//! What the tests of several formats do with a file: hold it against known counts, cut it and flip its bits.

#![expect(clippy::disallowed_methods, reason = "meshes of known size are read whole, to be cut and damaged")]

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use super::reading::{Mesh, read};
use super::{Format, HEAD_BYTES};
use crate::error::Result;
use crate::mesh::{Class, Shape};

/// File, nodes, measured elements, counted elements.
pub(super) type Row = (&'static str, u64, &'static [(Shape, usize)], &'static [(&'static str, u64)]);

/// The folder of meshes that are not ours, or nothing, said aloud.
pub(super) fn corpus() -> Option<PathBuf> {
    let folder = std::env::var_os("MESHGAUGE_CORPUS").map(PathBuf::from);
    if folder.is_none() {
        eprintln!("skipped: MESHGAUGE_CORPUS names no folder");
    }
    folder
}

/// Our own meshes of a format.
pub(super) fn own(format: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes").join(format)
}

/// Reads `bytes` as a file whose name ends in `suffix`.
pub(super) fn read_bytes(format: &dyn Format, suffix: &str, bytes: &[u8]) -> Result<Mesh> {
    let mut file = tempfile::Builder::new().suffix(suffix).tempfile().expect("a temporary file");
    file.write_all(bytes).expect("a temporary file");
    read(format, file.path())
}

/// The error of `bytes`, without the name of the file.
pub(super) fn message(format: &dyn Format, bytes: &[u8]) -> String {
    let error = read_bytes(format, "", bytes).expect_err("an error");
    let path = error.path().map(|p| format!("{}: ", p.display())).unwrap_or_default();
    error.to_string().trim_start_matches(&path).to_owned()
}

/// Number of elements that are not measured, under the name `what`.
pub(super) fn counted(mesh: &Mesh, what: &str) -> u64 {
    let is = |class: &Class| *class == Class::Counted(what.to_owned().into());
    mesh.ledger.types.iter().filter(|t| is(&t.class)).map(|t| t.count).sum()
}

/// Reads the file of a row and holds it against the row.
pub(super) fn check(format: &dyn Format, folder: &Path, (name, nodes, measured, others): &Row) -> Mesh {
    let mesh = read(format, &folder.join(name)).unwrap_or_else(|e| panic!("{e}"));
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
    mesh
}

/// Two sums over the corners of a shape's elements, by which one mesh in two formats is known.
pub(super) fn sums(mesh: &Mesh, shape: Shape) -> (f64, f64) {
    let (mut sum, mut squares) = (0.0, 0.0);
    for (_, _, corners) in mesh.elements.iter().filter(|e| e.1 == shape) {
        for (k, p) in corners.iter().enumerate() {
            let s = (k + 1) as f64 * (p[0] + 2.0 * p[1] + 3.0 * p[2]);
            sum += s;
            squares += s * s;
        }
    }
    (sum, squares)
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

/// Cuts the first `whole` bytes of a file at 50 places, each of which must be an error, and flips 200 bits.
pub(super) fn damage(format: &dyn Format, path: &Path, whole: impl Fn(&[u8]) -> usize) {
    let bytes = fs::read(path).expect("readable");
    let name = path.file_name().and_then(|n| n.to_str()).expect("a name");
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    for _ in 0..50 {
        let cut = random.below(whole(&bytes));
        let Err(error) = read_bytes(format, name, &bytes[..cut]) else { panic!("{name} cut at {cut}") };
        assert!(error.path().is_some(), "{name} cut at {cut}: {error}");
    }
    for _ in 0..200 {
        let mut flipped = bytes.clone();
        flipped[random.below(bytes.len())] ^= 1 << random.below(8);
        if let Err(error) = read_bytes(format, name, &flipped) {
            assert!(error.path().is_some(), "{name}: {error}");
        }
    }
}

/// The files of the corpus that a format takes for its own, by folder and name. Compressed files are not looked into.
pub(super) fn detected(format: &dyn Format, corpus: &Path) -> Vec<String> {
    let (mut folders, mut found) = (vec![corpus.to_owned()], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder").map(|e| e.expect("an entry").path()) {
            if entry.is_dir() {
                folders.push(entry);
                continue;
            }
            let bytes = fs::read(&entry).expect("readable");
            if format.detect(&bytes[..bytes.len().min(HEAD_BYTES)]) {
                found.push(entry.strip_prefix(corpus).expect("it is inside").display().to_string());
            }
        }
    }
    found.sort();
    found
}
