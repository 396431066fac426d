//! Statistics by region and the worst elements, on small meshes whose regions are known and on real ones.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use meshgauge::mesh::Shape;
use meshgauge::summary::Region;
use meshgauge::{Options, Summary, score};

/// Two right-angled tetrahedra of one node table, the second three times as high.
const NODES: [[f64; 3]; 5] = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.], [0., 0., -3.]];

fn options() -> Options {
    Options { threads: 2, run_info: false, by_region: true, worst: 3, ..Options::default() }
}

fn scored(name: &str, text: &str) -> Summary {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(name);
    std::fs::write(&path, text).expect("written");
    score(&path, &options()).unwrap_or_else(|e| panic!("{e}"))
}

fn lines(row: impl Fn(usize, [f64; 3]) -> String) -> String {
    NODES.iter().enumerate().map(|(i, point)| row(i + 1, *point)).collect()
}

/// Name, number of elements and smallest M31 of each region.
fn regions(summary: &Summary) -> Vec<(Option<&str>, u64, u64)> {
    let row = |region: &Region| {
        let found = &region.shapes[&Shape::Tetrahedron];
        (found.count, found.measures["M31"].min_element)
    };
    let list = &summary.regions.as_ref().expect("they were asked for").list;
    list.iter().map(|region| (region.name.as_deref(), row(region).0, row(region).1)).collect()
}

fn gmsh2(groups: [i64; 2], names: &str) -> String {
    let nodes = lines(|id, [x, y, z]| format!("{id} {x} {y} {z}\n"));
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n{names}$Nodes\n5\n{nodes}$EndNodes\n$Elements\n2\n\
         7 4 2 {} 1 1 2 3 4\n9 4 2 {} 1 1 3 2 5\n$EndElements\n",
        groups[0], groups[1]
    )
}

fn gmsh4(names: &str, groups: &str) -> String {
    let nodes = lines(|_, [x, y, z]| format!("{x} {y} {z}\n"));
    format!(
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n{names}$Entities\n1 0 0 2\n1 0 0 0 0\n\
         5 0 0 0 1 1 1 {groups} 0\n6 0 0 -3 1 1 0 0 0\n$EndEntities\n\
         $Nodes\n1 5 1 5\n3 5 0 5\n1\n2\n3\n4\n5\n{nodes}$EndNodes\n\
         $Elements\n2 2 7 9\n3 5 4 1\n7 1 2 3 4\n3 6 4 1\n9 1 3 2 5\n$EndElements\n"
    )
}

#[test]
fn each_format_says_which_region_an_element_is_in() {
    let names = "$PhysicalNames\n2\n2 1 \"wall\"\n3 1 \"bar of steel\"\n$EndPhysicalNames\n";
    let bulk = lines(|id, [x, y, z]| format!("GRID,{id},,{x:.1},{y:.1},{z:.1}\n"));
    let deck = lines(|id, [x, y, z]| format!("{id}, {x}, {y}, {z}\n"));
    let keyword = lines(|id, [x, y, z]| format!("{id},{x:.1},{y:.1},{z:.1}\n"));
    let vertices = lines(|_, [x, y, z]| format!("{x} {y} {z} 0\n"));
    let points = lines(|_, [x, y, z]| format!("{x} {y} {z}\n"));
    let abaqus_parts = format!(
        "*PART, NAME=bar\n*NODE\n{deck}*ELEMENT, TYPE=C3D4, ELSET=core\n7, 1, 2, 3, 4\n\
         *ELEMENT, TYPE=C3D4\n9, 1, 3, 2, 5\n*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=bar-1, PART=bar\n\
         *END INSTANCE\n*END ASSEMBLY\n"
    );
    // (file, its text, the regions of elements 1 and 2, the elements' numbers)
    let rows = [
        ("a.msh", gmsh2([1, 12], names), ["bar of steel", "12"], [7, 9]),
        ("b.msh", gmsh2([0, 12], ""), ["", "12"], [7, 9]),
        ("c.msh", gmsh4(names, "1 1"), ["bar of steel", "volume 6"], [7, 9]),
        ("d.msh", gmsh4("", "1 4"), ["4", "volume 6"], [7, 9]),
        (
            "e.bdf",
            format!("BEGIN BULK\n{bulk}CTETRA,7,20,1,2,3,4\nCTETRA,9,3,1,3,2,5\nENDDATA\n"),
            ["20", "3"],
            [7, 9],
        ),
        (
            "f.inp",
            format!(
                "*NODE\n{deck}*ELEMENT, TYPE=C3D4, ELSET=Core\n7,1,2,3,4\n*ELEMENT, TYPE=C3D4\n9,1,3,2,5\n"
            ),
            ["CORE", ""],
            [7, 9],
        ),
        ("g.inp", abaqus_parts, ["BAR-1.CORE", "BAR-1"], [7, 9]),
        (
            "h.mesh",
            format!(
                "MeshVersionFormatted 2\nDimension 3\nVertices\n5\n{vertices}Tetrahedra\n2\n\
                 1 2 3 4 2\n1 3 2 5 -1\nEnd\n"
            ),
            ["2", "-1"],
            [1, 2],
        ),
        (
            "i.k",
            format!(
                "*KEYWORD\n*NODE\n{keyword}*ELEMENT_SOLID\n7,31,1,2,3,4,4,4,4,4\n9,30,1,3,2,5,5,5,5,5\n*END\n"
            ),
            ["31", "30"],
            [7, 9],
        ),
        (
            "j.vol",
            format!(
                "mesh3d\ndimension\n3\ngeomtype\n0\nsurfaceelements\n0\nvolumeelements\n2\n\
                 1 4 1 2 3 4\n2 4 1 3 2 5\npoints\n5\n{points}endmesh\n"
            ),
            ["1", "2"],
            [1, 2],
        ),
    ];
    for (file, text, names, numbers) in rows {
        let summary = scored(file, &text);
        let found: BTreeMap<_, _> =
            regions(&summary).into_iter().map(|(name, n, e)| (name, (n, e))).collect();
        let name = |name: &'static str| if name.is_empty() { None } else { Some(name) };
        let expected = names.into_iter().map(name).zip(numbers.map(|number| (1, number)));
        assert_eq!(found, expected.collect(), "{file}");
        assert!(summary.regions.expect("asked for").of.is_some(), "{file}");
    }
}

#[test]
fn regions_stand_in_the_order_of_their_names_and_none_comes_last() {
    let summary = scored("a.msh", &gmsh2([10, 9], ""));
    assert_eq!(regions(&summary), [(Some("9"), 1, 9), (Some("10"), 1, 7)]);
    let summary = scored("a.msh", &gmsh2([0, 9], ""));
    assert_eq!(regions(&summary), [(Some("9"), 1, 9), (None, 1, 7)]);
}

#[test]
fn one_region_too_many_is_an_error() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.msh");
    std::fs::write(&path, gmsh2([1, 2], "")).expect("written");
    let error = score(&path, &Options { most_regions: 1, ..options() }).expect_err("two regions");
    assert!(error.to_string().contains("number of regions (limits.regions)"), "{error}");
    assert!(score(&path, &Options { most_regions: 1, by_region: false, ..options() }).is_ok());
}

#[test]
fn a_format_without_regions_says_so() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes/off/gmsh_pit_block.off");
    let summary = score(&path, &options()).unwrap_or_else(|e| panic!("{e}"));
    let regions = summary.regions.expect("they were asked for");
    assert_eq!((regions.of, regions.list.len()), (None, 0));
}

/// Meshes of several shapes and pieces, some with regions.
fn meshes() -> Vec<PathBuf> {
    let names = [
        "examples/drop/pit-specimen.inp",
        "examples/drop/pit-specimen-fine.msh.zst",
        "examples/drop/cylinder-hex.vtu",
        "tests/meshes/gmsh/mixed_hex_prism_41.msh",
        "tests/meshes/gmsh/pit2d_41_bin.msh",
    ];
    names.map(|name| Path::new(env!("CARGO_MANIFEST_DIR")).join(name)).to_vec()
}

#[test]
fn regions_and_worst_elements_do_not_depend_on_threads_and_change_nothing_else() {
    for path in meshes() {
        let run = |options: &Options| score(&path, options).unwrap_or_else(|e| panic!("{e}"));
        let first = run(&Options { threads: 1, worst: 20, ..options() });
        for threads in [2, 3, 7] {
            let again = run(&Options { threads, memory: 0, worst: 20, ..options() });
            assert_eq!(again.to_json(), first.to_json(), "{}", path.display());
        }
        let plain = run(&Options { threads: 1, run_info: false, ..Options::default() });
        let mut bare = first.clone();
        bare.regions = None;
        bare.shapes.values_mut().flat_map(|s| s.measures.values_mut()).for_each(|m| m.worst.clear());
        assert_eq!(bare.to_json(), plain.to_json(), "{}", path.display());
    }
}

#[test]
fn regions_add_up_to_the_whole_mesh() {
    for path in meshes() {
        let summary = score(&path, &options()).unwrap_or_else(|e| panic!("{e}"));
        let list = &summary.regions.as_ref().expect("asked for").list;
        for (shape, whole) in summary.shapes.iter().filter(|_| !list.is_empty()) {
            let parts: Vec<_> = list.iter().filter_map(|region| region.shapes.get(shape)).collect();
            assert_eq!(parts.iter().map(|part| part.count).sum::<u64>(), whole.count);
            assert_eq!(parts.iter().map(|part| part.inverted).sum::<u64>(), whole.inverted);
            for (code, measure) in &whole.measures {
                let parts: Vec<_> = parts.iter().map(|part| &part.measures[code]).collect();
                let count = parts.iter().map(|part| part.count).sum::<u64>();
                let least = parts.iter().map(|part| part.min).fold(f64::INFINITY, f64::min);
                let total = parts.iter().map(|part| part.mean * part.count as f64).sum::<f64>();
                assert_eq!((count, least), (measure.count, measure.min), "{}: {code}", path.display());
                assert!((total / count as f64 - measure.mean).abs() < 1e-12, "{}: {code}", path.display());
            }
        }
    }
}

#[test]
fn the_worst_elements_begin_with_the_minimum_and_have_place_and_nodes() {
    for path in meshes() {
        let summary = score(&path, &Options { worst: 50, ..options() }).unwrap_or_else(|e| panic!("{e}"));
        for (shape, found) in &summary.shapes {
            for measure in found.measures.values() {
                let worst = &measure.worst;
                assert_eq!(worst.len() as u64, found.count.min(50));
                assert_eq!((worst[0].element, worst[0].value), (measure.min_element, measure.min));
                assert!(worst.windows(2).all(|pair| pair[0].value <= pair[1].value));
                assert!(worst.iter().all(|element| element.nodes.len() == shape.corners()));
                let bounds = summary.nodes.bounds.expect("there are nodes");
                let inside = |axis: usize, x: f64| (bounds.min[axis]..=bounds.max[axis]).contains(&x);
                assert!(worst.iter().all(|e| (0..3).all(|axis| inside(axis, e.centroid[axis]))));
            }
        }
    }
    let summary = scored("a.msh", &gmsh2([1, 1], ""));
    let worst = &summary.shapes[&Shape::Tetrahedron].measures["M31"].worst;
    assert_eq!((worst[0].element, &worst[0].nodes[..]), (9, &[1, 3, 2, 5][..]));
    assert_eq!((worst[0].centroid, worst[0].region.as_deref()), ([0.25, 0.25, -0.75], Some("1")));
    assert_eq!((worst.len(), worst[1].element), (2, 7));
}

/// Name, number of elements and smallest M31 of each region.
type Found = &'static [(Option<&'static str>, u64, u64)];

/// Elements whose keyword names no set are in that of their section, or in the first list that holds them.
#[test]
fn element_sets_of_abaqus_are_those_of_sections_or_else_of_lists() {
    let deck = lines(|id, [x, y, z]| format!("{id}, {x}, {y}, {z}\n"));
    let elements = "*ELEMENT, TYPE=C3D4\n7, 1, 2, 3, 4\n9, 1, 3, 2, 5\n";
    let copies =
        "*ELSET, ELSET=Old\n9\n*ELCOPY, OLD SET=Old, ELEMENT SHIFT=10, SHIFT NODES=0, NEW SET=Copy\n";
    let rows: [(&str, String, Found); 5] = [
        (
            "lists",
            format!(
                "*NODE\n{deck}{elements}*ELSET, ELSET=A\n9\n*ELSET, ELSET=B, GENERATE\n1, 8\n*ELSET, ELSET=C\nA, B\n"
            ),
            &[(Some("A"), 1, 9), (Some("B"), 1, 7)],
        ),
        (
            "sections",
            format!(
                "*NODE\n{deck}{elements}*ELSET, ELSET=A\n9\n*ELSET, ELSET=B, GENERATE\n7, 9, 2\n*SOLID SECTION, ELSET=B, MATERIAL=M\n"
            ),
            &[(Some("B"), 2, 9)],
        ),
        (
            "a part",
            format!(
                "*PART, NAME=P\n*NODE\n{deck}{elements}*ELSET, ELSET=A\n9\n*SOLID SECTION, ELSET=A\n*END PART\n*ASSEMBLY, NAME=A\n\
                 *INSTANCE, NAME=I, PART=P\n*END INSTANCE\n*END ASSEMBLY\n"
            ),
            &[(Some("I"), 1, 7), (Some("I.A"), 1, 9)],
        ),
        (
            "copies",
            format!("*NODE\n{deck}{elements}{copies}"),
            &[(Some("COPY"), 1, 19), (Some("OLD"), 1, 9), (None, 1, 7)],
        ),
        (
            "rows",
            format!("*NODE\n{deck}{elements}*ELGEN, ELSET=Row\n7, 2, 0, 50\n"),
            &[(Some("ROW"), 1, 57), (None, 2, 9)],
        ),
    ];
    for (what, text, expected) in rows {
        let summary = scored("a.inp", &text);
        assert_eq!(regions(&summary), expected, "{what}");
    }
}
