//! Tables of binary records of one width.

use std::ops::Range;
use std::sync::Arc;

use crate::error::{Error, Result};
use crate::formats::binary::{Endian, cut_records};
use crate::formats::{BLOCK, ElementLayout, ElementSink, NodeBatch, NodeLayout, Outline, Piece};
use crate::input::{Source, Spot, Window};
use crate::mesh::ElementType;

/// How numbers are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Words {
    /// The order of their bytes.
    pub endian: Endian,
    /// Bytes of a whole number, 4 or 8.
    pub word: usize,
    /// Bytes of a real number, 4 or 8.
    pub real: usize,
}

impl Words {
    /// The whole number at the start of `bytes`, as if it had no sign.
    #[inline]
    pub fn integer(self, bytes: &[u8]) -> u64 {
        if self.word == 4 { self.endian.u32(bytes).into() } else { self.endian.u64(bytes) }
    }

    /// A whole number of either sign, as [`Self::integer`] gives it.
    pub fn signed(self, number: u64) -> i64 {
        if self.word == 4 { i64::from(number as u32 as i32) } else { number as i64 }
    }

    /// The real number at the start of `bytes`.
    #[inline]
    pub fn real(self, bytes: &[u8]) -> f64 {
        if self.real == 4 { self.endian.f32(bytes).into() } else { self.endian.f64(bytes) }
    }

    /// The numbers of a record's nodes; says whether none is negative.
    #[inline]
    fn ids<const WORD: usize>(self, record: &[u8], ids: &mut [u64]) -> bool {
        let (words, _) = record.as_chunks::<WORD>();
        let mut all = 0;
        let endian = self.endian;
        for (id, word) in ids.iter_mut().zip(words) {
            *id = if WORD == 4 { endian.u32(word).into() } else { endian.u64(word) };
            all |= *id;
        }
        all >> (8 * WORD - 1) == 0
    }
}

#[cold]
fn negative(ids: &[u64], word: usize) -> Error {
    let id = ids.iter().find(|id| **id >> (8 * word - 1) != 0).copied().unwrap_or_default();
    let id = if word == 4 { i64::from(id as u32 as i32) } else { id as i64 };
    Error::malformed("the number of a node", id.to_string())
}

/// Records of coordinates; a span is a range of record numbers.
#[derive(Debug)]
pub struct NodeRecords {
    /// The file.
    pub source: Arc<Source>,
    /// How its numbers are stored.
    pub words: Words,
    /// Where the first record starts.
    pub at: u64,
    /// Bytes of a record.
    pub width: usize,
    /// Number of coordinates, with which a record begins.
    pub dimension: usize,
    /// Number of the first node.
    pub first: u64,
}

impl NodeRecords {
    /// Hands out `count` records, which must be in the file, cut into pieces.
    pub fn outline(self, count: u64, out: &mut dyn Outline) -> Result<()> {
        let width = self.width as u64;
        let layout: Arc<dyn NodeLayout> = Arc::new(self);
        cut_records(count, width, |span| out.nodes(Piece { layout: Arc::clone(&layout), span }))
    }
}

impl NodeLayout for NodeRecords {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let (width, at) = (self.width as u64, self.at + span.start * self.width as u64);
        let window = self.source.window(at..self.at + span.end * width);
        for (k, record) in window.chunks_exact(self.width).enumerate() {
            out.at = Spot::Binary(at + k as u64 * width);
            let mut point = [0.0; 3];
            for (axis, x) in point[..self.dimension].iter_mut().enumerate() {
                *x = self.words.real(&record[axis * self.words.real..]);
            }
            out.push(self.first + span.start + k as u64, point)?;
        }
        Ok(())
    }
}

/// Records of nodes' numbers; a span is a range of record numbers.
#[derive(Debug)]
pub struct ElementRecords {
    /// The file.
    pub source: Arc<Source>,
    /// How its numbers are stored.
    pub words: Words,
    /// Where the first record starts.
    pub at: u64,
    /// Bytes of a record, which begins with the numbers of the nodes; a word that follows is the region.
    pub width: usize,
    /// The elements' type.
    pub kind: &'static Arc<ElementType>,
    /// Number of the first element.
    pub first: u64,
}

impl ElementRecords {
    /// Hands out `count` records, which must be in the file, cut into pieces.
    pub fn outline(self, count: u64, out: &mut dyn Outline) -> Result<()> {
        let width = self.width as u64;
        let layout: Arc<dyn ElementLayout> = Arc::new(self);
        cut_records(count, width, |span| out.elements(Piece { layout: Arc::clone(&layout), span }))
    }

    /// The numbers of nodes that nearly all meshes are made of have a loop of their own.
    fn decode_words<const WORD: usize>(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        match self.kind.nodes {
            3 => self.decode_blocks::<WORD, 3>(span, out),
            4 => self.decode_blocks::<WORD, 4>(span, out),
            5 => self.decode_blocks::<WORD, 5>(span, out),
            6 => self.decode_blocks::<WORD, 6>(span, out),
            8 => self.decode_blocks::<WORD, 8>(span, out),
            10 => self.decode_blocks::<WORD, 10>(span, out),
            _ => self.decode_any::<WORD>(span.start, &self.window(&span), out),
        }
    }

    fn window(&self, span: &Range<u64>) -> Window<'_> {
        let width = self.width as u64;
        self.source.window(self.at + span.start * width..self.at + span.end * width)
    }

    fn decode_blocks<const WORD: usize, const NODES: usize>(
        &self,
        span: Range<u64>,
        out: &mut ElementSink<'_>,
    ) -> Result<()> {
        let mut ids = [[0; NODES]; BLOCK];
        for (number, block) in self.window(&span).chunks(BLOCK * self.width).enumerate() {
            let (count, first) = (block.len() / self.width, span.start + (number * BLOCK) as u64);
            let labels: [u64; BLOCK] = std::array::from_fn(|k| self.first + first + k as u64);
            let mut good = true;
            for (ids, record) in ids.iter_mut().zip(block.chunks_exact(self.width)) {
                good &= self.words.ids::<WORD>(record, ids);
            }
            // Where somebody asks for regions, each element has its own.
            let alike = !out.wants_regions() || self.width == NODES * WORD;
            if !good || !alike || !out.block(self.kind, &labels[..count], ids[..count].as_flattened())? {
                self.decode_any::<WORD>(first, block, out)?;
            }
        }
        Ok(())
    }

    /// The word after the nodes, if there is one, is the region.
    #[inline]
    fn enter_region<const WORD: usize>(&self, record: &[u8], out: &mut ElementSink<'_>) -> Result<()> {
        match record.get(self.kind.nodes * WORD..).filter(|rest| rest.len() >= WORD) {
            Some(rest) => {
                let reference = self.words.integer(rest);
                out.region(reference, || self.words.signed(reference).to_string())
            }
            None => Ok(()),
        }
    }

    /// Record by record: elements with many nodes, and blocks with an error in them, which this finds.
    fn decode_any<const WORD: usize>(
        &self,
        first: u64,
        records: &[u8],
        out: &mut ElementSink<'_>,
    ) -> Result<()> {
        let mut ids = vec![0; self.kind.nodes];
        for (record, number) in records.chunks_exact(self.width).zip(first..) {
            out.at = Spot::Binary(self.at + number * self.width as u64);
            if !self.words.ids::<WORD>(record, &mut ids) {
                return Err(negative(&ids, WORD));
            }
            self.enter_region::<WORD>(record, out)?;
            out.element(self.first + number, self.kind, &ids)?;
        }
        Ok(())
    }
}

impl ElementLayout for ElementRecords {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        match self.words.word {
            4 => self.decode_words::<4>(span, out),
            _ => self.decode_words::<8>(span, out),
        }
    }
}
