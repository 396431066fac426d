//! The verdict: the user's own rules, those of presets, and the true area or volume.
//!
//! Boundary shapes (of a lower dimension than the mesh) have no say. Reasons stand in this order: failures before
//! warnings; the expected area or volume first, then shape by shape, measure by measure, then checks.

use super::rule::{PRESETS, Rule, Statistic, Subject, preset};
use super::{Checks, Expected, MeasureSummary, Reason, Status, Summary, Verdict};
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

    /// Whether the rule's name alone tells how bad it is to break it.
    pub(super) fn has_own_status(name: &str) -> bool {
        matches!(
            name,
            NPL | FAIL_UNDER | INVERTED | DEGENERATE | NOTHING_MEASURED | EXPECTED_VOLUME | EXPECTED_AREA
        )
    }
}

/// What a mesh is judged by.
#[derive(Debug, Clone, PartialEq)]
pub struct Judgement {
    /// Rules of the user's own; those of presets do not hold for a measure of a shape that one of these is about.
    pub rules: Vec<Rule>,
    /// Names of the presets that hold, out of [`PRESETS`].
    pub presets: Vec<&'static str>,
    /// The true area or volume.
    pub expectation: Option<Expectation>,
}

impl Default for Judgement {
    fn default() -> Self {
        Self { rules: Vec::new(), presets: vec![PRESETS[0].name], expectation: None }
    }
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
                let broken =
                    self.rules_about(code, shape).into_iter().filter(|rule| is_broken(rule, measure));
                reasons.extend(worst_of(broken.collect()).map(|rule| reason(rule, code, shape, measure)));
            }
        }
        reasons.extend(self.rules.iter().filter_map(|rule| check(rule, &summary.checks)));
        reasons.sort_by_key(|reason| std::cmp::Reverse(reason.status()));
        let status = reasons.first().map_or(Status::Pass, Reason::status);
        summary.verdict = Verdict { status, reasons };
    }

    /// The rules that a measure is under: the user's own where there are any, else the presets'.
    fn rules_about(&self, code: &str, shape: Shape) -> Vec<&Rule> {
        let own: Vec<_> = self.rules.iter().filter(|rule| rule.is_about(code, shape)).collect();
        if !own.is_empty() {
            return own;
        }
        let presets = self.presets.iter().filter_map(|name| preset(name));
        presets.flat_map(|preset| preset.rules).filter(|rule| rule.is_about(code, shape)).collect()
    }

    /// The values of a measure that the number of smaller ones is asked for, in ascending order.
    pub fn thresholds(&self, code: &str, shape: Shape) -> Vec<f64> {
        let counted =
            |rule: &&Rule| matches!(rule.statistic, Statistic::ShareBelow(_) | Statistic::CountBelow(_));
        let mut limits: Vec<_> =
            self.rules_about(code, shape).into_iter().filter(counted).map(|rule| rule.limit).collect();
        limits.sort_by(f64::total_cmp);
        limits.dedup();
        limits
    }

    /// The probabilities that a measure's quantiles are asked for, besides those that every summary has.
    pub fn probabilities(&self, code: &str, shape: Shape) -> Vec<f64> {
        let rules = self.rules_about(code, shape).into_iter();
        rules
            .filter_map(|rule| if let Statistic::Quantile(p) = rule.statistic { Some(p) } else { None })
            .collect()
    }
}

/// What a measure has to show for a rule: the value and what it may be; nothing where the summary does not know.
fn shown(rule: &Rule, measure: &MeasureSummary) -> Option<(f64, f64)> {
    let below = || measure.below.get(&rule.limit.to_string()).map(|count| *count as f64);
    match rule.statistic {
        Statistic::Min => Some((measure.min, rule.limit)),
        Statistic::Max => Some((measure.max, rule.limit)),
        Statistic::Mean => Some((measure.mean, rule.limit)),
        Statistic::Quantile(p) => measure.quantiles.get(&p.to_string()).map(|value| (*value, rule.limit)),
        Statistic::ShareBelow(allowed) => below().map(|count| (count / measure.count as f64, allowed)),
        Statistic::CountBelow(allowed) => below().map(|count| (count, allowed as f64)),
        Statistic::Count => None,
    }
}

fn is_broken(rule: &Rule, measure: &MeasureSummary) -> bool {
    shown(rule, measure).is_some_and(|(value, limit)| match rule.statistic {
        Statistic::ShareBelow(_) | Statistic::CountBelow(_) => value > limit,
        _ => value < limit,
    })
}

/// One value, one reason: a warning is not told beside a failure for the same statistic.
fn worst_of(broken: Vec<&Rule>) -> impl Iterator<Item = &Rule> {
    let fails = |statistic: Statistic| {
        let same =
            |rule: &&Rule| std::mem::discriminant(&rule.statistic) == std::mem::discriminant(&statistic);
        broken.iter().filter(|rule| same(rule)).any(|rule| rule.status == Status::Fail)
    };
    let told: Vec<_> =
        broken.iter().copied().filter(|rule| rule.status == Status::Fail || !fails(rule.statistic)).collect();
    told.into_iter()
}

fn reason(rule: &Rule, code: &str, shape: Shape, measure: &MeasureSummary) -> Reason {
    let (value, limit) = shown(rule, measure).unwrap_or_default();
    let counted = matches!(rule.statistic, Statistic::ShareBelow(_) | Statistic::CountBelow(_));
    Reason {
        measure: Some(code.to_owned()),
        shape: Some(shape),
        value,
        limit,
        element: Some(measure.min_element),
        statistic: rule.statistic.described(),
        threshold: counted.then_some(rule.limit),
        status: (!rules::has_own_status(&rule.name)).then_some(rule.status),
        ..Reason::of(rule.name.clone())
    }
}

/// The reason why a rule about a check is broken, if it is.
fn check(rule: &Rule, checks: &Checks) -> Option<Reason> {
    let Subject::Check(name) = &rule.subject else { return None };
    let count = checks.get(name)?;
    (count as f64 > rule.limit).then(|| Reason {
        measure: Some(name.to_string()),
        value: count as f64,
        limit: rule.limit,
        statistic: rule.statistic.described(),
        status: Some(rule.status),
        ..Reason::of(rule.name.clone())
    })
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
            value: relative_error,
            limit: self.tolerance_percent / 100.0,
            ..Reason::of(if self.volume { rules::EXPECTED_VOLUME } else { rules::EXPECTED_AREA })
        }
    }
}

/// (found - truth) / truth, always finite: JSON has no infinity, and a true value of 0 must not pass unseen.
fn relative_error(found: f64, truth: f64) -> f64 {
    let error = if found == truth { 0.0 } else { (found - truth) / truth };
    if error.is_nan() { f64::MAX } else { error.clamp(-f64::MAX, f64::MAX) }
}

fn nothing_measured() -> Reason {
    Reason { limit: 1.0, ..Reason::of(rules::NOTHING_MEASURED) }
}

fn counted(rule: &'static str, shape: Shape, count: u64) -> Reason {
    Reason { shape: Some(shape), value: count as f64, ..Reason::of(rule) }
}

#[cfg(test)]
mod tests;
