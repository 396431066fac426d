//! Bytes: mapped files, what is unpacked to scratch first, and the siblings that a file includes.

mod mapped;
mod scratch;
mod source;

use std::fs::File;
use std::path::Path;
use std::sync::Arc;

use crate::error::{Error, Result};

pub use mapped::Window;
pub use scratch::{Scratch, ScratchFile};
pub use source::{Source, Spot};

/// Limits that guard the machine against hostile or broken files. Each has its own error.
#[derive(Debug, Clone)]
pub struct Limits {
    /// Most bytes that a file may have on disk.
    pub file_bytes: u64,
    /// Most bytes that a compressed file may unpack to.
    pub unpacked_bytes: u64,
    /// Most bytes out for a byte in, once 64 MiB have come out.
    pub unpacked_ratio: u64,
    /// Largest memory window that a zstd or xz stream may ask for, in bytes.
    pub window_bytes: u64,
    /// Longest line of a text file, in bytes.
    pub line_bytes: usize,
    /// Deepest nesting of included files.
    pub include_depth: usize,
    /// Most included files.
    pub include_count: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            file_bytes: 16 << 40,
            unpacked_bytes: 2 << 40,
            unpacked_ratio: 1000,
            window_bytes: 128 << 20,
            line_bytes: 1 << 20,
            include_depth: 16,
            include_count: 1000,
        }
    }
}

/// A mesh file that is open: its (unpacked) bytes, its scratch space and its limits.
#[derive(Debug, Clone)]
pub struct Input {
    /// The main file.
    pub source: Arc<Source>,
    /// Where what cannot be mapped goes.
    pub scratch: Scratch,
    /// The limits in force.
    pub limits: Limits,
    /// What the bytes were packed with: `gzip`, `zstd`, `bzip2`, `xz`.
    pub compression: Option<&'static str>,
    /// Number of bytes of the file as it stands on disk.
    pub bytes_on_disk: u64,
}

impl Input {
    /// Opens and maps the mesh file at `path`.
    pub fn open(path: &Path, limits: &Limits, scratch: &Scratch) -> Result<Self> {
        let file = File::open(path).map_err(|e| Error::unreadable(path, e))?;
        let source = Source::new(path, &file)?;
        let bytes_on_disk = source.len();
        Ok(Self {
            source: Arc::new(source),
            scratch: scratch.clone(),
            limits: limits.clone(),
            compression: None,
            bytes_on_disk,
        })
    }
}
