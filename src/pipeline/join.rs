//! The semi-join: brings the coordinates to the elements by streams alone, where the node table is not in memory and numbers
//! are in no order.
//!
//! 1. Each piece of elements says which rows of the table it uses, each once. Rows are dealt to buckets, one for each block
//!    of the table that fits into memory, piece after piece.
//! 2. Bucket by bucket, the block of the table is brought in and the points of all rows are written, in the same order.
//! 3. A piece reads its rows and points back, a run from each bucket, and has a small table of its own.
//!
//! Nothing is sorted but the rows of one piece, and every file is read and written from its start to its end.

use std::fs::File;
use std::ops::Range;
use std::os::unix::fs::FileExt;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use super::Options;
use super::in_order::in_order;
use super::locality::Used;
use super::row_map::RowMap;
use crate::error::{Error, Result};
use crate::formats::{ElementLayout, Piece};
use crate::input::{Scratch, ScratchFile, ScratchShare};
use crate::mesh::Nodes;

/// Rows that a thread looks up at a time.
const STEP: usize = 16 << 10;
/// Room for writing, for all blocks together.
const BUFFERS: usize = 8 << 20;
/// Smallest block of the table, in rows.
const LEAST_BLOCK: u64 = 1 << 12;
/// Most blocks: each has two files open and room for writing.
const MOST_BLOCKS: u64 = 128;

/// Points by piece, in scratch.
#[derive(Debug)]
pub(super) struct Join {
    /// A row is in the bucket `row >> shift`.
    shift: u32,
    buckets: Vec<Bucket>,
    /// For each piece and bucket the number of rows of that bucket which earlier pieces use; one piece more than there are.
    starts: Vec<u64>,
}

/// The rows of one block of the table that pieces use, in the order of the pieces, and their points.
#[derive(Debug)]
struct Bucket {
    rows: File,
    points: File,
    _shares: [ScratchShare; 2],
}

/// A table of the nodes that one piece uses.
#[derive(Debug, Default)]
pub(super) struct Local {
    map: RowMap,
    points: Vec<[f64; 3]>,
    rows: Vec<u32>,
}

impl Join {
    /// Joins the nodes to the pieces, with `memory` bytes for a block of the table.
    pub(super) fn new(
        pieces: &[Piece<dyn ElementLayout>],
        nodes: &Nodes,
        threads: usize,
        memory: u64,
        scratch: &Scratch,
        options: &Options,
    ) -> Result<Self> {
        let least = LEAST_BLOCK.max(2 * nodes.rows().len() as u64 / MOST_BLOCKS);
        let block = (memory / size_of::<[f64; 3]>() as u64).max(least);
        let shift = block.ilog2();
        let count = (nodes.rows().len() >> shift) + 1;
        let buckets: Result<Vec<_>> = (0..count).map(|_| scratch.file_with(BUFFERS / count)).collect();
        let (files, starts) = deal(pieces, nodes, threads, shift, buckets?, options)?;
        let mut buckets = Vec::with_capacity(count);
        for (number, file) in files.into_iter().enumerate() {
            let block = number << shift..((number + 1) << shift).min(nodes.rows().len());
            buckets.push(Bucket::fill(file, nodes, block, threads, scratch)?);
        }
        Ok(Self { shift, buckets, starts })
    }

    /// Number of blocks that the table was cut into.
    pub(super) fn blocks(&self) -> usize {
        self.buckets.len()
    }

    /// Number of points that were brought to pieces.
    pub(super) fn points(&self) -> u64 {
        self.starts[self.starts.len() - self.buckets.len()..].iter().sum()
    }

    /// Reads the table of a piece.
    pub(super) fn read(&self, piece: usize, local: &mut Local) -> Result<()> {
        let Local { map, points, rows } = local;
        map.clear();
        points.clear();
        let count = self.buckets.len();
        for (number, bucket) in self.buckets.iter().enumerate() {
            let [start, end] = [piece, piece + 1].map(|piece| self.starts[piece * count + number]);
            let run = (end - start) as usize;
            rows.resize(run, 0);
            read_at(&bucket.rows, bytemuck::cast_slice_mut(rows), start * 4)?;
            rows.iter().for_each(|row| map.insert(((number as u32) << self.shift) | row));
            let known = points.len();
            points.resize(known + run, [0.0; 3]);
            read_at(&bucket.points, bytemuck::cast_slice_mut(&mut points[known..]), start * 24)?;
        }
        Ok(())
    }
}

impl Local {
    /// Turns rows of the node table into rows of this one.
    pub(super) fn localise(&self, rows: &mut [u32]) {
        rows.iter_mut().for_each(|row| *row = self.map.place(*row));
    }

    /// The points.
    pub(super) fn points(&self) -> &[[f64; 3]] {
        &self.points
    }
}

/// Deals the rows that pieces use to buckets, as rows within the bucket's block.
fn deal(
    pieces: &[Piece<dyn ElementLayout>],
    nodes: &Nodes,
    threads: usize,
    shift: u32,
    mut buckets: Vec<ScratchFile>,
    options: &Options,
) -> Result<(Vec<ScratchFile>, Vec<u64>)> {
    let mut starts = vec![0; buckets.len()];
    let mut within = Vec::new();
    let read = |number: usize, mut used: Used| {
        used.read(&pieces[number], number, nodes, options)?;
        Ok(used)
    };
    in_order(pieces.len(), threads, read, |_, used| {
        let mut rest = used.rows();
        for (number, bucket) in buckets.iter_mut().enumerate() {
            let (run, others) = rest.split_at(rest.partition_point(|row| (row >> shift) as usize == number));
            rest = others;
            within.clear();
            within.extend(run.iter().map(|row| row & ((1 << shift) - 1)));
            bucket.write(bytemuck::cast_slice(&within))?;
            starts.push(bucket.len() / 4);
        }
        Ok(used)
    })?;
    Ok((buckets, starts))
}

impl Bucket {
    /// Writes the points of the rows in `file`, which are those of a block of the table.
    fn fill(
        file: ScratchFile,
        nodes: &Nodes,
        block: Range<usize>,
        threads: usize,
        scratch: &Scratch,
    ) -> Result<Self> {
        let count = file.len() as usize / 4;
        let (rows, row_share) = file.into_file()?;
        let (points, point_share) = scratch.zeroed(24 * count as u64)?;
        let table = &nodes.rows()[block.clone()];
        let next = AtomicUsize::new(0);
        let look_up = || -> Result<()> {
            let (mut run, mut found) = (vec![0u32; STEP], Vec::with_capacity(STEP));
            loop {
                let from = STEP * next.fetch_add(1, Ordering::Relaxed);
                if from >= count {
                    return Ok(());
                }
                run.resize(STEP.min(count - from), 0);
                read_at(&rows, bytemuck::cast_slice_mut(&mut run), 4 * from as u64)?;
                found.clear();
                found.extend(run.iter().map(|row| table[*row as usize]));
                let written = points.write_all_at(bytemuck::cast_slice(&found), 24 * from as u64);
                written.map_err(|e| Error::resource("scratch space", e))?;
            }
        };
        let done = thread::scope(|scope| {
            let workers: Vec<_> = (0..threads).map(|_| scope.spawn(look_up)).collect();
            workers.into_iter().map(|worker| worker.join()).collect::<Vec<_>>()
        });
        nodes.release(block);
        for result in done {
            result.unwrap_or_else(|panic| std::panic::resume_unwind(panic))?;
        }
        Ok(Self { rows, points, _shares: [row_share, point_share] })
    }
}

fn read_at(file: &File, bytes: &mut [u8], at: u64) -> Result<()> {
    file.read_exact_at(bytes, at).map_err(|e| Error::resource("scratch space", e))
}
