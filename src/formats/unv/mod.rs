//! I-DEAS universal files (`.unv`), as I-DEAS, NX, SALOME and Gmsh write them.
//!
//! A file is a list of datasets between lines of `    -1`; what stands outside them is no data. Nodes are read from the
//! datasets 2411, 781 and 15, elements from 2412, 780 and 71; all others are passed over.

mod records;
#[cfg(test)]
mod tests;
mod types;

use std::sync::Arc;

use crate::error::{Error, Result};
use crate::formats::columns::{Gathered, cut_off};
use crate::formats::text::{self, LineReader};
use crate::formats::{Format, Outline, Piece};
use crate::input::{Input, Spot};
use records::{ElementDataset, ElementRecords, NodeDataset, NodeRecords};

/// I-DEAS universal files.
pub(super) struct Unv;

impl Format for Unv {
    fn name(&self) -> &'static str {
        "unv"
    }

    fn title(&self) -> &'static str {
        "I-DEAS universal files: datasets 2411, 781, 15 of nodes, 2412, 780, 71 of elements"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["unv"]
    }

    fn looks_for(&self) -> &'static str {
        "a line of -1 in columns 5 and 6, then the number of a dataset"
    }

    fn detect(&self, head: &[u8]) -> bool {
        let mut lines = text::lines(0, head).map(|line| line.bytes);
        let Some(number) = lines.find(|line| is_mark(line)).and_then(|_| lines.next()) else { return false };
        // Other formats have lines of -1 too, with other things after them: the number is an I6.
        let begins = number.len() >= 6 && text::integer(number[..6].trim_ascii()).is_some();
        begins && (NodeDataset::find(number).is_some() || is_listed(number) || number[6..].starts_with(b"b"))
    }

    fn regions(&self) -> Option<&'static str> {
        Some("physical properties")
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        let mut lines = LineReader::new(&input.source, &input.limits, 0);
        let (mut nodes, mut elements) = (false, false);
        while let Some(line) = lines.next_line()? {
            if !is_mark(line.bytes) {
                continue;
            }
            let Some(number) = lines.next_line()? else { break };
            let place = |e: Error| input.source.place(e, Spot::Text(number.at));
            if let Some(dataset) = NodeDataset::find(number.bytes) {
                outline_nodes(input, &mut lines, dataset, out)?;
                nodes = true;
            } else if let Some(dataset) = ElementDataset::find(number.bytes) {
                outline_elements(input, &mut lines, dataset, out)?;
                elements = true;
            } else if number.bytes.get(6) == Some(&b'b') {
                return Err(place(Error::unsupported("binary datasets (58b) are not read")));
            } else if text::integer(number.bytes.trim_ascii()).is_some() {
                skip(input, &mut lines)?;
            } else {
                return Err(input.source.malformed_text(number.at, "the number of a dataset"));
            }
        }
        match (nodes, elements) {
            (true, true) => Ok(()),
            (false, _) => Err(cut_off(&input.source, "a dataset of nodes: 2411, 781 or 15")),
            (true, false) => Err(cut_off(&input.source, "a dataset of elements: 2412, 780 or 71")),
        }
    }
}

/// Whether a line begins or ends a dataset.
fn is_mark(line: &[u8]) -> bool {
    let line = line.trim_ascii_end();
    line.len() <= 6 && line.trim_ascii_start() == b"-1"
}

/// Datasets that files with meshes begin with.
fn is_listed(number: &[u8]) -> bool {
    const FIRST: [u64; 16] =
        [71, 151, 164, 170, 780, 2400, 2412, 2420, 2429, 2430, 2432, 2435, 2448, 2452, 2467, 2477];
    text::integer(number.trim_ascii()).is_some_and(|number| FIRST.contains(&number))
}

fn unended(input: &Input) -> Error {
    cut_off(&input.source, "the line -1 that ends a dataset")
}

/// Passes a dataset over.
fn skip(input: &Input, lines: &mut LineReader<'_>) -> Result<()> {
    while let Some(line) = lines.next_line()? {
        if is_mark(line.bytes) {
            return Ok(());
        }
    }
    Err(unended(input))
}

fn outline_nodes(
    input: &Input,
    lines: &mut LineReader<'_>,
    dataset: &'static NodeDataset,
    out: &mut dyn Outline,
) -> Result<()> {
    let layout = Arc::new(NodeRecords { source: Arc::clone(&input.source), dataset });
    let mut piece = |span| out.nodes(Piece { layout: Arc::clone(&layout) as _, span });
    let mut gathered = Gathered::default();
    while let Some(line) = lines.next_line()? {
        if is_mark(line.bytes) {
            return gathered.end(line.at).map_or(Ok(()), piece);
        }
        gathered.record(line.at).map_or(Ok(()), &mut piece)?;
        if dataset.lines == 2 {
            let line = lines.next_line()?.ok_or_else(|| unended(input))?;
            if is_mark(line.bytes) {
                return Err(input.source.malformed_text(line.at, "the coordinates of a node"));
            }
        }
    }
    Err(unended(input))
}

fn outline_elements(
    input: &Input,
    lines: &mut LineReader<'_>,
    dataset: &'static ElementDataset,
    out: &mut dyn Outline,
) -> Result<()> {
    let layout = Arc::new(ElementRecords { source: Arc::clone(&input.source), dataset });
    let mut piece = |span| out.elements(Piece { layout: Arc::clone(&layout) as _, span });
    let mut gathered = Gathered::default();
    while let Some(line) = lines.next_line()? {
        if is_mark(line.bytes) {
            return gathered.end(line.at).map_or(Ok(()), piece);
        }
        let at = line.at;
        let head = dataset.head(line.bytes).map_err(|e| input.source.place(e, Spot::Text(at)))?;
        gathered.record(at).map_or(Ok(()), &mut piece)?;
        for _ in 0..dataset.more_lines(&head) {
            let line = lines.next_line()?.ok_or_else(|| unended(input))?;
            if is_mark(line.bytes) {
                let expected = format!("{} nodes of element {}", head.nodes, head.label);
                return Err(input.source.malformed_text(line.at, expected));
            }
        }
    }
    Err(unended(input))
}
