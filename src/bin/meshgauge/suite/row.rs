//! A row: what became of one generator on one problem.

use std::fmt;

use serde::{Deserialize, Serialize};

/// What became of one generator on one problem.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The problem's name.
    pub problem: String,
    /// The generator's name.
    pub generator: String,
    /// What the generator is.
    pub title: String,
    /// Its version; nothing where it is missing.
    pub version: Option<String>,
    /// What became of it.
    pub outcome: Outcome,
    /// Why it is not fine.
    pub reason: Option<String>,
    /// The element size that it was asked for last.
    pub size: Option<f64>,
    /// Number of runs until the number of nodes was right.
    pub tries: u32,
    /// The command of the last run.
    pub command: Vec<String>,
    /// Seconds on the clock of the last run, start of the interpreter included.
    pub seconds: Option<f64>,
    /// Seconds of its processors.
    pub cpu_seconds: Option<f64>,
    /// Most memory of one of its processes.
    pub peak_rss_bytes: Option<u64>,
    /// Number of nodes that elements name.
    pub nodes: Option<u64>,
    /// Number of elements of the problem's dimension.
    pub elements: Option<u64>,
    /// The mesh's area or volume beside the true one.
    pub relative_error: Option<f64>,
    /// What the row depends on: while it is the same, the row is kept.
    pub key: String,
}

/// What became of a generator on a problem.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// A mesh in the window.
    Fine,
    /// A mesh, but not of so many nodes as the problem wants.
    OutsideWindow,
    /// The generator is not installed.
    Missing,
    /// It ended badly.
    Failed,
    /// It took too long.
    TimedOut,
    /// What it wrote is no mesh that could be read.
    Unreadable,
    /// What it wrote fills something else: its area or volume is far from the problem's.
    WrongDomain,
}

impl Outcome {
    /// Whether there is a mesh.
    pub fn has_mesh(self) -> bool {
        matches!(self, Outcome::Fine | Outcome::OutsideWindow)
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Outcome::Fine => "fine",
            Outcome::OutsideWindow => "outside the window",
            Outcome::Missing => "missing",
            Outcome::Failed => "failed",
            Outcome::TimedOut => "timed out",
            Outcome::Unreadable => "unreadable",
            Outcome::WrongDomain => "wrong domain",
        })
    }
}
