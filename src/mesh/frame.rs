//! The coordinates that measures look at: the file's own, or those that the solver works in.
//!
//! The report's two caveats: axes of an anisotropic problem want rescaling before shapes are judged (section 2.1), and a
//! mesh for cylindrical coordinates is poor in x, y, z and good in r, θ, z (section 5.6).

use std::f64::consts::{PI, TAU};
use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::Shape;

/// The coordinates that measures look at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// The system of coordinates.
    pub system: System,
    /// What each coordinate of the system is multiplied by.
    pub stretch: [f64; 3],
}

/// A system of coordinates; as text it is what users type.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum System {
    /// x, y, z as the file has them.
    Cartesian,
    /// Distance from an axis, angle round it in radians, height along it.
    Cylindrical {
        /// The direction of the axis.
        axis: Axis,
        /// A point that the axis goes through.
        through: [f64; 3],
    },
}

/// A coordinate axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Axis {
    X,
    Y,
    Z,
}

/// A corner nearer to the axis than this share of the element's farthest corner is on the axis and has no angle.
const ON_AXIS: f64 = 1e-9;

impl Frame {
    /// The file's own coordinates.
    pub const OWN: Frame = Frame { system: System::Cartesian, stretch: [1.0; 3] };

    /// Puts the first `n` elements, given by their corners side by side, into the frame. Gives the number of elements
    /// that enclose the axis: they have no image in cylindrical coordinates, where each is cut open at the widest gap
    /// between its corners.
    pub fn apply<const LANES: usize>(&self, corners: &mut [[[f64; LANES]; 3]], n: usize) -> u64 {
        let mut enclosing = 0;
        if let System::Cylindrical { axis, through } = self.system {
            for lane in 0..n {
                enclosing += u64::from(unroll(corners, lane, axis, through));
            }
        }
        for corner in corners {
            for (row, factor) in corner.iter_mut().zip(self.stretch) {
                row[..n].iter_mut().for_each(|value| *value *= factor);
            }
        }
        enclosing
    }
}

/// Turns the corners of one element into r, θ, height; whether the element encloses the axis.
///
/// Angles are a period apart, so an element across the cut of the angle is closed by moving corners a turn on. A corner
/// on the axis has every angle: it takes the mean of the others.
fn unroll<const LANES: usize>(
    corners: &mut [[[f64; LANES]; 3]],
    lane: usize,
    axis: Axis,
    through: [f64; 3],
) -> bool {
    let [first, second, along] = match axis {
        Axis::X => [1, 2, 0],
        Axis::Y => [2, 0, 1],
        Axis::Z => [0, 1, 2],
    };
    let mut polar = [[0.0; 3]; Shape::MAX_CORNERS];
    let polar = &mut polar[..corners.len()];
    for (polar, corner) in polar.iter_mut().zip(corners.iter()) {
        let [a, b, height] = [first, second, along].map(|k| corner[k][lane] - through[k]);
        *polar = [a.hypot(b), b.atan2(a), height];
    }
    let farthest = polar.iter().fold(0.0_f64, |r, corner| r.max(corner[0]));
    let off_axis = |corner: &[f64; 3]| corner[0] > ON_AXIS * farthest;
    let (start, gap) = widest_gap(polar.iter().filter(|corner| off_axis(corner)).map(|corner| corner[1]));
    let (mut sum, mut count) = (0.0, 0.0);
    for corner in polar.iter_mut().filter(|corner| off_axis(corner)) {
        if corner[1] < start {
            corner[1] += TAU;
        }
        sum += corner[1];
        count += 1.0;
    }
    for corner in polar.iter_mut().filter(|corner| !off_axis(corner)) {
        *corner = [0.0, if count > 0.0 { sum / count } else { 0.0 }, corner[2]];
    }
    for (corner, polar) in corners.iter_mut().zip(polar.iter()) {
        (0..3).for_each(|k| corner[k][lane] = polar[k]);
    }
    // A little over half a turn by rounding is a flat side on the axis.
    gap < PI * (1.0 - ON_AXIS)
}

/// The widest gap between angles on the circle, and the angle after it.
fn widest_gap(angles: impl Iterator<Item = f64>) -> (f64, f64) {
    let mut sorted = [0.0; Shape::MAX_CORNERS];
    let mut n = 0;
    for angle in angles {
        sorted[n] = angle;
        n += 1;
    }
    let sorted = &mut sorted[..n];
    sorted.sort_unstable_by(f64::total_cmp);
    let (Some(first), Some(last)) = (sorted.first(), sorted.last()) else { return (-PI, TAU) };
    let across = (*first, first + TAU - last);
    let gaps = sorted.windows(2).map(|pair| (pair[1], pair[1] - pair[0]));
    gaps.fold(across, |widest, gap| if gap.1 > widest.1 { gap } else { widest })
}

/// As it is typed: `cartesian`, `cylindrical:z`, `cylindrical:x@0,10,0`.
impl fmt::Display for System {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            System::Cartesian => f.write_str("cartesian"),
            System::Cylindrical { axis, through } => {
                let axis = match axis {
                    Axis::X => "x",
                    Axis::Y => "y",
                    Axis::Z => "z",
                };
                write!(f, "cylindrical:{axis}")?;
                let [a, b, c] = through;
                if *through == [0.0; 3] { Ok(()) } else { write!(f, "@{a},{b},{c}") }
            }
        }
    }
}

impl From<System> for String {
    fn from(system: System) -> Self {
        system.to_string()
    }
}

impl TryFrom<String> for System {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl FromStr for System {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || {
            format!("expected cartesian, or cylindrical[:AXIS[@X,Y,Z]] with AXIS x, y or z, found \"{text}\"")
        };
        let (name, rest) = text.split_once(':').map_or((text, None), |(name, rest)| (name, Some(rest)));
        match (name, rest) {
            ("cartesian", None) => Ok(System::Cartesian),
            ("cylindrical", None) => Ok(System::Cylindrical { axis: Axis::Z, through: [0.0; 3] }),
            ("cylindrical", Some(rest)) => {
                let (axis, through) = rest.split_once('@').map_or((rest, None), |(a, p)| (a, Some(p)));
                let axis = match axis {
                    "x" => Axis::X,
                    "y" => Axis::Y,
                    "z" => Axis::Z,
                    _ => return Err(wrong()),
                };
                let through = through.map_or(Some([0.0; 3]), three).ok_or_else(wrong)?;
                Ok(System::Cylindrical { axis, through })
            }
            _ => Err(wrong()),
        }
    }
}

/// Three finite numbers with commas between.
pub fn three(text: &str) -> Option<[f64; 3]> {
    let mut numbers =
        text.split(',').map(|number| number.trim().parse().ok().filter(|n: &f64| n.is_finite()));
    let three = [numbers.next()??, numbers.next()??, numbers.next()??];
    numbers.next().is_none().then_some(three)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn put<const CORNERS: usize>(system: &str, points: [[f64; 3]; CORNERS]) -> ([[f64; 3]; CORNERS], bool) {
        let frame = Frame { system: system.parse().expect("a system"), stretch: [1.0; 3] };
        let mut corners = points.map(|p| p.map(|value| [value]));
        let enclosing = frame.apply(&mut corners, 1);
        (corners.map(|p| p.map(|[value]| value)), enclosing == 1)
    }

    fn at(r: f64, degrees: f64, z: f64) -> [f64; 3] {
        let (s, c) = degrees.to_radians().sin_cos();
        [r * c, r * s, z]
    }

    fn is_near(found: &[[f64; 3]], expected: &[[f64; 3]]) -> bool {
        found.iter().flatten().zip(expected.iter().flatten()).all(|(a, b)| (a - b).abs() < 1e-12)
    }

    #[test]
    fn an_element_across_the_cut_of_the_angle_is_as_narrow_as_any_other() {
        let (across, enclosing) =
            put("cylindrical", [at(2.0, 170.0, 0.0), at(3.0, -170.0, 0.0), at(2.0, -170.0, 1.0)]);
        assert!(!enclosing);
        let [a, b] = [170.0_f64, 190.0].map(f64::to_radians);
        assert!(is_near(&across, &[[2.0, a, 0.0], [3.0, b, 0.0], [2.0, b, 1.0]]), "{across:?}");
    }

    #[test]
    fn a_corner_on_the_axis_takes_the_mean_angle_of_the_others() {
        let (wedge, enclosing) =
            put("cylindrical:z", [[1e-14, 0.0, 4.0], at(2.0, 170.0, 4.0), at(2.0, -170.0, 4.0)]);
        assert!(!enclosing);
        let [a, b] = [170.0_f64, 190.0].map(f64::to_radians);
        assert!(is_near(&wedge, &[[0.0, PI, 4.0], [2.0, a, 4.0], [2.0, b, 4.0]]), "{wedge:?}");
        let (line, enclosing) = put("cylindrical", [[0.0; 3], [0.0, 0.0, 1.0]]);
        assert!(!enclosing && is_near(&line, &[[0.0; 3], [0.0, 0.0, 1.0]]));
    }

    #[test]
    fn an_element_round_the_axis_is_told() {
        let round = [at(1.0, 0.0, 0.0), at(1.0, 130.0, 0.0), at(1.0, 250.0, 0.0)];
        assert!(put("cylindrical", round).1);
        assert!(!put("cylindrical:z@9,9,0", round).1);
        // The axis lies in a side.
        assert!(!put("cylindrical", [at(1.0, 0.0, 0.0), at(1.0, 180.0, 0.0), at(1.0, 90.0, 0.0)]).1);
    }

    #[test]
    fn every_axis_turns_the_same_way() {
        for (system, point) in [
            ("cylindrical:x", [7.0, 0.0, 2.0]),
            ("cylindrical:y", [2.0, 7.0, 0.0]),
            ("cylindrical:z", [0.0, 2.0, 7.0]),
        ] {
            let (found, _) = put(system, [point]);
            assert!(is_near(&found, &[[2.0, PI / 2.0, 7.0]]), "{system} {found:?}");
        }
        let (found, _) = put("cylindrical:y@1,1,1", [[3.0, 8.0, 1.0]]);
        assert!(is_near(&found, &[[2.0, PI / 2.0, 7.0]]), "{found:?}");
    }

    #[test]
    fn systems_read_back_and_others_are_refused() {
        for text in ["cartesian", "cylindrical:z", "cylindrical:x@0,10.5,-3"] {
            assert_eq!(text.parse::<System>().expect("a system").to_string(), text);
        }
        for text in [
            "",
            "polar",
            "cylindrical:",
            "cylindrical:w",
            "cylindrical:z@1,2",
            "cylindrical:z@1,2,nan",
            "cartesian:z",
        ] {
            assert!(text.parse::<System>().is_err(), "{text}");
        }
    }

    #[test]
    fn turning_an_elements_numbering_changes_only_its_order() {
        let tet = [at(1.0, 100.0, 0.0), at(2.0, 200.0, 1.0), at(3.0, 230.0, 0.0), at(0.5, 160.0, 2.0)];
        let (first, _) = put("cylindrical", tet);
        for turn in 1..4 {
            let mut turned = tet;
            turned.rotate_left(turn);
            let (mut found, _) = put("cylindrical", turned);
            found.rotate_right(turn);
            assert_eq!(found, first);
        }
    }
}
