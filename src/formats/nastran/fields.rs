//! The fields of a card: columns of 8 or 16 characters, or what stands between commas, over several lines.

use super::lines::Cards;
use crate::error::{Error, Result, excerpt};
use crate::formats::text;

/// The most data fields that any card is asked for: three lines of eight.
const MOST: usize = 24;
/// Data fields end with this column.
const LAST_COLUMN: usize = 72;

/// The data fields of a card as far as it was read, without blanks around them. Number 0 stands after the card's name.
#[derive(Debug)]
pub(super) struct Fields<'w> {
    cells: [&'w [u8]; MOST],
    len: usize,
    /// The line that was read last.
    line: &'w [u8],
    /// Whether that one was of large fields.
    large: bool,
}

impl<'w> Fields<'w> {
    pub(super) fn new() -> Self {
        Self { cells: [&[]; MOST], len: 0, line: &[], large: false }
    }

    /// Reads a card of which `wanted` fields matter.
    #[inline]
    pub(super) fn read(&mut self, first: &'w [u8], cards: &mut Cards<'w>, wanted: usize) -> Result<()> {
        self.len = 0;
        self.add(first)?;
        while self.len < wanted {
            let Some(line) = cards.continuation() else { break };
            self.follow(line)?;
        }
        Ok(())
    }

    /// Goes on with the next line of a card of any length; whole rows of eight are forgotten. Says where in
    /// [`Fields::cells`] the new ones begin.
    pub(super) fn read_on(&mut self, line: &'w [u8]) -> Result<usize> {
        if self.len.is_multiple_of(8) {
            self.len = 0;
        }
        let from = self.len;
        self.follow(line)?;
        Ok(from)
    }

    fn follow(&mut self, line: &'w [u8]) -> Result<()> {
        if self.large && self.len % 8 == 4 && !line.trim_ascii_start().starts_with(b"*") {
            let expected = "a second line of large fields, which begins with *";
            return Err(Error::malformed(expected, excerpt(line)));
        }
        let (tag, expected) = (tag(line, 0), tag(self.line, LAST_COLUMN));
        if !tag.is_empty() && !expected.is_empty() && tag != expected {
            let text = |tag: &[u8]| format!("\"+{}\"", tag.escape_ascii());
            return Err(Error::malformed(format!("the continuation {}", text(expected)), text(tag)));
        }
        self.add(line)
    }

    fn add(&mut self, line: &'w [u8]) -> Result<()> {
        self.line = line;
        match memchr::memchr3(b',', b'$', b'\t', &line[..line.len().min(80)]) {
            None => self.add_columns(line),
            Some(_) => {
                let line = &line[..memchr::memchr(b'$', line).unwrap_or(line.len())];
                if line[..line.len().min(LAST_COLUMN)].contains(&b',') {
                    return self.add_free(line);
                }
                self.add_tabbed(line);
            }
        }
        Ok(())
    }

    #[inline]
    fn add_columns(&mut self, line: &'w [u8]) {
        self.large = line[..line.len().min(8)].contains(&b'*');
        let width = if self.large { 16 } else { 8 };
        let (mut from, end) = (8, self.len + 64 / width);
        while self.len < end {
            let cell = line.get(from..(from + width).min(line.len())).unwrap_or_default();
            self.push(cell);
            from += width;
        }
    }

    /// Columns where a tab goes on to the next multiple of eight: it always ends a cell of eight.
    #[cold]
    fn add_tabbed(&mut self, line: &'w [u8]) {
        let mut starts = [line.len(); 10];
        let (mut column, mut cell) = (0, 0);
        for (at, byte) in line.iter().enumerate() {
            if column / 8 >= cell && cell < starts.len() {
                starts[cell] = at;
                cell += 1;
            }
            column = if *byte == b'\t' { (column / 8 + 1) * 8 } else { column + 1 };
        }
        self.large = line[..starts[1]].contains(&b'*');
        let step = if self.large { 2 } else { 1 };
        for k in (1..9).step_by(step) {
            self.push(&line[starts[k]..starts[k + step]]);
        }
    }

    fn add_free(&mut self, line: &'w [u8]) -> Result<()> {
        let mut cells = line.split(|b| *b == b',');
        self.large = cells.next().is_some_and(|name| name.contains(&b'*'));
        let end = self.len + if self.large { 4 } else { 8 };
        while self.len < end {
            self.push(cells.next().unwrap_or_default());
        }
        // The field after the data names the continuation.
        match cells.skip(1).find(|cell| !cell.trim_ascii().is_empty()) {
            None => Ok(()),
            Some(cell) => {
                let expected =
                    if self.large { "at most 6 fields in a line" } else { "at most 10 fields in a line" };
                Err(Error::malformed(expected, excerpt(cell.trim_ascii())))
            }
        }
    }

    #[inline]
    fn push(&mut self, cell: &'w [u8]) {
        if let Some(slot) = self.cells.get_mut(self.len) {
            *slot = cell.trim_ascii();
        }
        self.len += 1;
    }

    /// The fields that were read.
    pub(super) fn cells(&self) -> &[&'w [u8]] {
        &self.cells[..self.len.min(MOST)]
    }

    /// A field; blank where the card has fewer.
    #[inline]
    pub(super) fn get(&self, index: usize) -> &'w [u8] {
        if index < self.len.min(MOST) { self.cells[index] } else { &[] }
    }

    /// A number from 1.
    #[inline]
    pub(super) fn positive(&self, index: usize, what: &str) -> Result<u64> {
        match text::integer(self.get(index)) {
            Some(number) if number > 0 => Ok(number),
            _ => Err(self.malformed(index, what)),
        }
    }

    /// A number from 0, or `None` for a blank field.
    #[inline]
    pub(super) fn optional(&self, index: usize, what: &str) -> Result<Option<u64>> {
        let cell = self.get(index);
        if cell.is_empty() {
            return Ok(None);
        }
        text::integer(cell).map(Some).ok_or_else(|| self.malformed(index, what))
    }

    /// Three real numbers; blank ones are 0.
    #[inline]
    pub(super) fn point(&self, first: usize) -> Result<[f64; 3]> {
        let mut point = [0.0; 3];
        for (k, value) in point.iter_mut().enumerate() {
            let cell = self.get(first + k);
            if !cell.is_empty() {
                *value = text::real(cell).ok_or_else(|| self.malformed(first + k, "a real number"))?;
            }
        }
        Ok(point)
    }

    /// The error of a field.
    #[cold]
    pub(super) fn malformed(&self, index: usize, expected: &str) -> Error {
        let cell = self.get(index);
        let found = if cell.is_empty() { "a blank field".to_owned() } else { excerpt(cell) };
        Error::malformed(format!("{expected} in field {}", index + 2), found)
    }
}

/// The name of a continuation, in the columns after `from`; empty where the line has commas or tabs.
fn tag(line: &[u8], from: usize) -> &[u8] {
    let field = line.get(from + 1..line.len().min(from + 8)).unwrap_or_default();
    let plain =
        field.is_empty() || memchr::memchr3(b',', b'$', b'\t', &line[..from + 1 + field.len()]).is_none();
    if plain { field.trim_ascii() } else { &[] }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, wanted: usize) -> Result<Vec<String>> {
        let mut cards = Cards::new(text.as_bytes());
        let (_, first) = cards.next_card().expect("a card");
        let mut fields = Fields::new();
        fields.read(first, &mut cards, wanted)?;
        let text = |cell: &&[u8]| String::from_utf8_lossy(cell).into_owned();
        let mut cells: Vec<_> = fields.cells().iter().map(text).collect();
        while cells.last().is_some_and(String::is_empty) {
            cells.pop();
        }
        Ok(cells)
    }

    #[test]
    fn the_same_card_in_every_notation() {
        let expected = ["1", "2", "11", "12", "13", "14", "15", "16", "17", "18"];
        for text in [
            "CHEXA   1       2       11      12      13      14      15      16      +A\n+A      17      18",
            "CHEXA   1       2       11      12      13      14      15      16\n        17      18",
            "CHEXA          1       2      11      12      13      14      15      16+A\n$ note\n\n+A            17      18 $",
            "CHEXA\t1\t2\t11\t12\t13\t14\t15\t16\t+\n+\t17\t18",
            "CHEXA,1,2,11,12,13,14,15,16,+\n+,17,18",
            "chexa , 1, 2,11,12,13,14,15,16 $ note, more\n, 17, 18",
            "CHEXA,1,2,11,12,13,14,15,16\n        17      18",
            "CHEXA*                 1               2              11              12*\n*                     13              14              15              16*\n*                     17              18",
            "CHEXA*  1               2               11              12              *A\n*A      13              14              15              16\n        17      18",
            "CHEXA*\t1\t\t2\t\t11\t\t12\n*\t13\t\t14\t\t15\t\t16\n*\t17\t\t18",
            "CHEXA*,1,2,11,12,*\n*,13,14,15,16\n*,17,18",
        ] {
            assert_eq!(read(text, 10).expect(text), expected, "{text}");
        }
    }

    #[test]
    fn numbers_that_touch_and_columns_after_the_data() {
        let text =
            "GRID     2154           -.375018-.07100212.025                           comment, and more";
        assert_eq!(read(text, 5).expect("fields"), ["2154", "", "-.375018", "-.071002", "12.025"]);
    }

    #[test]
    fn what_would_lose_nodes_is_refused() {
        let rows = [
            ("CHEXA,1,2,3,4,5,6,7,8,9,10\n", "at most 10 fields in a line"),
            ("GRID*,1,,1.,2.,*,3.\n", "at most 6 fields in a line"),
            (
                "GRID*   1                               1.              2.\n+       3.\n",
                "a second line of large fields",
            ),
            (
                "CHEXA   1       2       11      12      13      14      15      16      +A\n+B      17      18",
                "the continuation \"+A\", found \"+B\"",
            ),
        ];
        for (text, expected) in rows {
            let error = read(text, 10).expect_err(text).to_string();
            assert!(error.contains(expected), "{error}");
        }
    }
}
