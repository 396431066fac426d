//! Real files, files by hand, broken files.

use std::path::{Path, PathBuf};

use super::Matlab;
use crate::error::Result;
use crate::formats::reading::{Mesh, read};
use crate::formats::testing::{self, Random};
use crate::mesh::Shape;

#[expect(clippy::disallowed_methods, reason = "the test's own small files")]
fn bytes_of(path: &Path) -> Vec<u8> {
    std::fs::read(path).expect("a file of the test")
}

fn read_bytes(bytes: &[u8]) -> Result<Mesh> {
    testing::read_bytes(&Matlab, "a.mat", bytes)
}

fn lines(mesh: &Mesh) -> u64 {
    mesh.ledger.types.iter().filter(|row| row.name.starts_with("edge")).map(|row| row.count).sum()
}

fn own() -> [PathBuf; 2] {
    ["scipy_pit2d_pet_compressed.mat", "scipy_pit2d_o2_struct.mat"]
        .map(|name| Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes/matlab").join(name))
}

fn area(mesh: &Mesh) -> f64 {
    let cross = |c: &[[f64; 3]]| {
        (c[1][0] - c[0][0]) * (c[2][1] - c[0][1]) - (c[2][0] - c[0][0]) * (c[1][1] - c[0][1])
    };
    mesh.elements.iter().map(|element| cross(&element.2) / 2.0).sum()
}

#[test]
fn own_files_are_read() {
    let [linear, quadratic] = own().map(|path| read(&Matlab, &path).expect("a mesh"));
    assert_eq!((linear.nodes.count(), linear.count(Shape::Triangle), lines(&linear)), (220, 382, 56));
    assert_eq!((quadratic.nodes.count(), quadratic.count(Shape::Triangle)), (821, 382));
    assert_eq!((linear.nodes.unused(), quadratic.nodes.unused()), (0, 0));
    assert!((area(&linear) - area(&quadratic)).abs() < 1e-9 && area(&linear) > 30.0);
}

#[test]
fn every_version_holds_the_same_mesh() {
    let folder = testing::own("matlab");
    let linear = read(&Matlab, &own()[0]).expect("a mesh");
    let mut others = vec!["scipy_pit2d_v4.mat"];
    if cfg!(feature = "hdf5") {
        others.push("v73_pit2d_struct.mat");
    }
    for name in others {
        let path = folder.join(name);
        let other = read(&Matlab, &path).unwrap_or_else(|e| panic!("{e}"));
        testing::same_elements(&other, &linear, 0.0);
        testing::damage(&Matlab, &path, <[u8]>::len);
    }
}

#[test]
fn corpus_files_have_the_counts_of_other_readers() {
    let Some(corpus) = testing::corpus() else { return };
    let rows = [
        ("pdetool_halfmesh_p_e_t.mat", 407, 752, 100),
        ("synthetic_pit2d_v5_compressed.mat", 220, 382, 56),
        ("synthetic_pit2d_v4.mat", 220, 382, 56),
        #[cfg(feature = "hdf5")]
        ("synthetic_pit2d_v73.mat", 220, 382, 56),
        ("hageman_metal_electrolyte_cells.mat", 6081, 1662 + 1332, 10 + 10 + 4 * 18 + 174),
    ];
    for (name, nodes, triangles, edges) in rows {
        let mesh = read(&Matlab, &corpus.join("matlab").join(name)).expect("a mesh");
        assert_eq!(
            (mesh.nodes.count(), mesh.count(Shape::Triangle), lines(&mesh)),
            (nodes, triangles, edges),
            "{name}"
        );
        assert!(mesh.elements.iter().all(|element| {
            let c = &element.2;
            (c[1][0] - c[0][0]) * (c[2][1] - c[0][1]) > (c[2][0] - c[0][0]) * (c[1][1] - c[0][1])
        }));
    }
}

#[test]
fn a_file_that_ends_too_early_is_an_error() {
    for path in own() {
        let bytes = bytes_of(&path);
        for k in 0..50 {
            let error = read_bytes(&bytes[..(bytes.len() - 8) * k / 50]).expect_err("cut off");
            assert!(error.path().is_some(), "{error}");
        }
    }
}

#[test]
fn a_file_with_flipped_bytes_is_read_or_refused() {
    let mut random = Random(0x2007_0503);
    for path in own() {
        let bytes = bytes_of(&path);
        for k in 0..200 {
            let mut broken = bytes.clone();
            // The heads of variables are few bytes: half of the flips go there.
            let within = if k % 2 == 0 { broken.len() } else { 400 };
            for _ in 0..1 + random.below(3) {
                let at = random.below(within);
                broken[at] = random.below(256) as u8;
            }
            if let Err(error) = read_bytes(&broken) {
                assert!(!error.is_resource(), "{error}");
            }
        }
    }
}

/// A file by hand, after MathWorks' description of the format.
struct File {
    bytes: Vec<u8>,
    is_big: bool,
}

impl File {
    fn new(is_big: bool) -> Self {
        let mut bytes = b"MATLAB 5.0 MAT-file, by hand".to_vec();
        bytes.resize(124, b' ');
        bytes.extend(if is_big { *b"\x01\x00MI" } else { *b"\x00\x01IM" });
        Self { bytes, is_big }
    }

    fn number(&self, bytes: &[u8]) -> Vec<u8> {
        if self.is_big { bytes.iter().rev().copied().collect() } else { bytes.to_vec() }
    }

    fn element(&self, kind: u32, data: &[u8]) -> Vec<u8> {
        let mut element = self.number(&kind.to_le_bytes());
        element.extend(self.number(&(data.len() as u32).to_le_bytes()));
        element.extend(data);
        element.resize(element.len().next_multiple_of(8), 0);
        element
    }

    /// A matrix of class double whose numbers are stored as bytes, or as doubles where one is not whole.
    fn matrix(mut self, name: &str, rows: u32, columns: u32, values: &[f64]) -> Self {
        let whole = values.iter().all(|value| value.fract() == 0.0 && (0.0..256.0).contains(value));
        let data: Vec<u8> = if whole {
            values.iter().map(|value| *value as u8).collect()
        } else {
            values.iter().flat_map(|value| self.number(&value.to_le_bytes())).collect()
        };
        let mut sizes = self.number(&rows.to_le_bytes());
        sizes.extend(self.number(&columns.to_le_bytes()));
        let mut flags = self.number(&6u32.to_le_bytes());
        flags.extend([0; 4]);
        let parts = [
            self.element(6, &flags),
            self.element(5, &sizes),
            self.element(1, name.as_bytes()),
            self.element(if whole { 2 } else { 9 }, &data),
        ];
        let matrix = self.element(14, &parts.concat());
        self.bytes.extend(matrix);
        self
    }
}

const SQUARE: [f64; 8] = [0.0, 0.0, 1.5, 0.0, 1.5, 1.0, 0.0, 1.0];
const SQUARE_IN_ROWS: [f64; 8] = [0.0, 1.5, 1.5, 0.0, 0.0, 0.0, 1.0, 1.0];

#[test]
fn either_way_up_and_either_byte_order_give_one_mesh() {
    for is_big in [false, true] {
        let files = [
            File::new(is_big).matrix("t", 4, 2, &[1., 2., 3., 9., 1., 3., 4., 9.]).matrix("p", 2, 4, &SQUARE),
            File::new(is_big).matrix("node", 4, 2, &SQUARE_IN_ROWS).matrix(
                "elem",
                2,
                3,
                &[1., 1., 2., 3., 3., 4.],
            ),
            File::new(is_big).matrix("Nodes", 2, 4, &SQUARE).matrix(
                "Elements",
                3,
                2,
                &[1., 2., 3., 1., 3., 4.],
            ),
        ];
        for file in files {
            let mesh = read_bytes(&file.bytes).expect("a mesh");
            assert_eq!(mesh.nodes.count(), 4);
            let corners: Vec<_> = mesh.elements.iter().map(|e| (e.0, e.2.clone())).collect();
            let [a, b, c, d] = [[0.0, 0.0, 0.0], [1.5, 0.0, 0.0], [1.5, 1.0, 0.0], [0.0, 1.0, 0.0]];
            assert_eq!(corners, [(1, vec![a, b, c]), (2, vec![a, c, d])]);
        }
    }
}

#[test]
fn tetrahedra_of_the_toolbox_have_five_rows() {
    let points = [0., 0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1.];
    let file = File::new(false).matrix("p", 3, 4, &points).matrix("t", 5, 1, &[1., 2., 3., 4., 1.]);
    assert_eq!(read_bytes(&file.bytes).expect("a mesh").count(Shape::Tetrahedron), 1);
}

#[test]
fn what_is_wrong_with_a_file_is_said() {
    let file = || File::new(false).matrix("p", 2, 4, &SQUARE);
    let t = [1., 2., 3., 1.];
    let mut version = file().matrix("t", 4, 1, &t).bytes;
    version[124] = 7;
    let mut size = file().matrix("t", 4, 1, &t).bytes;
    size[160] = 3;
    let rows = [
        (file().matrix("xy", 2, 4, &SQUARE).matrix("t", 4, 1, &t).bytes, "found p (2 x 4), xy (2 x 4)"),
        (file().matrix("t", 4, 1, &t).matrix("tri", 3, 1, &t[..3]).bytes, "found t (4 x 1), tri (3 x 1)"),
        (
            file().matrix("u", 1, 4, &t).bytes,
            "expected one matrix of elements (t, Elements) for points of 2 coordinates, found none among p (2 x 4), u (1 x 4)",
        ),
        (File::new(false).bytes, "found no variable"),
        (
            file().matrix("t", 4, 1, &[1., 2., 2.5, 1.]).bytes,
            "expected a point's number, 1 or more, in t of element 1, found 2.5",
        ),
        (file().matrix("t", 4, 1, &[0., 2., 3., 1.]).bytes, "in t of element 1, found 0"),
        (file().matrix("t", 4, 1, &[1., 2., 5., 1.]).bytes, "element 1 names node 5"),
        (version, "byte 124: expected version 0x0100 and IM or MI"),
        (size, "expected 3 x 4 numbers of 8 bytes (p), found 64 bytes"),
    ];
    for (bytes, expected) in rows {
        let error = read_bytes(&bytes).expect_err(expected).to_string();
        assert!(error.contains(expected), "{error}\n  lacks {expected}");
    }
}
