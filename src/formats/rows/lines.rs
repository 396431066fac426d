//! Tables of text with a row a line: cut into pieces by counting lines.

use std::ops::Range;
use std::sync::Arc;

use super::Numbers;
use super::tokens::too_few;
use crate::error::Result;
use crate::formats::text::{self, LineReader};
use crate::formats::{NodeBatch, NodeLayout, Outline, PIECE_BYTES, Piece};
use crate::input::Source;

/// Passes `rows` lines that are neither blank nor a comment, and gives them in pieces, each with the number of rows before
/// it. A line that begins with a letter, or the end of the file, is an error, in which `what` says what the rows are.
pub fn pass_lines(
    lines: &mut LineReader<'_>,
    source: &Source,
    comment: u8,
    (rows, what): (u64, &str),
    mut piece: impl FnMut(u64, Range<u64>) -> Result<()>,
) -> Result<()> {
    let (mut from, mut first, mut found) = (lines.position(), 0, 0);
    while found < rows {
        let at = lines.position();
        if at - from >= PIECE_BYTES {
            piece(first, from..at)?;
            (from, first) = (at, found);
        }
        let line = lines.next_line()?;
        match line.map(|line| line.bytes.trim_ascii_start().first().copied()) {
            Some(None) => {}
            Some(Some(byte)) if byte == comment => {}
            Some(Some(byte)) if !byte.is_ascii_alphabetic() => found += 1,
            _ => return Err(too_few(source, at, what, rows, found)),
        }
    }
    if found > first { piece(first, from..lines.position()) } else { Ok(()) }
}

/// [`pass_lines`] of nodes: `dimension` coordinates a line, whatever follows them. The first has the number `number`.
pub fn pass_node_lines(
    lines: &mut LineReader<'_>,
    source: &Arc<Source>,
    comment: u8,
    (rows, what): (u64, &str),
    (number, dimension): (u64, usize),
    out: &mut dyn Outline,
) -> Result<()> {
    pass_lines(lines, source, comment, (rows, what), |first, span| {
        let source = Arc::clone(source);
        let layout = Arc::new(NodeLines { source, comment, first: number + first, dimension });
        out.nodes(Piece { layout, span })
    })
}

/// Lines of coordinates; a span is a range of bytes.
#[derive(Debug)]
struct NodeLines {
    source: Arc<Source>,
    comment: u8,
    first: u64,
    dimension: usize,
}

impl NodeLayout for NodeLines {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let window = self.source.window(span.clone());
        let mut id = self.first;
        for line in text::lines(span.start, &window) {
            let mut numbers = Numbers::new(line.at, line.bytes, self.comment);
            if !numbers.more() {
                continue;
            }
            out.at = numbers.spot();
            let mut point = [0.0; 3];
            for x in &mut point[..self.dimension] {
                *x = numbers.real("a coordinate")?;
            }
            out.push(id, point)?;
            id += 1;
        }
        Ok(())
    }
}
