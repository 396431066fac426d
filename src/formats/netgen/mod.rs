//! Netgen `.vol`: names of sections, each alone on its line, with rows after most; surface and volume elements come
//! before the points. What follows `endmesh` is the geometry's.
//!
//! Elements have no numbers: theirs is their position in the file, from 1, over the rows of surface and volume
//! elements in file order. Orders may differ from row to row. Edge segments are counted as lines.

mod elements;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use crate::error::Result;
use crate::formats::rows::{pass_lines, pass_node_lines};
use crate::formats::text::{self, LineReader};
use crate::formats::{Format, Outline, Piece};
use crate::input::{Input, Source};
use crate::mesh::{ElementType, Shape};
use elements::{ElementLines, Section};

/// The format's row in the table of formats.
pub(super) struct Netgen;

const COMMENT: u8 = b'#';

static SEGMENT: ElementType = ElementType::counted("edge segment", "line", 2);
static POINT: ElementType = ElementType::counted("point element", "point", 1);

impl Format for Netgen {
    fn name(&self) -> &'static str {
        "netgen"
    }

    fn title(&self) -> &'static str {
        "Netgen .vol, two and three dimensions, first and second order"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["vol"]
    }

    fn looks_for(&self) -> &'static str {
        "mesh3d in the first line that is no comment"
    }

    /// Netgen's own solids stand the other way round, all of one mesh; of pyramids it is not known.
    fn own_orientation(&self) -> &'static [Shape] {
        &[Shape::Pyramid]
    }

    fn detect(&self, head: &[u8]) -> bool {
        let mut lines = text::lines(0, head).map(|line| line.bytes.trim_ascii());
        lines.find(|line| !line.is_empty() && line[0] != COMMENT) == Some(b"mesh3d")
    }

    fn regions(&self) -> Option<&'static str> {
        Some("materials and boundary conditions")
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        let lines = LineReader::new(&input.source, &input.limits, 0);
        let mut reader =
            Reader { source: &input.source, lines, points: None, elements: false, label: 1, free: false };
        while !reader.section(out)? {}
        let missing = |what: &str| Err(input.source.malformed_text(reader.lines.position() - 1, what));
        match (reader.points, reader.elements) {
            (None, _) => missing("a section points before endmesh"),
            (_, false) => missing("a section surfaceelements or volumeelements before endmesh"),
            _ => Ok(()),
        }
    }
}

struct Reader<'i> {
    source: &'i Arc<Source>,
    lines: LineReader<'i>,
    points: Option<u64>,
    elements: bool,
    /// Number of the next element.
    label: u64,
    /// Whether rows may follow that belong to a section which is not read.
    free: bool,
}

impl Reader<'_> {
    /// Reads the next section; true at the end of the mesh.
    fn section(&mut self, out: &mut dyn Outline) -> Result<bool> {
        let Some(line) = self.lines.next_line()? else {
            return Err(self.source.malformed_text(self.source.len(), "endmesh"));
        };
        let at = line.at;
        let name = line.bytes.trim_ascii();
        match name.first() {
            None | Some(&COMMENT) => return Ok(false),
            Some(first) if first.is_ascii_alphabetic() => {}
            Some(_) if self.free => return Ok(false),
            Some(_) => return Err(self.source.malformed_text(at, "the name of a section")),
        }
        self.free = false;
        match name {
            b"endmesh" => return Ok(true),
            b"mesh3d" => {}
            b"surfaceelements" | b"surfaceelementsgi" | b"surfaceelementsuv" => {
                self.elements(Section::Surface, "rows of surface elements", out)?;
            }
            b"volumeelements" => self.elements(Section::Volume, "rows of volume elements", out)?,
            b"points" if self.points.is_some() => {
                return Err(self.source.malformed_text(at, "one section points"));
            }
            b"points" => {
                let count = self.count("the number of points")?;
                self.points = Some(count);
                let rows = (count, "rows of points");
                pass_node_lines(&mut self.lines, self.source, COMMENT, rows, (1, 3), out)?;
            }
            b"edgesegments" | b"edgesegmentsgi" | b"edgesegmentsgi2" | b"edgesegmentsgi3" => {
                self.counted(&SEGMENT, "rows of edge segments", out)?;
            }
            b"pointelements" => self.counted(&POINT, "rows of point elements", out)?,
            _ => self.free = true,
        }
        Ok(false)
    }

    /// The number on the next line that says something.
    fn count(&mut self, what: &str) -> Result<u64> {
        loop {
            let Some(line) = self.lines.next_line()? else {
                return Err(self.source.malformed_text(self.source.len(), what));
            };
            let (at, text) = (line.at, line.bytes.trim_ascii());
            if !text.is_empty() && text[0] != COMMENT {
                return text::integer(text).ok_or_else(|| self.source.malformed_text(at, what));
            }
        }
    }

    fn elements(&mut self, section: Section, what: &str, out: &mut dyn Outline) -> Result<()> {
        let count = self.count("the number of elements")?;
        let (source, label) = (self.source, self.label);
        pass_lines(&mut self.lines, source, COMMENT, (count, what), |first, span| {
            let layout = ElementLines { source: Arc::clone(source), section, first: label + first };
            out.elements(Piece { layout: Arc::new(layout), span })
        })?;
        self.label += count;
        self.elements = true;
        Ok(())
    }

    fn counted(&mut self, kind: &ElementType, what: &str, out: &mut dyn Outline) -> Result<()> {
        let count = self.count("the number of elements")?;
        pass_lines(&mut self.lines, self.source, COMMENT, (count, what), |_, _| Ok(()))?;
        if count > 0 { out.count(kind, count) } else { Ok(()) }
    }
}
