//! XDMF files of several writers.

use super::Xdmf;
use crate::formats::testing::{self, Row, check, corpus, detected, message, own, read_bytes, read_file};
use crate::mesh::Shape::{self, *};

const MIXED: &[(Shape, usize)] = &[(Triangle, 28), (Quadrilateral, 36), (Wedge, 28), (Hexahedron, 8)];

const CORPUS: &[Row] = &[
    #[cfg(feature = "hdf5")]
    ("xdmf/meshio_mixed_hdf.xdmf", 54, MIXED, &[]),
    ("xdmf/meshio_mixed_xml.xdmf", 54, MIXED, &[]),
];

const OWN: &[Row] = &[
    ("meshio_mixed_xml.xdmf", 54, MIXED, &[]),
    #[cfg(feature = "hdf5")]
    ("meshio_mixed_hdf.xdmf", 54, MIXED, &[]),
    ("vtk_solids.xmf", 47, SOLIDS, &[]),
];
const SOLIDS: &[(Shape, usize)] =
    &[(Triangle, 2), (Tetrahedron, 2), (Pyramid, 2), (Wedge, 2), (Hexahedron, 2)];

#[test]
fn own_files_hold_what_their_writers_count() {
    OWN.iter().for_each(|row| drop(check(&Xdmf, &own("xdmf"), row)));
}

#[test]
fn corpus_files_hold_what_others_count() {
    let Some(corpus) = corpus() else { return };
    CORPUS.iter().for_each(|row| drop(check(&Xdmf, &corpus, row)));
    assert_eq!(detected(&Xdmf, &corpus), ["xdmf/meshio_mixed_hdf.xdmf", "xdmf/meshio_mixed_xml.xdmf"]);
}

/// A triangle and a quadrilateral of five points.
fn grid(points: &str, cells: &str) -> String {
    format!("<Grid>\n<Geometry GeometryType=\"XY\">{points}</Geometry>\n{cells}\n</Grid>\n")
}

const POINTS: &str = "<DataItem Dimensions=\"5 2\" Precision=\"8\">0 0 1 0 1 1 0 1 2 0</DataItem>";
const CELLS: &str = "<Topology TopologyType=\"Mixed\" NumberOfElements=\"5\">\
    <DataItem Dimensions=\"21\" NumberType=\"Int\">5 0 1 2 3 4 1 4 2 1 1 0 2 2 0 1 3 3 0 1 2 </DataItem></Topology>";

fn file(grids: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?>\n<!DOCTYPE Xdmf SYSTEM \"Xdmf.dtd\" []>\n<Xdmf><Domain>\n{grids}</Domain></Xdmf>\n"
    )
}

#[test]
fn mixed_elements_have_codes_and_some_have_counts() {
    let mesh = read_bytes(&Xdmf, "a.xdmf", file(&grid(POINTS, CELLS)).as_bytes()).expect("a mesh");
    assert_eq!(
        testing::holds(&mesh),
        "5 nodes, Polygon:1 Polyline:1 Polyvertex:1 Quadrilateral:1 Triangle:1"
    );
    let triangle = mesh.elements.iter().find(|element| element.1 == Triangle).expect("one");
    assert_eq!(triangle.2, [[1., 0., 0.], [2., 0., 0.], [1., 1., 0.]]);
}

#[test]
fn of_a_collection_over_time_the_first_is_read_and_of_one_over_space_all() {
    let one = grid(POINTS, CELLS);
    for (kind, nodes) in [("Temporal", 5), ("Spatial", 15)] {
        let all = format!("<Grid GridType=\"Collection\" CollectionType=\"{kind}\">{one}{one}{one}</Grid>");
        let mesh = read_bytes(&Xdmf, "a.xdmf", file(&all).as_bytes()).expect("a mesh");
        assert_eq!(mesh.nodes.count(), nodes, "{kind}");
    }
}

/// Two rows of three quadrilaterals; four hexahedra of 1 x 2 x 3.
#[test]
fn structured_topologies_imply_their_elements() {
    let item = |numbers: &str| {
        let count = numbers.split(' ').count();
        format!("<DataItem Dimensions=\"{count}\" Precision=\"8\">{numbers}</DataItem>")
    };
    let grid = |kind: &str, dimensions: &str, of: &str, items: &[&str]| {
        let items: String = items.iter().map(|numbers| item(numbers)).collect();
        format!(
            "<Grid><Topology TopologyType=\"{kind}\" Dimensions=\"{dimensions}\"/>\
             <Geometry GeometryType=\"{of}\">{items}</Geometry></Grid>"
        )
    };
    let listed = "0 0 1 0 2 0 3 0 0 1 1 1 2 1 3 1 0 2 1 2 2 2 3 2";
    let flat = [
        grid("2DSMesh", "3 4", "XY", &[listed]),
        grid("2DRectMesh", "3 4", "VXVY", &["0 1 2 3", "0 1 2"]),
        grid("2DCoRectMesh", "3 4", "ORIGIN_DXDY", &["0 0", "1 1"]),
    ];
    for text in &flat {
        let mesh = read_bytes(&Xdmf, "a.xdmf", file(text).as_bytes()).expect("a mesh");
        assert_eq!(testing::holds(&mesh), "12 nodes, Quadrilateral:6");
        assert_eq!(mesh.elements[4].2, [[1., 1., 0.], [2., 1., 0.], [2., 2., 0.], [1., 2., 0.]]);
    }
    let solid = [
        grid("3DRectMesh", "2 2 3", "VXVYVZ", &["5 6 7", "0 2", "1 4"]),
        grid("3DCoRectMesh", "2 2 3", "ORIGIN_DXDYDZ", &["1 0 5", "3 2 1"]),
    ];
    for text in &solid {
        let mesh = read_bytes(&Xdmf, "a.xdmf", file(text).as_bytes()).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(testing::holds(&mesh), "12 nodes, Hexahedron:2");
        let ring = |z| [[6., 0., z], [7., 0., z], [7., 2., z], [6., 2., z]];
        assert_eq!(mesh.elements[1].2, [ring(1.), ring(4.)].concat());
    }
    let both = format!("{}{}", flat[0], solid[1]);
    let mesh = read_bytes(&Xdmf, "a.xdmf", file(&both).as_bytes()).expect("a mesh");
    assert_eq!((mesh.nodes.count(), mesh.elements.len(), mesh.elements[7].0), (24, 8, 8));
    let endless = grid("3DCoRectMesh", "99999999 99999999 99999999", "ORIGIN_DXDYDZ", &["0 0 0", "1 1 1"]);
    assert!(message(&Xdmf, "a.xdmf", file(&endless).as_bytes()).contains("is over the limit"));
}

#[test]
fn steps_that_fetch_the_mesh_before_them_are_the_same_mesh() {
    let step = "<Grid><xi:include xpointer=\"xpointer(//Grid[@Name='mesh'])\"/><Time Value=\"0\"/></Grid>";
    let series = format!("<Grid GridType=\"Collection\" CollectionType=\"Temporal\">{step}{step}</Grid>");
    let mesh =
        read_bytes(&Xdmf, "a.xdmf", file(&(grid(POINTS, CELLS) + &series)).as_bytes()).expect("a mesh");
    assert_eq!(mesh.nodes.count(), 5);
    assert!(message(&Xdmf, "a.xdmf", file(&series).as_bytes()).contains("an XInclude is not read"));
}

#[test]
fn plain_binary_files_are_read_in_either_byte_order() {
    let cells = "<Topology TopologyType=\"Triangle\" BaseOffset=\"1\"><DataItem Dimensions=\"1 3\" NumberType=\"Int\" \
        Format=\"Binary\" Endian=\"Big\" Seek=\"4\">ids.bin</DataItem></Topology>";
    let points = "<DataItem Dimensions=\"3 2\" Format=\"Binary\" Endian=\"Little\">points.bin</DataItem>";
    let ids: Vec<u8> = [9i32, 1, 2, 3].into_iter().flat_map(i32::to_be_bytes).collect();
    let reals: Vec<u8> = [0f32, 0., 1., 0., 0., 1.].into_iter().flat_map(f32::to_le_bytes).collect();
    let text = file(&grid(points, cells));
    let files = [("a.xdmf", text.as_bytes()), ("ids.bin", &ids[..]), ("points.bin", &reals[..])];
    let mesh = testing::read_files(&Xdmf, "a.xdmf", &files).expect("a mesh");
    assert_eq!(mesh.elements[0].2, [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]]);
    let error = testing::read_files(&Xdmf, "a.xdmf", &files[..2]).expect_err("no file").to_string();
    assert!(error.contains("line 5: included file \"points.bin\""), "{error}");
}

#[test]
fn an_absolute_name_may_lead_into_the_own_folder() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let reals: Vec<u8> = [0f32, 0., 1., 0., 0., 1.].into_iter().flat_map(f32::to_le_bytes).collect();
    let cells =
        "<Topology TopologyType=\"Triangle\"><DataItem Dimensions=\"1 3\">0 1 2</DataItem></Topology>";
    for (name, is_read) in [(folder.path().join("p.bin"), true), ("/etc/hostname".into(), false)] {
        let points = "<DataItem Dimensions=\"3 2\" Format=\"Binary\" Endian=\"Little\">";
        let text = file(&grid(&format!("{points}{}</DataItem>", name.display()), cells));
        std::fs::write(folder.path().join("p.bin"), &reals).expect("a file");
        std::fs::write(folder.path().join("a.xdmf"), text).expect("a file");
        let found = crate::formats::reading::read(&Xdmf, &folder.path().join("a.xdmf"));
        assert_eq!(found.is_ok(), is_read, "{}", name.display());
    }
}

#[test]
fn what_is_wrong_or_not_read_is_named() {
    let rows = [
        (grid(POINTS, ""), "line 4: expected a grid with a Topology, found none"),
        (
            grid(&POINTS.replace("5 2", "6 2"), CELLS),
            "line 5: expected 12 numbers (points), of which 10 are there",
        ),
        (grid(POINTS, &CELLS.replace("5 0 1", "5 9 1")), "element 1 names node 9"),
        (grid(POINTS, &CELLS.replace("=\"5\"", "=\"4\"")), "expected 21 numbers for 4 elements, found 16"),
        (
            grid(POINTS, &CELLS.replace("5 0 1", "99 0 1")),
            "expected the code of a known type for element 1, found 99",
        ),
        (grid(POINTS, &CELLS.replace("Mixed", "Polygon3")), "XDMF topology of the type polygon3 is not read"),
        (
            grid(POINTS, &CELLS.replace("Mixed", "3DSMesh")),
            "expected 3 numbers of nodes in the attribute Dimensions, found 1",
        ),
        (
            grid(POINTS, &CELLS.replace("<DataItem", "<DataItem ItemType=\"HyperSlab\"")),
            "line 6: a DataItem of the type hyperslab within a grid is not read in XDMF files",
        ),
        (
            grid(&POINTS.replace("<DataItem", "<DataItem Reference=\"XML\""), CELLS),
            "line 5: a DataItem that refers to another is not read in XDMF files",
        ),
    ];
    for (grids, expected) in rows {
        let found = message(&Xdmf, "a.xdmf", file(&grids).as_bytes());
        assert!(found.contains(expected), "{found}\n  lacks {expected}");
    }
}

#[cfg(feature = "hdf5")]
#[test]
fn heavy_data_of_another_length_or_of_no_file_are_errors() {
    let [text, data] = ["meshio_mixed_hdf.xdmf", "meshio_mixed_hdf.h5"].map(|name| own("xdmf").join(name));
    #[expect(clippy::disallowed_methods, reason = "a small file of known size")]
    let [text, data] = [text, data].map(|path| std::fs::read(path).expect("readable"));
    let text = String::from_utf8(text).expect("text");
    for (from, to, expected) in [
        ("54 3", "53 3", "expected 159 numbers, as the XDMF file says, found 162"),
        (":/data0", ":/data7", "expected the dataset data7 in /, found none of that name"),
        ("meshio_mixed_hdf.h5:/data0", "../x.h5:/data0", "beneath the mesh's own folder"),
    ] {
        let text = text.replace(from, to);
        let files = [("a.xdmf", text.as_bytes()), ("meshio_mixed_hdf.h5", &data[..])];
        let error = testing::read_files(&Xdmf, "a.xdmf", &files).expect_err(expected).to_string();
        assert!(error.contains(expected), "{error}\n  lacks {expected}");
    }
}

#[test]
fn a_cut_file_is_an_error_and_a_flipped_bit_no_panic() {
    let folder = own("xdmf");
    let whole = |bytes: &[u8]| bytes.trim_ascii_end().len();
    testing::damage(&Xdmf, &folder.join("meshio_mixed_xml.xdmf"), whole);
    #[cfg(feature = "hdf5")]
    {
        let [text, data] = ["meshio_mixed_hdf.xdmf", "meshio_mixed_hdf.h5"].map(|name| folder.join(name));
        testing::damage_beside(&Xdmf, &text, &[&text, &data], whole);
        testing::damage_beside(&Xdmf, &data, &[&text, &data], <[u8]>::len);
    }
    assert!(read_file(&Xdmf, &folder.join("meshio_mixed_xml.xdmf")).nodes.count() > 0);
}
