//! The node stage: pieces are decoded by several threads and put into the table in the order of the file.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use crossbeam_channel::{Receiver, Sender, bounded};

use super::Progress;
use crate::error::Result;
use crate::formats::{NodeBatch, NodeLayout, Piece};
use crate::mesh::{Nodes, NodesBuilder};

/// A decoded piece with its number; nothing from a worker that has panicked.
type Decoded = Option<(usize, Result<NodeBatch>)>;

/// Reads all nodes.
pub(super) fn read_nodes(
    pieces: &[Piece<dyn NodeLayout>],
    threads: usize,
    mut builder: NodesBuilder,
    progress: &Progress,
) -> Result<Nodes> {
    // A worker takes an empty batch before it takes a piece. So there are never more batches than these, and the piece
    // that the table waits for always has one.
    let batches = threads + 2;
    let (empty_out, empty_in) = bounded(batches);
    let (full_out, full_in) = bounded(batches);
    for _ in 0..batches {
        empty_out.send(NodeBatch::default()).expect("the channel has room for every batch");
    }
    let next = AtomicUsize::new(0);
    thread::scope(|scope| {
        for _ in 0..threads.min(pieces.len()) {
            let (empty, full) = (empty_in.clone(), full_out.clone());
            let next = &next;
            scope.spawn(move || decode(pieces, next, &empty, &full));
        }
        drop((empty_in, full_out));
        // It takes its ends of the channels along: once it has met an error, nobody waits for a batch.
        append(pieces.len(), full_in, empty_out, &mut builder, progress)
    })?;
    builder.finish()
}

/// Decodes pieces until there are none left or somebody has failed.
fn decode(
    pieces: &[Piece<dyn NodeLayout>],
    next: &AtomicUsize,
    empty: &Receiver<NodeBatch>,
    full: &Sender<Decoded>,
) {
    let _end = SendsPanic(full.clone());
    while let Ok(mut batch) = empty.recv() {
        let number = next.fetch_add(1, Ordering::Relaxed);
        let Some(piece) = pieces.get(number) else { return };
        batch.clear();
        let done = piece.layout.decode(piece.span.clone(), &mut batch);
        let done = done.map_err(|error| piece.layout.source().place(error, batch.at)).map(|()| batch);
        // The other end has gone: it has met the error of an earlier piece, which is the one that counts.
        if full.send(Some((number, done))).is_err() {
            return;
        }
    }
}

/// Tells the other end that a worker has panicked: the piece that it had will never come.
struct SendsPanic(Sender<Decoded>);

impl Drop for SendsPanic {
    fn drop(&mut self) {
        if thread::panicking() {
            let _ = self.0.send(None);
        }
    }
}

/// Appends batches in the order of their pieces; the first piece in the file that fails gives the error.
fn append(
    pieces: usize,
    full: Receiver<Decoded>,
    empty: Sender<NodeBatch>,
    builder: &mut NodesBuilder,
    progress: &Progress,
) -> Result<()> {
    let mut waiting = BTreeMap::new();
    let mut next = 0;
    for decoded in full {
        // The scope of the threads passes the panic on.
        let Some((number, decoded)) = decoded else { return Ok(()) };
        waiting.insert(number, decoded);
        while let Some(decoded) = waiting.remove(&next) {
            let batch = decoded?;
            if next == 0 {
                builder.expect(batch.rows().len().saturating_mul(pieces));
            }
            builder.extend(batch.ids(), batch.rows())?;
            progress.done(0);
            next += 1;
            // No worker is left to take it: the pieces are all taken.
            let _ = empty.send(batch);
        }
    }
    Ok(())
}
