//! Summaries as Markdown, for a comment on a merge request.

use std::io::{self, Write};

use super::details::{self, TextTable};
use super::numbers::{score, spread};
use super::safe::markdown;
use super::{Style, head, layout};
use crate::summary::Summary;

/// Heads and tables. Whatever a file could have named is made harmless.
pub fn render(summaries: &[Summary], _: &Style, out: &mut dyn Write) -> io::Result<()> {
    for summary in summaries {
        writeln!(out, "### {}: {}\n", markdown(&summary.mesh.name), summary.verdict.status.name())?;
        for (i, (label, text)) in head::lines(summary).iter().enumerate() {
            writeln!(out, "| {label} | {} |", markdown(text))?;
            if i == 0 {
                writeln!(out, "|---|---|")?;
            }
        }
        writeln!(out)?;
    }
    for table in layout::tables(summaries) {
        writeln!(out, "#### {}\n", markdown(&table.title()))?;
        writeln!(out, "| mesh | measure | {} |", layout::COLUMNS.join(" | "))?;
        writeln!(out, "|---|---|{}", "---:|".repeat(layout::COLUMNS.len()))?;
        for row in &table.rows {
            write_row(row, out)?;
        }
        writeln!(out)?;
    }
    for table in details::tables(summaries) {
        write_details(&table, out)?;
    }
    Ok(())
}

fn write_details(table: &TextTable, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "#### {}\n", markdown(&table.title))?;
    if table.rows.is_empty() {
        return Ok(());
    }
    let (texts, numbers) = (table.text_columns, table.header.len() - table.text_columns);
    writeln!(out, "| {} |", table.header.join(" | "))?;
    writeln!(out, "|{}{}", "---|".repeat(texts), "---:|".repeat(numbers))?;
    for row in &table.rows {
        let cells: Vec<_> = row.iter().map(|cell| markdown(cell)).collect();
        writeln!(out, "| {} |", cells.join(" | "))?;
    }
    writeln!(out)
}

fn write_row(row: &layout::Row, out: &mut dyn Write) -> io::Result<()> {
    let found = row.found;
    let numbers = [
        score(found.max),
        score(found.min),
        found.min_element.to_string(),
        score(found.mean),
        spread(found.sd),
    ];
    writeln!(out, "| {} | {} | {} |", markdown(row.mesh), markdown(row.code), numbers.join(" | "))
}
