//! The measures of 64 elements side by side, compiled for each vector width and chosen at run time.
//!
//! Each loop calls the function that scores one element, so batch and scalar cannot differ; nothing is fused or
//! reordered, so neither do the widths.

use super::geometry::{self};
use super::vector::Vector;
use super::{quadrilateral, tetrahedron, triangle};
use crate::mesh::Shape;
use crate::width::at_every_width;

/// Number of elements in a batch. Unused lanes may hold any numbers; what comes out of them means nothing.
pub const LANES: usize = 64;

/// One number of each element of a batch.
pub type Lanes = [f64; LANES];

/// One corner of each element of a batch: all x, all y, all z.
pub type Corner = [Lanes; 3];

/// What is wrong with the outlines of a batch of quadrilaterals; see [`quadrilateral::Flaws`].
#[derive(Debug, Clone)]
pub struct QuadrilateralFlaws {
    /// A corner is re-entrant.
    pub concave: [bool; LANES],
    /// Two opposite sides cross.
    pub crossing: [bool; LANES],
}

impl Default for QuadrilateralFlaws {
    fn default() -> Self {
        Self { concave: [false; LANES], crossing: [false; LANES] }
    }
}

/// Geometry of a batch of whole elements; see [`geometry::Element`].
#[derive(Debug, Clone)]
pub struct Geometry {
    /// Signed volumes of solids, areas of surfaces.
    pub extent: Lanes,
    /// +1, -1, or 0 within rounding: of the volume, or of the z component of a surface's normal.
    pub sign: Lanes,
    /// Shortest edges.
    pub shortest: Lanes,
    /// Longest edges.
    pub longest: Lanes,
    /// RMS edge lengths.
    pub size: Lanes,
    /// Zero area, volume or edge, within rounding.
    pub degenerate: [bool; LANES],
}

impl Default for Geometry {
    fn default() -> Self {
        let zero = [0.0; LANES];
        Self {
            extent: zero,
            sign: zero,
            shortest: zero,
            longest: zero,
            size: zero,
            degenerate: [false; LANES],
        }
    }
}

at_every_width! {
    /// M11 to M15 of triangles: `out[m][lane]`.
    triangles, triangles_at = triangle_lanes(corners: [&Corner; 3], out: &mut [Lanes; triangle::COUNT])
}

at_every_width! {
    /// M21 to M23 of quadrilaterals given in order round them: `out[m][lane]`.
    quadrilaterals, quadrilaterals_at =
        quadrilateral_lanes(corners: [&Corner; 4], out: &mut [Lanes; quadrilateral::COUNT])
}

at_every_width! {
    /// M31 to M34 of tetrahedra: `out[m][lane]`.
    tetrahedra, tetrahedra_at = tetrahedron_lanes(corners: [&Corner; 4], out: &mut [Lanes; tetrahedron::COUNT])
}

at_every_width! {
    /// Which quadrilaterals are concave, and which cross themselves.
    quadrilateral_flaws, quadrilateral_flaws_at =
        flaw_lanes(corners: [&Corner; 4], out: &mut QuadrilateralFlaws)
}

at_every_width! {
    /// Geometry of elements of a shape, given by at least as many corners as the shape has.
    ///
    /// # Panics
    ///
    /// If there are fewer corners.
    geometry, geometry_at = geometry_lanes(shape: Shape, corners: &[Corner], out: &mut Geometry)
}

/// One corner of the element in a lane.
#[inline(always)]
fn point(corner: &Corner, lane: usize) -> Vector {
    [corner[0][lane], corner[1][lane], corner[2][lane]]
}

#[inline(always)]
fn triangle_lanes(corners: [&Corner; 3], out: &mut [Lanes; triangle::COUNT]) {
    let [a, b, c] = corners;
    for lane in 0..LANES {
        let scores = triangle::all(&[point(a, lane), point(b, lane), point(c, lane)]);
        for (row, score) in out.iter_mut().zip(scores) {
            row[lane] = score;
        }
    }
}

#[inline(always)]
fn quadrilateral_lanes(corners: [&Corner; 4], out: &mut [Lanes; quadrilateral::COUNT]) {
    let [a, b, c, d] = corners;
    for lane in 0..LANES {
        let scores = quadrilateral::all(&[point(a, lane), point(b, lane), point(c, lane), point(d, lane)]);
        for (row, score) in out.iter_mut().zip(scores) {
            row[lane] = score;
        }
    }
}

#[inline(always)]
fn tetrahedron_lanes(corners: [&Corner; 4], out: &mut [Lanes; tetrahedron::COUNT]) {
    let [a, b, c, d] = corners;
    for lane in 0..LANES {
        let scores = tetrahedron::all(&[point(a, lane), point(b, lane), point(c, lane), point(d, lane)]);
        for (row, score) in out.iter_mut().zip(scores) {
            row[lane] = score;
        }
    }
}

#[inline(always)]
fn flaw_lanes(corners: [&Corner; 4], out: &mut QuadrilateralFlaws) {
    let [a, b, c, d] = corners;
    for lane in 0..LANES {
        let points = [point(a, lane), point(b, lane), point(c, lane), point(d, lane)];
        let flaws = quadrilateral::flaws_of(&points);
        out.concave[lane] = flaws.concave;
        out.crossing[lane] = flaws.crossing;
    }
}

#[inline(always)]
fn geometry_lanes(shape: Shape, corners: &[Corner], out: &mut Geometry) {
    match shape {
        Shape::Triangle => shape_lanes::<3>(Shape::Triangle, corners, out),
        Shape::Quadrilateral => shape_lanes::<4>(Shape::Quadrilateral, corners, out),
        Shape::Tetrahedron => shape_lanes::<4>(Shape::Tetrahedron, corners, out),
        Shape::Pyramid => shape_lanes::<5>(Shape::Pyramid, corners, out),
        Shape::Wedge => shape_lanes::<6>(Shape::Wedge, corners, out),
        Shape::Hexahedron => shape_lanes::<8>(Shape::Hexahedron, corners, out),
    }
}

#[inline(always)]
fn shape_lanes<const N: usize>(shape: Shape, corners: &[Corner], out: &mut Geometry) {
    let corners: &[Corner; N] = corners.first_chunk().expect("as many corners as the shape has");
    for lane in 0..LANES {
        let points: [Vector; N] = std::array::from_fn(|i| point(&corners[i], lane));
        let element = geometry::of_corners(shape, &points);
        out.extent[lane] = element.extent;
        out.sign[lane] = element.sign;
        out.shortest[lane] = element.shortest;
        out.longest[lane] = element.longest;
        out.size[lane] = element.size;
        out.degenerate[lane] = element.degenerate;
    }
}
