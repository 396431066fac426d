//! Two summaries of one part, a base and a new one: what got better, what got worse.
//!
//! Every statistic is a [`Finding`] with what stood in the base, what stands in the new one, and how much may change.
//! High scores are good, so a score that fell is worse; a count of faults that grew is worse. Numbers of elements
//! and sizes are neither: they have changed. Only the shapes of the mesh's own dimension are compared, as for the verdict.
//!
//! What a mesher does differently from one version to the next must not cry wolf, and one new sliver must. So a
//! statistic of many elements (mean, quantiles, distance) has a narrow tolerance, that of a single one (the minimum) a
//! wide one, and each limit that somebody has given a meaning is watched by the number of values that lie clearly under it.

mod measure;
mod set;
mod tolerance;
mod whole;

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::mesh::Shape;
use crate::summary::{Status, Summary};

pub use set::{Comparisons, compare_sets};
pub use tolerance::{Tolerance, Tolerances};

/// The schema's name and version.
pub const SCHEMA: &str = "meshgauge.comparison/1";

/// What it came to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// Within the tolerance.
    Same,
    /// Over the tolerance, but neither better nor worse.
    Changed,
    /// Over the tolerance, to the good.
    Better,
    /// Over the tolerance, to the bad.
    Worse,
}

impl Outcome {
    /// The outcome as it stands in a comparison.
    pub const fn name(self) -> &'static str {
        match self {
            Outcome::Same => "same",
            Outcome::Changed => "changed",
            Outcome::Better => "better",
            Outcome::Worse => "worse",
        }
    }
}

/// Two meshes beside each other.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// The name that the two were paired by.
    pub name: String,
    /// The worst of the findings.
    pub outcome: Outcome,
    /// What it is compared with.
    pub base: Side,
    /// What is compared.
    pub new: Side,
    /// Every statistic: the mesh as a whole first, then shape by shape, measure by measure.
    pub findings: Vec<Finding>,
}

/// One of the two meshes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Side {
    /// The mesh's name.
    pub name: String,
    /// The path that it was scored from.
    pub path: String,
    /// XXH3 of the file: equal where it is the same file.
    pub xxh3: String,
    /// Number of elements of every kind.
    pub elements: u64,
    /// The verdict's status.
    pub status: Status,
}

/// One statistic in the base and in the new mesh.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    /// The shape, where the statistic is of one.
    pub shape: Option<Shape>,
    /// The measure's code, where the statistic is of one.
    pub measure: Option<String>,
    /// `min`, `mean`, `quantile 0.01`, `share under 0.1`, `wasserstein-1`, `volume`, `inverted`, ...
    pub statistic: Cow<'static, str>,
    /// In the base; `null` where there is none.
    pub base: Option<f64>,
    /// In the new mesh; `null` where there is none.
    pub new: Option<f64>,
    /// How much it may change.
    pub allowed: f64,
    /// What it comes to.
    pub outcome: Outcome,
    /// The element to look at, in the new mesh.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub element: Option<u64>,
}

impl Finding {
    /// A statistic of the mesh as a whole.
    fn of_mesh(statistic: &'static str, base: f64, new: f64, allowed: f64, outcome: Outcome) -> Self {
        let (base, new) = (Some(base), Some(new));
        let statistic = Cow::Borrowed(statistic);
        Self { shape: None, measure: None, statistic, base, new, allowed, outcome, element: None }
    }

    /// How much it changed; the distance itself where it is one.
    pub fn change(&self) -> Option<f64> {
        Some(self.new? - self.base.unwrap_or(0.0))
    }
}

/// Compares two meshes. `name` is what they are paired by.
pub fn compare(name: &str, base: &Summary, new: &Summary, tolerances: &Tolerances) -> Comparison {
    let mut findings = whole::findings(base, new, tolerances);
    findings.extend(measure::findings(base, new, tolerances));
    let outcome = findings.iter().map(|finding| finding.outcome).max().unwrap_or(Outcome::Same);
    Comparison { name: name.to_owned(), outcome, base: Side::of(base), new: Side::of(new), findings }
}

impl Comparison {
    /// The findings of one outcome.
    pub fn findings_that_are(&self, outcome: Outcome) -> impl Iterator<Item = &Finding> {
        self.findings.iter().filter(move |finding| finding.outcome == outcome)
    }
}

impl Side {
    fn of(summary: &Summary) -> Self {
        Self {
            name: summary.mesh.name.clone(),
            path: summary.mesh.path.clone(),
            xxh3: summary.mesh.xxh3.clone(),
            elements: summary.elements.count,
            status: summary.verdict.status,
        }
    }
}

/// A number of which more is better.
fn more_is_better(base: f64, new: f64, allowed: f64) -> Outcome {
    if new < base - allowed {
        Outcome::Worse
    } else if new > base + allowed {
        Outcome::Better
    } else {
        Outcome::Same
    }
}

/// A number of which less is better.
fn less_is_better(base: f64, new: f64, allowed: f64) -> Outcome {
    more_is_better(-base, -new, allowed)
}

/// A number that is neither good nor bad.
fn neither(base: f64, new: f64, allowed: f64) -> Outcome {
    if (new - base).abs() > allowed { Outcome::Changed } else { Outcome::Same }
}

#[cfg(test)]
mod tests;
