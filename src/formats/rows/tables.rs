//! Tables of text whose rows have one number of numbers: cut into pieces by counting, and decoded.

use std::ops::Range;
use std::sync::Arc;

use super::{Numbers, TokenReader};
use crate::error::Result;
use crate::formats::plain::{Columns, PlainRows};
use crate::formats::{ElementLayout, ElementSink, NodeBatch, NodeLayout, Outline, Piece};
use crate::input::Source;
use crate::mesh::ElementType;

/// A table as its head tells of it.
#[derive(Debug, Clone, Copy)]
pub struct Table<'w> {
    /// What its rows are, for errors.
    pub what: &'w str,
    /// Number of rows that it says to have.
    pub rows: u64,
    /// Numbers after those that are read, in each row; of elements, the region.
    pub extra: usize,
    /// Number of its first node or element.
    pub first: u64,
}

/// Finds the rows of a table of nodes with `dimension` coordinates.
pub fn outline_nodes(
    reader: &mut TokenReader<'_>,
    table: Table<'_>,
    dimension: usize,
    out: &mut dyn Outline,
) -> Result<()> {
    let (source, comment) = (Arc::clone(reader.source), reader.comment());
    cut(reader, table, dimension, |first, span| {
        let source = Arc::clone(&source);
        let layout = Arc::new(NodeRows { source, comment, first, dimension, extra: table.extra });
        out.nodes(Piece { layout, span })
    })
}

/// Finds the rows of a table of elements of one type.
pub fn outline_elements(
    reader: &mut TokenReader<'_>,
    table: Table<'_>,
    kind: &'static Arc<ElementType>,
    out: &mut dyn Outline,
) -> Result<()> {
    let (source, comment) = (Arc::clone(reader.source), reader.comment());
    cut(reader, table, kind.nodes, |first, span| {
        let source = Arc::clone(&source);
        let layout = Arc::new(ElementRows { source, comment, first, kind, extra: table.extra });
        out.elements(Piece { layout, span })
    })
}

fn cut(
    reader: &mut TokenReader<'_>,
    table: Table<'_>,
    width: usize,
    mut piece: impl FnMut(u64, Range<u64>) -> Result<()>,
) -> Result<()> {
    let mut done = 0;
    while done < table.rows {
        let from = reader.position();
        let rows = reader.pass_rows(table.rows - done, (width + table.extra) as u64, table.what)?;
        piece(table.first + done, from..reader.position())?;
        done += rows;
    }
    Ok(())
}

/// Rows of coordinates; a span is a range of bytes.
#[derive(Debug)]
struct NodeRows {
    source: Arc<Source>,
    comment: u8,
    first: u64,
    dimension: usize,
    extra: usize,
}

impl NodeLayout for NodeRows {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let window = self.source.window(span.clone());
        let mut numbers = Numbers::new(span.start, &window, self.comment);
        let mut id = self.first;
        while numbers.more() {
            out.at = numbers.spot();
            let mut point = [0.0; 3];
            for x in &mut point[..self.dimension] {
                *x = numbers.real("a coordinate")?;
            }
            for _ in 0..self.extra {
                numbers.reference("a reference")?;
            }
            out.push(id, point)?;
            id += 1;
        }
        Ok(())
    }
}

/// Rows of nodes' numbers; a span is a range of bytes.
#[derive(Debug)]
struct ElementRows {
    source: Arc<Source>,
    comment: u8,
    first: u64,
    kind: &'static Arc<ElementType>,
    extra: usize,
}

impl ElementLayout for ElementRows {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        let window = self.source.window(span.clone());
        let mut numbers = Numbers::new(span.start, &window, self.comment);
        let mut ids = vec![0; self.kind.nodes];
        let mut label = self.first;
        let columns =
            Columns { kind: self.kind, first: Some(label), before: (&[], 0), after: self.extra, scope: 0 };
        // References are what divides a mesh into regions.
        let passed = self.extra == 0 || !out.wants_regions();
        let mut plain = passed.then(|| PlainRows::new(b' ', &columns)).flatten();
        while numbers.more() {
            if let Some(plain) = &mut plain {
                let columns = Columns { first: Some(label), ..columns };
                let taken = plain.take(numbers.rest(), &columns, u64::MAX, out)?;
                numbers.pass(taken.bytes);
                label += taken.rows;
                if taken.rows > 0 {
                    continue;
                }
            }
            out.at = numbers.spot();
            for id in &mut ids {
                *id = numbers.integer("the number of a node")?;
            }
            for _ in 0..self.extra {
                let reference = numbers.reference("a reference")?;
                out.region(reference as u64, || reference.to_string())?;
            }
            out.element(label, self.kind, &ids)?;
            label += 1;
        }
        Ok(())
    }
}
