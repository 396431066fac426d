//! AFLR UGRID: seven counts, then tables of points, triangles, quadrilaterals, their surface numbers, tetrahedra, pyramids,
//! wedges and hexahedra. Text, or one of several binary variants that the file's name tells (`wing.lb8.ugrid`), and its
//! size as surely: each table's length follows from the counts.
//!
//! Elements have no numbers: theirs is their position in the file, from 1, over all tables in file order.

mod binary;
#[cfg(test)]
mod tests;

use std::sync::{Arc, LazyLock};

use crate::error::Result;
use crate::formats::rows::{Numbers, Table, TokenReader, outline_elements, outline_nodes};
use crate::formats::{Format, HEAD_BYTES, Outline, text};
use crate::input::Input;
use crate::mesh::ElementType;
use crate::mesh::Shape::{Hexahedron, Pyramid, Quadrilateral, Tetrahedron, Triangle, Wedge};

/// The format's row in the table of formats.
pub(super) struct Ugrid;

/// The counts that a file begins with: of points, and of elements by type.
#[derive(Debug, Clone, Copy)]
struct Counts {
    points: u64,
    elements: [u64; 6],
}

/// Number of the types that lie in surfaces and have a table of surface numbers.
const SURFACES: usize = 2;

/// The types in file order. The base of a pyramid goes round by its first, fourth, fifth and second node, and the
/// third is the apex.
static KINDS: LazyLock<[Arc<ElementType>; 6]> = LazyLock::new(|| {
    [
        ElementType::measured("triangle", Triangle, 1, 3),
        ElementType::measured("quadrilateral", Quadrilateral, 1, 4),
        ElementType::measured("tetrahedron", Tetrahedron, 1, 4),
        ElementType::permuted("pyramid", Pyramid, 1, 5, &[1, 0, 3, 4, 2]),
        ElementType::measured("prism", Wedge, 1, 6),
        ElementType::measured("hexahedron", Hexahedron, 1, 8),
    ]
    .map(Arc::new)
});

impl Counts {
    /// Whether a mesh may have such counts: told from any other numbers by their proportions.
    fn is_likely(&self) -> bool {
        let elements = self.elements.iter().fold(0u64, |sum, count| sum.saturating_add(*count));
        self.points >= 3 && elements > 0 && elements / 100 <= self.points && self.points / 100 <= elements
    }
}

impl Format for Ugrid {
    fn name(&self) -> &'static str {
        "ugrid"
    }

    fn title(&self) -> &'static str {
        "AFLR UGRID, text and binary (b8, b4, lb8, lb4, b8l, lb8l, r8, r4, lr8, lr4)"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["ugrid"]
    }

    fn looks_for(&self) -> &'static str {
        "seven counts, then coordinates, in a file of the size that they say"
    }

    fn detect(&self, head: &[u8]) -> bool {
        is_text(head) || binary::is_likely(head, head.len() < HEAD_BYTES)
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        if is_text(input.source.peek(0..HEAD_BYTES as u64)) {
            return outline_text(input, out);
        }
        binary::outline(input, out)
    }
}

/// Whether the first line is seven counts, and the second one point.
fn is_text(head: &[u8]) -> bool {
    let mut lines = text::lines(0, head).map(|line| Numbers::new(0, line.bytes, 0));
    let (Some(mut counts), Some(mut point)) = (lines.next(), lines.next()) else { return false };
    let counts = read_counts(|| counts.integer("")).ok().filter(|_| !counts.more());
    let is_point = (0..3).all(|_| point.real("").is_ok()) && !point.more();
    is_point && counts.is_some_and(|counts| counts.is_likely())
}

fn read_counts(mut next: impl FnMut() -> Result<u64>) -> Result<Counts> {
    let points = next()?;
    let mut elements = [0; 6];
    for count in &mut elements {
        *count = next()?;
    }
    Ok(Counts { points, elements })
}

fn outline_text(input: &Input, out: &mut dyn Outline) -> Result<()> {
    // No byte begins a comment: 0 is none that text has.
    let mut reader = TokenReader::new(input, 0);
    let counts = read_counts(|| reader.integer("one of seven counts"))?;
    let rows = counts.points;
    outline_nodes(&mut reader, Table { what: "rows of points", rows, extra: 0, first: 1 }, 3, out)?;
    let mut first = 1;
    for (k, (kind, rows)) in KINDS.iter().zip(counts.elements).enumerate() {
        if k == SURFACES {
            let mut numbers = counts.elements[..SURFACES].iter().fold(0u64, |sum, n| sum.saturating_add(*n));
            while numbers > 0 {
                numbers -= reader.pass_rows(numbers, 1, "surface numbers")?;
            }
        }
        let what = format!("rows of type {}", kind.name);
        outline_elements(&mut reader, Table { what: &what, rows, extra: 0, first }, kind, out)?;
        first = first.saturating_add(rows);
    }
    // A number that is cut short is still a number: something must follow the last.
    let len = input.source.len();
    if input.source.peek(len - 1..len).iter().any(u8::is_ascii_digit) {
        return Err(input.source.malformed_text(len, "the end of the last row's line"));
    }
    if reader.more() {
        return Err(input
            .source
            .malformed_text(reader.position(), "the end of the file after the last element"));
    }
    Ok(())
}
