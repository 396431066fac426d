//! Records of nodes and elements in their columns.

use std::ops::Range;
use std::sync::Arc;

use super::types;
use crate::error::{Error, Result};
use crate::formats::columns::{integer, real};
use crate::formats::{ElementLayout, ElementSink, NodeBatch, NodeLayout, text};
use crate::input::{Source, Spot};
use crate::mesh::Class;

/// Most nodes of an element whose type is not known.
const MOST_NODES: usize = 64;
/// Records begin after the mark ` -1`.
const START: usize = 3;

/// Decodes nodes: a number and three coordinates of 12 columns.
pub(super) struct NodeRecords {
    pub(super) source: Arc<Source>,
    /// Columns of a number.
    pub(super) width: usize,
}

impl NodeLayout for NodeRecords {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let window = self.source.window(span.clone());
        for line in text::lines(span.start, &window) {
            out.at = Spot::Text(line.at);
            let id = integer(line.bytes, START, self.width, "a node number")?;
            let mut point = [0.0; 3];
            for (k, value) in point.iter_mut().enumerate() {
                *value = real(line.bytes, START + self.width + 12 * k, 12, "a coordinate")?;
            }
            let end = START + self.width + 36;
            if !line.bytes.get(end..).unwrap_or_default().trim_ascii().is_empty() {
                let expected = format!("the end of the line after column {end}");
                return Err(Error::malformed(expected, crate::error::excerpt(&line.bytes[end..])));
            }
            out.push(id, point)?;
        }
        Ok(())
    }
}

/// Decodes elements: a number, a type and what no mesh needs; then lines of nodes.
pub(super) struct ElementRecords {
    pub(super) source: Arc<Source>,
    /// Columns of a number.
    pub(super) width: usize,
}

impl ElementLayout for ElementRecords {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        let window = self.source.window(span.clone());
        let mut lines = text::lines(span.start, &window).peekable();
        let mut ids = Vec::with_capacity(MOST_NODES);
        while let Some(line) = lines.next() {
            out.at = Spot::Text(line.at);
            let label = integer(line.bytes, START, self.width, "an element number")?;
            let kind = types::find(integer(line.bytes, START + self.width, 5, "an element type")?)?;
            ids.clear();
            while let Some(more) = lines.next_if(|next| next.bytes.starts_with(b" -2")) {
                out.at = Spot::Text(more.at);
                self.nodes(more.bytes, &mut ids)?;
            }
            out.at = Spot::Text(line.at);
            let known = matches!(kind.class, Class::Measured { .. }) || kind.nodes > 0;
            if known && ids.len() != kind.nodes {
                let expected = format!("{} nodes of element {label} of type {}", kind.nodes, kind.name);
                return Err(Error::malformed(expected, format!("{}", ids.len())));
            }
            out.element(label, kind, &ids)?;
        }
        Ok(())
    }
}

impl ElementRecords {
    /// The nodes of one line.
    #[inline]
    fn nodes(&self, line: &[u8], ids: &mut Vec<u64>) -> Result<()> {
        let line = line.trim_ascii_end();
        let mut from = START;
        while from < line.len() {
            if ids.len() == MOST_NODES {
                return Err(Error::limit("number of nodes of an element", MOST_NODES));
            }
            ids.push(integer(line, from, self.width, "a node number")?);
            from += self.width;
        }
        Ok(())
    }
}
