//! Headers that promise more than there is: refused at the first look, without room made for it.

use crate::attempt::{attempt_bytes, refused};

const HUGE: &str = "1000000000000000000";

fn gmsh(text: &str) -> Vec<u8> {
    text.as_bytes().to_vec()
}

/// A binary Gmsh file up to its nodes or elements.
fn gmsh_binary(version: &str, sections: &[&[u8]]) -> Vec<u8> {
    let head = format!("$MeshFormat\n{version} 1 8\n");
    [head.as_bytes(), &1u32.to_le_bytes(), b"\n$EndMeshFormat\n"]
        .into_iter()
        .chain(sections.iter().copied())
        .collect::<Vec<_>>()
        .concat()
}

fn words(values: &[u64]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_le_bytes()).collect()
}

#[test]
fn counts_that_gmsh_files_do_not_keep() {
    let nodes = "$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n";
    let header = |version: &str| format!("$MeshFormat\n{version} 0 8\n$EndMeshFormat\n");
    let blocks = "$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n";
    let huge = 1u64 << 60;
    let rows: Vec<(&str, Vec<u8>)> = vec![
        ("1, nodes", gmsh(&format!("$NOD\n{HUGE}\n1 0 0 0\n$ENDNOD\n"))),
        ("2.2, nodes", gmsh(&format!("{}$Nodes\n{HUGE}\n1 0 0 0\n$EndNodes\n", header("2.2")))),
        (
            "2.2, elements",
            gmsh(&format!("{}{nodes}$Elements\n{HUGE}\n1 2 2 1 1 1 2 3\n$EndElements\n", header("2.2"))),
        ),
        (
            "2.2, tags",
            gmsh(&format!("{}{nodes}$Elements\n1\n1 2 {HUGE} 1 1 1 2 3\n$EndElements\n", header("2.2"))),
        ),
        ("4.1, blocks", gmsh(&format!("{}$Nodes\n{HUGE} 3 1 3\n2 1 0 3\n1\n$EndNodes\n", header("4.1")))),
        ("4.1, nodes", gmsh(&format!("{}$Nodes\n1 {HUGE} 1 3\n2 1 0 {HUGE}\n1\n$EndNodes\n", header("4.1")))),
        (
            "4.1, elements",
            gmsh(&format!(
                "{}{blocks}$Elements\n1 {HUGE} 1 1\n2 1 2 {HUGE}\n1 1 2 3\n$EndElements\n",
                header("4.1")
            )),
        ),
        (
            "4.1, blocks of elements",
            gmsh(&format!(
                "{}{blocks}$Elements\n{HUGE} 1 1 1\n2 1 2 1\n1 1 2 3\n$EndElements\n",
                header("4.1")
            )),
        ),
        ("2.2 binary, nodes", gmsh_binary("2.2", &[b"$Nodes\n1000000000000000000\n", &[0; 28]])),
        (
            "2.2 binary, elements",
            gmsh_binary(
                "2.2",
                &[
                    b"$Nodes\n0\n\n$EndNodes\n$Elements\n1000000000000000000\n",
                    &[2, 0, 0, 0, 255, 255, 255, 127, 2, 0, 0, 0],
                    &[0; 28],
                ],
            ),
        ),
        (
            "2.2 binary, tags",
            gmsh_binary(
                "2.2",
                &[
                    b"$Nodes\n0\n\n$EndNodes\n$Elements\n1\n",
                    &[2, 0, 0, 0, 1, 0, 0, 0, 255, 255, 255, 127],
                    &[0; 28],
                ],
            ),
        ),
        ("4.1 binary, blocks", gmsh_binary("4.1", &[b"$Nodes\n", &words(&[huge, 1, 1, 1]), &[0; 28]])),
        (
            "4.1 binary, nodes",
            gmsh_binary(
                "4.1",
                &[b"$Nodes\n", &words(&[1, huge, 1, huge]), &[0; 12], &words(&[huge]), &[0; 64]],
            ),
        ),
    ];
    for (what, bytes) in rows {
        let what = format!("gmsh {what}");
        let error = refused(attempt_bytes("x.msh", &bytes, &what), &what);
        assert_eq!(error.format(), Some("gmsh"), "{error}");
    }
}

#[test]
fn counts_that_vtk_files_do_not_keep() {
    let head =
        |encoding: &str| format!("# vtk DataFile Version 4.2\n\n{encoding}\nDATASET UNSTRUCTURED_GRID\n");
    let points = "POINTS 3 float\n0 0 0 1 0 0 0 1 0\n";
    for encoding in ["ASCII", "BINARY"] {
        let rows = [
            format!("POINTS {HUGE} float\n0 0 0\n"),
            "POINTS 9999999999999999999 float\n0 0 0\n".to_owned(),
            format!("{points}CELLS {HUGE} 4\n3 0 1 2\nCELL_TYPES 1\n5\n"),
            format!("{points}CELLS 1 {HUGE}\n3 0 1 2\nCELL_TYPES 1\n5\n"),
            format!("{points}CELLS 1 4\n{HUGE} 0 1 2\nCELL_TYPES 1\n5\n"),
            format!("{points}CELLS 1 4\n3 0 1 2\nCELL_TYPES {HUGE}\n5\n"),
            format!(
                "{points}CELLS {HUGE} 3\nOFFSETS vtktypeint64\n0 3\nCONNECTIVITY vtktypeint64\n0 1 2\nCELL_TYPES 1\n5\n"
            ),
            format!("{points}METADATA\nINFORMATION {HUGE}\n\nCELLS 1 4\n3 0 1 2\n"),
            format!(
                "{points}CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\nPOINT_DATA {HUGE}\nSCALARS s double {HUGE}\nLOOKUP_TABLE default\n1\n"
            ),
            format!("{points}FIELD f {HUGE}\na {HUGE} {HUGE} double\n1 2 3\n"),
        ];
        for row in rows {
            let what = format!("vtk {encoding}: {row}");
            let error =
                refused(attempt_bytes("x.vtk", format!("{}{row}", head(encoding)).as_bytes(), &what), &what);
            assert_eq!(error.format(), Some("vtk"), "{error}");
        }
    }
}

#[test]
fn counts_that_vtu_files_do_not_keep() {
    let array = |kind: &str, name: &str, attributes: &str, text: &str| {
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"3\" {attributes}>{text}</DataArray>"
        )
    };
    let ascii = "format=\"ascii\"";
    let file = |attributes: &str, points: &str, cells: &str, arrays: [String; 4], tail: &str| {
        let [p, c, o, t] = arrays;
        format!(
            "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\" header_type=\"UInt64\" {attributes}><UnstructuredGrid>\
             <Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\"><Points>{p}</Points><Cells>{c}{o}{t}</Cells></Piece>\
             </UnstructuredGrid>{tail}</VTKFile>\n"
        )
    };
    let good = || {
        [
            array("Float64", "Points", ascii, "0 0 0 1 0 0 0 1 0"),
            array("Int64", "connectivity", ascii, "0 1 2"),
            array("Int64", "offsets", ascii, "3"),
            array("UInt8", "types", ascii, "5"),
        ]
    };
    let sound = attempt_bytes("x.vtu", file("", "3", "1", good(), "").as_bytes(), "sound");
    assert_eq!(sound.expect("a triangle").elements.count, 1);
    let with = |k: usize, row: String| {
        let mut arrays = good();
        arrays[k] = row;
        arrays
    };
    // A length of 2^60 bytes, and 2^60 blocks of 2^60 bytes.
    let long = "AAAAAAAAABA=";
    let appended = |text: &str| format!("<AppendedData encoding=\"base64\">_{text}</AppendedData>");
    let at =
        |offset: &str| array("Float64", "Points", &format!("format=\"appended\" offset=\"{offset}\""), "");
    let binary = |text: &str| array("Float64", "Points", "format=\"binary\"", text);
    let zlib = "compressor=\"vtkZLibDataCompressor\"";
    let rows = [
        file("", HUGE, "1", good(), ""),
        file("", "3", HUGE, good(), ""),
        file("", "9999999999999999999", "9999999999999999999", good(), ""),
        file("", "3", "1", with(2, array("Int64", "offsets", ascii, HUGE)), ""),
        file("", "3", "1", with(0, binary(long)), ""),
        file("", HUGE, "1", with(0, binary(long)), ""),
        file(zlib, "3", "1", with(0, binary(&long.repeat(3))), ""),
        file(zlib, HUGE, "1", with(0, binary(&long.repeat(3))), ""),
        file("", "3", "1", with(0, at("0")), &appended(long)),
        file("", "3", "1", with(0, at(HUGE)), &appended(long)),
        file("", "3", "1", with(0, at("18446744073709551615")), &appended(long)),
        file("", HUGE, "1", with(0, at("0")), &appended(long)),
    ];
    for row in rows {
        let error = refused(attempt_bytes("x.vtu", row.as_bytes(), &row), &row);
        assert_eq!(error.format(), Some("vtu"), "{error}");
    }
}

#[test]
fn numbers_of_decks_that_are_far_apart_take_no_room() {
    let deck = "*NODE\n1, 0., 0.\n1099511627775, 1., 0.\n500000000000, 0., 1.\n\
                *ELEMENT, TYPE=S3\n1099511627775, 1, 1099511627775, 500000000000\n";
    let summary = attempt_bytes("x.inp", deck.as_bytes(), "sparse").expect("a triangle");
    assert_eq!((summary.nodes.count, summary.elements.count, summary.totals.area), (3, 1, Some(0.5)));
    let rows = [
        format!("*USER ELEMENT, TYPE=U1, NODES={HUGE}\n"),
        format!("{deck}*NODE\n{HUGE}, 0., 0.\n"),
        format!("{deck}*ELEMENT, TYPE=S3\n{HUGE}, 1, 1, 1\n"),
        format!("{deck}*ELEMENT, TYPE=S3\n2, 1, 1, {HUGE}\n"),
    ];
    for row in rows {
        let error = refused(attempt_bytes("x.inp", row.as_bytes(), &row), &row);
        assert_eq!(error.format(), Some("abaqus"), "{error}");
    }
}
