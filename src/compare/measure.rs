//! The statistics of one measure on one shape.

use std::borrow::Cow;

use super::{Finding, Outcome, Tolerances, more_is_better};
use crate::measures::find;
use crate::mesh::Shape;
use crate::statistics::shift;
use crate::summary::{MeasureSummary, Summary};

/// The report: under this a measure is 'bad enough to warrant further investigation'.
const INVESTIGATE: f64 = 0.1;

/// A quantile that fewer values than this lie under is as uncertain as a minimum.
const FEW: f64 = 10.0;

/// The statistics of every measure that both meshes have on the same shape.
pub fn findings(base: &Summary, new: &Summary, tolerances: &Tolerances) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (shape, of_new) in new.main_shapes() {
        let Some((_, of_base)) = base.main_shapes().find(|(found, _)| *found == shape) else { continue };
        for (code, new) in &of_new.measures {
            if let Some(base) = of_base.measures.get(code) {
                let pair = Pair { shape, code, base, new, tolerances };
                findings.extend(pair.findings());
            }
        }
    }
    findings
}

/// One measure in both meshes.
struct Pair<'a> {
    shape: Shape,
    code: &'a str,
    base: &'a MeasureSummary,
    new: &'a MeasureSummary,
    tolerances: &'a Tolerances,
}

impl Pair<'_> {
    fn findings(&self) -> Vec<Finding> {
        let mut findings = vec![self.minimum()];
        findings.extend(limits(self.code).into_iter().filter_map(|limit| self.under(limit)));
        findings.extend(self.quantiles());
        findings.push(self.mean());
        findings.extend(self.distance());
        findings
    }

    fn minimum(&self) -> Finding {
        let allowed = self.tolerances.minimum.allowed(self.base.min);
        let outcome = more_is_better(self.base.min, self.new.min, allowed);
        Finding {
            element: Some(self.new.min_element),
            ..self.finding("min", self.base.min, self.new.min, allowed, outcome)
        }
    }

    fn mean(&self) -> Finding {
        let allowed = self.tolerances.mean.allowed(self.base.mean);
        let outcome = more_is_better(self.base.mean, self.new.mean, allowed);
        self.finding("mean", self.base.mean, self.new.mean, allowed, outcome)
    }

    fn quantiles(&self) -> Vec<Finding> {
        let finding = |(probability, &base): (&String, &f64)| {
            let new = *self.new.quantiles.get(probability)?;
            let fewest = self.base.count.min(self.new.count) as f64;
            let rests_on = probability.parse::<f64>().unwrap_or(0.0) * fewest;
            let tolerance = if rests_on < FEW { self.tolerances.minimum } else { self.tolerances.quantile };
            let allowed = tolerance.allowed(base);
            let outcome = more_is_better(base, new, allowed);
            Some(self.finding(format!("quantile {probability}"), base, new, allowed, outcome))
        };
        self.base.quantiles.iter().filter_map(finding).collect()
    }

    /// The share of values under a limit. It is worse where more values lie clearly under the limit in the new mesh
    /// than lay under it at all in the base: a value that slips from just over to just under it is jitter.
    fn under(&self, limit: f64) -> Option<Finding> {
        let clearly = limit - self.tolerances.minimum.allowed(limit);
        let (all_base, all_new) = (self.base.count as f64, self.new.count as f64);
        let (base, new) = (under(self.base, limit)?, under(self.new, limit)?);
        let (base_clearly, new_clearly) = (under(self.base, clearly)?, under(self.new, clearly)?);
        // A finer mesh may have as many more as it has elements; a coarser one need not have fewer.
        let finer = (all_new / all_base).max(1.0) * (1.0 + self.tolerances.under);
        let coarser = (all_base / all_new).max(1.0) * (1.0 + self.tolerances.under);
        let outcome = if new_clearly > base * finer {
            Outcome::Worse
        } else if base_clearly > new * coarser {
            Outcome::Better
        } else {
            Outcome::Same
        };
        let allowed = (base * finer - base) / all_new;
        let found =
            self.finding(format!("share under {limit}"), base / all_base, new / all_new, allowed, outcome);
        Some(Finding { element: (outcome == Outcome::Worse).then_some(self.new.min_element), ..found })
    }

    fn distance(&self) -> Option<Finding> {
        let shift = shift(&self.base.histogram, &self.new.histogram)?;
        let allowed = self.tolerances.distance;
        let outcome = if shift.down > allowed {
            Outcome::Worse
        } else if shift.up > allowed {
            Outcome::Better
        } else {
            Outcome::Same
        };
        let found = self.finding("wasserstein-1", 0.0, shift.distance(), allowed, outcome);
        Some(Finding { base: None, ..found })
    }

    fn finding(
        &self,
        statistic: impl Into<Cow<'static, str>>,
        base: f64,
        new: f64,
        allowed: f64,
        outcome: Outcome,
    ) -> Finding {
        Finding {
            shape: Some(self.shape),
            measure: Some(self.code.to_owned()),
            statistic: statistic.into(),
            base: Some(base),
            new: Some(new),
            allowed,
            outcome,
            element: None,
        }
    }
}

/// The limits of a measure that somebody has given a meaning, from the lowest.
fn limits(code: &str) -> Vec<f64> {
    let known = find(code).map(|measure| measure.thresholds).unwrap_or_default();
    let mut limits: Vec<f64> = known.iter().map(|threshold| threshold.value).chain([INVESTIGATE]).collect();
    limits.sort_by(f64::total_cmp);
    limits.dedup();
    limits
}

/// The number of values in the bins that lie wholly under a limit; `None` without values.
fn under(measure: &MeasureSummary, limit: f64) -> Option<f64> {
    let bins = &measure.histogram;
    // A limit such as 0.07 is a bin's edge, though 0.07 * 100 is more than 7 in doubles, and 0.29 * 100 less than 29.
    let whole = (limit * bins.len() as f64 + 1e-9).max(0.0) as usize;
    (measure.count > 0).then(|| bins.iter().take(whole).map(|&count| count as f64).sum())
}
