//! Goes from keyword to keyword.

use std::ops::Range;
use std::sync::Arc;

use super::elements::{ElementLines, Zone};
use crate::error::{Error, Result};
use crate::formats::rows::{pass_lines, pass_node_lines};
use crate::formats::text::{self, LineReader};
use crate::formats::{Outline, Piece};
use crate::input::{Input, Source, Spot};

pub(super) const COMMENT: u8 = b'%';

/// A line `KEYWORD= value`; the value ends where a comment begins.
fn keyword(line: &[u8]) -> Option<(Vec<u8>, &[u8])> {
    let line = line.split(|b| *b == COMMENT).next()?;
    let equals = memchr::memchr(b'=', line)?;
    let key = line[..equals].trim_ascii().to_ascii_uppercase();
    let named = key.first().is_some_and(u8::is_ascii_alphabetic);
    named.then(|| (key, line[equals + 1..].trim_ascii()))
}

fn is_nothing(line: &[u8]) -> bool {
    matches!(line.trim_ascii_start().first(), None | Some(&COMMENT))
}

/// Whether the first line that says something is one that files begin with.
pub(super) fn is_su2(head: &[u8]) -> bool {
    const FIRST: [&[u8]; 5] = [b"NDIME", b"NZONE", b"IZONE", b"NELEM", b"NPOIN"];
    let first = text::lines(0, head).find(|line| !is_nothing(line.bytes));
    first.and_then(|line| keyword(line.bytes)).is_some_and(|(key, value)| {
        FIRST.contains(&&key[..]) && value.first().is_some_and(u8::is_ascii_digit)
    })
}

pub(super) fn outline(input: &Input, out: &mut dyn Outline) -> Result<()> {
    let mut reader = Reader {
        source: &input.source,
        lines: LineReader::new(&input.source, &input.limits, 0),
        zone: Found::default(),
        zones: 0,
        zones_said: None,
        points: 0,
        label: 1,
        free: false,
    };
    while reader.keyword(out)? {}
    reader.end_zone(out)?;
    match reader.zones_said {
        Some(said) if said != reader.zones => {
            let expected = format!("{said} zones, as NZONE says, and not only {}", reader.zones);
            Err(input.source.malformed_text(input.source.len(), expected))
        }
        _ => Ok(()),
    }
}

/// What was found of a zone so far.
#[derive(Default)]
struct Found {
    begun: bool,
    dimension: Option<usize>,
    points: Option<u64>,
    has_elements: bool,
    markers_said: Option<u64>,
    markers: u64,
    /// The last marker's name.
    tag: Option<Arc<str>>,
    /// Pieces of element rows, with the number of the first and the marker: the zone's points may come later.
    elements: Vec<(u64, Range<u64>, Option<Arc<str>>)>,
}

struct Reader<'i> {
    source: &'i Arc<Source>,
    lines: LineReader<'i>,
    zone: Found,
    /// Zones that have ended.
    zones: u64,
    zones_said: Option<u64>,
    /// Points of the zones that have ended.
    points: u64,
    /// Number of the next element.
    label: u64,
    /// Whether rows may follow that belong to a keyword which is not read.
    free: bool,
}

impl Reader<'_> {
    /// Reads the next keyword and its rows; false at the end of the file.
    fn keyword(&mut self, out: &mut dyn Outline) -> Result<bool> {
        let Some(line) = self.lines.next_line()? else { return Ok(false) };
        let at = line.at;
        let Some((key, value)) = keyword(line.bytes) else {
            if is_nothing(line.bytes) || self.free {
                return Ok(true);
            }
            return Err(self.source.malformed_text(at, "a line KEYWORD= value"));
        };
        let number = value.split(|b| b.is_ascii_whitespace()).next().and_then(text::integer);
        self.free = false;
        let done = match (&key[..], number) {
            (b"NDIME" | b"NPOIN" | b"NELEM" | b"NMARK" | b"MARKER_ELEMS" | b"NZONE" | b"IZONE", None) => {
                Err(self.source.malformed_text(at, "a keyword with a number, 0 or more"))
            }
            (b"NZONE", said) => {
                self.zones_said = said;
                Ok(())
            }
            (b"IZONE", _) if self.zone.begun => self.end_zone(out),
            (b"IZONE", _) => Ok(()),
            (b"NDIME", Some(dimension @ (2 | 3))) => {
                self.zone.dimension = Some(dimension as usize);
                Ok(())
            }
            (b"NDIME", Some(other)) => Err(Error::malformed("NDIME= 2 or 3", other.to_string())),
            (b"NPOIN", Some(count)) => self.points(count, out),
            (b"NELEM", Some(count)) => {
                self.zone.has_elements = true;
                self.elements(count, "rows of NELEM", None)
            }
            (b"NMARK", said) => {
                self.zone.markers_said = said;
                Ok(())
            }
            (b"MARKER_TAG", _) => {
                self.zone.tag = Some(String::from_utf8_lossy(value).into());
                Ok(())
            }
            (b"MARKER_ELEMS", Some(count)) => {
                self.zone.markers += 1;
                self.pass_send_to()?;
                let tag = self.zone.tag.clone();
                self.elements(count, "rows of MARKER_ELEMS", tag)
            }
            _ => {
                self.free = true;
                return Ok(true);
            }
        };
        self.zone.begun |= !matches!(&key[..], b"NZONE" | b"IZONE");
        done.map_err(|e| self.source.place(e, Spot::Text(at)))?;
        Ok(true)
    }

    fn points(&mut self, count: u64, out: &mut dyn Outline) -> Result<()> {
        let Some(dimension) = self.zone.dimension else {
            return Err(Error::malformed("NDIME before NPOIN", "none"));
        };
        if self.zone.points.is_some() {
            return Err(Error::malformed("one NPOIN in a zone", "another"));
        }
        self.zone.points = Some(count);
        let (rows, first) = ((count, "rows of NPOIN"), (self.points, dimension));
        pass_node_lines(&mut self.lines, self.source, COMMENT, rows, first, out)
    }

    fn elements(&mut self, count: u64, what: &str, marker: Option<Arc<str>>) -> Result<()> {
        let (label, pieces) = (self.label, &mut self.zone.elements);
        pass_lines(&mut self.lines, self.source, COMMENT, (count, what), |first, span| {
            pieces.push((label + first, span, marker.clone()));
            Ok(())
        })?;
        self.label += count;
        Ok(())
    }

    /// A marker between partitions says where it sends to before its rows.
    fn pass_send_to(&mut self) -> Result<()> {
        let at = self.lines.position();
        let next = self.lines.next_line()?.and_then(|line| keyword(line.bytes));
        if next.is_none_or(|(key, _)| key != b"SEND_TO") {
            self.lines.seek(at);
        }
        Ok(())
    }

    /// Hands out the elements of a zone, now that its points are known.
    fn end_zone(&mut self, out: &mut dyn Outline) -> Result<()> {
        let zone = std::mem::take(&mut self.zone);
        let at = self.lines.position().min(self.source.len());
        let missing = |what: &str| Err(self.source.malformed_text(at, what));
        let Some(points) = zone.points else { return missing("NPOIN") };
        if !zone.has_elements {
            return missing("NELEM");
        }
        if let Some(said) = zone.markers_said.filter(|said| *said != zone.markers) {
            return missing(&format!("{said} markers, as NMARK says, and not {}", zone.markers));
        }
        let several = self.zones > 0 || self.zones_said.is_some_and(|zones| zones > 1);
        let numbers = Zone { first: self.points, points: several.then_some(points) };
        for (first, span, marker) in zone.elements {
            let source = Arc::clone(self.source);
            let layout = Arc::new(ElementLines { source, first, zone: numbers, marker });
            out.elements(Piece { layout, span })?;
        }
        self.points += points;
        self.zones += 1;
        Ok(())
    }
}
