//! Elements whose nodes stand in arrays.

use std::ops::Range;
use std::sync::Arc;

use super::Array;
use super::regions::InRegions;
use super::table::Table;
use crate::error::{Error, Result};
use crate::formats::binary::cut_records;
use crate::formats::{ElementLayout, ElementSink, Outline, Piece};
use crate::input::Source;
use crate::mesh::ElementType;

/// Elements of one type.
#[derive(Debug)]
pub struct Elements {
    /// The mesh file, for errors.
    pub file: Arc<Source>,
    /// The type; as many nodes as it has stand in a record.
    pub kind: Arc<ElementType>,
    /// Numbers of the nodes.
    pub nodes: Table,
    /// The elements' own numbers.
    pub labels: Labels,
    /// Which nodes are meant.
    pub range: NodeRange,
    /// Which regions they are in.
    pub regions: InRegions,
}

/// The elements' own numbers.
#[derive(Debug)]
pub enum Labels {
    /// One after another from this one on.
    From(u64),
    /// An array of them.
    Listed(Array),
}

/// The nodes that an element of one part of a file may name.
#[derive(Debug, Clone, Copy, Default)]
pub struct NodeRange {
    /// What is added to a number as it stands there.
    pub offset: u64,
    /// First and last number as it stands there, where the file has several parts: others would be another part's nodes.
    pub within: Option<(u64, u64)>,
}

impl NodeRange {
    /// Turns the numbers of an element's nodes as they stand in the file into those within the whole file.
    #[inline]
    pub fn resolve(&self, label: u64, ids: &mut [u64]) -> Result<()> {
        if ids.iter().fold(0, |all, id| all | id) > i64::MAX as u64 {
            return Err(wrong_node(label, ids, "a node's number, 0 or more,", |id| id > i64::MAX as u64));
        }
        if let Some((first, last)) = self.within {
            if ids.iter().any(|id| *id < first || *id > last) {
                let expected = format!("a node's number from {first} to {last}");
                return Err(wrong_node(label, ids, &expected, |id| id < first || id > last));
            }
            ids.iter_mut().for_each(|id| *id = id.wrapping_add(self.offset));
        }
        Ok(())
    }
}

#[cold]
fn wrong_node(label: u64, ids: &[u64], expected: &str, wrong: impl Fn(u64) -> bool) -> Error {
    let found = ids.iter().copied().find(|id| wrong(*id)).unwrap_or_default();
    Error::malformed(format!("{expected} in element {label}"), format!("{}", found.cast_signed()))
}

impl Elements {
    /// Hands out the elements, cut into pieces.
    pub fn outline(self, out: &mut dyn Outline) -> Result<()> {
        let (count, width) = (self.nodes.len(), self.nodes.record_bytes());
        let layout: Arc<dyn ElementLayout> = Arc::new(self);
        cut_records(count, width, |span| out.elements(Piece { layout: Arc::clone(&layout), span }))
    }
}

impl ElementLayout for Elements {
    fn source(&self) -> &Source {
        &self.file
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        let (mut ids, mut labels) = (Vec::new(), Vec::new());
        self.nodes.integers(span.clone(), &mut ids);
        match &self.labels {
            Labels::From(first) => labels.extend(span.clone().map(|k| first + k)),
            Labels::Listed(array) => array.integers(span.clone(), &mut labels),
        }
        let regions = self.regions.begin(span.clone(), out)?;
        let records = ids.chunks_exact_mut(self.nodes.width());
        for (k, ((element, record), label)) in span.zip(records).zip(labels).enumerate() {
            out.at = self.nodes.spot(element);
            if let Some(region) = regions.get(k) {
                self.regions.enter(*region, out)?;
            }
            self.range.resolve(label, record)?;
            out.element(label, &self.kind, record)?;
        }
        Ok(())
    }
}

/// Nodes of elements that are counted elsewhere: they are noted as used.
#[derive(Debug)]
pub struct UsedNodes {
    /// The mesh file, for errors.
    pub file: Arc<Source>,
    /// Numbers of nodes.
    pub nodes: Array,
    /// Which nodes are meant.
    pub range: NodeRange,
}

impl UsedNodes {
    /// Hands out the numbers, cut into pieces.
    pub fn outline(self, out: &mut dyn Outline) -> Result<()> {
        let (count, width) = (self.nodes.len(), self.nodes.width());
        let layout: Arc<dyn ElementLayout> = Arc::new(self);
        cut_records(count, width, |span| out.elements(Piece { layout: Arc::clone(&layout), span }))
    }
}

impl ElementLayout for UsedNodes {
    fn source(&self) -> &Source {
        &self.file
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        let mut ids = Vec::new();
        self.nodes.integers(span.clone(), &mut ids);
        for (k, id) in span.zip(&mut ids) {
            out.at = self.nodes.spot(k);
            let id = std::slice::from_mut(id);
            self.range.resolve(0, id)?;
            out.mark_used(id);
        }
        Ok(())
    }
}
