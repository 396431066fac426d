//! The reader against files of Gmsh and others, against hand-made files of every odd kind, and against damage.

mod written;

use std::path::{Path, PathBuf};

use serde_json::Value;

use super::Gmsh;
use crate::error::Result;
use crate::formats::reading::{Mesh, read};
use crate::formats::testing::{self, Row, check, corpus, counted, damage, detected};
use crate::mesh::Shape::{self, Hexahedron, Quadrilateral, Triangle, Wedge};

fn read_bytes(bytes: &[u8]) -> Result<Mesh> {
    testing::read_bytes(&Gmsh, "a.msh", bytes)
}

fn message(bytes: &[u8]) -> String {
    testing::message(&Gmsh, "a.msh", bytes)
}

fn own(name: &str) -> PathBuf {
    testing::own("gmsh").join(name)
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

#[test]
fn own_files_hold_what_gmsh_counts() {
    OWN.iter().for_each(|row| drop(check(&Gmsh, &own(""), row)));
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
    let Some(corpus) = corpus() else { return };
    CORPUS.iter().chain(OWN).for_each(|row| drop(check(&Gmsh, &corpus.join("gmsh"), row)));
}

#[test]
fn only_gmsh_files_of_the_corpus_are_detected() {
    let Some(corpus) = corpus() else { return };
    let mut expected: Vec<_> = CORPUS.iter().chain(OWN).map(|row| format!("gmsh/{}", row.0)).collect();
    expected.sort();
    assert_eq!(detected(&Gmsh, &corpus), expected);
}

#[test]
#[expect(clippy::disallowed_methods, reason = "the test's own small file")]
fn every_encoding_that_peers_write_is_read_as_they_see_it() {
    let Some(python) = std::env::var_os("MESHGAUGE_PYTHON") else {
        eprintln!("skipped: MESHGAUGE_PYTHON names no Python with gmsh and meshio");
        return;
    };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let folder = folder.path();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/peers/gmsh_encodings.py");
    let status = std::process::Command::new(python).arg(script).arg(folder).status();
    assert!(status.expect("Python").success());
    let rows = std::fs::read_to_string(folder.join("expected.jsonl")).expect("expected.jsonl");
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

/// The bytes up to the end of the elements.
fn elements_end(bytes: &[u8]) -> usize {
    let ends = [&b"$EndElements"[..], b"$ENDELM"];
    let ends = ends.map(|end| memchr::memmem::rfind(bytes, end).map(|k| k + end.len()));
    ends.into_iter().flatten().max().expect("the end of the elements")
}

#[test]
fn a_cut_file_is_an_error_and_a_flipped_bit_no_panic() {
    OWN.iter().for_each(|row| damage(&Gmsh, &own(row.0), elements_end));
}

#[test]
fn damaged_corpus_files_are_errors_too() {
    let Some(corpus) = corpus() else { return };
    CORPUS.iter().for_each(|row| damage(&Gmsh, &corpus.join("gmsh").join(row.0), elements_end));
}

/// Files of the partitions that Gmsh splits a mesh into hold the elements of their neighbours too, in entities of their own.
#[test]
fn elements_of_other_partitions_are_left_out_and_counted() {
    let rows = [("partition_1_of_2.msh", 92, 71), ("partition_2_of_2_bin.msh", 92, 68)];
    for (name, own_tetrahedra, ghosts) in rows {
        let mesh = testing::read_file(&Gmsh, &own(name));
        assert_eq!(
            (mesh.count(Shape::Tetrahedron), mesh.ledger.ghost_elements),
            (own_tetrahedra, ghosts),
            "{name}"
        );
    }
}
