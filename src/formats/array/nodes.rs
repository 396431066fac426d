//! Nodes whose coordinates stand in arrays.

use std::ops::Range;
use std::sync::Arc;

use super::table::Table;
use crate::error::Result;
use crate::formats::binary::cut_records;
use crate::formats::{NodeBatch, NodeLayout, Outline, Piece};
use crate::input::Source;

/// Nodes with numbers one after another.
#[derive(Debug)]
pub struct Coordinates {
    /// The mesh file, for errors.
    pub file: Arc<Source>,
    /// Coordinates, of which there may be three or less.
    pub table: Table,
    /// The number of the first node.
    pub first: u64,
}

impl Coordinates {
    /// Hands out the nodes, cut into pieces.
    pub fn outline(self, out: &mut dyn Outline) -> Result<()> {
        let (count, width) = (self.table.len(), self.table.record_bytes());
        let layout: Arc<dyn NodeLayout> = Arc::new(self);
        cut_records(count, width, |span| out.nodes(Piece { layout: Arc::clone(&layout), span }))
    }
}

impl NodeLayout for Coordinates {
    fn source(&self) -> &Source {
        &self.file
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let mut values = Vec::new();
        self.table.reals(span.clone(), &mut values);
        for (node, record) in span.zip(values.chunks_exact(self.table.width())) {
            out.at = self.table.spot(node);
            let mut point = [0.0; 3];
            for (x, value) in point.iter_mut().zip(record) {
                *x = *value;
            }
            out.push(self.first + node, point)?;
        }
        Ok(())
    }
}
