//! The cells of a structured zone: hexahedra or quadrilaterals between vertices in rows and columns.

use std::ops::Range;
use std::sync::{Arc, LazyLock};

use crate::error::Result;
use crate::formats::binary::cut_records;
use crate::formats::{ElementLayout, ElementSink, Outline, Piece};
use crate::input::Source;
use crate::mesh::{ElementType, Shape};

static HEXAHEDRON: LazyLock<Arc<ElementType>> =
    LazyLock::new(|| Arc::new(ElementType::measured("structured HEXA_8", Shape::Hexahedron, 1, 8)));
static QUADRILATERAL: LazyLock<Arc<ElementType>> =
    LazyLock::new(|| Arc::new(ElementType::measured("structured QUAD_4", Shape::Quadrilateral, 1, 4)));
static LINE: LazyLock<Arc<ElementType>> =
    LazyLock::new(|| Arc::new(ElementType::counted("structured BAR_2", "line", 2)));

/// The cells of a block of vertices; a span is a range of cells, the first index fastest. They have their positions for
/// numbers, from 1.
#[derive(Debug)]
pub(super) struct Block {
    file: Arc<Source>,
    /// Vertices along each axis; 1 along those that the block lacks.
    vertices: [u64; 3],
    /// The number of the first vertex.
    first: u64,
    kind: &'static Arc<ElementType>,
    /// The corners of a cell, as steps along the axes.
    corners: &'static [[u64; 3]],
}

/// Corners in our order: round the lower face, then round the upper one.
const CORNERS: [[u64; 3]; 8] =
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];

impl Block {
    /// Hands out the cells between so many vertices along each axis, cut into pieces.
    pub(super) fn outline(file: Arc<Source>, axes: &[u64], first: u64, out: &mut dyn Outline) -> Result<()> {
        let mut vertices = [1; 3];
        vertices.iter_mut().zip(axes).for_each(|(vertices, count)| *vertices = *count);
        let (kind, corners): (&'static Arc<ElementType>, _) = match axes.len() {
            3 => (&HEXAHEDRON, &CORNERS[..]),
            2 => (&QUADRILATERAL, &CORNERS[..4]),
            _ => (&LINE, &CORNERS[..2]),
        };
        let cells = axes.iter().fold(1, |cells: u64, count| cells.saturating_mul(count.saturating_sub(1)));
        let layout: Arc<dyn ElementLayout> = Arc::new(Self { file, vertices, first, kind, corners });
        let width = 8 * corners.len() as u64;
        cut_records(cells, width, |span| out.elements(Piece { layout: Arc::clone(&layout), span }))
    }
}

impl ElementLayout for Block {
    fn source(&self) -> &Source {
        &self.file
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        let [columns, rows, _] = self.vertices.map(|count| (count - 1).max(1));
        let [width, height, _] = self.vertices;
        let mut ids = Vec::new();
        for cell in span {
            let at = [cell % columns, cell / columns % rows, cell / columns / rows];
            ids.clear();
            ids.extend(self.corners.iter().map(|step| {
                let [i, j, k] = [0, 1, 2].map(|axis| at[axis] + step[axis]);
                self.first + i + width * (j + height * k)
            }));
            out.element(cell + 1, self.kind, &ids)?;
        }
        Ok(())
    }
}
