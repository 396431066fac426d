//! A coordinate system: rectangular, cylindrical or spherical, somewhere in the basic one. Angles are in degrees.

use crate::formats::axes::{cross, minus, sin_cos, unit};

/// How the three coordinates of a system are meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Axes {
    /// x, y, z.
    Rectangular,
    /// Radius, angle about z from x, z.
    Cylindrical,
    /// Radius, angle from z, angle about z from x.
    Spherical,
}

impl Axes {
    fn rectangular(self, p: [f64; 3]) -> [f64; 3] {
        match self {
            Axes::Rectangular => p,
            Axes::Cylindrical => {
                let (sin, cos) = sin_cos(p[1]);
                [p[0] * cos, p[0] * sin, p[2]]
            }
            Axes::Spherical => {
                let ((out, up), (sin, cos)) = (sin_cos(p[1]), sin_cos(p[2]));
                [p[0] * out * cos, p[0] * out * sin, p[0] * up]
            }
        }
    }
}

/// A coordinate system in terms of the basic one.
#[derive(Debug)]
pub(super) struct Frame {
    axes: Axes,
    origin: [f64; 3],
    /// Unit vectors along x, y and z.
    units: [[f64; 3]; 3],
}

impl Frame {
    /// The system with its origin in `a`, `b` on its z axis, and `c` in the x-z plane on the side of x. `None` where the
    /// points do not span a plane.
    pub(super) fn through(axes: Axes, a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> Option<Frame> {
        let z = unit(minus(b, a))?;
        let y = unit(cross(z, minus(c, a)))?;
        Some(Frame { axes, origin: a, units: [cross(y, z), y, z] })
    }

    /// A point of this system in the basic one.
    pub(super) fn to_basic(&self, point: [f64; 3]) -> [f64; 3] {
        let p = self.axes.rectangular(point);
        let [x, y, z] = &self.units;
        [0, 1, 2].map(|k| self.origin[k] + p[0] * x[k] + p[1] * y[k] + p[2] * z[k])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn assert_near(found: [f64; 3], expected: [f64; 3]) {
        for k in 0..3 {
            assert!((found[k] - expected[k]).abs() < 1e-12, "{found:?} is not {expected:?}");
        }
    }

    #[test]
    fn points_of_each_kind_of_system() {
        let basic = |axes| Frame::through(axes, [0.0; 3], [0.0, 0.0, 2.0], [3.0, 0.0, 5.0]).expect("a plane");
        assert_near(basic(Axes::Rectangular).to_basic([1.0, 2.0, 3.0]), [1.0, 2.0, 3.0]);
        assert_near(basic(Axes::Cylindrical).to_basic([2.0, 90.0, 5.0]), [0.0, 2.0, 5.0]);
        assert_near(basic(Axes::Cylindrical).to_basic([2.0, -30.0, 0.0]), [3f64.sqrt(), -1.0, 0.0]);
        assert_near(basic(Axes::Spherical).to_basic([2.0, 90.0, 0.0]), [2.0, 0.0, 0.0]);
        assert_near(basic(Axes::Spherical).to_basic([2.0, 30.0, 90.0]), [0.0, 1.0, 3f64.sqrt()]);
    }

    #[test]
    fn a_system_that_lies_elsewhere() {
        let frame = Frame::through(Axes::Rectangular, [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, 5.0, 0.0]);
        // z along x, x along y, y along z.
        assert_near(frame.expect("a plane").to_basic([1.0, 2.0, 3.0]), [4.0, 1.0, 2.0]);
        assert!(Frame::through(Axes::Rectangular, [0.0; 3], [0.0; 3], [1.0, 0.0, 0.0]).is_none());
        assert!(Frame::through(Axes::Rectangular, [0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]).is_none());
    }
}
