//! The report's tables for a terminal: a short head for each mesh, then one table for each shape.

use std::io::{self, Write};

use comfy_table::{
    CellAlignment, ColumnConstraint, ContentArrangement, ContentLineStyle, LineStyle, TableStyle,
};

use super::details::{self, TextTable};
use super::layout::{self, Row};
use super::numbers::{score, spread};
use super::safe::escaped;
use super::{Style, head, plot};
use crate::summary::{GOOD, INVESTIGATE, Status, Summary};

/// Columns that a table takes besides the mesh's name, with element numbers of up to nine digits.
const BESIDES_MESH: u16 = 60;

/// Names are not cut below this.
const SHORTEST_NAME: u16 = 12;

/// Heads and tables.
pub fn render(summaries: &[Summary], style: &Style, out: &mut dyn Write) -> io::Result<()> {
    for summary in summaries {
        let name = bold(&escaped(&summary.mesh.name), style);
        writeln!(out, "{name}  {}", colored(summary.verdict.status, style))?;
        write_lines(&head_table(summary, style), out)?;
        writeln!(out)?;
    }
    for table in layout::tables(summaries) {
        writeln!(out, "{}", bold(&escaped(&table.title()), style))?;
        write_measures(&table, style, out)?;
        writeln!(out)?;
    }
    if style.plot {
        plot::render(summaries, style, out)?;
    }
    for table in details::tables(summaries) {
        writeln!(out, "{}", bold(&table.title, style))?;
        if !table.rows.is_empty() {
            write_lines(&detailed(&table, style), out)?;
        }
        writeln!(out)?;
    }
    Ok(())
}

fn head_table(summary: &Summary, style: &Style) -> comfy_table::Table {
    let mut table = comfy_table::Table::new();
    table.load_style(TableStyle::new()).set_content_arrangement(ContentArrangement::Dynamic);
    if let Some(width) = style.width {
        table.set_width(width);
    }
    for (label, text) in head::lines(summary) {
        table.add_row([label.to_owned(), text]);
    }
    for (column, padding) in table.column_iter_mut().zip([(2, 1), (1, 0)]) {
        column.set_padding(padding);
    }
    table
}

fn detailed(found: &TextTable, style: &Style) -> comfy_table::Table {
    let mut table = ruled(found.header.iter().map(|name| name.replace(' ', "\n")));
    let width = style.width.map_or(usize::MAX, |_| usize::from(SHORTEST_NAME));
    table.add_rows(found.rows.iter().map(|row| {
        let cut = |(i, cell): (usize, &String)| if i == 0 { shortened(cell, width) } else { cell.clone() };
        row.iter().enumerate().map(cut).collect::<Vec<_>>()
    }));
    for (i, column) in table.column_iter_mut().enumerate() {
        column.set_padding((if i == 0 { 2 } else { 1 }, 0));
        if i >= found.text_columns {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    let breaks = ["mesh", "region", "centroid", "nodes"];
    let columns = found.header.iter().enumerate().filter(|(_, name)| breaks.contains(name));
    fit(&mut table, style, &columns.map(|(i, _)| i).collect::<Vec<_>>());
    table
}

/// Has a table that is wider than the terminal break its lines in the columns that may; numbers stay whole.
pub(super) fn fit(table: &mut comfy_table::Table, style: &Style, may_break: &[usize]) {
    let Some(width) = style.width else { return };
    table.set_content_arrangement(ContentArrangement::Dynamic).set_width(width);
    for (i, column) in table.column_iter_mut().enumerate() {
        if !may_break.contains(&i) {
            column.set_constraint(ColumnConstraint::ContentWidth);
        }
    }
}

/// The rows under what the report's limits make worth a look, or good, in colour.
fn write_measures(found: &layout::Table, style: &Style, out: &mut dyn Write) -> io::Result<()> {
    let table = measures(found, style);
    let lines: Vec<_> = table.lines().collect();
    let header = lines.len().saturating_sub(found.rows.len());
    for (i, line) in lines.iter().enumerate() {
        let least = i.checked_sub(header).map(|row| found.rows[row].found.min);
        let line = line.trim_end();
        match least {
            Some(least) if least < INVESTIGATE => writeln!(out, "{}", ansi("33", line, style))?,
            Some(least) if least > GOOD => writeln!(out, "{}", ansi("32", line, style))?,
            _ => writeln!(out, "{line}")?,
        }
    }
    Ok(())
}

fn measures(found: &layout::Table, style: &Style) -> comfy_table::Table {
    let columns = layout::COLUMNS.map(|name| name.replace(' ', "\n"));
    let mut table = ruled(["mesh", "measure"].map(str::to_owned).into_iter().chain(columns));
    let width = style.width.map(|width| width.saturating_sub(BESIDES_MESH).max(SHORTEST_NAME));
    table.add_rows(found.rows.iter().map(|row| cells(row, width)));
    for (i, column) in table.column_iter_mut().enumerate() {
        column.set_padding((if i == 0 { 2 } else { 1 }, 0));
        if i > 1 {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table
}

/// An empty table with a line under its header and no other.
pub(super) fn ruled<T: Into<comfy_table::Cell>>(header: impl Iterator<Item = T>) -> comfy_table::Table {
    let mut table = comfy_table::Table::new();
    let rule = TableStyle::new()
        .header_lines(ContentLineStyle::none())
        .header_separator(LineStyle::none().fill('─').junction('─'));
    table.load_style(rule).set_content_arrangement(ContentArrangement::Disabled);
    table.set_header(header);
    table
}

fn cells(row: &Row, width: Option<u16>) -> [String; 7] {
    let found = row.found;
    let name = escaped(row.mesh);
    [
        width.map_or_else(|| name.clone(), |width| shortened(&name, width.into())),
        escaped(row.code),
        score(found.max),
        score(found.min),
        found.min_element.to_string(),
        score(found.mean),
        spread(found.sd),
    ]
}

/// A name without its middle, which seldom tells meshes apart.
fn shortened(name: &str, width: usize) -> String {
    let length = name.chars().count();
    if length <= width {
        return name.to_owned();
    }
    let (start, end) = ((width - 1) / 2, width - 1 - (width - 1) / 2);
    name.chars().take(start).chain(['…']).chain(name.chars().skip(length - end)).collect()
}

/// The lines of a table, without blanks at their ends.
pub(super) fn write_lines(table: &comfy_table::Table, out: &mut dyn Write) -> io::Result<()> {
    for line in table.lines() {
        writeln!(out, "{}", line.trim_end())?;
    }
    Ok(())
}

fn colored(status: Status, style: &Style) -> String {
    let color = match status {
        Status::Pass => "32",
        Status::Warn => "33",
        Status::Fail => "31",
    };
    ansi(color, status.name(), style)
}

pub(super) fn bold(text: &str, style: &Style) -> String {
    ansi("1", text, style)
}

/// The text under an SGR code, where the style has colour.
pub(super) fn ansi(code: &str, text: &str, style: &Style) -> String {
    if style.color { format!("\u{1b}[{code}m{text}\u{1b}[0m") } else { text.to_owned() }
}
