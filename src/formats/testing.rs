//! What the formats' own tests do alike: read bytes as a file, hold counts against known ones, damage a file.

#![expect(clippy::disallowed_methods, reason = "meshes of known size are read whole, to be cut and damaged")]

use std::fs;
use std::path::{Path, PathBuf};

use super::reading::{Mesh, read};
use super::{Format, HEAD_BYTES};
use crate::error::Result;
use crate::input::{Input, Limits, Scratch};
use crate::mesh::{Class, Shape};

/// A file, its nodes, its measured elements by shape, and others by what they are.
pub(super) type Row = (&'static str, u64, &'static [(Shape, usize)], &'static [(&'static str, u64)]);

/// The folder of third-party meshes, or nothing, said aloud.
pub(super) fn corpus() -> Option<PathBuf> {
    let folder = std::env::var_os("MESHGAUGE_CORPUS").map(PathBuf::from);
    if folder.is_none() {
        eprintln!("skipped: MESHGAUGE_CORPUS names no folder");
    }
    folder
}

/// The folder of our own meshes of a format.
pub(super) fn own(format: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes").join(format)
}

/// Reads a file that must be readable.
#[track_caller]
pub(super) fn read_file(format: &dyn Format, path: &Path) -> Mesh {
    read(format, path).unwrap_or_else(|e| panic!("{e}"))
}

/// Reads `bytes` as a file of that name.
pub(super) fn read_bytes(format: &dyn Format, name: &str, bytes: &[u8]) -> Result<Mesh> {
    read_files(format, name, &[(name, bytes)])
}

/// Reads the file `main` among files of one folder.
pub(super) fn read_files(format: &dyn Format, main: &str, files: &[(&str, &[u8])]) -> Result<Mesh> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, bytes) in files {
        fs::write(folder.path().join(name), bytes).expect("a temporary file");
    }
    read(format, &folder.path().join(main))
}

/// The error of a file without its folder and name.
#[track_caller]
pub(super) fn message(format: &dyn Format, name: &str, bytes: &[u8]) -> String {
    let error = read_bytes(format, name, bytes).expect_err("an error");
    let path = error.path().map(|p| format!("{}: ", p.display())).unwrap_or_default();
    error.to_string().trim_start_matches(&path).to_owned()
}

/// Number of elements that are not measured, under the name `what`.
pub(super) fn counted(mesh: &Mesh, what: &str) -> u64 {
    let is = |class: &Class| *class == Class::Counted(what.to_owned().into());
    mesh.ledger.types.iter().filter(|t| is(&t.class)).map(|t| t.count).sum()
}

/// Nodes and elements by type, as `8 nodes, C3D8:1 line:2`.
pub(super) fn holds(mesh: &Mesh) -> String {
    let mut types: Vec<_> = mesh.ledger.types.iter().map(|t| format!("{}:{}", t.name, t.count)).collect();
    types.sort();
    format!("{} nodes, {}", mesh.nodes.count(), types.join(" "))
}

/// Reads the file of a row and holds it against the row.
pub(super) fn check(format: &dyn Format, folder: &Path, (name, nodes, measured, others): &Row) -> Mesh {
    let mesh = read_file(format, &folder.join(name));
    assert_eq!(mesh.nodes.count(), *nodes, "{name}");
    for shape in Shape::ALL {
        let count = measured.iter().find(|m| m.0 == shape).map_or(0, |m| m.1);
        assert_eq!(mesh.count(shape), count, "{name}: {shape}");
    }
    others.iter().for_each(|(what, count)| assert_eq!(counted(&mesh, what), *count, "{name}: {what}"));
    let total = mesh.elements.len() as u64 + others.iter().map(|o| o.1).sum::<u64>();
    assert_eq!(mesh.ledger.types.iter().map(|t| t.count).sum::<u64>(), total, "{name}");
    mesh
}

/// Coordinates of the corners of a shape's elements, in file order.
pub(super) fn corners(mesh: &Mesh, shape: Shape) -> Vec<f64> {
    let of_shape = mesh.elements.iter().filter(|e| e.1 == shape);
    of_shape.flat_map(|e| e.2.iter().flatten().copied()).collect()
}

/// Both meshes have the same elements, shape by shape and corner by corner, to `tolerance`; numbers may differ.
#[track_caller]
pub(super) fn same_elements(ours: &Mesh, theirs: &Mesh, tolerance: f64) {
    assert_eq!(ours.elements.len(), theirs.elements.len());
    for shape in Shape::ALL {
        let (ours, theirs) = (corners(ours, shape), corners(theirs, shape));
        assert_eq!(ours.len(), theirs.len(), "{shape}");
        for (k, (p, q)) in ours.iter().zip(&theirs).enumerate() {
            assert!((p - q).abs() <= tolerance, "{shape}: coordinate {k}: {p} {q}");
        }
    }
}

/// The files beneath `folder` that a format takes for its own, sorted. Compressed files are not looked into.
pub(super) fn detected(format: &dyn Format, folder: &Path) -> Vec<String> {
    let (mut folders, mut found) = (vec![folder.to_owned()], Vec::new());
    while let Some(inner) = folders.pop() {
        for entry in fs::read_dir(inner).expect("a folder").map(|e| e.expect("an entry").path()) {
            if entry.is_dir() {
                folders.push(entry);
                continue;
            }
            let bytes = fs::read(&entry).expect("readable");
            if format.detect(&bytes[..bytes.len().min(HEAD_BYTES)]) {
                found.push(entry.strip_prefix(folder).expect("it is inside").display().to_string());
            }
        }
    }
    found.sort();
    found
}

/// The first bytes of a file, unpacked, as detection sees them.
pub(super) fn head(path: &Path) -> Vec<u8> {
    let scratch = Scratch::new(&std::env::temp_dir(), 1 << 30);
    let input = Input::open(path, &Limits::default(), &scratch).expect("a readable file");
    input.source.peek(0..HEAD_BYTES as u64).to_vec()
}

/// Numbers that are the same in every run.
pub(super) struct Random(pub(super) u64);

impl Random {
    pub(super) fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % end as u64) as usize
    }
}

/// A file that is cut at any of 50 places within its first `whole` bytes gives an error with its place; one of 200 flipped
/// bits gives that or a mesh.
pub(super) fn damage(format: &dyn Format, path: &Path, whole: impl Fn(&[u8]) -> usize) {
    damage_beside(format, path, &[], whole);
}

/// [`damage`] of a file beside which those of `beside` stand, whole; where there are any, the first of them is the one to
/// read.
pub(super) fn damage_beside(
    format: &dyn Format,
    path: &Path,
    beside: &[&Path],
    whole: impl Fn(&[u8]) -> usize,
) {
    let name = |path: &Path| path.file_name().expect("a name").to_str().expect("UTF-8").to_owned();
    let others: Vec<_> = beside.iter().map(|p| (name(p), fs::read(p).expect("readable"))).collect();
    let (main, bytes) =
        (others.first().map_or(name(path), |o| o.0.clone()), fs::read(path).expect("readable"));
    let damaged = |bytes: &[u8]| {
        let damaged = name(path);
        let mut files: Vec<_> = others.iter().map(|(name, bytes)| (name.as_str(), &bytes[..])).collect();
        // Written last: it may be one of the others.
        files.push((&damaged, bytes));
        read_files(format, &main, &files)
    };
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let whole = whole(&bytes);
    for _ in 0..50 {
        let cut = random.below(whole);
        let Err(error) = damaged(&bytes[..cut]) else { panic!("{} cut at {cut}", path.display()) };
        assert!(error.path().is_some() && (error.place().is_some() || cut == 0), "cut at {cut}: {error}");
    }
    for _ in 0..200 {
        let mut flipped = bytes.clone();
        flipped[random.below(bytes.len())] ^= 1 << random.below(8);
        if let Err(error) = damaged(&flipped) {
            assert!(error.path().is_some() && error.place().is_some(), "{}: {error}", path.display());
        }
    }
}

/// Where the last word of text begins that is no comment, for what is cut after may miss unseen; all bytes of binary data.
pub(super) fn last_word(bytes: &[u8]) -> usize {
    if bytes.contains(&0) {
        return bytes.len();
    }
    let mut end = bytes.len();
    loop {
        end = bytes[..end].trim_ascii_end().len();
        let start = bytes[..end].iter().rposition(|&b| b == b'\n').map_or(0, |k| k + 1);
        match bytes[start..end].iter().position(|&b| b == b'#') {
            Some(mark) => end = start + mark,
            None => return bytes[..end].iter().rposition(u8::is_ascii_whitespace).map_or(0, |k| k + 1),
        }
    }
}
