//! The parse stage: workers decode pieces of elements into chunks, and measure chunks.
//!
//! A full chunk goes into a bounded channel, for whoever is free; where nobody is, the worker that filled it measures
//! it itself. So one thread works without waiting, several share whatever there is, and the chunks in flight are a
//! number known at the start.

use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;

use crossbeam_channel::{Receiver, Sender, TrySendError, bounded, select};

use super::duplicates::{self, Fingerprints};
use super::each::Each;
use super::listing::Listing;
use super::measure::{Bins, Workspace, measure};
use super::merge::{Merged, Message, merge};
use super::{Options, Progress};
use crate::error::Result;
use crate::formats::{Chunks, ElementLayout, ElementSink, Piece};
use crate::mesh::{Chunk, Nodes, Regions, Shape};

/// What all workers share.
struct Shared<'a> {
    pieces: &'a [Piece<dyn ElementLayout>],
    nodes: &'a Nodes,
    next: AtomicU64,
    options: &'a Options,
    /// Where elements are tagged with their region and place.
    regions: Option<&'a Regions>,
    keeps_rows: bool,
    progress: &'a Progress,
}

/// One worker's ends of the channels.
#[derive(Clone)]
struct Ends {
    /// A ticket allows one more piece; the merge stage gives it back once the piece is merged, in order.
    tickets: Receiver<()>,
    full_in: Receiver<Chunk>,
    full_out: Sender<Chunk>,
    empty_in: Receiver<Chunk>,
    empty_out: Sender<Chunk>,
    results: Sender<Message>,
}

/// Number of chunks that a run with so many threads has in flight.
pub(super) fn chunks_in_flight(threads: usize) -> usize {
    // One open for each shape and one at hand a thread, and those in the channel.
    threads * (Shape::ALL.len() + 1) + threads
}

/// Measures all elements.
pub(super) fn measure_elements(
    pieces: &[Piece<dyn ElementLayout>],
    nodes: &Nodes,
    options: &Options,
    listing: Option<Listing<'_>>,
    fingerprints: Option<&mut Fingerprints>,
    regions: &Regions,
    progress: &Progress,
) -> Result<(Merged, Bins)> {
    let threads = options.threads.max(1);
    let window = 4 * threads + 2;
    let (ticket_out, tickets) = bounded(window);
    let (full_out, full_in) = bounded(threads - 1);
    let (empty_out, empty_in) = bounded(chunks_in_flight(threads));
    let (results, results_in) = bounded(4 * threads);
    for _ in 0..window {
        ticket_out.send(()).expect("the channel has room for every ticket");
    }
    for _ in 0..chunks_in_flight(threads) {
        empty_out.send(Chunk::new()).expect("the channel has room for every chunk");
    }
    let keeps_rows = listing.is_some();
    let regions = Each::of(options, keeps_rows).map(|_| regions);
    let next = AtomicU64::new(0);
    let shared = Shared { pieces, nodes, next, options, regions, keeps_rows, progress };
    let ends = Ends { tickets, full_in, full_out, empty_in, empty_out, results };
    thread::scope(|scope| {
        let workers: Vec<_> = (0..threads)
            .map(|_| {
                let (shared, ends) = (&shared, ends.clone());
                scope.spawn(move || Worker::new(shared, ends).run())
            })
            .collect();
        drop(ends);
        let merged = merge(&results_in, ticket_out, listing, fingerprints);
        let mut bins = Bins::new(nodes.bounds().diagonal(), options);
        for worker in workers {
            match worker.join() {
                Ok(theirs) => bins.merge(theirs),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        Ok((merged?, bins))
    })
}

struct Worker<'a> {
    shared: &'a Shared<'a>,
    ends: Ends,
    work: Box<Workspace>,
    bins: Bins,
}

impl<'a> Worker<'a> {
    fn new(shared: &'a Shared<'a>, ends: Ends) -> Self {
        let bins = Bins::new(shared.nodes.bounds().diagonal(), shared.options);
        let each = Each::of(shared.options, shared.keeps_rows);
        Self { shared, ends, work: Workspace::new(shared.options.frame, each), bins }
    }

    /// Measures what others hand over and decodes pieces until there are none left.
    fn run(mut self) -> Bins {
        let _end = SendsEnd(self.ends.results.clone());
        let (tickets, full_in) = (self.ends.tickets.clone(), self.ends.full_in.clone());
        loop {
            select! {
                recv(full_in) -> chunk => match chunk {
                    Ok(chunk) => self.measure(chunk),
                    Err(_) => break,
                },
                recv(tickets) -> ticket => if ticket.is_err() || !self.decode_next() { break },
            }
        }
        // Others may still hand chunks over; the channel ends when the last of us has left this loop.
        let Worker { ends, shared, mut work, mut bins } = self;
        let Ends { full_in, full_out, empty_out, results, .. } = ends;
        drop(full_out);
        for chunk in full_in {
            measure_and_send(&chunk, shared, &mut work, &mut bins, &results);
            let _ = empty_out.send(chunk);
        }
        bins
    }

    /// Decodes the next piece; `false` when there is none or it failed.
    fn decode_next(&mut self) -> bool {
        let number = self.shared.next.fetch_add(1, Ordering::Relaxed);
        let Some(piece) = self.shared.pieces.get(number as usize) else { return false };
        let (shared, results) = (self.shared, self.ends.results.clone());
        let mut sink = ElementSink::new(shared.nodes, self, number, shared.options.allow_missing_nodes)
            .tagging(shared.regions);
        let done = piece.layout.decode(piece.span.clone(), &mut sink);
        let at = sink.at;
        let done = done.and_then(|()| sink.finish()).map_err(|error| piece.layout.source().place(error, at));
        let good = done.is_ok();
        if let Ok((ledger, _)) = &done {
            shared.progress.done(ledger.types.iter().map(|row| row.count).sum());
        }
        // The merge stage outlives the workers, unless it has met an error already.
        let sent = results.send(Message::Piece { number, done });
        good && sent.is_ok()
    }

    fn measure(&mut self, chunk: Chunk) {
        measure_and_send(&chunk, self.shared, &mut self.work, &mut self.bins, &self.ends.results);
        let _ = self.ends.empty_out.send(chunk);
    }
}

impl Chunks for Worker<'_> {
    fn empty(&mut self) -> Result<Chunk> {
        Ok(self.ends.empty_in.recv().expect("a worker holds the other end itself"))
    }

    fn hand_on(&mut self, chunk: Chunk) -> Result<()> {
        match self.ends.full_out.try_send(chunk) {
            Ok(()) => {}
            Err(TrySendError::Full(chunk) | TrySendError::Disconnected(chunk)) => self.measure(chunk),
        }
        Ok(())
    }
}

fn measure_and_send(
    chunk: &Chunk,
    shared: &Shared<'_>,
    work: &mut Workspace,
    bins: &mut Bins,
    results: &Sender<Message>,
) {
    let (found, rows) = measure(chunk, shared.nodes, work, bins);
    let prints = if shared.options.all_checks { duplicates::of_elements(chunk) } else { Vec::new() };
    let (origin, shape, found) = (chunk.origin(), chunk.shape(), Box::new(found));
    // A closed channel means that the merge stage has an error to report, which is the answer then.
    let _ = results.send(Message::Chunk { origin, shape, found, rows, prints });
}

/// Tells the merge stage that a worker has ended, however it did.
struct SendsEnd(Sender<Message>);

impl Drop for SendsEnd {
    fn drop(&mut self) {
        if thread::panicking() {
            let _ = self.0.send(Message::Panicked);
        }
    }
}
