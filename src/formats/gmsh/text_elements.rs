//! Elements in text, one a row: each with its type and tags in MSH 1 and 2, in blocks of one type in 4.0 and 4.1.

use std::ops::Range;
use std::sync::Arc;

use super::groups::Groups;
use super::rows::Rows;
use super::walk::{Gathered, Walk};
use super::{Version, types};
use crate::error::{Error, Result};
use crate::formats::plain::{Columns, PlainRows};
use crate::formats::{ElementLayout, ElementSink, Outline, PIECE_BYTES, Piece};
use crate::input::Source;
use crate::mesh::ElementType;

const ROW: &str = "rows of elements";
const LABEL: &str = "an element's number";
const NODE: &str = "the tag of an element's node";

/// Finds the rows of a section of MSH 1 or 2.
pub(super) fn outline_rows(
    walk: &mut Walk<'_>,
    version: Version,
    groups: Arc<Groups>,
    out: &mut dyn Outline,
) -> Result<()> {
    let count = walk.row("the number of elements", |row| row.integer("the number of elements"))?;
    let layout: Arc<dyn ElementLayout> =
        Arc::new(TaggedRows { source: Arc::clone(walk.source), version, groups });
    cut_rows(walk, count, &layout, out)
}

/// Finds the blocks of a section of MSH 4.
pub(super) fn outline_blocks(
    walk: &mut Walk<'_>,
    version: Version,
    groups: Arc<Groups>,
    out: &mut dyn Outline,
) -> Result<()> {
    let what = "the numbers of blocks and elements";
    let (blocks, elements) = walk.row(what, |row| version.block_counts(row))?;
    let whole = Arc::new(ElementBlocks { source: Arc::clone(walk.source), version, groups: groups.clone() });
    let emit = |out: &mut dyn Outline, span: Option<Range<u64>>| match span {
        Some(span) => out.elements(Piece { layout: whole.clone(), span }),
        None => Ok(()),
    };
    let mut found = 0u64;
    let mut gathered = Gathered::new(walk.at());
    for _ in 0..blocks {
        let start = walk.at();
        let block = walk.row("the first line of a block of elements", |row| Block::read(row, version))?;
        found = found.saturating_add(block.elements);
        let body = walk.at();
        let elements = block.elements;
        let rows = walk.rows(elements, PIECE_BYTES, ROW)?;
        if rows == elements {
            emit(out, gathered.add(walk.at()))?;
            continue;
        }
        emit(out, gathered.take(start))?;
        let layout: Arc<dyn ElementLayout> =
            Arc::new(ElementRows { source: Arc::clone(walk.source), block, groups: groups.clone() });
        out.elements(Piece { layout: layout.clone(), span: body..walk.at() })?;
        cut_rows(walk, elements - rows, &layout, out)?;
        gathered = Gathered::new(walk.at());
    }
    emit(out, gathered.take(walk.at()))?;
    walk.same_count(elements, found, "elements")
}

/// Cuts `left` rows into pieces.
fn cut_rows(
    walk: &mut Walk<'_>,
    mut left: u64,
    layout: &Arc<dyn ElementLayout>,
    out: &mut dyn Outline,
) -> Result<()> {
    while left > 0 {
        let from = walk.at();
        left -= walk.rows(left, PIECE_BYTES, ROW)?;
        out.elements(Piece { layout: Arc::clone(layout), span: from..walk.at() })?;
    }
    Ok(())
}

/// Rows of MSH 1, `number type physical elementary nodes ...`, or MSH 2, `number type tags ... nodes ...`.
#[derive(Debug)]
struct TaggedRows {
    source: Arc<Source>,
    version: Version,
    groups: Arc<Groups>,
}

impl ElementLayout for TaggedRows {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        let window = self.source.window(span.clone());
        let mut rows = Rows::new(span.start, &window);
        let mut ids = Vec::new();
        let first = self.version == Version::V1;
        let mut plain: Option<(&Arc<ElementType>, [u64; 2], PlainRows)> = None;
        while rows.more() {
            if let Some((kind, before, plain)) = &mut plain {
                let columns =
                    Columns { kind, first: None, before: (before, before[1] as usize), after: 0, scope: 0 };
                let taken = plain.take(rows.rest(), &columns, u64::MAX, out)?;
                rows.pass(taken.bytes);
                if taken.rows > 0 {
                    continue;
                }
            }
            out.at = rows.spot();
            let label = rows.integer(LABEL)?;
            let kind = rows.kind()?;
            let tags = if first { 2 } else { rows.integer("the number of an element's tags")? };
            let mut group = 0;
            for k in 0..tags {
                let tag = rows.signed("an element's tag")?;
                group = if k == 0 { tag } else { group };
            }
            self.groups.enter(kind, group, out)?;
            let mut nodes = kind.nodes as u64;
            if first || nodes == 0 {
                nodes = number_of_nodes(&mut rows, kind)?;
            }
            ids.clear();
            for _ in 0..nodes {
                ids.push(rows.integer(NODE)?);
            }
            rows.end()?;
            out.element(label, kind, &ids)?;
            // The next rows are most likely of the same type with as many tags.
            if !first
                && !out.wants_regions()
                && plain.as_ref().is_none_or(|(last, known, _)| !Arc::ptr_eq(last, kind) || known[1] != tags)
            {
                let columns = Columns { kind, first: None, before: (&[], 0), after: 0, scope: 0 };
                plain = types::number_of(kind)
                    .and_then(|number| Some((kind, [number, tags], PlainRows::new(b' ', &columns)?)));
            }
        }
        Ok(())
    }
}

/// The number of nodes where the row itself has it.
fn number_of_nodes(rows: &mut Rows<'_>, kind: &ElementType) -> Result<u64> {
    let nodes = rows.integer("the number of an element's nodes")?;
    if kind.nodes > 0 && nodes != kind.nodes as u64 {
        return Err(Error::malformed(format!("{} nodes of a {}", kind.nodes, kind.name), format!("{nodes}")));
    }
    Ok(nodes)
}

/// Rows `tag nodes ...` of one type.
#[derive(Debug)]
struct ElementRows {
    source: Arc<Source>,
    block: Block,
    groups: Arc<Groups>,
}

impl ElementLayout for ElementRows {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        let window = self.source.window(span.clone());
        self.block.enter(&self.groups, out)?;
        read_rows(&mut Rows::new(span.start, &window), u64::MAX, self.block.kind, &mut Vec::new(), out)
    }
}

/// Reads rows of one type.
fn read_rows(
    rows: &mut Rows<'_>,
    count: u64,
    kind: &Arc<ElementType>,
    ids: &mut Vec<u64>,
    out: &mut ElementSink<'_>,
) -> Result<()> {
    ids.resize(kind.nodes, 0);
    let columns = Columns { kind, first: None, before: (&[], 0), after: 0, scope: 0 };
    let mut plain = PlainRows::new(b' ', &columns);
    let mut left = count;
    while left > 0 && rows.more() {
        if let Some(plain) = &mut plain {
            let taken = plain.take(rows.rest(), &columns, left, out)?;
            rows.pass(taken.bytes);
            left -= taken.rows;
            if taken.rows > 0 {
                continue;
            }
        }
        left -= 1;
        out.at = rows.spot();
        let label = rows.integer(LABEL)?;
        for id in ids.iter_mut() {
            *id = rows.integer(NODE)?;
        }
        // Gmsh writes polygons and polyhedra of MSH 4 without their nodes; others may add them.
        if kind.nodes == 0 {
            rows.skip(1)
        } else {
            rows.end()?
        }
        out.element(label, kind, ids)?;
    }
    Ok(())
}

/// Whole blocks of MSH 4; a span is a range of bytes.
#[derive(Debug)]
struct ElementBlocks {
    source: Arc<Source>,
    version: Version,
    groups: Arc<Groups>,
}

impl ElementLayout for ElementBlocks {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        let window = self.source.window(span.clone());
        let mut rows = Rows::new(span.start, &window);
        let mut ids = Vec::new();
        while rows.next_block() {
            out.at = rows.spot();
            let block = Block::read(&mut rows, self.version)?;
            rows.end()?;
            block.enter(&self.groups, out)?;
            read_rows(&mut rows, block.elements, block.kind, &mut ids, out)?;
        }
        Ok(())
    }
}

/// The first line of a block.
#[derive(Debug)]
struct Block {
    /// Dimension and tag of the entity.
    entity: (u64, i64),
    kind: &'static Arc<ElementType>,
    elements: u64,
}

impl Block {
    fn read(row: &mut Rows<'_>, version: Version) -> Result<Self> {
        let entity = version.entity(row)?;
        Ok(Self { entity, kind: row.kind()?, elements: row.integer("the number of elements of a block")? })
    }

    /// Says which region its elements are in.
    fn enter(&self, groups: &Groups, out: &mut ElementSink<'_>) -> Result<()> {
        groups.enter_entity(self.entity.0 as u8, self.entity.1, out)
    }
}
