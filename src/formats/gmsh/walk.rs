//! Walks through a file once, in windows, to find where its sections, blocks and rows stand.

use std::ops::Range;
use std::sync::Arc;

use super::rows::Rows;
use crate::error::{Error, Result, excerpt};
use crate::formats::PIECE_BYTES;
use crate::formats::text::{self, Placed};
use crate::input::{Input, Source, Spot, Window};

/// A place in a file, and the bytes that follow it.
#[derive(Debug)]
pub(super) struct Walk<'i> {
    pub(super) source: &'i Arc<Source>,
    line_bytes: usize,
    /// Whether errors name bytes instead of lines.
    pub(super) binary: bool,
    at: u64,
    /// Where the window starts, and the window.
    window: (u64, Window<'i>),
}

impl<'i> Walk<'i> {
    pub(super) fn new(input: &'i Input) -> Self {
        Self {
            source: &input.source,
            line_bytes: input.limits.line_bytes,
            binary: false,
            at: 0,
            window: (0, input.source.window(0..0)),
        }
    }

    /// The byte that comes next.
    pub(super) fn at(&self) -> u64 {
        self.at
    }

    /// Number of bytes that are left.
    fn left(&self) -> u64 {
        self.source.len() - self.at
    }

    /// Goes on after `bytes` bytes, which must be in the file.
    pub(super) fn pass(&mut self, bytes: Option<u64>, what: &str) -> Result<Range<u64>> {
        match bytes {
            Some(bytes) if bytes <= self.left() => {
                let from = self.at;
                self.at += bytes;
                Ok(from..self.at)
            }
            _ => Err(self.source.truncated(what)),
        }
    }

    /// The bytes that follow: a whole line at least, if it is not over the limit, or all up to the file's end.
    fn ahead(&mut self) -> &[u8] {
        const STEP: u64 = 4 << 20;
        let line = self.line_bytes as u64 + 1;
        let (start, window) = &self.window;
        let end = start + window.len() as u64;
        if self.at < *start || (self.at + line > end && end < self.source.len()) || self.at > end {
            self.window = (self.at, self.source.window(self.at..self.at + STEP.max(line)));
        }
        &self.window.1[(self.at - self.window.0) as usize..]
    }

    /// The next `count` bytes.
    pub(super) fn bytes(&mut self, count: usize, what: &str) -> Result<&[u8]> {
        if (self.left() as usize) < count {
            return Err(self.source.truncated(what));
        }
        self.ahead();
        let from = (self.at - self.window.0) as usize;
        self.at += count as u64;
        Ok(&self.window.1[from..from + count])
    }

    /// The next line that is not blank, or `None` at the end of the file.
    pub(super) fn line(&mut self) -> Result<Option<Placed<'_>>> {
        loop {
            let (source, at, limit) = (self.source, self.at, self.line_bytes);
            let ahead = self.ahead();
            if ahead.is_empty() {
                return Ok(None);
            }
            let (len, ends) = text::line_length(source, ahead, limit, at)?;
            let blank = ahead[..len].trim_ascii().is_empty();
            self.at += (len + usize::from(ends)) as u64;
            if !blank {
                let from = (at - self.window.0) as usize;
                return Ok(Some(Placed { at, bytes: self.window.1[from..from + len].trim_ascii_end() }));
            }
        }
    }

    /// The next line that is not blank as one row of numbers.
    pub(super) fn row<T>(&mut self, what: &str, parse: impl FnOnce(&mut Rows<'_>) -> Result<T>) -> Result<T> {
        let Some(line) = self.line()? else { return Err(self.truncated(what)) };
        let at = line.at;
        let mut rows = Rows::new(at, line.bytes);
        let parsed = parse(&mut rows).and_then(|value| rows.end().map(|()| value));
        parsed.map_err(|e| self.place(e, at))
    }

    /// Passes rows of text, one a line: at most `most`, and no more once `bytes` bytes were passed. Says how many.
    pub(super) fn rows(&mut self, most: u64, bytes: u64, what: &str) -> Result<u64> {
        const STEP: usize = 4096;
        let begin = self.at;
        let mut rows = 0;
        while rows < most && self.at - begin < bytes {
            let (source, at, limit) = (self.source, self.at, self.line_bytes);
            let ahead = self.ahead();
            // Every step starts with a line, so a line over the limit is one that has no end near.
            let near = &ahead[..ahead.len().min(STEP).min(limit.saturating_add(1))];
            let end = match memchr::memrchr(b'\n', near) {
                Some(end) => end,
                None => match text::line_length(source, ahead, limit, at)? {
                    (end, true) => end,
                    (_, false) => return Err(self.missing(rows, most, what)),
                },
            };
            let mut step = &ahead[..=end];
            let mut found = memchr::memchr_iter(b'\n', step).count() as u64;
            if found > most - rows {
                found = most - rows;
                let last = memchr::memchr_iter(b'\n', step).nth(found as usize - 1);
                step = &step[..=last.unwrap_or(end)];
            }
            if let Some(mark) = memchr::memchr(b'$', step) {
                let before = memchr::memchr_iter(b'\n', &step[..mark]).count() as u64;
                let at = self.at + mark as u64;
                return Err(
                    self.malformed(at, format!("{what}, {most} in all, and not only {}", rows + before))
                );
            }
            let passed = step.len() as u64;
            self.at += passed;
            rows += found;
        }
        Ok(rows)
    }

    fn missing(&self, rows: u64, most: u64, what: &str) -> Error {
        self.truncated(&format!("{what}, {most} in all, and not only {rows}"))
    }

    /// The name of the next section, `$Name`; `None` at the end of the file.
    pub(super) fn section(&mut self) -> Result<Option<String>> {
        let Some(line) = self.line()? else { return Ok(None) };
        let at = line.at;
        match line.bytes.split_first() {
            Some((b'$', name)) if name.first().is_some_and(u8::is_ascii_alphabetic) => {
                Ok(Some(String::from_utf8_lossy(name).into_owned()))
            }
            _ => Err(self.malformed(at, "a section's name ($Nodes, $Elements, ...)")),
        }
    }

    /// Passes the line that ends a section.
    pub(super) fn end(&mut self, mark: &str) -> Result<()> {
        match self.line()? {
            Some(line) if line.bytes == mark.as_bytes() => Ok(()),
            Some(line) => {
                let at = line.at;
                Err(self.malformed(at, mark))
            }
            None => Err(self.truncated(mark)),
        }
    }

    /// Passes a section whatever it holds, up to the line `mark`.
    pub(super) fn skip_to(&mut self, mark: &str) -> Result<()> {
        let finder = memchr::memmem::Finder::new(mark);
        loop {
            let (at, binary) = (self.at, self.binary);
            let ahead = self.ahead();
            let Some(k) = finder.find(ahead) else {
                let keep = mark.len() as u64;
                if (ahead.len() as u64) <= keep || at + ahead.len() as u64 >= self.source.len() {
                    return Err(self.truncated(mark));
                }
                self.at += self.window.1.len() as u64 - (at - self.window.0) - keep;
                continue;
            };
            let end = at + (k + mark.len()) as u64;
            let after = self.source.peek(end..end + 1).first();
            let before = self.source.peek((at + k as u64).saturating_sub(1)..at + k as u64).first();
            self.at = end;
            if after.is_none_or(u8::is_ascii_whitespace) && (binary || before == Some(&b'\n')) {
                return Ok(());
            }
        }
    }

    /// Checks that the blocks of a section hold as many records as its head says.
    pub(super) fn same_count(&self, said: u64, found: u64, what: &str) -> Result<()> {
        if said == found {
            return Ok(());
        }
        let error = Error::malformed(
            format!("{said} {what}, as the head of the section says"),
            format!("{found} in its blocks"),
        );
        Err(self.place(error, self.at.saturating_sub(1)))
    }

    /// An error about what stands at byte `at`.
    pub(super) fn malformed(&self, at: u64, expected: impl Into<String>) -> Error {
        if self.binary {
            self.source.malformed_binary(at, expected, excerpt(self.source.peek(at..at + 48)))
        } else {
            self.source.malformed_text(at, expected)
        }
    }

    /// The error of a file that ends where `expected` should follow.
    pub(super) fn truncated(&self, expected: &str) -> Error {
        if self.binary {
            self.source.truncated(expected)
        } else {
            self.malformed(self.source.len(), expected)
        }
    }

    /// Adds the place `at` to an error that names none.
    pub(super) fn place(&self, error: Error, at: u64) -> Error {
        self.source.place(error, if self.binary { Spot::Binary(at) } else { Spot::Text(at) })
    }
}

/// Whole blocks that stand one after another, gathered until they make a piece: some meshes have a block an element.
#[derive(Debug)]
pub(super) struct Gathered {
    from: u64,
    to: u64,
}

impl Gathered {
    /// Nothing yet; the first block will start at `at`.
    pub(super) fn new(at: u64) -> Self {
        Self { from: at, to: at }
    }

    /// Adds the block that ends at `to`; gives the piece that is full with it.
    pub(super) fn add(&mut self, to: u64) -> Option<Range<u64>> {
        self.to = to;
        if to - self.from >= PIECE_BYTES { self.take(to) } else { None }
    }

    /// Gives what is left and goes on with a block that will start at `next`.
    pub(super) fn take(&mut self, next: u64) -> Option<Range<u64>> {
        let piece = (self.from < self.to).then_some(self.from..self.to);
        (self.from, self.to) = (next, next);
        piece
    }
}
