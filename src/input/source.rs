//! One file as the formats see it: bytes by position, a name, and errors that name the place.

use std::fs::File;
use std::ops::{Deref, Range};
use std::path::{Path, PathBuf};

use super::ScratchShare;
use super::hashing::Hashing;
use super::mapped::{self, Mapped};
use crate::error::{At, Error, Result, excerpt};

/// Where a decoder stands, as a byte of the file.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Spot {
    /// Not known.
    #[default]
    Unknown,
    /// In text: errors name the line.
    Text(u64),
    /// In text, at the token `number` (from 0) of those between blanks that start at byte `from`: errors name its line.
    Token {
        /// Byte before which no token is counted.
        from: u64,
        /// Number of tokens before this one.
        number: u64,
    },
    /// In binary data: errors name the byte.
    Binary(u64),
}

/// A mapped file (or its unpacked contents) with the name that the user knows it by.
#[derive(Debug)]
pub struct Source {
    path: PathBuf,
    mapped: Mapped,
    hashing: Hashing,
    /// What of the scratch space the bytes take, where they stand there.
    _share: Option<ScratchShare>,
}

/// Bytes of a file; their pages are given back when it is dropped.
#[derive(Debug)]
pub struct Window<'s> {
    source: &'s Source,
    bytes: mapped::Window<'s>,
}

impl Deref for Window<'_> {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        &self.bytes
    }
}

impl Drop for Window<'_> {
    fn drop(&mut self) {
        self.source.hashing.take_in(&self.source.mapped, self.bytes.range());
    }
}

/// How much is looked at, and given back, at a time where a whole file is gone through.
const STEP: u64 = 8 << 20;

impl Source {
    /// Maps `file`, which the user knows as `path`.
    pub fn new(path: &Path, file: &File) -> Result<Self> {
        let mapped = Mapped::new(file).map_err(|e| Error::unreadable(path, e))?;
        Ok(Self { path: path.to_owned(), mapped, hashing: Hashing::default(), _share: None })
    }

    /// Maps a scratch file, whose `share` of the space is given back with the source.
    pub(super) fn from_scratch(path: &Path, file: &File, share: ScratchShare) -> Result<Self> {
        Ok(Self { _share: Some(share), ..Self::new(path, file)? })
    }

    /// The name that the user knows the file by.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Number of bytes (after unpacking).
    pub fn len(&self) -> u64 {
        self.mapped.len()
    }

    /// Whether there are no bytes.
    pub fn is_empty(&self) -> bool {
        self.mapped.is_empty()
    }

    /// A window on `range`, cut to the file's end; its pages are given back when it is dropped.
    pub fn window(&self, range: Range<u64>) -> Window<'_> {
        Window { source: self, bytes: self.mapped.window(range) }
    }

    /// A few bytes at a place, cut to the file's end.
    pub fn peek(&self, range: Range<u64>) -> &[u8] {
        self.mapped.peek(range)
    }

    /// Tells the system that the bytes of `range` will be wanted soon.
    pub fn will_need(&self, range: Range<u64>) {
        self.mapped.will_need(range);
    }

    /// The number, from 1, of the line that byte `at` stands on. Counts from the start of the file: for errors only.
    pub fn line_of(&self, at: u64) -> u64 {
        let mut lines = 1;
        self.go_through(at, |bytes| {
            lines += memchr::memchr_iter(b'\n', bytes).count() as u64;
            true
        });
        lines
    }

    /// Says that [`Source::xxh3`] will be asked for: what windows were on is hashed as they are given back.
    pub(super) fn begin_hash(&self) {
        self.hashing.begin();
    }

    /// The XXH3 (64 bits) of all bytes.
    pub(super) fn xxh3(&self) -> u64 {
        self.hashing.finish(&self.mapped)
    }

    /// The byte at which the token `number` of those from byte `from` on starts, or the end.
    fn token(&self, from: u64, number: u64) -> u64 {
        let (mut at, mut left, mut blank) = (from, number, true);
        while at < self.len() {
            let window = self.window(at..at + STEP);
            for (byte, k) in window.iter().zip(0..) {
                let starts = blank && *byte > b' ';
                blank = *byte <= b' ';
                if starts && left == 0 {
                    return at + k;
                }
                left -= u64::from(starts);
            }
            at += window.len() as u64;
        }
        self.len()
    }

    /// Shows all bytes before byte `end`, window by window, until somebody says no. Says whether nobody did.
    fn go_through(&self, end: u64, mut see: impl FnMut(&[u8]) -> bool) -> bool {
        let end = end.min(self.len());
        let mut from = 0;
        while from < end {
            let to = end.min(from + STEP);
            if !see(&self.window(from..to)) {
                return false;
            }
            from = to;
        }
        true
    }

    /// Adds this file and the place `spot` to an error that names none.
    pub fn place(&self, error: Error, spot: Spot) -> Error {
        if error.place().is_some() || error.is_resource() {
            return error.in_file(&self.path);
        }
        match spot {
            Spot::Unknown => error,
            Spot::Text(at) => error.at(At::Line(self.line_of(at))),
            Spot::Token { from, number } => error.at(At::Line(self.line_of(self.token(from, number)))),
            Spot::Binary(at) => error.at(At::Byte(at)),
        }
        .in_file(&self.path)
    }

    /// An error about text: the line of byte `at`, what was expected there and what stands there.
    pub fn malformed_text(&self, at: u64, expected: impl Into<String>) -> Error {
        Error::malformed(expected, excerpt(self.peek(at..at + 48)))
            .at(At::Line(self.line_of(at)))
            .in_file(&self.path)
    }

    /// An error about binary data: byte `at`, what was expected there and what was found.
    pub fn malformed_binary(&self, at: u64, expected: impl Into<String>, found: impl Into<String>) -> Error {
        Error::malformed(expected, found).at(At::Byte(at)).in_file(&self.path)
    }

    /// The error of a file that ends at byte `at` or before, where `expected` should follow.
    pub fn truncated(&self, expected: impl Into<String>) -> Error {
        self.malformed_binary(self.len(), expected, "the end of the file")
    }
}
