//! Rows of whole numbers as nearly all programs write them: `number nodes ...` on a line, one separator, and perhaps blanks,
//! between numbers. Such rows are read and handed on block by block; any other row is left to its format, which knows what
//! else may stand there and says what is wrong.

use std::sync::Arc;

use crate::error::Result;
use crate::formats::text::short_number;
use crate::formats::{BLOCK, ElementSink};
use crate::mesh::ElementType;

/// Digits of the longest number of a plain row.
const MOST_DIGITS: usize = 11;
/// Most nodes of an element in a plain row.
const MOST_NODES: usize = 64;

/// What stands in each row.
#[derive(Debug, Clone, Copy)]
pub struct Columns<'k> {
    /// The elements' type.
    pub kind: &'k Arc<ElementType>,
    /// Number of the first element where rows have none; otherwise the number comes first.
    pub first: Option<u64>,
    /// What stands between the element's number and its nodes: known numbers, the same in all rows, and how many others.
    pub before: (&'k [u64], usize),
    /// How many numbers follow the nodes.
    pub after: usize,
    /// Bits that the nodes' numbers have besides what stands in the row.
    pub scope: u64,
}

/// How far plain rows went.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Taken {
    /// Number of bytes, up to the start of the next row.
    pub bytes: usize,
    /// Number of rows; where it is 0 the format reads the next row.
    pub rows: u64,
}

/// Reads plain rows.
#[derive(Debug)]
pub struct PlainRows {
    /// What stands behind a number that is not the last: `,` or a blank.
    separator: u8,
    labels: [u64; BLOCK],
    ids: Vec<u64>,
    /// Rows that are left to the format before the next try.
    pause: usize,
}

impl PlainRows {
    /// Rows whose numbers stand apart by `separator`. Nothing where they are too long, or of types without nodes.
    pub fn new(separator: u8, columns: &Columns<'_>) -> Option<Self> {
        let measured = columns.kind.shape().is_some() && columns.kind.nodes <= MOST_NODES;
        measured.then(|| Self { separator, labels: [0; BLOCK], ids: Vec::new(), pause: 0 })
    }

    /// Hands on the elements of at most `most` rows from the start of `bytes`, which is that of a row.
    pub fn take(
        &mut self,
        bytes: &[u8],
        columns: &Columns<'_>,
        most: u64,
        out: &mut ElementSink<'_>,
    ) -> Result<Taken> {
        if self.pause > 0 {
            self.pause -= 1;
            return Ok(Taken::default());
        }
        let mut taken = Taken::default();
        self.ids.clear();
        while taken.rows < most.min(BLOCK as u64) {
            let Some(end) = self.row(bytes, taken, columns) else { break };
            taken = Taken { bytes: end, rows: taken.rows + 1 };
        }
        let rows = taken.rows as usize;
        self.ids.truncate(rows * columns.kind.nodes);
        if rows > 0 && out.block(columns.kind, &self.labels[..rows], &self.ids)? {
            return Ok(taken);
        }
        self.pause = rows;
        Ok(Taken::default())
    }

    /// Reads one row; gives the byte after its line.
    #[inline(always)]
    fn row(&mut self, bytes: &[u8], taken: Taken, columns: &Columns<'_>) -> Option<usize> {
        let mut at = taken.bytes;
        let label = match columns.first {
            Some(first) => first + taken.rows,
            None => self.number(bytes, &mut at)?,
        };
        if label == 0 && columns.first.is_none() {
            return None;
        }
        self.labels[taken.rows as usize] = label;
        for known in columns.before.0 {
            if self.number(bytes, &mut at)? != *known {
                return None;
            }
        }
        for _ in 0..columns.before.1 {
            self.number(bytes, &mut at)?;
        }
        let (nodes, after) = (columns.kind.nodes, columns.after);
        for k in (0..nodes + after).rev() {
            let number = if k > 0 { self.number(bytes, &mut at)? } else { last_number(bytes, &mut at)? };
            if k >= after {
                self.ids.push(columns.scope | number);
            }
        }
        Some(at)
    }

    /// The next number, which is not the last of its row.
    #[inline(always)]
    fn number(&self, bytes: &[u8], at: &mut usize) -> Option<u64> {
        let number = digits(bytes, at)?;
        let separated = bytes.get(*at) == Some(&self.separator);
        *at += 1;
        separated.then_some(number)
    }
}

/// The last number of a row; goes to the next row.
#[inline(always)]
fn last_number(bytes: &[u8], at: &mut usize) -> Option<u64> {
    let number = digits(bytes, at)?;
    while let Some(b' ' | b'\r') = bytes.get(*at) {
        *at += 1;
    }
    let ended = bytes.get(*at) == Some(&b'\n');
    *at += 1;
    ended.then_some(number)
}

/// The number behind the blanks that stand here.
#[inline(always)]
fn digits(bytes: &[u8], at: &mut usize) -> Option<u64> {
    while bytes.get(*at) == Some(&b' ') {
        *at += 1;
    }
    let (mut number, mut digits) = short_number(bytes.get(*at..)?.first_chunk()?);
    *at += digits;
    if digits == 8 {
        while let Some(digit) = bytes.get(*at).map(|byte| byte.wrapping_sub(b'0')).filter(|digit| *digit < 10)
        {
            number = number.wrapping_mul(10) + u64::from(digit);
            *at += 1;
            digits += 1;
        }
    }
    matches!(digits, 1..=MOST_DIGITS).then_some(number)
}
