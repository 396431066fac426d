//! The pipeline: the only threads and channels. Bytes go in, a summary comes out.
//!
//! `run.rs` reads from top to bottom. Pieces of nodes are decoded into the node table; pieces of elements into chunks,
//! chunks into statistics, statistics into a summary. What is merged with what depends on positions in the file alone.

mod assemble;
mod duplicates;
mod each;
mod elements;
mod in_order;
mod join;
mod listing;
mod locality;
mod measure;
mod merge;
mod nodes;
mod options;
mod regions;
mod row_map;
mod run;
#[cfg(test)]
mod tests;
mod worst;

use std::io::Read;
use std::path::Path;

use crate::error::Result;
use crate::formats;
use crate::input::{Input, Scratch};
use crate::mesh::ElementWriter;
use crate::summary::Summary;

pub use options::{Options, Progress};

/// Scores the mesh in the file at `path`, or in the folder, where a mesh of its format is a folder.
pub fn score(path: &Path, options: &Options) -> Result<Summary> {
    score_each(path, options, None)
}

/// Scores the mesh in the file at `path`, and hands every measured element to `writer`, in the order of the file.
pub fn score_each(path: &Path, options: &Options, writer: Option<&mut dyn ElementWriter>) -> Result<Summary> {
    let scratch = Scratch::new(&options.scratch, options.scratch_bytes);
    let mut input = formats::open(path, &options.limits, &scratch)?;
    input.memory = run::budget(options);
    run::run(&input, options, writer)
}

/// Scores a mesh that comes from a stream, such as standard input; it is spooled to scratch first.
pub fn score_reader(name: &str, reader: impl Read, options: &Options) -> Result<Summary> {
    score_reader_each(name, reader, options, None)
}

/// Scores a mesh that comes from a stream, and hands every measured element to `writer`.
pub fn score_reader_each(
    name: &str,
    reader: impl Read,
    options: &Options,
    writer: Option<&mut dyn ElementWriter>,
) -> Result<Summary> {
    let scratch = Scratch::new(&options.scratch, options.scratch_bytes);
    let mut input = Input::from_reader(Path::new(name), reader, &options.limits, &scratch)?;
    input.memory = run::budget(options);
    run::run(&input, options, writer)
}
