//! Rows of elements: the type's number, the points, and perhaps the element's own number.

use std::ops::Range;
use std::sync::{Arc, LazyLock};

use super::keywords::COMMENT;
use crate::error::{Error, Result};
use crate::formats::rows::Numbers;
use crate::formats::{ElementLayout, ElementSink, text};
use crate::input::Source;
use crate::mesh::ElementType;
use crate::mesh::Shape::{self, Hexahedron, Pyramid, Quadrilateral, Tetrahedron, Triangle, Wedge};

/// Most numbers that a row may have.
const LONGEST: usize = 40;

/// How a zone's points are numbered within the file.
#[derive(Debug, Clone, Copy)]
pub(super) struct Zone {
    /// Number of the first.
    pub(super) first: u64,
    /// How many there are, where a number beyond would be another zone's point.
    pub(super) points: Option<u64>,
}

/// Rows of elements; a span is a range of bytes.
#[derive(Debug)]
pub(super) struct ElementLines {
    pub(super) source: Arc<Source>,
    /// Number of the first element.
    pub(super) first: u64,
    pub(super) zone: Zone,
    /// The marker that the elements are of.
    pub(super) marker: Option<Arc<str>>,
}

impl ElementLayout for ElementLines {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        if let Some(marker) = &self.marker {
            out.region(0, || marker.to_string())?;
        }
        let window = self.source.window(span.clone());
        let mut label = self.first;
        let mut row = [0; LONGEST];
        let mut last: Option<(u64, usize, &'static Arc<ElementType>)> = None;
        for line in text::lines(span.start, &window) {
            let mut numbers = Numbers::new(line.at, line.bytes, COMMENT);
            if !numbers.more() {
                continue;
            }
            out.at = numbers.spot();
            let code = numbers.integer("the number of an element type")?;
            let mut len = 0;
            while numbers.more() {
                let Some(place) = row.get_mut(len) else {
                    return Err(numbers.unlike_here(&format!("at most {LONGEST} numbers in a row")));
                };
                *place = numbers.integer("the number of a point")?;
                len += 1;
            }
            let kind = match last {
                Some((known, long, kind)) if (known, long) == (code, len) => kind,
                _ => find(code, len)?,
            };
            last = Some((code, len, kind));
            let ids = &mut row[..kind.nodes];
            self.zone.renumber(ids)?;
            out.element(label, kind, ids)?;
            label += 1;
        }
        Ok(())
    }
}

impl Zone {
    #[inline]
    fn renumber(self, ids: &mut [u64]) -> Result<()> {
        let Some(points) = self.points else { return Ok(()) };
        for id in ids {
            if *id >= points {
                let expected = format!("the number of a point, under {points} in this zone");
                return Err(Error::malformed(expected, id.to_string()));
            }
            *id += self.first;
        }
        Ok(())
    }
}

/// The type with the number `code` in a row of `len` more numbers: its points, and perhaps its own number.
fn find(code: u64, len: usize) -> Result<&'static Arc<ElementType>> {
    let mut known = TYPES.iter().filter(|kind| kind.0 == code).map(|kind| &kind.1);
    // Points between partitions have more numbers after them.
    let fits = |kind: &&Arc<ElementType>| len == kind.nodes || len == kind.nodes + 1 || code == 1 && len > 0;
    if let Some(kind) = known.clone().find(fits) {
        return Ok(kind);
    }
    Err(match known.next() {
        Some(kind) => Error::malformed(format!("{} points of a {}", kind.nodes, kind.name), len.to_string()),
        None => Error::malformed(
            "the number of an element type (1, 3, 5, 9, 10, 12, 13, 14, ...)",
            code.to_string(),
        ),
    })
}

static TYPES: LazyLock<Vec<(u64, Arc<ElementType>)>> = LazyLock::new(|| {
    let kind = |&(code, name, nodes, order, shape): &Row| {
        let kind = match shape {
            Some(shape) => ElementType::measured(name, shape, order, nodes),
            None => ElementType::counted(name, if nodes == 1 { "point" } else { "line" }, nodes),
        };
        (code, Arc::new(kind))
    };
    ROWS.iter().map(kind).collect()
});

type Row = (u64, &'static str, usize, u8, Option<Shape>);

/// The numbers are VTK's: number, name, points, order, shape. Those of second order are Gmsh's addition, as is its
/// pyramid of 13 points under the number of the linear one.
#[rustfmt::skip]
static ROWS: &[Row] = &[
    (1, "VTK_VERTEX", 1, 1, None),
    (3, "VTK_LINE", 2, 1, None),
    (5, "VTK_TRIANGLE", 3, 1, Some(Triangle)),
    (9, "VTK_QUAD", 4, 1, Some(Quadrilateral)),
    (10, "VTK_TETRA", 4, 1, Some(Tetrahedron)),
    (12, "VTK_HEXAHEDRON", 8, 1, Some(Hexahedron)),
    (13, "VTK_WEDGE", 6, 1, Some(Wedge)),
    (14, "VTK_PYRAMID", 5, 1, Some(Pyramid)),
    (14, "VTK_PYRAMID", 13, 2, Some(Pyramid)),
    (21, "VTK_QUADRATIC_EDGE", 3, 2, None),
    (22, "VTK_QUADRATIC_TRIANGLE", 6, 2, Some(Triangle)),
    (23, "VTK_QUADRATIC_QUAD", 8, 2, Some(Quadrilateral)),
    (24, "VTK_QUADRATIC_TETRA", 10, 2, Some(Tetrahedron)),
    (25, "VTK_QUADRATIC_HEXAHEDRON", 20, 2, Some(Hexahedron)),
    (26, "VTK_QUADRATIC_WEDGE", 15, 2, Some(Wedge)),
    (27, "VTK_QUADRATIC_PYRAMID", 13, 2, Some(Pyramid)),
    (28, "VTK_BIQUADRATIC_QUAD", 9, 2, Some(Quadrilateral)),
    (29, "VTK_TRIQUADRATIC_HEXAHEDRON", 27, 2, Some(Hexahedron)),
    (32, "VTK_BIQUADRATIC_QUADRATIC_WEDGE", 18, 2, Some(Wedge)),
];
