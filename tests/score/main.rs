//! The whole library on real meshes: the same bytes whatever the threads, the memory, the packing or the way in; and on
//! small meshes with flaws: what is found, and the verdict.

#![expect(clippy::disallowed_methods, reason = "small meshes of known size are read whole, to be packed")]

mod flaws;
#[path = "../input/packing.rs"]
#[expect(dead_code, reason = "shared with the tests of input")]
mod packing;

use std::fs;
use std::path::{Path, PathBuf};

use meshgauge::input::Compression::{self, Bzip2, Gzip, Lz4, Xz, Zstd};
use meshgauge::{Options, Summary, score, score_reader};
use serde_json::Value;

use packing::pack;

fn options() -> Options {
    Options { threads: 2, run_info: false, ..Options::default() }
}

/// Meshes of all formats, some of several pieces.
fn meshes() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let names = [
        "examples/drop/pit-specimen.inp",
        "examples/drop/pit-specimen-fine.msh.zst",
        "examples/drop/cylinder-hex.vtu",
        "tests/meshes/abaqus/gmsh_pit2d_o2.inp",
        "tests/meshes/gmsh/mixed_hex_prism_41.msh",
        "tests/meshes/gmsh/pit2d_41_bin.msh",
        "tests/meshes/vtk/all_51_binary.vtk",
        "tests/meshes/vtu/all_raw_lz4.vtu",
    ];
    names.map(|name| root.join(name)).to_vec()
}

#[track_caller]
fn scored(path: &Path, options: &Options) -> Summary {
    score(path, options).unwrap_or_else(|e| panic!("{e}"))
}

/// The summary as JSON without the key `mesh`.
fn all_but_mesh(summary: &Summary) -> String {
    let mut value: Value = serde_json::from_str(&summary.to_json()).expect("JSON");
    value.as_object_mut().expect("an object").remove("mesh").expect("the mesh");
    value.to_string()
}

#[test]
fn threads_and_memory_do_not_show_in_a_summary() {
    for path in meshes() {
        let first = scored(&path, &Options { threads: 1, ..options() });
        assert!(first.elements.count > 0 && !first.shapes.is_empty(), "{}", path.display());
        let first = first.to_json();
        for (threads, memory) in [(1, 0), (2, 0), (7, 0), (2, 1 << 20), (7, 256 << 20)] {
            let again = scored(&path, &Options { threads, memory, ..options() });
            assert_eq!(again.to_json(), first, "{}: {threads} threads, {memory} bytes", path.display());
        }
    }
}

/// Packed in two halves, where the program that undoes it puts them together again.
fn in_two(compression: Compression, bytes: &[u8]) -> Vec<u8> {
    let (first, second) = bytes.split_at(bytes.len() / 2);
    [pack(compression, first), pack(compression, second)].concat()
}

#[test]
fn packing_shows_in_the_mesh_alone() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for path in meshes().into_iter().filter(|path| path.extension().is_some_and(|e| e != "zst")) {
        let plain = scored(&path, &options());
        let bytes = fs::read(&path).expect("readable");
        let packed = [Gzip, Zstd, Bzip2, Xz, Lz4].map(|c| (c, pack(c, &bytes)));
        let halves = [Gzip, Zstd, Bzip2, Xz].map(|c| (c, in_two(c, &bytes)));
        for (compression, packed) in packed.into_iter().chain(halves) {
            let name = path.file_name().expect("a name").to_string_lossy();
            let copy = folder.path().join(format!("{name}.{}", compression.extension()));
            fs::write(&copy, &packed).expect("written");
            let found = scored(&copy, &options());
            let what = format!("{name}, {}", compression.name());
            assert_eq!(all_but_mesh(&found), all_but_mesh(&plain), "{what}");
            assert_eq!(found.mesh.compression.as_deref(), Some(compression.name()), "{what}");
            assert_eq!(found.mesh.bytes, packed.len() as u64, "{what}");
            assert_eq!(
                (found.mesh.name, found.mesh.format),
                (plain.mesh.name.clone(), plain.mesh.format.clone())
            );
        }
    }
}

#[test]
fn a_stream_is_scored_as_the_file_is() {
    for path in meshes() {
        let file = scored(&path, &options());
        let reader = fs::File::open(&path).expect("readable");
        let stream = score_reader("-", reader, &options()).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(all_but_mesh(&stream), all_but_mesh(&file), "{}", path.display());
        assert_eq!((stream.mesh.bytes, &stream.mesh.xxh3), (file.mesh.bytes, &file.mesh.xxh3));
        assert_eq!(
            (&stream.mesh.format, &stream.mesh.compression),
            (&file.mesh.format, &file.mesh.compression)
        );
    }
}

#[test]
fn a_summary_reads_back_as_it_was_written() {
    for path in meshes() {
        let summary = scored(&path, &Options { run_info: true, ..options() });
        let again: Summary = serde_json::from_str(&summary.to_json()).expect("its own schema");
        assert_eq!(again, summary, "{}", path.display());
    }
}
