//! Reads a file field by field, in either encoding.

use std::ops::Range;

use super::layouts::Encoding;
use crate::error::{Error, Result};
use crate::formats::binary::{Endian, cut_records};
use crate::formats::words::WordWalk;
use crate::input::{Input, Spot};

/// What a row's numbers are.
#[derive(Debug, Clone, Copy)]
pub(super) enum Number {
    Integer,
    Real,
}

/// A place in a file.
pub(super) struct Reader<'i> {
    pub(super) input: &'i Input,
    place: Place<'i>,
    /// Where the last field started, for errors.
    last: u64,
}

enum Place<'i> {
    Text(WordWalk<'i>),
    /// The byte that comes next.
    Binary(u64),
}

impl<'i> Reader<'i> {
    /// Starts at byte `at`.
    pub(super) fn new(input: &'i Input, encoding: Encoding, at: u64) -> Self {
        let place = match encoding {
            Encoding::Text => Place::Text(WordWalk::new(input, at)),
            Encoding::Binary => Place::Binary(at),
        };
        Self { input, place, last: at }
    }

    pub(super) fn encoding(&self) -> Encoding {
        match self.place {
            Place::Text(_) => Encoding::Text,
            Place::Binary(_) => Encoding::Binary,
        }
    }

    /// The next whole number.
    pub(super) fn integer(&mut self, what: &str) -> Result<i64> {
        match &mut self.place {
            Place::Text(walk) => {
                walk.more();
                self.last = walk.at();
                walk.integer(what)
            }
            Place::Binary(at) => {
                self.last = *at;
                let bytes = self.input.source.peek(*at..*at + 4);
                if bytes.len() < 4 {
                    return Err(self.input.source.truncated(what));
                }
                *at += 4;
                Ok(Endian::Little.i32(bytes).into())
            }
        }
    }

    /// The next whole number, which must not be negative.
    pub(super) fn count(&mut self, what: &str) -> Result<u64> {
        let value = self.integer(what)?;
        u64::try_from(value).map_err(|_| self.wrong(what, value))
    }

    /// The next whole number, which must be one of those that are known.
    pub(super) fn one_of(&mut self, known: Range<i64>, what: &str) -> Result<i64> {
        let value = self.integer(what)?;
        if known.contains(&value) { Ok(value) } else { Err(self.wrong(what, value)) }
    }

    /// The next string.
    pub(super) fn string(&mut self, what: &str) -> Result<String> {
        if let Place::Text(walk) = &mut self.place {
            walk.more();
            self.last = walk.at();
            return walk.string(what);
        }
        let from = self.binary_at();
        let length = self.count(&format!("the length of {what}"))?;
        self.last = from;
        let limit = self.input.limits.line_bytes as u64;
        if length > limit {
            let error = Error::limit(format!("the length of {what}"), format!("{limit} characters"));
            return Err(self.place(error));
        }
        let span = self.pass(length * 4, what)?;
        let codes = self.input.source.peek(span).as_chunks::<4>().0;
        Ok(codes.iter().map(|c| char::from_u32(u32::from_le_bytes(*c)).unwrap_or('\u{fffd}')).collect())
    }

    /// Passes `count` rows of `width` numbers each, and cuts them into pieces: the bytes of each, and its first row.
    pub(super) fn rows(
        &mut self,
        (count, width): (u64, u64),
        number: Number,
        what: &str,
        mut piece: impl FnMut(Range<u64>, u64) -> Result<()>,
    ) -> Result<()> {
        if let Place::Text(walk) = &mut self.place {
            return walk.rows(count, width, what, piece);
        }
        let size = match number {
            Number::Integer => 4,
            Number::Real => 8,
        };
        let bytes = width.saturating_mul(size);
        let span = self.pass(count.saturating_mul(bytes), &format!("{count} {what}"))?;
        cut_records(if bytes == 0 { 0 } else { count }, bytes, |run| {
            piece(span.start + run.start * bytes..span.start + run.end * bytes, run.start)
        })
    }

    /// Passes rows that are not needed.
    pub(super) fn skip(&mut self, size: (u64, u64), number: Number, what: &str) -> Result<()> {
        self.rows(size, number, what, |_, _| Ok(()))
    }

    /// The end of the file.
    pub(super) fn end(&mut self) -> Result<()> {
        match &mut self.place {
            Place::Text(walk) => walk.end(),
            Place::Binary(at) if *at == self.input.source.len() => Ok(()),
            Place::Binary(at) => {
                let left = format!("{} more bytes", self.input.source.len() - *at);
                Err(self.input.source.malformed_binary(*at, "the end of the file", left))
            }
        }
    }

    /// The error of a field that was read last and is not what it should be.
    pub(super) fn wrong(&self, expected: &str, found: impl ToString) -> Error {
        self.place(Error::malformed(expected, found.to_string()))
    }

    /// Adds the place of the field that was read last.
    pub(super) fn place(&self, error: Error) -> Error {
        let spot = match self.place {
            Place::Text(_) => Spot::Text(self.last),
            Place::Binary(_) => Spot::Binary(self.last),
        };
        self.input.source.place(error, spot)
    }

    fn binary_at(&self) -> u64 {
        match self.place {
            Place::Text(ref walk) => walk.at(),
            Place::Binary(at) => at,
        }
    }

    /// Passes bytes of a binary file.
    fn pass(&mut self, bytes: u64, what: &str) -> Result<Range<u64>> {
        let from = self.binary_at();
        match from.checked_add(bytes).filter(|&end| end <= self.input.source.len()) {
            Some(end) => {
                self.place = Place::Binary(end);
                Ok(from..end)
            }
            None => Err(self.input.source.truncated(what)),
        }
    }
}
