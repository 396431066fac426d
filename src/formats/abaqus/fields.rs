//! Data lines: numbers between commas, blanks anywhere, comments between lines.

use crate::error::{Error, Result, excerpt};
use crate::formats::text;

/// Numbers of nodes and elements stay under this: the bits above hold the instance.
pub(super) const LARGEST_NUMBER: u64 = (1 << 40) - 1;

/// A place in the data lines of a piece.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fields<'t> {
    bytes: &'t [u8],
    /// Byte of the piece.
    pub(super) at: usize,
}

impl<'t> Fields<'t> {
    /// The start of `bytes`, which must be that of a line.
    pub(super) fn new(bytes: &'t [u8]) -> Self {
        Self { bytes, at: 0 }
    }

    /// The bytes from here on.
    pub(super) fn rest(&self) -> &'t [u8] {
        &self.bytes[self.at..]
    }

    #[inline]
    fn byte(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    #[inline]
    fn skip_blanks(&mut self) {
        while let Some(b' ' | b'\t' | b'\r') = self.byte() {
            self.at += 1;
        }
    }

    /// From the start of a line to the first field of the next data line; false at the end of the piece.
    #[inline]
    pub(super) fn next_line(&mut self) -> Result<bool> {
        loop {
            self.skip_blanks();
            match self.byte() {
                None => return Ok(false),
                Some(b'\n') => self.at += 1,
                Some(b'*') if self.bytes.get(self.at + 1) == Some(&b'*') => self.skip_line(),
                Some(b'*') => return Err(self.malformed("a data line")),
                Some(_) => return Ok(true),
            }
        }
    }

    fn skip_line(&mut self) {
        let rest = &self.bytes[self.at..];
        self.at += memchr::memchr(b'\n', rest).map_or(rest.len(), |k| k + 1);
    }

    /// After a comma: whether the line ends here. Goes past the end.
    #[inline]
    pub(super) fn ends_line(&mut self) -> bool {
        self.skip_blanks();
        match self.byte() {
            None => true,
            Some(b'\n') => {
                self.at += 1;
                true
            }
            Some(_) => false,
        }
    }

    /// After a field: goes past a comma (true) or the end of the line (false).
    #[inline]
    pub(super) fn comma(&mut self) -> Result<bool> {
        if self.byte() == Some(b',') {
            self.at += 1;
            return Ok(true);
        }
        if self.ends_line() {
            return Ok(false);
        }
        match self.byte() {
            Some(b',') => {
                self.at += 1;
                Ok(true)
            }
            _ => Err(self.malformed("a comma or the end of the line")),
        }
    }

    /// Whether the field is blank: a comma stands here.
    #[inline]
    pub(super) fn is_blank(&mut self) -> bool {
        self.skip_blanks();
        self.byte() == Some(b',')
    }

    /// A number without a sign, 0 to [`LARGEST_NUMBER`].
    #[inline]
    pub(super) fn integer(&mut self, expected: &str) -> Result<u64> {
        self.skip_blanks();
        let start = self.at;
        let (mut value, len) = self.bytes[start..].first_chunk().map_or((0, 0), text::short_number);
        self.at += len;
        if len == 0 || len == 8 {
            while let Some(digit) = self.byte().map(|b| b.wrapping_sub(b'0')).filter(|digit| *digit < 10) {
                value = value.wrapping_mul(10).wrapping_add(u64::from(digit));
                self.at += 1;
            }
        }
        let len = self.at - start;
        if len == 0 || len > 18 || value > LARGEST_NUMBER {
            self.at = start;
            return Err(self.malformed(format!("{expected} up to {LARGEST_NUMBER}")));
        }
        Ok(value)
    }

    /// The number of a node or element: from 1.
    #[inline]
    pub(super) fn number(&mut self, expected: &str) -> Result<u64> {
        self.skip_blanks();
        let start = self.at;
        match self.integer(expected) {
            Ok(0) => {
                self.at = start;
                Err(self.malformed(format!("{expected} from 1")))
            }
            done => done,
        }
    }

    /// A real number; a blank field is 0.
    #[inline]
    pub(super) fn real(&mut self) -> Result<f64> {
        self.skip_blanks();
        let rest = &self.bytes[self.at..];
        match fast_float2::parse_partial::<f64, _>(rest) {
            Ok((value, len)) if matches!(rest.get(len), None | Some(b',' | b'\n' | b'\r' | b' ')) => {
                self.at += len;
                Ok(value)
            }
            _ => self.unusual_real(),
        }
    }

    /// Exponents as Fortran writes them, blank fields, and whatever is no number.
    #[cold]
    fn unusual_real(&mut self) -> Result<f64> {
        let token = self.token();
        if token.is_empty() {
            return Ok(0.0);
        }
        match text::real(token) {
            Some(value) => {
                self.at += token.len();
                Ok(value)
            }
            None => Err(self.malformed("a number")),
        }
    }

    /// Whole numbers up to the end of the line, each with what it is where nothing stands there.
    pub(super) fn integers<const N: usize>(&mut self, absent: [Option<u64>; N]) -> Result<[u64; N]> {
        let (mut values, mut more) = ([0; N], true);
        for (value, absent) in values.iter_mut().zip(absent) {
            more = more && !self.ends_line();
            let given = more && !self.is_blank();
            *value = match absent {
                Some(absent) if !given => absent,
                _ => self.integer("a number")?,
            };
            more = more && self.comma()?;
        }
        if more && !self.ends_line() {
            return Err(self.malformed(format!("at most {N} numbers")));
        }
        Ok(values)
    }

    /// Up to ten numbers to the end of the line, and how many they are; what is not given is 0.
    pub(super) fn reals(&mut self) -> Result<([f64; 10], usize)> {
        let (mut values, mut count) = ([0.0; 10], 0);
        let mut more = true;
        while more && !self.ends_line() {
            let Some(value) = values.get_mut(count) else {
                return Err(self.malformed("at most ten numbers"));
            };
            *value = self.real()?;
            count += 1;
            more = self.comma()?;
        }
        Ok((values, count))
    }

    /// The field's bytes without the blanks round them, quoted ones whole.
    pub(super) fn token(&mut self) -> &'t [u8] {
        self.skip_blanks();
        let rest = &self.bytes[self.at..];
        let mut quoted = false;
        let end = rest.iter().position(|b| {
            quoted ^= *b == b'"';
            matches!(b, b'\n') || (*b == b',' && !quoted)
        });
        rest[..end.unwrap_or(rest.len())].trim_ascii_end()
    }

    /// The error of what stands here.
    #[cold]
    pub(super) fn malformed(&self, expected: impl Into<String>) -> Error {
        let rest = &self.bytes[self.at..];
        match rest.first() {
            Some(b'<') => Error::unsupported(format!(
                "the parameter in {} is not substituted",
                excerpt(&rest[..rest.iter().position(|b| *b == b'>').map_or(rest.len(), |k| k + 1)])
            )),
            Some(b'\n') => Error::malformed(expected, "the end of the line"),
            _ => Error::malformed(expected, excerpt(rest)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reals_in_all_spellings() {
        for (text, value) in [
            (" 1.5 ,", 1.5),
            ("1.D0\n", 1.0),
            ("-2.5d-1\r\n", -0.25),
            ("1.5-3", 0.0015),
            (" ,", 0.0),
            ("3\t", 3.0),
        ] {
            let mut fields = Fields::new(text.as_bytes());
            assert_eq!(fields.real().expect(text), value, "{text:?}");
            assert!(fields.comma().is_ok(), "{text:?}");
        }
        for text in ["x", "1.5x,", "1 5", "--1", "<r>, 2"] {
            let mut fields = Fields::new(text.as_bytes());
            assert!(fields.real().is_err() || fields.comma().is_err(), "{text:?}");
        }
    }

    #[test]
    fn numbers_of_any_length_before_any_byte() {
        for digits in 1..=12 {
            for number in [10u64.pow(digits - 1), 10u64.pow(digits) - 1, 123_456_789_012 % 10u64.pow(digits)]
            {
                for after in ["", ",", "\n", " ", "/", ":", "\u{ff},,,,,,,,", ", 2, 3, 4, 5", "a23456789"] {
                    let text = format!("{number}{after}");
                    let mut fields = Fields::new(text.as_bytes());
                    assert_eq!(fields.integer("a number").expect(&text), number, "{text}");
                    assert_eq!(fields.at, number.to_string().len(), "{text}");
                }
            }
        }
    }

    #[test]
    fn numbers_have_bounds() {
        for (text, good) in [
            ("1", true),
            ("999999999", true),
            ("1099511627775", true),
            ("1099511627776", false),
            ("0", false),
        ] {
            assert_eq!(Fields::new(text.as_bytes()).number("a node number").is_ok(), good, "{text}");
        }
        for text in ["-1", "", "+1", "99999999999999999999999999", "1.5x", "a"] {
            let mut fields = Fields::new(text.as_bytes());
            assert!(fields.number("a node number").is_err() || fields.comma().is_err(), "{text}");
        }
    }
}
