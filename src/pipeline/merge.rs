//! The merge stage: puts what the workers found into the order of the file and merges it along a fixed tree.

use std::collections::BTreeMap;

use crossbeam_channel::{Receiver, Sender};

use super::duplicates::Fingerprints;
use super::each::Rows;
use super::listing::Listing;
use super::measure::ShapeStatistics;
use crate::error::{Error, Result};
use crate::formats::Ledger;
use crate::mesh::{Origin, Shape};
use crate::statistics::Tree;

/// What a piece held besides its chunks, and how many those were.
type Done = Result<(Ledger, u32)>;

/// What workers tell the merge stage.
pub(super) enum Message {
    /// A chunk is measured.
    Chunk {
        origin: Origin,
        shape: Shape,
        found: Box<ShapeStatistics>,
        rows: Option<Box<Rows>>,
        prints: Vec<u128>,
    },
    /// A piece is decoded, into so many chunks; or it failed.
    Piece { number: u64, done: Done },
    /// A worker has panicked; its thread will say how.
    Panicked,
}

/// Statistics by shape.
pub(super) type ByShape = [Option<Box<ShapeStatistics>>; Shape::ALL.len()];

/// All that was found, but for the bins.
#[derive(Default)]
pub(super) struct Merged {
    pub shapes: ByShape,
    pub ledger: Ledger,
    /// What the costly checks found, where they were made.
    pub duplicate_elements: Option<u64>,
    pub coincident_nodes: Option<u64>,
}

/// A piece of which not everything has come in.
#[derive(Default)]
struct Pending {
    chunks: BTreeMap<u32, (Shape, Box<ShapeStatistics>)>,
    /// The single elements of the chunks, where somebody takes them.
    rows: Vec<(Shape, Box<Rows>)>,
    done: Option<(Ledger, u32)>,
}

impl Pending {
    fn is_complete(&self) -> bool {
        self.done.as_ref().is_some_and(|(_, chunks)| *chunks as usize == self.chunks.len())
    }
}

/// Merges until all workers have ended. Of several errors the first in the file counts: pieces are taken in order, so
/// whoever fails, all pieces before it are still brought to their end. Single elements go to `listing`, and their
/// fingerprints to `fingerprints`, if there are such.
pub(super) fn merge(
    results: &Receiver<Message>,
    tickets: Sender<()>,
    mut listing: Option<Listing<'_>>,
    mut fingerprints: Option<&mut Fingerprints>,
) -> Result<Merged> {
    let mut tickets = Some(tickets);
    let mut pending: BTreeMap<u64, Pending> = BTreeMap::new();
    let mut failed: Option<(u64, Error)> = None;
    let mut tree = Tree::new(merge_shapes);
    let mut ledger = Ledger::default();
    let mut next = 0;
    for message in results {
        match message {
            Message::Chunk { origin, shape, found, rows, prints } => {
                if let Some(all) = &mut fingerprints
                    && let Err(error) = prints.into_iter().try_for_each(|print| all.add(print))
                {
                    (tickets, fingerprints) = (None, None);
                    failed.get_or_insert((origin.piece, error));
                }
                let piece = pending.entry(origin.piece).or_default();
                piece.chunks.insert(origin.chunk, (shape, found));
                piece.rows.extend(rows.map(|rows| (shape, rows)));
            }
            Message::Piece { number, done: Ok(done) } => pending.entry(number).or_default().done = Some(done),
            Message::Piece { number, done: Err(error) } => {
                tickets = None;
                if failed.as_ref().is_none_or(|(first, _)| number < *first) {
                    failed = Some((number, error));
                }
            }
            Message::Panicked => tickets = None,
        }
        while pending.get(&next).is_some_and(Pending::is_complete) {
            let mut piece = pending.remove(&next).unwrap_or_default();
            if let (Some(listing), None) = (&mut listing, &failed)
                && let Err(error) = listing.piece(std::mem::take(&mut piece.rows))
            {
                (tickets, failed) = (None, Some((next, error)));
            }
            next += 1;
            if let Some((found, _)) = &piece.done {
                ledger.merge(found);
            }
            tree.push(piece_statistics(piece));
            if let Some(tickets) = &tickets {
                // The workers have all the pieces they want.
                let _ = tickets.send(());
            }
        }
    }
    match failed {
        Some((_, error)) => Err(error),
        None => Ok(Merged { shapes: tree.finish().unwrap_or_default(), ledger, ..Merged::default() }),
    }
}

/// The chunks of one piece, merged in their order.
fn piece_statistics(piece: Pending) -> ByShape {
    let mut shapes = ByShape::default();
    for (shape, found) in piece.chunks.into_values() {
        match &mut shapes[shape.index()] {
            Some(mine) => mine.merge(&found),
            empty => *empty = Some(found),
        }
    }
    shapes
}

fn merge_shapes(mine: &mut ByShape, theirs: &ByShape) {
    for (mine, theirs) in mine.iter_mut().zip(theirs) {
        match (mine.as_mut(), theirs) {
            (Some(mine), Some(theirs)) => mine.merge(theirs),
            (None, Some(theirs)) => *mine = Some(theirs.clone()),
            (_, None) => {}
        }
    }
}
