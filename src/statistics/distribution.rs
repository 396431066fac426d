//! The distribution of scores: the report's 100 bins of equal width over [0, 1], and cells for quantiles.
//!
//! Both come from one table. The cell of a value and its bin only grow with the value, so that their sum tells the pair: one
//! count a score is all that the hot loop has to take.

use std::collections::BTreeMap;

use super::spread::{Cells, Spread};
use super::tally::Tally;

/// Number of bins.
pub const BINS: usize = 100;

/// Lower edges of the bins, and 1: the doubles nearest to 0.00, 0.01, 0.02 and so on.
static EDGES: [f64; BINS + 1] = {
    let mut edges = [0.0; BINS + 1];
    let mut k = 0;
    while k <= BINS {
        edges[k] = k as f64 / BINS as f64;
        k += 1;
    }
    edges
};

/// Counts of scores of [0, 1]. Bin k holds `k / 100 <= score < (k + 1) / 100`, and 1 is in the last.
#[derive(Debug, Clone, PartialEq)]
pub struct Distribution {
    cells: Cells,
    /// By cell plus bin.
    counts: Tally,
}

impl Default for Distribution {
    fn default() -> Self {
        let cells = Cells::of_unit();
        Self { cells, counts: Tally::new(cells.count() + BINS - 1) }
    }
}

impl Distribution {
    /// Counts scores.
    #[inline(always)]
    pub fn record(&mut self, scores: &[f64]) {
        let cells = self.cells;
        self.counts.count_by(scores, |score| cells.of(score) + bin(score));
    }

    /// Adds the counts of another.
    pub fn merge(&mut self, other: &Self) {
        self.counts.merge(&other.counts);
    }

    /// Counts by bin.
    pub fn bins(&self) -> [u64; BINS] {
        std::array::from_fn(|bin| self.counts_of_bin(bin).1.sum())
    }

    /// Quantiles by key, as [`Spread::quantiles`] has them.
    pub fn quantiles(&self, further: &[f64], min: f64, max: f64) -> BTreeMap<String, f64> {
        let mut spread = Spread::of_unit();
        for bin in 0..BINS {
            let (first, counts) = self.counts_of_bin(bin);
            spread.add(first, counts);
        }
        spread.quantiles(further, min, max)
    }

    /// The first cell with values of a bin, and the counts of that bin from this cell on.
    fn counts_of_bin(&self, bin: usize) -> (usize, impl Iterator<Item = u64>) {
        let first = self.cells.of(EDGES[bin]) as usize;
        let last = if bin + 1 < BINS { EDGES[bin + 1].next_down() } else { 1.0 };
        (first, self.counts.from(first + bin).take(self.cells.of(last) as usize - first + 1))
    }
}

/// The bin of a score. The nearest whole number to what the product is less a half, and any product that rounds over an
/// edge (0.29 * 100 < 29), is one bin off at most.
#[inline(always)]
fn bin(score: f64) -> u32 {
    /// Adding this leaves the nearest whole number in the low bits of the double, without a conversion.
    const ROUND: f64 = 1.5 * (1u64 << 52) as f64;
    let guess = (score * BINS as f64 - 0.5 + ROUND) - ROUND;
    let low = if score < edge(guess) { 1.0 } else { 0.0 };
    let high = if score >= edge(guess + 1.0) { 1.0 } else { 0.0 };
    let bin = guess - low + high;
    let last = (BINS - 1) as f64;
    let bin = if bin < last { bin } else { last };
    (bin + ROUND).to_bits() as u32 & 0x7f
}

/// k / 100 to the last bit without a division: 0.01 in two parts, of which the first is short enough for its product to be
/// exact.
#[inline(always)]
fn edge(k: f64) -> f64 {
    const HIGH: f64 = f64::from_bits(0.01f64.to_bits() & !0xff);
    const LOW: f64 = (1.0 - 100.0 * HIGH) / 100.0;
    k * HIGH + k * LOW
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_on_an_edge_are_in_the_upper_bin_and_one_is_in_the_last() {
        for (k, low) in EDGES.iter().enumerate() {
            assert_eq!(edge(k as f64), *low);
        }
        for k in 0..BINS {
            let edge: f64 = format!("0.{k:02}").parse().expect("a number");
            assert_eq!(bin(edge), k as u32, "{edge}");
            assert_eq!(bin(edge.next_down().max(0.0)), k.saturating_sub(1) as u32, "under {edge}");
        }
        assert_eq!(bin(1.0), 99);
        assert_eq!(bin(1.0f64.next_down()), 99);
        assert_eq!(bin(5e-324), 0);
    }

    #[test]
    fn one_table_tells_what_two_would() {
        let mut scores: Vec<f64> = (0..50_000).map(|k| f64::from(k) / 50_000.0).collect();
        scores.extend(
            EDGES.iter().flat_map(|edge| [*edge, edge.next_down().max(0.0), edge.next_up().min(1.0)]),
        );
        scores.extend((0..1000).map(|k| f64::from(-k).exp2()));
        let mut found = Distribution::default();
        let mut spread = Spread::of_unit();
        let mut bins = [0; BINS];
        for part in scores.chunks(77) {
            found.record(part);
            spread.record(part);
        }
        for score in &scores {
            bins[EDGES[1..BINS].partition_point(|edge| edge <= score)] += 1;
        }
        assert_eq!(found.bins(), bins);
        assert_eq!(found.quantiles(&[], 0.0, 1.0), spread.quantiles(&[], 0.0, 1.0));
        let mut twice = found.clone();
        twice.merge(&found);
        assert_eq!(twice.bins(), bins.map(|count| 2 * count));
    }
}
