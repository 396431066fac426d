//! Elements out of others: rows and layers of one, and copies of a set.

use std::sync::Arc;

use super::made::Copies;
use super::tables::Tables;
use super::{MadeElements, Store};
use crate::error::{Error, Result};
use crate::formats::abaqus::fields::Fields;
use crate::formats::abaqus::types::Kind;

/// Most elements that one line may make.
const MOST: u64 = 1 << 26;

/// What a line of `*ELGEN` makes: an element, again and again in rows, the rows in layers.
#[derive(Debug)]
pub(super) struct Rows {
    pub(super) kind: Kind,
    master: u64,
    ids: Vec<u64>,
    /// For elements in a row, rows and layers: how many, increments of nodes and of elements.
    steps: [[u64; 3]; 3],
}

impl Rows {
    /// Number of elements, the master among them.
    pub(super) fn count(&self) -> u64 {
        self.steps.iter().map(|step| step[0]).product()
    }

    /// The number of an element by its place, and its nodes.
    pub(super) fn at(&self, place: u64, ids: &mut Vec<u64>) -> u64 {
        let [[in_row, ..], [rows, ..], _] = self.steps;
        let places = [place % in_row, place / in_row % rows, place / in_row / rows];
        let of = |k: usize| places.iter().zip(&self.steps).map(|(n, step)| n * step[k]).sum::<u64>();
        let shift = of(1);
        ids.clear();
        // A node that is left out stays so.
        ids.extend(self.ids.iter().map(|id| if *id == 0 { 0 } else { id + shift }));
        self.master + of(2)
    }
}

/// `*ELGEN`.
pub(super) fn rows(
    tables: &mut Tables,
    store: &Store<'_>,
    fields: &mut Fields<'_>,
    set: Option<&[u8]>,
) -> Result<Vec<MadeElements>> {
    let mut made = Vec::new();
    while fields.next_line()? {
        store.line.set(fields.at);
        let at = store.at + fields.at as u64;
        let one = Some(1);
        let [master, in_row, a, b, rows, c, d, layers, e, f] =
            fields.integers([None, one, one, one, one, one, one, one, one, one])?;
        let steps = [[in_row, a, b], [rows, c, d], [layers, e, f]].map(|[n, a, b]| [n.max(1), a, b]);
        let (kind, ids) = tables.element(master)?;
        let count = steps.iter().try_fold(1u64, |count, step| count.checked_mul(step[0]));
        let reach = steps
            .iter()
            .try_fold(0u64, |sum, step| sum.checked_add(step[0].checked_mul(step[1].max(step[2]))?));
        if count.is_none_or(|count| count > MOST) || reach.is_none_or(|reach| reach > MOST << 8) {
            return Err(Error::limit("number of elements that a line of *ELGEN makes", MOST));
        }
        if let Some(set) = set {
            for layer in 0..steps[2][0] {
                for row in 0..steps[1][0] {
                    tables.take(24)?;
                    let first = master + row * steps[1][2] + layer * steps[2][2];
                    let range = [first, first + (steps[0][0] - 1) * steps[0][2], steps[0][2].max(1)];
                    tables.element_sets.entry(set.to_vec()).or_default().add(vec![range]);
                }
            }
        }
        let rows = Arc::new(Rows { kind, master, ids, steps });
        tables.take(256 + 8 * rows.ids.len() as u64)?;
        tables.rows.push(Arc::clone(&rows));
        made.push(MadeElements::rows(store, at, rows));
    }
    Ok(made)
}

/// `*ELCOPY`: copies of the elements of a set, with other numbers and other nodes.
pub(super) fn copy(
    tables: &mut Tables,
    store: &Store<'_>,
    (old, set): (&[u8], Option<&[u8]>),
    (change, shift): (u64, u64),
) -> Result<Vec<MadeElements>> {
    let mut copies = Copies::new(store);
    for label in tables.members(false, old)? {
        let (kind, mut ids) = tables.element(label)?;
        ids.iter_mut().filter(|id| **id != 0).for_each(|id| *id = id.saturating_add(shift));
        let label = label.saturating_add(change);
        tables.add_element(label, &kind, &ids)?;
        copies.push(label, &kind, &ids)?;
        if let Some(set) = set {
            tables.element_sets.entry(set.to_vec()).or_default().add(vec![[label, label, 1]]);
        }
    }
    copies.finish()
}
