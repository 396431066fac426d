//! How the cells' lists of points are told apart, and what type each cell has.

use crate::error::{Error, Result};
use crate::formats::PIECE_BYTES;
use crate::formats::array::{Array, Reader};
use crate::input::Source;

/// How the cells' lists of points are told apart.
#[derive(Debug)]
pub enum Lists {
    /// By the end of each list; the first list starts at 0.
    Ends(Array),
    /// By a count before each list. Known are the places of some lists: number of the cell, and where its count stands.
    Counted(Vec<(u64, u64)>),
}

/// Types of cells.
#[derive(Debug)]
pub enum Types {
    /// One code a cell.
    Each(Array),
    /// One code for all.
    All(u64),
}

/// Walks through lists with a count before each: gives the places where a piece shall start.
pub fn walk_counted(file: &Source, lists: &Array, cells: u64) -> Result<Vec<(u64, u64)>> {
    let mut reader = Reader::new(lists);
    let (mut at, mut starts) = (0, Vec::new());
    let step = PIECE_BYTES / lists.width();
    for cell in 0..cells {
        if starts.last().is_none_or(|(_, start)| at - start >= step) {
            starts.push((cell, at));
        }
        if at >= lists.len() {
            let error =
                Error::malformed(format!("the list of cell {cell} of {cells}"), "the end of the lists");
            return Err(file.place(error, lists.spot(at)));
        }
        let nodes = reader.get(at..at + 1, lists.len())[0];
        at = list_end(at + 1, nodes, lists.len(), cell).map_err(|e| file.place(e, lists.spot(at)))?;
    }
    if at != lists.len() {
        let error = Error::malformed(
            format!("{} numbers in the lists of {cells} cells", lists.len()),
            format!("{at}"),
        );
        return Err(file.place(error, lists.spot(at)));
    }
    Ok(starts)
}

/// The end of a list of `nodes` points that starts at `start`.
#[inline]
pub(super) fn list_end(start: u64, nodes: u64, len: u64, cell: u64) -> Result<u64> {
    match start.checked_add(nodes) {
        Some(end) if end <= len => Ok(end),
        _ => Err(Error::malformed(
            format!("at most {} points for cell {cell}", len.saturating_sub(start)),
            format!("{}", nodes.cast_signed()),
        )),
    }
}
