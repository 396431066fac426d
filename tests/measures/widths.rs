//! Batch and scalar give the same bits, at every vector width that this machine has.

use meshgauge::measures::batch::{
    geometry_at, quadrilateral_flaws_at, quadrilaterals_at, tetrahedra_at, triangles_at,
};
use meshgauge::measures::{
    Corner, Geometry, LANES, Lanes, QuadrilateralFlaws, geometry, quadrilateral, tetrahedron, triangle,
};
use meshgauge::mesh::Shape;
use meshgauge::width::Width;

use super::random::Random;

const BATCHES: usize = 100_000 / LANES + 1;

/// The same elements one after another and side by side.
fn elements<const N: usize>(random: &mut Random) -> (Vec<[[f64; 3]; N]>, [Corner; N]) {
    let elements: Vec<[[f64; 3]; N]> = (0..LANES).map(|_| random.any_element()).collect();
    let mut corners = [[[0.0; LANES]; 3]; N];
    for (lane, element) in elements.iter().enumerate() {
        for (corner, point) in corners.iter_mut().zip(element) {
            for (axis, c) in corner.iter_mut().zip(point) {
                axis[lane] = *c;
            }
        }
    }
    (elements, corners)
}

fn compare<const N: usize, const M: usize>(
    seed: u64,
    one: fn(&[[f64; 3]; N]) -> [f64; M],
    many: fn(Width, [&Corner; N], &mut [Lanes; M]),
) {
    let mut random = Random(seed);
    for _ in 0..BATCHES {
        let (elements, corners) = elements::<N>(&mut random);
        for width in Width::available() {
            let mut out = [[f64::NAN; LANES]; M];
            many(width, corners.each_ref(), &mut out);
            for (lane, element) in elements.iter().enumerate() {
                for (m, score) in one(element).into_iter().enumerate() {
                    let found = out[m][lane];
                    assert!(
                        found.to_bits() == score.to_bits() && (0.0..=1.0).contains(&score),
                        "measure {m} of {element:?}: {found:e} with {}, {score:e} alone",
                        width.name()
                    );
                }
            }
        }
    }
}

#[test]
fn triangles_have_the_same_bits_at_every_width() {
    compare(1, triangle::score, triangles_at);
}

#[test]
fn quadrilaterals_have_the_same_bits_at_every_width() {
    compare(2, quadrilateral::score, quadrilaterals_at);
}

#[test]
fn tetrahedra_have_the_same_bits_at_every_width() {
    compare(3, tetrahedron::score, tetrahedra_at);
}

#[test]
fn flaws_are_the_same_at_every_width() {
    let mut random = Random(4);
    for _ in 0..BATCHES {
        let (elements, corners) = elements::<4>(&mut random);
        for width in Width::available() {
            let mut out = QuadrilateralFlaws::default();
            quadrilateral_flaws_at(width, corners.each_ref(), &mut out);
            for (lane, element) in elements.iter().enumerate() {
                let flaws = quadrilateral::flaws(element);
                assert_eq!((out.concave[lane], out.crossing[lane]), (flaws.concave, flaws.crossing));
            }
        }
    }
}

fn compare_geometry<const N: usize>(shape: Shape) {
    let mut random = Random(5);
    for _ in 0..BATCHES / 4 {
        let (elements, corners) = elements::<N>(&mut random);
        for width in Width::available() {
            let mut out = Geometry::default();
            geometry_at(width, shape, &corners, &mut out);
            for (lane, element) in elements.iter().enumerate() {
                let one = geometry::of(shape, element);
                let found = [out.extent, out.sign, out.shortest, out.longest, out.size].map(|row| row[lane]);
                let expected = [one.extent, one.sign, one.shortest, one.longest, one.size];
                for (found, expected) in found.into_iter().zip(expected) {
                    let same = found.to_bits() == expected.to_bits() || (found.is_nan() && expected.is_nan());
                    assert!(same, "{shape} {element:?}: {found} with {}, {expected} alone", width.name());
                }
                assert_eq!(out.degenerate[lane], one.degenerate, "{shape} {element:?}");
            }
        }
    }
}

#[test]
fn geometry_has_the_same_bits_at_every_width() {
    compare_geometry::<3>(Shape::Triangle);
    compare_geometry::<4>(Shape::Quadrilateral);
    compare_geometry::<4>(Shape::Tetrahedron);
    compare_geometry::<5>(Shape::Pyramid);
    compare_geometry::<6>(Shape::Wedge);
    compare_geometry::<8>(Shape::Hexahedron);
}
