//! Text of one record a line, with the number of lines known from a header: finding, cutting and reading such lines.

use std::ops::Range;

use crate::error::{Error, Result};
use crate::formats::PIECE_BYTES;
use crate::formats::text::{self, LineReader, Placed};
use crate::input::Source;

/// What of a line counts: OFF has comments from a `#` on. Nothing is left of a line that holds no record.
#[inline]
pub(super) fn record(line: &[u8]) -> &[u8] {
    line[..memchr::memchr(b'#', line).unwrap_or(line.len())].trim_ascii_end()
}

/// Goes over `count` records and cuts them into pieces: a range of bytes, and the number of its first record.
pub(super) fn cut(
    source: &Source,
    lines: &mut LineReader<'_>,
    count: u64,
    what: &str,
    mut piece: impl FnMut(Range<u64>, u64) -> Result<()>,
) -> Result<()> {
    let (mut from, mut first) = (lines.position(), 0);
    for row in 0..count {
        loop {
            match lines.next_line()? {
                Some(line) if record(line.bytes).is_empty() => {}
                Some(_) => break,
                None => {
                    let expected = format!("{} more lines of {what}, {count} in all", count - row);
                    return Err(source.malformed_text(source.len(), expected));
                }
            }
        }
        // A number that is cut short is still a number.
        if lines.position() > source.len() {
            let expected = format!("the end of the line of one of the {count} {what}");
            return Err(source.malformed_text(source.len(), expected));
        }
        let to = lines.position();
        if to - from >= PIECE_BYTES || row + 1 == count {
            piece(from..to, first)?;
            (from, first) = (to, row + 1);
        }
    }
    Ok(())
}

/// The next line that holds a record; `expected` says what should stand there.
pub(super) fn next<'l>(
    source: &Source,
    lines: &'l mut LineReader<'_>,
    expected: impl FnOnce() -> String,
) -> Result<Placed<'l>> {
    let mut at = lines.position();
    while lines.next_line()?.is_some_and(|line| record(line.bytes).is_empty()) {
        at = lines.position();
    }
    lines.seek(at);
    match lines.next_line()? {
        Some(line) => Ok(Placed { at: line.at, bytes: record(line.bytes) }),
        None => Err(source.malformed_text(source.len(), expected())),
    }
}

/// The records of a piece.
pub(super) fn records(at: u64, bytes: &[u8]) -> impl Iterator<Item = Placed<'_>> {
    text::lines(at, bytes)
        .map(|line| Placed { at: line.at, bytes: record(line.bytes) })
        .filter(|line| !line.bytes.is_empty())
}

/// The next word of a record as a real number.
#[inline]
pub(super) fn real<'w>(words: &mut impl Iterator<Item = Placed<'w>>, what: &str) -> Result<f64> {
    let word = words.next().map_or(&b""[..], |word| word.bytes);
    text::real(word).ok_or_else(|| wrong(what, word))
}

/// The next word of a record as a whole number that is not negative.
#[inline]
pub(super) fn integer<'w>(words: &mut impl Iterator<Item = Placed<'w>>, what: &str) -> Result<u64> {
    let word = words.next().map_or(&b""[..], |word| word.bytes);
    text::integer(word).ok_or_else(|| wrong(what, word))
}

/// The error of a word that is not what it should be; an empty one stands for the end of the line.
#[cold]
pub(super) fn wrong(expected: &str, found: &[u8]) -> Error {
    let found = if found.is_empty() { "the end of the line".into() } else { crate::error::excerpt(found) };
    Error::malformed(expected, found)
}

/// x, y and z.
#[inline]
pub(super) fn point<'w>(words: &mut impl Iterator<Item = Placed<'w>>) -> Result<[f64; 3]> {
    Ok([real(words, "x")?, real(words, "y")?, real(words, "z")?])
}
