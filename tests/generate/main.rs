//! The model problems: their meshes are sound, are the report's, and are written as they were walked.

#![allow(clippy::unwrap_used)]
#![expect(clippy::disallowed_methods, reason = "the tests' own small files")]

mod bodies;
mod files;
mod published;

use meshgauge::generate::{self, MODELS, MeshSource, Problem};
use meshgauge::mesh::Shape;

type Point = [f64; 3];

fn problem(model: &str, settings: &[&str]) -> Problem {
    generate::model(model).unwrap().problem(settings.iter().copied()).unwrap()
}

fn nodes(mesh: &dyn MeshSource) -> Vec<Point> {
    let mut nodes = Vec::new();
    mesh.each_node(&mut |point| {
        nodes.push(point);
        Ok(())
    })
    .unwrap();
    nodes
}

fn elements(mesh: &dyn MeshSource, shape: Shape) -> Vec<Vec<u64>> {
    let mut elements = Vec::new();
    mesh.each_element(shape, &mut |corners| {
        elements.push(corners.to_vec());
        Ok(())
    })
    .unwrap();
    elements
}

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The Jacobian at each corner of an element, in the sense of Abaqus and Gmsh.
fn corner_jacobians(shape: Shape, corners: &[Point]) -> Vec<f64> {
    let spokes: &[[usize; 3]] = match shape {
        Shape::Tetrahedron => &[[1, 2, 3]],
        Shape::Quadrilateral => &[[1, 3, 3], [2, 0, 0], [3, 1, 1], [0, 2, 2]],
        Shape::Wedge => &[[1, 2, 3], [2, 0, 4], [0, 1, 5], [5, 4, 0], [3, 5, 1], [4, 3, 2]],
        Shape::Hexahedron => {
            &[[1, 3, 4], [2, 0, 5], [3, 1, 6], [0, 2, 7], [7, 5, 0], [4, 6, 1], [5, 7, 2], [6, 4, 3]]
        }
        _ => panic!("no model problem makes a {shape}"),
    };
    let at = |(corner, ends): (usize, &[usize; 3])| {
        let [a, b, c] = ends.map(|end| minus(corners[end], corners[corner]));
        if shape.dimension() == 2 { cross(a, b)[2] } else { dot(cross(a, b), c) }
    };
    spokes.iter().enumerate().map(at).collect()
}

#[test]
fn every_model_has_the_nodes_and_elements_that_it_says_and_all_are_sound() {
    let cases = [
        problem("fd-cylinder", &[]),
        problem("fd-cylinder", &["strips=3", "rings=1", "layers=1"]),
        problem("fd-cylinder", &["strips=7", "rings=4", "layers=3", "radius=1e-6", "height=1e3"]),
        problem("mapped-disc", &[]),
        problem("mapped-disc", &["divisions=1", "radius=0.5"]),
        problem("swept-cylinder", &[]),
        problem("swept-cylinder", &["divisions=1", "layers=1", "radius=1e9"]),
        problem("swept-cylinder", &["elements=tetrahedra", "divisions=5", "layers=3"]),
        problem("swept-cylinder", &["elements=wedges", "divisions=1", "layers=1"]),
        problem("swept-cylinder", &["elements=wedges", "divisions=6"]),
        problem("pit-specimen", &[]),
        problem("pit-specimen", &["elements=hexahedra", "depth=0.1"]),
        problem("pit-specimen", &["diameter=32", "depth=0.1", "divisions=5"]),
        problem("pit-specimen", &["diameter=32", "elements=hexahedra", "divisions=1"]),
        problem("pit-specimen", &["width=0.666", "divisions=9"]),
        problem("pit-specimen", &["diameter=2", "length=0.8", "depth=0.16", "elements=hexahedra"]),
        problem("pit-specimen", &["diameter=2", "length=0.1", "depth=0.02", "width=0.01"]),
        problem("pit-specimen", &["diameter=2", "length=99", "depth=0.3", "width=0.15", "divisions=7"]),
    ];
    for model in MODELS {
        assert!(cases.iter().any(|case| case.model().name == model.name), "{} is not tried", model.name);
    }
    for case in &cases {
        let points = nodes(case.mesh());
        assert_eq!(points.len() as u64, case.mesh().nodes(), "{case}");
        let mut used = vec![false; points.len()];
        for block in case.mesh().blocks() {
            let elements = elements(case.mesh(), block.shape);
            assert_eq!(elements.len() as u64, block.elements, "{case}");
            assert_ne!(block.elements, 0, "{case}");
            for corners in elements {
                assert_eq!(corners.len(), block.shape.corners());
                corners.iter().for_each(|&corner| used[corner as usize] = true);
                let corners: Vec<_> = corners.iter().map(|&corner| points[corner as usize]).collect();
                let jacobians = corner_jacobians(block.shape, &corners);
                assert!(jacobians.iter().all(|&j| j > 0.0), "{case}: {jacobians:?}");
            }
        }
        assert!(used.iter().all(|&used| used), "{case}: a node is not used");
    }
}

#[test]
fn settings_out_of_place_are_named_with_what_is_allowed() {
    let error = |model: &str, settings: &[&'static str]| {
        let error = generate::model(model).and_then(|m| m.problem(settings.iter().copied())).unwrap_err();
        assert!(error.is_usage());
        error.to_string()
    };
    assert_eq!(
        error("cube", &[]),
        "no model problem is named \"cube\"; there are fd-cylinder, mapped-disc, swept-cylinder, pit-specimen"
    );
    assert_eq!(
        error("mapped-disc", &["rings=3"]),
        "mapped-disc has no parameter \"rings\"; it has radius, divisions"
    );
    assert_eq!(
        error("fd-cylinder", &["strips=2"]),
        "fd-cylinder: strips must be a whole number from 3 to 100000, found \"2\""
    );
    assert_eq!(
        error("fd-cylinder", &["layers=1.5"]),
        "fd-cylinder: layers must be a whole number from 1 to 100000, found \"1.5\""
    );
    for text in ["radius=0", "radius=-1", "radius=nan", "radius=inf", "radius=wide", "radius="] {
        let message = error("fd-cylinder", &[text]);
        assert!(message.contains("radius must be a number from 1e-12 to 1e12, found"), "{message}");
    }
    assert_eq!(
        error("mapped-disc", &["radius"]),
        "mapped-disc: expected a setting as name=value, found \"radius\""
    );
    assert_eq!(error("mapped-disc", &["radius=1", "radius=1"]), "mapped-disc: radius is set twice");
    assert_eq!(
        error("swept-cylinder", &["elements=pyramids"]),
        "swept-cylinder: elements must be one of hexahedra, tetrahedra, wedges, found \"pyramids\""
    );
    assert_eq!(
        error("pit-specimen", &["depth=0.5", "width=1.5"]),
        "pit-specimen: width must be from half to twice the depth, 0.25 to 1, found 1.5"
    );
    assert_eq!(
        error("pit-specimen", &["depth=1"]),
        "pit-specimen: depth must be at most 0.3 of the specimen's radius and 0.2 of its length, here 0.96, found 1"
    );
}
