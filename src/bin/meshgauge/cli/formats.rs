//! `meshgauge formats`

use std::io::{Write, stdout};

use meshgauge::formats::{FORMATS, facts};

use crate::exit::Status;

/// List the mesh formats that are read.
#[derive(Debug, clap::Args)]
pub struct Args {}

pub fn run(_args: &Args) -> anyhow::Result<Status> {
    let mut out = stdout().lock();
    for format in FORMATS {
        let extensions: Vec<_> = format.extensions().iter().map(|e| format!(".{e}")).collect();
        writeln!(out, "{:<12} {}", format.name(), format.title())?;
        writeln!(out, "{:<12} extensions: {}", "", extensions.join(" "))?;
        writeln!(out, "{:<12} recognised by: {}", "", format.looks_for())?;
        let facts =
            facts(format.name()).map(|facts| [("handled", facts.quirks), ("refused by name", facts.refused)]);
        for (title, rows) in facts.into_iter().flatten() {
            rows.iter().try_for_each(|row| writeln!(out, "{:<12} {title}: {row}", ""))?;
        }
    }
    Ok(Status::Fine)
}
