//! What must not change a score: numbering, place, attitude, size. And the two ends of the scale.

use meshgauge::measures::{geometry, quadrilateral, tetrahedron, triangle};
use meshgauge::mesh::Shape;

use super::random::{CUBE, Random, SQUARE, regular};

/// The numberings that leave a triangle, a quadrilateral, a tetrahedron what it is.
const TRIANGLES: [[usize; 3]; 6] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];
const QUADRILATERALS: [[usize; 4]; 8] = [
    [0, 1, 2, 3],
    [1, 2, 3, 0],
    [2, 3, 0, 1],
    [3, 0, 1, 2],
    [3, 2, 1, 0],
    [2, 1, 0, 3],
    [1, 0, 3, 2],
    [0, 3, 2, 1],
];
const TETRAHEDRA: [[usize; 4]; 12] = [
    [0, 1, 2, 3],
    [0, 2, 3, 1],
    [0, 3, 1, 2],
    [1, 0, 3, 2],
    [1, 3, 2, 0],
    [1, 2, 0, 3],
    [2, 0, 1, 3],
    [2, 1, 3, 0],
    [2, 3, 0, 1],
    [3, 0, 2, 1],
    [3, 2, 1, 0],
    [3, 1, 0, 2],
];

/// Rows of a random rotation matrix, from a random quaternion.
fn rotation(random: &mut Random) -> [[f64; 3]; 3] {
    let q = [random.number(), random.number(), random.number(), random.number()];
    let length = q.iter().map(|c| c * c).sum::<f64>().sqrt();
    let [w, x, y, z] = q.map(|c| c / length);
    [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
        [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
        [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
    ]
}

fn turned<const N: usize>(points: &[[f64; 3]; N], matrix: &[[f64; 3]; 3]) -> [[f64; 3]; N] {
    points.map(|p| matrix.map(|row| row[0] * p[0] + row[1] * p[1] + row[2] * p[2]))
}

/// Scores every image of random elements, and checks them against the element's own.
fn check<const N: usize, const M: usize>(
    score: fn(&[[f64; 3]; N]) -> [f64; M],
    start: [[f64; 3]; N],
    numberings: &[[usize; N]],
) {
    let mut random = Random(11);
    for round in 0..20_000 {
        let jitter = if round % 3 == 0 { 1e-6 } else { 0.3 };
        let element = start.map(|p| p.map(|c| c + jitter * random.number()));
        let own = score(&element);
        let close = |image: &[[f64; 3]; N], tolerance: f64, what: &str| {
            for (m, (found, own)) in score(image).into_iter().zip(own).enumerate() {
                let error = (found - own).abs();
                assert!(error <= tolerance, "{what}, measure {m} of {element:?}: {error:e}");
            }
        };
        for numbering in numberings {
            close(&numbering.map(|i| element[i]), 1e-14, "renumbered");
        }
        // Turning rounds each coordinate once; moving by 1e4 sizes rounds it to 1e-12 of the size.
        close(&turned(&element, &rotation(&mut random)), 2e-13, "turned");
        let shift = [random.number() * 1e4, random.number() * 1e4, random.number() * 1e4];
        close(&element.map(|p| [p[0] + shift[0], p[1] + shift[1], p[2] + shift[2]]), 2e-11, "moved");
        let size = 10f64.powf(9.0 * random.number());
        close(&element.map(|p| p.map(|c| c * size)), 2e-13, "scaled");
        for exponent in [-900, -500, 500, 900] {
            let size = 2f64.powi(exponent);
            close(&element.map(|p| p.map(|c| c * size)), 0.0, "scaled by a power of two");
        }
    }
}

#[test]
fn no_motion_changes_the_scores_of_a_triangle() {
    check(triangle::score, regular::<3>(), &TRIANGLES);
}

#[test]
fn no_motion_changes_the_scores_of_a_quadrilateral() {
    check(quadrilateral::score, SQUARE, &QUADRILATERALS);
}

#[test]
fn no_motion_changes_the_scores_of_a_tetrahedron() {
    check(tetrahedron::score, regular::<4>(), &TETRAHEDRA);
}

/// A small face and a far corner: whichever corner is numbered first, the volume must come from the short edges.
#[test]
fn numbering_does_not_cost_a_needle_its_digits() {
    let mut random = Random(12);
    for _ in 0..1000 {
        let mut needle = random.element::<4>(0.3).map(|p| p.map(|c| c * 1e-6));
        needle[3] = [1.0, 0.3, -0.2];
        let own = tetrahedron::score(&needle);
        for numbering in TETRAHEDRA {
            for (found, own) in tetrahedron::score(&numbering.map(|i| needle[i])).into_iter().zip(own) {
                assert!((found - own).abs() <= 1e-9 * own, "{numbering:?} of {needle:?}: {found} {own}");
            }
        }
    }
}

/// Two coinciding largest eigenvalues: the textbook solution of the cubic is off by 1e-8 there.
#[test]
fn conditioning_of_a_tetrahedron_on_an_axis_of_symmetry_keeps_its_digits() {
    for height in [0.01_f64, 0.1, 0.5, 2.0, 10.0, 100.0] {
        let s = 3f64.sqrt();
        let points = [[1.0, 0.0, 0.0], [-0.5, s / 2.0, 0.0], [-0.5, -s / 2.0, 0.0], [0.0, 0.0, height]];
        // Twice the areas: 3√3/2 of the base; the sides have normals of length √3 √(1/4 + h²), and N is diagonal.
        let across = 9.0 / 2.0 * height * height;
        let along = 27.0 / 4.0 + 9.0 / 4.0;
        let volume6 = 3.0 * s / 2.0 * height;
        let expected = 2f64.sqrt() * volume6 / f64::max(across, along).powf(0.75);
        let mut random = Random(13);
        for _ in 0..100 {
            let [_, _, found, _] = tetrahedron::score(&turned(&points, &rotation(&mut random)));
            assert!((found - expected).abs() <= 2e-14, "height {height}: {found} {expected}");
        }
    }
}

#[test]
fn perfect_elements_score_one() {
    let mut random = Random(14);
    for _ in 0..1000 {
        let matrix = rotation(&mut random);
        let close = |scores: &[f64]| {
            for score in scores {
                assert!((score - 1.0).abs() <= 2e-14, "{scores:?}");
            }
        };
        close(&tetrahedron::score(&turned(&regular::<4>(), &matrix)));
        close(&triangle::score(&turned(&regular::<3>(), &matrix)));
        close(&quadrilateral::score(&turned(&SQUARE, &matrix)));
    }
}

#[test]
fn degenerate_elements_score_zero() {
    let mut random = Random(15);
    for _ in 0..10_000 {
        // All corners exactly in line, at any slope: what is left of the products of rounded edges is rounding.
        let along = [random.number(), random.number(), random.number()];
        let [a, b, c] = [0, 1, 2].map(|_| 2f64.powi(random.below(16) as i32) * random.number().signum());
        let on_line = [0.0, a, b, c].map(|t| along.map(|x| t * x));
        assert_eq!(tetrahedron::score(&on_line), [0.0; 4], "{on_line:?}");
        assert_eq!(triangle::score(&[on_line[0], on_line[1], on_line[2]]), [0.0; 5], "{on_line:?}");
        let [planarity, _, angles] = quadrilateral::score(&on_line);
        assert!(planarity == 0.0 && angles <= 1e-7, "{on_line:?}: {planarity} {angles}");
        for shape in [Shape::Quadrilateral, Shape::Tetrahedron] {
            assert!(geometry::of(shape, &on_line).degenerate, "{shape} {on_line:?}");
        }

        let mut flat = random.element::<4>(0.3);
        flat[3] = [0, 1, 2].map(|i| 0.5 * flat[0][i] + 0.25 * flat[1][i] + 0.25 * flat[2][i]);
        assert!(tetrahedron::score(&flat).into_iter().all(|score| score <= 1e-14), "{flat:?}");

        let point = [along; 4];
        assert_eq!(tetrahedron::score(&point), [0.0; 4]);
        assert_eq!(quadrilateral::score(&point), [0.0; 3]);
        assert_eq!(triangle::score(&[along; 3]), [0.0; 5]);
    }
}

/// Files with such coordinates are refused, but a kernel must not make NaN of what overflows all the same.
#[test]
fn no_coordinate_makes_a_score_nan() {
    let ends = [0.0, 1.0, -f64::MAX, f64::MAX, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, -f64::NAN, 5e-324];
    let mut random = Random(17);
    for _ in 0..100_000 {
        let points = [(); 4].map(|()| [(); 3].map(|()| ends[random.below(ends.len() as u64)]));
        let scores = [
            &tetrahedron::score(&points)[..],
            &quadrilateral::score(&points)[..],
            &triangle::score(&[points[0], points[1], points[2]])[..],
        ];
        assert!(scores.concat().iter().all(|score| (0.0..=1.0).contains(score)), "{points:?}: {scores:?}");
    }
}

#[test]
fn flaws_of_outlines() {
    let at = |x: f64, y: f64| [x, y, 0.0];
    let flaws = |points: [[f64; 3]; 4]| {
        let mut random = Random(16);
        let flaws = quadrilateral::flaws(&points);
        for numbering in QUADRILATERALS {
            let image = turned(&numbering.map(|i| points[i]), &rotation(&mut random));
            assert_eq!(quadrilateral::flaws(&image), flaws, "{numbering:?} of {points:?}");
        }
        (flaws.concave, flaws.crossing)
    };
    assert_eq!(flaws(SQUARE), (false, false));
    let arrow = [at(0.0, 0.0), at(2.0, -1.0), at(1.0, 0.0), at(2.0, 1.0)];
    assert_eq!(flaws(arrow), (true, false));
    // Straight at a corner is not yet re-entrant.
    assert_eq!(flaws([at(0.0, 0.0), at(1.0, 0.0), at(2.0, 0.0), at(1.0, 1.0)]), (false, false));
    // Bow-ties: a symmetric one, whose mean normal vanishes, and a lopsided one.
    assert_eq!(flaws([CUBE[0], CUBE[2], CUBE[1], CUBE[3]]), (false, true));
    assert_eq!(flaws([at(0.0, 0.0), at(2.0, 2.0), at(3.0, 0.0), at(0.0, 1.0)]), (false, true));
}

/// Neighbouring corners turn against each other there as in a bow-tie, but seen along the mean normal it is convex.
#[test]
fn a_sharply_folded_quadrilateral_is_not_taken_for_a_bow_tie() {
    let folded = [[0.0, 0.0, 0.0], [0.0, 1.0, -2.0], [1.0, 0.0, -1.0], [0.0, 2.0, 0.0]];
    let flaws = quadrilateral::flaws(&folded);
    assert!(!flaws.crossing && !flaws.concave, "{flaws:?}");
}
