//! Summaries as CSV (RFC 4180 quoting): one row for each mesh, shape and measure, at full precision.
//!
//! Control characters in names are written as escapes, so that a row is always one line.

use std::borrow::Cow;
use std::io::{self, Write};

use super::Style;
use super::safe::escaped;
use crate::summary::Summary;

/// Columns before the quantiles.
const FIRST: [&str; 12] =
    ["mesh", "path", "format", "shape", "on", "measure", "count", "max", "min", "min_element", "mean", "sd"];

/// Probabilities of the quantiles, as the summary writes them.
const QUANTILES: [&str; 5] = ["0.001", "0.01", "0.05", "0.5", "0.95"];

/// Columns after the quantiles.
const LAST: [&str; 3] = ["inverted", "degenerate", "verdict"];

/// A header and the rows.
pub fn render(summaries: &[Summary], _: &Style, out: &mut dyn Write) -> io::Result<()> {
    let quantiles = QUANTILES.iter().map(|probability| format!("q{probability}"));
    let header =
        FIRST.iter().map(ToString::to_string).chain(quantiles).chain(LAST.iter().map(ToString::to_string));
    write_row(header, out)?;
    for summary in summaries {
        rows(summary, out)?;
    }
    Ok(())
}

fn rows(summary: &Summary, out: &mut dyn Write) -> io::Result<()> {
    let mesh = &summary.mesh;
    for (shape, measured) in &summary.shapes {
        for (code, found) in &measured.measures {
            let first = [
                mesh.name.clone(),
                mesh.path.clone(),
                mesh.format.clone(),
                shape.to_string(),
                found.on.to_string(),
                code.clone(),
                found.count.to_string(),
                number(found.max),
                number(found.min),
                found.min_element.to_string(),
                number(found.mean),
                number(found.sd),
            ];
            let quantile =
                |probability| found.quantiles.get(probability).copied().map(number).unwrap_or_default();
            let last = [
                measured.inverted.to_string(),
                measured.degenerate.to_string(),
                summary.verdict.status.name().to_owned(),
            ];
            write_row(first.into_iter().chain(QUANTILES.map(quantile)).chain(last), out)?;
        }
    }
    Ok(())
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
