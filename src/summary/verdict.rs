//! The verdict: the preset `npl`, what the user asked for on the command line, and the true area or volume.

use std::borrow::Cow;

use super::{Expected, Reason, Status, Summary, Verdict};
use crate::mesh::Shape;

/// The report: under this a measure is 'bad enough to warrant further investigation'.
const INVESTIGATE: f64 = 0.1;

/// What a mesh is judged by.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Judgement {
    /// Limits of the user's own.
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
        let mut reasons = Vec::new();
        summary.expected = self.expectation.and_then(|e| expected(&e, summary));
        if let (Some(found), Some(asked)) = (&summary.expected, &self.expectation)
            && !found.within
        {
            reasons.push(Reason {
                rule: Cow::Borrowed(if asked.volume { "expected volume" } else { "expected area" }),
                status: Status::Fail,
                measure: None,
                shape: None,
                value: found.relative_error,
                limit: asked.tolerance_percent / 100.0,
                element: None,
            });
        }
        for (shape, found) in summary.main_shapes() {
            for (rule, count) in
                [("inverted elements", found.inverted), ("degenerate elements", found.degenerate)]
            {
                if count > 0 {
                    reasons.push(counted(rule, shape, count));
                }
            }
            for (code, measure) in &found.measures {
                let reason = |rule: &'static str, status, limit| Reason {
                    rule: Cow::Borrowed(rule),
                    status,
                    measure: Some(code.clone()),
                    shape: Some(shape),
                    value: measure.min,
                    limit,
                    element: Some(measure.min_element),
                };
                let asked = self.fail_under.iter().filter(|f| f.measure == *code && measure.min < f.value);
                reasons.extend(asked.map(|f| reason("fail under", Status::Fail, f.value)));
                if measure.min < INVESTIGATE {
                    reasons.push(reason("npl", Status::Warn, INVESTIGATE));
                }
            }
        }
        reasons.sort_by_key(|reason| std::cmp::Reverse(reason.status));
        let status = reasons.first().map_or(Status::Pass, |reason| reason.status);
        summary.verdict = Verdict { status, reasons };
    }
}

fn counted(rule: &'static str, shape: Shape, count: u64) -> Reason {
    Reason {
        rule: Cow::Borrowed(rule),
        status: Status::Fail,
        measure: None,
        shape: Some(shape),
        value: count as f64,
        limit: 0.0,
        element: None,
    }
}

fn expected(asked: &Expectation, summary: &Summary) -> Option<Expected> {
    let found = if asked.volume { summary.totals.volume } else { summary.totals.area }.unwrap_or(0.0);
    let relative_error = (found - asked.value) / asked.value;
    relative_error.is_finite().then(|| Expected {
        volume: asked.volume.then_some(asked.value),
        area: (!asked.volume).then_some(asked.value),
        relative_error,
        within: relative_error.abs() <= asked.tolerance_percent / 100.0,
    })
}
