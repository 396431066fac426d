//! What text formats share: numbers as Fortran and C write them, lines and tokens with their places, cutting at line ends.

use std::ops::Range;

use crate::error::{Bound, Error, Result};
use crate::formats::PIECE_BYTES;
use crate::input::{Input, Limits, Source};

/// A line or a token, and the byte of the file that it starts at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Placed<'t> {
    /// Byte of the file.
    pub at: u64,
    /// The bytes, without the line's end.
    pub bytes: &'t [u8],
}

/// A whole token as a real number: `1.5`, `.5`, `5.`, `+1e3`, `1.5D+03`, `1.5d3`, `1.5-3`. Infinite and NaN are numbers
/// here; the node batch refuses them.
#[inline]
pub fn real(token: &[u8]) -> Option<f64> {
    match fast_float2::parse::<f64, _>(token) {
        Ok(value) => Some(value),
        Err(_) => fortran_real(token),
    }
}

/// Fortran's spellings of an exponent, rewritten to `e`.
#[cold]
fn fortran_real(token: &[u8]) -> Option<f64> {
    let mut buffer = [0u8; 64];
    if token.len() + 1 > buffer.len() {
        return None;
    }
    let mut len = 0;
    let mut exponent = false;
    for (i, &byte) in token.iter().enumerate() {
        let starts_exponent = match byte {
            b'd' | b'D' | b'q' | b'Q' => true,
            b'e' | b'E' => {
                exponent = true;
                false
            }
            b'+' | b'-' => i > 0 && !exponent && (token[i - 1].is_ascii_digit() || token[i - 1] == b'.'),
            _ => false,
        };
        if starts_exponent {
            if exponent {
                return None;
            }
            exponent = true;
            buffer[len] = b'e';
            len += 1;
        }
        if !byte.is_ascii_alphabetic() || matches!(byte, b'e' | b'E') {
            buffer[len] = byte;
            len += 1;
        } else if !starts_exponent {
            return None;
        }
    }
    fast_float2::parse(&buffer[..len]).ok()
}

/// A whole token as a number without a sign (a leading `+` is allowed).
#[inline]
pub fn integer(token: &[u8]) -> Option<u64> {
    let digits = token.strip_prefix(b"+").unwrap_or(token);
    if digits.is_empty() || digits.len() > 19 {
        return None;
    }
    let mut value = 0u64;
    for byte in digits {
        let digit = byte.wrapping_sub(b'0');
        if digit > 9 {
            return None;
        }
        value = value * 10 + u64::from(digit);
    }
    Some(value)
}

/// The digits that `bytes` begin with: their value and how many they are, all eight at once.
#[inline(always)]
pub fn short_number(bytes: &[u8; 8]) -> (u64, usize) {
    const HIGH: u64 = 0x8080_8080_8080_8080;
    // Digits become 0 to 9; what is larger gets its highest bit set, without a carry to its neighbour.
    let digits = u64::from_le_bytes(*bytes) ^ 0x3030_3030_3030_3030;
    let others = (((digits & !HIGH) + 0x7676_7676_7676_7676) | digits) & HIGH;
    let len = others.trailing_zeros() as usize / 8;
    if len == 0 {
        return (0, 0);
    }
    // Moved to the end, with zeros before: pairs, fours and eights are then added up side by side.
    let digits = digits << (64 - 8 * len);
    let pairs = (digits * 10 + (digits >> 8)) & 0x00ff_00ff_00ff_00ff;
    let fours = (pairs * 100 + (pairs >> 16)) & 0x0000_ffff_0000_ffff;
    let eight = (fours * 10_000 + (fours >> 32)) & 0xffff_ffff;
    (eight, len)
}

/// The digits that begin at place `at`, which moves behind them; `None` where there are none, or more than a `u64` is
/// sure to hold.
#[inline(always)]
pub fn digits(bytes: &[u8], at: &mut usize) -> Option<u64> {
    let start = *at;
    let (mut value, len) = bytes.get(start..)?.first_chunk().map_or((0, 0), short_number);
    *at += len;
    if len > 0 && len < 8 {
        return Some(value);
    }
    while let Some(digit) = bytes.get(*at).map(|b| b.wrapping_sub(b'0'))
        && digit < 10
    {
        value = value.wrapping_mul(10).wrapping_add(u64::from(digit));
        *at += 1;
    }
    matches!(*at - start, 1..=19).then_some(value)
}

/// A whole token as a number with a sign.
#[inline]
pub fn signed(token: &[u8]) -> Option<i64> {
    match token.strip_prefix(b"-") {
        Some(digits) => integer(digits).and_then(|v| 0i64.checked_sub_unsigned(v)),
        None => integer(token).and_then(|v| i64::try_from(v).ok()),
    }
}

/// The lines of `bytes`, which start at byte `at` of the file. A line's end is `\n` or `\r\n`.
pub fn lines(at: u64, bytes: &[u8]) -> impl Iterator<Item = Placed<'_>> {
    let mut from = 0;
    std::iter::from_fn(move || {
        if from >= bytes.len() {
            return None;
        }
        let start = from;
        let end = memchr::memchr(b'\n', &bytes[start..]).map_or(bytes.len(), |k| start + k);
        from = end + 1;
        let line = &bytes[start..end];
        Some(Placed { at: at + start as u64, bytes: line.strip_suffix(b"\r").unwrap_or(line) })
    })
}

/// The tokens of `bytes` between blanks of any kind.
pub fn tokens(at: u64, bytes: &[u8]) -> impl Iterator<Item = Placed<'_>> {
    let mut from = 0;
    std::iter::from_fn(move || {
        let start = from + bytes[from..].iter().position(|b| !b.is_ascii_whitespace())?;
        let end = bytes[start..].iter().position(u8::is_ascii_whitespace).map_or(bytes.len(), |k| start + k);
        from = end;
        Some(Placed { at: at + start as u64, bytes: &bytes[start..end] })
    })
}

/// The error of a line, of lines that go on in the next one, or of a word that passes `limits.line_bytes`. It starts at
/// byte `at`; `what` says which of them.
pub fn too_long(source: &Source, what: &str, limit: usize, at: u64) -> Error {
    let error = Error::limit_of(Bound::LineBytes, format!("length of {what}"), format!("{limit} bytes"));
    source.place(error, crate::input::Spot::Text(at))
}

/// Where the line ends that `ahead` begins with, at byte `at` of the file: the number of its bytes, and whether a newline
/// follows. `ahead` goes over the limit or to the file's end. A line over the limit is an error.
pub fn line_length(source: &Source, ahead: &[u8], limit: usize, at: u64) -> Result<(usize, bool)> {
    match memchr::memchr(b'\n', &ahead[..ahead.len().min(limit.saturating_add(1))]) {
        Some(end) => Ok((end, true)),
        None if ahead.len() <= limit => Ok((ahead.len(), false)),
        None => Err(too_long(source, "a line", limit, at)),
    }
}

/// Reads a text file line by line through windows, for outlines: in bounded memory, and with every line's place.
#[derive(Debug)]
pub struct LineReader<'s> {
    source: &'s Source,
    limit: usize,
    /// The next line starts here.
    at: u64,
    window: Option<(u64, crate::input::Window<'s>)>,
}

impl<'s> LineReader<'s> {
    /// A reader that starts at byte `at`.
    pub fn new(source: &'s Source, limits: &Limits, at: u64) -> Self {
        Self { source, limit: limits.line_bytes, at, window: None }
    }

    /// The byte that the next line starts at.
    pub fn position(&self) -> u64 {
        self.at
    }

    /// Goes on at byte `at`.
    pub fn seek(&mut self, at: u64) {
        self.at = at;
    }

    /// The next line, or `None` at the end of the file. A line over the limit is an error.
    pub fn next_line(&mut self) -> Result<Option<Placed<'_>>> {
        const STEP: u64 = 4 << 20;
        if self.at >= self.source.len() {
            return Ok(None);
        }
        let at = self.at;
        let holds = |start: u64, len: usize| at >= start && at < start + len as u64;
        let end_in = |start: u64, bytes: &[u8]| memchr::memchr(b'\n', &bytes[(at - start) as usize..]);
        let found = match &self.window {
            Some((start, window)) if holds(*start, window.len()) => end_in(*start, window),
            _ => None,
        };
        if found.is_none() {
            let window = self.source.window(at..at + STEP.max(self.limit as u64 + 1));
            self.window = Some((at, window));
        }
        let Some((start, window)) = &self.window else { return Ok(None) };
        let rest = &window[(at - start) as usize..];
        let len = match found {
            Some(len) if len <= self.limit => len,
            _ => line_length(self.source, rest, self.limit, at)?.0,
        };
        self.at = at + len as u64 + 1;
        let line = &rest[..len];
        Ok(Some(Placed { at, bytes: line.strip_suffix(b"\r").unwrap_or(line) }))
    }
}

/// Cuts `range` into pieces of about [`PIECE_BYTES`] that end with a line.
pub fn cut_at_lines(
    input: &Input,
    source: &Source,
    range: Range<u64>,
    mut piece: impl FnMut(Range<u64>) -> Result<()>,
) -> Result<()> {
    let mut from = range.start;
    while from < range.end {
        let to = end_of_line(input, source, from + PIECE_BYTES, range.end)?;
        piece(from..to)?;
        from = to;
    }
    Ok(())
}

/// The byte after the end of the line that byte `at` stands on, at most `end`.
pub fn end_of_line(input: &Input, source: &Source, at: u64, end: u64) -> Result<u64> {
    if at >= end {
        return Ok(end);
    }
    let limit = input.limits.line_bytes;
    let window = source.window(at..end.min(at.saturating_add(limit as u64).saturating_add(1)));
    let (len, ends) = line_length(source, &window, limit, at)?;
    Ok(if ends { at + len as u64 + 1 } else { end })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reals_of_fortran_and_c() {
        let rows: [(&str, Option<f64>); 18] = [
            ("1.5", Some(1.5)),
            ("-.5", Some(-0.5)),
            ("5.", Some(5.0)),
            ("+1.5", Some(1.5)),
            ("1.5D+03", Some(1500.0)),
            ("1.5d3", Some(1500.0)),
            ("1.D0", Some(1.0)),
            ("1.5-3", Some(0.0015)),
            ("-7.-1", Some(-0.7)),
            ("2.3+2", Some(230.0)),
            ("1e5", Some(1e5)),
            ("1.5E+003", Some(1500.0)),
            ("", None),
            ("1.5x", None),
            ("1.5-3-3", None),
            ("1_0", None),
            ("--1", None),
            ("1.5e5d5", None),
        ];
        for (text, value) in rows {
            assert_eq!(real(text.as_bytes()), value, "{text:?}");
        }
    }

    #[test]
    fn integers() {
        let rows: [(&str, Option<i64>); 7] = [
            ("7", Some(7)),
            ("+7", Some(7)),
            ("-7", Some(-7)),
            ("", None),
            ("-", None),
            ("7.", None),
            ("99999999999999999999", None),
        ];
        for (text, value) in rows {
            assert_eq!(signed(text.as_bytes()), value, "{text:?}");
        }
    }

    /// Numbers without order, the same at every run.
    fn noise(seed: u64) -> impl FnMut() -> u64 {
        let mut state = seed;
        move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            state ^ state >> 29
        }
    }

    #[test]
    fn a_million_whole_numbers_are_those_of_the_standard_library() {
        let mut random = noise(1);
        let mut line = String::new();
        for _ in 0..1_000_000 {
            let (number, cut, zeros) = (random(), random() % 64, random() % 16);
            let number = number >> cut;
            line.clear();
            let zeros = if zeros < 3 { zeros as usize } else { 0 };
            let after = [" 7 8 9 10", "\n", ",", "", "x", ".5", "\u{fffd}"][(cut % 7) as usize];
            line.extend(std::iter::repeat_n('0', zeros));
            line += &number.to_string();
            let digits_long = line.len();
            line += after;
            let mut at = 0;
            let expected = line[..digits_long].parse::<u64>().ok().filter(|_| digits_long <= 19);
            assert_eq!(digits(line.as_bytes(), &mut at), expected, "{line:?}");
            assert_eq!(at, digits_long, "{line:?}");
        }
    }

    #[test]
    fn a_million_real_numbers_are_those_of_the_standard_library_to_the_last_bit() {
        let mut random = noise(2);
        for k in 0..1_000_000u64 {
            let bits = random();
            // All doubles, such as meshes have, halfway cases with a digit too many, and subnormal ones.
            let x = match k % 4 {
                0 => f64::from_bits(bits),
                1 => (bits >> 11) as f64 / (1u64 << 53) as f64 - 0.5,
                2 => (bits as i64 >> 20) as f64 * 1e-9,
                _ => f64::from_bits(bits >> 12),
            };
            if !x.is_finite() {
                continue;
            }
            let text = match bits % 5 {
                0 => format!("{x:?}"),
                1 => format!("{x:.16e}"),
                2 => format!("{x:.17e}"),
                3 => format!("{x:.6}"),
                _ => format!("{x:e}"),
            };
            let expected: f64 = text.parse().expect("the library wrote it");
            assert_eq!(real(text.as_bytes()).map(f64::to_bits), Some(expected.to_bits()), "{text}");
        }
    }

    #[test]
    fn lines_and_tokens_know_their_place() {
        let found: Vec<_> = lines(10, b"ab\r\n\ncd").map(|l| (l.at, l.bytes.to_vec())).collect();
        assert_eq!(found, [(10, b"ab".to_vec()), (14, vec![]), (15, b"cd".to_vec())]);
        let found: Vec<_> = tokens(10, b"  a bc\n d ").map(|t| (t.at, t.bytes.to_vec())).collect();
        assert_eq!(found, [(12, b"a".to_vec()), (14, b"bc".to_vec()), (18, b"d".to_vec())]);
    }
}
