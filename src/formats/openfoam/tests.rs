//! Meshes that OpenFOAM's own programs wrote, in every way to write them, with the counts of checkMesh; and damaged ones.

#![expect(
    clippy::disallowed_methods,
    reason = "meshes of known size are read whole, to be rewritten and damaged"
)]

use std::fs;
use std::path::Path;

use super::OpenFoam;
use crate::error::Result;
use crate::formats::reading::{Mesh, read};
use crate::formats::testing::{Random, corners, corpus, holds, own, same_elements};
use crate::formats::{self, Format, HEAD_BYTES};
use crate::mesh::Shape;

/// The four files of a mesh.
type Files = Vec<(String, Vec<u8>)>;

fn files(mesh: &str) -> Files {
    let entries = fs::read_dir(own("openfoam").join(mesh)).expect("a mesh");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let name = |path: &Path| path.file_name().expect("a name").to_string_lossy().into_owned();
    paths.map(|path| (name(&path), fs::read(&path).expect("readable"))).collect()
}

fn read_mesh(files: &Files) -> Result<Mesh> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mesh = folder.path().join("case/constant/polyMesh");
    fs::create_dir_all(&mesh).expect("a folder");
    files.iter().for_each(|(name, bytes)| fs::write(mesh.join(name), bytes).expect("written"));
    read(&OpenFoam, &folder.path().join("case"))
}

/// The error without the folder.
#[track_caller]
fn error(files: &Files) -> String {
    let error = read_mesh(files).expect_err("an error").to_string();
    error.split_once("polyMesh/").map_or(error.clone(), |(_, rest)| rest.to_owned())
}

/// A list without its file's header, a bracket or blank after each number.
fn body(bytes: &[u8]) -> &str {
    let text = std::str::from_utf8(bytes).expect("text");
    let end = text.find('}').expect("a header") + 1;
    let rest = text[end..].trim_start();
    rest.lines().next().filter(|line| line.starts_with("//")).map_or(rest, |line| &rest[line.len()..])
}

fn numbers<T: std::str::FromStr>(text: &str) -> Vec<T> {
    text.split(|c: char| "() \n".contains(c)).filter_map(|word| word.parse().ok()).collect()
}

/// A mesh in memory: points, faces, owner, neighbour.
struct Lists(Vec<f64>, Vec<Vec<i64>>, Vec<i64>, Vec<i64>);

fn lists(files: &Files) -> Lists {
    let of = |name: &str| body(&files.iter().find(|file| file.0 == name).expect("a file").1);
    let all: Vec<i64> = numbers(of("faces"));
    let (mut faces, mut at) = (Vec::new(), 1);
    while at < all.len() {
        let len = all[at] as usize;
        faces.push(all[at + 1..at + 1 + len].to_vec());
        at += 1 + len;
    }
    let rest = |name| numbers(of(name)).split_off(1);
    Lists(numbers(of("points")).split_off(1), faces, rest("owner"), rest("neighbour"))
}

/// How the numbers of a binary file are written.
#[derive(Clone, Copy)]
struct Writing {
    big: bool,
    label: usize,
    scalar: usize,
    compact: bool,
}

impl Writing {
    fn label(&self, value: i64) -> Vec<u8> {
        let mut bytes = value.to_le_bytes()[..self.label].to_vec();
        if self.big {
            bytes.reverse();
        }
        bytes
    }

    fn scalar(&self, value: f64) -> Vec<u8> {
        let mut bytes = if self.scalar == 4 {
            (value as f32).to_le_bytes().to_vec()
        } else {
            value.to_le_bytes().to_vec()
        };
        if self.big {
            bytes.reverse();
        }
        bytes
    }

    fn labels(&self, values: &[i64]) -> Vec<u8> {
        let mut bytes = format!("\n{}\n(", values.len()).into_bytes();
        values.iter().for_each(|value| bytes.extend(self.label(*value)));
        bytes.push(b')');
        bytes
    }

    fn write(&self, Lists(points, faces, owner, neighbour): &Lists) -> Files {
        let order = if self.big { "MSB" } else { "LSB" };
        let head = |class: &str, name: &str| {
            let (label, scalar) = (8 * self.label, 8 * self.scalar);
            format!(
                "/* C++ */\nFoamFile\n{{\n version 2.0; format binary; arch \"{order};label={label};scalar={scalar}\";\n\
                 note \"nPoints: 9; }}\"; class {class}; object {name};\n}}\n// * * //\n"
            )
            .into_bytes()
        };
        let mut all = head("vectorField", "points");
        all.extend(format!("\n{}\n(", points.len() / 3).bytes());
        points.iter().for_each(|value| all.extend(self.scalar(*value)));
        all.extend(b")\n\n// ** //\n");
        let mut sides = head(if self.compact { "faceCompactList" } else { "faceList" }, "faces");
        if self.compact {
            let mut starts = vec![0];
            faces.iter().for_each(|face| starts.push(starts[starts.len() - 1] + face.len() as i64));
            sides.extend(self.labels(&starts));
            sides.extend(self.labels(&faces.concat()));
        } else {
            sides.extend(format!("{}\n(", faces.len()).bytes());
            faces.iter().for_each(|face| sides.extend(self.labels(face)));
            sides.push(b')');
        }
        let named = |name: &str, bytes: Vec<u8>| (name.to_owned(), bytes);
        vec![
            named("points", all),
            named("faces", sides),
            named("owner", [head("labelList", "owner"), self.labels(owner)].concat()),
            named("neighbour", [head("labelList", "neighbour"), self.labels(neighbour)].concat()),
        ]
    }
}

#[test]
fn meshes_have_the_counts_of_checkmesh() {
    let rows = [
        ("mixed_ascii", "54 nodes, hex:8 prism:28", 2.0),
        ("pyramids_gz", "134 nodes, hex:27 pyr:9 tet:206", 2.0),
        ("pyramids_binary", "134 nodes, hex:27 pyr:9 tet:206", 2.0),
        ("polyhedra_binary", "882 nodes, hex:184 polyhedron:110", 0.4479),
        ("axis_ascii", "54 nodes, hex:15 prism:5", 0.05),
    ];
    for (name, expected, total) in rows {
        let mesh = read(&OpenFoam, &own("openfoam").join(name)).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(holds(&mesh), expected, "{name}");
        assert_eq!(mesh.nodes.unused(), 0, "{name}");
        let found: f64 = mesh.elements.iter().map(|(_, shape, corners)| volume(*shape, corners)).sum();
        assert!((found - total).abs() < 1e-4, "{name}: {found}");
    }
}

/// The volume of an element with plane faces, which look outwards.
fn volume(shape: Shape, c: &[[f64; 3]]) -> f64 {
    let facts = shape.facts();
    let halves = facts.quadrilaterals.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]);
    let cone = |[a, b, d]: [usize; 3]| {
        let ([x, y, z], [u, v, w], [p, q, r]) = (c[a], c[b], c[d]);
        (x * (v * r - w * q) + y * (w * p - u * r) + z * (u * q - v * p)) / 6.0
    };
    facts.triangles.iter().copied().chain(halves).map(cone).sum()
}

/// Widths, byte orders, faces one by one or compact: the same elements.
#[test]
fn every_way_to_write_a_binary_mesh_gives_the_same() {
    let text = files("mixed_ascii");
    let expected = read_mesh(&text).expect("a mesh");
    for big in [false, true] {
        for (label, scalar, compact) in
            [(4, 8, true), (4, 8, false), (8, 8, true), (8, 4, false), (4, 4, true)]
        {
            let binary = Writing { big, label, scalar, compact }.write(&lists(&text));
            let mesh = read_mesh(&binary).unwrap_or_else(|e| panic!("{e}"));
            same_elements(&mesh, &expected, if scalar == 4 { 1e-6 } else { 0.0 });
        }
    }
}

#[test]
fn text_may_be_written_in_other_ways() {
    let text = files("mixed_ascii");
    let expected = read_mesh(&text).expect("a mesh");
    let Lists(points, faces, owner, mut neighbour) = lists(&text);
    // Old versions list a neighbour for each face; lists need not tell their length; comments stand anywhere.
    neighbour.resize(owner.len(), -1);
    let head = |name: &str| format!("#!/usr/bin/cgx -foam\nFoamFile{{format ascii;object {name};}}\n");
    let list = |values: &[i64]| {
        let words: Vec<_> = values.iter().map(ToString::to_string).collect();
        format!("{}({})", values.len(), words.join(" "))
    };
    let rows: String =
        faces.iter().map(|face| format!("{} // a face\n", list(face).replace('(', "\n(\n"))).collect();
    let triples: String = points.chunks(3).map(|p| format!("( {} {:e} {} )", p[0], p[1], p[2])).collect();
    let other = [
        ("points", format!("{}/* all */ ({triples})", head("points"))),
        ("faces", format!("{}\n{}\n(\n{rows})\n", head("faces"), faces.len())),
        (
            "owner",
            format!("{}{}", head("owner"), list(&owner).split_once('(').map_or("", |l| l.1))
                .replace("}\n", "}\n("),
        ),
        ("neighbour", format!("{}{}// end", head("neighbour"), list(&neighbour))),
    ];
    let other = other.map(|(name, text)| (name.to_owned(), text.into_bytes())).to_vec();
    let mesh = read_mesh(&other).unwrap_or_else(|e| panic!("{e}"));
    same_elements(&mesh, &expected, 0.0);
    assert_eq!(corners(&mesh, Shape::Wedge).len(), 28 * 18);
}

/// One brick with an edge collapsed, one prism with one, and a brick with a face in two: what checkMesh calls them.
#[test]
fn cells_that_are_no_shape_are_counted_by_name() {
    let head = |name: &str| format!("FoamFile {{ format ascii; object {name}; }}\n");
    let rows: [(&str, &str, &str); 4] = [
        (
            "wedge",
            "0 0 0 1 0 0 1 1 0 0 1 0  0 0 1 1 1 1 0 1 1",
            "4(0 3 2 1) 4(0 4 6 3) 4(2 3 6 5) 4(0 1 5 4) 3(1 2 5) 3(4 5 6)",
        ),
        ("tetWedge", "0 0 0 1 0 0 0 1 0  0 0 1 0 1 1", "3(0 2 1) 4(0 3 4 2) 4(1 2 4 3) 3(0 1 3)"),
        (
            "polyhedron",
            "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1",
            "3(0 3 2) 3(0 2 1) 4(4 5 6 7) 4(0 1 5 4) 4(1 2 6 5) 4(2 3 7 6) 4(3 0 4 7)",
        ),
        (
            "hex",
            "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1",
            "4(3 2 1 0) 4(4 5 6 7) 4(0 1 5 4) 4(1 2 6 5) 4(2 3 7 6) 4(3 0 4 7)",
        ),
    ];
    for (name, points, faces) in rows {
        let values: Vec<f64> = numbers(points);
        let triples: String = values.chunks(3).map(|p| format!("({} {} {})", p[0], p[1], p[2])).collect();
        let count = faces.matches('(').count();
        let files = [
            ("points", format!("{}({triples})", head("points"))),
            ("faces", format!("{}{count}({faces})", head("faces"))),
            ("owner", format!("{}{count}{{0}}", head("owner"))),
            ("neighbour", format!("{}0()", head("neighbour"))),
        ];
        let files = files.map(|(name, text)| (name.to_owned(), text.into_bytes())).to_vec();
        let mesh = read_mesh(&files).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(holds(&mesh), format!("{} nodes, {name}:1", values.len() / 3));
        assert_eq!(mesh.nodes.unused(), 0);
    }
}

#[test]
fn a_mesh_is_found_by_its_folder_its_case_or_one_of_its_files() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let at = |inner: &str| folder.path().join(inner);
    let put = |inner: &str| {
        fs::create_dir_all(at(inner)).expect("a folder");
        files("mixed_ascii")
            .iter()
            .for_each(|(name, bytes)| fs::write(at(inner).join(name), bytes).expect("written"));
    };
    put("case/constant/polyMesh");
    put("regions/constant/water/polyMesh");
    put("apart/processor0/constant/polyMesh");
    put("apart/processor1/constant/polyMesh");
    put("together/processors2/constant/polyMesh");
    fs::write(at("case/case.foam"), "").expect("written");
    for path in [
        "case",
        "case/constant/polyMesh",
        "case/constant/polyMesh/faces",
        "case/constant/polyMesh/neighbour",
        "case/case.foam",
        "regions/constant/water",
        "apart/processor1",
    ] {
        let mesh = read(&OpenFoam, &at(path)).unwrap_or_else(|e| panic!("{path}: {e}"));
        assert_eq!(holds(&mesh), "54 nodes, hex:8 prism:28", "{path}");
    }
    assert!(formats::files(&at("regions")).is_none());
    for path in ["apart", "together"] {
        let error = read(&OpenFoam, &at(path)).expect_err("decomposed").to_string();
        assert!(error.contains("reconstructParMesh"), "{error}");
    }
}

#[test]
fn errors_name_the_file_and_the_line() {
    let sound = files("mixed_ascii");
    let with = |name: &str, from: &str, to: &str| -> Files {
        let change = |(file, bytes): &(String, Vec<u8>)| {
            let text = String::from_utf8(bytes.clone()).expect("text");
            let text = if file == name { text.replacen(from, to, 1) } else { text };
            (file.clone(), text.into_bytes())
        };
        sound.iter().map(change).collect()
    };
    let rows = [
        (with("points", "\n54\n", "\n55\n"), "points: line 20: expected 55 points, found 54"),
        (with("points", "(0 0 0)", "(0 0)"), "points: line 21: expected a coordinate, found \")\""),
        (with("points", "(0 0 0)", "(0 0 0 0)"), "points: line 21: expected the end ) of a point"),
        (
            with("points", "format      ascii", "format      xml"),
            "points: line 1: expected format ascii or binary, found xml",
        ),
        (
            with("points", "FoamFile", "Foam"),
            "points: line 8: expected a header FoamFile { ... }, found \"Foam\"",
        ),
        (with("faces", "4(", "5("), "expected 5 points of a face, found 4"),
        (with("faces", "4(", "2("), "the end ) of a list after 2 points of a face, found"),
        (with("faces", "4(", "4(-"), "expected the number of a point, from 0 to 2147483647, found -"),
        (with("owner", "(\n0\n", "(\n"), "cells, one a face, found"),
        (with("owner", "(\n0\n", "(\n999999\n"), "owner: line 1: expected numbers of cells under"),
        (with("owner", "(\n0\n", "(\n0 x\n"), "line 22: expected numbers of cells, one a face, found \"x\""),
        (
            with("neighbour", ")", ""),
            "expected the end ) of a list after 64 numbers of cells, one a face, found the end",
        ),
    ];
    for (files, expected) in rows {
        let found = error(&files);
        assert!(found.contains(expected), "found    {found}\nexpected {expected}");
    }
    for absent in ["points", "neighbour"] {
        let files = sound.iter().filter(|file| file.0 != absent).cloned().collect();
        assert!(error(&files).contains("No such file"), "{absent}");
    }
    // A file that stands alone is known for what it is.
    let alone = super::super::testing::message(&OpenFoam, "x.msh", &sound[0].1);
    assert!(alone.contains("expected the files points, faces, owner and neighbour in one folder"), "{alone}");
}

#[test]
fn damaged_meshes_give_errors_and_no_panic() {
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    for mesh in ["mixed_ascii", "pyramids_binary"] {
        let sound = files(mesh);
        for (file, (name, bytes)) in sound.iter().enumerate() {
            for _ in 0..25 {
                let mut cut = sound.clone();
                let end = bytes.iter().rposition(|b| *b == b')').expect("a list's end");
                let at = random.below(end);
                cut[file].1.truncate(at);
                assert!(read_mesh(&cut).is_err(), "{mesh}/{name} cut at {at}");
            }
            for _ in 0..50 {
                let mut flipped = sound.clone();
                flipped[file].1[random.below(bytes.len())] ^= 1 << random.below(8);
                let _ = read_mesh(&flipped);
            }
        }
    }
}

#[test]
fn a_mesh_of_others_has_its_counts() {
    let Some(corpus) = corpus() else { return };
    let mesh =
        read(&OpenFoam, &corpus.join("openfoam/couette/polyMesh/points")).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(holds(&mesh), "410 nodes, hex:160");
}

#[test]
fn each_file_of_a_mesh_is_known_and_no_other() {
    for (name, bytes) in files("pyramids_binary") {
        assert!(OpenFoam.detect(&bytes[..bytes.len().min(HEAD_BYTES)]), "{name}");
    }
    for other in [
        "FoamFile { class volScalarField; object p; }",
        "FoamFile { class dictionary; object controlDict; }",
        "FoamFile",
    ] {
        assert!(!OpenFoam.detect(other.as_bytes()));
    }
}
