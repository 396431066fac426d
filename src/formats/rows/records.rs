//! Tables of binary records of one width.

use std::ops::Range;
use std::sync::Arc;

use crate::error::{Error, Result};
use crate::formats::binary::{Endian, cut_records};
use crate::formats::{ElementLayout, ElementSink, NodeBatch, NodeLayout, Outline, Piece};
use crate::input::{Source, Spot};
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

    /// The real number at the start of `bytes`.
    #[inline]
    pub fn real(self, bytes: &[u8]) -> f64 {
        if self.real == 4 { self.endian.f32(bytes).into() } else { self.endian.f64(bytes) }
    }

    #[inline]
    fn ids<const WORD: usize>(self, record: &[u8], ids: &mut [u64]) -> Result<()> {
        let (words, _) = record.as_chunks::<WORD>();
        let mut all = 0;
        let endian = self.endian;
        for (id, word) in ids.iter_mut().zip(words) {
            *id = if WORD == 4 { endian.u32(word).into() } else { endian.u64(word) };
            all |= *id;
        }
        if all >> (8 * WORD - 1) != 0 {
            return Err(negative(ids, WORD));
        }
        Ok(())
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
    /// Bytes of a record, which begins with the numbers of the nodes.
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
            3 => self.decode_ids::<WORD, _>(span, [0; 3], out),
            4 => self.decode_ids::<WORD, _>(span, [0; 4], out),
            5 => self.decode_ids::<WORD, _>(span, [0; 5], out),
            6 => self.decode_ids::<WORD, _>(span, [0; 6], out),
            8 => self.decode_ids::<WORD, _>(span, [0; 8], out),
            10 => self.decode_ids::<WORD, _>(span, [0; 10], out),
            nodes => self.decode_ids::<WORD, _>(span, vec![0; nodes], out),
        }
    }

    fn decode_ids<const WORD: usize, I: AsMut<[u64]>>(
        &self,
        span: Range<u64>,
        mut ids: I,
        out: &mut ElementSink<'_>,
    ) -> Result<()> {
        let (width, at) = (self.width as u64, self.at + span.start * self.width as u64);
        let window = self.source.window(at..self.at + span.end * width);
        let ids = ids.as_mut();
        for (k, record) in window.chunks_exact(self.width).enumerate() {
            out.at = Spot::Binary(at + k as u64 * width);
            self.words.ids::<WORD>(record, ids)?;
            out.element(self.first + span.start + k as u64, self.kind, ids)?;
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
