//! The parse stage: workers decode pieces of elements into chunks, and measure chunks.
//!
//! A full chunk goes into a bounded channel, for whoever is free; where nobody is, the worker that filled it measures
//! it itself. So one thread works without waiting, several share whatever there is, and the chunks in flight are a
//! number known at the start.

use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::Instant;

use crossbeam_channel::{Receiver, Sender, TrySendError, bounded, select};

use super::duplicates::{self, Fingerprints};
use super::each::Each;
use super::join::{Join, Local};
use super::listing::Listing;
use super::locality::locality;
use super::measure::{Bins, Workspace, measure};
use super::merge::{Merged, Message, merge};
use super::{Options, Progress};
use crate::error::Result;
use crate::formats::{Chunks, ElementLayout, ElementSink, Piece};
use crate::input::Input;
use crate::mesh::{Chunk, Nodes, Regions, Shape};

/// What all workers share.
struct Shared<'a> {
    pieces: &'a [Piece<dyn ElementLayout>],
    nodes: &'a Nodes,
    access: Access,
    next: AtomicU64,
    options: &'a Options,
    /// Where elements are tagged with their region and place.
    regions: Option<&'a Regions>,
    keeps_rows: bool,
    progress: &'a Progress,
}

/// How workers come by coordinates.
enum Access {
    /// By looking into the node table. Where that is in a scratch file, what was looked at is given back each time that so
    /// many pieces are done.
    Table { release_every: Option<u64> },
    /// Each piece has a table of its own.
    Joined(Join),
}

impl Access {
    /// Chooses, by how near to each other the nodes are that pieces use.
    fn choose(
        pieces: &[Piece<dyn ElementLayout>],
        nodes: &Nodes,
        threads: usize,
        keeps_rows: bool,
        input: &Input,
        options: &Options,
    ) -> Result<Self> {
        if !nodes.is_spilled() {
            return Ok(Self::Table { release_every: None });
        }
        let memory = input.memory.left();
        let found = locality(pieces, nodes, options);
        // Who is told of single elements is told of their rows in the whole table.
        if let Some(locality) = found
            && locality.joined < locality.paged
            && !keeps_rows
        {
            let started = Instant::now();
            let join = Join::new(pieces, nodes, threads, memory, &input.scratch, options)?;
            tracing::info!(
                paged = format_args!("{:.0} bytes an element", locality.paged),
                joined = format_args!("{:.0} bytes an element", locality.joined),
                blocks = join.blocks(),
                points = join.points(),
                seconds = started.elapsed().as_secs_f64(),
                "the node table is not in memory and its order is not that of the elements: joined"
            );
            return Ok(Self::Joined(join));
        }
        // The system maps the neighbours of a page along with it.
        const NEIGHBOURS: f64 = 16.0;
        let by_piece = found.map_or(0.0, |locality| NEIGHBOURS * locality.paged_by_piece);
        let release_every = (memory as f64 / 2.0 / by_piece.max(1.0)).clamp(1.0, 1e6) as u64;
        tracing::info!(
            paged = format_args!("{:.0} bytes an element", found.map_or(0.0, |locality| locality.paged)),
            joined = format_args!("{:.0} bytes an element", found.map_or(0.0, |locality| locality.joined)),
            release_every,
            "the node table is not in memory and its order is near that of the elements: mapped"
        );
        Ok(Self::Table { release_every: Some(release_every) })
    }
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
#[expect(
    clippy::too_many_arguments,
    reason = "what there is to measure, what is asked for, and where it goes"
)]
pub(super) fn measure_elements(
    pieces: &[Piece<dyn ElementLayout>],
    nodes: &Nodes,
    input: &Input,
    options: &Options,
    listing: Option<Listing<'_>>,
    fingerprints: Option<&mut Fingerprints>,
    regions: &Regions,
    progress: &Progress,
) -> Result<(Merged, Bins)> {
    let threads = options.threads.max(1);
    let keeps_rows = listing.is_some();
    let regions = Each::of(options, keeps_rows).map(|_| regions);
    let access =
        Access::choose(pieces, nodes, threads, regions.is_some() || options.all_checks, input, options)?;
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
    let next = AtomicU64::new(0);
    let shared = Shared { pieces, nodes, access, next, options, regions, keeps_rows, progress };
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
    /// The table of the piece at hand, where pieces have their own.
    local: Local,
}

impl<'a> Worker<'a> {
    fn new(shared: &'a Shared<'a>, ends: Ends) -> Self {
        let bins = Bins::new(shared.nodes.bounds().diagonal(), shared.options);
        let each = Each::of(shared.options, shared.keeps_rows);
        Self { shared, ends, work: Workspace::new(shared.options.frame, each), bins, local: Local::default() }
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
        let Worker { ends, shared, mut work, mut bins, .. } = self;
        let Ends { full_in, full_out, empty_out, results, .. } = ends;
        drop(full_out);
        for chunk in full_in {
            let table = shared.nodes.rows();
            measure_and_send(&chunk, table, shared, &mut work, &mut bins, &results);
            let _ = empty_out.send(chunk);
        }
        bins
    }

    /// Decodes the next piece; `false` when there is none or it failed.
    fn decode_next(&mut self) -> bool {
        let number = self.shared.next.fetch_add(1, Ordering::Relaxed);
        let Some(piece) = self.shared.pieces.get(number as usize) else { return false };
        let (shared, results) = (self.shared, self.ends.results.clone());
        if let Access::Joined(join) = &shared.access
            && let Err(error) = join.read(number as usize, &mut self.local)
        {
            let _ = results.send(Message::Piece { number, done: Err(error) });
            return false;
        }
        let mut sink = ElementSink::new(shared.nodes, self, number, shared.options.allow_missing_nodes)
            .tagging(shared.regions);
        let done = piece.layout.decode(piece.span.clone(), &mut sink);
        let at = sink.at;
        let done = done.and_then(|()| sink.finish()).map_err(|error| piece.layout.source().place(error, at));
        let good = done.is_ok();
        if let Access::Table { release_every: Some(every) } = shared.access
            && number.is_multiple_of(every)
        {
            shared.nodes.release(0..shared.nodes.rows().len());
        }
        if let Ok((ledger, _)) = &done {
            shared.progress.done(ledger.types.iter().map(|row| row.count).sum());
        }
        // The merge stage outlives the workers, unless it has met an error already.
        let sent = results.send(Message::Piece { number, done });
        good && sent.is_ok()
    }

    fn measure(&mut self, chunk: Chunk) {
        let nodes = self.shared.nodes;
        let points = match &self.shared.access {
            Access::Table { .. } => nodes.rows(),
            Access::Joined(_) => self.local.points(),
        };
        let (work, bins) = (&mut self.work, &mut self.bins);
        measure_and_send(&chunk, points, self.shared, work, bins, &self.ends.results);
        let _ = self.ends.empty_out.send(chunk);
    }
}

impl Chunks for Worker<'_> {
    fn empty(&mut self) -> Result<Chunk> {
        Ok(self.ends.empty_in.recv().expect("a worker holds the other end itself"))
    }

    fn hand_on(&mut self, mut chunk: Chunk) -> Result<()> {
        // Nobody else has this piece's table.
        if let Access::Joined(_) = self.shared.access {
            self.local.localise(chunk.rows_mut());
            self.measure(chunk);
            return Ok(());
        }
        match self.ends.full_out.try_send(chunk) {
            Ok(()) => {}
            Err(TrySendError::Full(chunk) | TrySendError::Disconnected(chunk)) => self.measure(chunk),
        }
        Ok(())
    }
}

fn measure_and_send(
    chunk: &Chunk,
    points: &[[f64; 3]],
    shared: &Shared<'_>,
    work: &mut Workspace,
    bins: &mut Bins,
    results: &Sender<Message>,
) {
    let (found, rows) = measure(chunk, points, shared.nodes.is_planar(), work, bins);
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
