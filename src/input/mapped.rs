//! The mapped file. Bytes are looked at through windows; a window that is dropped is given back to the system, because
//! batch systems count mapped pages as a job's memory.
//!
//! A file that someone truncates while it is mapped raises `SIGBUS` and ends the process: this is why the daemon
//! scores each mesh in a worker process of its own.

use std::fs::File;
use std::ops::{Deref, Range};

use memmap2::{Advice, Mmap, UncheckedAdvice};

/// A read-only map of a whole file.
#[derive(Debug)]
pub struct Mapped {
    /// `None` stands for an empty file, which cannot be mapped.
    map: Option<Mmap>,
}

/// Bytes of a mapped file; given back when dropped.
#[derive(Debug)]
pub struct Window<'m> {
    mapped: &'m Mapped,
    range: Range<usize>,
}

impl Mapped {
    /// Maps the whole of `file`.
    #[expect(unsafe_code, reason = "a map cannot be made safely: the file may change under it")]
    pub fn new(file: &File) -> std::io::Result<Self> {
        if file.metadata()?.len() == 0 {
            return Ok(Self { map: None });
        }
        // SAFETY: the map is read-only and private to us. If another process writes into the file we may read torn
        // bytes, which every decoder checks as it would any hostile input; if it truncates the file the process ends
        // by SIGBUS, which is no memory unsafety (see the module's words).
        let map = unsafe { Mmap::map(file)? };
        Ok(Self { map: Some(map) })
    }

    /// Number of bytes.
    pub fn len(&self) -> u64 {
        self.map.as_ref().map_or(0, |m| m.len() as u64)
    }

    /// Whether the file was empty.
    pub fn is_empty(&self) -> bool {
        self.map.is_none()
    }

    /// A window on `range`, cut to the file's end. The pages go back when it is dropped.
    pub fn window(&self, range: Range<u64>) -> Window<'_> {
        let end = range.end.min(self.len());
        let start = range.start.min(end);
        Window { mapped: self, range: start as usize..end as usize }
    }

    /// The bytes of `range` without giving them back afterwards: for random looks at a few bytes.
    pub fn peek(&self, range: Range<u64>) -> &[u8] {
        let end = range.end.min(self.len()) as usize;
        let start = (range.start as usize).min(end);
        &self.bytes()[start..end]
    }

    /// Tells the system that the bytes of `range` will be wanted soon.
    pub fn will_need(&self, range: Range<u64>) {
        if let Some(map) = &self.map {
            let end = range.end.min(self.len()) as usize;
            let start = (range.start as usize).min(end);
            // Advice only: a system that does not take it costs speed, not correctness.
            let _ = map.advise_range(Advice::WillNeed, start, end - start);
        }
    }

    fn bytes(&self) -> &[u8] {
        self.map.as_deref().unwrap_or_default()
    }
}

impl Window<'_> {
    /// Which bytes of the file they are.
    pub fn range(&self) -> Range<u64> {
        self.range.start as u64..self.range.end as u64
    }
}

impl Deref for Window<'_> {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        &self.mapped.bytes()[self.range.clone()]
    }
}

impl Drop for Window<'_> {
    #[expect(
        unsafe_code,
        reason = "memmap2 calls giving pages back unchecked, as it would lose writes of a private map"
    )]
    fn drop(&mut self) {
        /// Below this a call costs more than the pages are worth.
        const WORTH: usize = 64 << 10;
        /// The system maps the neighbours of a page along with it, up to a large page: with the first and last pages of a
        /// window come some of the windows beside it, which may have been given back already.
        const AROUND: usize = 2 << 20;
        if self.range.len() >= WORTH
            && let Some(map) = &self.mapped.map
        {
            let start = self.range.start / AROUND * AROUND;
            let end = self.range.end.next_multiple_of(AROUND).min(map.len());
            // SAFETY: the map is read-only and file-backed: pages that are dropped come back from the file with the
            // same bytes when somebody (another window may overlap) looks again.
            let _ = unsafe { map.unchecked_advise_range(UncheckedAdvice::DontNeed, start, end - start) };
        }
    }
}
