//! The data of `*NODE`: a number and up to three coordinates a line; direction cosines may follow.

use std::ops::Range;
use std::sync::Arc;

use super::fields::Fields;
use super::placement::Placement;
use crate::error::Result;
use crate::formats::{NodeBatch, NodeLayout};
use crate::input::{Source, Spot};

/// Decodes the lines of one `*NODE` block for one instance.
pub(super) struct NodeLines {
    pub(super) source: Arc<Source>,
    pub(super) placement: Placement,
    /// The instance, in the bits above the node's own number.
    pub(super) scope: u64,
}

impl NodeLayout for NodeLines {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let window = self.source.window(span.clone());
        let mut fields = Fields::new(&window);
        let done = self.lines(&mut fields, span.start, out);
        if done.is_err() {
            out.at = Spot::Text(span.start + fields.at as u64);
        }
        done
    }
}

impl NodeLines {
    /// An error leaves `fields` on the line that it is about.
    fn lines(&self, fields: &mut Fields<'_>, base: u64, out: &mut NodeBatch) -> Result<()> {
        let moved = !self.placement.is_identity();
        while fields.next_line()? {
            let line = fields.at;
            out.at = Spot::Text(base + line as u64);
            let id = fields.number("a node number")?;
            let mut point = coordinates(fields)?;
            if moved {
                point = self.placement.apply(point);
            }
            out.push(self.scope | id, point).inspect_err(|_| fields.at = line)?;
        }
        Ok(())
    }
}

/// From after the node's number to the next line. Missing coordinates are 0.
#[inline]
fn coordinates(fields: &mut Fields<'_>) -> Result<[f64; 3]> {
    let mut values = [0.0; 6];
    for value in &mut values {
        if !fields.comma()? || fields.ends_line() {
            return Ok([values[0], values[1], values[2]]);
        }
        *value = fields.real()?;
    }
    // Trailing commas may stand after the direction cosines.
    while fields.comma()? && !fields.ends_line() {
        if !fields.is_blank() {
            return Err(fields.malformed("at most a number, three coordinates and three direction cosines"));
        }
    }
    Ok([values[0], values[1], values[2]])
}
