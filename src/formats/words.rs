//! Text that is one stream of words: a line's end means no more than a blank, and `#` starts a comment up to it.

use std::ops::Range;
use std::sync::Arc;

use crate::error::{Error, Result, excerpt};
use crate::formats::{PIECE_BYTES, text};
use crate::input::{Input, Source, Spot, Window};

/// Longest word: a number with room to spare.
const WORD_BYTES: usize = 4096;
/// How much is looked at, at a time, where words are only counted.
const STEP: usize = 16 << 10;

#[inline]
fn is_blank(byte: u8) -> bool {
    byte <= b' '
}

#[inline]
fn is_word(byte: u8) -> bool {
    !is_blank(byte) && byte != b'#'
}

/// Reads numbers from words that lie in memory.
#[derive(Debug)]
pub struct Words<'t> {
    bytes: &'t [u8],
    at: usize,
    /// The byte of the file that `bytes` start at.
    base: u64,
}

impl<'t> Words<'t> {
    /// The words of `bytes`, which start at byte `base` of the file.
    pub fn new(base: u64, bytes: &'t [u8]) -> Self {
        Self { bytes, at: 0, base }
    }

    /// Goes to the next word; says whether there is one.
    #[inline]
    pub fn more(&mut self) -> bool {
        while let Some(&byte) = self.bytes.get(self.at) {
            if byte == b'#' {
                let end = memchr::memchr(b'\n', &self.bytes[self.at..]);
                self.at = end.map_or(self.bytes.len(), |k| self.at + k);
            } else if !is_blank(byte) {
                return true;
            } else {
                self.at += 1;
            }
        }
        false
    }

    /// The place, for errors.
    #[inline]
    pub fn spot(&self) -> Spot {
        Spot::Text(self.base + self.at as u64)
    }

    /// The next word as a number without a sign.
    #[inline]
    pub fn integer(&mut self, what: &str) -> Result<u64> {
        self.more();
        let start = self.at;
        let value = text::digits(self.bytes, &mut self.at);
        value.filter(|_| self.ends_here()).ok_or_else(|| self.unlike(start, what))
    }

    /// The next word as a real number.
    #[inline]
    pub fn real(&mut self, what: &str) -> Result<f64> {
        self.more();
        let start = self.at;
        if let Ok((value, len)) = fast_float2::parse_partial::<f64, _>(&self.bytes[start..]) {
            self.at += len;
            if self.ends_here() {
                return Ok(value);
            }
            self.at = start;
        }
        let word = self.word();
        text::real(word).ok_or_else(|| self.unlike(start, what))
    }

    /// The next word; empty where there is none.
    pub fn word(&mut self) -> &'t [u8] {
        self.more();
        let rest = &self.bytes[self.at..];
        let word = &rest[..rest.iter().position(|&b| !is_word(b)).unwrap_or(rest.len())];
        self.at += word.len();
        word
    }

    /// Passes the next word.
    pub fn skip(&mut self) {
        self.word();
    }

    #[inline]
    fn ends_here(&self) -> bool {
        self.bytes.get(self.at).is_none_or(|&b| !is_word(b))
    }

    #[cold]
    fn unlike(&self, at: usize, what: &str) -> Error {
        let word = Words::new(0, &self.bytes[at..]).word();
        let found = if word.is_empty() { "no number".into() } else { excerpt(word) };
        Error::malformed(what, found)
    }
}

/// Walks through a file of words once, in windows, to find where its parts stand.
#[derive(Debug)]
pub struct WordWalk<'i> {
    source: &'i Arc<Source>,
    line_bytes: usize,
    at: u64,
    /// Where the window starts, and the window.
    window: (u64, Window<'i>),
}

impl<'i> WordWalk<'i> {
    /// A walk that starts at byte `at`.
    pub fn new(input: &'i Input, at: u64) -> Self {
        let source = &input.source;
        Self { source, line_bytes: input.limits.line_bytes, at, window: (at, source.window(at..at)) }
    }

    /// The byte that comes next.
    pub fn at(&self) -> u64 {
        self.at
    }

    /// The bytes that follow: `least` of them, or all up to the file's end.
    fn ahead(&mut self, least: usize) -> &[u8] {
        const WINDOW: u64 = 4 << 20;
        let (start, window) = &self.window;
        let end = start + window.len() as u64;
        if self.at < *start || self.at > end || (self.at + least as u64 > end && end < self.source.len()) {
            let to = self.at + WINDOW.max(least as u64);
            self.window = (self.at, self.source.window(self.at..to));
        }
        &self.window.1[(self.at - self.window.0) as usize..]
    }

    /// Goes to the next word; says whether there is one.
    pub fn more(&mut self) -> bool {
        loop {
            let ahead = self.ahead(STEP);
            let step = &ahead[..ahead.len().min(STEP)];
            match step.iter().position(|&b| !is_blank(b)) {
                None if step.is_empty() => return false,
                None => self.at += step.len() as u64,
                Some(k) => {
                    let comment = step[k] == b'#';
                    self.at += k as u64;
                    if !comment {
                        return true;
                    }
                    self.pass_comment();
                }
            }
        }
    }

    /// Passes what is left of the line.
    fn pass_comment(&mut self) {
        loop {
            let ahead = self.ahead(STEP);
            match memchr::memchr(b'\n', ahead) {
                Some(k) => return self.at += k as u64 + 1,
                None if ahead.is_empty() => return,
                None => self.at += ahead.len() as u64,
            }
        }
    }

    /// Passes what is left of a word.
    fn pass_word(&mut self) -> Result<()> {
        let from = self.at;
        loop {
            let ahead = self.ahead(WORD_BYTES);
            let len = ahead.iter().take(WORD_BYTES).take_while(|&&b| is_word(b)).count();
            let whole = len < WORD_BYTES;
            self.at += len as u64;
            if self.at - from >= WORD_BYTES as u64 {
                return Err(text::too_long(self.source, "a word", WORD_BYTES, from));
            }
            if whole {
                return Ok(());
            }
        }
    }

    /// The next word as a whole number.
    pub fn integer(&mut self, what: &str) -> Result<i64> {
        if !self.more() {
            return Err(self.truncated(what));
        }
        let from = self.at;
        self.pass_word()?;
        text::signed(self.source.peek(from..self.at)).ok_or_else(|| self.source.malformed_text(from, what))
    }

    /// A string as COMSOL writes it: its length, a blank, and as many characters, whatever they are.
    pub fn string(&mut self, what: &str) -> Result<String> {
        let from = if self.more() { self.at } else { return Err(self.truncated(what)) };
        let len = self.integer(&format!("the length of {what}"))?;
        let limit = self.line_bytes;
        let Some(len) = usize::try_from(len).ok().filter(|&len| len <= limit) else {
            let error = Error::limit(format!("the length of {what}"), format!("0 to {limit} bytes"));
            return Err(self.source.place(error, Spot::Text(from)));
        };
        // Lengths are of bytes or of characters, which is the same in all but few files: a blank follows the right one.
        let rest = self.ahead(1 + 4 * len + 1).get(1..).unwrap_or_default();
        let ends = |end: usize| rest.get(end).is_none_or(|&b| is_blank(b));
        let starts = |b: &u8| b & 0xc0 != 0x80;
        let characters =
            rest.iter().enumerate().filter(|(_, b)| starts(b)).nth(len).map_or(rest.len(), |c| c.0);
        let found = [len, characters].into_iter().find(|&end| end <= rest.len() && ends(end));
        let Some(end) = found else {
            return Err(self.source.malformed_text(from, format!("{what}, {len} characters")));
        };
        let string = String::from_utf8_lossy(&rest[..end]).into_owned();
        self.at += (1 + end) as u64;
        Ok(string)
    }

    /// Passes `count` rows of `width` words each, and cuts them into pieces: the bytes of each, and its first row.
    pub fn rows(
        &mut self,
        count: u64,
        width: u64,
        what: &str,
        mut piece: impl FnMut(Range<u64>, u64) -> Result<()>,
    ) -> Result<()> {
        let least = count.checked_mul(width).and_then(|words| words.checked_mul(2));
        let Some(words) = least.filter(|&l| l <= self.source.len() - self.at + 1).map(|l| l / 2) else {
            return Err(self.truncated(&format!("{count} {what}")));
        };
        if words == 0 {
            return Ok(());
        }
        self.more();
        let (mut from, mut first, mut passed, mut inside) = (self.at, 0, 0, false);
        while passed < words {
            self.step(words - passed, &mut passed, &mut inside)
                .map_err(|e| e.unwrap_or_else(|| self.missing(count, passed / width.max(1), what)))?;
            let full = self.at - from >= PIECE_BYTES;
            if !full && passed < words {
                continue;
            }
            if inside {
                self.pass_word()?;
            }
            while passed % width != 0 {
                if !self.more() {
                    return Err(self.missing(count, passed / width, what));
                }
                self.pass_word()?;
                passed += 1;
            }
            inside = false;
            piece(from..self.at, first)?;
            (from, first) = (self.at, passed / width);
        }
        Ok(())
    }

    /// Passes some words, at most `most`; the last of them perhaps in part, and then `inside` says so. After all of them
    /// nothing more is passed. The error is nothing where the file ends.
    fn step(
        &mut self,
        most: u64,
        passed: &mut u64,
        inside: &mut bool,
    ) -> std::result::Result<(), Option<Error>> {
        let ahead = self.ahead(STEP);
        let ahead = &ahead[..ahead.len().min(STEP)];
        let step = &ahead[..memchr::memchr(b'#', ahead).unwrap_or(ahead.len())];
        if ahead.is_empty() {
            return Err(None);
        }
        let started = starts(step, *inside);
        if started < most {
            let comment = step.len() < ahead.len();
            *passed += started;
            *inside = !comment && step.last().is_some_and(|&b| !is_blank(b));
            self.at += step.len() as u64;
            if comment {
                self.pass_comment();
            }
            return Ok(());
        }
        if *inside {
            self.pass_word()?;
        }
        for _ in 0..most {
            if !self.more() {
                return Err(None);
            }
            self.pass_word()?;
        }
        *passed += most;
        *inside = false;
        Ok(())
    }

    /// The end of the file, but for blanks and comments.
    pub fn end(&mut self) -> Result<()> {
        if self.more() {
            return Err(self.source.malformed_text(self.at, "the end of the file"));
        }
        Ok(())
    }

    /// The error of a file that ends where `expected` should follow.
    pub fn truncated(&self, expected: &str) -> Error {
        self.source.malformed_text(self.source.len(), expected)
    }

    fn missing(&self, count: u64, found: u64, what: &str) -> Error {
        self.truncated(&format!("{count} {what}, and not only {found}"))
    }
}

/// Number of words that start in `bytes`; `inside`: a word goes on from before.
fn starts(bytes: &[u8], inside: bool) -> u64 {
    let first = u64::from(!inside && bytes.first().is_some_and(|&b| !is_blank(b)));
    let (Some(left), Some(right)) = (bytes.get(..bytes.len().saturating_sub(1)), bytes.get(1..)) else {
        return first;
    };
    // Sums of a byte are what the processor does sixteen at a time.
    let run = |(l, r): (&[u8], &[u8])| -> u64 {
        u64::from(l.iter().zip(r).map(|(l, r)| u8::from(is_blank(*l) & !is_blank(*r))).sum::<u8>())
    };
    first + left.chunks(255).zip(right.chunks(255)).map(run).sum::<u64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::{Limits, Scratch};

    fn input(bytes: &str) -> (tempfile::NamedTempFile, Input) {
        use std::io::Write;
        let mut file = tempfile::NamedTempFile::new().expect("a temporary file");
        file.write_all(bytes.as_bytes()).expect("a temporary file");
        let scratch = Scratch::new(&std::env::temp_dir(), 1 << 20);
        let input = Input::open(file.path(), &Limits::default(), &scratch).expect("readable");
        (file, input)
    }

    #[test]
    fn rows_are_cut_between_rows_wherever_lines_and_comments_stand() {
        let mut text = String::from("# rows\n");
        let mut expected = Vec::new();
        for k in 0..200_000u64 {
            text += &format!("{} {k}", 7 * k);
            text += match k % 5 {
                0 => "\n",
                1 => " ",
                2 => "# a 1 2 3 comment\r\n",
                3 => "\t\n\n",
                _ => " # 4\n",
            };
            expected.extend([7 * k, k]);
        }
        text += "77 end";
        let (_file, input) = input(&text);
        let mut walk = WordWalk::new(&input, 0);
        let (mut found, mut pieces) = (Vec::new(), 0);
        let read = walk.rows(200_000, 2, "rows", |span, first| {
            assert_eq!(first * 2, found.len() as u64);
            let window = input.source.window(span.clone());
            let mut words = Words::new(span.start, &window);
            while words.more() {
                found.push(words.integer("a number")?);
            }
            pieces += 1;
            Ok(())
        });
        read.expect("readable");
        assert_eq!(found, expected);
        assert!(pieces > 2);
        assert_eq!(walk.integer("a number").expect("the next word"), 77);
    }

    #[test]
    fn a_string_holds_what_its_length_says_and_a_comment_comes_after() {
        let (_file, input) = input("8 Ti Bolts # label\r\n8 Solid #1\n5 fünf \n4 fünf\n0  3 abc");
        let mut walk = WordWalk::new(&input, 0);
        for expected in ["Ti Bolts", "Solid #1", "fünf", "fünf", "", "abc"] {
            assert_eq!(walk.string("a name").expect("a string"), expected);
        }
        assert!(walk.string("a name").is_err());
    }

    #[test]
    fn counts_that_the_file_cannot_hold_are_refused_at_once() {
        let (_file, input) = input("1 2 3");
        for (count, width) in [(u64::MAX, 3), (1 << 60, 1), (2, 2), (4, 1)] {
            assert!(WordWalk::new(&input, 0).rows(count, width, "rows", |_, _| Ok(())).is_err());
        }
        assert!(WordWalk::new(&input, 0).rows(3, 1, "rows", |_, _| Ok(())).is_ok());
        assert!(WordWalk::new(&input, 0).rows(0, 9, "rows", |_, _| Ok(())).is_ok());
    }
}
