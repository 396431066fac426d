//! OFF, Geomview's object file format, in text: counts, then a line a vertex, then a line a face.

use std::ops::Range;
use std::sync::Arc;

use super::{faces, rows};
use crate::error::{Error, Result};
use crate::formats::text::{self, LineReader, Placed};
use crate::formats::{ElementLayout, ElementSink, Format, NodeBatch, NodeLayout, Outline, Piece};
use crate::input::{Input, Source, Spot};

/// The format's row in the table of formats.
pub(in crate::formats) struct Off;

impl Format for Off {
    fn name(&self) -> &'static str {
        "off"
    }

    fn title(&self) -> &'static str {
        "OFF surfaces, text: OFF, COFF, NOFF, STOFF and their combinations"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["off"]
    }

    fn looks_for(&self) -> &'static str {
        "OFF, COFF, NOFF or the like as the first word"
    }

    fn detect(&self, head: &[u8]) -> bool {
        let first = rows::records(0, head).next();
        first.and_then(|line| text::tokens(0, line.bytes).next()).is_some_and(|word| is_keyword(word.bytes))
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        let source = &input.source;
        let mut lines = LineReader::new(source, &input.limits, 0);
        let [vertices, faces] = counts(source, &mut lines)?;
        let layout: Arc<dyn NodeLayout> = Arc::new(Vertices { source: Arc::clone(source) });
        rows::cut(source, &mut lines, vertices, "vertices", |span, _| {
            out.nodes(Piece { layout: Arc::clone(&layout), span })
        })?;
        if faces == 0 {
            return Err(faces::none(source, lines.position().min(source.len())));
        }
        rows::cut(source, &mut lines, faces, "faces", |span, first| {
            out.elements(Piece { layout: Arc::new(Faces { source: Arc::clone(source), first }), span })
        })?;
        while let Some(line) = lines.next_line()? {
            if !rows::record(line.bytes).is_empty() {
                let expected = format!("the end of the file after {vertices} vertices and {faces} faces");
                return Err(source.malformed_text(line.at, expected));
            }
        }
        Ok(())
    }
}

/// Whether a word is the keyword of the format: `[ST][C][N][4][n]OFF`.
fn is_keyword(word: &[u8]) -> bool {
    let Some(mut rest) = word.strip_suffix(b"OFF") else { return false };
    for prefix in [&b"ST"[..], b"C", b"N", b"4", b"n"] {
        rest = rest.strip_prefix(prefix).unwrap_or(rest);
    }
    rest.is_empty()
}

/// Reads the keyword, which may be absent, and the numbers of vertices and faces, which may follow it on its line.
fn counts(source: &Source, lines: &mut LineReader<'_>) -> Result<[u64; 2]> {
    const WHAT: &str = "the numbers of vertices and faces";
    let at = after_keyword(source, rows::next(source, lines, || "OFF".into())?)?;
    lines.seek(at);
    let line = rows::next(source, lines, || WHAT.into())?;
    let mut words = text::tokens(line.at, line.bytes);
    let mut count = || rows::integer(&mut words, WHAT).map_err(|e| source.place(e, Spot::Text(line.at)));
    Ok([count()?, count()?])
}

/// The byte after the keyword that `line` may start with.
fn after_keyword(source: &Source, line: Placed<'_>) -> Result<u64> {
    let mut words = text::tokens(line.at, line.bytes);
    let Some(keyword) = words.next().filter(|word| is_keyword(word.bytes)) else { return Ok(line.at) };
    let refused = |what| Err(source.place(Error::unsupported(what), Spot::Text(line.at)));
    if keyword.bytes.iter().any(|letter| matches!(letter, b'4' | b'n')) {
        let keyword = keyword.bytes.escape_ascii();
        return refused(format!("{keyword}: only vertices of three coordinates are read"));
    }
    if words.next().is_some_and(|word| word.bytes == b"BINARY") {
        return refused("OFF BINARY: only OFF in text is read".into());
    }
    Ok(keyword.at + keyword.bytes.len() as u64)
}

/// Vertices; what follows their coordinates (normals, colours) is passed over. A span is a range of bytes.
#[derive(Debug)]
struct Vertices {
    source: Arc<Source>,
}

impl NodeLayout for Vertices {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let window = self.source.window(span.clone());
        for line in rows::records(span.start, &window) {
            out.at = Spot::Text(line.at);
            out.push_next(rows::point(&mut text::tokens(line.at, line.bytes))?)?;
        }
        Ok(())
    }
}

/// Faces, counted from 0: number of corners, corners, perhaps a colour. A span is a range of bytes.
#[derive(Debug)]
struct Faces {
    source: Arc<Source>,
    /// Number of the first face of the piece.
    first: u64,
}

impl ElementLayout for Faces {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        let window = self.source.window(span.clone());
        let mut ids = Vec::new();
        for (line, label) in rows::records(span.start, &window).zip(self.first..) {
            out.at = Spot::Text(line.at);
            let mut words = text::tokens(line.at, line.bytes);
            let corners = rows::integer(&mut words, "the number of corners")?;
            ids.clear();
            for _ in 0..corners {
                ids.push(rows::integer(&mut words, "a vertex")?);
            }
            out.element(label, faces::of_corners(corners)?, &ids)?;
        }
        Ok(())
    }
}
