//! How the coordinates of a node table that is not in memory are come by: by looking where they are, or by a join.
//!
//! Where elements that follow each other use nodes that lie near each other, the system brings in what is looked at, and it
//! is little. Where numbers are in no order, nearly every look would bring in a page for one node: then elements and nodes
//! are joined by streams alone. Which it is, a few pairs of neighbouring pieces tell, by the bytes that either way moves.

use super::Options;
use super::row_map::RowMap;
use crate::error::Result;
use crate::formats::{Chunks, ElementLayout, ElementSink, Piece};
use crate::mesh::{Chunk, Nodes};

/// Pairs of pieces that are looked at.
const SAMPLES: usize = 8;
/// Bytes of a page, and of a node.
const PAGE: u64 = 4096;
const NODE: u64 = 24;
/// Bytes that a join moves for each node of a piece: its number is written once and read twice, its point written and read.
const JOINED: u64 = 3 * 4 + 2 * NODE;

/// What the pairs told, by element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Locality {
    /// Bytes of pages that a piece needs and the piece before did not.
    pub paged: f64,
    /// Bytes that a join would move.
    pub joined: f64,
    /// Bytes of pages that a piece needs anew.
    pub paged_by_piece: f64,
}

/// Distinct rows that one piece of elements uses, in ascending order.
#[derive(Debug, Default)]
pub(super) struct Used {
    map: RowMap,
    sorted: Vec<u32>,
    elements: u64,
    spare: Option<Chunk>,
}

impl Used {
    /// Reads a piece.
    pub(super) fn read(
        &mut self,
        piece: &Piece<dyn ElementLayout>,
        number: usize,
        nodes: &Nodes,
        options: &Options,
    ) -> Result<()> {
        self.map.clear();
        self.elements = 0;
        let mut sink = ElementSink::new(nodes, self, number as u64, options.allow_missing_nodes);
        let done = piece.layout.decode(piece.span.clone(), &mut sink);
        let at = sink.at;
        done.and_then(|()| sink.finish()).map_err(|error| piece.layout.source().place(error, at))?;
        self.sorted.clear();
        self.sorted.extend_from_slice(self.map.rows());
        self.sorted.sort_unstable();
        Ok(())
    }

    /// The rows.
    pub(super) fn rows(&self) -> &[u32] {
        &self.sorted
    }

    /// Pages that the rows lie on, in ascending order.
    fn pages(&self) -> Vec<u64> {
        let mut pages: Vec<_> = self.sorted.iter().map(|row| u64::from(*row) * NODE / PAGE).collect();
        pages.dedup();
        pages
    }
}

impl Chunks for Used {
    fn empty(&mut self) -> Result<Chunk> {
        Ok(self.spare.take().unwrap_or_default())
    }

    fn hand_on(&mut self, chunk: Chunk) -> Result<()> {
        chunk.rows().iter().for_each(|row| self.map.insert(*row));
        self.elements += chunk.len() as u64;
        self.spare = Some(chunk);
        Ok(())
    }
}

/// Looks at pairs of neighbouring pieces from all over the file. Nothing where there are too few pieces, or one is bad: the
/// error is told when its turn comes.
pub(super) fn locality(
    pieces: &[Piece<dyn ElementLayout>],
    nodes: &Nodes,
    options: &Options,
) -> Option<Locality> {
    let (mut first, mut second) = (Used::default(), Used::default());
    let (mut new_pages, mut distinct, mut elements, mut pairs) = (0u64, 0u64, 0u64, 0u64);
    let step = (pieces.len() / SAMPLES).max(2);
    for number in (0..pieces.len().saturating_sub(1)).step_by(step) {
        for (used, number) in [(&mut first, number), (&mut second, number + 1)] {
            used.read(&pieces[number], number, nodes, options).ok()?;
        }
        let known = first.pages();
        new_pages += second.pages().iter().filter(|page| known.binary_search(page).is_err()).count() as u64;
        distinct += second.rows().len() as u64;
        elements += second.elements;
        pairs += 1;
    }
    let by_element = |bytes: u64| bytes as f64 / elements as f64;
    (elements > 0).then(|| Locality {
        paged: by_element(new_pages * PAGE),
        joined: by_element(distinct * JOINED),
        paged_by_piece: (new_pages * PAGE) as f64 / pairs as f64,
    })
}
