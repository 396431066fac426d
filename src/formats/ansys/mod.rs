//! ANSYS archives (`.cdb`) as CDWRITE makes them, and the mesh part of Workbench's decks.
//!
//! An archive is a list of commands. `NBLOCK` and `EBLOCK` are followed by a Fortran format, from which the columns are
//! taken, and by the data; `ET`, `ETBLOCK` and `KEYOP` say what a type number stands for. All other commands make no
//! mesh and are passed over.

mod blocks;
mod commands;
#[cfg(test)]
mod tests;
mod types;

use std::sync::Arc;

use crate::error::{Error, Result};
use crate::formats::columns::{Gathered, cut_off, field};
use crate::formats::text::{self, LineReader};
use crate::formats::{Format, Outline, Piece};
use crate::input::{Input, Spot};
use blocks::{ElementRows, NodeRows};
use commands::{Command, Edit, elements_follow};
use types::Table;

/// ANSYS archives.
pub(super) struct Ansys;

impl Format for Ansys {
    fn name(&self) -> &'static str {
        "ansys"
    }

    fn title(&self) -> &'static str {
        "ANSYS archives: NBLOCK and EBLOCK, degenerate bricks told by their nodes"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["cdb"]
    }

    fn looks_for(&self) -> &'static str {
        "a command NBLOCK with its Fortran format, or /PREP7 with what CDWRITE begins with"
    }

    fn detect(&self, head: &[u8]) -> bool {
        let mut lines = text::lines(0, head).map(|line| line.bytes).peekable();
        let (mut preprocessor, mut block) = (false, false);
        while let Some(line) = lines.next() {
            let is =
                |word: &[u8]| line.get(..word.len()).is_some_and(|start| start.eq_ignore_ascii_case(word));
            preprocessor |= is(b"/PREP7");
            block |= is(b"NBLOCK,") && lines.peek().is_some_and(|next| next.trim_ascii().starts_with(b"("));
            block |= preprocessor && (is(b"*IF,_CDRDOFF") || is(b"NUMOFF,"));
        }
        block
    }

    fn regions(&self) -> Option<&'static str> {
        Some("materials")
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        let source = &input.source;
        let mut lines = LineReader::new(source, &input.limits, 0);
        let mut table = Table::default();
        let (mut nodes, mut elements) = (false, false);
        while let Some(line) = lines.next_line()? {
            let at = line.at;
            let place = |e: Error| source.place(e, Spot::Text(at));
            let command = Command::new(line.bytes);
            match command.name() {
                b"NBLOCK" => {
                    outline_nodes(input, &mut lines, out)?;
                    nodes = true;
                }
                b"EBLOCK" => {
                    let solid = elements_follow(&command).map_err(place)?;
                    outline_elements(input, &mut lines, &table, solid, out)?;
                    elements = true;
                }
                b"ET" => table.define(&command).map_err(place)?,
                b"KEYOP" | b"KEYOPT" => table.option(&command),
                b"ETBLOCK" => read_types(input, &mut lines, &mut table)?,
                _ => {}
            }
        }
        match (nodes, elements) {
            (true, true) => Ok(()),
            (false, _) => Err(cut_off(source, "a command NBLOCK")),
            (true, false) => Err(cut_off(source, "a command EBLOCK")),
        }
    }
}

/// The Fortran format that follows a command.
fn edit(input: &Input, lines: &mut LineReader<'_>) -> Result<Edit> {
    let missing = || cut_off(&input.source, "a Fortran format");
    let line = lines.next_line()?.ok_or_else(missing)?;
    Edit::read(line.bytes)
        .ok_or_else(|| input.source.malformed_text(line.at, "a Fortran format, as (3i9,6e21.13e3)"))
}

fn outline_nodes(input: &Input, lines: &mut LineReader<'_>, out: &mut dyn Outline) -> Result<()> {
    let edit = edit(input, lines)?;
    if edit.real_width == 0 {
        let expected = "a Fortran format with reals, as (3i9,6e21.13e3)";
        return Err(input.source.malformed_text(lines.position(), expected));
    }
    let layout = Arc::new(NodeRows { source: Arc::clone(&input.source), edit });
    let mut piece = |span| out.nodes(Piece { layout: Arc::clone(&layout) as _, span });
    let mut gathered = Gathered::default();
    while let Some(line) = lines.next_line()? {
        let text = line.bytes.trim_ascii();
        // CDWRITE ends the block by `N,R5.3,LOC,-1,`, Workbench by -1.
        if text.first().is_some_and(|b| b.eq_ignore_ascii_case(&b'N')) || text == b"-1" {
            return gathered.end(line.at).map_or(Ok(()), piece);
        }
        gathered.record(line.at).map_or(Ok(()), &mut piece)?;
    }
    Err(cut_off(&input.source, "the end mark -1 of a NBLOCK"))
}

fn outline_elements(
    input: &Input,
    lines: &mut LineReader<'_>,
    table: &Table,
    solid: bool,
    out: &mut dyn Outline,
) -> Result<()> {
    let edit = edit(input, lines)?;
    let layout = Arc::new(ElementRows {
        source: Arc::clone(&input.source),
        edit,
        solid,
        table: Arc::new(table.clone()),
    });
    let mut piece = |span| out.elements(Piece { layout: Arc::clone(&layout) as _, span });
    let mut gathered = Gathered::default();
    while let Some(line) = lines.next_line()? {
        if field(line.bytes, 0, edit.width) == b"-1" {
            return gathered.end(line.at).map_or(Ok(()), piece);
        }
        let at = line.at;
        let more = layout.more_lines(line.bytes).map_err(|e| input.source.place(e, Spot::Text(at)))?;
        gathered.record(at).map_or(Ok(()), &mut piece)?;
        for _ in 0..more {
            let line = lines.next_line()?.ok_or_else(|| cut_off(&input.source, "the nodes of an element"))?;
            if line.bytes.trim_ascii() == b"-1" {
                return Err(input.source.malformed_text(line.at, "the nodes of an element"));
            }
        }
    }
    Err(cut_off(&input.source, "the end mark -1 of an EBLOCK"))
}

/// The rows of an `ETBLOCK`: a type number, an element's number, and key options from the first on.
fn read_types(input: &Input, lines: &mut LineReader<'_>, table: &mut Table) -> Result<()> {
    let edit = edit(input, lines)?;
    while let Some(line) = lines.next_line()? {
        if field(line.bytes, 0, edit.width) == b"-1" {
            return Ok(());
        }
        let [number, element, option] = [0, 1, 2].map(|k| field(line.bytes, k * edit.width, edit.width));
        let at = line.at;
        table.set(number, element).map_err(|e| input.source.place(e, Spot::Text(at)))?;
        table.set_option(number, b"1", option);
    }
    Err(cut_off(&input.source, "the end mark -1 of an ETBLOCK"))
}
