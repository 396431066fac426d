//! The reader against files of Gmsh and others, against hand-made files of every odd kind, and against damage.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::Gmsh;
use crate::error::{At, Result};
use crate::formats::Format;
use crate::formats::reading::{Mesh, read};
use crate::mesh::Shape::{self, Hexahedron, Pyramid, Quadrilateral, Tetrahedron, Triangle, Wedge};

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
    let Some(folder) = folder("MESHGAUGE_GMSH_PEERS") else { return };
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

/// A tetrahedron in MSH 2.2 text, with what stands in the braces of each section.
fn v2(nodes: &str, elements: &str) -> String {
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{nodes}\n$EndNodes\n$Elements\n{elements}\n$EndElements\n"
    )
}

fn v4(version: &str, nodes: &str, elements: &str) -> String {
    v2(nodes, elements).replace("2.2 0 8", version)
}

const NODES: &str = "4\n1 0 0 0\n2 1 0 0\n30 0 1 0\n4 0 0 1";

#[test]
fn rows_of_version_2_have_any_number_of_tags_and_mixed_types() {
    let elements = "7\n1 15 2 0 1 1\n2 1 0 1 2\n3 4 2 -1 -2 1 2 30 4\n10 2 6 1 1 3 1 -2 -3 1 2 30\n\
                    11 34 2 0 0 3 1 2 4\n12 2 2 0 0 1 2 4 \n13 11 2 0 0 1 2 30 4 1 1 1 1 1 1";
    let mesh = read_bytes(v2(NODES, elements).as_bytes()).expect("readable");
    assert_eq!((mesh.count(Tetrahedron), mesh.count(Triangle)), (2, 2));
    assert_eq!([counted(&mesh, "point"), counted(&mesh, "line"), counted(&mesh, "polygon")], [1, 1, 1]);
    assert_eq!(mesh.elements.iter().map(|e| e.0).collect::<Vec<_>>(), [10, 12, 3, 13]);
    assert_eq!(mesh.elements[2].2, [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]]);
}

#[test]
fn nodes_of_version_2_may_be_parametric_or_numbered_from_0() {
    let parametric = "4\n0 0 0 0 0 1\n1 1 0 0 1 1 0.5\n2 0 1 0 2 -1 0.5 0.5\n3 0 0 1 3 1";
    let text = v2(parametric, "1\n1 4 0 0 1 2 3").replace("Nodes", "ParametricNodes");
    let mesh = read_bytes(text.as_bytes()).expect("readable");
    assert_eq!((mesh.nodes.count(), mesh.count(Tetrahedron)), (4, 1));
}

#[test]
fn records_of_parametric_nodes_in_binary_version_2_differ_in_length() {
    let mut bytes = b"$MeshFormat\n2.2 1 8\n\x00\x00\x00\x01\n$EndMeshFormat\n$ParametricNodes\n3\n".to_vec();
    for (id, parameters) in [(1i32, 0), (2, 1), (3, 2)] {
        bytes.extend(id.to_be_bytes());
        [f64::from(id), f64::from(id * id), 0.0].iter().for_each(|x| bytes.extend(x.to_be_bytes()));
        [parameters, 5].iter().for_each(|x: &i32| bytes.extend(x.to_be_bytes()));
        (0..parameters).for_each(|_| bytes.extend(0.5f64.to_be_bytes()));
    }
    bytes.extend(b"\n$EndParametricNodes\n$Elements\n1\n");
    [2i32, 1, 0, 77, 1, 2, 3].iter().for_each(|x| bytes.extend(x.to_be_bytes()));
    bytes.extend(b"$EndElements");
    let mesh = read_bytes(&bytes).expect("readable");
    assert_eq!(mesh.elements, [(77, Triangle, vec![[1., 1., 0.], [2., 4., 0.], [3., 9., 0.]])]);
}

#[test]
fn version_1_is_read() {
    let text = "$NOD\n5\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n$ENDNOD\n$ELM\n1\n8 7 1 1 5 1 2 3 4 5\n$ENDELM\n";
    let mesh = read_bytes(text.as_bytes()).expect("readable");
    assert_eq!((mesh.elements[0].0, mesh.count(Pyramid)), (8, 1));
    assert!(message(text.replace(" 1 5 1 2", " 1 4 1 2").as_bytes()).contains("5 nodes of a Pyramid 5"));
}

#[test]
fn blocks_of_version_4_may_be_empty_parametric_and_of_negative_entities() {
    let nodes = "4 4 1 40\n0 -1 0 1\n1\n0 0 0\n1 2 1 1\n2\n1 0 0 0.25\n2 5 1 0\n3 1 1 2\n30\n40\n0 1 0 1 2 3\n0 0 1 4 5 6";
    let elements = "2 2 9 11\n3 -1 4 2\n9 1 2 30 40\n11 1 2 40 30 \n2 1 2 0";
    let mesh = read_bytes(v4("4.1 0 8", nodes, elements).as_bytes()).expect("readable");
    assert_eq!((mesh.nodes.count(), mesh.count(Tetrahedron)), (4, 2));
    let nodes = "2 4\n-1 0 0 2\n1 0 0 0\n2 1 0 0\n5 2 1 2\n30 0 1 0 0.5 0.5\n40 0 0 1 0 0";
    let mesh = read_bytes(v4("4 0 8", nodes, "1 1\n-1 3 4 1\n9 1 2 30 40").as_bytes()).expect("readable");
    assert_eq!((mesh.nodes.count(), mesh.count(Tetrahedron)), (4, 1));
}

#[test]
fn other_sections_comments_and_blank_lines_are_passed_over() {
    let text = v2(NODES, "1\n1 4 0 1 2 30 4");
    let odd = "\n$Comments\n$MeshFormat of old\n $EndComments\nnot the end: $EndCommentsX\n$EndComments\n\n$Mine\n$EndMine\n";
    let mixed = format!("{odd}{}", text.replace("$Elements\n", &format!("{odd}$Elements\n")));
    assert!(Gmsh.detect(mixed.as_bytes()));
    assert_eq!(read_bytes(mixed.as_bytes()).expect("readable").count(Tetrahedron), 1);
    assert_eq!(read_bytes(mixed.replace('\n', "\r\n").as_bytes()).expect("readable").count(Tetrahedron), 1);
}

#[test]
fn long_blocks_are_cut_into_pieces_that_join_to_the_same_mesh() {
    let count = 60_000u64;
    let mut tags: Vec<u64> = (0..count).map(|k| 1 + (k * 7919) % count).collect();
    tags.swap(5, 50_000);
    let point = |tag: u64| [tag as f64, (tag * tag % 1000) as f64 / 8.0, 0.5];
    let row = |p: [f64; 3]| format!("{} {} {}", p[0], p[1], p[2]);
    let joined = |rows: &mut dyn Iterator<Item = String>| rows.collect::<Vec<_>>().join("\n");
    let triangles = (1..=count - 2).map(|k| (k + 100, [k, k + 1, k + 2]));
    let tagged = joined(&mut tags.iter().map(|&t| format!("{t} {}", row(point(t)))));
    let alone = joined(&mut tags.iter().map(u64::to_string));
    let points = joined(&mut tags.iter().map(|&t| row(point(t))));
    let rows = |middle: &str| {
        joined(&mut triangles.clone().map(|(l, [a, b, c])| format!("{l} {middle}{a} {b} {c}")))
    };
    let elements = count - 2;
    let texts = [
        v2(&format!("{count}\n{tagged}"), &format!("{elements}\n{}", rows("2 2 1 1 "))),
        v4(
            "4.0 0 8",
            &format!("1 {count}\n1 2 0 {count}\n{tagged}"),
            &format!("1 {elements}\n1 2 2 {elements}\n{}", rows("")),
        ),
        v4(
            "4.1 0 8",
            &format!("1 {count} 1 {count}\n2 1 0 {count}\n{alone}\n{points}"),
            &format!("1 {elements} 101 9\n2 1 2 {elements}\n{}", rows("")),
        ),
    ];
    for text in texts {
        let mesh = read_bytes(text.as_bytes()).expect("readable");
        assert_eq!((mesh.nodes.count(), mesh.count(Triangle) as u64), (count, elements));
        for ((label, _, corners), (expected, nodes)) in mesh.elements.iter().zip(triangles.clone()) {
            assert_eq!((*label, &corners[..]), (expected, &nodes.map(point)[..]));
        }
    }
}

#[test]
fn errors_name_the_line_and_what_stood_there() {
    let tet = "1\n1 4 0 1 2 30 4";
    let rows = [
        (
            v2(NODES, "2\n1 4 0 1 2 30 4"),
            "line 14: expected rows of elements, 2 in all, and not only 1, found \"$EndElements\"",
        ),
        (v2(NODES, "0\n1 4 0 1 2 30 4"), "line 13: expected $EndElements, found \"1 4 0 1 2 30 4\""),
        (
            v2(NODES, "1\n1 4 0 1 2 30"),
            "line 13: expected the tag of an element's node, found the end of the row",
        ),
        (v2(NODES, "1\n1 4 0 1 2 30 4 5"), "line 13: expected the end of the row, found \"5\""),
        (v2(NODES, "1\n1 4 0 1 2 30 -4"), "line 13: expected the tag of an element's node, found \"-4\""),
        (v2(NODES, "1\n1 4 0 1 2 30 5"), "line 13: element 1 names node 5, which the file does not define"),
        (
            v2(NODES, "1\n1 141 0 1"),
            "line 13: expected the number of an element type of Gmsh (1 to 140), found 141",
        ),
        (v2("1\n-1 0 0 0", tet), "line 6: expected a node's tag, found \"-1 0 0 0\""),
        (v2("1\n1 0 0", tet), "line 6: expected a node's z, found the end of the row"),
        (v2("1\n1 0 0 nan", tet), "line 6: expected finite coordinates, found [0.0, 0.0, NaN]"),
        (v2("1\n1 0 0 0x", tet), "line 6: expected a node's z, found \"0x\""),
        (v2("x\n1 0 0 0", tet), "line 5: expected the number of nodes, found \"x\""),
        (
            v2("1000000000000000000\n1 0 0 0", tet),
            "line 7: expected rows of nodes, 1000000000000000000 in all, and not only 1, found \"$EndNodes\"",
        ),
        (
            v4("4.1 0 8", "1 1 1 1\n3 1 0 1\n0\n0 0 0", "0 0 0 0"),
            "line 7: expected a node's tag, which is positive, found 0",
        ),
        (
            v4("4.1 0 8", "1 2 1 1\n3 1 0 1\n1\n0 0 0", "0 0 0 0"),
            "line 8: expected 2 nodes, as the head of the section says, found 1 in its blocks",
        ),
        (
            v4("4.1 0 8", "1 1 1 1\n4 1 0 1\n1\n0 0 0", "0 0 0 0"),
            "line 6: expected the dimension of an entity, 0 to 3, found 4",
        ),
        (
            v4("4.1 0 8", "1 1 1 1\n3 1 2 1\n1\n0 0 0", "0 0 0 0"),
            "line 6: expected 0 or 1, whether nodes are parametric, found 2",
        ),
        (
            v4("4.1 0 8", "9000000000000000000 1 1 1", "0 0 0 0"),
            "line 6: expected the dimension of an entity, found \"$EndNodes\"",
        ),
        (v4("3 0 8", NODES, tet), "line 2: Gmsh MSH version 3 is not read (1, 2.0 to 2.2, 4.0 and 4.1 are)"),
        (v4("4 1 8", NODES, tet), "line 2: binary Gmsh MSH 4.0 is not read"),
        (v4("2.2 1 4", NODES, tet), "line 2: binary Gmsh MSH of data size 4 is not read"),
        (v4("2.2 2 8", NODES, tet), "line 2: expected a file type, 0 for text or 1 for binary, found 2"),
        (v4("2.2 0", NODES, tet), "line 2: expected a data size, found the end of the row"),
        (v4("2.2 1 8", NODES, tet), "byte 20: expected the number 1 of four bytes, found \"$EndMeshFormat\""),
        (
            "$Nodes\n1\n$EndNodes\n".into(),
            "line 1: expected a section $MeshFormat before nodes and elements, found none",
        ),
        (
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$NodeData\n".into(),
            "line 5: expected $EndNodeData, found the end of the file",
        ),
        (
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n".into(),
            "line 4: expected a section $Nodes, found the end of the file",
        ),
    ];
    for (text, expected) in rows {
        assert_eq!(message(text.as_bytes()), expected);
    }
}

#[test]
fn counts_in_binary_heads_are_not_believed() {
    let head =
        |version: &str| format!("$MeshFormat\n{version} 1 8\n\x01\0\0\0\n$EndMeshFormat\n").into_bytes();
    let words = |words: &[u64]| words.iter().flat_map(|w| w.to_le_bytes()).collect::<Vec<u8>>();
    let huge = i64::MAX as u64;
    let nodes = [&head("4.1")[..], b"$Nodes\n", &words(&[1, huge, 1, huge, 3, 0]), &[0; 4]].concat();
    let rows = [
        (
            [&nodes[..nodes.len() - 8], &words(&[huge])].concat(),
            "nodes of a block, found the end of the file",
        ),
        (
            [&head("4.1")[..], b"$Nodes\n", &words(&[huge, 0, 0, 0])].concat(),
            "expected the head of a block of nodes",
        ),
        (
            [&head("4.1")[..], b"$Nodes\n", &words(&[u64::MAX, 0, 0, 0])].concat(),
            "expected a count, found -1",
        ),
        ([&head("2.2")[..], b"$Nodes\n2147483647\n"].concat(), "2147483647 nodes, found the end of the file"),
        (
            [&head("2.2")[..], b"$Nodes\n0\n$EndNodes\n$Elements\n9\n\x04\0\0\0\xff\xff\xff\x7f\0\0\0\0"]
                .concat(),
            "2147483647 elements of a block, found the end of the file",
        ),
        (
            [&head("2.2")[..], b"$Nodes\n0\n$EndNodes\n$Elements\n9\n\x22\0\0\0\x01\0\0\0\0\0\0\0"].concat(),
            "does not store the nodes of a Polygon",
        ),
    ];
    for (bytes, expected) in rows {
        let found = message(&bytes);
        assert!(found.starts_with("byte ") && found.contains(expected), "{found}");
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
