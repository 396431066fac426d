//! Decks that others wrote, against counts that others made.

use super::*;

#[test]
fn corpus_decks_have_the_counts_of_the_manifest() {
    let Some(corpus) = corpus() else { return };
    let rows: [(&str, u64, &str, u64); 15] = [
        ("autodesk_aa8lzviq9.nas", 1950, "CTETRA:810", 810),
        ("cp_cord_panel108.bdf", 48, "CQUAD4:35", 0),
        ("cp_cylindrical_a101x.dat", 59, "CQUAD4:42 CTRIA3:1 RBE3:2", 0),
        (
            "elements_first_cquadr_cqrcc128a.bdf",
            54,
            "CHEXA:1 CPENTA:1 CQUAD8:2 CQUADR:2 CTETRA:1 CTRIA6:1 CTRIAR:2",
            3,
        ),
        ("elements_first_tet10.bdf", 14, "CTETRA:2", 2),
        ("freefield_axisym.bdf", 17, "CONM2:1 CQUAD4:2 CQUADX:2 CQUADX8:1 CTRIAX:1 CTRIAX6:1", 3),
        ("freefield_ctetra10.bdf", 10, "CTETRA:1", 1),
        ("gmsh_box_o2_small.bdf", 2070, "CTETRA:1093", 1093),
        ("gmsh_mixed_free.bdf", 54, "CHEXA:8 CPENTA:28 CQUAD4:36 CTRIA3:28", 0),
        ("gmsh_mixed_large.bdf", 54, "CHEXA:8 CPENTA:28 CQUAD4:36 CTRIA3:28", 0),
        ("hex_penta_ac10901a.bdf", 60, "CELAS2:10 CHEXA:12 CPENTA:8 CQUAD4:3 CTRIA3:2", 0),
        ("longfield_expo_sol401.dat", 9, "CQUAD4:4", 0),
        ("longfield_ogs.bdf", 33, "CQUAD4:20", 0),
        (
            "mixed_cp_randvar2.bdf",
            147,
            "CBAR:3 CBEAM:1 CBEND:2 CDAMP1:1 CDAMP2:1 CELAS1:1 CELAS2:1 CHEXA:1 CMASS1:2 CMASS2:2 CONM1:2 CONM2:2 CONROD:2 \
             CPENTA:1 CQUAD4:3 CQUAD8:2 CQUADR:2 CROD:2 CSHEAR:1 CTETRA:1 CTRIA3:2 CTRIA6:1 CTRIAR:2 CTRIAX6:2 CVISC:2 GENEL:1 \
             RBAR:1 RBE1:1 RBE2:1 RBE3:2 RROD:1 RTRPLT:1",
            5,
        ),
        (
            "mixed_thermal_elements2.bdf",
            40,
            "CBAR:1 CBEAM:1 CDAMP1:4 CDAMP2:1 CDAMP3:1 CDAMP4:1 CELAS1:4 CELAS2:2 CELAS3:1 CELAS4:1 CHEXA:1 CONM2:2 CONROD:1 \
             CPENTA:2 CQUAD4:2 CQUAD8:1 CROD:2 CSHEAR:1 CTETRA:2 CTRIA3:4 CTRIA6:1 CTUBE:1 CVISC:2 PLOTEL:1",
            2,
        ),
    ];
    for (name, nodes, counts, second) in rows {
        let mesh =
            read(&Nastran, &corpus.join("nastran").join(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!((mesh.nodes.count(), types(&mesh).as_str()), (nodes, counts), "{name}");
        assert_eq!(of_order(&mesh, 2), second, "{name}");
    }
}

#[test]
fn an_include_that_is_not_there_is_an_error() {
    let Some(corpus) = corpus() else { return };
    let path = corpus.join("nastran/include_mode_solid_shell_bar.bdf");
    let error = read(&Nastran, &path).expect_err("no file").to_string();
    assert!(error.contains("line 27: included file \"geom.inc\": No such file"), "{error}");
}

#[test]
fn each_file_of_the_corpus_is_detected_as_what_it_is() {
    let Some(corpus) = corpus() else { return };
    let mut seen = 0;
    for folder in std::fs::read_dir(&corpus).expect("the corpus").map(|f| f.expect("an entry").path()) {
        let is_ours = folder.file_name().is_some_and(|name| name == "nastran");
        for entry in std::fs::read_dir(&folder).into_iter().flatten() {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                continue;
            }
            let head = head(&path);
            assert_eq!(Nastran.detect(&head), is_ours, "{}", path.display());
            let first = FORMATS.iter().find(|format| format.detect(&head));
            assert!(!is_ours || first.is_some_and(|format| format.name() == "nastran"), "{}", path.display());
            seen += u32::from(is_ours);
        }
    }
    assert_eq!(seen, 16);
}

#[test]
fn cylindrical_nodes_lie_where_their_angle_says() {
    let Some(corpus) = corpus() else { return };
    let mesh = read(&Nastran, &corpus.join("nastran/cp_cylindrical_a101x.dat")).expect("a deck");
    let angle = 35f64.to_radians();
    assert_near(node(&mesh, 10302), [1.25 * angle.cos(), 1.25 * angle.sin(), 0.0]);
}

#[test]
fn the_same_triangle_in_the_basic_and_in_a_chained_spherical_system() {
    let Some(corpus) = corpus() else { return };
    let mesh = read(&Nastran, &corpus.join("nastran/mixed_cp_randvar2.bdf")).expect("a deck");
    let sides = |nodes: [u64; 3]| {
        let p = nodes.map(|id| node(&mesh, id));
        [(0, 1), (1, 2), (2, 0)]
            .map(|(i, j): (usize, usize)| (0..3).map(|k| (p[i][k] - p[j][k]).powi(2)).sum::<f64>())
    };
    let (plain, chained) = (sides([7051, 7052, 7053]), sides([7060, 7061, 7062]));
    for k in 0..3 {
        assert!((plain[k] - chained[k]).abs() < 1e-4, "{plain:?} {chained:?}");
    }
}

#[test]
fn the_bricks_of_one_deck_are_all_left_handed_and_its_wedges_are_not() {
    let Some(corpus) = corpus() else { return };
    let mesh = read(&Nastran, &corpus.join("nastran/hex_penta_ac10901a.bdf")).expect("a deck");
    for (label, shape, corners) in &mesh.elements {
        match shape {
            Hexahedron => assert!(at_first_corner(*shape, corners) < 0.0, "{label}"),
            Wedge => assert!(at_first_corner(*shape, corners) > 0.0, "{label}"),
            _ => {}
        }
    }
    assert_eq!((mesh.count(Hexahedron), mesh.count(Wedge)), (12, 8));
}

#[test]
fn decks_that_gmsh_wrote() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes/nastran");
    let free = read(&Nastran, &folder.join("gmsh_mixed_free.bdf")).expect("a deck");
    let large = read(&Nastran, &folder.join("gmsh_mixed_large.bdf")).expect("a deck");
    for mesh in [&free, &large] {
        assert_eq!((mesh.nodes.count(), mesh.nodes.unused()), (54, 0));
        let shapes = [Hexahedron, Wedge, Quadrilateral, Triangle].map(|shape| mesh.count(shape));
        assert_eq!(shapes, [8, 28, 36, 28]);
        assert_eq!((mesh.nodes.bounds().min, mesh.nodes.bounds().max), ([0.0; 3], [2.0, 1.0, 1.0]));
        for (label, shape, corners) in mesh.elements.iter().filter(|e| e.1.dimension() == 3) {
            assert!(at_first_corner(*shape, corners) > 0.0, "{label}");
        }
    }
    for (a, b) in free.elements.iter().zip(&large.elements) {
        assert_eq!((a.0, a.1), (b.0, b.1));
        for (p, q) in a.2.iter().zip(&b.2) {
            assert!((0..3).all(|k| (p[k] - q[k]).abs() < 1e-6), "{p:?} {q:?}");
        }
    }
}
