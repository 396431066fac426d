//! OBJ, Wavefront's object file: statements `v` and `f` in any order. A reference counts from 1, or backwards from the
//! vertices defined so far.

use std::ops::Range;
use std::sync::{Arc, LazyLock};

use super::{faces, rows};
use crate::error::Result;
use crate::formats::text::{self, LineReader, Placed};
use crate::formats::{ElementLayout, ElementSink, Format, HEAD_BYTES, NodeBatch, NodeLayout};
use crate::formats::{Outline, PIECE_BYTES, Piece};
use crate::input::{Input, Source, Spot};
use crate::mesh::ElementType;

/// The format's row in the table of formats.
pub(in crate::formats) struct Obj;

impl Format for Obj {
    fn name(&self) -> &'static str {
        "obj"
    }

    fn title(&self) -> &'static str {
        "Wavefront OBJ surfaces, text"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["obj"]
    }

    fn looks_for(&self) -> &'static str {
        "statements of OBJ, among them v with three coordinates"
    }

    fn detect(&self, head: &[u8]) -> bool {
        let mut found = false;
        let cut = if head.len() < HEAD_BYTES { None } else { memchr::memrchr(b'\n', head) };
        for statement in statements(0, &head[..cut.unwrap_or(head.len())]) {
            match Keyword::of(&statement.text) {
                Some(Keyword::Vertex) => {
                    found |= rows::point(&mut text::tokens(0, &statement.text).skip(1)).is_ok();
                }
                Some(_) => {}
                None => return false,
            }
        }
        found
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        let source = &input.source;
        let mut lines = LineReader::new(source, &input.limits, 0);
        let (mut vertices, mut elements) = (0u64, 0u64);
        let mut piece = Part { source: Arc::clone(source), vertices: 0, elements: 0 };
        let mut from = 0;
        while let Some(keyword) = next_keyword(source, input.limits.line_bytes, &mut lines)? {
            match keyword {
                Keyword::Vertex => vertices += 1,
                Keyword::Face | Keyword::Line | Keyword::Point | Keyword::FreeForm => elements += 1,
                Keyword::Other => {}
            }
            // A face that lost a corner is a face, and OBJ has no end mark.
            if lines.position() > source.len() && keyword != Keyword::Other {
                return Err(source.malformed_text(source.len(), "the end of the line of the last statement"));
            }
            let to = lines.position().min(source.len());
            if to - from >= PIECE_BYTES || to == source.len() {
                let next = Part { source: Arc::clone(source), vertices, elements };
                std::mem::replace(&mut piece, next).hand_out(from..to, vertices, elements, out)?;
                from = to;
            }
        }
        if elements == 0 {
            return Err(faces::none(source, source.len()));
        }
        Ok(())
    }
}

/// What a statement begins with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Keyword {
    Vertex,
    Face,
    Line,
    Point,
    /// A curve or surface that is given by a formula.
    FreeForm,
    /// Nothing that defines vertices or elements; also an empty line and a comment.
    Other,
}

/// Statements that are passed over: textures, normals, groups, materials and what free forms consist of.
#[rustfmt::skip]
const OTHERS: &[&[u8]] = &[
    b"vt", b"vn", b"vp", b"g", b"s", b"o", b"mg", b"usemtl", b"mtllib", b"usemap", b"maplib", b"bevel", b"c_interp",
    b"d_interp", b"lod", b"shadow_obj", b"trace_obj", b"cstype", b"deg", b"bmat", b"step", b"parm", b"trim", b"hole",
    b"scrv", b"sp", b"end", b"con", b"ctech", b"stech", b"call", b"csh",
];

impl Keyword {
    /// The keyword of a statement, or of its first line; `None` where OBJ has no such statement.
    #[inline]
    fn of(statement: &[u8]) -> Option<Self> {
        let statement = statement.trim_ascii_start();
        let len = statement.iter().position(u8::is_ascii_whitespace).unwrap_or(statement.len());
        match &statement[..len] {
            b"v" => Some(Self::Vertex),
            b"f" | b"fo" => Some(Self::Face),
            b"l" => Some(Self::Line),
            b"p" => Some(Self::Point),
            b"curv" | b"curv2" | b"surf" => Some(Self::FreeForm),
            b"" | [b'#', ..] | b"\\" => Some(Self::Other),
            other if OTHERS.contains(&other) => Some(Self::Other),
            _ => None,
        }
    }
}

/// Reads the lines of the next statement and gives its keyword. A statement goes on after a `\` at a line's end.
fn next_keyword(source: &Source, most: usize, lines: &mut LineReader<'_>) -> Result<Option<Keyword>> {
    let start = lines.position();
    let Some(line) = lines.next_line()? else { return Ok(None) };
    let Some(keyword) = Keyword::of(line.bytes) else {
        return Err(source.malformed_text(start, "a statement of OBJ"));
    };
    let mut goes_on = continued(line.bytes).is_some();
    while goes_on {
        if lines.position() - start > most as u64 {
            return Err(text::too_long(source, "a statement", most, start));
        }
        match lines.next_line()? {
            Some(line) => goes_on = line.bytes.ends_with(b"\\"),
            None => return Err(source.malformed_text(source.len(), "the rest of a statement, after \\")),
        }
    }
    Ok(Some(keyword))
}

/// A line that goes on, without its `\`. A comment does not: it may end with the name of a folder.
#[inline]
fn continued(line: &[u8]) -> Option<&[u8]> {
    line.strip_suffix(b"\\").filter(|line| !line.trim_ascii_start().starts_with(b"#"))
}

/// A statement on one line.
struct Statement<'t> {
    at: u64,
    text: std::borrow::Cow<'t, [u8]>,
}

/// The statements of `bytes`, which end with a whole one.
fn statements(at: u64, bytes: &[u8]) -> impl Iterator<Item = Statement<'_>> {
    let mut lines = text::lines(at, bytes);
    std::iter::from_fn(move || {
        let Placed { at, bytes: first } = lines.next()?;
        let Some(start) = continued(first) else {
            return Some(Statement { at, text: first.into() });
        };
        let mut whole = start.to_vec();
        for line in lines.by_ref() {
            let rest = line.bytes.strip_suffix(b"\\");
            whole.push(b' ');
            whole.extend_from_slice(rest.unwrap_or(line.bytes));
            if rest.is_none() {
                break;
            }
        }
        Some(Statement { at, text: whole.into() })
    })
}

/// Statements of a run of bytes, with the numbers of vertices and elements before them.
#[derive(Debug)]
struct Part {
    source: Arc<Source>,
    vertices: u64,
    elements: u64,
}

impl Part {
    /// Hands out the statements of `span`, with the numbers of vertices and elements up to their end.
    fn hand_out(self, span: Range<u64>, vertices: u64, elements: u64, out: &mut dyn Outline) -> Result<()> {
        let (has_vertices, has_elements) = (vertices > self.vertices, elements > self.elements);
        let layout = Arc::new(self);
        if has_vertices {
            out.nodes(Piece { layout: layout.clone(), span: span.clone() })?;
        }
        if has_elements {
            out.elements(Piece { layout, span })?;
        }
        Ok(())
    }
}

impl NodeLayout for Part {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let window = self.source.window(span.clone());
        let mut number = self.vertices;
        for statement in statements(span.start, &window) {
            if Keyword::of(&statement.text) == Some(Keyword::Vertex) {
                out.at = Spot::Text(statement.at);
                number += 1;
                out.push(number, rows::point(&mut text::tokens(0, &statement.text).skip(1))?)?;
            }
        }
        Ok(())
    }
}

static FREE_FORM: LazyLock<ElementType> =
    LazyLock::new(|| ElementType::counted("free form", "free-form curve or surface", 0));

impl ElementLayout for Part {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        let window = self.source.window(span.clone());
        let (mut vertices, mut element) = (self.vertices, self.elements);
        let mut ids = Vec::new();
        for statement in statements(span.start, &window) {
            let Some(keyword) = Keyword::of(&statement.text) else { continue };
            match keyword {
                Keyword::Other => continue,
                Keyword::Vertex => {
                    vertices += 1;
                    continue;
                }
                Keyword::FreeForm => out.count(&FREE_FORM, 1),
                Keyword::Face | Keyword::Line | Keyword::Point => {
                    out.at = Spot::Text(statement.at);
                    references(&statement.text, vertices, &mut ids)?;
                    let kind = match keyword {
                        Keyword::Line => faces::line(),
                        Keyword::Point => faces::point(),
                        _ => faces::of_corners(ids.len() as u64)?,
                    };
                    out.element(element + 1, kind, &ids)?;
                }
            }
            element += 1;
        }
        Ok(())
    }
}

/// The vertices that a statement names: `7`, `7/1`, `7//3`, `7/1/3`, or `-1` for the last one defined.
#[inline]
fn references(statement: &[u8], vertices: u64, ids: &mut Vec<u64>) -> Result<()> {
    ids.clear();
    for word in text::tokens(0, statement).skip(1) {
        if word.bytes.starts_with(b"#") {
            break;
        }
        let end = word.bytes.iter().position(|b| *b == b'/').unwrap_or(word.bytes.len());
        let id = text::signed(&word.bytes[..end]).and_then(|number| match number {
            1.. => Some(number.unsigned_abs()),
            0 => None,
            // The last vertex is -1.
            _ => (vertices + 1).checked_sub(number.unsigned_abs()).filter(|id| *id > 0),
        });
        ids.push(id.ok_or_else(|| rows::wrong("a vertex: from 1, or from -1 backwards", word.bytes))?);
    }
    Ok(())
}
