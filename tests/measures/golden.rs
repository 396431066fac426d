//! 450 elements with values of 25 digits, computed with 60 straight from the definitions.

use meshgauge::measures::{Family, geometry, quadrilateral, tetrahedron, triangle};
use meshgauge::mesh::Shape;
use serde_json::Value;

const GOLDEN: &str = include_str!("../golden/golden.jsonl");

pub(crate) struct Row {
    pub(crate) shape: Shape,
    pub(crate) kind: String,
    pub(crate) points: Vec<[f64; 3]>,
    values: Value,
}

impl Row {
    pub(crate) fn value(&self, name: &str) -> f64 {
        self.try_value(name).unwrap_or_else(|| panic!("a golden row of {} lacks {name}", self.shape))
    }

    pub(crate) fn try_value(&self, name: &str) -> Option<f64> {
        Some(self.values.get(name)?.as_str()?.parse().expect("a number"))
    }
}

pub(crate) fn rows() -> impl Iterator<Item = Row> {
    GOLDEN.lines().map(|line| {
        let values: Value = serde_json::from_str(line).expect("a line of JSON");
        let points = values["points"].as_array().expect("points");
        let coordinate = |c: &Value| c.as_f64().expect("a coordinate");
        let points = points.iter().map(|p| [coordinate(&p[0]), coordinate(&p[1]), coordinate(&p[2])]);
        Row {
            shape: match values["shape"].as_str() {
                Some("triangle") => Shape::Triangle,
                Some("quad") => Shape::Quadrilateral,
                _ => Shape::Tetrahedron,
            },
            kind: values["kind"].as_str().expect("a kind").to_owned(),
            points: points.collect(),
            values,
        }
    })
}

/// The family of a golden row's shape, and the scores of its element.
fn score(row: &Row) -> (Family, Vec<f64>) {
    let p = &row.points;
    match row.shape {
        Shape::Triangle => (Family::Triangle, triangle::score(&[p[0], p[1], p[2]]).to_vec()),
        Shape::Quadrilateral => {
            (Family::Quadrilateral, quadrilateral::score(&[p[0], p[1], p[2], p[3]]).to_vec())
        }
        _ => (Family::Tetrahedron, tetrahedron::score(&[p[0], p[1], p[2], p[3]]).to_vec()),
    }
}

#[test]
fn every_score_is_within_1e_14_of_its_golden_value() {
    let mut count = 0;
    let mut worst = std::collections::BTreeMap::new();
    for row in rows() {
        let (family, scores) = score(&row);
        for (measure, score) in family.measures().iter().zip(scores) {
            let error = (score - row.value(measure.code)).abs();
            let worst = worst.entry(measure.code).or_insert(0.0);
            *worst = f64::max(*worst, error);
            assert!(error <= 1e-14, "{} of {} {:?}: {error:e}", measure.code, row.kind, row.points);
            count += 1;
        }
    }
    eprintln!("worst errors: {worst:?}");
    assert_eq!(count, 150 * (5 + 3 + 4));
}

#[test]
fn aspect_over_three_sides_is_what_the_report_tabulates() {
    for row in rows().filter(|row| row.shape == Shape::Quadrilateral) {
        let points: [_; 4] = row.points[..].try_into().expect("four corners");
        let error = quadrilateral::aspect_three_sides(&points) - row.value("M22_three_sides");
        assert!(error.abs() <= 1e-14, "{} {:?}: {error:e}", row.kind, row.points);
    }
}

#[test]
fn areas_and_volumes_are_right_to_the_rounding_of_their_terms() {
    for row in rows() {
        let element = geometry::of(row.shape, &row.points);
        let name = if row.shape == Shape::Tetrahedron { "volume" } else { "area" };
        let expected = row.value(name);
        let error = (element.extent - expected).abs();
        // Of a flat or needle element the terms cancel: the error is relative to the terms.
        let terms = element.longest.powi(row.shape.dimension() as i32);
        assert!(error <= 1e-15 * terms, "{} {:?}: {error:e}", row.kind, row.points);
        let round = expected.abs() > 0.02 * terms;
        assert!(!round || error <= 1e-14 * expected.abs(), "{} {:?}: {error:e}", row.kind, row.points);
        assert_eq!(element.degenerate, expected == 0.0 || element.shortest == 0.0, "{:?}", row.points);
        if row.shape == Shape::Tetrahedron && expected != 0.0 {
            assert_eq!(element.sign, expected.signum(), "{:?}", row.points);
        }
    }
}

/// Table 2 of the report: the triangular faces of mesh FD1's wedges are sectors of 10° and of radius 0.5, all alike.
#[test]
fn sectors_of_the_mesh_fd1_score_as_printed() {
    let turn = 10f64.to_radians();
    let sector = [[0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [0.5 * turn.cos(), 0.5 * turn.sin(), 0.0]];
    let printed = ["0.318", "0.382", "0.296", "0.535", "0.152"];
    for (found, printed) in triangle::score(&sector).into_iter().zip(printed) {
        assert_eq!(format!("{found:.3}"), printed);
    }
}

/// The golden sliver that an arc cosine gets wrong by 1e-9.
#[test]
fn angles_near_zero_keep_their_digits() {
    let thin = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0 - 1e-9, 1.0, 0.0]];
    let [_, _, angles] = quadrilateral::score(&thin);
    // Corners: 45° + 5e-10, 90°, 90°, 135° - 5e-10.
    let (quarter, half) = (std::f64::consts::FRAC_PI_4, std::f64::consts::FRAC_PI_2);
    assert!((angles - (quarter + 5e-10) / (quarter + half - 5e-10)).abs() < 1e-15, "{angles}");

    let height = 1e-8;
    let flat = [[0.0, 0.0, 0.0], [1.0, -height, 0.0], [2.0, 0.0, 0.0], [1.0, height, 0.0]];
    let [_, _, angles] = quadrilateral::score(&flat);
    assert!((angles - 2.0 * height / (2.0 * half - 2.0 * height)).abs() < 1e-22, "{angles}");
}
