//! Cards: fields in columns, or parted by commas.

use std::ops::Range;
use std::sync::Arc;

use super::keyword::Width;
use super::solids;
use crate::error::{Error, Result, excerpt};
use crate::formats::columns::field;
use crate::formats::{ElementLayout, ElementSink, NodeBatch, NodeLayout, text};
use crate::input::{Source, Spot};
use crate::mesh::ElementType;

/// Most fields of a card that are looked at.
pub(super) const MOST_FIELDS: usize = 12;

/// Whether a line is a comment.
#[inline]
pub(super) fn is_comment(line: &[u8]) -> bool {
    line.first() == Some(&b'$')
}

/// A card as a line of numbers; a blank field is 0.
#[inline]
pub(super) fn numbers(line: &[u8], width: usize, what: &str) -> Result<([u64; MOST_FIELDS], usize)> {
    let mut values = [0; MOST_FIELDS];
    let line = line.trim_ascii_end();
    let mut count = 0;
    let mut set = |count: usize, text: &[u8]| {
        if count == MOST_FIELDS {
            let expected = format!("at most {MOST_FIELDS} numbers on a card");
            return Err(Error::malformed(expected, excerpt(line)));
        }
        if !text.is_empty() {
            values[count] = text::integer(text).ok_or_else(|| Error::malformed(what, excerpt(text)))?;
        }
        Ok(())
    };
    if memchr::memchr(b',', line).is_some() {
        for part in line.split(|b| *b == b',') {
            let part = part.trim_ascii();
            if count < MOST_FIELDS || !part.is_empty() {
                set(count, part)?;
                count += 1;
            }
        }
    } else {
        let mut from = 0;
        while from < line.len() {
            set(count, field(line, from, width))?;
            count += 1;
            from += width;
        }
    }
    Ok((values, count.min(MOST_FIELDS)))
}

/// The field `k` of a card, from 0.
fn card_field(line: &[u8], width: usize, k: usize) -> &[u8] {
    match memchr::memchr(b',', line) {
        Some(_) => line.split(|b| *b == b',').nth(k).unwrap_or_default().trim_ascii(),
        None => field(line, k * width, width),
    }
}

/// Decodes `*NODE`: a number, three coordinates, and constraints that no mesh needs.
pub(super) struct NodeCards {
    pub(super) source: Arc<Source>,
    pub(super) width: Width,
}

impl NodeLayout for NodeCards {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let window = self.source.window(span.clone());
        for line in text::lines(span.start, &window) {
            if is_comment(line.bytes) || line.bytes.trim_ascii().is_empty() {
                continue;
            }
            out.at = Spot::Text(line.at);
            let (id, point) = self.node(line.bytes)?;
            out.push(id, point)?;
        }
        Ok(())
    }
}

impl NodeCards {
    #[inline]
    fn node(&self, line: &[u8]) -> Result<(u64, [f64; 3])> {
        let number = |text: &[u8]| {
            text::integer(text)
                .filter(|id| *id > 0)
                .ok_or_else(|| Error::malformed("a node number", excerpt(text)))
        };
        let coordinate = |text: &[u8]| match text {
            b"" => Ok(0.0),
            _ => text::real(text).ok_or_else(|| Error::malformed("a coordinate", excerpt(text))),
        };
        let mut point = [0.0; 3];
        if memchr::memchr(b',', line).is_some() {
            let mut parts = line.split(|b| *b == b',').map(<[u8]>::trim_ascii);
            let id = number(parts.next().unwrap_or_default())?;
            for value in &mut point {
                *value = coordinate(parts.next().unwrap_or_default())?;
            }
            return Ok((id, point));
        }
        let (first, each) = (self.width.number(), self.width.coordinate());
        for (k, value) in point.iter_mut().enumerate() {
            *value = coordinate(field(line, first + each * k, each))?;
        }
        Ok((number(field(line, 0, first))?, point))
    }
}

/// What the cards of a keyword are.
#[derive(Debug, Clone)]
pub(super) enum Cards {
    /// Solids of 4 to 20 nodes, with so many cards more for each.
    Solid { more: usize, lines: usize },
    /// Shells, with so many cards more for each, and one more where a shell has middle nodes and thicknesses.
    Shell { more: usize, thickness: bool },
    /// Thick shells: bricks.
    ThickShell { more: usize },
    /// Elements that are not measured, with so many cards more for each; their nodes are fields of the first.
    Counted { kind: Arc<ElementType>, more: usize, nodes: Range<usize> },
}

impl Cards {
    /// Lines of an element after its first, which is given.
    #[inline]
    pub(super) fn more_lines(&self, first: &[u8], width: Width) -> Result<usize> {
        Ok(match self {
            Cards::Solid { more, lines } if has_two_fields(first, width) => lines + more,
            Cards::Solid { more, .. } | Cards::ThickShell { more } | Cards::Counted { more, .. } => *more,
            Cards::Shell { more, thickness: false } => *more,
            Cards::Shell { more, thickness: true } => {
                let (values, _) = numbers(first, width.number(), "a number")?;
                more + usize::from(values[6..10].iter().any(|id| *id != 0))
            }
        })
    }
}

/// Whether a card has an element and a part only: nodes follow on the next.
#[inline]
pub(super) fn has_two_fields(line: &[u8], width: Width) -> bool {
    let line = line.trim_ascii_end();
    match memchr::memchr(b',', line) {
        Some(_) => line.split(|b| *b == b',').skip(2).all(|part| part.trim_ascii().is_empty()),
        None => line.len() <= 2 * width.number(),
    }
}

/// Decodes elements.
pub(super) struct ElementCards {
    pub(super) source: Arc<Source>,
    pub(super) width: Width,
    pub(super) cards: Cards,
    /// Whether Gmsh wrote the file, which has an order of its own for wedges.
    pub(super) by_gmsh: bool,
}

impl ElementLayout for ElementCards {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        let window = self.source.window(span.clone());
        let mut lines = text::lines(span.start, &window).filter(|line| !is_comment(line.bytes));
        let mut ids = Vec::with_capacity(2 * MOST_FIELDS);
        while let Some(line) = lines.next() {
            if line.bytes.trim_ascii().is_empty() {
                continue;
            }
            out.at = Spot::Text(line.at);
            let width = self.width.number();
            let mut more = self.cards.more_lines(line.bytes, self.width)?;
            ids.clear();
            if let Cards::Counted { kind, nodes, .. } = &self.cards {
                // Other fields may be real numbers.
                ids.extend(nodes.clone().filter_map(|k| text::integer(card_field(line.bytes, width, k))));
                out.element(0, kind, &ids)?;
            } else {
                let (head, count) = numbers(line.bytes, width, "a number")?;
                ids.extend(&head[2..count.max(2)]);
                let node_lines = match &self.cards {
                    Cards::Solid { lines, .. } if has_two_fields(line.bytes, self.width) => *lines,
                    _ => 0,
                };
                for _ in 0..node_lines {
                    let Some(nodes) = lines.next() else { break };
                    out.at = Spot::Text(nodes.at);
                    let (values, count) = numbers(nodes.bytes, width, "a node number")?;
                    ids.extend(&values[..count]);
                    more -= 1;
                }
                out.at = Spot::Text(line.at);
                out.region(head[1], || head[1].to_string())?;
                solids::put(&self.cards, head[0], &mut ids, self.by_gmsh, out)?;
            }
            for _ in 0..more {
                lines.next();
            }
        }
        Ok(())
    }
}
