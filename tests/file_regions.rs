//! Which regions the files of many writers divide their elements into.

use std::path::Path;

use meshgauge::{Options, Summary, score};

fn scored(path: &Path) -> Summary {
    let options = Options { threads: 2, run_info: false, by_region: true, ..Options::default() };
    score(path, &options).unwrap_or_else(|e| panic!("{e}"))
}

/// As `steel: 3 tetrahedron, 2 triangle; -: 1 wedge`; a dash is no region.
fn regions(path: &Path) -> String {
    let regions = scored(path).regions.expect("they were asked for");
    let rows = regions.list.iter().map(|region| {
        let shapes = region.shapes.iter().map(|(shape, found)| format!("{} {}", found.count, shape.name()));
        format!("{}: {}", region.name.as_deref().unwrap_or("-"), shapes.collect::<Vec<_>>().join(", "))
    });
    rows.collect::<Vec<_>>().join("; ")
}

/// Of many regions the last ones are held against the rows.
#[track_caller]
fn check(folder: &Path, rows: &[(&str, &str)]) {
    let found = rows.iter().map(|(file, expected)| (file, regions(&folder.join(file)), expected));
    let wrong: Vec<_> = found.filter(|(_, found, expected)| !found.ends_with(*expected)).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn own_files_are_divided_as_their_writers_say() {
    check(
        &Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes"),
        &[
            ("su2/gmsh_mixed.su2", "skin: 28 triangle, 36 quadrilateral; -: 28 wedge, 8 hexahedron"),
            (
                "comsol/mixed.mphtxt",
                "boundary 2: 28 triangle, 36 quadrilateral; domain 1: 28 wedge, 8 hexahedron",
            ),
            (
                "comsol/mixed.mphbin",
                "boundary 2: 28 triangle, 36 quadrilateral; domain 1: 28 wedge, 8 hexahedron",
            ),
            ("exodus/meshio_mixed.e", "0: 36 quadrilateral; 1: 28 triangle; 2: 8 hexahedron; 3: 28 wedge"),
            ("exodus/mixed_cdf1.e", "20: 14 triangle; 21: 8 hexahedron; 22: 28 wedge"),
            (
                "exodus/mixed_netcdf4.e",
                "10: 36 quadrilateral; 11: 28 triangle; 12: 8 hexahedron; 13: 28 wedge",
            ),
            ("med/gmsh_mixed.med", "F_2D_51: 14 triangle; F_3D_1: 8 hexahedron; F_3D_2: 28 wedge"),
            ("med/meshio_mixed.med", "-: 28 triangle, 36 quadrilateral, 28 wedge, 8 hexahedron"),
            ("cgns/gmsh_mixed.cgns", "4_S_46: 4 quadrilateral; 7_V_2: 28 wedge; 8_V_1: 8 hexahedron"),
            (
                "cgns/mixed_sections.cgns",
                "Surfaces: 28 triangle, 36 quadrilateral; Volumes: 28 wedge, 8 hexahedron",
            ),
            ("cgns/two_zones_ngon.cgns", "Block: 4 hexahedron"),
            ("vtu/blocks.vtm", "air: 2 hexahedron; skin: 1 triangle, 1 quadrilateral; steel: 4 hexahedron"),
            ("vtu/pieces.pvtu", "0: 4 hexahedron; 1: 4 hexahedron; -1: 2 hexahedron"),
            ("vtu/planes.vtr", "0: 2 hexahedron; 1: 2 hexahedron; -1: 2 hexahedron"),
            ("vtu/surface.vtp", "0: 1 quadrilateral; 1: 1 triangle"),
        ],
    );
}

#[test]
fn files_of_others_are_divided_as_their_writers_say() {
    let Some(corpus) = std::env::var_os("MESHGAUGE_CORPUS") else {
        eprintln!("skipped: MESHGAUGE_CORPUS names no folder");
        return;
    };
    check(
        Path::new(&corpus),
        &[
            (
                "comsol/busbar_with_selections.mphtxt",
                "domain 5: 32 tetrahedron; domain 6: 41 tetrahedron; domain 7: 31 tetrahedron",
            ),
            (
                "comsol/synthetic_busbar.mphbin",
                "domain 5: 32 tetrahedron; domain 6: 41 tetrahedron; domain 7: 31 tetrahedron",
            ),
            (
                "comsol/mesh_example_intro.mphtxt",
                "boundary 10: 1 triangle; domain 1: 4 tetrahedron, 1 wedge; domain 2: 1 tetrahedron, 1 wedge",
            ),
            (
                "exodus/dealii_four-sidesets.e",
                "1: 1 hexahedron; 10: 1 pyramid; 100: 1 tetrahedron; 1000: 1 wedge",
            ),
            ("exodus/mfem_cylinder-hex-q2.gen", "1: 144 hexahedron; 2: 108 hexahedron"),
            ("exodus/dealii_five-3d.e", "1: 4 quadrilateral; 10: 1 quadrilateral"),
            ("med/box_o2.med", "F_3D_1: 1093 tetrahedron"),
            ("med/pit2d.med", "F_2D_1: 382 triangle"),
            ("su2/pynastran_fea_fsi.su2", "-: 116 quadrilateral"),
        ],
    );
}
