//! How much may change before it is called better or worse.

use serde::{Deserialize, Serialize};

/// What is allowed: the larger of the two.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tolerance {
    /// In the statistic's own unit.
    #[serde(default)]
    pub absolute: f64,
    /// As a share of the base.
    #[serde(default)]
    pub relative: f64,
}

impl Tolerance {
    /// The change that is allowed from `base`.
    pub fn allowed(self, base: f64) -> f64 {
        self.absolute.max(self.relative * base.abs())
    }
}

/// The tolerances of every statistic. Meshers place nodes a little differently from version to version; what that
/// alone does to a mesh lies within the defaults.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Tolerances {
    /// Of a minimum, and of a quantile that rests on fewer than ten values. Also how far under a limit a value lies
    /// before it counts as newly under it.
    pub minimum: Tolerance,
    /// Of a mean.
    pub mean: Tolerance,
    /// Of a quantile.
    pub quantile: Tolerance,
    /// Of the Wasserstein-1 distance between two histograms.
    pub distance: f64,
    /// Of the number of values under a limit, as a share of the base.
    pub under: f64,
    /// Of the number of findings of a check, as a share of the base.
    pub checks: f64,
    /// Of area and volume, as a share of the base.
    pub volume: f64,
    /// Of the number of nodes and elements and of sizes, as a share of the base. They are neither better nor worse.
    pub size: f64,
}

impl Tolerances {
    /// Whether every tolerance is a number from 0 up.
    pub fn is_sound(&self) -> bool {
        let pairs = [self.minimum, self.mean, self.quantile];
        let single = [self.distance, self.under, self.checks, self.volume, self.size];
        let all = pairs.into_iter().flat_map(|pair| [pair.absolute, pair.relative]).chain(single);
        all.into_iter().all(|number| number.is_finite() && number >= 0.0)
    }
}

impl Default for Tolerances {
    fn default() -> Self {
        Self {
            minimum: Tolerance { absolute: 0.05, relative: 0.3 },
            mean: Tolerance { absolute: 0.01, relative: 0.03 },
            quantile: Tolerance { absolute: 0.02, relative: 0.1 },
            distance: 0.02,
            under: 0.25,
            checks: 0.25,
            volume: 0.005,
            size: 0.2,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_larger_of_the_two_is_allowed() {
        let tolerance = Tolerance { absolute: 0.05, relative: 0.3 };
        for (base, allowed) in [(0.0, 0.05), (0.1, 0.05), (0.5, 0.15), (-0.5, 0.15)] {
            assert_eq!(tolerance.allowed(base), allowed, "{base}");
        }
    }
}
