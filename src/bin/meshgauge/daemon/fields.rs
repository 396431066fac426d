//! A summary in short: flat fields for the log, a line for people.

use std::collections::BTreeMap;
use std::path::Path;

use meshgauge::Summary;
use meshgauge::summary::Reason;

use super::log::Event;
use super::protocol::Failure;

/// Adds what a person would grep for: `elements`, and `min_M31` and `mean_M31` for each measure. Where shapes share a
/// measure the shape goes before: `wedge.min_M21`.
pub fn flatten(mut event: Event, summary: &Summary) -> Event {
    event = event
        .with("status", summary.verdict.status.name())
        .with("elements", summary.elements.count)
        .with("nodes", summary.nodes.count)
        .with("format", summary.mesh.format.as_str())
        .with("bytes", summary.mesh.bytes)
        .with("xxh3", summary.mesh.xxh3.as_str());
    if let Some(reason) = summary.verdict.reasons.first() {
        event = event.with("reason", in_words(reason));
    }
    let mut shapes_of: BTreeMap<&str, u32> = BTreeMap::new();
    for code in summary.shapes.values().flat_map(|shape| shape.measures.keys()) {
        *shapes_of.entry(code).or_default() += 1;
    }
    for (shape, found) in &summary.shapes {
        for (code, measure) in &found.measures {
            let prefix = if shapes_of[code.as_str()] > 1 { format!("{shape}.") } else { String::new() };
            event = event
                .with(format!("{prefix}min_{code}"), measure.min)
                .with(format!("{prefix}mean_{code}"), measure.mean);
        }
    }
    event
}

/// Adds why a mesh was not scored.
pub fn failure(mut event: Event, failure: &Failure) -> Event {
    event = event.with("kind", failure.kind.name()).with("reason", failure.reason.as_str());
    if let Some(format) = &failure.format {
        event = event.with("format", format.as_str());
    }
    if let Some(line) = failure.line {
        event = event.with("line", line);
    }
    if let Some(byte) = failure.byte {
        event = event.with("byte", byte);
    }
    event
}

/// One line for people.
pub fn line(mesh: &Path, summary: &Summary, published: &Path) -> String {
    let shapes: Vec<_> =
        summary.main_shapes().map(|(shape, found)| format!("{} {shape}", found.count)).collect();
    let shapes = if shapes.is_empty() { "nothing to measure".into() } else { shapes.join(", ") };
    let reason = summary.verdict.reasons.first().map(|r| format!(" ({})", in_words(r))).unwrap_or_default();
    let status = summary.verdict.status.name();
    let published = published.display();
    printable(&format!("{}: {status}{reason}: {shapes} -> {published}", mesh.display()))
}

/// Without control characters: names come from whoever fills the drop.
pub fn printable(line: &str) -> String {
    line.chars().map(|c| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c }).collect()
}

fn in_words(reason: &Reason) -> String {
    let subject = match (&reason.measure, reason.shape) {
        (Some(measure), Some(shape)) => format!("{measure} of {shape} "),
        (None, Some(shape)) => format!("{shape} "),
        _ => String::new(),
    };
    let element = reason.element.map(|e| format!(" at element {e}")).unwrap_or_default();
    format!("{}: {subject}{}, limit {}{element}", reason.rule, reason.value, reason.limit)
}
