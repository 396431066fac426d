//! Matrices of a MAT-file as lists of records.

use std::ops::Range;

use crate::formats::array::Array;
use crate::input::Spot;

/// A matrix of real numbers, stored column by column.
#[derive(Debug, Clone)]
pub(super) struct Matrix {
    /// Its name: `p`, `mesh.p`, `groups{2}.Elems`.
    pub(super) path: String,
    pub(super) rows: u64,
    pub(super) columns: u64,
    pub(super) numbers: Array,
}

impl Matrix {
    /// The last part of the name.
    pub(super) fn leaf(&self) -> &str {
        leaf(&self.path)
    }

    /// Name and size.
    pub(super) fn describe(&self) -> String {
        format!("{} ({} x {})", self.path, self.rows, self.columns)
    }
}

/// The last part of a name.
pub(super) fn leaf(path: &str) -> &str {
    let last = path.rsplit('.').next().unwrap_or(path);
    last.split(['{', '(']).next().unwrap_or(last)
}

/// A matrix as a list of records: its columns, or its rows.
#[derive(Debug, Clone)]
pub(super) struct Records {
    pub(super) matrix: Matrix,
    /// Records stand in rows, so that the numbers of one lie far apart.
    pub(super) in_rows: bool,
}

impl Records {
    /// Number of records.
    pub(super) fn count(&self) -> u64 {
        if self.in_rows { self.matrix.rows } else { self.matrix.columns }
    }

    /// Numbers of a record.
    pub(super) fn width(&self) -> usize {
        (if self.in_rows { self.matrix.columns } else { self.matrix.rows }) as usize
    }

    /// Where record `index` starts, if it stands in the mesh file.
    pub(super) fn spot(&self, index: u64) -> Spot {
        self.matrix.numbers.spot(if self.in_rows { index } else { index * self.matrix.rows })
    }

    /// Replaces `out` with the records of `span`, one after another.
    pub(super) fn read(&self, span: Range<u64>, out: &mut Vec<f64>) {
        let (numbers, width) = (&self.matrix.numbers, self.width());
        if !self.in_rows {
            numbers.reals(span.start * width as u64..span.end * width as u64, out);
            return;
        }
        let mut column = Vec::new();
        out.clear();
        out.resize((span.end - span.start) as usize * width, 0.0);
        for k in 0..width {
            let start = k as u64 * self.matrix.rows;
            numbers.reals(start + span.start..start + span.end, &mut column);
            for (record, value) in out.chunks_exact_mut(width).zip(&column) {
                record[k] = *value;
            }
        }
    }
}
