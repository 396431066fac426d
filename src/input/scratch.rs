//! Scratch space: unlinked files in one folder, within one limit. Nothing is left behind, whatever ends the process.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use rustix::fs::FallocateFlags;

use super::{Source, bytes};
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
        self.file_with(1 << 20)
    }

    /// A new, unlinked file that is written in steps of `buffer` bytes, for those who write many at a time.
    pub fn file_with(&self, buffer: usize) -> Result<ScratchFile> {
        let file = tempfile::tempfile_in(&self.folder).map_err(|e| self.error(e))?;
        let share = ScratchShare { scratch: self.clone(), bytes: 0 };
        Ok(ScratchFile { out: BufWriter::with_capacity(buffer, file), share })
    }

    /// A new, unlinked file of `len` zero bytes, to be mapped and written in any order. The space is allocated at once:
    /// a full disk is an error here, where a hole would end the process when it is written to.
    pub fn zeroed(&self, len: u64) -> Result<(File, ScratchShare)> {
        let (file, mut share) = self.file()?.into_file()?;
        share.grow(len)?;
        let allocated = match rustix::fs::fallocate(&file, FallocateFlags::empty(), 0, len) {
            _ if len == 0 => Ok(()),
            // Some network file systems cannot allocate.
            Err(rustix::io::Errno::OPNOTSUPP) => file.set_len(len),
            done => done.map_err(io::Error::from),
        };
        allocated.map_err(|e| self.error(e))?;
        Ok((file, share))
    }

    /// Number of bytes that are taken now.
    pub fn used(&self) -> u64 {
        self.used.load(Ordering::Relaxed)
    }

    /// An error of the system with the folder's name.
    fn error(&self, cause: io::Error) -> Error {
        let cause = io::Error::new(cause.kind(), format!("{}: {cause}", self.folder.display()));
        Error::resource("scratch space", cause)
    }
}

/// What one file takes of the scratch space; given back when dropped.
#[derive(Debug)]
pub struct ScratchShare {
    scratch: Scratch,
    bytes: u64,
}

impl ScratchShare {
    fn grow(&mut self, more: u64) -> Result<()> {
        let Scratch { used, limit, .. } = &self.scratch;
        let grown = used.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |used| {
            used.checked_add(more).filter(|grown| grown <= limit)
        });
        if grown.is_err() {
            let text = format!("the limit of {} is reached", bytes(*limit));
            return Err(self.scratch.error(io::Error::new(io::ErrorKind::QuotaExceeded, text)));
        }
        self.bytes += more;
        Ok(())
    }
}

impl Drop for ScratchShare {
    fn drop(&mut self) {
        self.scratch.used.fetch_sub(self.bytes, Ordering::Relaxed);
    }
}

/// A scratch file that is being written.
#[derive(Debug)]
pub struct ScratchFile {
    out: BufWriter<File>,
    share: ScratchShare,
}

impl ScratchFile {
    /// Appends `bytes`.
    pub fn write(&mut self, bytes: &[u8]) -> Result<()> {
        self.share.grow(bytes.len() as u64)?;
        self.out.write_all(bytes).map_err(|e| self.share.scratch.error(e))
    }

    /// Number of bytes written so far.
    pub fn len(&self) -> u64 {
        self.share.bytes
    }

    /// Whether nothing was written yet.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Ends writing and hands the file over; its bytes count as taken until the share is dropped.
    pub fn into_file(self) -> Result<(File, ScratchShare)> {
        match self.out.into_inner() {
            Ok(file) => Ok((file, self.share)),
            Err(e) => Err(self.share.scratch.error(e.into_error())),
        }
    }

    /// Ends writing and maps what was written; errors will name `path`. The space is given back with the source.
    pub fn into_source(self, path: &Path) -> Result<Source> {
        let (file, share) = self.into_file()?;
        Source::from_scratch(path, &file, share)
    }
}
