//! Arrays of numbers in a MAT-file: where each stands (in the file, or unpacked in scratch), read as reals whatever type
//! MATLAB stored them as. MATLAB packs whole numbers into the smallest type: the class of an array says nothing about it.

use std::ops::Range;
use std::sync::Arc;

use crate::formats::binary::Endian;
use crate::input::{Source, Spot};

/// How a number is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Number {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
    I64,
    U64,
}

impl Number {
    /// The type with the tag of a data element.
    pub(super) fn of_tag(tag: u32) -> Option<Self> {
        Some(match tag {
            1 => Self::I8,
            2 => Self::U8,
            3 => Self::I16,
            4 => Self::U16,
            5 => Self::I32,
            6 => Self::U32,
            7 => Self::F32,
            9 => Self::F64,
            12 => Self::I64,
            13 => Self::U64,
            _ => return None,
        })
    }

    /// Number of bytes.
    pub(super) fn width(self) -> u64 {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 | Self::I64 | Self::U64 => 8,
        }
    }
}

/// Numbers one after another, every byte of which is there.
#[derive(Debug, Clone)]
pub(super) struct Numbers {
    pub(super) source: Arc<Source>,
    /// Whether they stand in the mesh file itself.
    pub(super) in_file: bool,
    pub(super) at: u64,
    pub(super) number: Number,
    pub(super) endian: Endian,
}

impl Numbers {
    /// Where number `index` stands, if it stands in the mesh file.
    pub(super) fn spot(&self, index: u64) -> Spot {
        if self.in_file { Spot::Binary(self.at + index * self.number.width()) } else { Spot::Unknown }
    }

    /// Replaces `out` with the numbers of `range`.
    pub(super) fn read(&self, range: Range<u64>, out: &mut Vec<f64>) {
        out.clear();
        let width = self.number.width();
        let bytes = self.source.window(self.at + range.start * width..self.at + range.end * width);
        macro_rules! convert {
            ($type:ty) => {{
                let (raw, _) = bytes.as_chunks::<{ size_of::<$type>() }>();
                match self.endian {
                    Endian::Little => out.extend(raw.iter().map(|raw| <$type>::from_le_bytes(*raw) as f64)),
                    Endian::Big => out.extend(raw.iter().map(|raw| <$type>::from_be_bytes(*raw) as f64)),
                }
            }};
        }
        match self.number {
            Number::I8 => convert!(i8),
            Number::U8 => convert!(u8),
            Number::I16 => convert!(i16),
            Number::U16 => convert!(u16),
            Number::I32 => convert!(i32),
            Number::U32 => convert!(u32),
            Number::F32 => convert!(f32),
            Number::F64 => convert!(f64),
            Number::I64 => convert!(i64),
            Number::U64 => convert!(u64),
        }
    }
}

/// A matrix of real numbers, stored column by column.
#[derive(Debug, Clone)]
pub(super) struct Matrix {
    /// Its name: `p`, `mesh.p`, `groups{2}.Elems`.
    pub(super) path: String,
    pub(super) rows: u64,
    pub(super) columns: u64,
    pub(super) numbers: Numbers,
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
            numbers.read(span.start * width as u64..span.end * width as u64, out);
            return;
        }
        let mut column = Vec::new();
        out.clear();
        out.resize((span.end - span.start) as usize * width, 0.0);
        for k in 0..width {
            let start = k as u64 * self.matrix.rows;
            numbers.read(start + span.start..start + span.end, &mut column);
            for (record, value) in out.chunks_exact_mut(width).zip(&column) {
                record[k] = *value;
            }
        }
    }
}
