//! Decks that others wrote, against counts that others made.

use super::*;

#[test]
fn corpus_decks_have_the_counts_of_the_manifest() {
    let Some(corpus) = corpus() else { return };
    let rows: [(_, _, _, &[(Shape, usize)]); 18] = [
        (
            "abaqus/cae_multi_instance_rivet.inp",
            808,
            "C3D8R:211 S4R:210",
            &[(Hexahedron, 211), (Quadrilateral, 210)],
        ),
        ("abaqus/ccx_artery1.inp", 13, "CAX8:1 D:3", &[(Quadrilateral, 1)]),
        ("abaqus/ccx_c3d15.inp.gz", 127, "C3D15:24", &[(Wedge, 24)]),
        ("abaqus/ccx_c3d6.inp", 16, "C3D6:6", &[(Wedge, 6)]),
        ("abaqus/ccx_distcoup.inp.gz", 262, "C3D20R:32 DCOUP3D:1", &[(Hexahedron, 32)]),
        ("abaqus/ccx_furnace.inp.gz", 613, "S6:300 D:5", &[(Triangle, 300)]),
        ("abaqus/ccx_rot4.inp", 21, "S8R:4", &[(Quadrilateral, 4)]),
        ("abaqus/ccx_scheibe.inp", 10, "CPE8R:1", &[(Quadrilateral, 1)]),
        ("abaqus/dealii_2d_test_abaqus.inp", 96, "CPS4R:75", &[(Quadrilateral, 75)]),
        ("abaqus/dealii_3d_CC_cubit_old.inp", 54, "C3D8R:16", &[(Hexahedron, 16)]),
        ("abaqus/dealii_3d_test_abaqus.inp", 576, "C3D8R:375", &[(Hexahedron, 375)]),
        ("abaqus/dealii_3d_test_cube_pave_1.inp", 39, "C3D8R:14", &[(Hexahedron, 14)]),
        ("abaqus/dealii_codim_1-tube.inp", 120, "S4R:96", &[(Quadrilateral, 96)]),
        ("abaqus/gmsh_pit2d_o2.inp", 821, "T3D3:56 CPS6:382", &[(Triangle, 382)]),
        ("abaqus/pynastran_chexa20.inp", 20, "C3D20:1", &[(Hexahedron, 1)]),
        ("abaqus/pynastran_system_nodes.inp", 702, "B31H:700", &[]),
        ("abaqus/pynastran_test_bracket.inp", 306, "C3D4:793", &[(Tetrahedron, 793)]),
        (
            "compressed/rivet_two_members.inp.gz",
            808,
            "C3D8R:211 S4R:210",
            &[(Hexahedron, 211), (Quadrilateral, 210)],
        ),
    ];
    for (name, nodes, counts, shapes) in rows {
        let path = corpus.join(name);
        assert!(Abaqus.detect(&head(&path)), "{name}");
        let mesh = read(&Abaqus, &path).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!((mesh.nodes.count(), types(&mesh).as_str()), (nodes, counts), "{name}");
        assert_eq!(mesh.elements.len(), shapes.iter().map(|s| s.1).sum::<usize>(), "{name}");
        for (shape, count) in shapes {
            assert_eq!(mesh.count(*shape), *count, "{name}");
        }
    }
}

#[test]
fn a_cylindrical_block_in_a_local_frame_lies_on_its_cylinder() {
    let Some(corpus) = corpus() else { return };
    let mesh = read(&Abaqus, &corpus.join("abaqus/pynastran_system_nodes.inp")).expect("a deck");
    // Node 241: radius 1724.06 about the axis of the frame, whose origin is (6414, 0, -678).
    let p = mesh.nodes.rows()[mesh.nodes.row(241).expect("node 241") as usize];
    let distance = ((p[0] - 6414.0).powi(2) + p[1].powi(2) + (p[2] + 678.0).powi(2)).sqrt();
    assert!((distance - 1724.0602494441f64.hypot(0.280338873236)).abs() < 1e-6, "{p:?}");
}

#[test]
fn the_torture_deck_is_assembled() {
    let Some(corpus) = corpus() else { return };
    let mesh = read(&Abaqus, &corpus.join("abaqus/synthetic_torture/main.inp")).expect("a deck");
    assert_eq!((mesh.nodes.count(), types(&mesh).as_str()), (20, "C3D8R:2 CPE4:1"));
    let (_, shape, corners) = &mesh.elements[1];
    assert_eq!(*shape, Hexahedron);
    // (1, 0, 0) shifted to (11, 0, 0), then turned by 90 degrees about z through (10, 0, 0).
    for (found, expected) in corners[1].iter().zip([10.0, 1.0, 0.0]) {
        assert!((found - expected).abs() < 1e-12, "{corners:?}");
    }
}

#[test]
fn other_formats_are_not_taken_for_abaqus() {
    let Some(corpus) = corpus() else { return };
    for folder in
        ["decoys", "lsdyna", "ansys_cdb", "nastran", "femgv_frd", "unv", "gmsh", "su2", "vtk", "obj"]
    {
        for entry in std::fs::read_dir(corpus.join(folder)).expect("a folder") {
            let path = entry.expect("an entry").path();
            assert!(path.is_dir() || !Abaqus.detect(&head(&path)), "{}", path.display());
        }
    }
}

#[test]
fn a_deck_that_gmsh_wrote() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes/abaqus/gmsh_pit2d_o2.inp");
    let mesh = read(&Abaqus, &path).expect("a deck");
    assert_eq!((mesh.nodes.count(), types(&mesh).as_str()), (821, "T3D3:56 CPS6:382"));
    assert!(mesh.nodes.is_planar());
    assert_eq!(mesh.nodes.unused(), 0);
    let area = |c: &[[f64; 3]]| {
        ((c[1][0] - c[0][0]) * (c[2][1] - c[0][1]) - (c[2][0] - c[0][0]) * (c[1][1] - c[0][1])) / 2.0
    };
    let areas: Vec<f64> = mesh.elements.iter().map(|(_, _, c)| area(c)).collect();
    // A plate of 10 by 4 with an elliptic notch.
    assert!(areas.iter().all(|a| *a > 0.0));
    let total: f64 = areas.iter().sum();
    assert!(total > 35.0 && total < 40.0, "{total}");
}
