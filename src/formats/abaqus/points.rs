//! Data lines of points: those of `*SYSTEM` and `*INSTANCE`.

use std::ops::Range;

use super::fields::Fields;
use super::placement::Affine;
use crate::error::Result;
use crate::input::{Source, Spot};

/// A line of up to seven numbers.
#[derive(Default)]
pub(super) struct Row {
    values: [f64; 7],
    read: usize,
}

impl Row {
    /// Three numbers from `first` on, if that many were read.
    pub(super) fn point(&self, first: usize) -> Option<[f64; 3]> {
        (self.read > first).then(|| [0, 1, 2].map(|k| self.values[first + k]))
    }

    /// The seventh number: an angle.
    pub(super) fn angle(&self) -> f64 {
        self.values[6]
    }
}

/// Adds the data lines of `range` to `rows`.
pub(super) fn points(source: &Source, range: Range<u64>, rows: &mut Vec<Row>) -> Result<()> {
    let mut fields = Fields::new(source.peek(range.clone()));
    let done = add_points(&mut fields, rows);
    done.map_err(|e| source.place(e, Spot::Text(range.start + fields.at as u64)))
}

fn add_points(fields: &mut Fields<'_>, rows: &mut Vec<Row>) -> Result<()> {
    while fields.next_line()? {
        let mut row = Row::default();
        let mut comma = true;
        while comma && !fields.ends_line() {
            if row.read == row.values.len() || rows.len() == 2 {
                return Err(fields.malformed("at most two lines of up to seven numbers"));
            }
            row.values[row.read] = fields.real()?;
            row.read += 1;
            comma = fields.comma()?;
        }
        rows.push(row);
    }
    Ok(())
}

/// The frame of `*SYSTEM`.
pub(super) fn frame(rows: &[Row]) -> Option<Affine> {
    match rows {
        [] => Some(Affine::IDENTITY),
        [first, rest @ ..] if first.read <= 6 => {
            Affine::frame(first.point(0)?, first.point(3), rest.first().and_then(|row| row.point(0)))
        }
        _ => None,
    }
}

/// The motion of `*INSTANCE`: the first line shifts, the second turns.
pub(super) fn motion(rows: &[Row]) -> Option<Affine> {
    match rows {
        [] => Some(Affine::IDENTITY),
        [first, rest @ ..] if first.read <= 3 => {
            let turn = rest.first().map(|row| Some((row.point(0)?, row.point(3)?, row.values[6])));
            let turn = match turn {
                Some(turn) => Some(turn?),
                None => None,
            };
            Affine::motion(first.point(0)?, turn)
        }
        _ => None,
    }
}
