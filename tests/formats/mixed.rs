//! One mesh of hexahedra and wedges with their faces, in every format and encoding: one result.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::fs;
use std::path::Path;

use meshgauge::Summary;
use serde_json::Value;

use crate::corpus::corpus;
use crate::{MIXED, OWN, SOLIDS, folder, summary};

/// The mesh as Gmsh wrote it: coordinates with their digits, elements with tag, type and nodes.
struct Mesh {
    points: Vec<[String; 3]>,
    elements: Vec<(u64, usize, Vec<u64>)>,
}

/// Gmsh's type, number of nodes, Abaqus's type, VTK's type.
const TYPES: [(usize, usize, &str, u8); 4] =
    [(2, 3, "S3", 5), (3, 4, "S4", 9), (5, 8, "C3D8", 12), (6, 6, "C3D6", 13)];

fn of_type(gmsh: usize) -> &'static (usize, usize, &'static str, u8) {
    TYPES.iter().find(|row| row.0 == gmsh).expect("a type of the mesh")
}

fn gmsh_file() -> std::path::PathBuf {
    folder("gmsh").join("mixed_hex_prism_41.msh")
}

impl Mesh {
    fn read() -> Self {
        let text = fs::read_to_string(gmsh_file()).expect("the mesh");
        let section = |name: &str| {
            let start = text.find(&format!("${name}\n")).expect("a section") + name.len() + 2;
            text[start..text.find(&format!("$End{name}")).expect("its end")].lines()
        };
        let numbers = |line: &str| -> Vec<u64> {
            line.split_whitespace().map(|word| word.parse().expect("a number")).collect()
        };
        let mut lines = section("Nodes").skip(1);
        let mut points = Vec::new();
        while let Some(head) = lines.next() {
            let count = numbers(head)[3] as usize;
            let tags: Vec<u64> = lines.by_ref().take(count).map(|line| numbers(line)[0]).collect();
            for (tag, line) in tags.into_iter().zip(lines.by_ref().take(count)) {
                assert_eq!(tag, points.len() as u64 + 1, "nodes are numbered as they stand");
                let mut words = line.split_whitespace().map(str::to_owned);
                points.push([(); 3].map(|()| words.next().expect("three coordinates")));
            }
        }
        let mut lines = section("Elements").skip(1);
        let mut elements = Vec::new();
        while let Some(head) = lines.next() {
            let [_, _, kind, count] = numbers(head)[..] else { panic!("the head of a block: {head}") };
            for line in lines.by_ref().take(count as usize) {
                let row = numbers(line);
                assert_eq!(row[0], elements.len() as u64 + 1, "elements are numbered as they stand");
                elements.push((row[0], kind as usize, row[1..].to_vec()));
            }
        }
        assert_eq!((points.len(), elements.len()), (54, 100));
        Self { points, elements }
    }

    fn abaqus(&self) -> Vec<u8> {
        let mut text = "*HEADING\nhexahedra, wedges and their faces\n*NODE\n".to_owned();
        for (k, [x, y, z]) in self.points.iter().enumerate() {
            writeln!(text, "{}, {x}, {y}, {z}", k + 1).expect("memory");
        }
        let mut last = 0;
        for (tag, kind, nodes) in &self.elements {
            if *kind != last {
                writeln!(text, "*ELEMENT, TYPE={}", of_type(*kind).2).expect("memory");
                last = *kind;
            }
            writeln!(text, "{tag}, {}", joined(nodes, 0, ", ")).expect("memory");
        }
        text.into_bytes()
    }

    fn nastran(&self) -> Vec<u8> {
        let mut text = String::new();
        // In any order, as decks have it.
        for (tag, kind, nodes) in &self.elements {
            let card = ["CTRIA3", "CQUAD4", "CHEXA", "CPENTA"]
                [TYPES.iter().position(|row| row.0 == *kind).expect("a type")];
            let (first, rest) = nodes.split_at(nodes.len().min(6));
            writeln!(text, "{card},{tag},1,{}", joined(first, 0, ",")).expect("memory");
            if !rest.is_empty() {
                writeln!(text, ",{}", joined(rest, 0, ",")).expect("memory");
            }
        }
        for (k, [x, y, z]) in self.points.iter().enumerate() {
            writeln!(text, "GRID,{},,{x},{y},{z}", k + 1).expect("memory");
        }
        text.into_bytes()
    }

    fn gmsh_22(&self) -> Vec<u8> {
        let mut text = format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n", self.points.len());
        for (k, [x, y, z]) in self.points.iter().enumerate() {
            writeln!(text, "{} {x} {y} {z}", k + 1).expect("memory");
        }
        write!(text, "$EndNodes\n$Elements\n{}\n", self.elements.len()).expect("memory");
        for (tag, kind, nodes) in &self.elements {
            writeln!(text, "{tag} {kind} 2 1 1 {}", joined(nodes, 0, " ")).expect("memory");
        }
        text.push_str("$EndElements\n");
        text.into_bytes()
    }

    fn vtk_text(&self) -> Vec<u8> {
        let entries = self.elements.iter().map(|(_, _, nodes)| nodes.len() + 1).sum::<usize>();
        let mut text = format!(
            "# vtk DataFile Version 3.0\nmixed\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 54 double\n{}\nCELLS 100 {entries}\n",
            self.coordinates()
        );
        for (_, _, nodes) in &self.elements {
            writeln!(text, "{} {}", nodes.len(), joined(nodes, 1, " ")).expect("memory");
        }
        writeln!(text, "CELL_TYPES 100\n{}", self.codes()).expect("memory");
        text.into_bytes()
    }

    fn vtk_binary(&self) -> Vec<u8> {
        let mut out =
            b"# vtk DataFile Version 5.1\nmixed\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 54 double\n"
                .to_vec();
        let coordinates = self.points.iter().flatten().map(|x| x.parse::<f64>().expect("a number"));
        coordinates.for_each(|x| out.extend(x.to_be_bytes()));
        let ends = self.ends();
        out.extend(format!("\nCELLS 101 {}\nOFFSETS vtktypeint64\n", ends[99]).bytes());
        [0].iter().chain(&ends).for_each(|end| out.extend(end.to_be_bytes()));
        out.extend(b"\nCONNECTIVITY vtktypeint64\n");
        self.elements.iter().flat_map(|e| &e.2).for_each(|id| out.extend((id - 1).to_be_bytes()));
        out.extend(b"\nCELL_TYPES 100\n");
        self.elements.iter().for_each(|e| out.extend(i32::from(of_type(e.1).3).to_be_bytes()));
        out.push(b'\n');
        out
    }

    fn vtu_text(&self) -> Vec<u8> {
        let connectivity: Vec<_> = self.elements.iter().map(|e| joined(&e.2, 1, " ")).collect();
        let array = |kind: &str, name: &str, values: &str| {
            format!(
                "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"3\" format=\"ascii\">\n{values}\n</DataArray>\n"
            )
        };
        let cells = [
            array("Int64", "connectivity", &connectivity.join("\n")),
            array("Int64", "offsets", &joined(&self.ends(), 0, " ")),
            array("UInt8", "types", &self.codes()),
        ];
        format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n\
             <UnstructuredGrid>\n<Piece NumberOfPoints=\"54\" NumberOfCells=\"100\">\n<Points>\n{}</Points>\n\
             <Cells>\n{}</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n",
            array("Float64", "Points", &self.coordinates()),
            cells.concat()
        )
        .into_bytes()
    }

    fn coordinates(&self) -> String {
        self.points.iter().map(|point| point.join(" ")).collect::<Vec<_>>().join("\n")
    }

    fn codes(&self) -> String {
        self.elements.iter().map(|e| of_type(e.1).3.to_string()).collect::<Vec<_>>().join(" ")
    }

    fn ends(&self) -> Vec<u64> {
        let mut end = 0;
        let after = |e: &(u64, usize, Vec<u64>)| {
            end += e.2.len() as u64;
            end
        };
        self.elements.iter().map(after).collect()
    }
}

fn joined(numbers: &[u64], less: u64, between: &str) -> String {
    numbers.iter().map(|n| (n - less).to_string()).collect::<Vec<_>>().join(between)
}

fn shapes(summary: &Summary) -> Value {
    without_noise(serde_json::to_value(&summary.shapes).expect("JSON"))
}

/// The number that the first element has.
fn base(summary: &Summary) -> u64 {
    u64::from(!summary.mesh.format.starts_with("vt"))
}

/// Elements by their position.
fn from_zero(value: &mut Value, base: u64) {
    match value {
        Value::Object(entries) => {
            for (key, value) in entries {
                match value.as_u64() {
                    Some(number) if key == "min_element" => *value = (number - base).into(),
                    _ => from_zero(value, base),
                }
            }
        }
        Value::Array(values) => values.iter_mut().for_each(|value| from_zero(value, base)),
        _ => {}
    }
}

/// Whole numbers agree exactly, others to within `tolerance`.
fn assert_near(found: &Value, expected: &Value, tolerance: f64, place: &str) {
    match (found, expected) {
        (Value::Object(a), Value::Object(b)) => {
            assert!(a.keys().eq(b.keys()), "{place}: {:?} {:?}", a.keys(), b.keys());
            a.iter().for_each(|(key, a)| assert_near(a, &b[key], tolerance, &format!("{place} {key}")));
        }
        (Value::Number(a), Value::Number(b)) if a.is_f64() || b.is_f64() => {
            let (a, b) = (a.as_f64().expect("a number"), b.as_f64().expect("a number"));
            assert!((a - b).abs() <= tolerance, "{place}: {a} {b}");
        }
        _ => assert_eq!(found, expected, "{place}"),
    }
}

/// Takes out what rounding decides: how measures go together that do not vary.
fn without_noise(mut shapes: Value) -> Value {
    for shape in shapes.as_object_mut().expect("shapes by name").values_mut() {
        let mut steady = Vec::new();
        for (code, measure) in shape["measures"].as_object_mut().expect("measures by code") {
            if measure["sd"].as_f64().is_some_and(|sd| sd < 1e-9) {
                steady.push(code.clone());
            }
        }
        let correlation = shape["correlation"].as_object_mut().expect("pairs by their codes");
        correlation.retain(|pair, _| !pair.split(' ').any(|code| steady.iter().any(|s| s == code)));
    }
    shapes
}

/// Takes out which of equal minima is the smallest, which rounding decides too.
fn without_places(mut shapes: Value) -> Value {
    for shape in shapes.as_object_mut().expect("shapes by name").values_mut() {
        for measure in shape["measures"].as_object_mut().expect("measures by code").values_mut() {
            measure.as_object_mut().expect("a measure").remove("min_element");
        }
    }
    shapes
}

#[test]
fn a_mesh_of_the_same_digits_is_the_same_in_every_format() {
    let mesh = Mesh::read();
    let own = summary(&gmsh_file());
    let mut expected = shapes(&own);
    from_zero(&mut expected, base(&own));
    let folder = tempfile::tempdir().expect("a temporary folder");
    let files = [
        ("abaqus", mesh.abaqus()),
        ("gmsh", mesh.gmsh_22()),
        ("nastran", mesh.nastran()),
        ("vtk", mesh.vtk_text()),
        ("vtk", mesh.vtk_binary()),
        ("vtu", mesh.vtu_text()),
    ];
    for (format, bytes) in files {
        let path = folder.path().join("mesh");
        fs::write(&path, bytes).expect("written");
        let found = summary(&path);
        assert_eq!(found.mesh.format, format);
        let mut found_shapes = shapes(&found);
        from_zero(&mut found_shapes, base(&found));
        // A block of a type is a piece in some formats, and sums are taken piece by piece.
        assert_near(&found_shapes, &expected, 1e-14, format);
        assert_eq!(
            (&found.nodes, &found.sizes.edge_length),
            (&own.nodes, &own.sizes.edge_length),
            "{format}"
        );
        assert_eq!(found.checks, own.checks, "{format}");
    }
}

/// Gmsh turns wedges round where it writes VTK, and others round coordinates or order the cells anew.
fn assert_is_the_mixed_mesh(path: &Path) {
    assert_is_the_mixed_mesh_to(path, 1e-9);
}

/// What a format holds of the mesh is the same to a tolerance: some list cells alone, or fewer digits.
fn assert_is_the_mixed_mesh_to(path: &Path, tolerance: f64) {
    let (own, found) = (summary(&gmsh_file()), summary(path));
    let place = path.display().to_string();
    let mut expected = without_places(shapes(&own));
    expected
        .as_object_mut()
        .expect("shapes by name")
        .retain(|name, _| found.shapes.keys().any(|shape| shape.name() == name));
    assert_near(&without_places(shapes(&found)), &expected, tolerance, &place);
    let close = |a: Option<f64>, b: Option<f64>| a.zip(b).is_some_and(|(a, b)| (a - b).abs() < tolerance);
    assert!(close(found.totals.volume, own.totals.volume), "{place}");
    assert_eq!((found.checks.inverted, found.checks.degenerate), (0, 0), "{place}");
}

#[test]
fn a_mesh_that_gmsh_wrote_twice_is_the_same() {
    assert_is_the_mixed_mesh(&folder("vtk").join("gmsh_mixed_wedge.vtk"));
}

/// Each format that can hold the mesh, or its cells, has it in `tests/meshes`.
#[test]
fn our_own_mixed_meshes_are_the_same_in_every_format() {
    let mut formats = BTreeSet::new();
    for (format, name, _, found, _) in OWN {
        if *found == MIXED || *found == SOLIDS {
            assert_is_the_mixed_mesh_to(&folder(format).join(name), 1e-5);
            formats.insert(*format);
        }
    }
    let least =
        ["comsol", "gmsh", "lsdyna", "medit", "nastran", "netgen", "openfoam", "su2", "ugrid", "unv", "vtk"];
    assert!(least.iter().all(|format| formats.contains(format)), "{formats:?}");
}

#[test]
fn the_mixed_mesh_of_the_corpus_is_the_same_whoever_wrote_it() {
    let Some(corpus) = corpus() else { return };
    let mut found = 0;
    for format in ["cgns", "exodus", "gmsh", "med", "medit", "netgen", "su2", "ugrid", "vtk", "vtu", "xdmf"] {
        for entry in fs::read_dir(corpus.join(format)).expect("a folder of the corpus") {
            let path = entry.expect("an entry").path();
            if path.file_name().is_some_and(|name| {
                let name = name.to_string_lossy();
                name.contains("mixed") && !(name.starts_with("mfem") || name.ends_with(".h5"))
            }) {
                assert_is_the_mixed_mesh(&path);
                found += 1;
            }
        }
    }
    assert!(found >= 27, "{found}");
}
