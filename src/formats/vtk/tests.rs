//! Real files, files by hand, broken files; and, where there is a Python with VTK, whatever VTK and meshio write.

use std::path::{Path, PathBuf};

use super::{Legacy, Vtu};
use crate::error::Result;
use crate::formats::Format;
use crate::formats::reading::{Mesh, read};
use crate::formats::testing::{self, Random};
use crate::mesh::{Class, Shape};

/// One for each of the two formats.
fn own_folders() -> [PathBuf; 2] {
    ["vtk", "vtu"].map(|name| Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes").join(name))
}

/// The checked-in meshes: every cell type of VTK, written by VTK's own writers in several encodings.
fn own() -> Vec<PathBuf> {
    let entries = own_folders().into_iter().flat_map(|folder| std::fs::read_dir(folder).expect("a folder"));
    let mut files: Vec<_> = entries.flatten().map(|e| e.path()).collect();
    files.retain(|file| {
        file.extension()
            .is_some_and(|e| ["vtk", "vtu", "vtp", "vts", "vtr", "vti"].iter().any(|known| e == *known))
    });
    files.sort();
    assert!(files.len() >= 8, "{files:?}");
    files
}

#[expect(clippy::disallowed_methods, reason = "the test's own small files")]
fn bytes_of(path: &Path) -> Vec<u8> {
    std::fs::read(path).expect("a file of the test")
}

fn read_any(path: &Path) -> Result<Mesh> {
    let format: &dyn Format = if path.extension().is_some_and(|e| e == "vtk") { &Legacy } else { &Vtu };
    read(format, path)
}

/// The text or bytes of a file, read as a mesh.
fn read_bytes(format: &dyn Format, bytes: &[u8]) -> Result<Mesh> {
    testing::read_bytes(format, "a", bytes)
}

/// Measured cells by shape.
fn shapes(mesh: &Mesh) -> Vec<(&'static str, usize)> {
    Shape::ALL.into_iter().map(|s| (s.name(), mesh.count(s))).filter(|row| row.1 > 0).collect()
}

fn counted(mesh: &Mesh) -> u64 {
    mesh.ledger.types.iter().filter(|t| matches!(t.class, Class::Counted(_))).map(|t| t.count).sum()
}

fn checksum(mesh: &Mesh) -> f64 {
    let corner = |p: &[f64; 3]| p[0] + 2.0 * p[1] + 3.0 * p[2];
    let cell = |label: u64, corners: &[[f64; 3]]| {
        let sum: f64 = corners.iter().enumerate().map(|(k, p)| (k + 1) as f64 * corner(p)).sum();
        (label % 7 + 1) as f64 * sum
    };
    mesh.elements.iter().map(|(label, _, corners)| cell(*label, corners)).sum()
}

/// Holds the files of a folder against its `expected.jsonl`; gives their number.
fn check_folder(folder: &Path) -> usize {
    let expected = String::from_utf8(bytes_of(&folder.join("expected.jsonl"))).expect("UTF-8");
    let mut wrong = Vec::new();
    for line in expected.lines() {
        let row: serde_json::Value = serde_json::from_str(line).expect("JSON");
        let name = row["file"].as_str().expect("file");
        let mesh = match read_any(&folder.join(name)) {
            Ok(mesh) => mesh,
            Err(error) => {
                wrong.push(error.to_string());
                continue;
            }
        };
        if let Some(nodes) = row["nodes"].as_u64() {
            assert_eq!(mesh.nodes.count(), nodes, "{name}");
        }
        assert_eq!(counted(&mesh), row["counted"].as_u64().expect("counted"), "{name}");
        for shape in Shape::ALL {
            let count = row["shapes"][shape.name()].as_u64().unwrap_or(0);
            assert_eq!(mesh.count(shape) as u64, count, "{name}: {shape}");
        }
        if let Some(sum) = row["checksum"].as_f64() {
            let turned = row["checksum_of_turned_wedges"].as_f64();
            let found = checksum(&mesh);
            assert!(found == sum || Some(found) == turned, "{name}: {found}, not {sum}");
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    expected.lines().count()
}

#[test]
fn what_vtk_and_meshio_write_is_read() {
    let Some(python) = std::env::var_os("MESHGAUGE_PYTHON") else {
        eprintln!("skipped: MESHGAUGE_PYTHON names no Python with vtk, meshio and numpy");
        return;
    };
    for (script, least) in [("tests/peers/vtk_family.py", 300), ("tests/peers/vtk_grids.py", 150)] {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join(script);
        let status = std::process::Command::new(&python).arg(script).arg(folder.path()).status();
        assert!(status.expect("Python").success());
        assert!(check_folder(folder.path()) > least);
    }
}

#[test]
fn own_files_are_read() {
    // Two more name others as their parts.
    assert_eq!(own_folders().iter().map(|folder| check_folder(folder)).sum::<usize>(), own().len() + 2);
}

type Shapes = &'static [(&'static str, usize)];

#[test]
fn corpus_files_have_the_counts_of_other_readers() {
    let Some(corpus) = testing::corpus() else { return };
    let mixed: Shapes = &[("triangle", 28), ("quadrilateral", 36), ("wedge", 28), ("hexahedron", 8)];
    let quads: Shapes = &[("quadrilateral", 9)];
    let hexahedron: Shapes = &[("hexahedron", 1)];
    // File, points, measured cells by shape, counted cells.
    let rows: &[(&str, u64, Shapes, u64)] = &[
        ("vtk/gmsh_mixed_wedge.vtk", 54, mixed, 0),
        ("vtk/meshio_mixed_wedge_51.vtk", 54, mixed, 0),
        ("vtk/mfem_beam-wedge.vtk", 27, &[("wedge", 8)], 0),
        ("vtk/mfem_escher-p2.vtk", 117, &[("tetrahedron", 42)], 0),
        ("vtk/mfem_fichera-mixed-p2.vtk", 116, &[("tetrahedron", 5), ("wedge", 6), ("hexahedron", 3)], 0),
        ("vtk/mfem_fichera-q2.vtk", 117, &[("hexahedron", 7)], 0),
        ("vtk/mfem_star-q2.vtk", 101, &[("quadrilateral", 20)], 0),
        ("vtk/vtk97_mixed_42_bin.vtk", 54, mixed, 0),
        ("vtk/vtk97_mixed_51_ascii.vtk", 54, mixed, 0),
        ("vtk/vtk97_mixed_51_bin.vtk", 54, mixed, 0),
        ("vtk/vtkio_para_tet.vtk", 4, &[("tetrahedron", 1)], 0),
        ("vtk/vtkio_tet_test_binary.vtk", 4, &[("tetrahedron", 1)], 0),
        ("vtk/vtkio_triangle_vtkidtype.vtk", 3, &[("triangle", 1)], 0),
        (
            "vtk/vtkio_unstructured_grid_complex.vtk",
            27,
            &[("triangle", 2), ("quadrilateral", 1), ("tetrahedron", 3), ("hexahedron", 2)],
            4,
        ),
        ("vtu/meshio_mixed_wedge_zlib.vtu", 54, mixed, 0),
        ("vtu/mfem_quad_append_b64.vtu", 16, quads, 0),
        ("vtu/mfem_quad_append_b64_compress.vtu", 16, quads, 0),
        ("vtu/mfem_quad_append_raw.vtu", 16, quads, 0),
        ("vtu/mfem_quad_append_raw_compress.vtu", 16, quads, 0),
        ("vtu/mfem_quad_ascii.vtu", 16, quads, 0),
        ("vtu/mfem_quad_binary.vtu", 16, quads, 0),
        ("vtu/mfem_quad_binary_compress.vtu", 16, quads, 0),
        ("vtu/vtk97_mixed_appended_b64_lz4.vtu", 54, mixed, 0),
        ("vtu/vtk97_mixed_appended_b64_zlib.vtu", 54, mixed, 0),
        ("vtu/vtk97_mixed_appended_raw_lz4.vtu", 54, mixed, 0),
        ("vtu/vtk97_mixed_appended_raw_lzma.vtu", 54, mixed, 0),
        ("vtu/vtk97_mixed_appended_raw_none.vtu", 54, mixed, 0),
        ("vtu/vtk97_mixed_appended_raw_zlib.vtu", 54, mixed, 0),
        ("vtu/vtk97_mixed_inline_lz4.vtu", 54, mixed, 0),
        ("vtu/vtk97_mixed_inline_zlib.vtu", 54, mixed, 0),
        ("vtu/vtkio_box_para.vtu", 8, &[("quadrilateral", 6)], 0),
        ("vtu/vtkio_hexahedron_lz4.vtu", 8, hexahedron, 0),
        ("vtu/vtkio_hexahedron_lzma_inline_binary.vtu", 8, hexahedron, 0),
        ("vtu/vtkio_hexahedron_zlib.vtu", 8, hexahedron, 0),
    ];
    let mut wrong = Vec::new();
    for (name, nodes, cells, others) in rows {
        match read_any(&corpus.join(name)) {
            Err(error) => wrong.push(error.to_string()),
            Ok(mesh)
                if (mesh.nodes.count(), &shapes(&mesh)[..], counted(&mesh)) != (*nodes, *cells, *others) =>
            {
                wrong.push(format!("{name}: {} {:?} {}", mesh.nodes.count(), shapes(&mesh), counted(&mesh)));
            }
            Ok(_) => {}
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    let error = read_any(&corpus.join("vtu/vtkio_hexahedron_parallel.pvtu")).expect_err("no mesh");
    assert!(error.to_string().contains("included file"), "{error}");
}

#[test]
fn a_file_that_ends_too_early_is_an_error() {
    for file in own() {
        let bytes = bytes_of(&file);
        let format: &dyn Format = if file.extension().is_some_and(|e| e == "vtk") { &Legacy } else { &Vtu };
        // A number that lost its last digit is still a number: cut before the last word.
        let end = bytes.trim_ascii_end();
        let end = end.iter().rposition(u8::is_ascii_whitespace).expect("several words");
        for k in 0..50 {
            let cut = end * k / 50;
            let rest = bytes[cut..].trim_ascii_start();
            match read_bytes(format, &bytes[..cut]) {
                Err(error) => assert!(error.path().is_some(), "{error}"),
                // Legacy files have no end mark: without their data they are whole meshes.
                Ok(_) if rest.starts_with(b"CELL_DATA") || rest.starts_with(b"POINT_DATA") => {}
                Ok(_) => panic!("{}: cut to {cut} bytes of {}", file.display(), bytes.len()),
            }
        }
    }
}

#[test]
fn a_file_with_flipped_bytes_is_read_or_refused() {
    let mut random = Random(0x2007_0301);
    for file in own() {
        let bytes = bytes_of(&file);
        let format: &dyn Format = if file.extension().is_some_and(|e| e == "vtk") { &Legacy } else { &Vtu };
        for _ in 0..200 {
            let mut broken = bytes.clone();
            for _ in 0..1 + random.below(3) {
                let at = random.below(broken.len());
                broken[at] = random.below(256) as u8;
            }
            if let Err(error) = read_bytes(format, &broken) {
                assert!(!error.is_resource() && error.path().is_some(), "{error}");
            }
        }
    }
}

/// Text with CRLF line ends, keywords in small letters, numbers wherever they like.
#[test]
fn legacy_text_is_read_word_by_word() {
    let text = "# vtk DataFile Version 3.0\r\na title\r\nascii\r\ndataset unstructured_grid\r\n\
        points 5 float 0 0 0\r\n1 0 0 0 1 0\r\n0 0 1.5e0 1 1 1\r\n\r\nmetadata\r\ninformation 0\r\n\r\n\
        cells 2 10\r\n4 0 1\r\n2 3 4 1 2 3 4 cell_types 2 10 10\r\n";
    let mesh = read_bytes(&Legacy, text.as_bytes()).expect("a mesh");
    assert_eq!(shapes(&mesh), [("tetrahedron", 2)]);
    assert_eq!(
        mesh.elements[1],
        (1, Shape::Tetrahedron, vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.5], [1.0; 3]])
    );
}

#[test]
fn a_long_cell_marks_all_of_its_points_as_used() {
    let count = 150_000;
    let mut text =
        format!("# vtk DataFile Version 3.0\n\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {count} float\n");
    (0..count).for_each(|k| text.push_str(&format!("{k} 0 0\n")));
    text.push_str(&format!("CELLS 2 {}\n4 0 1 2 3\n{count}", count + 6));
    (0..count).for_each(|k| text.push_str(&format!(" {k}")));
    text.push_str("\nCELL_TYPES 2\n10\n2\n");
    let mesh = read_bytes(&Legacy, text.as_bytes()).expect("a mesh");
    assert_eq!((mesh.nodes.unused(), mesh.elements.len(), counted(&mesh)), (0, 1, 1));
}

/// Two tetrahedra in a legacy text file, with one replacement.
fn tetrahedra_but(from: &str, to: &str) -> Result<Mesh> {
    let text = "# vtk DataFile Version 5.1\n\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n0 0 0 1 0 0 0 1 0\n\
        0 0 1 1 1 1\nCELLS 3 8\nOFFSETS vtktypeint64\n0 4 8\nCONNECTIVITY vtktypeint64\n0 1 2 3\n1 2 3 4\n\
        CELL_TYPES 2\n10\n10\n";
    assert!(text.contains(from), "{from}");
    read_bytes(&Legacy, text.replace(from, to).as_bytes())
}

#[test]
fn what_is_wrong_with_a_legacy_file_is_said() {
    tetrahedra_but("10", "10").expect("a mesh");
    let rows = [
        ("UNSTRUCTURED_GRID", "FIELD", "line 4: a dataset of the kind FIELD is not read"),
        ("UNSTRUCTURED_GRID", "RECTILINEAR_GRID", "expected a section: DIMENSIONS, POINTS, SPACING"),
        ("POINTS 5", "POINTS 6", "line 8: expected a coordinate as number 16 of 18, found \"CELLS 3 8\""),
        (
            "POINTS 5 double",
            "POINTS 1000000000000000000 double",
            "expected a coordinate as number 16 of 3000000000000000000",
        ),
        ("1 0 0", "1 0 x", "line 6: expected a coordinate as number 6 of 15, found \"x 0 1 0\""),
        ("0 1 0", "0 nan 0", "expected finite coordinates"),
        (
            "CELLS 3 8",
            "CELLS 1000000000000000000 8",
            "as number 4 of 1000000000000000000, found \"CONNECTIVITY",
        ),
        ("CELLS 3 8", "CELLS 3 7", "expected a section"),
        ("0 4 8", "0 4 7", "expected 7 entries in the connectivity, as the last offset says, found 8"),
        ("0 4 8", "0 9 8", "expected an offset from 0 to 8 for cell 0, found 9"),
        ("0 4 8", "0 5 8", "expected 4 nodes for cell 0, a VTK_TETRA, found 5"),
        ("0 4 8", "1 4 8", "expected 0 as the first offset, found 1"),
        (
            "1 2 3 4",
            "1 2 3 -4",
            "line 13: expected a point's number (0 to 4294967295) as number 8 of 8, found \"-4\"",
        ),
        ("1 2 3 4", "1 2 3 5", "element 1 names node 5"),
        ("CELL_TYPES 2\n10\n10", "CELL_TYPES 1\n10", "expected 2 cell types, one for each cell, found 1"),
        ("10\n10\n", "10\n99\n", "expected a known cell type for cell 1, found type 99"),
        ("10\n10\n", "10\n12\n", "expected 8 nodes for cell 1, a VTK_HEXAHEDRON, found 4"),
        ("10\n10\n", "10\n72\n", "cell 1 is a VTK_LAGRANGE_HEXAHEDRON with 4 nodes"),
        ("CELL_TYPES 2\n10\n10\n", "", "the section CELL_TYPES"),
    ];
    for (from, to, expected) in rows {
        let error = tetrahedra_but(from, to).expect_err(to).to_string();
        assert!(error.contains(expected), "{error}\n  lacks {expected}");
    }
}

#[test]
fn a_negative_point_in_a_binary_file_is_named_with_its_cell_and_byte() {
    let mut file =
        b"# vtk DataFile Version 4.2\n\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n".to_vec();
    (0..12u8).for_each(|k| file.extend(f32::from(k * k % 7).to_be_bytes()));
    file.extend(b"\nCELLS 1 5\n");
    let at = file.len();
    [4i32, 0, 1, -2, 3].iter().for_each(|k| file.extend(k.to_be_bytes()));
    file.extend(b"\nCELL_TYPES 1\n");
    file.extend(10i32.to_be_bytes());
    let error = read_bytes(&Legacy, &file).expect_err("a negative number").to_string();
    assert!(
        error.contains(&format!("byte {at}: expected a point's number, 0 or more, in cell 0, found -2")),
        "{error}"
    );
}

/// Gmsh 4.15 writes quadratic pyramids under the code of linear ones.
#[test]
fn gmsh_pyramids_of_13_nodes_under_code_14_are_of_second_order() {
    let mut text =
        "# vtk DataFile Version 2.0\n\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 13 double\n".to_owned();
    (0..13).for_each(|k| text.push_str(&format!("{k} {} 0\n", k * k)));
    text.push_str("CELLS 1 14\n13 0 1 2 3 4 5 6 7 8 9 10 11 12\nCELL_TYPES 1\n14\n");
    let mesh = read_bytes(&Legacy, text.as_bytes()).expect("a mesh");
    assert!(matches!(mesh.ledger.types[0].class, Class::Measured { shape: Shape::Pyramid, order: 2, .. }));
}

fn vtu(attributes: &str, inside: &str) -> String {
    format!(
        "<VTKFile type=\"UnstructuredGrid\" {attributes}><UnstructuredGrid>{inside}</UnstructuredGrid></VTKFile>\n"
    )
}

/// A piece with one tetrahedron, arrays in an unusual order.
fn piece(connectivity: &str) -> String {
    format!(
        "<Piece NumberOfPoints=\" 4 \" NumberOfCells='1'><Cells>\
         <DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10</DataArray><!-- > -->\
         <DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">\n4\n</DataArray>\
         <DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">{connectivity}</DataArray></Cells>\
         <Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 1\
         <InformationKey name=\"A\">7</InformationKey></DataArray></Points></Piece>"
    )
}

#[test]
fn points_are_numbered_anew_in_each_piece() {
    let empty = "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"/>";
    let file = vtu("", &format!("{}{empty}{}", piece("0 1 2 3"), piece("3 2 1 0")));
    let mesh = read_bytes(&Vtu, file.as_bytes()).expect("a mesh");
    assert_eq!(mesh.nodes.count(), 8);
    assert_eq!(mesh.nodes.unused(), 0);
    assert_eq!((mesh.elements[0].0, mesh.elements[1].0), (0, 1));
    assert_eq!(mesh.elements[1].2[0], [0.0, 0.0, 1.0]);
    let file = vtu("", &format!("{}{}", piece("0 1 2 4"), piece("3 2 1 0")));
    let error = read_bytes(&Vtu, file.as_bytes()).expect_err("a point of another piece").to_string();
    assert!(error.contains("expected a point's number under 4 in cell 0, found 4"), "{error}");
}

#[test]
fn base64_is_read_with_line_breaks_and_with_a_header_of_its_own() {
    let encode = |bytes: &[u8]| base64_simd::STANDARD.encode_to_string(bytes);
    let array = |data: &[u8], split: bool| {
        let head = (data.len() as u32).to_le_bytes();
        let text = if split { encode(&head) + &encode(data) } else { encode(&[&head[..], data].concat()) };
        text.as_bytes().chunks(5).map(|c| String::from_utf8_lossy(c).into_owned() + "\n ").collect::<String>()
    };
    for split in [false, true] {
        let points: Vec<u8> = (0..12).flat_map(|k| f64::from(k % 5).to_le_bytes()).collect();
        let connectivity: Vec<u8> = (0..4i32).flat_map(i32::to_le_bytes).collect();
        let inside = format!(
            "<Piece NumberOfPoints=\"4\" NumberOfCells=\"1\"><Points>\
             <DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"binary\">{}</DataArray></Points><Cells>\
             <DataArray type=\"Int32\" Name=\"connectivity\" format=\"binary\">{}</DataArray>\
             <DataArray type=\"UInt64\" Name=\"offsets\" format=\"binary\">{}</DataArray>\
             <DataArray type=\"UInt8\" Name=\"types\" format=\"binary\">{}</DataArray></Cells></Piece>",
            array(&points, split),
            array(&connectivity, split),
            array(&4u64.to_le_bytes(), split),
            array(&[10], split)
        );
        let mesh = read_bytes(&Vtu, vtu("byte_order=\"LittleEndian\"", &inside).as_bytes()).expect("a mesh");
        assert_eq!(shapes(&mesh), [("tetrahedron", 1)]);
        assert_eq!(mesh.elements[0].2[3], [4.0, 0.0, 1.0]);
    }
}

#[test]
fn what_is_wrong_with_a_vtu_file_is_said() {
    let good = vtu("", &piece("0 1 2 3"));
    let huge = "NumberOfCells='1000000000000000000'";
    let rows = [
        (
            "type=\"UnstructuredGrid\"",
            "type=\"HyperTreeGrid\"",
            "a VTK file of the type HyperTreeGrid is not read",
        ),
        ("type=\"UnstructuredGrid\"", "type=\"UnstructuredGrid\" compressor=\"x\"", "unknown compressor x"),
        ("NumberOfCells='1'", huge, "expected 1000000000000000000 numbers (types), of which 1 are there"),
        ("\"types\"", "\"kinds\"", "expected a piece with an array of types"),
        ("UInt8", "Float32", "expected a type of numbers for types"),
        ("0 1 2 3<", "0 1 2 -3<", "expected a point's number (0 to 4294967295) as number 4, found \"-3<"),
        ("0 1 2 3<", "0 1 2 7<", "element 0 names node 7"),
        ("0 1 2 3<", "0 1 2 3 3<", "expected 4 entries in the connectivity"),
        ("</Piece>", "", "expected </Piece>"),
        ("</VTKFile>", "", "expected </VTKFile>"),
        ("\"ascii\">10", "\"appended\" offset=\"0\">", "expected appended data, found none"),
        ("\"ascii\">10", "\"binary\">////f38=", "expected 1 bytes of types, found 2147483647 bytes"),
        ("\"ascii\">10", "\"binary\">@@@@@@@@", "expected base64 text"),
    ];
    for (from, to, expected) in rows {
        assert!(good.contains(from), "{from}");
        let error = read_bytes(&Vtu, good.replace(from, to).as_bytes()).expect_err(to).to_string();
        assert!(error.contains(expected), "{error}\n  lacks {expected}");
    }
}

/// Headers of compressed arrays that lie: number of blocks, size of a block, size of the last, sizes as packed.
#[test]
fn compressed_blocks_that_promise_too_much_are_refused() {
    let rows: [(&[u64], &str); 5] = [
        (&[1 << 60, 1 << 60, 0], "expected blocks of 96 bytes in all"),
        (&[1, 96, 96, 1 << 50], "more bytes of the array, found its end"),
        (&[96, 1, 1], "more bytes of the array, found its end"),
        (&[1, 96, 0, 8, 0], "expected a compressed block of 96 bytes"),
        (&[], "more bytes of the array, found its end"),
    ];
    for compressor in ["vtkZLibDataCompressor", "vtkLZ4DataCompressor", "vtkLZMADataCompressor"] {
        for (header, expected) in rows {
            let bytes: Vec<u8> = header.iter().flat_map(|k| k.to_le_bytes()).collect();
            let text = base64_simd::STANDARD.encode_to_string(&bytes);
            let from = piece("0 1 2 3");
            let points = from.find("\"ascii\">0 0 0").expect("points");
            let inside = format!("{}\"binary\">{text}</DataArray></Points></Piece>", &from[..points]);
            let file = vtu(&format!("header_type=\"UInt64\" compressor=\"{compressor}\""), &inside);
            let error = read_bytes(&Vtu, file.as_bytes()).expect_err("broken blocks").to_string();
            assert!(error.contains(expected), "{compressor} {header:?}: {error}");
        }
    }
}
