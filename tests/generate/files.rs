//! What is written is what was walked, in every format and encoding, whole and in its place.

use std::fs;
use std::io::Write;

use meshgauge::generate::{self, Encoding, Problem, WRITERS};

use crate::{nodes, problem};

fn bytes(problem: &Problem, name: &str, encoding: Encoding) -> Vec<u8> {
    let mut bytes = Vec::new();
    let writer = generate::writer_for(name.as_ref()).unwrap();
    writer.write(problem, encoding, &mut bytes).unwrap();
    bytes
}

#[test]
fn abaqus_has_every_digit() {
    let case = problem("fd-cylinder", &["strips=5", "rings=2", "layers=1", "radius=0.1"]);
    let text = String::from_utf8(bytes(&case, "a.inp", Encoding::Default)).unwrap();
    let rows = |keyword: &str| -> Vec<Vec<f64>> {
        let after = text.lines().skip_while(|line| !line.starts_with(keyword)).skip(1);
        let rows = after.take_while(|line| !line.starts_with('*'));
        rows.map(|row| row.split(", ").map(|field| field.parse().unwrap()).collect()).collect()
    };
    let expected: Vec<_> = nodes(case.mesh());
    let found: Vec<_> = rows("*NODE").iter().map(|row| [row[1], row[2], row[3]]).collect();
    assert_eq!(found, expected);
    let wedges = rows("*ELEMENT, TYPE=C3D6");
    assert_eq!(wedges[0], [6.0, 1.0, 2.0, 3.0, 12.0, 13.0, 14.0]);
    assert_eq!((wedges.len(), rows("*ELEMENT, TYPE=C3D8").len()), (5, 5));
}

/// The 64-bit numbers from `at` on.
fn words(bytes: &[u8], at: usize, count: usize) -> Vec<u64> {
    let words = bytes[at..at + 8 * count].chunks_exact(8);
    words.map(|word| u64::from_le_bytes(word.try_into().unwrap())).collect()
}

fn after(bytes: &[u8], mark: &[u8]) -> usize {
    bytes.windows(mark.len()).position(|window| window == mark).unwrap() + mark.len()
}

#[test]
fn gmsh_binary_and_text_hold_the_same() {
    let case = problem("mapped-disc", &["divisions=3"]);
    let text = String::from_utf8(bytes(&case, "a.msh", Encoding::Text)).unwrap();
    let binary = bytes(&case, "a.msh", Encoding::Binary);
    let expected = nodes(case.mesh());

    // Four sizes, three 32-bit numbers, a size, the tags; then the coordinates.
    let at = after(&binary, b"$Nodes\n") + 4 * 8 + 3 * 4 + 8 + 16 * 8;
    let found: Vec<_> = words(&binary, at, 48).into_iter().map(f64::from_bits).collect();
    assert_eq!(found, expected.as_flattened());
    let lines = text.lines().skip_while(|line| *line != "$Nodes").skip(1 + 2 + 16).take(16);
    let found: Vec<f64> = lines.flat_map(|line| line.split(' ')).map(|x| x.parse().unwrap()).collect();
    assert_eq!(found, expected.as_flattened());

    let at = after(&binary, b"$Elements\n") + 4 * 8 + 3 * 4 + 8;
    let found = words(&binary, at, 9 * 5);
    let lines = text.lines().skip_while(|line| *line != "$Elements").skip(1 + 2).take(9);
    let in_text: Vec<u64> = lines.flat_map(|line| line.split(' ')).map(|x| x.parse().unwrap()).collect();
    assert_eq!(found, in_text);
    assert_eq!(found[..5], [1, 1, 2, 6, 5]);
    assert!(binary.ends_with(b"\n$EndElements\n") && text.ends_with("\n$EndElements\n"));
}

/// The offset that the XML gives for the array, and where the data begin.
fn appended(bytes: &[u8], name: &str) -> usize {
    let array = &bytes[after(bytes, format!("Name=\"{name}\"").as_bytes())..];
    let offset = &array[after(array, b"offset=\"")..];
    let digits = offset.iter().take_while(|byte| byte.is_ascii_digit());
    let offset = digits.fold(0, |number, digit| 10 * number + usize::from(digit - b'0'));
    after(bytes, b"<AppendedData encoding=\"raw\">\n   _") + offset
}

#[test]
fn vtu_raw_and_compressed_hold_the_same() {
    let case = problem("fd-cylinder", &[]);
    let raw = bytes(&case, "a.vtu", Encoding::Binary);
    let packed = bytes(&case, "a.vtu", Encoding::Compressed);
    for name in ["Points", "connectivity", "offsets", "types"] {
        let at = appended(&raw, name);
        let size = words(&raw, at, 1)[0] as usize;
        let expected = &raw[at + 8..][..size];

        let at = appended(&packed, name);
        let header = words(&packed, at, 3);
        let [blocks, block_size, last] = [0, 1, 2].map(|k| header[k] as usize);
        let mut block_at = at + 24 + 8 * blocks;
        let mut found = Vec::new();
        for size in words(&packed, at + 24, blocks) {
            let block = &packed[block_at..][..size as usize];
            flate2::write::ZlibDecoder::new(&mut found).write_all(block).unwrap();
            block_at += size as usize;
        }
        assert_eq!(found, expected, "{name}");
        assert_eq!(found.len() % block_size, last, "{name}");
    }
    let points: Vec<_> = words(&raw, appended(&raw, "Points") + 8, 3 * 19811);
    assert!(nodes(case.mesh()).as_flattened().iter().map(|x| x.to_bits()).eq(points));
    assert!(raw.ends_with(b"\n  </AppendedData>\n</VTKFile>\n"));
}

#[test]
fn a_file_is_placed_whole_and_compressed_by_its_extension() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let case = problem("mapped-disc", &["divisions=5"]);
    let expected = bytes(&case, "a.msh", Encoding::Default);
    let written = |name: &str| {
        let counts = generate::write_file(&case, Encoding::Default, &folder.path().join(name)).unwrap();
        assert_eq!((counts.nodes, counts.elements), (36, 25));
        fs::read(folder.path().join(name)).unwrap()
    };
    assert_eq!(written("a.msh"), expected);
    assert_eq!(zstd::decode_all(&*written("a.msh.zst")).unwrap(), expected);
    let mut unpacked = Vec::new();
    flate2::write::GzDecoder::new(&mut unpacked).write_all(&written("a.msh.gz")).unwrap();
    assert_eq!(unpacked, expected);
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 3, "a temporary file is left");
    let mode = fs::metadata(folder.path().join("a.msh")).unwrap().permissions().mode();
    let plain =
        fs::File::create(folder.path().join("plain")).unwrap().metadata().unwrap().permissions().mode();
    assert_eq!(mode, plain);
}

#[test]
fn a_link_is_followed_and_not_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let (real, link) = (folder.path().join("real.inp"), folder.path().join("link.inp"));
    fs::write(&real, "old").unwrap();
    std::os::unix::fs::symlink(&real, &link).unwrap();
    let case = problem("mapped-disc", &["divisions=1"]);
    generate::write_file(&case, Encoding::Default, &link).unwrap();
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(fs::read(&real).unwrap(), bytes(&case, "a.inp", Encoding::Default));
}

#[test]
fn what_cannot_be_written_is_said_and_nothing_is_touched() {
    let folder = tempfile::tempdir().unwrap();
    let case = problem("mapped-disc", &[]);
    let error =
        |name: &str, encoding| generate::write_file(&case, encoding, &folder.path().join(name)).unwrap_err();
    let unknown = error("mesh.stl", Encoding::Default);
    assert!(unknown.is_usage());
    let message = unknown.to_string();
    assert!(message.contains("expected .inp (abaqus), .msh (gmsh), .mesh (medit), .su2 (su2), .vtk (vtk), .vtu (vtu), found \".stl\""), "{message}");
    assert!(error("mesh", Encoding::Default).to_string().contains("found none"));
    assert_eq!(
        error("mesh.inp", Encoding::Compressed).to_string(),
        "abaqus is not written as compressed, only as text"
    );
    let nowhere = error("no/such/folder/mesh.inp", Encoding::Default);
    assert!(nowhere.to_string().contains("mesh.inp: could not be written"), "{nowhere}");
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
}

#[test]
fn a_full_disk_is_the_machines_fault() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.vtu");
    std::os::unix::fs::symlink("/dev/full", &path).unwrap();
    let error = generate::write_file(&problem("mapped-disc", &[]), Encoding::Default, &path).unwrap_err();
    assert!(error.is_resource(), "{error}");
}

/// What was found in the elements, but for the numbers of elements, which count from 0 or from 1.
fn found(path: &std::path::Path) -> serde_json::Value {
    let summary = meshgauge::score(path, &meshgauge::Options::default()).unwrap();
    let mut shapes = serde_json::to_value(&summary.shapes).unwrap();
    for shape in shapes.as_object_mut().unwrap().values_mut() {
        for measure in shape["measures"].as_object_mut().unwrap().values_mut() {
            measure.as_object_mut().unwrap().remove("min_element");
        }
    }
    serde_json::json!({ "shapes": shapes, "nodes": summary.nodes, "totals": summary.totals })
}

#[test]
fn every_writer_in_every_encoding_is_read_back_to_the_same_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let cases = [
        problem("mapped-disc", &["divisions=7"]),
        problem("fd-cylinder", &["strips=8", "rings=3", "layers=2", "radius=0.1"]),
        problem("swept-cylinder", &["elements=tetrahedra", "divisions=3", "layers=2"]),
    ];
    for case in &cases {
        let expected = folder.path().join("expected.inp");
        generate::write_file(case, Encoding::Text, &expected).unwrap();
        let expected = found(&expected);
        for writer in WRITERS {
            for encoding in writer.encodings {
                let path = folder.path().join(format!("a.{}", writer.extensions[0]));
                generate::write_file(case, *encoding, &path).unwrap();
                assert_eq!(found(&path), expected, "{case} as {} {encoding:?}", writer.name);
            }
        }
    }
}
