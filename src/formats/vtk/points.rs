//! How points are decoded, wherever their array came from.

use std::ops::Range;
use std::sync::Arc;

use crate::error::Result;
use crate::formats::array::Array;
use crate::formats::binary::cut_records;
use crate::formats::{NodeBatch, NodeLayout, Outline, Piece};
use crate::input::Source;

/// Points: x, y, z of each.
#[derive(Debug)]
pub struct Points {
    /// The mesh file, for errors.
    pub file: Arc<Source>,
    /// Three numbers a point.
    pub coordinates: Array,
}

impl Points {
    /// Hands out the points, cut into pieces.
    pub fn outline(self, out: &mut dyn Outline) -> Result<()> {
        let (count, width) = (self.coordinates.len() / 3, self.coordinates.width());
        let layout: Arc<dyn NodeLayout> = Arc::new(self);
        cut_records(count, 3 * width, |span| out.nodes(Piece { layout: Arc::clone(&layout), span }))
    }
}

impl NodeLayout for Points {
    fn source(&self) -> &Source {
        &self.file
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let mut values = Vec::new();
        self.coordinates.reals(3 * span.start..3 * span.end, &mut values);
        for (point, xyz) in span.zip(values.as_chunks::<3>().0) {
            out.at = self.coordinates.spot(3 * point);
            out.push_next(*xyz)?;
        }
        Ok(())
    }
}
