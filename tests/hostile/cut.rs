//! Meshes that end too early: at every section and at many places between. Half a mesh is an error, not a summary.

use std::fs;

use meshgauge::error::Kind;
use meshgauge::input::Compression;

use crate::attempt::{assert_line, attempt_bytes, refused};
use crate::packing::pack;
use crate::{Random, own_meshes};

/// Whether a cut leaves a whole mesh, by what is kept and what is lost.
type Unseen = fn(&[u8], &[u8]) -> bool;

/// Cuts that nobody can tell: format (none for all), which they are, and why.
const UNSEEN: &[(&str, Unseen, &str)] = &[
    ("", |_, lost| lost.trim_ascii().is_empty(), "blanks at the end say nothing"),
    (
        "vtk",
        |_, lost| starts_with_any(lost, &["CELL_DATA", "POINT_DATA"]),
        "the data of a mesh come after it",
    ),
    ("vtk", no_data_yet, "point data of no arrays are allowed, and some writers make them"),
    ("vtk", within_last_number, "the last number is still one without its last digits"),
    ("abaqus", after_the_mesh, "sets come after the mesh"),
    ("abaqus", in_elements_at_end_of_line, "a deck has no end mark: it may well end with any element"),
    ("nastran", after_first_element, "a deck may lack ENDDATA: it may well end with any card"),
    ("abaqus", within_last_node, "a node's number is still one without its last digits"),
];

fn starts_with_any(bytes: &[u8], words: &[&str]) -> bool {
    let bytes = bytes.trim_ascii_start();
    words.iter().any(|word| bytes.starts_with(word.as_bytes()))
}

fn contains(bytes: &[u8], word: &[u8]) -> bool {
    memchr::memmem::find(bytes, word).is_some()
}

/// Nothing stands after the number of points that data are for.
fn no_data_yet(kept: &[u8], _: &[u8]) -> bool {
    let last = kept.trim_ascii_end().rsplit(|b| *b == b'\n').next().unwrap_or_default();
    last.starts_with(b"POINT_DATA ") || last.starts_with(b"CELL_DATA ")
}

fn after_the_mesh(kept: &[u8], lost: &[u8]) -> bool {
    memchr::memmem::find(&[kept, lost].concat(), b"*ELSET").is_some_and(|sets| kept.len() >= sets)
}

fn within_last_number(_: &[u8], lost: &[u8]) -> bool {
    lost.iter().filter(|b| b.is_ascii_digit()).count() <= 1 && lost.trim_ascii().len() == 1
}

fn in_elements_at_end_of_line(kept: &[u8], lost: &[u8]) -> bool {
    let elements = memchr::memmem::find(kept, b"*ELEMENT").is_some_and(|at| kept[at..].contains(&b'\n'));
    elements && (kept.ends_with(b"\n") || lost.starts_with(b"\n") || lost.starts_with(b"\r"))
}

/// A card ends here.
fn after_first_element(kept: &[u8], lost: &[u8]) -> bool {
    let ended = kept.ends_with(b"\n") || lost.starts_with(b"\n");
    contains(kept, b"\nC") && ended
}

/// All commas of the line are there, and something of its last number.
fn within_last_node(kept: &[u8], lost: &[u8]) -> bool {
    let rest = lost.split(|b| *b == b'\n').next().unwrap_or_default();
    contains(kept, b"*ELEMENT") && kept.last().is_some_and(u8::is_ascii_digit) && !rest.contains(&b',')
}

/// Where sections begin: marks at the start of a line, as all formats have them.
fn sections(bytes: &[u8]) -> Vec<usize> {
    let is_mark = |byte: &u8| matches!(byte, b'$' | b'*' | b'<') || byte.is_ascii_uppercase();
    let mut found = Vec::new();
    for end in memchr::memchr_iter(b'\n', bytes) {
        let start = end + 1 + bytes[end + 1..].iter().take_while(|b| **b == b' ').count();
        if bytes.get(start).is_some_and(is_mark) {
            found.extend([end, end + 1, start, (start + 4).min(bytes.len() - 1)]);
        }
    }
    // Noise in binary data looks like marks as well.
    let step = found.len().div_ceil(200).max(1);
    found.into_iter().step_by(step).collect()
}

#[test]
fn a_mesh_that_ends_too_early_is_an_error() {
    let mut random = Random(0x2007_0301);
    for (format, path) in own_meshes() {
        let bytes = fs::read(&path).expect("readable");
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        let is_text = bytes.is_ascii() && matches!(format, "gmsh" | "abaqus" | "nastran" | "vtk");
        let places = (0..50).map(|_| random.below(bytes.len()));
        for cut in sections(&bytes).into_iter().chain(places.collect::<Vec<_>>()) {
            let what = format!("{format}/{name} cut to {cut} of {} bytes", bytes.len());
            let (kept, lost) = bytes.split_at(cut);
            let result = attempt_bytes(&name, kept, &what);
            let unseen =
                UNSEEN.iter().any(|row| (row.0.is_empty() || row.0 == format) && (row.1)(kept, lost));
            if !(result.is_ok() && unseen) {
                let error = refused(result, &what);
                assert!(
                    !is_text || matches!(error.kind(), Kind::Empty) || {
                        assert_line(&error, &what);
                        true
                    }
                );
            }
        }
    }
}

#[test]
fn a_packed_mesh_that_ends_too_early_is_an_error() {
    let mut random = Random(0x2007_0302);
    for (format, path) in own_meshes() {
        let bytes = fs::read(&path).expect("readable");
        for compression in Compression::ALL {
            let packed = pack(compression, &bytes);
            let places = (0..10).map(|_| 1 + random.below(packed.len() - 1)).chain([1, packed.len() - 1]);
            for cut in places.collect::<Vec<_>>() {
                let what = format!("{format}, {} cut to {cut} of {}", compression.name(), packed.len());
                let error = refused(attempt_bytes("x", &packed[..cut], &what), &what);
                let fits = match error.kind() {
                    Kind::Malformed { .. } => error.format() == Some(compression.name()),
                    kind => matches!(kind, Kind::UnknownFormat(_)) && cut < Compression::HEAD_BYTES,
                };
                assert!(fits, "{what}: {error}");
            }
        }
    }
}
