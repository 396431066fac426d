//! Joins corners with equal coordinates. The nodes found so far stand in a hash table, which moves to a mapped scratch
//! file as it outgrows its memory; nodes and facets go to scratch as they are found.

use std::hash::BuildHasher;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use twox_hash::XxHash3_64;

use crate::error::{Error, Result};
use crate::formats::binary::{Endian, cut_records};
use crate::formats::surface::faces;
use crate::formats::{ElementLayout, ElementSink, NodeBatch, NodeLayout, Outline, Piece};
use crate::input::{Budget, Input, Scratch, ScratchFile, Source};
use crate::mesh::Column;

/// Slots of the table at first.
const SLOTS: usize = 1 << 12;
/// Number of bytes of a point and of a facet in scratch.
const POINT: u64 = 24;
const FACET: u64 = 12;

/// Bits of x, y and z, and the node's number plus one; all zero where nobody lives.
type Slot = [u64; 4];

/// Joins corners to nodes.
pub(super) struct Welder {
    source: Arc<Source>,
    scratch: Scratch,
    budget: Budget,
    slots: Column<Slot>,
    /// The file must not be able to know which coordinates collide.
    seed: u64,
    nodes: u64,
    facets: u64,
    points: Written,
    corners: Written,
}

impl Welder {
    pub(super) fn new(input: &Input) -> Result<Self> {
        let (scratch, budget) = (input.scratch.clone(), input.memory.clone());
        Ok(Self {
            source: Arc::clone(&input.source),
            slots: Column::zeroed(SLOTS, &budget, &scratch)?,
            seed: std::hash::RandomState::new().hash_one(0),
            nodes: 0,
            facets: 0,
            points: Written::new(&scratch)?,
            corners: Written::new(&scratch)?,
            scratch,
            budget,
        })
    }

    /// Number of facets so far.
    pub(super) fn facets(&self) -> u64 {
        self.facets
    }

    /// Takes in the next facet.
    #[inline]
    pub(super) fn facet(&mut self, corners: [[f64; 3]; 3]) -> Result<()> {
        let mut bytes = [0; FACET as usize];
        for (corner, bytes) in corners.into_iter().zip(bytes.as_chunks_mut::<4>().0) {
            *bytes = self.node(corner)?.to_le_bytes();
        }
        self.facets += 1;
        self.corners.write(&bytes)
    }

    /// The number of the node at `point`.
    #[inline]
    fn node(&mut self, point: [f64; 3]) -> Result<u32> {
        if !point.iter().all(|value| value.is_finite()) {
            return Err(Error::malformed("finite coordinates", format!("{point:?}")));
        }
        // -0.0 and 0.0 are one place: their sum is 0.0.
        let point = point.map(|value| value + 0.0);
        let slot = self.find(point.map(f64::to_bits));
        let known = self.slots.rows()[slot][3];
        if known > 0 {
            return Ok((known - 1) as u32);
        }
        self.add(slot, point)
    }

    /// The slot of a node, or the empty one that it shall have.
    #[inline]
    fn find(&self, [x, y, z]: [u64; 3]) -> usize {
        let slots = self.slots.rows();
        let hash = XxHash3_64::oneshot_with_seed(self.seed, bytemuck::bytes_of(&[x, y, z]));
        let mut at = hash as usize & (slots.len() - 1);
        while slots[at][3] > 0 && slots[at][..3] != [x, y, z] {
            at = (at + 1) & (slots.len() - 1);
        }
        at
    }

    fn add(&mut self, slot: usize, point: [f64; 3]) -> Result<u32> {
        let number = u32::try_from(self.nodes).map_err(|_| Error::limit("number of nodes", u32::MAX))?;
        self.nodes += 1;
        let [x, y, z] = point.map(f64::to_bits);
        self.slots.rows_mut()[slot] = [x, y, z, self.nodes];
        let mut bytes = [0; POINT as usize];
        for (bits, bytes) in [x, y, z].into_iter().zip(bytes.as_chunks_mut::<8>().0) {
            *bytes = bits.to_le_bytes();
        }
        self.points.write(&bytes)?;
        if self.nodes as usize > self.slots.rows().len() / 2 {
            self.grow()?;
        }
        Ok(number)
    }

    /// Moves to a table of twice the size.
    #[cold]
    fn grow(&mut self) -> Result<()> {
        let doubled = Column::zeroed(2 * self.slots.rows().len(), &self.budget, &self.scratch)?;
        let old = std::mem::replace(&mut self.slots, doubled);
        for slot in old.rows().iter().filter(|slot| slot[3] > 0) {
            let at = self.find([slot[0], slot[1], slot[2]]);
            self.slots.rows_mut()[at] = *slot;
        }
        Ok(())
    }

    /// Hands out what was found.
    pub(super) fn outline(self, out: &mut dyn Outline) -> Result<()> {
        let path = self.source.path();
        let welded = Arc::new(Welded {
            points: self.points.finish(path)?,
            corners: self.corners.finish(path)?,
            source: Arc::clone(&self.source),
        });
        cut_records(self.nodes, POINT, |span| out.nodes(Piece { layout: welded.clone(), span }))?;
        cut_records(self.facets, FACET, |span| out.elements(Piece { layout: welded.clone(), span }))
    }
}

/// Small records on their way to scratch, gathered: the space that a write takes is accounted for each time.
struct Written {
    file: ScratchFile,
    buffer: Vec<u8>,
}

impl Written {
    fn new(scratch: &Scratch) -> Result<Self> {
        Ok(Self { file: scratch.file()?, buffer: Vec::new() })
    }

    #[inline]
    fn write(&mut self, record: &[u8]) -> Result<()> {
        const MOST: usize = 64 << 10;
        self.buffer.extend_from_slice(record);
        if self.buffer.len() < MOST {
            return Ok(());
        }
        self.file.write(&self.buffer)?;
        self.buffer.clear();
        Ok(())
    }

    fn finish(mut self, path: &Path) -> Result<Source> {
        self.file.write(&self.buffer)?;
        self.file.into_source(path)
    }
}

/// Nodes and facets in scratch; a span is a range of their numbers.
#[derive(Debug)]
struct Welded {
    source: Arc<Source>,
    points: Source,
    corners: Source,
}

impl NodeLayout for Welded {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let window = self.points.window(POINT * span.start..POINT * span.end);
        for bytes in window.chunks_exact(POINT as usize) {
            out.push_next([0, 8, 16].map(|axis| Endian::Little.f64(&bytes[axis..])))?;
        }
        Ok(())
    }
}

impl ElementLayout for Welded {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        let window = self.corners.window(FACET * span.start..FACET * span.end);
        for (bytes, label) in window.chunks_exact(FACET as usize).zip(span) {
            let ids = [0, 4, 8].map(|corner| u64::from(Endian::Little.u32(&bytes[corner..])));
            out.element(label, faces::triangle(), &ids)?;
        }
        Ok(())
    }
}
