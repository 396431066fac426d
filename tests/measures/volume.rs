//! Volumes of pyramids, wedges and hexahedra against Gauss quadrature of their own maps, and what geometry says of
//! an element as a whole.

use meshgauge::measures::geometry;
use meshgauge::mesh::Shape;

use super::random::{CUBE, Random, SQUARE, regular};

type Vector = [f64; 3];

fn mix(a: Vector, b: Vector, t: f64) -> Vector {
    [0, 1, 2].map(|i| (1.0 - t) * a[i] + t * b[i])
}

fn minus(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn triple([u, v, w]: [Vector; 3]) -> f64 {
    u[0] * (v[1] * w[2] - v[2] * w[1])
        + u[1] * (v[2] * w[0] - v[0] * w[2])
        + u[2] * (v[0] * w[1] - v[1] * w[0])
}

/// The integral of the Jacobian of the trilinear map of eight corners, by two Gauss points each way, which is exact:
/// the Jacobian is of the second degree in each coordinate. A wedge and a pyramid are hexahedra with edges collapsed.
fn quadrature(p: &[Vector; 8]) -> f64 {
    let gauss = [0.5 - 0.5 / 3f64.sqrt(), 0.5 + 0.5 / 3f64.sqrt()];
    let mut volume = 0.0;
    for r in gauss {
        for s in gauss {
            for t in gauss {
                let sides = |a: usize, b: usize, c: usize, d: usize, x: f64, y: f64| {
                    mix(mix(p[a], p[b], x), mix(p[c], p[d], x), y)
                };
                let dr = minus(sides(1, 2, 5, 6, s, t), sides(0, 3, 4, 7, s, t));
                let ds = minus(sides(3, 2, 7, 6, r, t), sides(0, 1, 4, 5, r, t));
                let dt = minus(sides(4, 5, 7, 6, r, s), sides(0, 1, 3, 2, r, s));
                volume += triple([dr, ds, dt]) / 8.0;
            }
        }
    }
    volume
}

/// The hexahedron that a solid is when some of its corners coincide.
fn as_hexahedron(shape: Shape, p: &[Vector]) -> [Vector; 8] {
    let corners: [usize; 8] = match shape {
        Shape::Pyramid => [0, 1, 2, 3, 4, 4, 4, 4],
        Shape::Wedge => [0, 1, 2, 2, 3, 4, 5, 5],
        _ => [0, 1, 2, 3, 4, 5, 6, 7],
    };
    corners.map(|i| p[i])
}

fn check<const N: usize>(shape: Shape, numberings: &[[usize; N]]) {
    let mut random = Random(21);
    for _ in 0..5000 {
        let points = random.element::<N>(0.4);
        let expected = quadrature(&as_hexahedron(shape, &points));
        for numbering in numberings {
            let image = numbering.map(|i| points[i]);
            let found = geometry::of(shape, &image);
            assert!((found.extent - expected).abs() <= 2e-15, "{shape} {numbering:?}: {found:?} {expected}");
            assert_eq!(found.sign, expected.signum());
            assert!(!found.degenerate);
            let size = 1e-9;
            let small = geometry::of(shape, &image.map(|p| p.map(|c| c * size)));
            assert!((small.extent / size.powi(3) - expected).abs() <= 4e-15);
            assert!((small.longest / size - found.longest).abs() <= 4e-15);
        }
    }
}

#[test]
fn pyramids_have_the_volume_of_their_map() {
    check(Shape::Pyramid, &[[0, 1, 2, 3, 4], [1, 2, 3, 0, 4], [2, 3, 0, 1, 4], [3, 0, 1, 2, 4]]);
}

#[test]
fn wedges_have_the_volume_of_their_map() {
    let numberings = [
        [0, 1, 2, 3, 4, 5],
        [1, 2, 0, 4, 5, 3],
        [2, 0, 1, 5, 3, 4],
        [3, 5, 4, 0, 2, 1],
        [5, 4, 3, 2, 1, 0],
        [4, 3, 5, 1, 0, 2],
    ];
    check(Shape::Wedge, &numberings);
}

#[test]
fn hexahedra_have_the_volume_of_their_map() {
    // The 24 rotations of a cube, made of two generators.
    let about_z = [1, 2, 3, 0, 5, 6, 7, 4];
    let about_x = [3, 2, 6, 7, 0, 1, 5, 4];
    let mut numberings = vec![[0, 1, 2, 3, 4, 5, 6, 7]];
    let mut next = 0;
    while next < numberings.len() {
        for generator in [about_z, about_x] {
            let image = generator.map(|i: usize| numberings[next][i]);
            if !numberings.contains(&image) {
                numberings.push(image);
            }
        }
        next += 1;
    }
    assert_eq!(numberings.len(), 24);
    check(Shape::Hexahedron, &numberings);
}

#[test]
fn a_mirrored_element_is_negative() {
    fn check<const N: usize>(shape: Shape) {
        let mut points = regular::<N>();
        let upright = geometry::of(shape, &points);
        points.iter_mut().for_each(|p| p[0] = -p[0]);
        let mirrored = geometry::of(shape, &points);
        assert_eq!((upright.sign, mirrored.sign), (1.0, -1.0), "{shape}");
        let solid = if shape.dimension() == 3 { -1.0 } else { 1.0 };
        assert_eq!(mirrored.extent, solid * upright.extent, "{shape}");
    }
    check::<3>(Shape::Triangle);
    check::<4>(Shape::Tetrahedron);
    check::<5>(Shape::Pyramid);
    check::<6>(Shape::Wedge);
    check::<8>(Shape::Hexahedron);
    let down = [SQUARE[3], SQUARE[2], SQUARE[1], SQUARE[0]];
    assert_eq!(geometry::of(Shape::Quadrilateral, &down).sign, -1.0);
    assert_eq!(geometry::of(Shape::Quadrilateral, &down).extent, 1.0);
}

#[test]
fn a_surface_that_stands_upright_has_no_sign() {
    let upright = SQUARE.map(|[x, y, _]| [0.6 * x, 0.8 * x, y]);
    let wall = geometry::of(Shape::Quadrilateral, &upright);
    assert_eq!((wall.sign, wall.degenerate), (0.0, false));
    assert!((wall.extent - 1.0).abs() <= 1e-15);
}

#[test]
fn edges_of_a_box() {
    let points = CUBE.map(|[x, y, z]| [x, 2.0 * y, 3.0 * z]);
    let element = geometry::of(Shape::Hexahedron, &points);
    assert_eq!((element.shortest, element.longest, element.extent), (1.0, 3.0, 6.0));
    assert!((element.size - (14.0_f64 / 3.0).sqrt()).abs() <= 1e-15);
}

#[test]
fn flat_and_collapsed_solids_are_degenerate() {
    let mut random = Random(22);
    for _ in 0..1000 {
        let slope = random.number();
        let flat = random.element::<8>(0.4).map(|[x, y, _]| [x, y, slope * x + 0.3 * y]);
        let element = geometry::of(Shape::Hexahedron, &flat);
        assert!(element.degenerate && element.sign == 0.0, "{flat:?}: {element:?}");
    }
    let mut collapsed = CUBE;
    collapsed[1] = collapsed[0];
    let element = geometry::of(Shape::Hexahedron, &collapsed);
    assert!(element.degenerate && element.sign == 1.0 && element.shortest == 0.0, "{element:?}");
}
