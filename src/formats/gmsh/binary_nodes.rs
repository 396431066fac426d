//! Nodes in binary sections: records of tag and point in MSH 2; in 4.1 blocks that list the tags first and the points
//! after.

use std::ops::Range;
use std::sync::Arc;

use super::walk::{Gathered, Walk};
use super::words::Binary;
use crate::error::{Error, Result};
use crate::formats::binary::{Endian, cut_records};
use crate::formats::{NodeBatch, NodeLayout, Outline, PIECE_BYTES, Piece};
use crate::input::{Source, Spot};

/// Bytes of a point.
const POINT: usize = 24;

/// Finds the records of `$Nodes` in MSH 2.
pub(super) fn outline_records(walk: &mut Walk<'_>, binary: Binary, out: &mut dyn Outline) -> Result<()> {
    let count = walk.row("the number of nodes", |row| row.integer("the number of nodes"))?;
    let width = (4 + POINT) as u64;
    let records = walk.pass(count.checked_mul(width), &format!("{count} nodes"))?;
    let layout = Arc::new(NodeRecords { source: Arc::clone(walk.source), binary, parametric: false });
    cut_records(count, width, |run| {
        let span = records.start + run.start * width..records.start + run.end * width;
        out.nodes(Piece { layout: layout.clone(), span })
    })
}

/// Finds the records of `$ParametricNodes` in MSH 2, which differ in length.
pub(super) fn outline_parametric(walk: &mut Walk<'_>, binary: Binary, out: &mut dyn Outline) -> Result<()> {
    let count = walk.row("the number of nodes", |row| row.integer("the number of nodes"))?;
    let layout = Arc::new(NodeRecords { source: Arc::clone(walk.source), binary, parametric: true });
    let mut gathered = Gathered::new(walk.at());
    for _ in 0..count {
        let width = record_width(binary.endian, walk.bytes(PARAMETRIC, "a node with its entity")?);
        walk.pass(Some((width - PARAMETRIC) as u64), "a node's parameters")?;
        if let Some(span) = gathered.add(walk.at()) {
            out.nodes(Piece { layout: layout.clone(), span })?;
        }
    }
    match gathered.take(walk.at()) {
        Some(span) => out.nodes(Piece { layout, span }),
        None => Ok(()),
    }
}

/// Bytes of a record of `$ParametricNodes` without its parameters: tag, point, dimension and tag of the entity.
const PARAMETRIC: usize = 4 + POINT + 8;

/// Bytes of a record of `$ParametricNodes`: nodes on curves have one parameter, those on surfaces two.
fn record_width(endian: Endian, record: &[u8]) -> usize {
    match endian.u32(&record[4 + POINT..]) {
        1 => PARAMETRIC + 8,
        2 => PARAMETRIC + 16,
        _ => PARAMETRIC,
    }
}

/// Finds the blocks of MSH 4.1.
pub(super) fn outline_blocks(walk: &mut Walk<'_>, binary: Binary, out: &mut dyn Outline) -> Result<()> {
    let (blocks, nodes) = binary.block_counts(walk)?;
    let layout = Arc::new(NodeBlocks { source: Arc::clone(walk.source), binary });
    let emit = |out: &mut dyn Outline, span: Option<Range<u64>>| match span {
        Some(span) => out.nodes(Piece { layout: layout.clone(), span }),
        None => Ok(()),
    };
    let mut found = 0;
    let mut gathered = Gathered::new(walk.at());
    for _ in 0..blocks {
        let start = walk.at();
        let head = walk.bytes(binary.block_head(), "the head of a block of nodes")?;
        let block = Block::read(binary, head).map_err(|e| walk.place(e, start))?;
        let width = (binary.word + block.width()) as u64;
        let body = walk.pass(block.nodes.checked_mul(width), &format!("{} nodes of a block", block.nodes))?;
        found += block.nodes;
        if body.end - body.start <= PIECE_BYTES {
            emit(out, gathered.add(body.end))?;
            continue;
        }
        emit(out, gathered.take(start))?;
        gathered = Gathered::new(body.end);
        let source = Arc::clone(walk.source);
        let run = Arc::new(NodeRun { source, binary, tags: body.start, block });
        cut_records(run.block.nodes, width, |span| out.nodes(Piece { layout: run.clone(), span }))?;
    }
    emit(out, gathered.take(walk.at()))?;
    walk.same_count(nodes, found, "nodes")
}

/// Records of MSH 2; a span is a range of bytes.
#[derive(Debug)]
struct NodeRecords {
    source: Arc<Source>,
    binary: Binary,
    parametric: bool,
}

impl NodeLayout for NodeRecords {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let window = self.source.window(span.clone());
        let mut rest = &window[..];
        let endian = self.binary.endian;
        while rest.len() >= 4 + POINT {
            out.at = Spot::Binary(span.end - rest.len() as u64);
            // Old writers number from 0, against the letter of the format.
            let id = self.binary.tag::<4>(rest, 0)?;
            out.push(id, point(endian, &rest[4..]))?;
            let width = if self.parametric { record_width(endian, rest) } else { 4 + POINT };
            rest = &rest[width.min(rest.len())..];
        }
        Ok(())
    }
}

/// A long block of MSH 4.1; a span is a range of its nodes.
#[derive(Debug)]
struct NodeRun {
    source: Arc<Source>,
    binary: Binary,
    /// Where its tags start; its points follow.
    tags: u64,
    block: Block,
}

impl NodeLayout for NodeRun {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let (word, width) = (self.binary.word as u64, self.block.width() as u64);
        let points = self.tags + self.block.nodes * word;
        let window = |at: u64, width: u64| {
            let from = at + span.start * width;
            (from, self.source.window(from..at + span.end * width))
        };
        let ((tags_at, tags), (points_at, points)) = (window(self.tags, word), window(points, width));
        self.block.decode(self.binary, (tags_at, &tags), (points_at, &points), out)
    }
}

/// Whole blocks of MSH 4.1; a span is a range of bytes.
#[derive(Debug)]
struct NodeBlocks {
    source: Arc<Source>,
    binary: Binary,
}

impl NodeLayout for NodeBlocks {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let window = self.source.window(span.clone());
        let mut rest = &window[..];
        while let Some((head, body)) = rest.split_at_checked(self.binary.block_head()) {
            let at = span.end - body.len() as u64;
            out.at = Spot::Binary(at - head.len() as u64);
            let block = Block::read(self.binary, head)?;
            let tags = (block.nodes as usize).saturating_mul(self.binary.word);
            let points = (block.nodes as usize).saturating_mul(block.width());
            let Some((body, after)) = body.split_at_checked(tags.saturating_add(points)) else {
                return Err(Error::malformed("a whole block of nodes", "less"));
            };
            let (tags, points) = body.split_at(tags);
            block.decode(self.binary, (at, tags), (at + tags.len() as u64, points), out)?;
            rest = after;
        }
        Ok(())
    }
}

/// The head of a block of MSH 4.1.
#[derive(Debug, Clone, Copy)]
struct Block {
    nodes: u64,
    /// Number of parameters after x, y and z.
    parameters: usize,
}

impl Block {
    fn read(binary: Binary, head: &[u8]) -> Result<Self> {
        let dimension = binary.dimension(head)?;
        let nodes = binary.count(&head[12..])?;
        match binary.endian.u32(&head[8..]) {
            0 => Ok(Self { nodes, parameters: 0 }),
            1 => Ok(Self { nodes, parameters: dimension }),
            other => Err(Error::malformed("0 or 1, whether nodes are parametric", format!("{other}"))),
        }
    }

    /// Bytes of a point with its parameters.
    fn width(&self) -> usize {
        POINT + 8 * self.parameters
    }

    /// Decodes tags and points, each with the byte of the file that they start at.
    fn decode(
        &self,
        binary: Binary,
        tags: (u64, &[u8]),
        points: (u64, &[u8]),
        out: &mut NodeBatch,
    ) -> Result<()> {
        match binary.word {
            4 => self.decode_words::<4>(binary, tags, points, out),
            _ => self.decode_words::<8>(binary, tags, points, out),
        }
    }

    fn decode_words<const WORD: usize>(
        &self,
        binary: Binary,
        (tags_at, tags): (u64, &[u8]),
        (points_at, points): (u64, &[u8]),
        out: &mut NodeBatch,
    ) -> Result<()> {
        let width = self.width();
        for (k, (tag, raw)) in tags.chunks_exact(WORD).zip(points.chunks_exact(width)).enumerate() {
            out.at = Spot::Binary(tags_at + (k * WORD) as u64);
            let id = binary.tag::<WORD>(tag, 1)?;
            out.at = Spot::Binary(points_at + (k * width) as u64);
            out.push(id, point(binary.endian, raw))?;
        }
        Ok(())
    }
}

/// The point at the start of `bytes`.
#[inline]
fn point(endian: Endian, bytes: &[u8]) -> [f64; 3] {
    let raw = &bytes[..POINT];
    [endian.f64(raw), endian.f64(&raw[8..]), endian.f64(&raw[16..])]
}
