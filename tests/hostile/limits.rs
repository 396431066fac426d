//! Lines without an end, bombs, and errors early in long files.

use std::fs::File;
use std::io::{BufWriter, Write};

use meshgauge::error::{At, Kind};

use crate::attempt::{attempt, attempt_bytes, refused};
use crate::bombs::{gzip_bomb, zstd_bomb};

/// Starts of text files, each in the middle of a line or of a number.
const STARTS: [(&str, &str); 8] = [
    ("abaqus", "*HEADING\n*NODE\n1, 0."),
    ("abaqus", "*HEADING\n*NODE\n1, 0., 0.\n*ELEMENT, TYPE=S3\n1, 1"),
    ("gmsh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 "),
    ("gmsh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 1 1 1\n2 1 0 1\n"),
    ("nastran", "SOL 101\nBEGIN BULK\nGRID,1,,0."),
    ("vtk", "# vtk DataFile Version 3.0\na title of "),
    ("vtk", "# vtk DataFile Version 3.0\n\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 1 float\n0 0 "),
    ("vtu", "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\""),
];

#[test]
fn a_line_of_a_gigabyte_is_refused() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (number, (format, start)) in STARTS.iter().enumerate() {
        let path = folder.path().join(format!("{number}"));
        let mut file = File::create(&path).expect("a file");
        file.write_all(start.as_bytes()).expect("written");
        // The rest is zero bytes that take no room on disk.
        file.set_len(1 << 30).expect("a sparse file");
        let what = format!("{format}: {start:?} and a gigabyte");
        let error = refused(attempt(&path, &what), &what);
        assert_eq!(error.format(), Some(*format), "{error}");
    }
}

#[test]
fn a_line_of_megabytes_is_refused() {
    for (format, start) in STARTS {
        let bytes = [start.as_bytes(), &b"1".repeat(4 << 20)].concat();
        let what = format!("{format}: {start:?} and many digits");
        let error = refused(attempt_bytes("x", &bytes, &what), &what);
        assert_eq!(error.format(), Some(format), "{error}");
        assert!(matches!(error.place(), Some(At::Line(_))), "{error}");
    }
}

/// The stage that reads nodes has several pieces in hand when one of them turns out bad.
#[test]
fn a_bad_node_early_in_a_long_file_ends_the_run() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("x.inp");
    for bad in [2, 300_000] {
        let mut file = BufWriter::new(File::create(&path).expect("a file"));
        file.write_all(b"*NODE\n").expect("written");
        for node in 1..=1_000_000u32 {
            match node {
                node if node == bad => writeln!(file, "{node}, x, 1.25, 2.5").expect("written"),
                _ => writeln!(file, "{node}, 0.125, 1.25, 2.5").expect("written"),
            }
        }
        file.write_all(b"*ELEMENT, TYPE=S3\n1, 1, 2, 3\n").and_then(|()| file.flush()).expect("written");
        let error = refused(attempt(&path, "a long file"), "a long file");
        assert_eq!(error.place(), Some(At::Line(u64::from(bad) + 1)), "{error}");
    }
}

#[test]
fn bombs_are_refused() {
    let rows = [
        ("a gigabyte in 33 KB", zstd_bomb(8192, 20), "packed byte"),
        ("a window of 2 GiB", zstd_bomb(8192, 31), "window"),
        ("gzip", gzip_bomb(80), "packed byte"),
        ("xz", crate::bombs::xz_bomb(), "window"),
    ];
    for (what, bytes, limit) in rows {
        let error = attempt_bytes("x.inp", &bytes, what).expect_err(what);
        assert!(matches!(error.kind(), Kind::Limit { what, .. } if what.contains(limit)), "{error}");
        assert!(error.path().is_some() && error.format().is_some(), "{error}");
    }
}

#[test]
fn a_mesh_packed_twice_is_refused() {
    use meshgauge::input::Compression::{Gzip, Zstd};
    let twice = crate::packing::pack(Gzip, &crate::packing::pack(Zstd, b"*NODE\n1, 0.\n"));
    let error = attempt_bytes("x.inp", &twice, "twice").expect_err("twice");
    assert!(matches!(error.kind(), Kind::Unsupported(_)) && error.path().is_some(), "{error}");
}
