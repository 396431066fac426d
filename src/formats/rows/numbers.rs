//! A place in text, and the numbers that follow it.

use super::is_blank;
use crate::error::{Error, Result, excerpt};
use crate::formats::text;
use crate::input::Spot;

/// A place among numbers with blanks between. Ends of lines are blanks; comments go to the end of their line.
#[derive(Debug, Clone)]
pub struct Numbers<'t> {
    bytes: &'t [u8],
    at: usize,
    /// The byte of the file that `bytes` start at.
    base: u64,
    comment: u8,
}

impl<'t> Numbers<'t> {
    /// The numbers of `bytes`, which start at byte `base` of the file; `comment` begins a comment.
    pub fn new(base: u64, bytes: &'t [u8], comment: u8) -> Self {
        Self { bytes, at: 0, base, comment }
    }

    /// The place, for errors.
    #[inline]
    pub fn spot(&self) -> Spot {
        Spot::Text(self.base + self.at as u64)
    }

    /// The bytes from here on.
    pub fn rest(&self) -> &'t [u8] {
        &self.bytes[self.at..]
    }

    /// Goes on after `bytes` bytes.
    pub fn pass(&mut self, bytes: usize) {
        self.at += bytes;
    }

    /// Passes blanks and comments; says whether something follows.
    #[inline]
    pub fn more(&mut self) -> bool {
        while let Some(&byte) = self.bytes.get(self.at) {
            if byte == self.comment {
                let rest = &self.bytes[self.at..];
                self.at += memchr::memchr(b'\n', rest).unwrap_or(rest.len());
            } else if is_blank(byte) {
                self.at += 1;
            } else {
                return true;
            }
        }
        false
    }

    /// The next number, without a sign.
    #[inline]
    pub fn integer(&mut self, what: &str) -> Result<u64> {
        self.more();
        let start = self.at;
        let value = text::digits(self.bytes, &mut self.at);
        value.filter(|_| self.ends_here()).ok_or_else(|| self.unlike(start, what))
    }

    /// Passes a whole number of either sign.
    #[inline]
    pub fn reference(&mut self, what: &str) -> Result<i64> {
        self.more();
        let start = self.at;
        self.at += usize::from(matches!(self.bytes.get(self.at), Some(b'-' | b'+')));
        let digits = self.bytes[self.at..].iter().take_while(|b| b.is_ascii_digit()).count();
        self.at += digits;
        if digits == 0 || !self.ends_here() {
            // Some writers have references as real numbers.
            self.at = start;
            return self.real(what).map(|value| value as i64);
        }
        // A sign and digits: what does not fit is no region that anybody could tell from others.
        Ok(std::str::from_utf8(&self.bytes[start..self.at])
            .ok()
            .and_then(|t| t.parse().ok())
            .unwrap_or(i64::MAX))
    }

    /// The next number as a real one.
    #[inline]
    pub fn real(&mut self, what: &str) -> Result<f64> {
        self.more();
        let start = self.at;
        if let Ok((value, len)) = fast_float2::parse_partial::<f64, _>(&self.bytes[start..]) {
            self.at += len;
            if self.ends_here() {
                return Ok(value);
            }
        }
        let rest = &self.bytes[start..];
        let len = rest.iter().position(|b| is_blank(*b) || *b == self.comment).unwrap_or(rest.len());
        match text::real(&rest[..len]) {
            Some(value) => {
                self.at = start + len;
                Ok(value)
            }
            None => Err(self.unlike(start, what)),
        }
    }

    #[inline]
    fn ends_here(&self) -> bool {
        self.bytes.get(self.at).is_none_or(|b| is_blank(*b) || *b == self.comment)
    }

    /// The error of what stands here.
    #[cold]
    pub fn unlike_here(&self, what: &str) -> Error {
        self.unlike(self.at, what)
    }

    #[cold]
    fn unlike(&self, at: usize, what: &str) -> Error {
        let found = match self.bytes.get(at) {
            None => "the end of the row".into(),
            Some(_) => excerpt(&self.bytes[at..]),
        };
        Error::malformed(what, found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_every_spelling() {
        let mut numbers = Numbers::new(10, b" 12\t+1.5D2 # 7 8\n\r\n-3 4.0 .5#x\n 1-2 ", b'#');
        assert_eq!(numbers.integer("n").expect("12"), 12);
        assert_eq!(numbers.real("x").expect("150"), 150.0);
        numbers.reference("r").expect("-3");
        numbers.reference("r").expect("4.0");
        assert_eq!(numbers.real("x").expect("0.5"), 0.5);
        assert_eq!(numbers.real("x").expect("0.01"), 0.01);
        assert!(!numbers.more());
        assert!(numbers.integer("a number").expect_err("the end").to_string().contains("the end of the row"));
        for bad in ["-1", "1.5", "1x", "12345678901234567890", "", "x"] {
            assert!(Numbers::new(0, bad.as_bytes(), b'#').integer("n").is_err(), "{bad}");
        }
    }
}
