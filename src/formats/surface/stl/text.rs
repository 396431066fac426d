//! STL in text: `solid`, `facet normal`, `outer loop`, three times `vertex`, `endloop`, `endfacet`, `endsolid`; perhaps
//! several solids. Normals are not read.

use super::weld::Welder;
use crate::error::{Error, Result};
use crate::formats::surface::rows;
use crate::formats::text::{self, LineReader, Placed};
use crate::input::{Input, Spot};

/// Whether a file begins as STL in text does.
pub(super) fn begins(head: &[u8]) -> bool {
    filled_lines(head).next().is_some_and(|line| starts_with(line.bytes, b"solid"))
}

/// Whether the first bytes of a file are those of STL in text.
pub(super) fn is_text(head: &[u8]) -> bool {
    let second = |line: Placed<'_>| starts_with(line.bytes, b"facet") || starts_with(line.bytes, b"endsolid");
    begins(head) && filled_lines(head).nth(1).is_some_and(second)
}

fn filled_lines(head: &[u8]) -> impl Iterator<Item = Placed<'_>> {
    text::lines(0, head).filter(|line| !line.bytes.trim_ascii().is_empty())
}

/// Whether the first word of a line is `word`, in whatever case.
#[inline]
fn starts_with(line: &[u8], word: &[u8]) -> bool {
    let line = line.trim_ascii_start();
    line.len() >= word.len()
        && line[..word.len()].eq_ignore_ascii_case(word)
        && line.get(word.len()).is_none_or(u8::is_ascii_whitespace)
}

/// Takes in all facets.
pub(super) fn read(input: &Input, welder: &mut Welder) -> Result<()> {
    let mut lines = Lines { input, lines: LineReader::new(&input.source, &input.limits, 0) };
    let mut is_open = false;
    while let Some(line) = lines.next()? {
        if is_open && starts_with(line.bytes, b"facet") {
            let at = line.at;
            let facet = lines.facet()?;
            welder.facet(facet).map_err(|error| input.source.place(error, Spot::Text(at)))?;
        } else if is_open && starts_with(line.bytes, b"endsolid") {
            is_open = false;
        } else if !is_open && starts_with(line.bytes, b"solid") {
            is_open = true;
        } else {
            let expected = if is_open { "facet or endsolid" } else { "solid or the end of the file" };
            return Err(input.source.malformed_text(line.at, expected));
        }
    }
    if is_open {
        return Err(input.source.malformed_text(input.source.len(), "endsolid"));
    }
    Ok(())
}

/// The lines that are not empty.
struct Lines<'i> {
    input: &'i Input,
    lines: LineReader<'i>,
}

impl Lines<'_> {
    fn next(&mut self) -> Result<Option<Placed<'_>>> {
        let mut at = self.lines.position();
        while self.lines.next_line()?.is_some_and(|line| line.bytes.trim_ascii_start().is_empty()) {
            at = self.lines.position();
        }
        self.lines.seek(at);
        self.lines.next_line()
    }

    /// The rest of a facet, after its first line.
    fn facet(&mut self) -> Result<[[f64; 3]; 3]> {
        self.expect(b"outer", |_| Ok(()))?;
        let mut facet = [[0.0; 3]; 3];
        for corner in &mut facet {
            *corner =
                self.expect(b"vertex", |line| rows::point(&mut text::tokens(line.at, line.bytes).skip(1)))?;
        }
        self.expect(b"endloop", |_| Ok(()))?;
        self.expect(b"endfacet", |_| Ok(()))?;
        Ok(facet)
    }

    /// Reads the next line, which must start with `word`.
    fn expect<T>(&mut self, word: &[u8], read: impl FnOnce(Placed<'_>) -> Result<T>) -> Result<T> {
        let source = &self.input.source;
        let malformed = |at| Err(source.malformed_text(at, word.escape_ascii().to_string()));
        match self.next()? {
            Some(line) if starts_with(line.bytes, word) => {
                read(line).map_err(|error: Error| source.place(error, Spot::Text(line.at)))
            }
            Some(line) => malformed(line.at),
            None => malformed(source.len()),
        }
    }
}
