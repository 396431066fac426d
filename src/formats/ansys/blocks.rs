//! The rows of `NBLOCK` and `EBLOCK`.

use std::ops::Range;
use std::sync::Arc;

use super::commands::Edit;
use super::types::{MOST_NODES, Table};
use crate::error::{Error, Result};
use crate::formats::columns::{cut_off, field, integer, real_or_zero};
use crate::formats::{ElementLayout, ElementSink, NodeBatch, NodeLayout, text};
use crate::input::{Source, Spot};

/// Numbers before the nodes in a row of solids.
const SOLID_HEAD: usize = 11;
/// Numbers before the nodes in a short row: element, type, real constants, material, coordinate system.
const SHORT_HEAD: usize = 5;

/// Decodes nodes: a number, up to two others, up to three coordinates; those at the end are left out where they are 0.
pub(super) struct NodeRows {
    pub(super) source: Arc<Source>,
    pub(super) edit: Edit,
}

impl NodeLayout for NodeRows {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let window = self.source.window(span.clone());
        let Edit { count, width, real_width } = self.edit;
        for line in text::lines(span.start, &window) {
            out.at = Spot::Text(line.at);
            let id = integer(line.bytes, 0, width, "a node number")?;
            let mut point = [0.0; 3];
            for (k, value) in point.iter_mut().enumerate() {
                *value =
                    real_or_zero(line.bytes, count * width + real_width * k, real_width, "a coordinate")?;
            }
            out.push(id, point)?;
        }
        Ok(())
    }
}

/// Decodes elements.
pub(super) struct ElementRows {
    pub(super) source: Arc<Source>,
    pub(super) edit: Edit,
    /// Whether rows are those of solids.
    pub(super) solid: bool,
    pub(super) table: Arc<Table>,
}

impl ElementLayout for ElementRows {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        let window = self.source.window(span.clone());
        let mut lines = text::lines(span.start, &window);
        let mut ids = Vec::with_capacity(MOST_NODES);
        let mut undefined = Vec::new();
        while let Some(line) = lines.next() {
            out.at = Spot::Text(line.at);
            ids.clear();
            let label = self.number(line.bytes, if self.solid { 10 } else { 0 }, "an element number")?;
            let number = self.number(line.bytes, 1, "a type number")?;
            if out.wants_regions() {
                let material =
                    self.number(line.bytes, if self.solid { 0 } else { 3 }, "a material number")?;
                out.region(material, || material.to_string())?;
            }
            if self.solid {
                let nodes = self.nodes(line.bytes)?;
                let mut from = SOLID_HEAD;
                let mut row = line;
                while ids.len() < nodes {
                    if from == self.edit.count {
                        let cut = || cut_off(&self.source, "the nodes of an element");
                        row = lines.next().ok_or_else(cut)?;
                        out.at = Spot::Text(row.at);
                        from = 0;
                    }
                    ids.push(self.number(row.bytes, from, "a node number")?);
                    from += 1;
                }
            } else {
                let text = line.bytes.trim_ascii_end();
                let nodes = text.len().div_ceil(self.edit.width).saturating_sub(SHORT_HEAD);
                if nodes > MOST_NODES {
                    return Err(Error::limit("number of nodes of an element", MOST_NODES));
                }
                for k in 0..nodes {
                    ids.push(self.number(text, SHORT_HEAD + k, "a node number")?);
                }
            }
            out.at = Spot::Text(line.at);
            self.table.put(number, label, &ids, &mut undefined, out)?;
        }
        Ok(())
    }
}

impl ElementRows {
    /// The number `k` of a row.
    #[inline]
    fn number(&self, line: &[u8], k: usize, what: &str) -> Result<u64> {
        integer(line, k * self.edit.width, self.edit.width, what)
    }

    /// How many nodes a row of solids has.
    #[inline]
    fn nodes(&self, line: &[u8]) -> Result<usize> {
        let nodes = self.number(line, 8, "a number of nodes")?;
        if nodes > MOST_NODES as u64 {
            return Err(Error::limit("number of nodes of an element", MOST_NODES));
        }
        Ok(nodes as usize)
    }

    /// Lines of an element after its first.
    pub(super) fn more_lines(&self, line: &[u8]) -> Result<usize> {
        if !self.solid {
            return Ok(0);
        }
        let on_first = self.edit.count.checked_sub(SOLID_HEAD).filter(|n| *n > 0).ok_or_else(|| {
            let expected =
                format!("a Fortran format of more than {SOLID_HEAD} integers for an EBLOCK of solids");
            Error::malformed(expected, format!("{}", self.edit.count))
        })?;
        if field(line, 0, self.edit.width).is_empty() {
            return Err(Error::malformed("an element or -1", crate::error::excerpt(line)));
        }
        Ok(self.nodes(line)?.saturating_sub(on_first).div_ceil(self.edit.count))
    }
}
