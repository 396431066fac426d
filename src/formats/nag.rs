//! Meshes as the example programs of the NAG Library's chapter D06 print them when asked to: a title, the numbers of
//! vertices, triangles and perhaps edges on a line of their own, then a row for each of them. Vertices have no numbers of
//! their own; they count from 1.

use std::ops::Range;
use std::sync::{Arc, LazyLock};

use crate::error::{Error, Result};
use crate::formats::text::{self, LineReader};
use crate::formats::words::{WordWalk, Words};
use crate::formats::{ElementLayout, ElementSink, Format, NodeBatch, NodeLayout, Outline, Piece};
use crate::input::{Input, Source, Spot};
use crate::mesh::{ElementType, Shape};

/// The format's row in the table of formats.
pub(super) struct Nag;

static TRIANGLE: LazyLock<Arc<ElementType>> =
    LazyLock::new(|| Arc::new(ElementType::measured("triangle", Shape::Triangle, 1, 3)));
static EDGE: LazyLock<Arc<ElementType>> = LazyLock::new(|| Arc::new(ElementType::counted("edge", "line", 2)));

impl Format for Nag {
    fn name(&self) -> &'static str {
        "nag"
    }

    fn title(&self) -> &'static str {
        "NAG Library D06 listings: the mesh that example programs print"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["r"]
    }

    fn looks_for(&self) -> &'static str {
        "a first line as \"D06ABF Example Program Results\""
    }

    fn detect(&self, head: &[u8]) -> bool {
        let title = text::lines(0, head).find(|line| !line.bytes.trim_ascii().is_empty());
        title.is_some_and(|line| {
            let line = line.bytes[..line.bytes.len().min(256)].to_ascii_lowercase();
            let has = |what: &str| memchr::memmem::find(&line, what.as_bytes()).is_some();
            has("d06") && has("example program")
        })
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        let (counts, body) = counts(input, 0)?.ok_or_else(|| {
            let what = "a line with the numbers of vertices and triangles, and of edges perhaps";
            input.source.malformed_text(input.source.len(), what)
        })?;
        let source = &input.source;
        let mut walk = WordWalk::new(input, body);
        walk.rows(counts.vertices, 2, "vertices", |span, row| {
            let layout = Vertices { source: Arc::clone(source), first: row + 1 };
            out.nodes(Piece { layout: Arc::new(layout), span })
        })?;
        let triangles = Columns { before: 0, after: reference(input, &mut walk)? };
        walk.rows(counts.triangles, triangles.width(3), "triangles", |span, row| {
            out.elements(Rows::piece(source, &TRIANGLE, triangles, row, span))
        })?;
        let edges = Columns { before: 1, after: 1 };
        walk.rows(counts.edges, edges.width(2), "edges", |span, row| {
            out.elements(Rows::piece(source, &EDGE, edges, row, span))
        })?;
        // A number that is cut short is still a number: a line's end must follow the last.
        if source.peek(walk.at()..walk.at() + 1).is_empty() {
            return Err(walk.truncated("the end of the last row's line"));
        }
        let mut lines = LineReader::new(source, &input.limits, walk.at());
        while let Some(line) = lines.next_line()? {
            let mut words = text::tokens(line.at, line.bytes).peekable();
            if words.peek().is_some() && words.all(|word| text::real(word.bytes).is_some()) {
                let error = Error::unsupported("a listing with numbers after its mesh is not read");
                return Err(source.place(error, Spot::Text(line.at)));
            }
        }
        Ok(())
    }
}

struct Counts {
    vertices: u64,
    triangles: u64,
    edges: u64,
}

/// The next line of two or three whole numbers and nothing else, and the byte after it.
fn counts(input: &Input, from: u64) -> Result<Option<(Counts, u64)>> {
    let mut lines = LineReader::new(&input.source, &input.limits, from);
    while let Some(line) = lines.next_line()? {
        if let Some(counts) = Counts::read(line.bytes) {
            return Ok(Some((counts, lines.position())));
        }
    }
    Ok(None)
}

impl Counts {
    fn read(line: &[u8]) -> Option<Self> {
        let numbers: Option<Vec<_>> = text::tokens(0, line).take(4).map(|w| text::integer(w.bytes)).collect();
        match numbers?[..] {
            [vertices, triangles] => Some(Self { vertices, triangles, edges: 0 }),
            [vertices, triangles, edges] => Some(Self { vertices, triangles, edges }),
            _ => None,
        }
    }
}

/// Number of columns after a triangle's vertices: its reference, which some leave out.
fn reference(input: &Input, walk: &mut WordWalk<'_>) -> Result<u64> {
    walk.more();
    let line = LineReader::new(&input.source, &input.limits, walk.at())
        .next_line()?
        .map_or(0, |line| text::tokens(line.at, line.bytes).take(4).count());
    Ok(if line == 3 { 0 } else { 1 })
}

/// Rows `x y`; a span is a range of bytes.
#[derive(Debug)]
struct Vertices {
    source: Arc<Source>,
    /// The number of the first vertex.
    first: u64,
}

impl NodeLayout for Vertices {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let window = self.source.window(span.clone());
        let mut words = Words::new(span.start, &window);
        let mut id = self.first;
        while words.more() {
            out.at = words.spot();
            out.push(id, [words.real("a vertex's x")?, words.real("a vertex's y")?, 0.0])?;
            id += 1;
        }
        Ok(())
    }
}

/// The columns of a row that are not vertices.
#[derive(Debug, Clone, Copy)]
struct Columns {
    before: u64,
    after: u64,
}

impl Columns {
    fn width(self, vertices: u64) -> u64 {
        self.before + vertices + self.after
    }
}

/// Rows of elements of one type; a span is a range of bytes.
#[derive(Debug)]
struct Rows {
    source: Arc<Source>,
    kind: &'static Arc<ElementType>,
    columns: Columns,
    /// The number of the first element.
    first: u64,
}

impl Rows {
    fn piece(
        source: &Arc<Source>,
        kind: &'static Arc<ElementType>,
        columns: Columns,
        row: u64,
        span: Range<u64>,
    ) -> Piece<dyn ElementLayout> {
        let rows = Self { source: Arc::clone(source), kind, columns, first: row + 1 };
        Piece { layout: Arc::new(rows), span }
    }
}

impl ElementLayout for Rows {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        let window = self.source.window(span.clone());
        let mut words = Words::new(span.start, &window);
        let mut ids = [0; 3];
        let ids = &mut ids[..self.kind.nodes];
        let mut label = self.first;
        while words.more() {
            out.at = words.spot();
            (0..self.columns.before).for_each(|_| words.skip());
            for id in ids.iter_mut() {
                *id = words.integer("the number of a vertex")?;
            }
            (0..self.columns.after).for_each(|_| words.skip());
            out.element(label, self.kind, ids)?;
            label += 1;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
