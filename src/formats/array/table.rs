//! Records of equal width whose numbers stand in arrays: side by side, or each component in an array of its own.

use std::ops::Range;

use super::Array;
use crate::input::Spot;

/// Records of equal width.
#[derive(Debug)]
pub enum Table {
    /// Record after record, of so many numbers each.
    Rows(Array, usize),
    /// An array a component.
    Columns(Vec<Array>),
}

impl Table {
    /// One array in which all first components stand first, then all second ones.
    #[cfg(feature = "hdf5")]
    pub fn striped(array: &Array, width: usize) -> Self {
        let count = array.len() / (width as u64).max(1);
        Table::Columns((0..width as u64).map(|k| array.part(k * count..(k + 1) * count)).collect())
    }

    /// Number of records.
    pub fn len(&self) -> u64 {
        match self {
            Table::Rows(array, width) => array.len() / (*width as u64).max(1),
            Table::Columns(arrays) => arrays.iter().map(Array::len).min().unwrap_or(0),
        }
    }

    /// Numbers of a record.
    pub fn width(&self) -> usize {
        match self {
            Table::Rows(_, width) => *width,
            Table::Columns(arrays) => arrays.len(),
        }
    }

    /// Bytes of a record.
    pub fn record_bytes(&self) -> u64 {
        match self {
            Table::Rows(array, width) => array.width() * *width as u64,
            Table::Columns(arrays) => arrays.iter().map(Array::width).sum(),
        }
    }

    /// Where the record `index` starts.
    #[inline]
    pub fn spot(&self, index: u64) -> Spot {
        match self {
            Table::Rows(array, width) => array.spot(index * *width as u64),
            Table::Columns(arrays) => arrays.first().map_or(Spot::Unknown, |array| array.spot(index)),
        }
    }

    /// Replaces `out` with the whole numbers of the records of `span`, record by record.
    pub fn integers(&self, span: Range<u64>, out: &mut Vec<u64>) {
        self.read(span, out, Array::integers);
    }

    /// Replaces `out` with the numbers of the records of `span`, record by record.
    pub fn reals(&self, span: Range<u64>, out: &mut Vec<f64>) {
        self.read(span, out, Array::reals);
    }

    fn read<T: Copy + Default>(
        &self,
        span: Range<u64>,
        out: &mut Vec<T>,
        read: impl Fn(&Array, Range<u64>, &mut Vec<T>),
    ) {
        let arrays = match self {
            Table::Rows(array, width) => {
                return read(array, span.start * *width as u64..span.end * *width as u64, out);
            }
            Table::Columns(arrays) => arrays,
        };
        let mut column = Vec::new();
        out.clear();
        out.resize((span.end - span.start) as usize * arrays.len(), T::default());
        for (k, array) in arrays.iter().enumerate() {
            read(array, span.clone(), &mut column);
            for (record, value) in out.chunks_exact_mut(arrays.len()).zip(&column) {
                record[k] = *value;
            }
        }
    }
}
