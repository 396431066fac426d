//! Records of the datasets of nodes and elements, in their columns.

use std::ops::Range;
use std::sync::Arc;

use super::types::{self, Types};
use crate::error::{Error, Result};
use crate::formats::columns::{cut_off, integer, real};
use crate::formats::{ElementLayout, ElementSink, NodeBatch, NodeLayout, text};
use crate::input::{Source, Spot};

/// Columns of an integer.
const WIDTH: usize = 10;
/// Nodes on a line.
const ON_A_LINE: usize = 8;
/// Most nodes of an element: rigid ones have as many as they like.
const MOST_NODES: u64 = 1 << 16;

/// A dataset of nodes.
#[derive(Debug)]
pub(super) struct NodeDataset {
    number: u64,
    /// Lines of a record: coordinates stand on the last.
    pub(super) lines: usize,
    /// Column of the first coordinate, and columns of each.
    from: usize,
    width: usize,
}

static NODE_DATASETS: [NodeDataset; 3] = [
    NodeDataset { number: 2411, lines: 2, from: 0, width: 25 },
    NodeDataset { number: 781, lines: 2, from: 0, width: 25 },
    NodeDataset { number: 15, lines: 1, from: 40, width: 13 },
];

impl NodeDataset {
    pub(super) fn find(number: &[u8]) -> Option<&'static Self> {
        let number = text::integer(number.trim_ascii())?;
        NODE_DATASETS.iter().find(|dataset| dataset.number == number)
    }
}

/// Decodes nodes.
pub(super) struct NodeRecords {
    pub(super) source: Arc<Source>,
    pub(super) dataset: &'static NodeDataset,
}

impl NodeLayout for NodeRecords {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let window = self.source.window(span.clone());
        let mut lines = text::lines(span.start, &window);
        let NodeDataset { lines: two, from, width, .. } = *self.dataset;
        while let Some(line) = lines.next() {
            out.at = Spot::Text(line.at);
            let id = integer(line.bytes, 0, WIDTH, "a node number")?;
            let last = if two == 2 { lines.next() } else { Some(line) };
            let last = last.ok_or_else(|| cut_off(&self.source, "the coordinates of a node"))?;
            out.at = Spot::Text(last.at);
            let mut point = [0.0; 3];
            for (k, value) in point.iter_mut().enumerate() {
                *value = real(last.bytes, from + width * k, width, "a coordinate")?;
            }
            out.push(id, point)?;
        }
        Ok(())
    }
}

/// A dataset of elements.
#[derive(Debug)]
pub(super) struct ElementDataset {
    number: u64,
    /// Which integer of the first line is the number of nodes.
    nodes: usize,
    /// Which integer is the number of the physical property.
    property: usize,
    /// Whether beams have a line more, between the first and the nodes.
    beam_line: bool,
}

static ELEMENT_DATASETS: [ElementDataset; 3] = [
    ElementDataset { number: 2412, nodes: 5, property: 2, beam_line: true },
    ElementDataset { number: 780, nodes: 7, property: 3, beam_line: true },
    ElementDataset { number: 71, nodes: 6, property: 2, beam_line: false },
];

/// The first line of an element.
pub(super) struct Head {
    pub(super) label: u64,
    /// Number of its descriptor.
    pub(super) descriptor: u64,
    pub(super) nodes: usize,
}

impl ElementDataset {
    pub(super) fn find(number: &[u8]) -> Option<&'static Self> {
        let number = text::integer(number.trim_ascii())?;
        ELEMENT_DATASETS.iter().find(|dataset| dataset.number == number)
    }

    /// Reads the first line of an element.
    #[inline]
    pub(super) fn head(&self, line: &[u8]) -> Result<Head> {
        let label = integer(line, 0, WIDTH, "an element number")?;
        let descriptor = integer(line, WIDTH, WIDTH, "the number of an element descriptor")?;
        let nodes = integer(line, WIDTH * self.nodes, WIDTH, "a number of nodes")?;
        if nodes > MOST_NODES {
            return Err(Error::limit("number of nodes of an element", MOST_NODES));
        }
        Ok(Head { label, descriptor, nodes: nodes as usize })
    }

    /// Lines of an element after its first.
    pub(super) fn more_lines(&self, head: &Head) -> usize {
        head.nodes.div_ceil(ON_A_LINE) + usize::from(self.has_beam_line(head))
    }

    fn has_beam_line(&self, head: &Head) -> bool {
        self.beam_line && types::is_beam(head.descriptor)
    }
}

/// Decodes elements.
pub(super) struct ElementRecords {
    pub(super) source: Arc<Source>,
    pub(super) dataset: &'static ElementDataset,
}

impl ElementLayout for ElementRecords {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        let window = self.source.window(span.clone());
        let mut lines = text::lines(span.start, &window);
        let mut types = Types::default();
        let mut ids = Vec::new();
        while let Some(line) = lines.next() {
            out.at = Spot::Text(line.at);
            let head = self.dataset.head(line.bytes)?;
            if self.dataset.has_beam_line(&head) {
                lines.next();
            }
            ids.clear();
            while ids.len() < head.nodes {
                let cut = || cut_off(&self.source, format!("{} nodes of element {}", head.nodes, head.label));
                let more = lines.next().ok_or_else(cut)?;
                out.at = Spot::Text(more.at);
                for k in 0..ON_A_LINE.min(head.nodes - ids.len()) {
                    ids.push(integer(more.bytes, WIDTH * k, WIDTH, "a node number")?);
                }
            }
            out.at = Spot::Text(line.at);
            if out.wants_regions() {
                let at = WIDTH * self.dataset.property;
                let property = integer(line.bytes, at, WIDTH, "a physical property")?;
                out.region(property, || property.to_string())?;
            }
            out.element(head.label, types.find(&head)?, &ids)?;
        }
        Ok(())
    }
}
