//! Nodes in text: rows `tag x y z` in MSH 1, 2 and 4.0; in 4.1 blocks that list the tags first and the points after.

use std::ops::Range;
use std::sync::Arc;

use super::Version;
use super::rows::Rows;
use super::walk::{Gathered, Walk};
use crate::error::{Error, Result};
use crate::formats::{NodeBatch, NodeLayout, Outline, PIECE_BYTES, Piece};
use crate::input::Source;

/// The most nodes of a block of MSH 4.1 that one piece decodes: their tags and points stand in two places.
const RUN: u64 = PIECE_BYTES / 64;

/// Finds the rows of a section of MSH 1 or 2.
pub(super) fn outline_rows(walk: &mut Walk<'_>, columns: Columns, out: &mut dyn Outline) -> Result<()> {
    let left = walk.row("the number of nodes", |row| row.integer("the number of nodes"))?;
    // Old writers number from 0, against the letter of the format.
    cut_rows(walk, left, &NodeRows { source: Arc::clone(walk.source), least: 0, columns }, out)
}

/// Finds the blocks of a section of MSH 4.
pub(super) fn outline_blocks(walk: &mut Walk<'_>, version: Version, out: &mut dyn Outline) -> Result<()> {
    let what = "the numbers of blocks and nodes";
    let (blocks, nodes) = walk.row(what, |row| version.block_counts(row))?;
    let whole = Arc::new(NodeBlocks { source: Arc::clone(walk.source), version });
    let emit = |out: &mut dyn Outline, span: Option<Range<u64>>| match span {
        Some(span) => out.nodes(Piece { layout: whole.clone(), span }),
        None => Ok(()),
    };
    let mut found = 0u64;
    let mut gathered = Gathered::new(walk.at());
    for _ in 0..blocks {
        let start = walk.at();
        let block = walk.row(HEADER, |row| Block::read(row, version))?;
        found = found.saturating_add(block.nodes);
        if block.nodes > RUN {
            emit(out, gathered.take(start))?;
            block.cut(walk, version, out)?;
            gathered = Gathered::new(walk.at());
        } else {
            for _ in 0..version.rows_a_node() {
                walk.rows(block.nodes, u64::MAX, ROW)?;
            }
            emit(out, gathered.add(walk.at()))?;
        }
    }
    emit(out, gathered.take(walk.at()))?;
    walk.same_count(nodes, found, "nodes")
}

const HEADER: &str = "the first line of a block of nodes";
const ROW: &str = "rows of nodes";

/// Cuts `left` rows into pieces.
fn cut_rows(walk: &mut Walk<'_>, mut left: u64, rows: &NodeRows, out: &mut dyn Outline) -> Result<()> {
    let layout = Arc::new(rows.clone());
    while left > 0 {
        let from = walk.at();
        left -= walk.rows(left, PIECE_BYTES, ROW)?;
        out.nodes(Piece { layout: layout.clone(), span: from..walk.at() })?;
    }
    Ok(())
}

/// What follows x, y and z in a row.
#[derive(Debug, Clone, Copy)]
pub(super) enum Columns {
    /// So many parameters.
    Parameters(u64),
    /// The dimension and tag of an entity, and as many parameters as a curve or surface has.
    Entity,
}

/// Rows `tag x y z ...`; a span is a range of bytes.
#[derive(Debug, Clone)]
struct NodeRows {
    source: Arc<Source>,
    least: u64,
    columns: Columns,
}

impl NodeRows {
    fn read(&self, rows: &mut Rows<'_>, count: u64, out: &mut NodeBatch) -> Result<()> {
        for _ in 0..count {
            if !rows.more() {
                break;
            }
            out.at = rows.spot();
            let id = tag(rows, self.least)?;
            let point = rows.point()?;
            let parameters = match self.columns {
                Columns::Parameters(count) => count,
                Columns::Entity => {
                    let dimension = rows.integer("the dimension of an entity")?;
                    rows.signed("the tag of an entity")?;
                    if dimension < 3 { dimension } else { 0 }
                }
            };
            skip_parameters(rows, parameters)?;
            out.push(id, point)?;
        }
        Ok(())
    }
}

impl NodeLayout for NodeRows {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let window = self.source.window(span.clone());
        self.read(&mut Rows::new(span.start, &window), u64::MAX, out)
    }
}

/// Points of MSH 4.1, one a row, with their tags elsewhere; a span is a range of bytes of points.
#[derive(Debug)]
struct NodeRun {
    source: Arc<Source>,
    tags: Range<u64>,
    parameters: u64,
}

impl NodeLayout for NodeRun {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let tags = self.source.window(self.tags.clone());
        let points = self.source.window(span.clone());
        let mut tags = Rows::new(self.tags.start, &tags);
        read_run(&mut tags, &mut Rows::new(span.start, &points), u64::MAX, self.parameters, out)
    }
}

/// Reads tags and points that stand in two places.
fn read_run(
    tags: &mut Rows<'_>,
    points: &mut Rows<'_>,
    count: u64,
    parameters: u64,
    out: &mut NodeBatch,
) -> Result<()> {
    for _ in 0..count {
        if !tags.more() {
            break;
        }
        out.at = tags.spot();
        let id = tag(tags, 1)?;
        tags.end()?;
        out.at = points.spot();
        let point = points.point()?;
        skip_parameters(points, parameters)?;
        out.push(id, point)?;
    }
    Ok(())
}

/// A node's tag, `least` or more.
#[inline]
fn tag(rows: &mut Rows<'_>, least: u64) -> Result<u64> {
    let id = rows.integer("a node's tag")?;
    if id < least {
        return Err(Error::malformed("a node's tag, which is positive", format!("{id}")));
    }
    Ok(id)
}

/// The rest of a row: parameters that nobody needs here.
#[inline]
fn skip_parameters(rows: &mut Rows<'_>, count: u64) -> Result<()> {
    for _ in 0..count {
        rows.real("a node's parameter on its curve or surface")?;
    }
    rows.end()
}

/// Whole blocks of MSH 4; a span is a range of bytes.
#[derive(Debug)]
struct NodeBlocks {
    source: Arc<Source>,
    version: Version,
}

impl NodeLayout for NodeBlocks {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let window = self.source.window(span.clone());
        let mut rows = Rows::new(span.start, &window);
        while rows.next_block() {
            out.at = rows.spot();
            let block = Block::read(&mut rows, self.version)?;
            rows.end()?;
            if self.version == Version::V40 {
                block.rows(&self.source).read(&mut rows, block.nodes, out)?;
            } else {
                let mut points = rows.clone();
                points.skip(block.nodes);
                read_run(&mut rows, &mut points, block.nodes, block.parameters, out)?;
                rows = points;
            }
        }
        Ok(())
    }
}

/// The first line of a block.
struct Block {
    nodes: u64,
    /// Number of parameters after x, y and z.
    parameters: u64,
}

impl Block {
    fn read(row: &mut Rows<'_>, version: Version) -> Result<Self> {
        let (dimension, _) = version.entity(row)?;
        let parametric = row.integer("whether nodes are parametric")?;
        let nodes = row.integer("the number of nodes of a block")?;
        match parametric {
            0 => Ok(Self { nodes, parameters: 0 }),
            1 => Ok(Self { nodes, parameters: dimension }),
            other => Err(Error::malformed("0 or 1, whether nodes are parametric", format!("{other}"))),
        }
    }

    fn rows(&self, source: &Arc<Source>) -> NodeRows {
        NodeRows { source: Arc::clone(source), least: 1, columns: Columns::Parameters(self.parameters) }
    }

    /// Cuts a long block into pieces.
    fn cut(&self, walk: &mut Walk<'_>, version: Version, out: &mut dyn Outline) -> Result<()> {
        if version == Version::V40 {
            return cut_rows(walk, self.nodes, &self.rows(walk.source), out);
        }
        // Where each run of tags starts: eight bytes for 16384 nodes.
        let mut starts = vec![walk.at()];
        let mut left = self.nodes;
        while left > 0 {
            left -= walk.rows(left.min(RUN), u64::MAX, ROW)?;
            starts.push(walk.at());
        }
        let mut left = self.nodes;
        for tags in starts.windows(2) {
            let from = walk.at();
            left -= walk.rows(left.min(RUN), u64::MAX, ROW)?;
            let source = Arc::clone(walk.source);
            let layout = Arc::new(NodeRun { source, tags: tags[0]..tags[1], parameters: self.parameters });
            out.nodes(Piece { layout, span: from..walk.at() })?;
        }
        Ok(())
    }
}
