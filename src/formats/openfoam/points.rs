//! The points of a mesh: `((0 0 0) (1 0 0) ...)`, or three scalars of bytes each.

use std::ops::Range;
use std::sync::Arc;

use super::header::{self, Header};
use super::lists::end;
use super::reader::Reader;
use crate::error::{Error, Result, excerpt};
use crate::formats::binary::cut_records;
use crate::formats::{NodeBatch, NodeLayout, Outline, PIECE_BYTES, Piece, text};
use crate::input::{Source, Spot};

/// Says where the points stand.
pub(super) fn outline(source: &Arc<Source>, out: &mut dyn Outline) -> Result<()> {
    let header = header::read(source)?;
    let mut reader = Reader::new(source, header.end);
    let told = if reader.next() == Some(b'(') { None } else { Some(reader.integer("a list of points")?) };
    reader.expect(b'(', "the beginning ( of a list of points")?;
    let begin = reader.at();
    match (header.binary, told) {
        (true, Some(count)) => {
            let width = 3 * header.scalar;
            let end = u64::try_from(count)
                .ok()
                .and_then(|c| c.checked_mul(width))
                .and_then(|b| b.checked_add(begin));
            let Some(end) = end.filter(|end| *end < source.len()) else {
                return Err(source.truncated(format!("{count} points of {width} bytes each")));
            };
            reader.pass(end - begin);
            let layout = Arc::new(Raw { source: Arc::clone(source), begin, header });
            cut_records((end - begin) / width, width, |span| {
                out.nodes(Piece { layout: layout.clone(), span })
            })?;
            reader.expect(b')', "the end ) of the list of points")?;
        }
        _ => {
            let layout = Arc::new(Text { source: Arc::clone(source) });
            let found = cut(&mut reader, |span| out.nodes(Piece { layout: layout.clone(), span }))?;
            if told.is_some_and(|told| u64::try_from(told) != Ok(found)) {
                let expected = format!("{} points", told.unwrap_or_default());
                return Err(source.place(Error::malformed(expected, found.to_string()), Spot::Text(begin)));
            }
        }
    }
    end(&mut reader)
}

/// Cuts the points of a text behind closing brackets, up to the one that ends the list; says how many points there are.
fn cut(reader: &mut Reader<'_>, mut piece: impl FnMut(Range<u64>) -> Result<()>) -> Result<u64> {
    let (mut found, mut from) = (0, reader.at());
    loop {
        let at = reader.at();
        let ahead = reader.ahead(64 << 10);
        if ahead.is_empty() {
            return Err(reader.unlike("the end ) of the list of points"));
        }
        // Brackets come in turns, but for the one that ends the list.
        let (mut open, mut passed) = (false, 0);
        let mut ends = false;
        for k in memchr::memchr2_iter(b'(', b')', ahead) {
            match (ahead[k], open) {
                (b'(', _) => open = true,
                (_, true) => {
                    (open, passed) = (false, k + 1);
                    found += 1;
                    if at + passed as u64 - from >= PIECE_BYTES {
                        piece(from..at + passed as u64)?;
                        from = at + passed as u64;
                    }
                }
                (_, false) => {
                    (ends, passed) = (true, k + 1);
                    break;
                }
            }
        }
        if passed == 0 {
            return Err(reader.unlike("a point (x y z)"));
        }
        let to = at + passed as u64;
        reader.pass(passed as u64);
        if ends {
            if from < to - 1 {
                piece(from..to - 1)?;
            }
            return Ok(found);
        }
    }
}

/// Points as text; a span is a range of bytes.
#[derive(Debug)]
struct Text {
    source: Arc<Source>,
}

impl NodeLayout for Text {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let window = self.source.window(span.clone());
        let mut at = 0;
        let unlike = |at: usize, what: &str| Error::malformed(what, excerpt(&window[at..]));
        loop {
            pass_blanks(&window, &mut at);
            if at == window.len() {
                return Ok(());
            }
            out.at = Spot::Text(span.start + at as u64);
            if window[at] != b'(' {
                return Err(unlike(at, "a point (x y z)"));
            }
            at += 1;
            let mut point = [0.0; 3];
            for value in &mut point {
                pass_blanks(&window, &mut at);
                let rest = &window[at..];
                let len = rest.iter().position(|b| *b <= b' ' || *b == b')').unwrap_or(rest.len());
                *value = text::real(&rest[..len]).ok_or_else(|| unlike(at, "a coordinate"))?;
                at += len;
            }
            pass_blanks(&window, &mut at);
            if window.get(at) != Some(&b')') {
                return Err(unlike(at, "the end ) of a point of three coordinates"));
            }
            at += 1;
            out.push_next(point)?;
        }
    }
}

#[inline]
fn pass_blanks(bytes: &[u8], at: &mut usize) {
    while bytes.get(*at).is_some_and(|b| *b <= b' ') {
        *at += 1;
    }
}

/// Points as bytes; a span is a range of their numbers.
#[derive(Debug)]
struct Raw {
    source: Arc<Source>,
    begin: u64,
    header: Header,
}

impl NodeLayout for Raw {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let Header { endian, scalar, .. } = self.header;
        let place = |point: u64| self.begin + point * 3 * scalar;
        let window = self.source.window(place(span.start)..place(span.end));
        for (bytes, point) in window.chunks_exact(3 * scalar as usize).zip(span) {
            out.at = Spot::Binary(place(point));
            out.push_next([0, 1, 2].map(|axis| match scalar {
                4 => f64::from(endian.f32(&bytes[4 * axis..])),
                _ => endian.f64(&bytes[8 * axis..]),
            }))?;
        }
        Ok(())
    }
}
