//! `.meshb`: a chain of keywords, each with the place of the next.

use std::sync::Arc;

use super::keywords::Polytopes;
use super::{COOKIES, Found, keywords};
use crate::error::{Error, Result};
use crate::formats::Outline;
use crate::formats::binary::Endian;
use crate::formats::rows::{ElementRecords, NodeRecords, Words};
use crate::input::{Input, Source, Spot};

const DIMENSION: u32 = 3;
const VERTICES: u32 = 4;
const END: u32 = 54;

/// The byte order of a binary file: it begins with 1, a version, and the keyword of the dimension.
pub(super) fn endian(head: &[u8]) -> Option<Endian> {
    let (endian, _) = COOKIES.into_iter().find(|(_, cookie)| head.starts_with(cookie))?;
    let head = head.get(..12)?;
    ((1..=4).contains(&endian.u32(&head[4..])) && endian.u32(&head[8..]) == DIMENSION).then_some(endian)
}

pub(super) fn outline(input: &Input, endian: Endian, out: &mut dyn Outline) -> Result<()> {
    let version = endian.u32(input.source.peek(4..8));
    let words =
        Words { endian, word: if version > 3 { 8 } else { 4 }, real: if version > 1 { 8 } else { 4 } };
    let mut chain = Chain { source: &input.source, words, position: if version > 2 { 8 } else { 4 }, at: 8 };
    let mut found = Found::new();
    while let Some(link) = chain.next()? {
        let done = match link.code {
            DIMENSION => chain.bytes(link.body, 4).and_then(|b| found.set_dimension(endian.u32(b).into())),
            VERTICES => vertices(&chain, &link, &mut found, out),
            code => elements(&chain, &link, code, &mut found, out),
        };
        done.map_err(|e| input.source.place(e, Spot::Binary(link.at)))?;
    }
    found.check(&input.source, Spot::Binary(input.source.len()))
}

/// A keyword in the file: its own place, and the bytes of what belongs to it.
struct Link {
    code: u32,
    at: u64,
    body: u64,
    end: u64,
}

/// Goes from keyword to keyword.
struct Chain<'i> {
    source: &'i Arc<Source>,
    words: Words,
    /// Bytes of a place in the file.
    position: u64,
    at: u64,
}

impl Chain<'_> {
    /// The next keyword, or nothing at the end.
    fn next(&mut self) -> Result<Option<Link>> {
        let (at, len) = (self.at, self.source.len());
        if at == len + 1 {
            return Ok(None);
        }
        let code = self.words.endian.u32(self.bytes(at, 4)?);
        if code == END {
            return Ok(None);
        }
        let next = self.bytes(at + 4, self.position)?;
        let endian = self.words.endian;
        let next = if self.position == 4 { endian.u32(next).into() } else { endian.u64(next) };
        let body = at + 4 + self.position;
        let end = match next {
            // The last keyword has no next; it should have been End.
            0 => len,
            next if next < body => {
                return Err(self.source.malformed_binary(
                    at + 4,
                    format!("the place of the next keyword, {body} or after"),
                    next.to_string(),
                ));
            }
            next if next > len => {
                return Err(self
                    .source
                    .truncated(format!("the keyword after keyword {code}, at byte {next}")));
            }
            next => next,
        };
        self.at = if next == 0 { len + 1 } else { end };
        Ok(Some(Link { code, at, body, end }))
    }

    /// `count` bytes, or the error of a file that ends before.
    fn bytes(&self, at: u64, count: u64) -> Result<&[u8]> {
        let bytes = self.source.peek(at..at.saturating_add(count));
        if bytes.len() as u64 == count {
            Ok(bytes)
        } else {
            Err(self.source.truncated("a keyword, the last of which is 54 (End)"))
        }
    }

    /// The number of rows of a table, and where they start.
    fn rows(&self, link: &Link) -> Result<(u64, u64)> {
        let word = self.words.word as u64;
        Ok((self.words.integer(self.bytes(link.body, word)?), link.body + word))
    }
}

/// The error of a table whose bytes are not those of its rows.
fn wrong_size(name: &str, rows: u64, width: usize, bytes: u64) -> Error {
    Error::malformed(
        format!("{rows} rows of {name} of {width} bytes each before the next keyword"),
        format!("{bytes} bytes"),
    )
}

fn vertices(chain: &Chain<'_>, link: &Link, found: &mut Found, out: &mut dyn Outline) -> Result<()> {
    let dimension = found.dimension()?;
    let (rows, at) = chain.rows(link)?;
    let Words { word, real, .. } = chain.words;
    let (width, bytes) = (dimension * real + word, link.end.saturating_sub(at));
    if rows.checked_mul(width as u64) != Some(bytes) {
        return Err(wrong_size("Vertices", rows, width, bytes));
    }
    let first = found.add_vertices(rows);
    let source = Arc::clone(chain.source);
    NodeRecords { source, words: chain.words, at, width, dimension, first }.outline(rows, out)
}

fn elements(
    chain: &Chain<'_>,
    link: &Link,
    code: u32,
    found: &mut Found,
    out: &mut dyn Outline,
) -> Result<()> {
    if let Some(name) = keywords::ordered_by(code) {
        found.ordered.push(name.to_owned());
    }
    if let Some(polytopes) = Polytopes::by_code(code) {
        return count(chain, link, polytopes, out);
    }
    let Some(keyword) = keywords::by_code(code) else { return Ok(()) };
    let (rows, at) = chain.rows(link)?;
    let (word, bytes) = (chain.words.word, link.end.saturating_sub(at));
    let nodes = bytes.checked_div(rows).map_or(0, |width| (width / word as u64).saturating_sub(1));
    let kind = keyword.with_nodes(nodes as usize).unwrap_or(keyword.usual());
    let width = (kind.nodes + 1) * word;
    if rows.checked_mul(width as u64) != Some(bytes) {
        return Err(wrong_size(keyword.name, rows, width, bytes));
    }
    let first = found.add_elements(keyword, rows);
    let source = Arc::clone(chain.source);
    ElementRecords { source, words: chain.words, at, width, kind, first }.outline(rows, out)
}

/// Counts the rows of polygons or polyhedra.
fn count(chain: &Chain<'_>, link: &Link, polytopes: &Polytopes, out: &mut dyn Outline) -> Result<()> {
    let (rows, at) = chain.rows(link)?;
    let (width, bytes) = (polytopes.width * chain.words.word, link.end.saturating_sub(at));
    if rows.checked_mul(width as u64) != Some(bytes) {
        return Err(wrong_size(polytopes.name, rows, width, bytes));
    }
    out.count(&polytopes.kind(), rows)
}
