//! The node table: coordinates by row, and the index from a node's own number to its row.
//!
//! It is the one large consumer of memory. Rows are `[x, y, z]`, 24 bytes a node, in memory while the budget lasts and
//! in a mapped scratch file after. Numbers that follow each other cost nothing; others cost 4 bytes for each number in
//! their range, or 16 bytes a node where the range is sparse.

use std::collections::{BTreeSet, HashMap};
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

use super::column::{Column, ColumnBuilder};
use crate::error::{Error, Result};
use crate::input::{Budget, Scratch};
use crate::width::{Wide, at_widest};

/// More runs of consecutive numbers than this, and numbers are kept one by one.
const MOST_RUNS: usize = 1 << 16;
/// A table by number may have this many places for each node.
const SPARSEST_TABLE: u64 = 8;

/// Nodes that are being read, in file order.
#[derive(Debug)]
pub struct NodesBuilder {
    rows: ColumnBuilder<[f64; 3]>,
    runs: Vec<Run>,
    /// Numbers one by one, once there are too many runs.
    ids: Option<ColumnBuilder<u64>>,
    bounds: Bounds,
    budget: Budget,
    scratch: Scratch,
}

/// Smallest and largest coordinate along each axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Smallest x, y, z.
    pub min: [f64; 3],
    /// Largest x, y, z.
    pub max: [f64; 3],
}

/// Consecutive numbers in consecutive rows.
#[derive(Debug, Clone, Copy)]
struct Run {
    id: u64,
    row: u64,
    len: u64,
}

/// The node table.
#[derive(Debug)]
pub struct Nodes {
    rows: Column<[f64; 3]>,
    index: Index,
    /// Number of distinct nodes: rows that a later definition replaced do not count.
    count: u64,
    bounds: Bounds,
    used: Vec<AtomicU64>,
}

#[derive(Debug)]
enum Index {
    /// Number `first + row`.
    Dense { first: u64, len: u64 },
    /// Place `number - first` holds row + 1, or 0.
    Table { first: u64, rows: Column<u32> },
    /// Runs sorted by number.
    Runs(Vec<Run>),
    /// Pairs of number and row, sorted by number.
    Pairs(Column<[u64; 2]>),
}

impl Bounds {
    /// The bounds of nothing.
    pub const EMPTY: Bounds = Bounds { min: [f64::INFINITY; 3], max: [f64::NEG_INFINITY; 3] };

    /// Takes in one point.
    #[inline]
    pub fn include(&mut self, point: &[f64; 3]) {
        for (axis, x) in point.iter().enumerate() {
            self.min[axis] = self.min[axis].min(*x);
            self.max[axis] = self.max[axis].max(*x);
        }
    }

    /// Length of the diagonal; 0 where there is nothing.
    pub fn diagonal(&self) -> f64 {
        if self.min[0] > self.max[0] {
            return 0.0;
        }
        let d = [0, 1, 2].map(|k| self.max[k] - self.min[k]);
        (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt()
    }
}

impl NodesBuilder {
    /// An empty table.
    pub fn new(budget: &Budget, scratch: &Scratch) -> Self {
        Self {
            rows: ColumnBuilder::new(budget, scratch),
            runs: Vec::new(),
            ids: None,
            bounds: Bounds::EMPTY,
            budget: budget.clone(),
            scratch: scratch.clone(),
        }
    }

    /// Says how many nodes to expect, as far as the data seen tells. Nothing is lost if it is wrong.
    pub fn expect(&mut self, nodes: usize) {
        self.rows.expect(nodes);
    }

    /// Appends nodes. An empty `ids` means that numbers follow the rows, from 0. Of nodes with one number the last wins.
    pub fn extend(&mut self, ids: &[u64], rows: &[[f64; 3]]) -> Result<()> {
        debug_assert!(ids.is_empty() || ids.len() == rows.len());
        let first = self.rows.len() as u64;
        if first + rows.len() as u64 >= u64::from(u32::MAX) {
            return Err(Error::limit("number of nodes", u32::MAX - 1));
        }
        for row in rows {
            self.bounds.include(row);
        }
        self.rows.extend(rows)?;
        if ids.is_empty() {
            return self.add_run(Run { id: first, row: first, len: rows.len() as u64 });
        }
        let mut start = 0;
        for i in 1..=ids.len() {
            if i == ids.len() || ids[i] != ids[i - 1].wrapping_add(1) {
                self.add_run(Run { id: ids[start], row: first + start as u64, len: (i - start) as u64 })?;
                start = i;
            }
        }
        Ok(())
    }

    fn add_run(&mut self, run: Run) -> Result<()> {
        if run.id.checked_add(run.len).is_none() {
            return Err(Error::malformed(format!("a node number under {}", u64::MAX), run.id.to_string()));
        }
        if let Some(ids) = &mut self.ids {
            return extend_run(ids, run);
        }
        match self.runs.last_mut() {
            Some(last) if last.id + last.len == run.id && last.row + last.len == run.row => {
                last.len += run.len
            }
            _ => self.runs.push(run),
        }
        if self.runs.len() > MOST_RUNS {
            self.ids = Some(self.list_ids()?);
        }
        Ok(())
    }

    /// Number of each row, one by one.
    fn list_ids(&mut self) -> Result<ColumnBuilder<u64>> {
        let mut ids = ColumnBuilder::new(&self.budget, &self.scratch);
        for run in std::mem::take(&mut self.runs) {
            extend_run(&mut ids, run)?;
        }
        Ok(ids)
    }

    /// Ends reading and makes the index.
    pub fn finish(mut self) -> Result<Nodes> {
        self.runs.retain(|run| run.len > 0);
        self.runs.sort_unstable_by_key(|run| (run.id, run.row));
        let redefined = self.runs.windows(2).any(|w| w[0].id + w[0].len > w[1].id);
        if redefined {
            self.runs.sort_unstable_by_key(|run| run.row);
            self.ids = Some(self.list_ids()?);
        }
        let total = self.rows.len() as u64;
        let bounds = self.bounds;
        let rows =
            std::mem::replace(&mut self.rows, ColumnBuilder::new(&self.budget, &self.scratch)).finish()?;
        let (index, count) = match self.ids.take() {
            Some(ids) => self.index_ids(&ids.finish()?)?,
            None => (self.index_runs(total)?, total),
        };
        let used = (0..total.div_ceil(64)).map(|_| AtomicU64::new(0)).collect();
        let mut nodes = Nodes { rows, index, count, bounds, used };
        if count < total {
            nodes.bounds = nodes.bounds_of_live_rows();
        }
        Ok(nodes)
    }

    fn index_runs(&mut self, total: u64) -> Result<Index> {
        let runs = std::mem::take(&mut self.runs);
        let (Some(first), Some(last)) = (runs.first(), runs.last()) else {
            return Ok(Index::Dense { first: 0, len: 0 });
        };
        if runs.len() == 1 {
            return Ok(Index::Dense { first: first.id, len: first.len });
        }
        let (first, places) = (first.id, last.id + last.len - first.id);
        if runs.len() <= 8 || places > SPARSEST_TABLE * total {
            return Ok(Index::Runs(runs));
        }
        let mut table = Column::<u32>::zeroed(places as usize, &self.budget, &self.scratch)?;
        for run in &runs {
            for k in 0..run.len {
                table.rows_mut()[(run.id - first + k) as usize] = (run.row + k + 1) as u32;
            }
        }
        Ok(Index::Table { first, rows: table })
    }

    /// The index of numbers in any order, and how many distinct ones there are.
    fn index_ids(&self, ids: &Column<u64>) -> Result<(Index, u64)> {
        let ids = ids.rows();
        let first = ids.iter().copied().min().unwrap_or(0);
        let last = ids.iter().copied().max().unwrap_or(0);
        if last - first < SPARSEST_TABLE * ids.len() as u64 {
            let places = (last - first + 1) as usize;
            let mut table = Column::<u32>::zeroed(places, &self.budget, &self.scratch)?;
            let mut distinct = 0;
            for (row, id) in ids.iter().enumerate() {
                let place = &mut table.rows_mut()[(id - first) as usize];
                distinct += u64::from(*place == 0);
                *place = row as u32 + 1;
            }
            return Ok((Index::Table { first, rows: table }, distinct));
        }
        let mut pairs = Column::<[u64; 2]>::zeroed(ids.len(), &self.budget, &self.scratch)?;
        for (row, (pair, id)) in pairs.rows_mut().iter_mut().zip(ids).enumerate() {
            *pair = [*id, row as u64];
        }
        pairs.rows_mut().sort_unstable();
        let distinct = 1 + pairs.rows().windows(2).filter(|w| w[0][0] != w[1][0]).count() as u64;
        Ok((Index::Pairs(pairs), distinct))
    }
}

/// Appends the numbers of a run.
fn extend_run(ids: &mut ColumnBuilder<u64>, run: Run) -> Result<()> {
    let mut step = [0u64; 512];
    let mut done = 0;
    while done < run.len {
        let n = (run.len - done).min(step.len() as u64) as usize;
        for (k, id) in step[..n].iter_mut().enumerate() {
            *id = run.id + done + k as u64;
        }
        ids.extend(&step[..n])?;
        done += n as u64;
    }
    Ok(())
}

/// Rows of numbers that follow each other; see [`Nodes::rows_of`].
struct DenseRows<'a> {
    first: u64,
    len: u64,
    ids: &'a [u64],
    out: &'a mut [u32],
}

impl Wide for DenseRows<'_> {
    type Output = bool;

    #[inline(always)]
    fn run(self) -> bool {
        let mut unknown = 0;
        for (out, id) in self.out.iter_mut().zip(self.ids) {
            let row = id.wrapping_sub(self.first);
            unknown |= u64::from(row >= self.len);
            *out = row as u32;
        }
        unknown == 0
    }
}

impl Nodes {
    /// Coordinates by row.
    #[inline]
    pub fn rows(&self) -> &[[f64; 3]] {
        self.rows.rows()
    }

    /// Gives back the memory of rows that were looked at, where they are in a scratch file. They are still there.
    pub fn release(&self, rows: Range<usize>) {
        self.rows.release(rows);
    }

    /// The row of the node with number `id`.
    #[inline(always)]
    pub fn row(&self, id: u64) -> Option<u32> {
        match &self.index {
            Index::Dense { first, len } => {
                let row = id.wrapping_sub(*first);
                (row < *len).then_some(row as u32)
            }
            Index::Table { first, rows } => {
                match rows.rows().get(usize::try_from(id.wrapping_sub(*first)).ok()?) {
                    Some(&row) if row > 0 => Some(row - 1),
                    _ => None,
                }
            }
            Index::Runs(_) | Index::Pairs(_) => self.search(id),
        }
    }

    /// The rows of the nodes with the numbers `ids`, one for each. Says whether all are known; if not, the rows mean
    /// nothing.
    #[inline]
    pub fn rows_of(&self, ids: &[u64], out: &mut [u32]) -> bool {
        let mut known = true;
        let each = out.iter_mut().zip(ids);
        match &self.index {
            Index::Dense { first, len } => {
                return at_widest(DenseRows { first: *first, len: *len, ids, out });
            }
            Index::Table { first, rows } => {
                let rows = rows.rows();
                each.for_each(|(out, id)| {
                    let row = rows.get(id.wrapping_sub(*first) as usize).copied().unwrap_or(0);
                    known &= row > 0;
                    *out = row.wrapping_sub(1);
                });
            }
            Index::Runs(_) | Index::Pairs(_) => each.for_each(|(out, id)| {
                let row = self.search(*id);
                known &= row.is_some();
                *out = row.unwrap_or(0);
            }),
        }
        known
    }

    /// The row of a number that is not near the others.
    fn search(&self, id: u64) -> Option<u32> {
        match &self.index {
            Index::Runs(runs) => {
                let run = runs[..runs.partition_point(|run| run.id <= id)].last()?;
                (id - run.id < run.len).then(|| (run.row + (id - run.id)) as u32)
            }
            Index::Pairs(pairs) => {
                let pairs = pairs.rows();
                let last = pairs[..pairs.partition_point(|pair| pair[0] <= id)].last()?;
                (last[0] == id).then_some(last[1] as u32)
            }
            Index::Dense { .. } | Index::Table { .. } => self.row(id),
        }
    }

    /// The numbers of the nodes in some rows, by row. It goes through the index once where that is not sorted by row.
    pub fn numbers(&self, rows: &BTreeSet<u32>) -> HashMap<u32, u64> {
        let wanted = |row: u64, id: u64| {
            let row = u32::try_from(row).ok().filter(|row| rows.contains(row))?;
            Some((row, id))
        };
        match &self.index {
            Index::Dense { first, .. } => rows.iter().map(|row| (*row, first + u64::from(*row))).collect(),
            Index::Table { first, rows: table } => {
                let places = (*first..).zip(table.rows()).filter(|(_, row)| **row > 0);
                places.filter_map(|(id, row)| wanted(u64::from(*row) - 1, id)).collect()
            }
            Index::Pairs(pairs) => pairs.rows().iter().filter_map(|[id, row]| wanted(*row, *id)).collect(),
            Index::Runs(runs) => {
                let of_run = |run: &Run| {
                    let Run { id, row, len } = *run;
                    let (first, end) = (row as u32, (row + len) as u32);
                    rows.range(first..end).map(move |row| (*row, id + u64::from(*row - first)))
                };
                runs.iter().flat_map(of_run).collect()
            }
        }
    }

    /// Notes that an element uses the node in `row`.
    #[inline]
    pub fn mark_used(&self, row: u32) {
        let word = &self.used[row as usize / 64];
        let bit = 1 << (row % 64);
        // Most nodes are marked already: looking is far cheaper than writing.
        if word.load(Ordering::Relaxed) & bit == 0 {
            word.fetch_or(bit, Ordering::Relaxed);
        }
    }

    /// Notes that elements use the nodes in `rows`.
    #[inline]
    pub fn mark_all_used(&self, rows: &[u32]) {
        for rows in rows.chunks(4) {
            let new = rows.iter().fold(0, |new, row| {
                new | !(self.used[*row as usize / 64].load(Ordering::Relaxed) >> (row % 64))
            });
            if new & 1 != 0 {
                rows.iter().for_each(|row| self.mark_used(*row));
            }
        }
    }

    /// Number of nodes, each number counted once.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Number of nodes that no element was seen to use.
    pub fn unused(&self) -> u64 {
        self.count
            - self.used.iter().map(|word| u64::from(word.load(Ordering::Relaxed).count_ones())).sum::<u64>()
    }

    /// The bounds of all nodes.
    pub fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// Whether all nodes have one z: then the mesh lies in a plane and its faces have a sign.
    pub fn is_planar(&self) -> bool {
        self.count > 0 && self.bounds.min[2] == self.bounds.max[2]
    }

    /// Whether the table is in a scratch file.
    pub fn is_spilled(&self) -> bool {
        self.rows.is_spilled()
    }

    fn bounds_of_live_rows(&self) -> Bounds {
        let mut bounds = Bounds::EMPTY;
        let included = self.try_each_row(|row| {
            bounds.include(&self.rows()[row]);
            Ok(())
        });
        debug_assert!(included.is_ok());
        bounds
    }

    /// Calls `include` with every row that no later definition of its node replaced.
    pub fn try_each_row(&self, mut include: impl FnMut(usize) -> Result<()>) -> Result<()> {
        match &self.index {
            Index::Table { rows, .. } => {
                rows.rows().iter().filter(|&&row| row > 0).try_for_each(|&row| include(row as usize - 1))
            }
            Index::Pairs(pairs) => {
                let pairs = pairs.rows();
                let last = |i: usize| i + 1 == pairs.len() || pairs[i][0] != pairs[i + 1][0];
                (0..pairs.len()).filter(|&i| last(i)).try_for_each(|i| include(pairs[i][1] as usize))
            }
            Index::Dense { .. } | Index::Runs(_) => (0..self.rows().len()).try_for_each(include),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers in file order, the budget, and whether some number comes twice.
    fn table(ids: &[u64], budget: u64) -> Nodes {
        let scratch = Scratch::new(&std::env::temp_dir(), 1 << 30);
        let mut builder = NodesBuilder::new(&Budget::new(budget), &scratch);
        for (k, ids) in ids.chunks(7).enumerate() {
            let rows: Vec<_> = (0..ids.len()).map(|i| [(7 * k + i) as f64, 0.0, 0.0]).collect();
            builder.extend(ids, &rows).expect("scratch");
        }
        builder.finish().expect("scratch")
    }

    #[test]
    fn every_index_finds_the_last_definition_of_every_number() {
        let reversed: Vec<u64> = (0..200_000).rev().collect();
        let sparse: Vec<u64> = (0..1000u64).map(|k| (k * 7_919_993) % 1_000_000_007).collect();
        let many_sparse: Vec<u64> = (0..100_000u64).map(|k| (k * 7_919_993) % 1_000_000_007).collect();
        let twice: Vec<u64> = (1..50).chain(20..30).collect();
        let rows: [&[u64]; 8] = [
            &[1, 2, 3, 4],
            &[10, 11, 12, 500, 501, 2, 3],
            &[5, 4, 3, 2, 1],
            &[1, 1_000_000_000_000, 5],
            &reversed,
            &sparse,
            &many_sparse,
            &twice,
        ];
        for ids in rows {
            for budget in [0, 1 << 30] {
                let nodes = table(ids, budget);
                let mut last = std::collections::HashMap::new();
                ids.iter().enumerate().for_each(|(row, id)| {
                    last.insert(*id, row as u32);
                });
                assert_eq!(nodes.count(), last.len() as u64);
                let numbers = nodes.numbers(&last.values().copied().collect());
                for (id, row) in &last {
                    assert_eq!(nodes.row(*id), Some(*row), "node {id}");
                    assert_eq!(numbers.get(row), Some(id), "row {row}");
                }
                assert_eq!(nodes.row(999_999_999_999), None);
                assert_eq!(nodes.row(0), last.get(&0).copied());
            }
        }
    }

    #[test]
    fn the_largest_number_does_not_overflow() {
        let scratch = Scratch::new(&std::env::temp_dir(), 1 << 30);
        let mut builder = NodesBuilder::new(&Budget::new(1 << 20), &scratch);
        assert!(builder.extend(&[u64::MAX], &[[0.0; 3]]).is_err());
        assert_eq!(table(&[u64::MAX - 1, 1], 1 << 20).row(u64::MAX - 1), Some(0));
    }

    #[test]
    fn a_replaced_node_does_not_count_in_bounds_and_unused() {
        let nodes = table(&[1, 2, 1], 1 << 20);
        assert_eq!((nodes.bounds().min[0], nodes.bounds().max[0]), (1.0, 2.0));
        nodes.mark_used(nodes.row(1).expect("defined"));
        assert_eq!(nodes.unused(), 1);
    }
}
