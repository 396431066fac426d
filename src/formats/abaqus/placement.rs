//! Where nodes come to stand: coordinate systems of `*NODE`, the local frame of `*SYSTEM`, the motion of `*INSTANCE`.

use crate::formats::axes::{cross, minus, sin_cos, unit};

/// The coordinate system of a `*NODE` block. Angles are in degrees.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) enum System {
    /// x, y, z.
    #[default]
    Rectangular,
    /// Radius, angle about z from x, z.
    Cylindrical,
    /// Radius, angle about z from x, angle from the x-y plane towards z.
    Spherical,
}

impl System {
    /// The system that `SYSTEM=` names, in capitals: its first letter tells.
    pub(super) fn named(name: &[u8]) -> Option<Self> {
        let systems = [
            ("RECTANGULAR", Self::Rectangular),
            ("CYLINDRICAL", Self::Cylindrical),
            ("SPHERICAL", Self::Spherical),
        ];
        let found = |(known, _): &&(&str, Self)| !name.is_empty() && known.as_bytes().starts_with(name);
        systems.iter().find(found).map(|(_, system)| *system)
    }

    fn rectangular(self, p: [f64; 3]) -> [f64; 3] {
        match self {
            System::Rectangular => p,
            System::Cylindrical => {
                let (sin, cos) = sin_cos(p[1]);
                [p[0] * cos, p[0] * sin, p[2]]
            }
            System::Spherical => {
                let ((sin, cos), (up, out)) = (sin_cos(p[1]), sin_cos(p[2]));
                [p[0] * out * cos, p[0] * out * sin, p[0] * up]
            }
        }
    }
}

/// A linear map and a shift after it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Affine {
    /// Rows of the map; `None` is the identity.
    rows: Option<[[f64; 3]; 3]>,
    shift: [f64; 3],
}

impl Affine {
    /// Leaves everything where it is.
    pub(super) const IDENTITY: Affine = Affine { rows: None, shift: [0.0; 3] };

    /// The frame of `*SYSTEM`: origin a, b on its x axis, c in its x-y plane on the side of y. Without c its x axis is
    /// that to b, projected onto the global x-y plane, and its z axis the global one. `None` where the points make no
    /// frame.
    pub(super) fn frame(a: [f64; 3], b: Option<[f64; 3]>, c: Option<[f64; 3]>) -> Option<Affine> {
        let Some(b) = b else { return Some(Affine { rows: None, shift: a }) };
        let (x, z) = match c {
            None => (unit([b[0] - a[0], b[1] - a[1], 0.0])?, [0.0, 0.0, 1.0]),
            Some(c) => {
                let x = unit(minus(b, a))?;
                (x, unit(cross(x, minus(c, a)))?)
            }
        };
        let y = cross(z, x);
        let rows = [0, 1, 2].map(|k| [x[k], y[k], z[k]]);
        Some(Affine { rows: Some(rows), shift: a })
    }

    /// The motion of `*INSTANCE`: first the shift, then a turn by `degrees` about the axis from a to b. `None` where a
    /// and b are one point.
    pub(super) fn motion(shift: [f64; 3], turn: Option<([f64; 3], [f64; 3], f64)>) -> Option<Affine> {
        let Some((a, b, degrees)) = turn else { return Some(Affine { rows: None, shift }) };
        if degrees == 0.0 {
            return Some(Affine { rows: None, shift });
        }
        let k = unit(minus(b, a))?;
        let (sin, cos) = sin_cos(degrees);
        let rows = [0, 1, 2].map(|i| {
            let cross = [[0.0, -k[2], k[1]], [k[2], 0.0, -k[0]], [-k[1], k[0], 0.0]][i];
            [0, 1, 2].map(|j| {
                let unit = if i == j { cos + (1.0 - cos) * k[i] * k[i] } else { (1.0 - cos) * k[i] * k[j] };
                unit + sin * cross[j]
            })
        });
        // R (p + shift - a) + a = R p + (R (shift - a) + a)
        let arm = Affine { rows: Some(rows), shift: a }.apply(minus(shift, a));
        Some(Affine { rows: Some(rows), shift: arm })
    }

    pub(super) fn apply(&self, p: [f64; 3]) -> [f64; 3] {
        let t = self.shift;
        match &self.rows {
            None => [p[0] + t[0], p[1] + t[1], p[2] + t[2]],
            Some(rows) => [0, 1, 2].map(|i| rows[i][0] * p[0] + rows[i][1] * p[1] + rows[i][2] * p[2] + t[i]),
        }
    }
}

/// All that is done to the coordinates of a `*NODE` block.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placement {
    pub(super) system: System,
    pub(super) frame: Affine,
    pub(super) motion: Affine,
}

impl Placement {
    /// Whether coordinates stay as they are written.
    pub(super) fn is_identity(&self) -> bool {
        self.system == System::Rectangular
            && self.frame == Affine::IDENTITY
            && self.motion == Affine::IDENTITY
    }

    /// Where a node with these coordinates stands.
    pub(super) fn apply(&self, p: [f64; 3]) -> [f64; 3] {
        self.motion.apply(self.frame.apply(self.system.rectangular(p)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_near(found: [f64; 3], expected: [f64; 3]) {
        for k in 0..3 {
            assert!((found[k] - expected[k]).abs() < 1e-12, "{found:?} is not {expected:?}");
        }
    }

    #[test]
    fn an_instance_is_shifted_first_and_turned_then() {
        let turn = Some(([10.0, 0.0, 0.0], [10.0, 0.0, 1.0], 90.0));
        let motion = Affine::motion([10.0, 0.0, 0.0], turn).expect("an axis");
        assert_near(motion.apply([1.0, 0.0, 0.0]), [10.0, 1.0, 0.0]);
        let turn = Some(([0.0; 3], [2.0, 2.0, 2.0], 120.0));
        assert_near(Affine::motion([0.0; 3], turn).expect("an axis").apply([1.0, 2.0, 3.0]), [3.0, 1.0, 2.0]);
        assert!(Affine::motion([0.0; 3], Some(([1.0; 3], [1.0; 3], 5.0))).is_none());
    }

    #[test]
    fn frames_of_one_two_and_three_points() {
        let a = [1.0, 2.0, 3.0];
        assert_near(Affine::frame(a, None, None).expect("a shift").apply([1.0, 1.0, 1.0]), [2.0, 3.0, 4.0]);
        let up = Affine::frame(a, Some([1.0, 5.0, 9.0]), None).expect("a frame");
        assert_near(up.apply([1.0, 0.0, 1.0]), [1.0, 3.0, 4.0]);
        let tilted = Affine::frame([0.0; 3], Some([0.0, 0.0, 2.0]), Some([0.0, 3.0, 7.0])).expect("a frame");
        assert_near(tilted.apply([1.0, 2.0, 3.0]), [-3.0, 2.0, 1.0]);
        assert!(Affine::frame(a, Some(a), None).is_none());
        assert!(Affine::frame(a, Some([2.0, 2.0, 3.0]), Some([5.0, 2.0, 3.0])).is_none());
    }

    #[test]
    fn angles_are_degrees() {
        assert_near(System::Cylindrical.rectangular([2.0, 90.0, 5.0]), [0.0, 2.0, 5.0]);
        assert_near(System::Cylindrical.rectangular([2.0, -30.0, 0.0]), [3f64.sqrt(), -1.0, 0.0]);
        assert_near(System::Spherical.rectangular([2.0, 0.0, 90.0]), [0.0, 0.0, 2.0]);
        assert_near(System::Spherical.rectangular([2.0, 90.0, 30.0]), [0.0, 3f64.sqrt(), 1.0]);
    }

    #[test]
    fn systems_by_letter_or_name() {
        assert_eq!(System::named(b"C"), Some(System::Cylindrical));
        assert_eq!(System::named(b"SPHERICAL"), Some(System::Spherical));
        for name in [&b""[..], b"X", b"CYL1"] {
            assert_eq!(System::named(name), None);
        }
    }
}
