//! The verdict: the preset `npl`, what the user asked for on the command line, and the true area or volume.
//!
//! Boundary shapes (of a lower dimension than the mesh) have no say. Reasons stand in this order: failures before
//! warnings; the expected area or volume first, then shape by shape, measure by measure.

use std::borrow::Cow;

use super::{Expected, MeasureSummary, Reason, Status, Summary, Verdict};
use crate::mesh::Shape;

/// Names of the rules, as they stand in a summary.
pub mod rules {
    /// Warns where the minimum of a measure is under 0.1.
    pub const NPL: &str = "npl";
    /// Fails where the minimum of a measure is under a limit of the user's.
    pub const FAIL_UNDER: &str = "fail under";
    /// Fails where elements are oriented against the rest.
    pub const INVERTED: &str = "inverted elements";
    /// Fails where elements have no area, no volume or an edge without length.
    pub const DEGENERATE: &str = "degenerate elements";
    /// Warns where no element of the mesh is one that a measure is defined for.
    pub const NOTHING_MEASURED: &str = "nothing measured";
    /// Fails where the volume is not what the user expects.
    pub const EXPECTED_VOLUME: &str = "expected volume";
    /// Fails where the area is not what the user expects.
    pub const EXPECTED_AREA: &str = "expected area";
}

/// The report: under this a measure is 'bad enough to warrant further investigation'.
const INVESTIGATE: f64 = 0.1;

/// What a mesh is judged by.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Judgement {
    /// Limits of the user's own; each takes the place of the preset's limit for its measure.
    pub fail_under: Vec<FailUnder>,
    /// The true area or volume.
    pub expectation: Option<Expectation>,
}

/// Fail where the minimum of a measure is under a value.
#[derive(Debug, Clone, PartialEq)]
pub struct FailUnder {
    /// The measure's code: `M31`.
    pub measure: String,
    /// The limit.
    pub value: f64,
}

/// The true area or volume of the domain, and how far off the mesh may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Expectation {
    /// Whether `value` is a volume; else it is an area.
    pub volume: bool,
    /// The true value.
    pub value: f64,
    /// Largest relative error, in per cent.
    pub tolerance_percent: f64,
}

impl Judgement {
    /// Fills `expected` and `verdict` of a summary.
    pub fn judge(&self, summary: &mut Summary) {
        summary.expected = self.expectation.map(|asked| asked.meet(summary));
        let mut reasons = Vec::new();
        if let (Some(found), Some(asked)) = (&summary.expected, &self.expectation)
            && !found.within
        {
            reasons.push(asked.missed(found.relative_error));
        }
        if summary.shapes.is_empty() {
            reasons.push(nothing_measured());
        }
        for (shape, found) in summary.main_shapes() {
            for (rule, count) in [(rules::INVERTED, found.inverted), (rules::DEGENERATE, found.degenerate)] {
                if count > 0 {
                    reasons.push(counted(rule, shape, count));
                }
            }
            for (code, measure) in &found.measures {
                reasons.extend(self.limits(code, measure, shape));
            }
        }
        reasons.sort_by_key(|reason| std::cmp::Reverse(reason.status()));
        let status = reasons.first().map_or(Status::Pass, Reason::status);
        summary.verdict = Verdict { status, reasons };
    }

    /// The limits that a measure is under: the user's own where there are any, else the preset's.
    fn limits(&self, code: &str, measure: &MeasureSummary, shape: Shape) -> Vec<Reason> {
        let mut limits: Vec<_> = self
            .fail_under
            .iter()
            .filter(|limit| limit.measure == code)
            .map(|limit| (rules::FAIL_UNDER, limit.value))
            .collect();
        if limits.is_empty() {
            limits.push((rules::NPL, INVESTIGATE));
        }
        limits.retain(|(_, limit)| measure.min < *limit);
        let reason = |(rule, limit)| Reason {
            rule: Cow::Borrowed(rule),
            measure: Some(code.to_owned()),
            shape: Some(shape),
            value: measure.min,
            limit,
            element: Some(measure.min_element),
        };
        limits.into_iter().map(reason).collect()
    }
}

impl Expectation {
    /// Compares the mesh with what is expected of it. A mesh without solids has the volume 0, one with solids the
    /// area 0: the user expects another kind of mesh, and that must not pass.
    fn meet(&self, summary: &Summary) -> Expected {
        let found = if self.volume { summary.totals.volume } else { summary.totals.area }.unwrap_or(0.0);
        let relative_error = relative_error(found, self.value);
        Expected {
            volume: self.volume.then_some(self.value),
            area: (!self.volume).then_some(self.value),
            relative_error,
            within: relative_error.abs() <= self.tolerance_percent / 100.0,
        }
    }

    fn missed(&self, relative_error: f64) -> Reason {
        Reason {
            rule: Cow::Borrowed(if self.volume { rules::EXPECTED_VOLUME } else { rules::EXPECTED_AREA }),
            measure: None,
            shape: None,
            value: relative_error,
            limit: self.tolerance_percent / 100.0,
            element: None,
        }
    }
}

/// (found - truth) / truth, always finite: JSON has no infinity, and a true value of 0 must not pass unseen.
fn relative_error(found: f64, truth: f64) -> f64 {
    let error = if found == truth { 0.0 } else { (found - truth) / truth };
    if error.is_nan() { f64::MAX } else { error.clamp(-f64::MAX, f64::MAX) }
}

fn nothing_measured() -> Reason {
    Reason {
        rule: Cow::Borrowed(rules::NOTHING_MEASURED),
        measure: None,
        shape: None,
        value: 0.0,
        limit: 1.0,
        element: None,
    }
}

fn counted(rule: &'static str, shape: Shape, count: u64) -> Reason {
    Reason {
        rule: Cow::Borrowed(rule),
        measure: None,
        shape: Some(shape),
        value: count as f64,
        limit: 0.0,
        element: None,
    }
}

#[cfg(test)]
mod tests;
