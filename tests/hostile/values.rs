//! Sound files with values that make no sense: node numbers, coordinates, elements without their nodes.

use meshgauge::Options;
use meshgauge::error::Kind;

use crate::attempt::{attempt_bytes, attempt_with, options, refused};

/// One triangle in every text format, with words to replace: the second node's number and the first coordinate of the third
/// node, and the element's nodes.
fn triangle(format: &str, second: &str, x: &str, nodes: [&str; 3]) -> Vec<u8> {
    let [a, b, c] = nodes;
    let text = match format {
        "abaqus" => format!(
            "*NODE\n1, 0., 0., 0.\n{second}, 1., 0., 0.\n3, {x}, 1., 0.\n*ELEMENT, TYPE=S3\n7, {a}, {b}, {c}\n"
        ),
        "gmsh 2.2" => format!(
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n{second} 1 0 0\n3 {x} 1 0\n$EndNodes\n\
             $Elements\n1\n7 2 2 1 1 {a} {b} {c}\n$EndElements\n"
        ),
        "gmsh 4.1" => format!(
            "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 3 1 3\n2 1 0 3\n1\n{second}\n3\n0 0 0\n1 0 0\n{x} 1 0\n$EndNodes\n\
             $Elements\n1 1 7 7\n2 1 2 1\n7 {a} {b} {c}\n$EndElements\n"
        ),
        "nastran" => format!(
            "GRID,1,,0.,0.,0.\nGRID,{second},,1.,0.,0.\nGRID,3,,{x},1.,0.\nCTRIA3,7,1,{a},{b},{c}\nENDDATA\n"
        ),
        "vtk" => {
            let [a, b, c] =
                nodes.map(|id| id.parse::<i64>().map_or(id.to_owned(), |id| (id - 1).to_string()));
            format!(
                "# vtk DataFile Version 3.0\n\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 3 double\n0 0 0\n1 0 0\n{x} 1 0\n\
                 CELLS 1 4\n3 {a} {b} {c}\nCELL_TYPES 1\n5\n"
            )
        }
        _ => {
            let [a, b, c] =
                nodes.map(|id| id.parse::<i64>().map_or(id.to_owned(), |id| (id - 1).to_string()));
            format!(
                "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"3\" NumberOfCells=\"1\">\
                 <Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0\n1 0 0\n{x} 1 0</DataArray></Points>\
                 <Cells><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">{a} {b} {c}</DataArray>\
                 <DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">3</DataArray>\
                 <DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">5</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>\n"
            )
        }
    };
    text.into_bytes()
}

const ALL: [&str; 6] = ["abaqus", "gmsh 2.2", "gmsh 4.1", "nastran", "vtk", "vtu"];
/// Those whose nodes have numbers of their own.
const NUMBERED: [&str; 4] = ["abaqus", "gmsh 2.2", "gmsh 4.1", "nastran"];
const GOOD: [&str; 3] = ["1", "2", "3"];

#[test]
fn the_triangle_is_sound() {
    for format in ALL {
        let found =
            attempt_bytes("x", &triangle(format, "2", "0", GOOD), format).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!((found.elements.count, found.totals.area), (1, Some(0.5)), "{format}");
    }
}

#[test]
fn node_numbers_that_are_none_are_refused() {
    for format in NUMBERED {
        for number in ["-2", "", "x", "2.5", "99999999999999999999", "0x2"] {
            let what = format!("{format}: node {number:?}");
            refused(attempt_bytes("x", &triangle(format, number, "0", GOOD), &what), &what);
        }
    }
    let what = "abaqus: node 0";
    refused(attempt_bytes("x", &triangle("abaqus", "0", "0", ["1", "1", "3"]), what), what);
    for format in ALL {
        for number in ["-2", "x", "2.5", "99999999999999999999"] {
            let what = format!("{format}: an element with the node {number:?}");
            refused(attempt_bytes("x", &triangle(format, "2", "0", ["1", number, "3"]), &what), &what);
        }
    }
}

#[test]
fn coordinates_that_are_not_finite_are_refused() {
    for format in ALL {
        for x in ["nan", "NaN", "-nan", "inf", "-inf", "Infinity", "1e999", "-1e999", "x", "1e", "0x1p3"] {
            let what = format!("{format}: x is {x}");
            let error = refused(attempt_bytes("x", &triangle(format, "2", x, GOOD), &what), &what);
            assert!(matches!(error.kind(), Kind::Malformed { .. }), "{error}");
        }
    }
}

#[test]
fn coordinates_at_the_ends_of_the_range_give_finite_numbers_or_an_error() {
    for format in ALL {
        for x in ["1e91", "-1e308"] {
            let what = format!("{format}: x is {x}");
            let error = refused(attempt_bytes("x", &triangle(format, "2", x, GOOD), &what), &what);
            assert!(error.to_string().contains("coordinates from -1e90 to 1e90"), "{error}");
        }
        for x in ["1e90", "-1e90", "1e60", "1e-155", "1e-200", "1e-308", "5e-324", "-0.0"] {
            let what = format!("{format}: x is {x}");
            let found =
                attempt_bytes("x", &triangle(format, "2", x, GOOD), &what).unwrap_or_else(|e| panic!("{e}"));
            let json = found.to_json();
            let again: meshgauge::Summary =
                serde_json::from_str(&json).unwrap_or_else(|e| panic!("{what}: {e}: {json}"));
            assert_eq!(again, found, "{what}");
        }
    }
}

#[test]
fn elements_that_name_missing_nodes_are_an_error_or_a_counted_check() {
    for format in ALL {
        let bytes = triangle(format, "2", "0", ["1", "9", "3"]);
        let error = refused(attempt_bytes("x", &bytes, format), format);
        let element = if format.starts_with("vt") { 0 } else { 7 };
        let node = if format.starts_with("vt") { 8 } else { 9 };
        let named =
            matches!(error.kind(), Kind::MissingNode { element: e, node: n } if (*e, *n) == (element, node));
        assert!(named, "{format}: {error}");
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("x");
        std::fs::write(&path, &bytes).expect("written");
        let allowing = Options { allow_missing_nodes: true, ..options() };
        let found = attempt_with(&path, &allowing, format).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!((found.checks.missing_nodes, found.elements.count), (1, 1), "{format}");
        assert!(found.shapes.is_empty(), "{format}: it has no corners to measure");
    }
}

#[test]
fn a_node_that_is_defined_twice_counts_once_and_the_last_holds() {
    let text = "*NODE\n1, 0., 0.\n2, 5., 0.\n3, 0., 1.\n2, 1., 0.\n*ELEMENT, TYPE=S3\n1, 1, 2, 3\n";
    let found = attempt_bytes("x", text.as_bytes(), "twice").expect("a triangle");
    assert_eq!((found.nodes.count, found.totals.area), (3, Some(0.5)));
    let bounds = found.nodes.bounds.expect("bounds");
    assert_eq!(bounds.max, [1.0, 1.0, 0.0]);
}
