//! Reads numbers and brackets from a file in windows, and knows where it stands.

use super::header::Header;
use crate::error::{Error, Result};
use crate::formats::text;
use crate::input::{Source, Spot, Window};

/// Longest number.
const LONGEST: usize = 64;
/// What is mapped at a time.
const WINDOW: u64 = 4 << 20;

/// A file from its header on.
pub(super) struct Reader<'s> {
    source: &'s Source,
    at: u64,
    start: u64,
    window: Window<'s>,
}

impl<'s> Reader<'s> {
    /// A reader that starts at byte `at`.
    pub(super) fn new(source: &'s Source, at: u64) -> Self {
        Self { source, at, start: at, window: source.window(at..at + WINDOW) }
    }

    /// The byte that comes next.
    pub(super) fn at(&self) -> u64 {
        self.at
    }

    /// Passes `count` bytes.
    pub(super) fn pass(&mut self, count: u64) {
        self.at += count;
    }

    /// The bytes that follow: `least` of them, or all up to the file's end.
    #[inline]
    pub(super) fn ahead(&mut self, least: usize) -> &[u8] {
        let end = self.start + self.window.len() as u64;
        if self.at + least as u64 > end && end < self.source.len() {
            self.start = self.at;
            self.window = self.source.window(self.at..self.at + WINDOW.max(least as u64));
        }
        self.window.get((self.at - self.start) as usize..).unwrap_or_default()
    }

    /// The next byte that is neither blank nor in a comment; it is not passed.
    #[inline]
    pub(super) fn next(&mut self) -> Option<u8> {
        loop {
            let ahead = self.ahead(LONGEST);
            match ahead.iter().position(|byte| *byte > b' ') {
                Some(k) => {
                    let byte = ahead[k];
                    self.at += k as u64;
                    if byte != b'/' {
                        return Some(byte);
                    }
                    if !self.pass_comment() {
                        return Some(byte);
                    }
                }
                None if ahead.is_empty() => return None,
                None => self.at += ahead.len() as u64,
            }
        }
    }

    /// Passes a comment, if one stands here.
    #[cold]
    fn pass_comment(&mut self) -> bool {
        let end: &[u8] = match self.ahead(2) {
            [b'/', b'/', ..] => b"\n",
            [b'/', b'*', ..] => b"*/",
            _ => return false,
        };
        self.at += 2;
        loop {
            let ahead = self.ahead(LONGEST);
            match memchr::memmem::find(ahead, end) {
                Some(k) => self.at += (k + end.len()) as u64,
                // The end's two bytes may lie on either side of the window's.
                None if ahead.len() >= LONGEST => {
                    self.at += (ahead.len() - 1) as u64;
                    continue;
                }
                None => self.at = self.source.len(),
            }
            return true;
        }
    }

    /// Whether `byte` comes next, which is passed then.
    #[inline]
    pub(super) fn takes(&mut self, byte: u8) -> bool {
        let found = self.next() == Some(byte);
        self.at += u64::from(found);
        found
    }

    /// Passes `byte`, which must come next.
    #[inline]
    pub(super) fn expect(&mut self, byte: u8, what: &str) -> Result<()> {
        if self.takes(byte) { Ok(()) } else { Err(self.unlike(what)) }
    }

    /// The next number, which may have a sign.
    #[inline]
    pub(super) fn integer(&mut self, what: &str) -> Result<i64> {
        let first = self.next();
        let ahead = self.ahead(LONGEST);
        let mut len = usize::from(first == Some(b'-'));
        let value = text::digits(ahead, &mut len).and_then(|value| i64::try_from(value).ok());
        let ends = ahead.get(len).is_none_or(|b| *b <= b' ' || matches!(b, b'(' | b')' | b'{' | b'}' | b'/'));
        match value.filter(|_| ends) {
            Some(value) => {
                self.at += len as u64;
                Ok(if first == Some(b'-') { -value } else { value })
            }
            None if ahead.len() >= LONGEST && ahead[..LONGEST].iter().all(u8::is_ascii_digit) => {
                Err(text::too_long(self.source, "a number", LONGEST, self.at))
            }
            None => Err(self.unlike(what)),
        }
    }

    /// A label of a binary file.
    #[inline]
    pub(super) fn raw_label(&mut self, header: &Header, what: &str) -> Result<i64> {
        let bytes = self.ahead(header.label as usize);
        if (bytes.len() as u64) < header.label {
            return Err(self.source.truncated(what));
        }
        let value = match header.label {
            4 => i64::from(header.endian.i32(bytes)),
            _ => header.endian.i64(bytes),
        };
        self.at += header.label;
        Ok(value)
    }

    /// Adds the place `at` to an error.
    pub(super) fn placed(&self, at: u64, error: Error) -> Error {
        self.source.place(error, Spot::Text(at))
    }

    /// The error of something else than `what` coming next.
    #[cold]
    pub(super) fn unlike(&self, what: &str) -> Error {
        self.source.malformed_text(self.at, what)
    }
}
