//! Records in fixed columns, as Fortran writes them: numbers may touch, so that columns and not blanks part them.

use std::ops::Range;

use crate::error::{Error, Result, excerpt};
use crate::formats::{PIECE_BYTES, text};
use crate::input::{Source, Spot};

/// The field of `width` columns from column `from` on, counted from 0, without blanks; empty beyond the line's end.
#[inline]
pub fn field(line: &[u8], from: usize, width: usize) -> &[u8] {
    let end = line.len().min(from + width);
    line.get(from..end).unwrap_or_default().trim_ascii()
}

/// The number in a field; `what` names it in errors.
#[inline]
pub fn integer(line: &[u8], from: usize, width: usize, what: &str) -> Result<u64> {
    text::integer(field(line, from, width)).ok_or_else(|| no_number(line, from, width, what))
}

/// The number in a field that may be blank, which stands for 0.
#[inline]
pub fn integer_or_zero(line: &[u8], from: usize, width: usize, what: &str) -> Result<u64> {
    if field(line, from, width).is_empty() { Ok(0) } else { integer(line, from, width, what) }
}

/// The real number in a field.
#[inline]
pub fn real(line: &[u8], from: usize, width: usize, what: &str) -> Result<f64> {
    text::real(field(line, from, width)).ok_or_else(|| no_number(line, from, width, what))
}

/// The real number in a field that may be blank, which stands for 0.
#[inline]
pub fn real_or_zero(line: &[u8], from: usize, width: usize, what: &str) -> Result<f64> {
    if field(line, from, width).is_empty() { Ok(0.0) } else { real(line, from, width, what) }
}

#[cold]
fn no_number(line: &[u8], from: usize, width: usize, what: &str) -> Error {
    let found = match line.get(from..line.len().min(from + width)) {
        Some(bytes) if !bytes.is_empty() => excerpt(bytes),
        _ => "the end of the line".into(),
    };
    Error::malformed(format!("{what} in columns {} to {}", from + 1, from + width), found)
}

/// Gathers records that follow one another into pieces of about [`PIECE_BYTES`].
#[derive(Debug, Default)]
pub struct Gathered {
    from: Option<u64>,
}

impl Gathered {
    /// A record begins at byte `at`. Gives the piece that ends before it, once one is full.
    pub fn record(&mut self, at: u64) -> Option<Range<u64>> {
        let from = *self.from.get_or_insert(at);
        if at - from < PIECE_BYTES {
            return None;
        }
        self.from = Some(at);
        Some(from..at)
    }

    /// Whether no record has begun.
    pub fn is_empty(&self) -> bool {
        self.from.is_none()
    }

    /// The records end before byte `at`. Gives the last piece.
    pub fn end(&mut self, at: u64) -> Option<Range<u64>> {
        self.from.take().map(|from| from..at)
    }
}

/// The error of a text file that ends where `expected` should follow.
pub fn cut_off(source: &Source, expected: impl Into<String>) -> Error {
    let error = Error::malformed(expected, "the end of the file");
    source.place(error, Spot::Text(source.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_touch_are_parted_by_columns() {
        let line = b" -1    7 0.10000E+01-0.20000E+01";
        assert_eq!(integer(line, 3, 5, "a number").ok(), Some(7));
        assert_eq!(real(line, 8, 12, "x").ok(), Some(1.0));
        assert_eq!(real(line, 20, 12, "y").ok(), Some(-2.0));
        assert_eq!(real_or_zero(line, 32, 12, "z").ok(), Some(0.0));
        let error = real(line, 32, 12, "z").expect_err("nothing there").to_string();
        assert_eq!(error, "expected z in columns 33 to 44, found the end of the line");
    }

    #[test]
    fn pieces_begin_with_records() {
        let mut gathered = Gathered::default();
        assert_eq!(gathered.record(10), None);
        assert_eq!(gathered.record(11), None);
        assert_eq!(gathered.record(10 + PIECE_BYTES), Some(10..10 + PIECE_BYTES));
        assert_eq!(gathered.end(20 + PIECE_BYTES), Some(10 + PIECE_BYTES..20 + PIECE_BYTES));
        assert!(gathered.is_empty() && gathered.end(99).is_none());
    }
}
