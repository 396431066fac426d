//! What a caller may ask of a run, and how it can watch the run go.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::input::Limits;
use crate::mesh::Frame;
use crate::summary::Judgement;

/// What a caller may ask of a run.
#[derive(Debug, Clone)]
pub struct Options {
    /// Number of worker threads, at least 1.
    pub threads: usize,
    /// Bytes of memory for the node table and the buffers; what does not fit goes to scratch.
    pub memory: u64,
    /// Folder for scratch files.
    pub scratch: PathBuf,
    /// Most bytes of scratch.
    pub scratch_bytes: u64,
    /// The format's name; without it the content decides.
    pub format: Option<String>,
    /// Codes of the measures that the summary shall hold; empty for all.
    pub measures: Vec<String>,
    /// The coordinates that measures look at.
    pub frame: Frame,
    /// Count elements that name missing nodes instead of refusing the file.
    pub allow_missing_nodes: bool,
    /// Limits that guard the machine.
    pub limits: Limits,
    /// What the mesh is judged by.
    pub judgement: Judgement,
    /// How many of the worst elements the summary names a measure.
    pub worst: usize,
    /// Whether the summary has statistics by region.
    pub by_region: bool,
    /// Most regions that there are statistics of.
    pub most_regions: usize,
    /// Whether the costly checks are made too: duplicate elements, coincident nodes.
    pub all_checks: bool,
    /// Whether the summary tells of the run.
    pub run_info: bool,
    /// Where the run notes how far it is.
    pub progress: Option<Arc<Progress>>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            threads: std::thread::available_parallelism().map_or(1, usize::from),
            memory: 256 << 20,
            scratch: std::env::temp_dir(),
            scratch_bytes: 4 << 40,
            format: None,
            measures: Vec::new(),
            frame: Frame::OWN,
            allow_missing_nodes: false,
            limits: Limits::default(),
            judgement: Judgement::default(),
            worst: 0,
            by_region: false,
            most_regions: 1000,
            all_checks: false,
            run_info: true,
            progress: None,
        }
    }
}

/// How far a run is. Readers may look at any time.
#[derive(Debug, Default)]
pub struct Progress {
    bytes: AtomicU64,
    pieces: AtomicU64,
    pieces_done: AtomicU64,
    elements: AtomicU64,
}

impl Progress {
    /// Notes how many bytes the mesh has, unpacked.
    pub(crate) fn of_bytes(&self, bytes: u64) {
        self.bytes.store(bytes, Ordering::Relaxed);
    }

    /// Notes that `count` more pieces are known.
    pub(crate) fn expect(&self, count: u64) {
        self.pieces.fetch_add(count, Ordering::Relaxed);
    }

    /// Notes that a piece is done and how many elements it held.
    pub(crate) fn done(&self, elements: u64) {
        self.pieces_done.fetch_add(1, Ordering::Relaxed);
        self.elements.fetch_add(elements, Ordering::Relaxed);
    }

    /// Number of pieces (about 1 MiB each) that are known so far.
    pub fn pieces(&self) -> u64 {
        self.pieces.load(Ordering::Relaxed)
    }

    /// Number of pieces that are done.
    pub fn pieces_done(&self) -> u64 {
        self.pieces_done.load(Ordering::Relaxed)
    }

    /// Number of bytes of the mesh, unpacked.
    pub fn bytes(&self) -> u64 {
        self.bytes.load(Ordering::Relaxed)
    }

    /// Number of those bytes that are done, by the share of pieces; 0 until the pieces are known.
    pub fn bytes_done(&self) -> u64 {
        let (pieces, done) = (self.pieces(), self.pieces_done());
        let share = done.min(pieces) as f64 / pieces.max(1) as f64;
        (share * self.bytes() as f64) as u64
    }

    /// Number of elements that are measured.
    pub fn elements(&self) -> u64 {
        self.elements.load(Ordering::Relaxed)
    }
}
