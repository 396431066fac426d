//! A finding in words and numbers, as the table and the Markdown share them.

use crate::compare::{Comparison, Comparisons, Finding, Outcome, Side};
use crate::report::layout::plural;
use crate::report::numbers::{count, counted, percent, score, significant};
use crate::report::safe::escaped;

/// The columns after the outcome.
pub const COLUMNS: [&str; 8] = ["of", "measure", "statistic", "base", "new", "change", "allowed", "element"];

/// A finding's cells under [`COLUMNS`].
pub fn cells(finding: &Finding) -> [String; 8] {
    let of = finding.shape.map_or("mesh", plural);
    let unit = Unit::of(finding);
    let value = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |value| unit.text(value));
    [
        of.to_owned(),
        escaped(finding.measure.as_deref().unwrap_or_default()),
        escaped(&finding.statistic),
        value(finding.base),
        value(finding.new),
        finding.change().map(|change| signed(change, &unit.text(change.abs()))).unwrap_or_default(),
        unit.text(finding.allowed),
        finding.element.map(|element| element.to_string()).unwrap_or_default(),
    ]
}

/// What a number counts.
#[derive(Clone, Copy)]
enum Unit {
    /// A score from 0 to 1.
    Score,
    /// A share of values.
    Share,
    /// Whole things.
    Count,
    /// Lengths, areas, volumes, and errors of them.
    Size,
}

impl Unit {
    fn of(finding: &Finding) -> Self {
        let name = finding.statistic.as_ref();
        if finding.measure.is_some() {
            return if name.starts_with("share") { Unit::Share } else { Unit::Score };
        }
        let sized = ["area", "volume", "edge", "size", "error"];
        if sized.iter().any(|word| name.contains(word)) { Unit::Size } else { Unit::Count }
    }

    fn text(self, value: f64) -> String {
        match self {
            Unit::Score => score(value),
            Unit::Share => percent(value),
            Unit::Count => count(value.max(0.0).round() as u64),
            Unit::Size => significant(value, 6),
        }
    }
}

/// A change with its sign; one that reads as nothing has none.
fn signed(change: f64, text: &str) -> String {
    if change == 0.0 {
        return String::new();
    }
    let sign = if change < 0.0 { '−' } else { '+' };
    format!("{sign}{text}")
}

/// `3 meshes: 1 worse, 2 same; 1 gone`.
pub fn tally(comparisons: &Comparisons) -> String {
    let all = counted(comparisons.meshes.len() as u64, "mesh", "meshes");
    let mut parts = Vec::new();
    for outcome in [Outcome::Worse, Outcome::Better, Outcome::Changed, Outcome::Same] {
        let number = comparisons.count(outcome) as u64;
        if number > 0 {
            parts.push(format!("{} {}", count(number), outcome.name()));
        }
    }
    for (names, what) in [(&comparisons.gone, "gone"), (&comparisons.added, "new")] {
        if !names.is_empty() {
            parts.push(format!("{} {what}", count(names.len() as u64)));
        }
    }
    if parts.is_empty() { format!("{all} compared") } else { format!("{all} compared: {}", parts.join(", ")) }
}

/// `results/pit.inp (83,340 elements, pass)`.
pub fn side(side: &Side) -> String {
    let elements = counted(side.elements, "element", "elements");
    format!("{} ({elements}, {})", escaped(&side.path), side.status.name())
}

/// The findings that are told, the worst first.
pub fn told(comparison: &Comparison) -> impl Iterator<Item = &Finding> {
    [Outcome::Worse, Outcome::Better, Outcome::Changed]
        .into_iter()
        .flat_map(|outcome| comparison.findings_that_are(outcome))
}

/// `87 more within their tolerances`.
pub fn rest(comparison: &Comparison) -> String {
    let same = comparison.findings_that_are(Outcome::Same).count() as u64;
    counted(same, "statistic is within its tolerance", "statistics are within their tolerances")
}
