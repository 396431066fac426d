//! Reads numbers from rows of text, one row a line.

use std::sync::Arc;

use super::types;
use crate::error::{Error, Result, excerpt};
use crate::formats::text;
use crate::input::Spot;
use crate::mesh::ElementType;

/// A place in rows of text.
#[derive(Debug, Clone)]
pub(super) struct Rows<'t> {
    bytes: &'t [u8],
    at: usize,
    /// The byte of the file that `bytes` start at.
    base: u64,
}

impl<'t> Rows<'t> {
    /// The rows of `bytes`, which start at byte `base` of the file.
    pub(super) fn new(base: u64, bytes: &'t [u8]) -> Self {
        Self { bytes, at: 0, base }
    }

    /// Whether bytes are left.
    #[inline]
    pub(super) fn more(&self) -> bool {
        self.at < self.bytes.len()
    }

    /// The bytes from here on.
    pub(super) fn rest(&self) -> &'t [u8] {
        &self.bytes[self.at..]
    }

    /// Goes on after `bytes` bytes.
    pub(super) fn pass(&mut self, bytes: usize) {
        self.at += bytes;
    }

    /// Passes blank lines; says whether bytes are left.
    pub(super) fn next_block(&mut self) -> bool {
        while self.bytes.get(self.at).is_some_and(u8::is_ascii_whitespace) {
            self.at += 1;
        }
        self.more()
    }

    /// The place, for errors.
    #[inline]
    pub(super) fn spot(&self) -> Spot {
        Spot::Text(self.base + self.at as u64)
    }

    #[inline]
    fn skip_blanks(&mut self) {
        while let Some(b' ' | b'\t') = self.bytes.get(self.at) {
            self.at += 1;
        }
    }

    /// The next number of the row, without a sign.
    #[inline]
    pub(super) fn integer(&mut self, what: &str) -> Result<u64> {
        self.skip_blanks();
        let start = self.at;
        let value = text::digits(self.bytes, &mut self.at);
        value.filter(|_| self.ends_here()).ok_or_else(|| self.unlike(start, what))
    }

    /// The next number of the row, of either sign.
    pub(super) fn signed(&mut self, what: &str) -> Result<i64> {
        self.skip_blanks();
        let negative = self.bytes.get(self.at) == Some(&b'-');
        self.at += usize::from(negative);
        let value = self.integer(what)? as i64;
        Ok(if negative { value.wrapping_neg() } else { value })
    }

    /// The next number of the row as a real one.
    #[inline]
    pub(super) fn real(&mut self, what: &str) -> Result<f64> {
        self.skip_blanks();
        let start = self.at;
        if let Ok((value, len)) = fast_float2::parse_partial::<f64, _>(&self.bytes[start..]) {
            self.at += len;
            if self.ends_here() {
                return Ok(value);
            }
        }
        let token = text::tokens(0, &self.bytes[start..]).next().filter(|token| token.at == 0);
        match token.and_then(|token| text::real(token.bytes).map(|value| (value, token.bytes.len()))) {
            Some((value, len)) => {
                self.at = start + len;
                Ok(value)
            }
            None => Err(self.unlike(start, what)),
        }
    }

    /// The next three numbers as a point.
    #[inline]
    pub(super) fn point(&mut self) -> Result<[f64; 3]> {
        Ok([self.real("a node's x")?, self.real("a node's y")?, self.real("a node's z")?])
    }

    /// The next number as an element type.
    #[inline]
    pub(super) fn kind(&mut self) -> Result<&'static Arc<ElementType>> {
        types::by_number(self.integer("an element type")?)
    }

    /// The end of the row.
    #[inline]
    pub(super) fn end(&mut self) -> Result<()> {
        while let Some(b' ' | b'\t' | b'\r') = self.bytes.get(self.at) {
            self.at += 1;
        }
        match self.bytes.get(self.at) {
            Some(b'\n') => self.at += 1,
            None => {}
            Some(_) => return Err(self.unlike(self.at, "the end of the row")),
        }
        Ok(())
    }

    /// Passes `count` rows whatever they hold.
    pub(super) fn skip(&mut self, count: u64) {
        for _ in 0..count {
            self.at = match memchr::memchr(b'\n', &self.bytes[self.at..]) {
                Some(k) => self.at + k + 1,
                None => return self.at = self.bytes.len(),
            };
        }
    }

    #[inline]
    fn ends_here(&self) -> bool {
        self.bytes.get(self.at).is_none_or(u8::is_ascii_whitespace)
    }

    #[cold]
    fn unlike(&self, at: usize, what: &str) -> Error {
        let found = match self.bytes.get(at) {
            None | Some(b'\n' | b'\r') => "the end of the row".into(),
            Some(_) => excerpt(&self.bytes[at..]),
        };
        Error::malformed(what, found)
    }
}
