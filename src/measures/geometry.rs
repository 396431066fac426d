//! Area, volume, orientation and edge lengths of whole elements of any shape.

use super::elementary::{ROUNDING2, unit};
use super::vector::{Vector, add, choose, cross, dot, edge, larger, reach, smaller, square};
use super::{quadrilateral, tetrahedron, triangle};
use crate::mesh::Shape;

/// What is known of one element as a whole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Element {
    /// The signed volume of a solid; the area of a surface, which is not negative.
    pub extent: f64,
    /// +1, -1, or 0 where the sign is within the rounding error of its computation: the sign of a solid's volume,
    /// of the z component of a surface's normal.
    pub sign: f64,
    /// The shortest edge.
    pub shortest: f64,
    /// The longest edge.
    pub longest: f64,
    /// The root mean square of the edges.
    pub size: f64,
    /// Whether the area or volume is 0 within the rounding error of its computation, or an edge is.
    pub degenerate: bool,
}

/// Measures an element of a shape, given by its corners.
///
/// The volume of a pyramid, wedge or hexahedron is the exact one of the (tri)linear element, whose quadrilateral
/// faces are bilinear. The area of a quadrilateral is half the length of the cross product of its diagonals.
///
/// # Panics
///
/// If there are fewer points than the shape has corners.
pub fn of(shape: Shape, points: &[[f64; 3]]) -> Element {
    match shape {
        Shape::Triangle => of_corners::<3>(shape, first(points)),
        Shape::Quadrilateral => of_corners::<4>(shape, first(points)),
        Shape::Tetrahedron => of_corners::<4>(shape, first(points)),
        Shape::Pyramid => of_corners::<5>(shape, first(points)),
        Shape::Wedge => of_corners::<6>(shape, first(points)),
        Shape::Hexahedron => of_corners::<8>(shape, first(points)),
    }
}

fn first<const N: usize>(points: &[Vector]) -> &[Vector; N] {
    points.first_chunk().expect("an element has as many points as its shape has corners")
}

/// Runs a block for each row of a shape's table, written out once for every row that a table can have: a loop would
/// be unrolled too late for the lanes around it to become vector code. What is beyond the table's end vanishes.
macro_rules! for_each {
    ($row:pat in $table:expr, $block:block) => {
        for_each!(@ $row, $table, $block, 0 1 2 3 4 5 6 7 8 9 10 11)
    };
    (@ $row:pat, $table:expr, $block:block, $($index:literal)+) => {
        $(if $index < $table.len() {
            let $row = $table[$index];
            $block
        })+
    };
}

/// The one definition. `shape` is a constant wherever this is inlined, so its table folds into the code.
#[inline(always)]
pub(super) fn of_corners<const N: usize>(shape: Shape, p: &[Vector; N]) -> Element {
    let mut far = 0.0;
    for_each!(corner in p, {
        far = larger(far, reach(&p[0], &corner));
    });
    let (scale, length) = unit(far);

    let edges = shape.facts().edges;
    let (mut shortest, mut longest, mut sum) = (f64::MAX, 0.0, 0.0);
    for_each!([a, b] in edges, {
        let squared = square(&edge(&p[a], &p[b], scale));
        shortest = smaller(shortest, squared);
        longest = larger(longest, squared);
        sum += squared;
    });

    let extent = match shape {
        Shape::Triangle => {
            let (normal, bound) = triangle::normal(&[p[0], p[1], p[2]], scale);
            Extent::of_surface(&normal, bound, length)
        }
        Shape::Quadrilateral => {
            let (normal, bound) = quadrilateral::normal(&[p[0], p[1], p[2], p[3]], scale);
            Extent::of_surface(&normal, bound, length)
        }
        Shape::Tetrahedron => {
            let (volume, bound) = tetrahedron::determinant(&[p[0], p[1], p[2], p[3]], scale);
            Extent::of_solid(volume, bound, length)
        }
        Shape::Pyramid | Shape::Wedge | Shape::Hexahedron => {
            let (volume, bound) = divergence(shape, p, scale);
            Extent::of_solid(volume, bound, length)
        }
    };
    Element {
        extent: extent.size,
        sign: extent.sign,
        shortest: shortest.sqrt() * length,
        longest: longest.sqrt() * length,
        size: (sum / edges.len() as f64).sqrt() * length,
        degenerate: !extent.certain | (shortest <= 0.0),
    }
}

/// An area or volume.
struct Extent {
    size: f64,
    sign: f64,
    /// Whether it is beyond the rounding error of its computation.
    certain: bool,
}

impl Extent {
    /// From a normal of length 2A and the square of a bound on its error, in units of `length`.
    #[inline(always)]
    fn of_surface(normal: &Vector, bound: f64, length: f64) -> Self {
        let squared = square(normal);
        let area = squared.sqrt() * 0.5 * length * length;
        Extent { size: area, sign: sign(normal[2], bound), certain: squared > bound }
    }

    /// From 6V and the square of a bound on its error, in units of `length`.
    #[inline(always)]
    fn of_solid(volume: f64, bound: f64, length: f64) -> Self {
        let size = volume * (1.0 / 6.0) * length * length * length;
        Extent { size, sign: sign(volume, bound), certain: volume * volume > bound }
    }
}

/// +1 or -1, or 0 where `x` is within a bound of 0, given the bound's square.
#[inline(always)]
fn sign(x: f64, bound: f64) -> f64 {
    choose(x * x > bound, choose(x > 0.0, 1.0, -1.0), 0.0)
}

/// 6V of a solid and the square of a bound on its rounding error, by the divergence theorem: the sum over the faces of
/// the flux of the position.
///
/// The flux through a bilinear face with corners a, b, c, d is (a+b+c+d)/4 · (c-a)×(d-b), the mean of the fluxes
/// through the two pairs of triangles that a diagonal makes of it.
#[inline(always)]
fn divergence<const N: usize>(shape: Shape, p: &[Vector; N], scale: f64) -> (f64, f64) {
    let (mut sum, mut magnitude) = (0.0, 0.0);
    for_each!([a, b, c] in shape.facts().triangles, {
        let from = edge(&p[0], &p[a], scale);
        let (u, v) = (edge(&p[a], &p[b], scale), edge(&p[a], &p[c], scale));
        sum += dot(&from, &cross(&u, &v));
        magnitude += permanent(&from, &u, &v);
    });
    for_each!([a, b, c, d] in shape.facts().quadrilaterals, {
        let first = add(&edge(&p[0], &p[a], scale), &edge(&p[0], &p[b], scale));
        let second = add(&edge(&p[0], &p[c], scale), &edge(&p[0], &p[d], scale));
        let middle = add(&first, &second);
        let (u, v) = (edge(&p[a], &p[c], scale), edge(&p[b], &p[d], scale));
        sum += 0.25 * dot(&middle, &cross(&u, &v));
        magnitude += 0.25 * permanent(&middle, &u, &v);
    });
    (sum, ROUNDING2 * (magnitude * magnitude))
}

/// The triple product with all signs positive: what its rounding error is relative to.
#[inline(always)]
fn permanent(a: &Vector, b: &Vector, c: &Vector) -> f64 {
    a[0].abs() * ((b[1] * c[2]).abs() + (b[2] * c[1]).abs())
        + a[1].abs() * ((b[2] * c[0]).abs() + (b[0] * c[2]).abs())
        + a[2].abs() * ((b[0] * c[1]).abs() + (b[1] * c[0]).abs())
}
