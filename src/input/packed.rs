//! Bytes as they come in, before unpacking: counted, hashed and held within the limit, in one pass and one buffer.

use std::cell::Cell;
use std::hash::Hasher;
use std::io::{self, BufRead, Read};
use std::path::Path;
use std::rc::Rc;

use twox_hash::XxHash3_64;

use super::bytes;
use crate::error::{Bound, Error, Result};

const BUFFER_BYTES: usize = 256 << 10;

/// A reader that knows where it stands, what it has seen and why it stopped.
pub(super) struct Packed<'p, R> {
    path: &'p Path,
    raw: R,
    limit: u64,
    buffer: Box<[u8]>,
    from: usize,
    to: usize,
    read: u64,
    position: Rc<Cell<u64>>,
    ended: bool,
    hash: XxHash3_64,
    /// The cause, where reading itself failed: decoders hand on a copy that has lost it.
    stopped: Option<Error>,
}

impl<'p, R: Read> Packed<'p, R> {
    /// Reads from `raw`, which the user knows as `path`, at most `limit` bytes.
    pub(super) fn new(path: &'p Path, raw: R, limit: u64) -> Self {
        Self {
            path,
            raw,
            limit,
            buffer: vec![0; BUFFER_BYTES].into(),
            from: 0,
            to: 0,
            read: 0,
            position: Rc::default(),
            ended: false,
            hash: XxHash3_64::new(),
            stopped: None,
        }
    }

    /// The name that the user knows the bytes by.
    pub(super) fn path(&self) -> &'p Path {
        self.path
    }

    /// Number of bytes that were consumed; it goes on counting while a decoder holds the reader.
    pub(super) fn position(&self) -> Rc<Cell<u64>> {
        Rc::clone(&self.position)
    }

    /// Whether somebody asked for more than there is.
    pub(super) fn ended(&self) -> bool {
        self.ended
    }

    /// Number of bytes read, and their hash.
    pub(super) fn seen(&self) -> (u64, u64) {
        (self.read, self.hash.finish())
    }

    /// Why reading stopped, if it did not stop at the end.
    pub(super) fn stopped(&mut self) -> Option<Error> {
        self.stopped.take()
    }

    /// The next bytes without consuming them: `least` or more, fewer only at the end.
    pub(super) fn head(&mut self, least: usize) -> Result<&[u8]> {
        while self.to - self.from < least && !self.ended {
            if let Err(cause) = self.fill() {
                return Err(self.stopped().unwrap_or_else(|| Error::unreadable(self.path, cause)));
            }
        }
        Ok(&self.buffer[self.from..self.to])
    }

    /// Reads once, behind what is buffered.
    fn fill(&mut self) -> io::Result<()> {
        if self.ended {
            return Ok(());
        }
        if self.from > 0 {
            self.buffer.copy_within(self.from..self.to, 0);
            (self.from, self.to) = (0, self.to - self.from);
        }
        let count = loop {
            match self.raw.read(&mut self.buffer[self.to..]) {
                Ok(count) => break count,
                Err(e) if e.kind() == io::ErrorKind::Interrupted => {}
                Err(e) => return Err(self.stop(|path| Error::unreadable(path, e))),
            }
        };
        self.ended = count == 0;
        self.hash.write(&self.buffer[self.to..self.to + count]);
        self.read += count as u64;
        self.to += count;
        if self.read > self.limit {
            let limit = bytes(self.limit);
            return Err(self.stop(|path| {
                Error::limit_of(Bound::FileBytes, "the size of the file", limit).in_file(path)
            }));
        }
        Ok(())
    }

    fn stop(&mut self, error: impl FnOnce(&Path) -> Error) -> io::Error {
        let error = error(self.path);
        let shown = io::Error::other(error.to_string());
        self.stopped = Some(error);
        shown
    }
}

impl<R: Read> BufRead for Packed<'_, R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.from == self.to {
            self.fill()?;
        }
        Ok(&self.buffer[self.from..self.to])
    }

    fn consume(&mut self, count: usize) {
        self.from += count;
        self.position.set(self.position.get() + count as u64);
    }
}

impl<R: Read> Read for Packed<'_, R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let there = self.fill_buf()?;
        let count = there.len().min(into.len());
        into[..count].copy_from_slice(&there[..count]);
        self.consume(count);
        Ok(count)
    }
}
