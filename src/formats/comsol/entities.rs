//! The geometric entities that elements lie in: domains, boundaries, edges, points. Their numbers stand after the
//! elements of a type, one an element.

use std::ops::Range;
use std::sync::{Arc, OnceLock};

use super::layouts::Encoding;
use crate::error::{Error, Result};
use crate::formats::text;
use crate::formats::words::Words;
use crate::input::Source;

/// Where the numbers of one type's elements stand. They are found after the elements.
#[derive(Debug)]
pub(super) struct Entities {
    pub(super) source: Arc<Source>,
    pub(super) encoding: Encoding,
    /// What the entities are.
    pub(super) what: &'static str,
    /// What the user's number of an entity is above the file's.
    pub(super) base: i64,
    /// Pieces of the list, each with the number of its first row.
    pub(super) pieces: OnceLock<Vec<(u64, Range<u64>)>>,
}

impl Entities {
    /// The entities of elements with so many dimensions, in a space of so many.
    pub(super) fn of(source: &Arc<Source>, encoding: Encoding, dimension: usize, space: usize) -> Self {
        // Users see the entities of all dimensions counted from 1; in the file only domains are.
        let (what, base) = match (dimension, space.saturating_sub(dimension)) {
            (_, 0) => ("domain", 0),
            (_, 1) => ("boundary", 1),
            (0, _) => ("point", 1),
            _ => ("edge", 1),
        };
        Self { source: Arc::clone(source), encoding, what, base, pieces: OnceLock::new() }
    }

    /// The numbers of at most `most` elements from `row` on.
    pub(super) fn numbers(&self, row: u64, most: usize) -> Result<Vec<i64>> {
        let pieces = self.pieces.get().map_or(&[][..], Vec::as_slice);
        let first = pieces.partition_point(|piece| piece.0 <= row).saturating_sub(1);
        let mut numbers = Vec::new();
        for (start, span) in pieces.iter().skip(first) {
            let pass = usize::try_from(row.saturating_sub(*start)).unwrap_or(usize::MAX);
            self.piece(span.clone(), pass, most, &mut numbers)?;
            if numbers.len() == most {
                break;
            }
        }
        Ok(numbers)
    }

    /// Adds the numbers of a piece after the first `pass` of them, until there are `most`.
    fn piece(&self, span: Range<u64>, pass: usize, most: usize, numbers: &mut Vec<i64>) -> Result<()> {
        let window = self.source.window(span.clone());
        let left = most - numbers.len();
        match self.encoding {
            Encoding::Binary => {
                let rows = window.as_chunks::<4>().0.iter().skip(pass).take(left);
                numbers.extend(rows.map(|raw| i64::from(i32::from_le_bytes(*raw))));
            }
            Encoding::Text => {
                let mut words = Words::new(span.start, &window);
                let mut row = 0;
                while row < pass.saturating_add(left) && words.more() {
                    let (spot, word) = (words.spot(), words.word());
                    if row >= pass {
                        let number = text::signed(word).ok_or_else(|| {
                            let found = crate::error::excerpt(word);
                            self.source.place(Error::malformed("a geometric entity index", found), spot)
                        })?;
                        numbers.push(number);
                    }
                    row += 1;
                }
            }
        }
        Ok(())
    }

    /// What the user calls the entity with that number.
    pub(super) fn name(&self, number: i64) -> String {
        format!("{} {}", self.what, number.saturating_add(self.base))
    }
}
