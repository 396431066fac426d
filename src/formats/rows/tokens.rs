//! Goes through text token by token, or over a great many of them at once, in windows.

use std::sync::Arc;

use super::is_blank;
use crate::error::{Error, Result};
use crate::formats::PIECE_BYTES;
use crate::formats::text::{self, Placed};
use crate::input::{Input, Source, Window};

/// Longest word or number that is read.
const LONGEST: usize = 4096;
/// Bytes that are counted in one go.
const STRIDE: usize = 4096;
/// Tokens that are passed one by one before counting is tried again.
const RETRY: u64 = 512;

/// A place in a file of words and numbers. Words begin with a letter.
#[derive(Debug)]
pub struct TokenReader<'i> {
    /// The file.
    pub source: &'i Arc<Source>,
    comment: u8,
    at: u64,
    window: (u64, Window<'i>),
}

impl<'i> TokenReader<'i> {
    /// The start of the file; `comment` begins a comment, which goes to the end of its line.
    pub fn new(input: &'i Input, comment: u8) -> Self {
        Self { source: &input.source, comment, at: 0, window: (0, input.source.window(0..0)) }
    }

    /// The byte that comes next.
    pub fn position(&self) -> u64 {
        self.at
    }

    /// What begins a comment.
    pub fn comment(&self) -> u8 {
        self.comment
    }

    /// The bytes that follow: more than the longest token, or all up to the file's end.
    fn ahead(&mut self) -> &[u8] {
        const STEP: u64 = 4 << 20;
        let (start, window) = &self.window;
        let end = start + window.len() as u64;
        if self.at < *start || self.at + 4 * LONGEST as u64 > end && end < self.source.len() {
            self.window = (self.at, self.source.window(self.at..self.at + STEP));
        }
        &self.window.1[(self.at - self.window.0) as usize..]
    }

    /// Passes blanks and comments; says whether something follows.
    pub fn more(&mut self) -> bool {
        let (comment, mut inside) = (self.comment, false);
        loop {
            let ahead = self.ahead();
            if ahead.is_empty() {
                return false;
            }
            let mut k = 0;
            while k < ahead.len() {
                if inside {
                    let end = memchr::memchr(b'\n', &ahead[k..]);
                    inside = end.is_none();
                    k = end.map_or(ahead.len(), |n| k + n);
                } else if ahead[k] == comment {
                    inside = true;
                } else if is_blank(ahead[k]) {
                    k += 1;
                } else {
                    self.at += k as u64;
                    return true;
                }
            }
            self.at += k as u64;
        }
    }

    /// The next word or number.
    pub fn token(&mut self) -> Result<Option<Placed<'_>>> {
        if !self.more() {
            return Ok(None);
        }
        let (at, comment) = (self.at, self.comment);
        let ahead = self.ahead();
        let len = ahead.iter().take(LONGEST + 1).position(|b| is_blank(*b) || *b == comment);
        let len = len.unwrap_or(ahead.len());
        if len > LONGEST {
            return Err(text::too_long(self.source, "a word", LONGEST, at));
        }
        self.at += len as u64;
        let from = (at - self.window.0) as usize;
        Ok(Some(Placed { at, bytes: &self.window.1[from..from + len] }))
    }

    /// The next token as a number without a sign.
    pub fn integer(&mut self, what: &str) -> Result<u64> {
        let found = self.token()?.map(|token| (token.at, text::integer(token.bytes)));
        match found {
            Some((_, Some(value))) => Ok(value),
            Some((at, None)) => Err(self.source.malformed_text(at, what)),
            None => Err(self.source.malformed_text(self.source.len(), what)),
        }
    }

    /// What [`Self::integer`] would give, if it is a number.
    pub fn peek_integer(&mut self) -> Result<Option<u64>> {
        let at = self.at;
        let found = self.token()?.and_then(|token| text::integer(token.bytes));
        self.at = at;
        Ok(found)
    }

    /// How many tokens stand on the line of the next one.
    pub fn tokens_of_line(&mut self) -> usize {
        self.more();
        let comment = self.comment;
        let line = self.ahead().split(|b| *b == b'\n' || *b == comment).next().unwrap_or_default();
        text::tokens(0, line).count()
    }

    /// Passes all numbers up to the next word or the end of the file; says how many.
    pub fn pass_to_word(&mut self) -> Result<u64> {
        self.pass(u64::MAX, u64::MAX, 1).map(|passed| passed.0)
    }

    /// Passes rows of `width` numbers: at most `rows`, and no more once a piece is full. Says how many. A word or the
    /// end of the file before is an error, in which `what` says what the rows are.
    pub fn pass_rows(&mut self, rows: u64, width: u64, what: &str) -> Result<u64> {
        let (passed, stopped) = self.pass(rows.saturating_mul(width), PIECE_BYTES, width)?;
        if stopped {
            return Err(too_few(self.source, self.at, what, rows, passed / width));
        }
        Ok(passed / width)
    }

    /// Passes at most `most` numbers, and once `bytes` bytes are passed only those that fill a row. Says how many, and
    /// whether a word or the end of the file came before.
    fn pass(&mut self, most: u64, bytes: u64, width: u64) -> Result<(u64, bool)> {
        let (begin, mut passed) = (self.at, 0u64);
        loop {
            let full = self.at - begin >= bytes;
            let wanted = if full { passed.next_multiple_of(width) } else { most } - passed;
            if wanted == 0 {
                return Ok((passed, false));
            }
            let counted = if full { 0 } else { self.pass_stride(wanted) };
            passed += counted;
            if counted > 0 {
                continue;
            }
            for _ in 0..wanted.min(RETRY) {
                if !self.more() || self.ahead()[0].is_ascii_alphabetic() {
                    return Ok((passed, true));
                }
                self.token()?;
                passed += 1;
            }
        }
    }

    /// Passes a stride of tokens if there are at most `wanted`, no words and no comments in it.
    fn pass_stride(&mut self, wanted: u64) -> u64 {
        let comment = self.comment;
        let ahead = self.ahead();
        let near = &ahead[..ahead.len().min(STRIDE)];
        let Some(end) = near.iter().rposition(|b| is_blank(*b)) else { return 0 };
        match count(&near[..=end], comment) {
            Some(tokens) if tokens <= wanted => {
                self.at += end as u64 + 1;
                tokens
            }
            _ => 0,
        }
    }
}

/// Number of tokens in `bytes`, which start outside of one; nothing if there is a word or a comment among them.
fn count(bytes: &[u8], comment: u8) -> Option<u64> {
    /// So many bytes have fewer tokens than a byte can count.
    const BLOCK: usize = 128;
    let first = *bytes.first()?;
    let mut tokens = u64::from(!is_blank(first));
    let mut others = first.is_ascii_alphabetic() || first == comment;
    for (before, here) in bytes.chunks(BLOCK).zip(bytes[1..].chunks(BLOCK)) {
        // Without branches, so that it is done for many bytes at once.
        let (mut starts, mut odd) = (0u8, false);
        for (before, here) in before.iter().zip(here) {
            let starts_here = is_blank(*before) & !is_blank(*here);
            starts += u8::from(starts_here);
            odd |= (starts_here & here.is_ascii_alphabetic()) | (*here == comment);
        }
        tokens += u64::from(starts);
        others |= odd;
    }
    (!others).then_some(tokens)
}

/// The error of a table that holds fewer rows than it says.
pub(super) fn too_few(source: &Source, at: u64, what: &str, rows: u64, found: u64) -> Error {
    source.malformed_text(at, format!("{what}, {rows} in all, and not only {found}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tokens_are_counted_as_one_by_one() {
        let texts = ["1 22\n 333", " 1", "\t\r\n ", "1", &"12 3\n".repeat(100), &" 1e5 -2".repeat(99)];
        for text in texts {
            let expected = text.split_ascii_whitespace().count() as u64;
            assert_eq!(count(text.as_bytes(), b'#'), Some(expected), "{text:?}");
        }
        for text in ["End", "1 2 End", "1 # 2", "#", "1\nEnd\n"] {
            assert_eq!(count(text.as_bytes(), b'#'), None, "{text:?}");
        }
    }
}
