//! A comparison for a comment on a merge request: a line for all, a table for each mesh that changed, and the rest
//! folded away.

use std::io::{self, Write};

use super::words::{COLUMNS, cells, rest, side, tally, told};
use crate::compare::{Comparison, Comparisons, Finding, Outcome};
use crate::report::Style;
use crate::report::safe::markdown;

/// The whole comment. Whatever a file could have named is made harmless.
pub fn render(comparisons: &Comparisons, _: &Style, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "### Mesh quality: {}\n", comparisons.outcome.name())?;
    writeln!(out, "{}\n", tally(comparisons))?;
    let (changed, same): (Vec<_>, Vec<_>) =
        comparisons.meshes.iter().partition(|mesh| mesh.outcome != Outcome::Same);
    for mesh in changed {
        write_mesh(mesh, out)?;
    }
    write_names("Only the base has", &comparisons.gone, out)?;
    write_names("Only the new set has", &comparisons.added, out)?;
    let same: Vec<_> = same.into_iter().map(|mesh| mesh.name.clone()).collect();
    write_names("Within the tolerances:", &same, out)
}

fn write_mesh(mesh: &Comparison, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "#### {}: {}\n", markdown(&mesh.name), mesh.outcome.name())?;
    writeln!(out, "base {}; new {}\n", markdown(&side(&mesh.base)), markdown(&side(&mesh.new)))?;
    write_table(told(mesh), out)?;
    writeln!(out, "<details><summary>{}: every minimum and mean</summary>\n", rest(mesh))?;
    let main = |finding: &&Finding| matches!(&*finding.statistic, "min" | "mean");
    write_table(mesh.findings.iter().filter(main), out)?;
    writeln!(out, "</details>\n")
}

fn write_table<'a>(findings: impl Iterator<Item = &'a Finding>, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "| | {} |\n|---|---|---|---|---:|---:|---:|---:|---:|", COLUMNS.join(" | "))?;
    for finding in findings {
        let cells = cells(finding).map(|cell| markdown(&cell));
        writeln!(out, "| {} | {} |", finding.outcome.name(), cells.join(" | "))?;
    }
    writeln!(out)
}

fn write_names(what: &str, names: &[String], out: &mut dyn Write) -> io::Result<()> {
    if names.is_empty() {
        return Ok(());
    }
    let names: Vec<_> = names.iter().map(|name| markdown(name)).collect();
    writeln!(out, "{what} {}\n", names.join(", "))
}
