//! Cells from faces. Each face names the cell on either side; sorted by cell in scratch, a cell's faces stand together.

use std::ops::Range;
use std::sync::Arc;

use super::lists::{self, Faces, NO_CELL};
use super::matching::{self, Sides};
use crate::error::{Error, Result};
use crate::formats::binary::cut_records;
use crate::formats::{ElementLayout, ElementSink, Outline, Piece};
use crate::input::{Input, Source, Spot};
use crate::mesh::Column;

/// About as many bytes as a cell of ascii text takes; so many cells make a piece.
const CELL_BYTES: u64 = 128;

/// Says where the cells stand, once they are put together.
pub(super) fn outline(
    input: &Input,
    source: &Arc<Source>,
    [owner, neighbour]: [&Source; 2],
    out: &mut dyn Outline,
) -> Result<()> {
    let faces = lists::faces(input, source)?;
    if faces.count() == 0 {
        return Err(source.malformed_text(source.len(), "one face or more"));
    }
    let owners = lists::cells(input, owner, faces.count())?;
    let neighbours = lists::cells(input, neighbour, faces.count())?;
    let found = owners.rows().len() as u64;
    if found != faces.count() {
        let expected = format!("{} cells, one for each face", faces.count());
        return Err(owner.place(Error::malformed(expected, found.to_string()), Spot::Text(0)));
    }
    let cells = by_cell(input, owner, [owners, neighbours])?;
    let count = cells.starts.rows().len() as u64 - 1;
    let layout = Arc::new(Cells { source: Arc::clone(source), faces, sides: cells });
    cut_records(count, CELL_BYTES, |span| out.elements(Piece { layout: layout.clone(), span }))
}

/// The faces of each cell.
#[derive(Debug)]
struct ByCell {
    /// Where those of each cell begin; one more than there are cells.
    starts: Column<u64>,
    /// A face's number twice, and one more where the cell is its neighbour: the face turns its back on it.
    sides: Column<u32>,
}

/// Sorts the sides of the faces by cell: counts, sums up, and puts each where it belongs.
fn by_cell(input: &Input, owner: &Source, lists: [Column<u32>; 2]) -> Result<ByCell> {
    let named = || lists.iter().flat_map(|list| list.rows()).copied().filter(|cell| *cell != NO_CELL);
    let sides = named().count();
    let cells = named().max().map_or(0, |last| last as usize + 1);
    // A cell has four faces at least; a number that is far too large must not make a table.
    if cells > sides {
        let expected = format!("numbers of cells under {sides}, the number of their faces");
        return Err(owner.place(Error::malformed(expected, (cells - 1).to_string()), Spot::Text(0)));
    }
    let mut starts = Column::<u64>::zeroed(cells + 1, &input.memory, &input.scratch)?;
    let rows = starts.rows_mut();
    named().for_each(|cell| rows[cell as usize] += 1);
    if let Some(cell) = rows[..cells].iter().position(|faces| *faces == 0) {
        let error = Error::malformed(format!("faces of cell {cell}"), "none that names it");
        return Err(owner.place(error, Spot::Text(0)));
    }
    let mut sum = 0;
    for row in rows.iter_mut() {
        sum += std::mem::replace(row, sum);
    }
    let mut sorted = Column::<u32>::zeroed(sides, &input.memory, &input.scratch)?;
    let places = sorted.rows_mut();
    for (list, side) in lists.iter().zip(0..) {
        for (face, cell) in list.rows().iter().enumerate().filter(|(_, cell)| **cell != NO_CELL) {
            let next = &mut rows[*cell as usize];
            places[*next as usize] = (face as u32) << 1 | side;
            *next += 1;
        }
    }
    // Each start has moved on to the next cell's.
    rows.copy_within(..cells, 1);
    rows[0] = 0;
    Ok(ByCell { starts, sides: sorted })
}

/// Cells; a span is a range of their numbers.
#[derive(Debug)]
struct Cells {
    source: Arc<Source>,
    faces: Faces,
    sides: ByCell,
}

impl ElementLayout for Cells {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        let starts = self.sides.starts.rows();
        let mut points = Vec::new();
        for cell in span {
            let (from, to) = (starts[cell as usize] as usize, starts[cell as usize + 1] as usize);
            let sides = &self.sides.sides.rows()[from..to];
            let faces = || sides.iter().map(|side| (self.faces.points(side >> 1), side & 1 == 1));
            match Sides::of(faces()).and_then(|sides| matching::shape(&sides)) {
                Some((kind, corners)) => out.element(cell, kind, &corners[..kind.nodes])?,
                None => {
                    points.clear();
                    points.extend(faces().flat_map(|(points, _)| points).map(|point| u64::from(*point)));
                    out.element(cell, matching::other(sides.len(), &mut points), &points)?;
                }
            }
        }
        Ok(())
    }
}
