//! What is told of a mesh before its tables: a label and a text a line, for the terminal and for Markdown.

use std::collections::BTreeMap;

use super::numbers::{bytes, count, counted, percent, significant};
use super::reasons;
use super::safe::escaped;
use crate::summary::{Checks, Expected, Frame, Run, Sizes, Summary};

/// Significant digits of areas and volumes, and of lengths.
const DIGITS: (usize, usize) = (6, 4);

/// The lines of a mesh's head; the verdict's reasons come last.
pub fn lines(summary: &Summary) -> Vec<(&'static str, String)> {
    let mut lines = vec![("file", file(summary)), ("nodes", nodes(summary)), ("elements", elements(summary))];
    if !summary.elements.not_measured.is_empty() {
        lines.push(("not measured", by_name(&summary.elements.not_measured)));
    }
    lines.extend(summary.frame.as_ref().map(|frame| ("frame", in_frame(frame))));
    lines.extend(totals(summary));
    lines.extend(sizes(&summary.sizes));
    let checks = findings(&summary.checks);
    if !checks.is_empty() {
        lines.push(("checks", checks));
    }
    lines.extend(summary.run.as_ref().map(|run| ("run", pace(run))));
    let reasons = summary.verdict.reasons.iter();
    let label = |i| if i == 0 { "verdict" } else { "" };
    lines.extend(reasons.enumerate().map(|(i, reason)| (label(i), reasons::in_words(reason, summary))));
    lines
}

fn file(summary: &Summary) -> String {
    let mesh = &summary.mesh;
    let packed = mesh.compression.as_ref().map(|packed| format!(", {}", escaped(packed))).unwrap_or_default();
    format!("{} ({}{packed}, {})", escaped(&mesh.path), escaped(&mesh.format), bytes(mesh.bytes))
}

fn nodes(summary: &Summary) -> String {
    count(summary.nodes.count)
}

fn elements(summary: &Summary) -> String {
    let all = &summary.elements;
    let mut text = count(all.count);
    if !all.by_type.is_empty() {
        text = format!("{text}: {}", by_name(&all.by_type));
    }
    if summary.shapes.is_empty() {
        text += "; none that a measure is defined for";
    } else if summary.shapes.values().any(|measured| measured.order.keys().any(|order| order != "1")) {
        text += "; those of higher order are measured by their corners";
    }
    text
}

/// The coordinates that the measures are of.
fn in_frame(frame: &Frame) -> String {
    let mut text = format!("measures in {}", frame.system);
    if frame.stretch != [1.0; 3] {
        let factors = frame.stretch.map(|factor| factor.to_string()).join(", ");
        text = format!("{text}, stretched by {factors}");
    }
    if frame.enclosing_axis > 0 {
        let (one, many) = ("element that encloses the axis", "elements that enclose the axis");
        text = format!("{text}; {}", counted(frame.enclosing_axis, one, many));
    }
    text
}

/// `C3D4 82,916, S3 12`.
fn by_name(counts: &BTreeMap<String, u64>) -> String {
    let items: Vec<_> =
        counts.iter().map(|(name, number)| format!("{} {}", escaped(name), count(*number))).collect();
    items.join(", ")
}

/// Area or volume, beside what is expected.
fn totals(summary: &Summary) -> Vec<(&'static str, String)> {
    let totals = [("area", summary.totals.area), ("volume", summary.totals.volume)];
    let expected = summary.expected.as_ref();
    let line = |(name, found): (&'static str, Option<f64>)| {
        let asked =
            expected.and_then(|e| if name == "area" { e.area } else { e.volume }.map(|value| (e, value)));
        let text = match (found, asked) {
            (None, None) => return None,
            (Some(found), None) => significant(found, DIGITS.0),
            (None, Some((_, value))) => format!("none; expected {}", significant(value, DIGITS.0)),
            (Some(found), Some((expected, value))) => {
                format!("{}, {}", significant(found, DIGITS.0), beside(expected, value))
            }
        };
        Some((name, text))
    };
    totals.into_iter().filter_map(line).collect()
}

fn beside(expected: &Expected, value: f64) -> String {
    let side = if expected.relative_error < 0.0 { "under" } else { "over" };
    let within = if expected.within { "within" } else { "outside" };
    let (error, value) = (percent(expected.relative_error.abs()), significant(value, DIGITS.0));
    format!("{error} {side} the expected {value}, {within} the tolerance")
}

fn sizes(sizes: &Sizes) -> Vec<(&'static str, String)> {
    let length = |value: f64| significant(value, DIGITS.1);
    let edges = sizes.edge_length.map(|e| ("edge length", format!("{} to {}", length(e.min), length(e.max))));
    let element = sizes.element_size.as_ref().map(|s| {
        let median = s.quantiles.get("0.5").map(|m| format!(", median {}", length(*m))).unwrap_or_default();
        ("element size", format!("{} to {}, mean {}{median}", length(s.min), length(s.max), length(s.mean)))
    });
    edges.into_iter().chain(element).collect()
}

/// The checks that found something.
fn findings(checks: &Checks) -> String {
    let rows = [
        (checks.missing_nodes, "element that names missing nodes", "elements that name missing nodes"),
        (checks.repeated_nodes, "element that names a corner twice", "elements that name a corner twice"),
        (checks.unused_nodes, "unused node", "unused nodes"),
        (checks.inverted, "inverted element", "inverted elements"),
        (checks.degenerate, "degenerate element", "degenerate elements"),
        (
            checks.reversed,
            "element of a shape that is reversed as a whole",
            "elements of shapes reversed as a whole",
        ),
        (checks.concave_faces, "concave face", "concave faces"),
        (checks.crossed_faces, "crossed face", "crossed faces"),
        (checks.ghost_elements, "ghost element left out", "ghost elements left out"),
        (checks.duplicate_elements.unwrap_or(0), "duplicate element", "duplicate elements"),
        (checks.coincident_nodes.unwrap_or(0), "coincident node", "coincident nodes"),
    ];
    let found = rows.into_iter().filter(|(number, ..)| *number > 0);
    found.map(|(number, one, many)| counted(number, one, many)).collect::<Vec<_>>().join(", ")
}

fn pace(run: &Run) -> String {
    let (seconds, speed) = (significant(run.seconds, 3), count(run.elements_per_second.round() as u64));
    let threads = counted(run.threads as u64, "thread", "threads");
    format!("{seconds} s, {threads}, {speed} elements/s, peak {}", bytes(run.peak_rss_bytes))
}
