//! Measures in rescaled axes and in cylindrical coordinates: the report's two caveats.

#![allow(clippy::unwrap_used)]

use std::f64::consts::PI;

use meshgauge::generate::{self, Encoding};
use meshgauge::mesh::{Frame, Shape};
use meshgauge::{Options, Summary};

fn score(model: &str, settings: &[&str], system: &str, stretch: [f64; 3]) -> Summary {
    let problem = generate::model(model).unwrap().problem(settings.iter().copied()).unwrap();
    let mut file = Vec::new();
    generate::writer("gmsh").unwrap().write(&problem, Encoding::Default, &mut file).unwrap();
    let frame = Frame { system: system.parse().unwrap(), stretch };
    let options = Options { frame, run_info: false, threads: 2, ..Options::default() };
    meshgauge::score_reader("mesh", file.as_slice(), &options).unwrap()
}

fn range(summary: &Summary, shape: Shape, code: &str) -> [f64; 2] {
    let measure = &summary.shapes[&shape].measures[code];
    [measure.min, measure.max]
}

fn are_near(found: [f64; 2], expected: f64) -> bool {
    found.iter().all(|value| (value - expected).abs() < 1e-9)
}

#[test]
fn fd1_is_poor_in_x_y_z_and_perfect_in_r_theta_z() {
    let plain = score("fd-cylinder", &[], "cartesian", [1.0; 3]);
    assert!(plain.frame.is_none(), "the file's own coordinates are not told");
    assert!(range(&plain, Shape::Hexahedron, "M22")[0] < 0.12);
    assert!(range(&plain, Shape::Wedge, "M15")[1] < 0.16);

    // Steps of 0.5 along r and z, of 10 degrees round the axis.
    let polar = score("fd-cylinder", &[], "cylindrical", [1.0; 3]);
    assert!(are_near(range(&polar, Shape::Hexahedron, "M21"), 1.0));
    assert!(are_near(range(&polar, Shape::Hexahedron, "M23"), 1.0));
    let step = PI / 18.0;
    assert!((range(&polar, Shape::Hexahedron, "M22")[0] - step / 0.5).abs() < 1e-9);
    assert!((range(&polar, Shape::Hexahedron, "M22")[1] - 1.0).abs() < 1e-9);

    // With angles weighed such that a step is as long as the others every hexahedron is a cube.
    let weighed = score("fd-cylinder", &[], "cylindrical:z", [1.0, 0.5 / step, 1.0]);
    for code in ["M21", "M22", "M23"] {
        assert!(are_near(range(&weighed, Shape::Hexahedron, code), 1.0), "{code}");
    }
    // The wedges at the axis are half a square; each is like any other, across the cut of the angle too.
    let frame = weighed.frame.unwrap();
    assert_eq!((frame.system.to_string(), frame.enclosing_axis), ("cylindrical:z".into(), 0));
    for code in ["M11", "M12", "M13", "M14", "M15"] {
        let [min, max] = range(&weighed, Shape::Wedge, code);
        assert!(max - min < 1e-9 && min > range(&plain, Shape::Wedge, code)[1], "{code}: {min} to {max}");
    }
    // A square's half with its height on the middle of the base: sides 1, sqrt(5)/2, sqrt(5)/2.
    let [m13, _] = range(&weighed, Shape::Wedge, "M13");
    assert!((m13 - 4.0 * 3.0_f64.sqrt() * 0.5 / 3.5).abs() < 1e-9, "{m13}");
}

#[test]
fn all_but_the_measures_is_of_the_files_own_coordinates() {
    let plain = score("fd-cylinder", &[], "cartesian", [1.0; 3]);
    let polar = score("fd-cylinder", &[], "cylindrical", [3.0, 2.0, 1.0]);
    assert_eq!((&plain.totals, &plain.sizes, &plain.checks), (&polar.totals, &polar.sizes, &polar.checks));
    assert_eq!(plain.nodes, polar.nodes);
}

#[test]
fn stretched_axes_are_those_of_the_body_that_was_stretched() {
    for elements in ["elements=hexahedra", "elements=tetrahedra", "elements=wedges"] {
        let settings = [elements, "divisions=6", "layers=4", "height=4"];
        let stretched = score("swept-cylinder", &settings, "cartesian", [1.0, 1.0, 4.0]);
        let settings = [elements, "divisions=6", "layers=4", "height=16"];
        let longer = score("swept-cylinder", &settings, "cartesian", [1.0; 3]);
        for (shape, found) in &stretched.shapes {
            assert_eq!(found.measures, longer.shapes[shape].measures);
        }
    }
}

#[test]
fn elements_that_enclose_the_axis_are_counted() {
    // The square core of an odd number of divisions has the axis in its middle, in every layer.
    let through = score("swept-cylinder", &["divisions=5", "layers=3"], "cylindrical", [1.0; 3]);
    assert_eq!(through.frame.unwrap().enclosing_axis, 3);
    let beside = score("swept-cylinder", &["divisions=4", "layers=3"], "cylindrical", [1.0; 3]);
    assert_eq!(beside.frame.unwrap().enclosing_axis, 0);
    let outside = score("swept-cylinder", &["divisions=5", "layers=3"], "cylindrical:z@100,0,0", [1.0; 3]);
    assert_eq!(outside.frame.unwrap().enclosing_axis, 0);
}
