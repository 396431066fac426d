//! `limits.line_bytes` in every format of text.

use std::fs;
use std::path::{Path, PathBuf};

use meshgauge::error::{Bound, Kind};
use meshgauge::formats::FORMATS;

use crate::COMPANIONS;
use crate::attempt::attempt;

/// What the limit means to a format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Text {
    /// Records are lines: one over the limit is refused, whatever it holds.
    Lines,
    /// A line's end is a blank: all numbers may well stand in one line, as some writers put them, but a word has its limit.
    Words,
}

/// Every format of text, with the one of its meshes that is lengthened.
const TEXTS: [(&str, &str, Text); 26] = [
    ("gmsh", "pit2d_22_ascii.msh", Text::Lines),
    ("gmsh", "pit2d_40_ascii.msh", Text::Lines),
    ("gmsh", "pit2d_41_ascii.msh", Text::Lines),
    ("abaqus", "gmsh_pit2d_o2.inp", Text::Lines),
    ("ansys", "degenerate.cdb", Text::Lines),
    ("comsol", "mixed.mphtxt", Text::Words),
    ("femgv", "two_shapes.neu", Text::Lines),
    ("frd", "two_shapes.frd", Text::Lines),
    ("lsdyna", "gmsh_mixed.key", Text::Lines),
    ("medit", "gmsh_box_o2.mesh", Text::Words),
    ("nag", "pit2d.r", Text::Words),
    ("nastran", "gmsh_mixed_free.bdf", Text::Lines),
    ("netgen", "cube_o2.vol", Text::Lines),
    ("obj", "gmsh_pit_block.obj", Text::Lines),
    ("off", "gmsh_pit_block.off", Text::Lines),
    ("openfoam", "mixed_ascii/faces", Text::Words),
    ("ply", "meshio_mixed_ascii.ply", Text::Lines),
    ("stl", "gmsh_pit_block.stl", Text::Lines),
    ("su2", "gmsh_mixed.su2", Text::Lines),
    ("tetgen", "box.ele", Text::Lines),
    ("triangle", "pit2d.1.ele", Text::Lines),
    ("ugrid", "mixed.ugrid", Text::Words),
    ("unv", "gmsh_mixed.unv", Text::Lines),
    ("vtk", "linear_51_ascii.vtk", Text::Words),
    ("vtu", "linear_ascii.vtu", Text::Words),
    ("xdmf", "meshio_mixed_xml.xdmf", Text::Words),
];

/// The formats that have no text.
const BINARY: [&str; 5] = ["cgns", "exodus", "matlab", "med", "vtkhdf"];

/// Copies a mesh with what stands beside it, and puts `filling` at byte `at`.
fn lengthened(mesh: &Path, at: usize, filling: &[u8]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let beside =
        fs::read_dir(mesh.parent().expect("a folder")).expect("a folder").flatten().map(|entry| entry.path());
    let stem = mesh.file_stem();
    for file in beside.filter(|file| mesh.extension().is_none() || file.file_stem() == stem) {
        if mesh.extension().is_none() || COMPANIONS.iter().any(|c| file.extension().is_some_and(|e| e == *c))
        {
            fs::copy(&file, folder.path().join(file.file_name().expect("a name"))).expect("copied");
        }
    }
    let path = folder.path().join(mesh.file_name().expect("a name"));
    let whole = fs::read(mesh).expect("a mesh");
    fs::write(&path, [&whole[..at], filling, &whole[at..]].concat()).expect("written");
    (folder, path)
}

#[test]
fn a_line_of_three_megabytes_in_the_midst_of_the_records_is_refused_by_its_limit() {
    for (format, name, text) in TEXTS {
        let mesh = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes").join(format).join(name);
        let whole = fs::read(&mesh).expect("a mesh");
        let sound = attempt(&mesh, name).expect("a sound mesh").elements.count;
        let mut refused = 0;
        for third in [1, 2] {
            let at = end_of_number(&whole, whole.len() * third / 3);
            for filling in [b" ", b"1"] {
                let what = format!("{format}: {name}, 3 MiB of {:?} at byte {at}", char::from(filling[0]));
                let (_folder, path) = lengthened(&mesh, at, &filling.repeat(3 << 20));
                match attempt(&path, &what) {
                    // Words of parts that are passed over are not looked at.
                    Ok(summary) => {
                        assert!(text == Text::Words && summary.elements.count == sound, "{what}: scored");
                    }
                    Err(error) => {
                        let is_limit = matches!(error.kind(), Kind::Limit { bound: Bound::LineBytes, .. });
                        assert!(is_limit && error.place().is_some(), "{what}: {error:.300}");
                        refused += 1;
                    }
                }
            }
        }
        assert!(refused > 0, "{format}: {name}: nothing was refused");
    }
}

/// The end of the first number that ends behind byte `from`.
fn end_of_number(text: &[u8], from: usize) -> usize {
    let ends_word = |b: &u8| b.is_ascii_whitespace() || *b == b',';
    let ends_number = |at: &usize| {
        let word = text[..*at].rsplit(ends_word).next().unwrap_or_default();
        let of_number = |b: &u8| b.is_ascii_digit() || b"+-.eEdD".contains(b);
        ends_word(&text[*at]) && word.last().is_some_and(u8::is_ascii_digit) && word.iter().all(of_number)
    };
    (from..text.len()).find(ends_number).expect("a number's end")
}

#[test]
fn every_format_is_text_or_binary() {
    for format in FORMATS {
        let is_text = TEXTS.iter().any(|(name, ..)| *name == format.name());
        assert!(is_text != BINARY.contains(&format.name()), "{} has no row", format.name());
    }
}
