//! The reader against files of Gmsh, meshio and refine, against hand-made files, and against damage.

use super::Medit;
use crate::error::Result;
use crate::formats::Format;
use crate::formats::gmsh::Gmsh;
use crate::formats::reading::{Mesh, read};
use crate::formats::testing::{self, Row, check, corpus, counted, damage, detected, own};
use crate::mesh::Shape::{self, Hexahedron, Quadrilateral, Tetrahedron, Triangle, Wedge};

const MIXED: &[(Shape, usize)] = &[(Triangle, 28), (Quadrilateral, 36), (Wedge, 28), (Hexahedron, 8)];

/// Written by Gmsh, and by meshio from our own mesh of Gmsh.
const OWN: &[Row] =
    &[("gmsh_box_o2.mesh", 2070, &[(Tetrahedron, 1093)], &[]), ("mixed.meshb", 54, MIXED, &[])];

const CORPUS: &[Row] = &[
    ("meshio_mixed.mesh", 54, MIXED, &[]),
    ("meshio_mixed.meshb", 54, MIXED, &[]),
    ("refine_cone-cone.meshb", 17, &[(Triangle, 28), (Tetrahedron, 23)], &[("line", 19)]),
    ("refine_ega.meshb", 421, &[(Triangle, 296), (Tetrahedron, 2122)], &[("line", 76)]),
    ("refine_pencil.meshb", 34, &[(Triangle, 64), (Tetrahedron, 52)], &[("line", 35)]),
    ("refine_triangle.meshb", 47, &[(Triangle, 67)], &[("line", 25)]),
];

fn read_bytes(bytes: &[u8]) -> Result<Mesh> {
    testing::read_bytes(&Medit, "a.mesh", bytes)
}

fn message(text: &str) -> String {
    testing::message(&Medit, "a.mesh", text.as_bytes())
}

/// The bytes before the keyword End, which a file need not have.
fn before_end(bytes: &[u8]) -> usize {
    let text = bytes.trim_ascii_end();
    if text.ends_with(b"End") { text.len() - 8 } else { bytes.len() - 8 }
}

#[test]
fn own_files_hold_what_gmsh_counts() {
    let [mesh, _] = [0, 1].map(|k| check(&Medit, &own("medit"), &OWN[k]));
    assert_eq!(mesh.ledger.types[0].name, "TetrahedraP2");
    assert_eq!(mesh.elements.iter().map(|e| e.0).collect::<Vec<_>>(), (1..=1093).collect::<Vec<_>>());
}

#[test]
fn corpus_files_hold_what_others_count() {
    let Some(corpus) = corpus() else { return };
    CORPUS.iter().for_each(|row| drop(check(&Medit, &corpus.join("medit"), row)));
}

#[test]
fn the_mixed_mesh_is_that_of_gmsh() {
    let expected = read(&Gmsh, &own("gmsh").join("mixed_hex_prism_41.msh")).expect("readable");
    let mut files = vec![own("medit").join("mixed.meshb")];
    files.extend(corpus().map(|corpus| corpus.join("medit/meshio_mixed.mesh")));
    for file in files {
        testing::same_elements(&testing::read_file(&Medit, &file), &expected, 0.0);
    }
}

#[test]
fn only_medit_files_of_the_corpus_are_detected() {
    let Some(corpus) = corpus() else { return };
    let mut expected: Vec<_> = CORPUS.iter().chain(&OWN[..1]).map(|row| format!("medit/{}", row.0)).collect();
    expected.push("decoys/truncated_gmsh_crash_4096B.mesh".into());
    expected.sort();
    assert_eq!(detected(&Medit, &corpus), expected);
}

#[test]
fn a_file_that_gmsh_left_half_written_is_an_error() {
    let Some(corpus) = corpus() else { return };
    let error = read(&Medit, &corpus.join("decoys/truncated_gmsh_crash_4096B.mesh")).expect_err("an error");
    assert!(error.to_string().contains("54 in all"), "{error}");
}

#[test]
fn a_cut_file_is_an_error_and_a_flipped_bit_no_panic() {
    OWN.iter().for_each(|row| damage(&Medit, &own("medit").join(row.0), before_end));
    let Some(corpus) = corpus() else { return };
    CORPUS[1..].iter().for_each(|row| damage(&Medit, &corpus.join("medit").join(row.0), before_end));
}

#[test]
fn keywords_come_in_any_order_and_on_any_lines() {
    let text = "# by hand\nMeshVersionFormatted 2 Dimension\n3\nRidges 2 1 2\nCorners # none\n0\nNormalAtVertices 1\n1 1\n\
                Tetrahedra 2 1 2 3 4 -7 1 2\n3 5 0 Edges 1 1 2 0 AngleOfCornerBound 1.5 Triangles 1\n1 2 3 2\n\
                Vertices 5 # five\n0 0 0 0 1 0 0 0\n0 1 0 0 0 0 1 0 0 0 -1.d0 0.\nend\nnot read";
    let mesh = read_bytes(text.as_bytes()).expect("readable");
    assert_eq!((mesh.nodes.count(), mesh.count(Tetrahedron), counted(&mesh, "line")), (5, 2, 1));
    assert_eq!(mesh.elements.iter().map(|e| e.0).collect::<Vec<_>>(), [1, 2, 3]);
    assert_eq!(mesh.elements[1].2[3], [0., 0., -1.]);
    assert!(Medit.detect(text.as_bytes()));
}

#[test]
fn gmsh_writes_second_order_under_the_names_of_the_first() {
    for (name, nodes, shape) in
        [("Hexahedra", 20, Hexahedron), ("Hexahedra", 27, Hexahedron), ("Quadrilaterals", 9, Quadrilateral)]
    {
        let vertices: String = (0..27).map(|k| format!("{k} 0 0 0\n")).collect();
        let row: String = (1..=nodes).map(|k| format!("{k} ")).collect();
        let text = format!(
            "MeshVersionFormatted 2\nDimension 3\nVertices 27\n{vertices}{name}\n 2\n{row}1\n{row}2\nEnd\n"
        );
        let mesh = read_bytes(text.as_bytes()).expect("readable");
        assert_eq!((mesh.count(shape), mesh.elements.len()), (2, 2));
        assert!(matches!(mesh.ledger.types[0].class, crate::mesh::Class::Measured { order: 2, .. }));
    }
}

#[test]
fn two_dimensions_and_no_end() {
    let text =
        "MeshVersionFormatted 0\nDimension 2\nVertices\n3\n0 0 1\n1 0 1\n0 1 1\nTriangles\n1\n1 2 3 1\n";
    let mesh = read_bytes(text.as_bytes()).expect("readable");
    assert_eq!(mesh.elements, [(1, Triangle, vec![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]])]);
    assert!(read_bytes(format!("{text}Ridges\n2\n1\n2\n").as_bytes()).is_ok());
    assert!(read_bytes(format!("{text}Ridges\n2\n1\n").as_bytes()).is_err());
}

#[test]
fn polygons_and_polyhedra_were_passed_over_and_not_counted() {
    let text = "MeshVersionFormatted 2\nDimension 3\nVertices 3\n0 0 0 1\n1 0 0 1\n0 1 0 1\n\
                BoundaryPolygonHeaders 2\n1 0\n4 0\nBoundaryPolygonVertices 6\n1\n2\n3\n3\n2\n1\n\
                InnerPolygonHeaders 1\n1 0\nInnerPolygonVertices 3\n1 2 3\nPolyhedraHeaders 1\n1 0\nPolyhedraFaces 1\n1\nEnd\n";
    let mesh = read_bytes(text.as_bytes()).expect("readable");
    assert_eq!(["polygon", "polyhedron"].map(|what| counted(&mesh, what)), [2, 1]);
    assert_eq!(
        message(&text.replace("4 0\nB", "4\nB")),
        "line 10: expected 2 rows of BoundaryPolygonHeaders of 2 numbers each, and not 3 in all, found \"BoundaryPolygonVertices 6\""
    );
}

#[test]
fn long_tables_are_cut_into_pieces_that_join_to_the_same_mesh() {
    let count = 120_000;
    let rows: String = (0..count)
        .map(|k| format!("{k} {}.5 0 1{}", k % 7, if k % 1000 == 3 { " # x\n" } else { "\n" }))
        .collect();
    let triangles: String = (1..count - 1).map(|k| format!("{k} {} {} 0\n", k + 1, k + 2)).collect();
    let text = format!(
        "MeshVersionFormatted 2\nDimension 3\nVertices {count}\n{rows}Triangles {}\n{triangles}End",
        count - 2
    );
    let mesh = read_bytes(text.as_bytes()).expect("readable");
    assert_eq!((mesh.nodes.count(), mesh.elements.len()), (count as u64, count - 2));
    for (k, (label, _, corners)) in mesh.elements.iter().enumerate() {
        let point = |k: usize| [k as f64, (k % 7) as f64 + 0.5, 0.0];
        assert_eq!((*label, &corners[..]), (k as u64 + 1, &[point(k), point(k + 1), point(k + 2)][..]));
    }
}

#[test]
fn errors_name_the_line_and_what_stood_there() {
    let text = "MeshVersionFormatted 2\nDimension 3\nVertices 3\n0 0 0 1\n1 0 0 1\n0 1 0 1\nTriangles 1\n1 2 3 1\nEnd\n";
    let rows = [
        (("Dimension 3", "Dimension 4"), "line 2: expected a dimension, 2 or 3, found 4"),
        (("Dimension 3", ""), "line 3: expected Dimension before Vertices, found none"),
        (("Formatted 2", "Formatted 5"), "line 1: MEDIT version 5 is not read (1 to 4 are)"),
        (
            ("Vertices 3", "Vertices 4"),
            "line 7: expected rows of Vertices, 4 in all, and not only 3, found \"Triangles 1\"",
        ),
        (
            ("Vertices 3", "Vertices 2"),
            "line 6: expected a keyword (Vertices, Tetrahedra, End, ...), found \"0\"",
        ),
        (
            ("Vertices 3", "Vertices 1000000000000000000"),
            "line 7: expected rows of Vertices, 1000000000000000000 in all, and not only 3, found \"Triangles 1\"",
        ),
        (("Vertices 3", "Vertices x"), "line 3: expected the number of vertices, found \"x\""),
        (("1 0 0 1", "1 0 nan 1"), "line 5: expected finite coordinates, found [1.0, 0.0, NaN]"),
        (("1 0 0 1", "1 0 0z 1"), "line 5: expected a coordinate, found \"0z 1\""),
        (("1 2 3 1", "1 2 -3 1"), "line 8: expected the number of a node, found \"-3 1\""),
        (("1 2 3 1", "1 2 4 1"), "line 8: element 1 names node 4, which the file does not define"),
        (("1 2 3 1", "1 2 0 1"), "line 8: element 1 names node 0, which the file does not define"),
        (
            ("1 2 3 1\nEnd\n", "1 2 3"),
            "line 8: expected rows of Triangles, 1 in all, and not only 0, found the end of the file",
        ),
    ];
    for ((from, to), expected) in rows {
        let found = message(&text.replace(from, to));
        // A token that is not finite begins with a letter, as words do.
        let expected = if to.contains("nan") {
            "line 5: expected rows of Vertices, 3 in all, and not only 1, found \"nan 1\""
        } else {
            expected
        };
        assert_eq!(found, expected, "{to}");
    }
    let ordered = text
        .replace("Triangles", "TrianglesP2Ordering 1 1 0 0 TrianglesP2")
        .replace("1 2 3 1", "1 2 3 1 2 3 1");
    assert_eq!(
        message(&ordered),
        "line 9: TrianglesP2Ordering gives the nodes an order of its own, which is not read"
    );
    assert_eq!(
        message("MeshVersionFormatted 2\nDimension 3\nEnd"),
        "line 3: expected Vertices, found none in the file"
    );
}

/// A binary file of two triangles, an edge, two polygons, a polyhedron and a keyword that is not known.
fn binary(version: u32, big: bool) -> Vec<u8> {
    let (wide, long, real) = (version > 2, version > 3, version > 1);
    let mut bytes = Vec::new();
    let put = |bytes: &mut Vec<u8>, value: u64, width: usize| {
        if big {
            bytes.extend(&value.to_be_bytes()[8 - width..])
        } else {
            bytes.extend(&value.to_le_bytes()[..width])
        }
    };
    let word = if long { 8 } else { 4 };
    put(&mut bytes, 1, 4);
    put(&mut bytes, version.into(), 4);
    let mut table = |code: u64, count: Option<u64>, body: &dyn Fn(&mut Vec<u8>)| {
        put(&mut bytes, code, 4);
        let place = bytes.len();
        let width = if wide { 8 } else { 4 };
        put(&mut bytes, 0, width);
        if let Some(count) = count {
            put(&mut bytes, count, word);
        }
        body(&mut bytes);
        let (mut next, end) = (Vec::new(), bytes.len() as u64);
        put(&mut next, if code == 54 { 0 } else { end }, width);
        bytes[place..place + width].copy_from_slice(&next);
    };
    table(3, None, &|b| put(b, 2, 4));
    table(6, Some(2), &|b| [1, 2, 3, 0, 2, 4, 3, 0].iter().for_each(|id| put(b, *id, word)));
    table(126, None, &|b| b.extend(b"anything"));
    table(4, Some(4), &|b| {
        for point in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.5f64]] {
            for x in point {
                if real { put(b, x.to_bits(), 8) } else { put(b, (x as f32).to_bits().into(), 4) }
            }
            put(b, 0, word);
        }
    });
    table(5, Some(1), &|b| [1, 2, 0].iter().for_each(|id| put(b, *id, word)));
    table(203, Some(2), &|b| [1, 0, 4, 0].iter().for_each(|k| put(b, *k, word)));
    table(207, Some(1), &|b| [1, 0].iter().for_each(|k| put(b, *k, word)));
    table(54, None, &|_| ());
    bytes
}

#[test]
fn binary_files_of_all_versions_and_both_byte_orders() {
    for version in 1..=4 {
        for big in [false, true] {
            let bytes = binary(version, big);
            assert!(Medit.detect(&bytes));
            let mesh = read_bytes(&bytes).unwrap_or_else(|e| panic!("version {version}, {big}: {e}"));
            assert_eq!((mesh.nodes.count(), counted(&mesh, "line")), (4, 1));
            assert_eq!(["polygon", "polyhedron"].map(|what| counted(&mesh, what)), [2, 1]);
            let second = (2, Triangle, vec![[1., 0., 0.], [1., 1.5, 0.], [0., 1., 0.]]);
            assert_eq!(mesh.elements[1], second);
            for cut in 12..bytes.len() - 8 {
                assert!(read_bytes(&bytes[..cut]).is_err(), "version {version} cut at {cut}");
            }
        }
    }
}

#[test]
fn counts_and_places_of_binary_files_are_not_believed() {
    let whole = binary(2, false);
    let with = |at: usize, value: u32| {
        let mut bytes = whole.clone();
        bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
        testing::message(&Medit, "a.mesh", &bytes)
    };
    assert_eq!(
        with(28, u32::MAX),
        "byte 20: expected 4294967295 rows of Triangles of 16 bytes each before the next keyword, found 32 bytes"
    );
    assert_eq!(with(24, 8), "byte 24: expected the place of the next keyword, 28 or after, found 8");
    assert!(
        with(24, 1 << 30)
            .contains("expected the keyword after keyword 6, at byte 1073741824, found the end of the file")
    );
    assert!(with(32, u32::MAX).contains("byte 32: expected the number of a node, found -1"));
    assert_eq!(with(16, 5), "byte 8: expected a dimension, 2 or 3, found 5");
}

#[test]
fn elements_of_a_kind_that_is_not_known_are_counted_by_its_name() {
    let text = |rows: &str| {
        format!(
            "MeshVersionFormatted 2\nDimension 3\nVertices 3\n0 0 0 1\n1 0 0 1\n0 1 0 1\nTriangles 1\n1 2 3 1\n\
             PrismsP9 2\n{rows}TrianglesP2Ordering 1\n1 2\nEnd\n"
        )
    };
    let mesh = testing::read_bytes(&Medit, "a.mesh", text("1 2 3 1\n3 2 1 1\n").as_bytes()).expect("sound");
    assert_eq!((mesh.count(Triangle), counted(&mesh, "prismsp9")), (1, 2));
    let error =
        testing::read_bytes(&Medit, "a.mesh", text("1 2 3\n3 2\n").as_bytes()).expect_err("cut").to_string();
    assert!(error.contains("2 whole rows of prismsp9"), "{error}");
}
