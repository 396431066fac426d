//! Coordinates and elements of one piece, in either encoding.

use std::ops::Range;
use std::sync::Arc;

use super::entities::Entities;
use crate::error::{Error, Result};
use crate::formats::binary::Endian;
use crate::formats::words::Words;
use crate::formats::{ElementLayout, ElementSink, NodeBatch, NodeLayout};
use crate::input::{Source, Spot};
use crate::mesh::ElementType;

/// Where a mesh's own numbers stop: a file may hold several meshes, and the bits above say which one a node is of.
pub(super) const NUMBERS: u64 = 1 << 40;

/// How numbers are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    /// `.mphtxt`
    Text,
    /// `.mphbin`: whole numbers of 4 bytes, reals of 8, least significant byte first.
    Binary,
}

/// Rows of coordinates; a span is a range of bytes.
#[derive(Debug)]
pub(super) struct Points {
    pub(super) source: Arc<Source>,
    pub(super) encoding: Encoding,
    /// Number of coordinates in a row, 1 to 3.
    pub(super) dimension: usize,
    /// The number of the first node.
    pub(super) first: u64,
}

impl NodeLayout for Points {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let window = self.source.window(span.clone());
        let mut id = self.first;
        match self.encoding {
            Encoding::Text => {
                let mut words = Words::new(span.start, &window);
                while words.more() {
                    out.at = words.spot();
                    let mut point = [0.0; 3];
                    for x in &mut point[..self.dimension] {
                        *x = words.real("a coordinate")?;
                    }
                    out.push(id, point)?;
                    id += 1;
                }
            }
            Encoding::Binary => {
                let width = 8 * self.dimension;
                for (k, row) in window.chunks_exact(width).enumerate() {
                    out.at = Spot::Binary(span.start + (k * width) as u64);
                    let mut point = [0.0; 3];
                    for (x, raw) in point.iter_mut().zip(row.chunks_exact(8)) {
                        *x = Endian::Little.f64(raw);
                    }
                    out.push(id, point)?;
                    id += 1;
                }
            }
        }
        Ok(())
    }
}

/// Rows of elements of one type; a span is a range of bytes.
#[derive(Debug)]
pub(super) struct Elements {
    pub(super) source: Arc<Source>,
    pub(super) encoding: Encoding,
    pub(super) kind: Arc<ElementType>,
    /// What the numbers of the mesh's nodes have above their own.
    pub(super) mesh: u64,
    /// The number of the first element.
    pub(super) first: u64,
    /// Its place among those of its type.
    pub(super) row: u64,
    /// The geometric entities that the elements lie in.
    pub(super) entities: Arc<Entities>,
}

impl ElementLayout for Elements {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        let window = self.source.window(span.clone());
        let mut ids = vec![0; self.kind.nodes];
        let mut label = self.first;
        // An element takes two bytes a node at the least.
        let most = window.len() / (2 * self.kind.nodes).max(1) + 1;
        let numbers = if out.wants_regions() { self.entities.numbers(self.row, most)? } else { Vec::new() };
        let mut numbers = numbers.into_iter();
        match self.encoding {
            Encoding::Text => {
                let mut words = Words::new(span.start, &window);
                while words.more() {
                    out.at = words.spot();
                    self.enter(numbers.next(), out)?;
                    for id in &mut ids {
                        *id = self.node(words.integer("the number of an element's node")?);
                    }
                    out.element(label, &self.kind, &ids)?;
                    label += 1;
                }
            }
            Encoding::Binary => {
                let width = 4 * self.kind.nodes;
                for (k, row) in window.chunks_exact(width).enumerate() {
                    out.at = Spot::Binary(span.start + (k * width) as u64);
                    self.enter(numbers.next(), out)?;
                    for (id, raw) in ids.iter_mut().zip(row.as_chunks::<4>().0) {
                        let number = i32::from_le_bytes(*raw);
                        *id = self.node(u64::try_from(number).map_err(|_| {
                            Error::malformed("the number of an element's node", format!("{number}"))
                        })?);
                    }
                    out.element(label, &self.kind, &ids)?;
                    label += 1;
                }
            }
        }
        Ok(())
    }
}

impl Elements {
    /// The element that follows lies in the entity of that number, if it has one.
    #[inline]
    fn enter(&self, entity: Option<i64>, out: &mut ElementSink<'_>) -> Result<()> {
        let Some(number) = entity else { return Ok(()) };
        out.region(number.cast_unsigned(), || self.entities.name(number))
    }

    /// A node's number in the whole file; none where the mesh cannot have such a node.
    #[inline]
    fn node(&self, number: u64) -> u64 {
        if number < NUMBERS { self.mesh + number } else { u64::MAX }
    }
}
