//! Summaries as CSV (RFC 4180 quoting): one row for each mesh, shape and measure, at full precision.
//!
//! Control characters in names are written as escapes, so that a row is always one line.

use std::borrow::Cow;
use std::io::{self, Write};

use super::Style;
use super::safe::escaped;
use crate::mesh::Shape;
use crate::summary::{MeasureSummary, Summary};

/// Columns before the quantiles.
const FIRST: [&str; 12] =
    ["mesh", "path", "format", "shape", "on", "measure", "count", "max", "min", "min_element", "mean", "sd"];

/// Probabilities of the quantiles, as the summary writes them.
const QUANTILES: [&str; 5] = ["0.001", "0.01", "0.05", "0.5", "0.95"];

/// Columns after the quantiles.
const LAST: [&str; 3] = ["inverted", "degenerate", "verdict"];

/// A header and the rows. Columns `region` and `worst` stand at the end where some summary has such things.
pub fn render(summaries: &[Summary], _: &Style, out: &mut dyn Write) -> io::Result<()> {
    let asked = Asked {
        regions: summaries.iter().any(|summary| summary.regions.is_some()),
        worst: measures(summaries).any(|measure| !measure.worst.is_empty()),
    };
    let quantiles = QUANTILES.iter().map(|probability| format!("q{probability}"));
    let header = FIRST.iter().map(ToString::to_string).chain(quantiles).chain(LAST.map(String::from));
    let further = [("region", asked.regions), ("worst", asked.worst)];
    let further = further.into_iter().filter(|(_, asked)| *asked).map(|(name, _)| name.to_owned());
    write_row(header.chain(further), out)?;
    for summary in summaries {
        rows(summary, asked, out)?;
    }
    Ok(())
}

/// Which columns there are on demand.
#[derive(Debug, Clone, Copy)]
struct Asked {
    regions: bool,
    worst: bool,
}

fn measures(summaries: &[Summary]) -> impl Iterator<Item = &MeasureSummary> {
    summaries.iter().flat_map(|summary| summary.shapes.values()).flat_map(|shape| shape.measures.values())
}

/// One row for each shape and measure, then those of the regions.
fn rows(summary: &Summary, asked: Asked, out: &mut dyn Write) -> io::Result<()> {
    for (shape, measured) in &summary.shapes {
        for (code, found) in &measured.measures {
            let numbers = [found.max, found.min, found.mean, found.sd];
            let quantile =
                |probability| found.quantiles.get(probability).copied().map(number).unwrap_or_default();
            let flaws = [measured.inverted, measured.degenerate];
            let row = row(summary, (*shape, &found.on, code), found.count, found.min_element, numbers);
            let row = row.chain(QUANTILES.map(quantile)).chain(flaws.map(|count| count.to_string()));
            let row = row.chain([summary.verdict.status.name().to_owned()]);
            let row = row.chain(asked.regions.then(String::new)).chain(asked.worst.then(|| worst(found)));
            write_row(row, out)?;
        }
    }
    for region in summary.regions.iter().flat_map(|regions| &regions.list) {
        for (shape, measured) in &region.shapes {
            for (code, found) in &measured.measures {
                let numbers = [found.max, found.min, found.mean, found.sd];
                let flaws = [measured.inverted, measured.degenerate];
                let row = row(summary, (*shape, &found.on, code), found.count, found.min_element, numbers);
                let row =
                    row.chain(QUANTILES.map(|_| String::new())).chain(flaws.map(|count| count.to_string()));
                let row = row.chain([summary.verdict.status.name().to_owned()]);
                let name = region.name.clone().unwrap_or_else(|| "-".to_owned());
                write_row(row.chain([name]).chain(asked.worst.then(String::new)), out)?;
            }
        }
    }
    Ok(())
}

/// The columns of [`FIRST`]; `numbers` are maximum, minimum, mean and standard deviation.
fn row<'a>(
    summary: &'a Summary,
    (shape, on, code): (Shape, &'a str, &'a str),
    count: u64,
    min_element: u64,
    numbers: [f64; 4],
) -> impl Iterator<Item = String> + use<'a> {
    let mesh = &summary.mesh;
    let [max, min, mean, sd] = numbers.map(number);
    let names = [&mesh.name, &mesh.path, &mesh.format, shape.name(), on, code].map(str::to_owned);
    names.into_iter().chain([count.to_string(), max, min, min_element.to_string(), mean, sd])
}

/// `1937=0.0966;12=0.1`: the worst elements with their values.
fn worst(found: &MeasureSummary) -> String {
    let items = found.worst.iter().map(|worst| format!("{}={}", worst.element, number(worst.value)));
    items.collect::<Vec<_>>().join(";")
}

/// The shortest text that reads back to the same double.
fn number(value: f64) -> String {
    format!("{value:?}")
}

fn write_row(fields: impl Iterator<Item = String>, out: &mut dyn Write) -> io::Result<()> {
    for (i, field) in fields.enumerate() {
        let comma = if i == 0 { "" } else { "," };
        write!(out, "{comma}{}", quoted(&escaped(&field)))?;
    }
    writeln!(out)
}

fn quoted(field: &str) -> Cow<'_, str> {
    if field.contains([',', '"']) {
        Cow::Owned(format!("\"{}\"", field.replace('"', "\"\"")))
    } else {
        Cow::Borrowed(field)
    }
}
