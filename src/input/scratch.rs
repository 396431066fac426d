//! Scratch space: unlinked files in one folder, within one limit. Nothing is left behind, whatever ends the process.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::Source;
use crate::error::{Error, Result};

/// A folder for scratch files, and how much may be written there.
#[derive(Debug, Clone)]
pub struct Scratch {
    folder: PathBuf,
    used: Arc<AtomicU64>,
    limit: u64,
}

impl Scratch {
    /// Scratch files go to `folder`, at most `limit` bytes in all.
    pub fn new(folder: &Path, limit: u64) -> Self {
        Self { folder: folder.to_owned(), used: Arc::default(), limit }
    }

    /// A new, unlinked file.
    pub fn file(&self) -> Result<ScratchFile> {
        let file = tempfile::tempfile_in(&self.folder).map_err(|e| {
            let cause = io::Error::new(e.kind(), format!("{}: {e}", self.folder.display()));
            Error::resource("scratch space", cause)
        })?;
        Ok(ScratchFile { out: BufWriter::with_capacity(1 << 20, file), scratch: self.clone(), len: 0 })
    }
}

/// A scratch file that is being written.
#[derive(Debug)]
pub struct ScratchFile {
    out: BufWriter<File>,
    scratch: Scratch,
    len: u64,
}

impl ScratchFile {
    /// Appends `bytes`.
    pub fn write(&mut self, bytes: &[u8]) -> Result<()> {
        let used = self.scratch.used.fetch_add(bytes.len() as u64, Ordering::Relaxed) + bytes.len() as u64;
        if used > self.scratch.limit {
            return Err(Error::limit("scratch space", format!("{} bytes", self.scratch.limit)));
        }
        self.out.write_all(bytes).map_err(|e| Error::resource("scratch space", e))?;
        self.len += bytes.len() as u64;
        Ok(())
    }

    /// Number of bytes written so far.
    pub fn len(&self) -> u64 {
        self.len
    }

    /// Whether nothing was written yet.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Ends writing and hands the file over.
    pub fn into_file(self) -> Result<File> {
        self.out.into_inner().map_err(|e| Error::resource("scratch space", e.into_error()))
    }

    /// Ends writing and maps what was written; errors will name `path`.
    pub fn into_source(self, path: &Path) -> Result<Source> {
        let file = self.into_file()?;
        Source::new(path, &file)
    }
}
