//! Structured grids: vertices in rows, columns and layers, and the cells between them. The first axis runs fastest.

use std::ops::Range;
use std::sync::Arc;

use super::Array;
use super::regions::InRegions;
use crate::error::{Error, Result};
use crate::formats::binary::cut_records;
use crate::formats::{ElementLayout, ElementSink, NodeBatch, NodeLayout, Outline, Piece};
use crate::input::{Input, Source, Spot};
use crate::mesh::ElementType;

/// What the cells of a format are called, by their number of dimensions.
#[derive(Debug, Clone)]
pub struct Kinds {
    /// Of one axis.
    pub line: Arc<ElementType>,
    /// Of two.
    pub quadrilateral: Arc<ElementType>,
    /// Of three.
    pub hexahedron: Arc<ElementType>,
}

/// Corners in our order, as steps along the axes: round the lower face, then round the upper one.
const CORNERS: [[u64; 3]; 8] =
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];

/// Number of vertices of a grid with so many along each axis.
pub fn vertices(axes: &[u64]) -> u64 {
    axes.iter().copied().fold(1, u64::saturating_mul)
}

/// Number of cells of a grid with so many vertices along each axis.
pub fn cells(axes: &[u64]) -> u64 {
    axes.iter().fold(1, |cells: u64, count| cells.saturating_mul(count.saturating_sub(1)))
}

/// The cells of a grid; a span is a range of them.
#[derive(Debug)]
pub struct Cells {
    /// The mesh file, for errors.
    pub file: Arc<Source>,
    /// Vertices along each of one to three axes.
    pub axes: Vec<u64>,
    /// The number of the first vertex, and of the first cell.
    pub first: (u64, u64),
    /// Which regions the cells are in.
    pub regions: InRegions,
    /// Marks of each cell, and those that say that it is no cell of this grid.
    pub ghosts: Option<(Array, u64)>,
}

impl Cells {
    /// Hands out the cells, cut into pieces.
    pub fn outline(self, kinds: &Kinds, out: &mut dyn Outline) -> Result<()> {
        let (kind, corners) = match self.axes.len() {
            0 => return Ok(()),
            1 => (&kinds.line, &CORNERS[..2]),
            2 => (&kinds.quadrilateral, &CORNERS[..4]),
            _ => (&kinds.hexahedron, &CORNERS[..]),
        };
        let cells = cells(&self.axes);
        let layout: Arc<dyn ElementLayout> = Arc::new(Block { of: self, kind: Arc::clone(kind), corners });
        let width = 8 * corners.len() as u64;
        cut_records(cells, width, |span| out.elements(Piece { layout: Arc::clone(&layout), span }))
    }
}

/// Cells with their type.
#[derive(Debug)]
struct Block {
    of: Cells,
    kind: Arc<ElementType>,
    corners: &'static [[u64; 3]],
}

impl ElementLayout for Block {
    fn source(&self) -> &Source {
        &self.of.file
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        let count = |axis: usize| self.of.axes.get(axis).copied().unwrap_or(1);
        let (width, height) = (count(0), count(1));
        let (columns, rows) = ((width - 1).max(1), (height - 1).max(1));
        let (first_vertex, first_cell) = self.of.first;
        let regions = self.of.regions.begin(span.clone(), out)?;
        let mut marks = Vec::new();
        let mut hidden = 0;
        if let Some((array, mask)) = &self.of.ghosts {
            array.integers(span.clone(), &mut marks);
            hidden = *mask;
        }
        let mut ids = Vec::with_capacity(8);
        for (k, cell) in span.enumerate() {
            out.ghosts(marks.get(k).is_some_and(|mark| mark & hidden != 0));
            if let Some(region) = regions.get(k) {
                self.of.regions.enter(*region, out)?;
            }
            let at = [cell % columns, cell / columns % rows, cell / columns / rows];
            ids.clear();
            ids.extend(self.corners.iter().map(|step| {
                let [i, j, k] = [0, 1, 2].map(|axis| at[axis] + step[axis]);
                first_vertex + i + width * (j + height * k)
            }));
            out.element(first_cell + cell, &self.kind, &ids)?;
        }
        Ok(())
    }
}

/// Where the vertices of a grid stand that has no list of them.
#[derive(Debug)]
pub enum Places {
    /// At the crossings of planes: their places along x, y and z.
    Axes([Array; 3]),
    /// At equal steps, each a vector, from an origin.
    Steps {
        /// The first vertex.
        origin: [f64; 3],
        /// From one vertex to the next along each axis.
        steps: [[f64; 3]; 3],
    },
}

/// The vertices of such a grid; a span is a range of them.
#[derive(Debug)]
pub struct Vertices {
    /// The mesh file, for errors.
    pub file: Arc<Source>,
    /// How many there are along each axis.
    pub counts: [u64; 3],
    /// Where they stand.
    pub places: Places,
    /// The number of the first; positions count where there is none.
    pub first: Option<u64>,
    /// Where the grid is described.
    pub spot: Spot,
}

impl Vertices {
    /// Hands out the vertices, cut into pieces. A few words may describe a grid without end: it is held to the limit of
    /// what may come out of a byte.
    pub fn outline(self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        /// The ratio is not looked at before so many bytes.
        const FREE: u64 = 64 << 20;
        let count = vertices(&self.counts);
        let bytes = count.saturating_mul(24);
        let ratio = input.limits.unpacked_ratio;
        if bytes > FREE && bytes / ratio > self.file.len() {
            let what = format!("vertices of a grid of {:?}, in bytes for each byte of the file", self.counts);
            return Err(self.file.place(Error::limit(what, ratio), self.spot));
        }
        let layout: Arc<dyn NodeLayout> = Arc::new(self);
        cut_records(count, 24, |span| out.nodes(Piece { layout: Arc::clone(&layout), span }))
    }
}

impl NodeLayout for Vertices {
    fn source(&self) -> &Source {
        &self.file
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let [width, height, _] = self.counts;
        out.at = self.spot;
        let mut push = |vertex: u64, point: [f64; 3]| match self.first {
            Some(first) => out.push(first + vertex, point),
            None => out.push_next(point),
        };
        let place = |vertex: u64| [vertex % width, vertex / width % height, vertex / width / height];
        match &self.places {
            Places::Steps { origin, steps } => {
                for vertex in span {
                    let at = place(vertex).map(|k| k as f64);
                    let along =
                        |axis: usize| origin[axis] + (0..3).map(|k| at[k] * steps[k][axis]).sum::<f64>();
                    push(vertex, [0, 1, 2].map(along))?;
                }
            }
            Places::Axes([x, y, z]) => {
                let (mut xs, mut other) = (Vec::new(), Vec::new());
                let mut one = |array: &Array, k: u64| {
                    array.reals(k..k + 1, &mut other);
                    other.first().copied().unwrap_or_default()
                };
                // Row by row, or what of it is in the span.
                let mut vertex = span.start;
                while vertex < span.end {
                    let [i, j, k] = place(vertex);
                    let run = (width - i).min(span.end - vertex);
                    let (y, z) = (one(y, j), one(z, k));
                    x.reals(i..i + run, &mut xs);
                    for (x, vertex) in xs.iter().zip(vertex..) {
                        push(vertex, [*x, y, z])?;
                    }
                    vertex += run;
                }
            }
        }
        Ok(())
    }
}
