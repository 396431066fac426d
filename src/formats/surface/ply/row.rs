//! Reading rows: the columns that matter, going over the others.

use std::ops::Range;

use super::header::{Column, Number, Table};
use crate::error::{Error, Result};
use crate::formats::binary::{Endian, cut_records};
use crate::formats::surface::{faces, rows};
use crate::formats::text::Placed;
use crate::formats::{ElementSink, PIECE_BYTES};
use crate::input::{Source, Window};

/// A row of text.
pub(super) struct Text<I>(pub(super) I);

impl<'w, I: Iterator<Item = Placed<'w>>> Text<I> {
    /// The values of three columns.
    pub(super) fn reals(&mut self, table: &Table, axes: &[usize; 3]) -> Result<[f64; 3]> {
        let mut point = [0.0; 3];
        for (k, column) in table.columns.iter().enumerate() {
            match axes.iter().position(|axis| *axis == k) {
                Some(axis) => point[axis] = rows::real(&mut self.0, "a coordinate")?,
                None => self.skip(column)?,
            }
        }
        Ok(point)
    }

    /// The list that is a face.
    pub(super) fn list(&mut self, table: &Table, ids: &mut Vec<u64>) -> Result<()> {
        ids.clear();
        for (k, column) in table.columns.iter().enumerate() {
            if k != table.corners {
                self.skip(column)?;
                continue;
            }
            for _ in 0..rows::integer(&mut self.0, "the number of corners")? {
                ids.push(rows::integer(&mut self.0, "a vertex")?);
            }
        }
        Ok(())
    }

    fn skip(&mut self, column: &Column) -> Result<()> {
        let count = match column.length {
            Some(_) => rows::integer(&mut self.0, "the length of a list")?,
            None => 1,
        };
        for _ in 0..count {
            rows::real(&mut self.0, "the value of a property")?;
        }
        Ok(())
    }
}

/// Binary rows, all of whose bytes are there.
pub(super) struct Binary<'b> {
    pub(super) bytes: &'b [u8],
    pub(super) at: usize,
    pub(super) endian: Endian,
}

/// Most corners that are held at once.
const BATCH: u64 = 64 << 10;

impl Binary<'_> {
    /// The values of three columns.
    #[inline]
    pub(super) fn reals(&mut self, table: &Table, axes: &[usize; 3]) -> Result<[f64; 3]> {
        let mut point = [0.0; 3];
        for (k, column) in table.columns.iter().enumerate() {
            match axes.iter().position(|axis| *axis == k) {
                Some(axis) => point[axis] = real(column.number, self.endian, self.take(column.number)?),
                None => self.skip(column)?,
            }
        }
        Ok(point)
    }

    /// Hands on the face of the next row.
    #[inline]
    pub(super) fn list(
        &mut self,
        table: &Table,
        label: u64,
        ids: &mut Vec<u64>,
        out: &mut ElementSink<'_>,
    ) -> Result<()> {
        for (k, column) in table.columns.iter().enumerate() {
            match column.length {
                Some(length) if k == table.corners => {
                    let corners = integer(length, self.endian, self.take(length)?)?;
                    self.ids(column.number, corners.min(BATCH), ids)?;
                    out.element(label, faces::of_corners(corners)?, ids)?;
                    let mut left = corners - ids.len() as u64;
                    while left > 0 {
                        self.ids(column.number, left.min(BATCH), ids)?;
                        out.mark_used(ids);
                        left -= ids.len() as u64;
                    }
                }
                _ => self.skip(column)?,
            }
        }
        Ok(())
    }

    #[inline]
    fn ids(&mut self, number: Number, count: u64, ids: &mut Vec<u64>) -> Result<()> {
        ids.clear();
        for _ in 0..count {
            ids.push(integer(number, self.endian, self.take(number)?)?);
        }
        Ok(())
    }

    #[inline]
    fn skip(&mut self, column: &Column) -> Result<()> {
        let count = match column.length {
            Some(length) => integer(length, self.endian, self.take(length)?)?,
            None => 1,
        };
        let step = count.checked_mul(column.number.width()).and_then(|step| usize::try_from(step).ok());
        self.at = step.and_then(|step| self.at.checked_add(step)).ok_or_else(cut_off)?;
        Ok(())
    }

    #[inline]
    fn take(&mut self, number: Number) -> Result<&[u8]> {
        let end = self.at.saturating_add(number.width() as usize);
        let bytes = self.bytes.get(self.at..end).ok_or_else(cut_off)?;
        self.at = end;
        Ok(bytes)
    }
}

/// The outline has seen every row whole: only a file that changes meanwhile comes here.
#[cold]
fn cut_off() -> Error {
    Error::malformed("the rest of a row", "the end of the rows")
}

/// A whole number that is not negative.
#[inline]
fn integer(number: Number, endian: Endian, bytes: &[u8]) -> Result<u64> {
    let value = match number {
        Number::I8 => i64::from(bytes[0].cast_signed()),
        Number::U8 => i64::from(bytes[0]),
        Number::I16 => i64::from(short(endian, bytes).cast_signed()),
        Number::U16 => i64::from(short(endian, bytes)),
        Number::I32 => i64::from(endian.i32(bytes)),
        Number::U32 | Number::F32 | Number::F64 => i64::from(endian.u32(bytes)),
    };
    u64::try_from(value).map_err(|_| Error::malformed("a number, 0 or more", value.to_string()))
}

#[inline]
fn real(number: Number, endian: Endian, bytes: &[u8]) -> f64 {
    match number {
        Number::F32 => f64::from(endian.f32(bytes)),
        Number::F64 => endian.f64(bytes),
        Number::I8 => f64::from(bytes[0].cast_signed()),
        Number::U8 => f64::from(bytes[0]),
        Number::I16 => f64::from(short(endian, bytes).cast_signed()),
        Number::U16 => f64::from(short(endian, bytes)),
        Number::I32 => f64::from(endian.i32(bytes)),
        Number::U32 => f64::from(endian.u32(bytes)),
    }
}

#[inline]
fn short(endian: Endian, bytes: &[u8]) -> u16 {
    match endian {
        Endian::Little => u16::from_le_bytes([bytes[0], bytes[1]]),
        Endian::Big => u16::from_be_bytes([bytes[0], bytes[1]]),
    }
}

/// Goes over the rows of a table to cut it into pieces.
pub(super) struct Walk<'s> {
    pub(super) source: &'s Source,
    pub(super) table: &'s Table,
    pub(super) endian: Endian,
}

impl Walk<'_> {
    /// Cuts the rows from byte `at` on: ranges of bytes, with the number of the first row. Gives the byte after them.
    pub(super) fn cut(&self, at: u64, piece: &mut impl FnMut(Range<u64>, u64) -> Result<()>) -> Result<u64> {
        match self.table.width() {
            Some(width) => self.cut_equal(at, width, piece),
            None => self.cut_lists(at, piece),
        }
    }

    fn cut_equal(
        &self,
        at: u64,
        width: u64,
        piece: &mut impl FnMut(Range<u64>, u64) -> Result<()>,
    ) -> Result<u64> {
        let count = self.table.count;
        let end = count.checked_mul(width).and_then(|bytes| at.checked_add(bytes));
        let Some(end) = end.filter(|end| *end <= self.source.len()) else {
            let what = format!("{count} rows of {} from byte {at}, {width} bytes each", self.table.name);
            return Err(self.source.truncated(what));
        };
        // Rows without columns take no bytes, however many there are.
        let count = if width == 0 { 0 } else { count };
        cut_records(count, width, |rows| piece(at + rows.start * width..at + rows.end * width, rows.start))?;
        Ok(end)
    }

    fn cut_lists(&self, at: u64, piece: &mut impl FnMut(Range<u64>, u64) -> Result<()>) -> Result<u64> {
        let mut bytes = Windows { source: self.source, window: None };
        let (mut at, mut from, mut first) = (at, at, 0);
        for row in 0..self.table.count {
            let start = at;
            for column in &self.table.columns {
                let count = match column.length {
                    None => 1,
                    Some(length) => {
                        let Some(found) = bytes.get(at, length.width()) else {
                            return Err(self.truncated(row));
                        };
                        let count = integer(length, self.endian, found);
                        at += length.width();
                        count.map_err(|e| self.source.place(e, crate::input::Spot::Binary(start)))?
                    }
                };
                at = at.saturating_add(count.saturating_mul(column.number.width()));
            }
            if at > self.source.len() {
                return Err(self.truncated(row));
            }
            if at - from >= PIECE_BYTES || row + 1 == self.table.count {
                piece(from..at, first)?;
                (from, first) = (at, row + 1);
            }
        }
        Ok(at)
    }

    fn truncated(&self, row: u64) -> Error {
        let Table { count, name, .. } = self.table;
        self.source.truncated(format!("row {} of {count} of {name}", row + 1))
    }
}

/// A few bytes at rising places, through windows.
struct Windows<'s> {
    source: &'s Source,
    window: Option<(u64, Window<'s>)>,
}

impl Windows<'_> {
    #[inline]
    fn get(&mut self, at: u64, len: u64) -> Option<&[u8]> {
        const STEP: u64 = 4 << 20;
        let holds =
            |(start, window): &(u64, Window<'_>)| at >= *start && at + len <= *start + window.len() as u64;
        if !self.window.as_ref().is_some_and(holds) {
            self.window = Some((at, self.source.window(at..at.saturating_add(STEP))));
        }
        let (start, window) = self.window.as_ref()?;
        window.get((at - start) as usize..(at - start + len) as usize)
    }
}
