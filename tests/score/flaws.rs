//! Small meshes with one flaw each: the check that counts it, and what the verdict makes of it.

use meshgauge::mesh::Shape::{self, Hexahedron, Quadrilateral, Tetrahedron, Triangle};
use meshgauge::summary::{Checks, Status};
use meshgauge::{Summary, score_reader};

use crate::options;

/// The corners of the unit cube, 1 to 4 below and 5 to 8 above, and a node 9 over it.
const CUBE: &str = "*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 1., 1., 0.\n4, 0., 1., 0.\n\
                    5, 0., 0., 1.\n6, 1., 0., 1.\n7, 1., 1., 1.\n8, 0., 1., 1.\n9, 0.5, 0.5, 2.\n";
/// The unit square in a plane, cut at its middle, node 5.
const SQUARE: &str = "*NODE\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n5, 0.5, 0.5\n";

#[track_caller]
fn scored(nodes: &str, elements: &str) -> Summary {
    let text = format!("{nodes}*ELEMENT, TYPE={elements}\n");
    score_reader("flaw.inp", text.as_bytes(), &options()).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn rules(summary: &Summary) -> Vec<(&str, Option<Shape>)> {
    summary.verdict.reasons.iter().map(|reason| (&*reason.rule, reason.shape)).collect()
}

/// Checks that are not 0.
fn checks(set: impl Fn(&mut Checks)) -> Checks {
    let mut checks = Checks::default();
    set(&mut checks);
    checks
}

#[test]
fn a_sound_mesh_passes() {
    let found = scored(SQUARE, "CPS3\n1, 1, 2, 5\n2, 2, 3, 5\n3, 3, 4, 5\n4, 4, 1, 5");
    assert_eq!((found.verdict.status, found.checks), (Status::Pass, Checks::default()));
    assert_eq!((found.totals.area, found.totals.volume), (Some(1.0), None));
}

#[test]
fn a_flipped_triangle_of_a_plane_is_inverted() {
    let found = scored(SQUARE, "CPS3\n1, 1, 2, 5\n2, 2, 3, 5\n13, 4, 3, 5\n4, 4, 1, 5");
    assert_eq!(found.checks, checks(|c| c.inverted = 1));
    assert_eq!(found.shapes[&Triangle].inverted, 1);
    assert_eq!(found.verdict.status, Status::Fail);
    assert_eq!(rules(&found), [("inverted elements", Some(Triangle))]);
    assert_eq!(found.verdict.reasons[0].element, Some(13), "the first of them is named");
    assert_eq!(found.totals.area, Some(1.0), "areas count as magnitudes");
}

#[test]
fn a_mesh_that_is_left_handed_as_a_whole_is_reversed_and_not_inverted() {
    // The six tetrahedra round the diagonal of the cube, each turned inside out.
    let six =
        "C3D4\n1, 1, 3, 2, 7\n2, 1, 4, 3, 7\n3, 1, 8, 4, 7\n4, 1, 5, 8, 7\n5, 1, 6, 5, 7\n6, 1, 2, 6, 7";
    let found = scored(&CUBE.replace("9, 0.5, 0.5, 2.\n", ""), six);
    assert_eq!(found.checks, checks(|c| c.reversed = 6));
    assert_eq!(found.shapes[&Tetrahedron].inverted, 0);
    assert!((found.totals.volume.expect("a volume") - 1.0).abs() < 1e-15);
    assert_eq!(found.verdict.status, Status::Pass, "{:?}", rules(&found));
    // One against the other five.
    let found =
        scored(&CUBE.replace("9, 0.5, 0.5, 2.\n", ""), &six.replace("6, 1, 2, 6, 7", "6, 1, 6, 2, 7"));
    assert_eq!((found.checks.inverted, found.checks.reversed), (1, 5));
    assert_eq!(found.verdict.reasons[0].element, Some(6));
}

#[test]
fn shells_in_space_have_no_sign() {
    let found = scored(CUBE, "S4\n1, 1, 2, 3, 4\n2, 5, 6, 7, 8\n3, 1, 5, 6, 2");
    assert_eq!((found.checks.inverted, found.checks.reversed), (0, 0));
}

#[test]
fn elements_without_extent_are_degenerate() {
    let rows = [
        (SQUARE, "CPS3\n7, 1, 5, 3\n8, 1, 2, 5", Triangle, 7),
        (SQUARE, "CPS4\n7, 1, 2, 3, 4\n8, 1, 1, 3, 3", Quadrilateral, 8),
        (CUBE, "C3D4\n7, 1, 2, 3, 4\n8, 1, 2, 3, 7", Tetrahedron, 7),
        (CUBE, "C3D8\n7, 1, 2, 3, 4, 1, 2, 3, 4\n8, 1, 2, 3, 4, 5, 6, 7, 8", Hexahedron, 7),
    ];
    for (nodes, elements, shape, element) in rows {
        let found = scored(nodes, elements);
        assert_eq!((found.checks.degenerate, found.shapes[&shape].degenerate), (1, 1), "{elements}");
        assert_eq!((found.checks.inverted, found.checks.reversed), (0, 0), "{elements}");
        assert_eq!(found.verdict.status, Status::Fail, "{elements}");
        let reason = &found.verdict.reasons[0];
        assert_eq!((&*reason.rule, reason.element), ("degenerate elements", Some(element)), "{elements}");
        for (code, measure) in &found.shapes[&shape].measures {
            assert!((0.0..=1.0).contains(&measure.min) && measure.min <= measure.mean, "{elements}: {code}");
        }
    }
}

#[test]
fn nodes_that_coincide_without_being_one_are_degenerate_too() {
    let nodes = SQUARE.replace("5, 0.5, 0.5", "5, 1., 1.");
    let found = scored(&nodes, "CPS4\n1, 1, 2, 3, 4\n2, 1, 2, 3, 5");
    assert_eq!((found.checks.degenerate, found.checks.repeated_nodes), (1, 0));
}

#[test]
fn a_corner_that_is_named_twice_is_counted() {
    // A brick that was collapsed to a wedge, as some meshers write them.
    let found = scored(CUBE, "C3D8\n1, 1, 2, 3, 4, 5, 6, 7, 8\n2, 1, 2, 3, 3, 5, 6, 7, 7");
    assert_eq!((found.checks.repeated_nodes, found.checks.degenerate, found.checks.unused_nodes), (1, 1, 1));
    assert_eq!(found.verdict.status, Status::Fail);
}

#[test]
fn concave_and_crossed_quadrilaterals_are_told_apart() {
    let convex = scored(SQUARE, "CPS4\n1, 1, 2, 3, 4");
    assert_eq!((convex.checks.concave_faces, convex.checks.crossed_faces), (0, 0));
    let nodes = SQUARE.replace("5, 0.5, 0.5", "5, 0.75, 0.75");
    let concave = scored(&nodes, "CPS4\n1, 2, 3, 4, 5");
    assert_eq!((concave.checks.concave_faces, concave.checks.crossed_faces), (1, 0));
    let crossed = scored(SQUARE, "CPS4\n1, 1, 3, 2, 4");
    assert_eq!((crossed.checks.concave_faces, crossed.checks.crossed_faces), (0, 1));
    // A brick whose upper face is a bow-tie: four faces more are crossed or not, but that one is.
    let brick = scored(CUBE, "C3D8\n1, 1, 2, 3, 4, 5, 7, 6, 8");
    assert!(brick.checks.crossed_faces >= 1, "{:?}", brick.checks);
}

#[test]
fn nodes_of_no_element_are_counted_and_do_not_fail_a_mesh() {
    let found = scored(&format!("{SQUARE}8, 7., 7.\n"), "CPS4\n1, 1, 2, 3, 4");
    assert_eq!((found.nodes.count, found.nodes.unused), (6, 2));
    assert_eq!(found.checks, checks(|c| c.unused_nodes = 2));
    assert_eq!(found.verdict.status, Status::Pass);
    assert_eq!(found.nodes.bounds.expect("bounds").max, [7.0, 7.0, 0.0]);
}

#[test]
fn boundaries_stay_out_of_totals_and_verdict() {
    // The skin has a triangle without area and a needle.
    let nodes = format!("{CUBE}10, 1e-6, 0., 0.\n");
    let solid = scored(&nodes, "C3D8\n1, 1, 2, 3, 4, 5, 6, 7, 8");
    let skin = "C3D8\n1, 1, 2, 3, 4, 5, 6, 7, 8\n*ELEMENT, TYPE=S3\n2, 1, 10, 2\n3, 1, 10, 3\n*ELEMENT, TYPE=B31\n4, 1, 2";
    let found = scored(&nodes, skin);
    assert_eq!((found.totals, &found.verdict, &found.sizes), (solid.totals, &solid.verdict, &solid.sizes));
    assert_eq!(
        (found.verdict.status, found.totals.volume, found.totals.area),
        (Status::Pass, Some(1.0), None)
    );
    assert_eq!(found.elements.count, 4);
    assert_eq!(found.elements.not_measured.values().sum::<u64>(), 1);
    let triangles = &found.shapes[&Triangle];
    assert_eq!((triangles.count, triangles.degenerate), (2, 1), "they are measured all the same");
    assert!(triangles.measures["M11"].min < 0.1);
}

#[test]
fn second_order_is_counted_and_measured_by_corners() {
    let middles: String = (10..16).map(|n| format!("{n}, {n}., 0., 0.\n")).collect();
    let nodes = format!("{CUBE}{middles}");
    let found =
        scored(&nodes, "C3D10\n1, 1, 2, 4, 5, 10, 11, 12, 13, 14, 15\n*ELEMENT, TYPE=C3D4\n2, 1, 2, 4, 5");
    let order: Vec<_> = found.shapes[&Tetrahedron].order.iter().map(|(k, n)| (k.as_str(), *n)).collect();
    assert_eq!(order, [("1", 1), ("2", 1)]);
    let measure = &found.shapes[&Tetrahedron].measures["M31"];
    assert_eq!((measure.count, measure.min), (2, measure.max));
    assert_eq!(found.checks.unused_nodes, 5, "middle nodes are used");
}

#[test]
fn a_mesh_of_lines_alone_is_a_warning() {
    let found = scored(CUBE, "B31\n1, 1, 2\n2, 2, 3");
    assert!(found.shapes.is_empty());
    assert_eq!((found.verdict.status, rules(&found)), (Status::Warn, vec![("nothing measured", None)]));
    assert_eq!((found.totals.area, found.totals.volume), (None, None));
}

#[test]
fn a_needle_is_a_warning_that_names_measure_and_element() {
    let nodes = SQUARE.replace("5, 0.5, 0.5", "5, 0.5, 0.001");
    let found = scored(&nodes, "CPS3\n1, 1, 2, 5\n2, 2, 3, 5\n3, 3, 4, 5\n4, 4, 1, 5");
    assert_eq!(found.verdict.status, Status::Warn);
    let needle = |r: &&meshgauge::summary::Reason| r.rule == "npl" && r.element == Some(1) && r.value < 0.1;
    assert_eq!(found.verdict.reasons.iter().filter(needle).count(), found.verdict.reasons.len());
}

/// Sums round: the mean of equal values need not be that value.
#[test]
fn what_does_not_vary_has_its_own_mean_and_no_spread() {
    for count in [3, 5, 6, 7, 11, 12, 13, 49] {
        let mut nodes = String::from("*NODE\n");
        let mut elements = String::from("CPS3");
        for k in 0..count {
            let (x, n) = (f64::from(k), 3 * k);
            nodes.push_str(&format!("{}, {x}, 0.\n{}, {}, 0.\n{}, {x}, 1.\n", n + 1, n + 2, x + 1.0, n + 3));
            elements.push_str(&format!("\n{}, {}, {}, {}", k + 1, n + 1, n + 2, n + 3));
        }
        let found = scored(&nodes, &elements);
        let triangles = &found.shapes[&Triangle];
        for (code, measure) in &triangles.measures {
            assert_eq!(
                (measure.mean, measure.max, measure.sd),
                (measure.min, measure.min, 0.0),
                "{count} {code}"
            );
        }
        assert!(triangles.correlation.values().all(Option::is_none), "{:?}", triangles.correlation);
        let size = found.sizes.element_size.expect("sizes");
        assert_eq!((size.mean, size.max), (size.min, size.min), "{count}");
    }
}
