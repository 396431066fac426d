//! M21 to M23: quadrilaterals of space, elements as well as faces, and their flaws of shape.

use super::elementary::{ROUNDING, ROUNDING2, angle, unit};
use super::vector::{Vector, add, choose, cross, dot, edge, larger, reach, smaller, square};
use super::{ASPECT_FAILURE, ASPECT_WARNING, Family};

measures! { Family::Quadrilateral, of 4 corners:
    planarity {
        code: "M21",
        title: "Planarity",
        definition: "1-W, W the corners' distance from the mean plane over the mean diagonal; not under 0",
        watches: "warping",
        source: "NPL eq. (8); W as Nastran's Q4_WARP, since that of NPL eq. (2) depends on the origin",
        thresholds: &[],
    }
    aspect {
        code: "M22",
        title: "Aspect",
        definition: "lmin/lmax over the four sides",
        watches: "aspect ratio",
        source: "NPL eq. (9)",
        thresholds: &[ASPECT_WARNING, ASPECT_FAILURE],
    }
    angles {
        code: "M23",
        title: "Ratio of angles",
        definition: "θmin/θmax of the interior angles; a re-entrant corner is over 180°",
        watches: "taper and skew",
        source: "NPL eq. (10)",
        thresholds: &[],
    }
}

/// What the measures share, in units of about the longest edge.
struct Facts {
    /// Sides round the quadrilateral; side i goes from corner i to the next.
    sides: [Vector; 4],
    squares: [f64; 4],
    diagonals: [f64; 2],
    /// Cross product of the diagonals, of length 2A.
    normal: Vector,
    /// 2A; 0 where it is within the rounding error of its computation.
    twice_area: f64,
}

impl Facts {
    #[inline(always)]
    fn of(p: &[Vector; 4]) -> Self {
        let far = larger(larger(reach(&p[0], &p[1]), reach(&p[0], &p[2])), reach(&p[0], &p[3]));
        let (scale, _) = unit(far);
        let sides = [
            edge(&p[0], &p[1], scale),
            edge(&p[1], &p[2], scale),
            edge(&p[2], &p[3], scale),
            edge(&p[3], &p[0], scale),
        ];
        let squares = [square(&sides[0]), square(&sides[1]), square(&sides[2]), square(&sides[3])];
        let (d, e) = (edge(&p[0], &p[2], scale), edge(&p[1], &p[3], scale));
        let diagonals = [square(&d).sqrt(), square(&e).sqrt()];
        let (normal, bound) = normal(p, scale);
        let area2 = square(&normal);
        Facts { sides, squares, diagonals, normal, twice_area: choose(area2 > bound, area2.sqrt(), 0.0) }
    }

    /// Corner `i`'s own normal: the cross product of the sides that meet there.
    #[inline(always)]
    fn corner(&self, i: usize) -> Vector {
        cross(&self.sides[(i + 3) % 4], &self.sides[i])
    }

    /// Whether corner `i`, of normal `own`, is over 180° as seen along the mean normal. A spike whose angle is 0
    /// within rounding is not: it is 0, not 360°.
    #[inline(always)]
    fn is_reentrant(&self, own: &Vector, lengths: f64) -> bool {
        let seen = dot(own, &self.normal);
        (seen < -ROUNDING * lengths * self.twice_area) & (self.twice_area > 0.0)
    }

    /// The interior angle at corner `i`, given the lengths of all sides.
    #[inline(always)]
    fn angle(&self, i: usize, lengths: &[f64; 4]) -> f64 {
        let before = (i + 3) % 4;
        let product = lengths[before] * lengths[i];
        let own = self.corner(i);
        let inner = angle(square(&own).sqrt(), -dot(&self.sides[before], &self.sides[i]), product);
        choose(self.is_reentrant(&own, product), std::f64::consts::TAU - inner, inner)
    }

    #[inline(always)]
    fn lengths(&self) -> [f64; 4] {
        let [a, b, c, d] = self.squares;
        [a.sqrt(), b.sqrt(), c.sqrt(), d.sqrt()]
    }
}

/// The cross product of the diagonals, of length 2A, and the square of a bound on its rounding error.
#[inline(always)]
pub(super) fn normal(p: &[Vector; 4], scale: f64) -> (Vector, f64) {
    let d = edge(&p[0], &p[2], scale);
    let e = edge(&p[1], &p[3], scale);
    (cross(&d, &e), ROUNDING2 * (square(&d) * square(&e)))
}

/// The corners lie by turns h above and below the mean plane: 4h is the component along the normal of
/// x₀-x₁+x₂-x₃, the sum of two opposite sides.
#[inline(always)]
fn planarity(q: &Facts) -> f64 {
    let warp = dot(&add(&q.sides[1], &q.sides[3]), &q.normal).abs();
    let w = warp / (2.0 * q.twice_area * (q.diagonals[0] + q.diagonals[1]));
    choose(q.twice_area > 0.0, 1.0 - w, 0.0)
}

#[inline(always)]
fn aspect(q: &Facts) -> f64 {
    let [a, b, c, d] = q.lengths();
    smaller(smaller(a, b), smaller(c, d)) / larger(larger(a, b), larger(c, d))
}

#[inline(always)]
fn angles(q: &Facts) -> f64 {
    let lengths = q.lengths();
    let (a, b) = (q.angle(0, &lengths), q.angle(1, &lengths));
    let (c, d) = (q.angle(2, &lengths), q.angle(3, &lengths));
    smaller(smaller(a, b), smaller(c, d)) / larger(larger(a, b), larger(c, d))
}

/// M22 over the first three sides only: what the report's tables 3, 4, 5 and 9 hold in place of M22.
pub fn aspect_three_sides(points: &[[f64; 3]; 4]) -> f64 {
    let [a, b, c, _] = Facts::of(points).lengths();
    super::elementary::score(smaller(smaller(a, b), c) / larger(larger(a, b), c))
}

/// What is wrong with a quadrilateral's outline: at most one of the two holds.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Flaws {
    /// A corner is re-entrant: over 180°.
    pub concave: bool,
    /// Two opposite sides cross: a bow-tie, from corners out of order.
    pub crossing: bool,
}

/// The flaws of a quadrilateral.
#[inline(always)]
pub(super) fn flaws_of(points: &[Vector; 4]) -> Flaws {
    let q = Facts::of(points);
    let [a, b, c, d] = q.lengths();
    let corners = [q.corner(0), q.corner(1), q.corner(2), q.corner(3)];
    let reentrant = q.is_reentrant(&corners[0], d * a)
        | q.is_reentrant(&corners[1], a * b)
        | q.is_reentrant(&corners[2], b * c)
        | q.is_reentrant(&corners[3], c * d);
    // A side with its two neighbours on either hand turns once left and once right; where two opposite sides
    // both do, they cross. This needs no mean normal: a symmetric bow-tie has none. Where there is one, the corners of
    // the smaller half are re-entrant; without such a corner it is folded sharply and not crossed.
    let rounding = -ROUNDING * (a * b) * (c * d);
    let turns = [
        dot(&corners[0], &corners[1]) < rounding,
        dot(&corners[1], &corners[2]) < rounding,
        dot(&corners[2], &corners[3]) < rounding,
        dot(&corners[3], &corners[0]) < rounding,
    ];
    let opposite = (turns[0] & turns[2]) | (turns[1] & turns[3]);
    let crossing = opposite & (reentrant | (q.twice_area <= 0.0));
    Flaws { concave: reentrant & !crossing, crossing }
}

/// The flaws of a quadrilateral given by its corners in order round it.
pub fn flaws(points: &[[f64; 3]; 4]) -> Flaws {
    flaws_of(points)
}
