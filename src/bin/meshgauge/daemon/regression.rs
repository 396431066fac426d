//! Each mesh that was scored beside the baseline of its part: `mesh.regressed`, `mesh.improved`.

use std::path::Path;

use meshgauge::Summary;
use meshgauge::compare::{Comparison, Finding, Outcome, Tolerances, compare};

use super::Places;
use super::log::Event;
use crate::baseline::Baselines;
use crate::config::Config;
use crate::exit::Usage;
use crate::series::Naming;

/// What meshes are compared with, and how.
pub struct Watchman {
    /// The baselines.
    baselines: Baselines,
    /// Which meshes are one part.
    naming: Naming,
    /// What may change.
    tolerances: Tolerances,
}

impl Watchman {
    /// Who compares as the configuration says; `None` where it says that nothing is compared.
    pub fn of(config: &Config, places: &Places) -> Result<Option<Self>, Usage> {
        if !config.baseline.compare {
            return Ok(None);
        }
        let baselines = Baselines::of(&places.state);
        Ok(Some(Self { baselines, naming: config.baseline.naming()?, tolerances: config.compare }))
    }

    /// The event that tells that a mesh is worse or better than its baseline. The first mesh of a part becomes it.
    pub fn look(&self, path: &Path, summary: &Summary) -> anyhow::Result<Option<Event>> {
        let part = self.naming.part(path);
        let Some(base) = self.baselines.read(&part)? else {
            self.baselines.accept(&part, summary)?;
            return Ok(None);
        };
        let part = part.to_string_lossy();
        let found = compare(&part, &base, summary, &self.tolerances);
        let event = match found.outcome {
            Outcome::Worse => Event::warn("mesh.regressed"),
            Outcome::Better => Event::info("mesh.improved"),
            Outcome::Same | Outcome::Changed => return Ok(None),
        };
        Ok(Some(facts(event.mesh(path).with("part", part.as_ref()), &found)))
    }
}

/// The facts, flat: how many statistics, the first of them in full, and every minimum and mean that is over its tolerance.
fn facts(mut event: Event, found: &Comparison) -> Event {
    let told: Vec<&Finding> = found.findings_that_are(found.outcome).collect();
    let number = |outcome| found.findings_that_are(outcome).count();
    event = event
        .with("worse", number(Outcome::Worse))
        .with("better", number(Outcome::Better))
        .with("baseline_xxh3", found.base.xxh3.as_str());
    if let Some(first) = told.iter().find(|finding| finding.measure.is_some()).or(told.first()) {
        event =
            event.with("statistic", first.statistic.as_ref()).with("base", first.base).with("new", first.new);
        for (key, text) in
            [("measure", first.measure.clone()), ("shape", first.shape.map(|shape| shape.to_string()))]
        {
            if let Some(text) = text {
                event = event.with(key, text);
            }
        }
        if let Some(element) = first.element {
            event = event.with("element", element);
        }
    }
    for finding in told {
        if let (Some(code), "min" | "mean") = (&finding.measure, finding.statistic.as_ref()) {
            let key = format!("{}_{code}", finding.statistic);
            event = event.with(format!("base_{key}"), finding.base).with(key, finding.new);
        }
    }
    event
}
