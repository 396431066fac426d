//! Real files, files by hand, broken files.

use std::path::{Path, PathBuf};

use super::{Obj, Off, Ply, Stl};
use crate::error::Result;
use crate::formats::reading::{Mesh, read};
use crate::formats::testing::{self, Random};
use crate::formats::{FORMATS, Format, HEAD_BYTES};
use crate::mesh::Shape;

#[expect(clippy::disallowed_methods, reason = "the test's own small files")]
fn bytes_of(path: &Path) -> Vec<u8> {
    std::fs::read(path).expect("a file of the test")
}

fn read_bytes(format: &dyn Format, bytes: &[u8]) -> Result<Mesh> {
    testing::read_bytes(format, "a", bytes)
}

/// Nodes, triangles, quadrilaterals, polygons and unused nodes.
type Counts = (u64, usize, usize, u64, u64);

fn counts(mesh: &Mesh) -> Counts {
    let polygons = mesh.ledger.types.iter().filter(|t| t.name == "polygon").map(|t| t.count).sum();
    let (triangles, quadrilaterals) = (mesh.count(Shape::Triangle), mesh.count(Shape::Quadrilateral));
    (mesh.nodes.count(), triangles, quadrilaterals, polygons, mesh.nodes.unused())
}

fn own() -> Vec<(&'static dyn Format, PathBuf, Counts)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes");
    let rows: [(&'static dyn Format, &str, _); 8] = [
        (&Off, "off/gmsh_pit_block.off", (131, 258, 0, 0, 0)),
        (&Obj, "obj/gmsh_pit_block.obj", (131, 258, 0, 0, 0)),
        (&Obj, "obj/meshio_mixed.obj", (54, 28, 36, 0, 5)),
        (&Ply, "ply/meshio_mixed_ascii.ply", (54, 28, 36, 0, 5)),
        (&Ply, "ply/meshio_mixed_little.ply", (54, 28, 36, 0, 5)),
        (&Ply, "ply/vtk_mixed_big.ply", (54, 28, 36, 0, 5)),
        (&Stl, "stl/gmsh_pit_block.stl", (131, 258, 0, 0, 0)),
        (&Stl, "stl/gmsh_pit_block_binary.stl", (131, 258, 0, 0, 0)),
    ];
    rows.into_iter().map(|(format, name, counts)| (format, folder.join(name), counts)).collect()
}

/// Area of all triangles and quadrilaterals.
fn area(mesh: &Mesh) -> f64 {
    let cross = |a: [f64; 3], b: [f64; 3], c: [f64; 3]| {
        let (u, v) = ([0, 1, 2].map(|k| b[k] - a[k]), [0, 1, 2].map(|k| c[k] - a[k]));
        let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        n.iter().map(|x| x * x).sum::<f64>().sqrt() / 2.0
    };
    let fan = |corners: &[[f64; 3]]| {
        (2..corners.len()).map(|k| cross(corners[0], corners[k - 1], corners[k])).sum::<f64>()
    };
    mesh.elements.iter().map(|element| fan(&element.2)).sum()
}

#[test]
fn own_files_have_their_counts_and_areas() {
    let mut areas = Vec::new();
    for (format, path, expected) in own() {
        let mesh = read(format, &path).expect("a mesh");
        assert_eq!(counts(&mesh), expected, "{}", path.display());
        areas.push((path, area(&mesh)));
    }
    for name in ["mixed", "pit_block"] {
        let areas: Vec<_> = areas.iter().filter(|row| row.0.to_string_lossy().contains(name)).collect();
        assert!(areas.len() >= 4);
        for row in &areas {
            assert!((row.1 / areas[0].1 - 1.0).abs() < 1e-5, "{row:?} {:?}", areas[0]);
        }
    }
}

#[test]
fn corpus_files_have_the_counts_of_other_readers() {
    let Some(corpus) = testing::corpus() else { return };
    let rows: [(&dyn Format, &str, _); 9] = [
        (&Off, "off/elmer_femur.off", (3897, 7798, 0)),
        (&Off, "off/elmer_sample.off", (8, 0, 6)),
        (&Off, "off/elmer_socket.off", (836, 1696, 0)),
        (&Ply, "ply/elmer_octahedron.ply", (6, 8, 0)),
        (&Ply, "ply/elmer_sphere.ply", (422, 840, 0)),
        (&Obj, "obj/pynastran_shuttle.obj", (310, 170, 223)),
        (&Stl, "stl/gmsh_box_ascii.stl", (292, 580, 0)),
        (&Stl, "stl/gmsh_box_bin.stl", (292, 580, 0)),
        (&Stl, "stl/gmsh_sphere.stl", (305, 606, 0)),
    ];
    for (format, name, expected) in rows {
        let mesh = read(format, &corpus.join(name)).expect("a mesh");
        let (nodes, triangles, quadrilaterals, ..) = counts(&mesh);
        assert_eq!((nodes, triangles, quadrilaterals), expected, "{name}");
    }
}

fn files_below(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder").flatten().map(|entry| entry.path());
    entries.flat_map(|path| if path.is_dir() { files_below(&path) } else { vec![path] }).collect()
}

#[test]
fn detection_takes_its_own_files_of_the_corpus_and_no_others() {
    let Some(corpus) = testing::corpus() else { return };
    for path in files_below(&corpus) {
        let mut head = bytes_of(&path);
        head.truncate(HEAD_BYTES);
        for name in ["off", "ply", "obj", "stl", "matlab"] {
            let format = FORMATS.iter().find(|format| format.name() == name).expect("a format");
            let is_own = path.parent().and_then(Path::file_name).is_some_and(|folder| folder == name);
            assert_eq!(format.detect(&head), is_own, "{name}: {}", path.display());
        }
    }
}

#[test]
fn a_file_that_ends_too_early_is_an_error() {
    for (format, path, _) in own() {
        let bytes = bytes_of(&path);
        // A number that lost its last digit is still a number: cut before the last line.
        let end = bytes.len() - 40;
        for k in 0..50 {
            match read_bytes(format, &bytes[..end * k / 50]) {
                Err(error) => assert!(error.path().is_some(), "{error}"),
                // OBJ has no counts and no end mark.
                Ok(_) => assert_eq!(format.name(), "obj", "{}: cut at {k} of 50", path.display()),
            }
        }
    }
}

#[test]
fn a_file_with_flipped_bytes_is_read_or_refused() {
    let mut random = Random(0x2007_0412);
    for (format, path, _) in own() {
        let bytes = bytes_of(&path);
        for _ in 0..200 {
            let mut broken = bytes.clone();
            for _ in 0..1 + random.below(3) {
                let at = random.below(broken.len());
                broken[at] = random.below(256) as u8;
            }
            if let Err(error) = read_bytes(format, &broken) {
                let is_missing = matches!(error.kind(), crate::error::Kind::MissingNode { .. });
                assert!(!error.is_resource() && (is_missing || error.path().is_some()), "{error}");
            }
        }
    }
}

#[test]
fn off_with_comments_colours_polygons_and_counts_in_the_first_line() {
    let text = "# made by hand\r\nCOFF 6   2 # edges are not counted\r\n\r\n0 0 0 255 0 0 255\r\n1 0 0 1 1 1 1\r\n2 1 0\r\n\
        1 2 0\r\n0 1 0\r\n7 7 7\r\n 5 0 1 2 3 4 0.5 0.5 0.5\r\n# a face of three\r\n3 0 1 2 # the last\r\n";
    let mesh = read_bytes(&Off, text.as_bytes()).expect("a mesh");
    assert_eq!(counts(&mesh), (6, 1, 0, 1, 1));
    assert_eq!(mesh.elements[0].0, 1);
}

#[test]
fn what_is_wrong_with_an_off_file_is_said() {
    let rows = [
        ("4OFF\n1 1 0\n", "4OFF: only vertices of three coordinates are read"),
        ("OFF BINARY\n", "OFF BINARY: only OFF in text is read"),
        ("OFF\n3 1000000000000000000 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "more lines of faces"),
        ("OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", "expected one face or more, found points alone"),
        ("OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "line 4: expected z, found the end of the line"),
        ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "element 0 names node 3"),
        ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -2\n", "line 6: expected a vertex, found \"-2\""),
        ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 2\n", "line 7: expected the end of the file"),
        ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n1000000000000000000 0 1 2\n", "line 6: expected a vertex"),
    ];
    check_errors(&Off, &rows.map(|row| (row.0.as_bytes().to_vec(), row.1)));
}

fn check_errors(format: &dyn Format, rows: &[(Vec<u8>, &str)]) {
    for (bytes, expected) in rows {
        let error = read_bytes(format, bytes).expect_err(expected).to_string();
        assert!(error.contains(expected), "{error}\n  lacks {expected}");
    }
}

/// Faces before vertices, properties and elements that nobody needs, lists of other types.
#[test]
fn ply_follows_the_order_of_its_header() {
    let header = |format: &str| {
        format!(
            "ply\nformat {format} 1.0\ncomment by hand\nelement face 2\nproperty uchar red\nproperty list ushort short vertex_index\n\
            property list uchar float texcoord\nelement camera 1\nproperty double f\nelement vertex 4\nproperty list uchar char tags\n\
            property double z\nproperty short x\nproperty float y\nelement edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n"
        )
    };
    let text = header("ascii")
        + "9 3 0 1 2 2 0.5 0.5\n9 4 0 1 2 3 0\n35\n0 5 0 0\n2 1 1 5 1 0\n0 5 1 1\n0 5 0 1\n0 1\n";
    let texts = read_bytes(&Ply, text.as_bytes()).expect("a mesh");
    assert_eq!(counts(&texts), (4, 1, 1, 0, 0));
    for is_big in [false, true] {
        let mut file = header(if is_big { "binary_big_endian" } else { "binary_little_endian" }).into_bytes();
        let mut put = |mut bytes: Vec<u8>| {
            if is_big {
                bytes.reverse();
            }
            file.extend(bytes);
        };
        for (corners, texture) in [(&[0i16, 1, 2][..], &[0.5f32, 0.5][..]), (&[0, 1, 2, 3], &[])] {
            put(vec![9]);
            put((corners.len() as u16).to_le_bytes().to_vec());
            corners.iter().for_each(|corner| put(corner.to_le_bytes().to_vec()));
            put(vec![texture.len() as u8]);
            texture.iter().for_each(|value| put(value.to_le_bytes().to_vec()));
        }
        put(35f64.to_le_bytes().to_vec());
        for (tags, x, y) in [(&[][..], 0i16, 0f32), (&[1, 1], 1, 0.0), (&[], 1, 1.0), (&[], 0, 1.0)] {
            put(vec![tags.len() as u8]);
            put(tags.to_vec());
            put(5f64.to_le_bytes().to_vec());
            put(x.to_le_bytes().to_vec());
            put(y.to_le_bytes().to_vec());
        }
        put(0i32.to_le_bytes().to_vec());
        put(1i32.to_le_bytes().to_vec());
        let binary = read_bytes(&Ply, &file).expect("a mesh");
        assert_eq!((&binary.elements, &binary.ledger), (&texts.elements, &texts.ledger));
        file.pop();
        let error = read_bytes(&Ply, &file).expect_err("cut off").to_string();
        assert!(error.contains("1 rows of edge from byte"), "{error}");
    }
}

#[test]
fn what_is_wrong_with_a_ply_file_is_said() {
    let file = |from: &str, to: &str| {
        let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
            element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
        assert!(text.contains(from), "{from}");
        text.replacen(from, to, 1).into_bytes()
    };
    read_bytes(&Ply, &file("ply", "ply")).expect("a mesh");
    check_errors(
        &Ply,
        &[
            (file("ascii 1.0", "ascii 2.0"), "line 2: expected format ascii, binary_little_endian"),
            (file("end_header", "end_of_header"), "line 9: expected a line of the header"),
            (file("float x", "float u"), "expected properties x, y and z of element vertex, found u, y, z"),
            (file("uchar int", "float int"), "line 8: expected a property"),
            (file("uchar int", "uchar float"), "expected a list vertex_indices of whole numbers"),
            (file("element face", "element tristrips"), "strips of triangles (tristrips) are not read"),
            (file("element face", "element faces"), "expected one face or more"),
            (file("face 1\n", "face 1000000000000000000\n"), "more lines of face"),
            (file("vertex 3", "vertex 2"), "line 13: expected the end of the file after 3 rows"),
            (file("3 0 1 2\n", "3 0 1 2\n3 0 1 2\n"), "line 14: expected the end of the file after 4 rows"),
            (file("3 0 1 2", "0"), "line 13: expected a face of one corner or more"),
            (file("3 0 1 2", "3 0 1 -1"), "line 13: expected a vertex, found \"-1\""),
            (file("1 0 0", "1 0 inf"), "line 11: expected finite coordinates"),
            (file("ascii", "binary_little_endian"), "the end of the file"),
        ],
    );
}

#[test]
fn obj_with_relative_references_polygons_and_long_statements() {
    let text = "# C:\\meshes\\\r\nmtllib a.mtl\nv 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0 \\\n 1.0\nf -3 -2 -1\nv 0 1 0\nvt 0 0\nvn 0 0 1\n\
        g side\nf 1/1 2/1/1 3//1 \\\n4\nf 1 2 3 4 1\nl 1 2 3\np 1 2\ncurv 0 1 1 2\nf 1 2 4 # the last\n";
    let mesh = read_bytes(&Obj, text.as_bytes()).expect("a mesh");
    assert_eq!(counts(&mesh), (4, 2, 1, 1, 0));
    assert_eq!(mesh.elements[0].2, [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]);
    let labels: Vec<_> = mesh.elements.iter().map(|element| (element.1, element.0)).collect();
    assert_eq!(labels, [(Shape::Triangle, 1), (Shape::Triangle, 7), (Shape::Quadrilateral, 2)]);
}

/// Every piece must know how many vertices stand before it.
#[test]
fn relative_references_reach_back_over_pieces() {
    let mut text = String::new();
    for k in 0..60_000 {
        text.push_str(&format!("v {k} 0 0\nv {k} 1 0\nv {k} 1 1\nf -3 -2 -1\n"));
    }
    assert!(text.len() as u64 > 2 * crate::formats::PIECE_BYTES);
    let mesh = read_bytes(&Obj, text.as_bytes()).expect("a mesh");
    assert_eq!(counts(&mesh), (180_000, 60_000, 0, 0, 0));
    for (k, element) in mesh.elements.iter().enumerate() {
        assert_eq!((element.0, element.2[0]), (k as u64 + 1, [k as f64, 0.0, 0.0]));
    }
}

#[test]
fn what_is_wrong_with_an_obj_file_is_said() {
    let rows = [
        (
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n",
            "line 4: expected a vertex: from 1, or from -1 backwards, found \"0\"",
        ),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n", "line 4: expected a vertex"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "element 1 names node 4"),
        ("v 0 0 0\nv 1 0\nv 0 1 0\nf 1 2 3\n", "line 2: expected z, found the end of the line"),
        ("v 0 0 0\nw 1 0 0\nv 0 1 0\nf 1 2 3\n", "line 2: expected a statement of OBJ, found \"w 1 0 0\""),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\n", "expected one face or more, found points alone"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 \\", "expected the rest of a statement"),
        ("v 0 0 0\nf\n", "line 2: expected a face of one corner or more"),
    ];
    check_errors(&Obj, &rows.map(|row| (row.0.as_bytes().to_vec(), row.1)));
}

/// A binary file of facets.
fn binary_stl(header: &[u8], facets: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let mut file = header.to_vec();
    file.resize(80, b' ');
    file.extend((facets.len() as u32).to_le_bytes());
    for facet in facets {
        file.extend([0; 12]);
        facet.iter().flatten().for_each(|value| file.extend(value.to_le_bytes()));
        file.extend([0; 2]);
    }
    file
}

#[test]
fn a_binary_stl_that_begins_with_solid_is_known_by_its_size() {
    let file = binary_stl(b"solid made by a program\nfacet", &[[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]]);
    assert_eq!(counts(&read_bytes(&Stl, &file).expect("a mesh")), (3, 1, 0, 0, 0));
}

#[test]
fn corners_at_minus_zero_and_zero_are_one_node() {
    let facets = [
        [[0.0, 0.0, 0.0], [1.0, 0.0, -0.0], [0.0, 1.0, 0.0]],
        [[-0.0, 0.0, -0.0], [1.0, -0.0, 0.0], [-0.0, -1.0, 0.0]],
    ];
    let mesh = read_bytes(&Stl, &binary_stl(b"", &facets)).expect("a mesh");
    assert_eq!(counts(&mesh), (4, 2, 0, 0, 0));
}

/// The table of nodes grows several times.
#[test]
fn many_corners_are_joined() {
    let mut facets = Vec::new();
    for k in 0..200 * 200 {
        let (x, y) = ((k % 200) as f32 * 0.1, (k / 200) as f32 * 0.1);
        let (right, up) = ((k % 200 + 1) as f32 * 0.1, (k / 200 + 1) as f32 * 0.1);
        facets.push([[x, y, 0.0], [right, y, 0.0], [right, up, 0.0]]);
        facets.push([[x, y, 0.0], [right, up, 0.0], [x, up, 0.0]]);
    }
    let mesh = read_bytes(&Stl, &binary_stl(b"", &facets)).expect("a mesh");
    assert_eq!(counts(&mesh), (201 * 201, 80_000, 0, 0, 0));
    for (element, facet) in mesh.elements.iter().zip(&facets) {
        assert_eq!(element.2, facet.map(|corner| corner.map(f64::from)));
    }
}

#[test]
fn what_is_wrong_with_an_stl_file_is_said() {
    let facet =
        "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
    let solid = |facet: &str| format!("SOLID two\n{facet}ENDSOLID\n\nsolid\n{facet}endsolid two\n");
    assert_eq!(counts(&read_bytes(&Stl, solid(facet).as_bytes()).expect("a mesh")), (3, 2, 0, 0, 0));
    let but = |from: &str, to: &str| solid(&facet.replacen(from, to, 1)).into_bytes();
    let mut cut = binary_stl(b"", &[[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]]);
    let whole = cut.clone();
    cut.pop();
    let mut claims = whole.clone();
    claims[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    let mut infinite = whole.clone();
    infinite[96..100].copy_from_slice(&f32::INFINITY.to_le_bytes());
    check_errors(
        &Stl,
        &[
            (but("vertex 1 0 0\n", ""), "line 6: expected vertex, found \"endloop\""),
            (but("vertex 1 0 0\n", "vertex 1 0\n"), "line 5: expected z, found the end of the line"),
            (but("vertex 1 0 0\n", "vertex 1 0 nan\n"), "line 2: expected finite coordinates"),
            (but("endfacet\n", ""), "line 8: expected endfacet, found \"ENDSOLID\""),
            (but("facet normal", "face"), "line 2: expected facet or endsolid"),
            (b"solid a\nendsolid a\n".to_vec(), "expected one facet or more"),
            (format!("solid\n{facet}").into_bytes(), "expected endsolid, found the end of the file"),
            (cut, "byte 80: expected 134 bytes for 1 facets, found 133 bytes"),
            (claims, "expected 214748364834 bytes for 4294967295 facets"),
            (infinite, "byte 84: expected finite coordinates"),
        ],
    );
}
