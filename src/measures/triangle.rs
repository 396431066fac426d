//! M11 to M15: triangles of space, elements as well as faces.

use super::elementary::{ROUNDING2, inverse_root, unit};
use super::vector::{Vector, choose, choose_vector, cross, dot, edge, larger, reach, smaller, square, sub};
use super::{COMSOL_TRIANGLE, Family};

measures! { Family::Triangle, of 3 corners:
    radius_ratio {
        code: "M11",
        title: "Ratio of radii",
        definition: "2r/R, R of the minimum containment circle",
        watches: "interpolation error of values",
        source: "Cavendish, Field and Frey 1985; NPL eq. (3)",
        thresholds: &[],
    }
    inradius_over_area {
        code: "M12",
        title: "Inradius over area",
        definition: "3√3 r²/A",
        watches: "interpolation error of values",
        source: "NPL eq. (4)",
        thresholds: &[],
    }
    area_over_edges {
        code: "M13",
        title: "Area over squared edges",
        definition: "4√3 A/(3l²), l the RMS edge",
        watches: "interpolation error of values",
        source: "Bank; Comsol Multiphysics; NPL eq. (5)",
        thresholds: &[COMSOL_TRIANGLE],
    }
    gradient {
        code: "M14",
        title: "Gradient interpolation",
        definition: "4(√3+2)^⅔ A/(3^⅚ (lmax lmed (lmin+4r))^⅔)",
        watches: "interpolation error of gradients",
        source: "Shewchuk 2002; NPL eq. (6)",
        thresholds: &[],
    }
    conditioning {
        code: "M15",
        title: "Conditioning",
        definition: "4√3 A/(3l² + √|9l⁴-48A²|), l the RMS edge",
        watches: "conditioning of the stiffness matrix",
        source: "Shewchuk 2002; NPL eq. (7)",
        thresholds: &[],
    }
}

/// What the measures share, in units of about the longest edge.
struct Facts {
    shortest: f64,
    middle: f64,
    longest: f64,
    inverse_perimeter: f64,
    /// Sum of the squared edges: 3l².
    squares: f64,
    /// 9l⁴ - 48A², as the sum of squares that it is.
    spread: f64,
    /// 2A; 0 where it is within the rounding error of its computation.
    twice_area: f64,
    /// Whether all angles are under 90°.
    acute: bool,
}

impl Facts {
    #[inline(always)]
    fn of(p: &[Vector; 3]) -> Self {
        let (scale, _) = unit(larger(reach(&p[0], &p[1]), reach(&p[0], &p[2])));
        let sides = Sides::of(p, scale);
        let [a, b, c] = sides.squares;
        let squares = a + b + c;
        let longest2 = larger(larger(a, b), c);
        let longest = longest2.sqrt();
        let middle = larger(smaller(a, b), smaller(larger(a, b), c)).sqrt();
        let shortest = smaller(smaller(a, b), c).sqrt();
        let (normal, bound) = sides.normal();
        let area2 = square(&normal);
        Facts {
            shortest,
            middle,
            longest,
            inverse_perimeter: 1.0 / (shortest + middle + longest),
            squares,
            spread: sides.spread(),
            twice_area: choose(area2 > bound, area2.sqrt(), 0.0),
            acute: squares > 2.0 * longest2,
        }
    }
}

/// The sides as vectors round the triangle, and their squared lengths.
struct Sides {
    vectors: [Vector; 3],
    squares: [f64; 3],
}

impl Sides {
    #[inline(always)]
    fn of(p: &[Vector; 3], scale: f64) -> Self {
        let u = edge(&p[0], &p[1], scale);
        let v = edge(&p[1], &p[2], scale);
        let w = edge(&p[2], &p[0], scale);
        Sides { vectors: [u, v, w], squares: [square(&u), square(&v), square(&w)] }
    }

    /// The normal, of length 2A, and the square of a bound on its rounding error.
    ///
    /// It is the cross product of the two shorter sides: with the longest, a needle's area would lose digits.
    #[inline(always)]
    fn normal(&self) -> (Vector, f64) {
        let [u, v, w] = &self.vectors;
        let [a, b, c] = self.squares;
        let first = (a >= b) & (a >= c);
        let second = b >= c;
        let from = choose_vector(first, v, &choose_vector(second, w, u));
        let to = choose_vector(first, w, &choose_vector(second, u, v));
        let product = choose(first, b * c, choose(second, c * a, a * b));
        (cross(&from, &to), ROUNDING2 * product)
    }

    /// 2[(a²-b²)² + (b²-c²)² + (c²-a²)²], with a²-b² = (u-v)·(u+v) = (v-u)·w since the sides close.
    #[inline(always)]
    fn spread(&self) -> f64 {
        let [u, v, w] = &self.vectors;
        let x = dot(&sub(v, u), w);
        let y = dot(&sub(w, v), u);
        let z = dot(&sub(u, w), v);
        2.0 * (x * x + y * y + z * z)
    }
}

/// The normal, of length 2A, and the square of a bound on its rounding error.
#[inline(always)]
pub(super) fn normal(p: &[Vector; 3], scale: f64) -> (Vector, f64) {
    Sides::of(p, scale).normal()
}

/// r = 2A/perimeter; R is the circumradius abc/(4A) of an acute triangle, else half the longest edge.
#[inline(always)]
fn radius_ratio(t: &Facts) -> f64 {
    let n = t.twice_area;
    let above = choose(t.acute, n * n, n);
    let below = choose(t.acute, t.shortest * t.middle * t.longest, t.longest);
    4.0 * above * t.inverse_perimeter / below
}

/// 3√3 r²/A = 3√3 A/s², s the half perimeter.
#[inline(always)]
fn inradius_over_area(t: &Facts) -> f64 {
    10.392_304_845_413_264 * t.twice_area * (t.inverse_perimeter * t.inverse_perimeter)
}

#[inline(always)]
fn area_over_edges(t: &Facts) -> f64 {
    3.464_101_615_137_754_6 * t.twice_area / t.squares
}

#[inline(always)]
fn gradient(t: &Facts) -> f64 {
    let inradius = t.twice_area * t.inverse_perimeter;
    let root = inverse_root::<3>(t.longest * t.middle * (t.shortest + 4.0 * inradius));
    1.926_315_038_298_355_3 * t.twice_area * (root * root)
}

#[inline(always)]
fn conditioning(t: &Facts) -> f64 {
    3.464_101_615_137_754_6 * t.twice_area / (t.squares + t.spread.sqrt())
}
