//! The pipeline: the only threads and channels.

mod options;

use std::io::Read;
use std::path::Path;

use crate::error::{Error, Result};
use crate::summary::Summary;

pub use options::{Options, Progress};

/// Scores the mesh in the file at `path`.
pub fn score(path: &Path, _options: &Options) -> Result<Summary> {
    Err(Error::unsupported("not joined yet").in_file(path))
}

/// Scores a mesh that comes from a stream, such as standard input; it is spooled to scratch first.
pub fn score_reader(name: &str, _reader: impl Read, _options: &Options) -> Result<Summary> {
    Err(Error::unsupported("not joined yet").in_file(Path::new(name)))
}
