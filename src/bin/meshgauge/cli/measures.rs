//! `meshgauge measures`

use std::io::{Write, stdout};

use meshgauge::measures::{Measure, measures};
use meshgauge::summary::PRESETS;

use crate::exit::Status;

/// List the measures: definition, range, what a low score warns of, and source.
#[derive(Debug, clap::Args)]
pub struct Args {}

pub fn run(_args: &Args) -> anyhow::Result<Status> {
    let mut out = stdout().lock();
    let [low, high] = Measure::RANGE;
    for m in measures() {
        writeln!(out, "{:<4} {} ({}), {low} to {high}, best {}", m.code, m.title, m.family, Measure::BEST)?;
        writeln!(out, "     definition: {}", m.definition)?;
        writeln!(out, "     watches:    {}", m.watches)?;
        writeln!(out, "     source:     {}", m.source)?;
        for threshold in m.thresholds {
            let (value, meaning, source) = (threshold.value, threshold.meaning, threshold.source);
            writeln!(out, "     threshold:  {value} ({meaning}; {source})")?;
        }
    }
    writeln!(out, "\nPresets of the verdict (--preset):")?;
    for preset in PRESETS {
        writeln!(out, "{:<7} {}\n        source: {}", preset.name, preset.title, preset.source)?;
    }
    Ok(Status::Fine)
}
