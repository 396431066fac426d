//! A comparison for a terminal: a table of what changed for each mesh, and a line for all.

use std::io::{self, Write};

use comfy_table::CellAlignment;

use super::words::{COLUMNS, cells, rest, side, tally, told};
use crate::compare::{Comparison, Comparisons, Outcome};
use crate::report::Style;
use crate::report::safe::escaped;
use crate::report::table::{ansi, bold, fit, ruled, write_lines};

/// The columns whose lines may break in a narrow terminal.
const OF: usize = 1;
const STATISTIC: usize = 3;

/// Meshes, the worst first; then those that one side lacks, and a tally.
pub fn render(comparisons: &Comparisons, style: &Style, out: &mut dyn Write) -> io::Result<()> {
    for mesh in &comparisons.meshes {
        write_mesh(mesh, style, out)?;
    }
    for name in &comparisons.gone {
        writeln!(
            out,
            "{}  {}: only the base has it",
            bold(&escaped(name), style),
            ansi("31", "gone", style)
        )?;
    }
    for name in &comparisons.added {
        writeln!(out, "{}  new: the base does not have it", bold(&escaped(name), style))?;
    }
    writeln!(out, "{}", tally(comparisons))
}

fn write_mesh(mesh: &Comparison, style: &Style, out: &mut dyn Write) -> io::Result<()> {
    write!(out, "{}  {}", bold(&escaped(&mesh.name), style), colored(mesh.outcome, style))?;
    if mesh.outcome == Outcome::Same {
        return writeln!(out, "  {}", rest(mesh));
    }
    writeln!(out, "\n  base  {}\n  new   {}", side(&mesh.base), side(&mesh.new))?;
    let mut table = ruled(std::iter::once("").chain(COLUMNS));
    for finding in told(mesh) {
        let outcome = finding.outcome.name().to_owned();
        table.add_row(std::iter::once(outcome).chain(cells(finding)));
    }
    for (i, column) in table.column_iter_mut().enumerate() {
        column.set_padding((if i == 0 { 2 } else { 1 }, 0));
        if i > 3 {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    fit(&mut table, style, &[OF, STATISTIC]);
    write_lines(&table, out)?;
    writeln!(out, "  {}\n", rest(mesh))
}

fn colored(outcome: Outcome, style: &Style) -> String {
    let color = match outcome {
        Outcome::Same => "0",
        Outcome::Changed => "33",
        Outcome::Better => "32",
        Outcome::Worse => "31",
    };
    ansi(color, outcome.name(), style)
}
