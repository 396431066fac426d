//! The neutral files of FEMGV (FEMGEN and FEMVIEW), and CalculiX's `.frd`, which descends from them.
//!
//! A file is a list of data sets. Each begins with a line of a key and the letter C (`    2C` for nodes, `    3C` for
//! elements), whose last columns say how wide the numbers of nodes and elements are; ` -1` begins a record, ` -2`
//! continues it, ` -3` ends the data set. FEMGEN and FEMVIEW differ in fields that no mesh needs and in how many nodes
//! stand on a line; lines are read as far as they go, so that both are read by one rule.

mod records;
#[cfg(test)]
mod tests;
mod types;

use std::ops::Range;
use std::sync::Arc;

use crate::error::{Error, Result};
use crate::formats::columns::{Gathered, cut_off, field};
use crate::formats::text::{self, LineReader};
use crate::formats::{Format, Outline, Piece};
use crate::input::{Input, Spot};
use records::{ElementRecords, NodeRecords};

/// FEMGV's neutral files.
pub(super) struct Femgv;

/// CalculiX's results, which begin with the mesh.
pub(super) struct Frd;

impl Format for Femgv {
    fn name(&self) -> &'static str {
        "femgv"
    }

    fn title(&self) -> &'static str {
        "FEMGV neutral files (FEMGEN, FEMVIEW), numbers of 5 and of 10 digits"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["neu", "fvi"]
    }

    fn looks_for(&self) -> &'static str {
        "a first line of 1C or 2C in columns 5 and 6"
    }

    fn detect(&self, head: &[u8]) -> bool {
        is_neutral(head) && !has_user_headers(head)
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        outline(input, out)
    }
}

impl Format for Frd {
    fn name(&self) -> &'static str {
        "frd"
    }

    fn title(&self) -> &'static str {
        "CalculiX results, text of the short and the long form: the mesh"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["frd"]
    }

    fn looks_for(&self) -> &'static str {
        "a first line of 1C in columns 5 and 6, then lines of 1U"
    }

    fn detect(&self, head: &[u8]) -> bool {
        is_neutral(head) && has_user_headers(head)
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        outline(input, out)
    }
}

fn is_neutral(head: &[u8]) -> bool {
    let first = text::lines(0, head).map(|line| line.bytes).find(|line| !line.trim_ascii().is_empty());
    matches!(first.and_then(key), Some(1 | 2))
}

/// Whether lines of the kind that only CGX and CalculiX write stand before the nodes.
fn has_user_headers(head: &[u8]) -> bool {
    let mut lines = text::lines(0, head).map(|line| line.bytes).take_while(|line| key(line) != Some(2));
    lines.any(|line| line.starts_with(b"    1U") || line.starts_with(b"    1P"))
}

/// The key of a line that begins a data set: columns 2 to 5, before a C.
fn key(line: &[u8]) -> Option<u64> {
    let begins = line.first() == Some(&b' ') && line.get(5) == Some(&b'C');
    begins.then(|| text::integer(field(line, 1, 4))).flatten()
}

/// How many columns the numbers of nodes and elements take, by columns 74 and 75.
fn width(line: &[u8]) -> Result<usize> {
    match field(line, 73, 2) {
        b"" | b"0" => Ok(5),
        b"1" => Ok(10),
        b"2" | b"3" => {
            Err(Error::unsupported("binary .frd is not read: let the solver write its results as text"))
        }
        other => {
            let found = format!("\"{}\"", other.escape_ascii());
            Err(Error::malformed("the form of the data, 0 or 1, in columns 74 and 75", found))
        }
    }
}

fn outline(input: &Input, out: &mut dyn Outline) -> Result<()> {
    let source = &input.source;
    let mut lines = LineReader::new(source, &input.limits, 0);
    let (mut nodes, mut elements) = (false, false);
    while let Some(line) = lines.next_line()? {
        let at = line.at;
        let place = |e: Error| source.place(e, Spot::Text(at));
        match key(line.bytes) {
            Some(2) => {
                let width = width(line.bytes).map_err(place)?;
                let layout = Arc::new(NodeRecords { source: Arc::clone(source), width });
                data_set(input, &mut lines, false, |span| {
                    out.nodes(Piece { layout: Arc::clone(&layout) as _, span })
                })?;
                nodes = true;
            }
            Some(3) => {
                let width = width(line.bytes).map_err(place)?;
                let layout = Arc::new(ElementRecords { source: Arc::clone(source), width });
                data_set(input, &mut lines, true, |span| {
                    out.elements(Piece { layout: Arc::clone(&layout) as _, span })
                })?;
                elements = true;
            }
            // Loads, materials and results come after the mesh, and may be binary.
            Some(100..) if nodes && elements => break,
            _ if line.bytes.trim_ascii() == b"9999" => break,
            _ => {}
        }
    }
    match (nodes, elements) {
        (true, true) => Ok(()),
        (false, _) => Err(cut_off(source, "the data set 2C of nodes")),
        (true, false) => Err(cut_off(source, "the data set 3C of elements")),
    }
}

/// Cuts the records of a data set into pieces, up to and with its end mark.
fn data_set(
    input: &Input,
    lines: &mut LineReader<'_>,
    continued: bool,
    mut piece: impl FnMut(Range<u64>) -> Result<()>,
) -> Result<()> {
    let mut gathered = Gathered::default();
    while let Some(line) = lines.next_line()? {
        let full = match line.bytes.get(..3) {
            Some(b" -1") => gathered.record(line.at),
            Some(b" -2") if continued && !gathered.is_empty() => None,
            Some(b" -3") => return gathered.end(line.at).map_or(Ok(()), piece),
            _ => {
                let expected = if continued && !gathered.is_empty() { "-1, -2 or -3" } else { "-1 or -3" };
                return Err(input.source.malformed_text(line.at, format!("{expected} in columns 2 and 3")));
            }
        };
        full.map_or(Ok(()), &mut piece)?;
    }
    Err(cut_off(&input.source, "the end mark -3 of a data set"))
}
