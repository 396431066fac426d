//! PLY, the Stanford polygon file: a header that says what rows follow, then the rows, as text or binary.

mod header;
mod row;

use std::ops::Range;
use std::sync::Arc;

use super::{faces, rows};
use crate::error::Result;
use crate::formats::text::{self, LineReader};
use crate::formats::{ElementLayout, ElementSink, Format, NodeBatch, NodeLayout, Outline, Piece};
use crate::input::{Input, Source, Spot};
use header::{Encoding, Header, Table};
use row::{Binary, Text, Walk};

/// The format's row in the table of formats.
pub(in crate::formats) struct Ply;

impl Format for Ply {
    fn name(&self) -> &'static str {
        "ply"
    }

    fn title(&self) -> &'static str {
        "PLY surfaces, text and binary of either byte order"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["ply"]
    }

    fn looks_for(&self) -> &'static str {
        "ply on the first line"
    }

    fn detect(&self, head: &[u8]) -> bool {
        matches!(head, [b'p', b'l', b'y', b'\r' | b'\n', ..])
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        let source = &input.source;
        let header = Header::read(input)?;
        if header.faces().is_none_or(|table| table.count == 0) {
            return Err(faces::none(source, 0));
        }
        let mut at = header.end;
        for table in &header.tables {
            let mut emit = |span: Range<u64>, first: u64| match &*table.name {
                "vertex" => {
                    out.nodes(Piece { layout: Part::new(source, table, header.encoding, first), span })
                }
                "face" => {
                    out.elements(Piece { layout: Part::new(source, table, header.encoding, first), span })
                }
                _ => Ok(()),
            };
            at = match header.encoding {
                Encoding::Text => {
                    let mut lines = LineReader::new(source, &input.limits, at);
                    rows::cut(source, &mut lines, table.count, &table.name, &mut emit)?;
                    lines.position().min(source.len())
                }
                Encoding::Binary(endian) => Walk { source, table, endian }.cut(at, &mut emit)?,
            };
            if table.name == "edge" {
                out.count(faces::line(), table.count)?;
            }
        }
        let rest = source.peek(at..at + 48);
        if !rest.trim_ascii().is_empty() {
            let rows: u64 = header.tables.iter().map(|table| table.count).fold(0, u64::saturating_add);
            let expected = format!("the end of the file after {rows} rows");
            return Err(match header.encoding {
                Encoding::Text => source.malformed_text(at, expected),
                Encoding::Binary(_) => source.malformed_binary(at, expected, "more bytes"),
            });
        }
        Ok(())
    }
}

/// Rows of a table; a span is a range of bytes.
#[derive(Debug)]
struct Part {
    source: Arc<Source>,
    table: Arc<Table>,
    encoding: Encoding,
    /// Number of the first row.
    first: u64,
}

impl Part {
    fn new(source: &Arc<Source>, table: &Arc<Table>, encoding: Encoding, first: u64) -> Arc<Self> {
        Arc::new(Self { source: Arc::clone(source), table: Arc::clone(table), encoding, first })
    }
}

impl NodeLayout for Part {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let window = self.source.window(span.clone());
        let axes = &self.table.axes;
        match self.encoding {
            Encoding::Text => {
                for line in rows::records(span.start, &window) {
                    out.at = Spot::Text(line.at);
                    let mut row = Text(text::tokens(line.at, line.bytes));
                    out.push_next(row.reals(&self.table, axes)?)?;
                }
            }
            Encoding::Binary(endian) => {
                let mut row = Binary { bytes: &window, at: 0, endian };
                while row.at < window.len() {
                    out.at = Spot::Binary(span.start + row.at as u64);
                    out.push_next(row.reals(&self.table, axes)?)?;
                }
            }
        }
        Ok(())
    }
}

impl ElementLayout for Part {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        let window = self.source.window(span.clone());
        let mut ids = Vec::new();
        match self.encoding {
            Encoding::Text => {
                for (line, label) in rows::records(span.start, &window).zip(self.first..) {
                    out.at = Spot::Text(line.at);
                    Text(text::tokens(line.at, line.bytes)).list(&self.table, &mut ids)?;
                    out.element(label, faces::of_corners(ids.len() as u64)?, &ids)?;
                }
            }
            Encoding::Binary(endian) => {
                let mut row = Binary { bytes: &window, at: 0, endian };
                let mut label = self.first;
                while row.at < window.len() {
                    out.at = Spot::Binary(span.start + row.at as u64);
                    row.list(&self.table, label, &mut ids, out)?;
                    label += 1;
                }
            }
        }
        Ok(())
    }
}
