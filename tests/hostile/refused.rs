//! What is no mesh at all.

use std::fs;

use meshgauge::Options;
use meshgauge::error::Kind;
use meshgauge::formats::FORMATS;
use rustix::fs::{CWD, FileType, Mode, mknodat};

use crate::attempt::{attempt, attempt_bytes, attempt_with, options, refused};

#[test]
fn what_is_no_regular_file_is_named() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name);
    fs::create_dir(path("folder.inp")).expect("a folder");
    mknodat(CWD, path("x.inp"), FileType::Fifo, Mode::RWXU, 0).expect("a FIFO");
    for (path, expected) in [
        (path("folder.inp"), "a directory"),
        (path("x.inp"), "a FIFO"),
        ("/dev/zero".into(), "a character device"),
    ] {
        let error = refused(attempt(&path, expected), expected);
        assert!(matches!(error.kind(), Kind::NotAFile(found) if *found == expected), "{error}");
    }
    let error = attempt(&path("none.inp"), "no file").expect_err("no file");
    assert!(matches!(error.kind(), Kind::Unreadable(_)) && error.path().is_some(), "{error}");
}

#[test]
fn an_empty_file_is_empty_packed_or_not() {
    let packed = meshgauge::input::Compression::ALL.map(|c| crate::packing::pack(c, b""));
    for bytes in packed.iter().map(Vec::as_slice).chain([&b""[..]]) {
        let error = refused(attempt_bytes("x.msh", bytes, "nothing"), "nothing");
        assert!(matches!(error.kind(), Kind::Empty), "{error}");
    }
}

#[test]
fn content_of_no_format_is_refused_with_a_list_of_what_was_looked_for() {
    let utf16 = |text: &str| text.encode_utf16().flat_map(u16::to_le_bytes).collect::<Vec<_>>();
    let mut random = crate::Random(2007);
    let noise: Vec<u8> = (0..100_000).map(|_| random.below(256) as u8).collect();
    let rows: [(&str, Vec<u8>, &str); 6] = [
        ("x.inp", vec![0; 100_000], "zero bytes only"),
        ("x.msh", utf16("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"), "UTF-16 text"),
        ("x.vtk", b"\n\n   \n".to_vec(), "blank lines only"),
        ("x.vtu", b"<html><body>Not found</body></html>".to_vec(), "a web page"),
        ("x.inp", noise, "a mesh of a known format"),
        ("x.inp", b"To whom it may concern\n".to_vec(), "a mesh of a known format"),
    ];
    for (name, bytes, found) in rows {
        let error = refused(attempt_bytes(name, &bytes, found), found).to_string();
        assert!(error.contains(found) && error.contains("looked for"), "{error}");
        for format in FORMATS {
            assert!(error.contains(format.name()) && error.contains(format.looks_for()), "{error}");
        }
    }
}

#[test]
fn a_deck_in_utf_16_is_refused_as_such() {
    let deck = "*HEADING\n*NODE\n1, 0., 0.\n2, 1., 0.\n3, 0., 1.\n*ELEMENT, TYPE=S3\n1, 1, 2, 3\n";
    for mark in [None, Some(0xfeffu16)] {
        let units = mark.into_iter().chain(deck.encode_utf16());
        let bytes: Vec<u8> = units.flat_map(u16::to_le_bytes).collect();
        let error = refused(attempt_bytes("x.inp", &bytes, "UTF-16"), "UTF-16").to_string();
        assert!(error.contains("abaqus") && error.contains("found UTF-16"), "{error}");
    }
}

#[test]
fn includes_do_not_lead_out_of_the_folder() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let inside = folder.path().join("in");
    fs::create_dir(&inside).expect("a folder");
    fs::write(folder.path().join("secret.inp"), "*NODE\n1, 0., 0.\n").expect("written");
    std::os::unix::fs::symlink("../secret.inp", inside.join("link.inp")).expect("a link");
    std::os::unix::fs::symlink("..", inside.join("up")).expect("a link");
    mknodat(CWD, inside.join("fifo.inp"), FileType::Fifo, Mode::RWXU, 0).expect("a FIFO");
    let path = inside.join("x.inp");
    let secret = folder.path().join("secret.inp").display().to_string();
    let names =
        ["../secret.inp", "link.inp", "up/secret.inp", "/etc/passwd", &secret, "sub/../../secret.inp"];
    for name in names.into_iter().chain(["none.inp", "fifo.inp", "x.inp", "."]) {
        for keyword in ["INCLUDE", "NODE"] {
            fs::write(&path, format!("*HEADING\n*{keyword}, INPUT={name}\n")).expect("written");
            let error = attempt(&path, name).expect_err(name);
            let line = matches!(error.place(), Some(meshgauge::error::At::Line(2)));
            // A deck whose nodes are itself is read once: its own keyword lines are no data.
            let itself = (name, keyword) == ("x.inp", "NODE");
            assert!(error.path() == Some(&path) && (line || itself), "{name}: {error}");
        }
    }
}

/// Formats that differ in lines without meaning for the mesh.
const ALIKE: [&str; 2] = ["femgv", "frd"];

/// Who names the format himself gets that format's errors.
#[test]
fn a_mesh_of_another_format_than_was_named_is_refused() {
    for (format, path) in crate::own_meshes() {
        for other in FORMATS.iter().filter(|other| other.name() != format) {
            if ALIKE.contains(&format) && ALIKE.contains(&other.name()) {
                continue;
            }
            let named = Options { format: Some(other.name().to_owned()), ..options() };
            let what = format!("{} as {}", path.display(), other.name());
            let error = refused(attempt_with(&path, &named, &what), &what);
            assert_eq!(error.format(), Some(other.name()), "{error}");
        }
    }
    let (_, path) = &crate::own_meshes()[0];
    let unknown = Options { format: Some("mesh".to_owned()), ..options() };
    let error = attempt_with(path, &unknown, "no format").expect_err("no format");
    assert!(error.is_usage() && error.to_string().contains("abaqus"), "{error}");
}

#[test]
fn a_listing_of_nag_with_rows_of_other_numbers_after_it_is_refused() {
    let rows = "2 3 0\n0 1\n1 1\n".to_owned() + &"1 2 1\n".repeat(3) + "4 1 2 3\n";
    let named = Options { format: Some("nag".to_owned()), ..options() };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("x.ele");
    fs::write(&path, rows).expect("written");
    let error = refused(attempt_with(&path, &named, "rows"), "rows").to_string();
    assert!(error.contains("numbers after its mesh"), "{error}");
}
