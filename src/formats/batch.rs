//! Takes the nodes of one piece from a layout.

use crate::error::{Error, Result};
use crate::input::Spot;

/// Beyond this volumes, and sums of them, could be infinite.
const LARGEST_COORDINATE: f64 = 1e90;

#[cold]
fn out_of_range(point: [f64; 3]) -> Error {
    let expected = if point.iter().all(|x| x.is_finite()) {
        "coordinates from -1e90 to 1e90"
    } else {
        "finite coordinates"
    };
    Error::malformed(expected, format!("{point:?}"))
}

/// The nodes of one piece, in file order.
#[derive(Debug, Default)]
pub struct NodeBatch {
    /// Where the record stands that is being decoded: set it before each record, and errors will name the place.
    pub at: Spot,
    ids: Vec<u64>,
    rows: Vec<[f64; 3]>,
}

impl NodeBatch {
    /// Adds the node with the number `id`. All nodes of a file have numbers of their own, or none has.
    #[inline]
    pub fn push(&mut self, id: u64, point: [f64; 3]) -> Result<()> {
        self.ids.push(id);
        self.push_next(point)
    }

    /// Adds a node whose number is its position in the file, from 0.
    #[inline]
    pub fn push_next(&mut self, point: [f64; 3]) -> Result<()> {
        // NaN is not under anything.
        let [x, y, z] = point.map(|x| x.abs() <= LARGEST_COORDINATE);
        if !(x & y & z) {
            return Err(out_of_range(point));
        }
        self.rows.push(point);
        Ok(())
    }

    /// Empties the batch; room is kept.
    pub fn clear(&mut self) {
        self.ids.clear();
        self.rows.clear();
        self.at = Spot::Unknown;
    }

    /// The nodes' own numbers; empty where they are their positions.
    pub fn ids(&self) -> &[u64] {
        &self.ids
    }

    /// Coordinates x, y, z.
    pub fn rows(&self) -> &[[f64; 3]] {
        &self.rows
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_that_are_not_finite_or_too_large_are_refused() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1.1e90, -1e308] {
            for axis in 0..3 {
                let mut point = [1e90, -1e90, 0.0];
                point[axis] = bad;
                assert!(NodeBatch::default().push_next(point).is_err());
            }
        }
        assert!(NodeBatch::default().push_next([1e90, -1e90, 5e-324]).is_ok());
    }
}
