//! Distributions over many orders of magnitude, and their quantiles.
//!
//! In the hot loop a value falls into a cell that is cut from the bits of the double: its power of two and the next
//! ten bits, which is just how an HDR histogram of three significant digits divides its range. In the end the cells go
//! into such a histogram, with their counts, and the quantiles come from there.

use std::collections::BTreeMap;

use super::tally::Tally;

/// The probabilities that a summary gives quantiles for, as its keys.
pub const QUANTILES: [(&str, f64); 5] =
    [("0.001", 0.001), ("0.01", 0.01), ("0.05", 0.05), ("0.5", 0.5), ("0.95", 0.95)];

/// Bits of the mantissa that tell cells apart.
const CELL_BITS: u32 = 10;
/// Shift that leaves exponent and those bits.
const SHIFT: u32 = 52 - CELL_BITS;
/// Ticks of the HDR histogram at the upper end of the range. Twenty bits under the end and every cell still has one.
const TOP_TICKS: u64 = 1 << 40;

/// How a range (0, `top`] is divided into cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cells {
    /// Bits of the first cell, which holds 0 and whatever is smaller than the range.
    base: u64,
    /// A power of two that no value exceeds.
    top: f64,
}

impl Cells {
    /// For values of [0, 1].
    pub(super) fn of_unit() -> Self {
        Self::new(1.0, 30)
    }

    fn new(top: f64, octaves: i32) -> Self {
        let lowest = (top * 2f64.powi(-octaves)).max(f64::MIN_POSITIVE);
        Self { base: (lowest.to_bits() >> SHIFT) - 1, top }
    }

    /// Number of cells.
    pub(super) fn count(&self) -> usize {
        ((self.top.to_bits() >> SHIFT) - self.base + 1) as usize
    }

    /// The cell of a value.
    #[inline(always)]
    pub(super) fn of(&self, value: f64) -> u32 {
        let least = f64::from_bits(self.base << SHIFT);
        let value = if value > least { value } else { least };
        let value = if value < self.top { value } else { self.top };
        ((value.to_bits() >> SHIFT) - self.base) as u32
    }

    /// Smallest value of a cell.
    fn low(&self, cell: usize) -> f64 {
        f64::from_bits((self.base + cell as u64) << SHIFT)
    }
}

/// Counts of values in (0, `top`], by cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Spread {
    cells: Cells,
    counts: Tally,
}

impl Spread {
    /// For values of [0, 1].
    pub fn of_unit() -> Self {
        Self::new(Cells::of_unit())
    }

    /// For values up to `largest`, over 40 powers of two.
    pub fn up_to(largest: f64) -> Self {
        let largest = if largest.is_normal() { largest.min(1e300) } else { 1.0 };
        // The next power of two: the exponent of the double, one up.
        let top = f64::from_bits((largest.to_bits() >> 52) << 52) * 2.0;
        Self::new(Cells::new(top, 40))
    }

    fn new(cells: Cells) -> Self {
        Self { cells, counts: Tally::new(cells.count()) }
    }

    /// Counts values of [0, top].
    #[inline(always)]
    pub fn record(&mut self, values: &[f64]) {
        let cells = self.cells;
        self.counts.count_by(values, |value| cells.of(value));
    }

    /// Adds counts of the cells from `first` on.
    pub(super) fn add(&mut self, first: usize, counts: impl Iterator<Item = u64>) {
        for (cell, count) in (first..).zip(counts) {
            self.counts.add(cell, count);
        }
    }

    /// Adds the counts of another, made with the same range.
    pub fn merge(&mut self, other: &Self) {
        debug_assert!(self.cells == other.cells);
        self.counts.merge(&other.counts);
    }

    /// Quantiles by key, within [min, max], the true extremes: those of [`QUANTILES`] and of further probabilities.
    pub fn quantiles(&self, further: &[f64], min: f64, max: f64) -> BTreeMap<String, f64> {
        let mut histogram = hdrhistogram::Histogram::<u64>::new_with_bounds(1, 2 * TOP_TICKS, 3)
            .expect("the bounds are in order and three digits are allowed");
        for (cell, count) in self.counts.from(0).enumerate().filter(|(_, count)| *count > 0) {
            let ticks =
                if cell == 0 { 0 } else { (self.cells.low(cell) / self.cells.top * TOP_TICKS as f64) as u64 };
            histogram.record_n(ticks, count).expect("no value exceeds the range");
        }
        let read = |probability: f64| {
            let ticks = histogram.median_equivalent(histogram.value_at_quantile(probability));
            (ticks as f64 / TOP_TICKS as f64 * self.cells.top).clamp(min, max)
        };
        let always = QUANTILES.iter().map(|(key, probability)| ((*key).to_owned(), *probability));
        let asked = further.iter().map(|probability| (probability.to_string(), *probability));
        always.chain(asked).map(|(key, probability)| (key, read(probability))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_within_a_thousandth_of_the_sorted_values() {
        for scale in [1.0, 1e-9, 1e9] {
            let mut values: Vec<f64> = (1..=100_000).map(|k| scale * (f64::from(k) / 1e5).powi(2)).collect();
            let mut spread = if scale == 1.0 { Spread::of_unit() } else { Spread::up_to(scale) };
            spread.record(&values);
            values.sort_by(f64::total_cmp);
            let found = spread.quantiles(&[], values[0], values[values.len() - 1]);
            for (key, probability) in QUANTILES {
                let true_value = values[(probability * 1e5) as usize - 1];
                assert!((found[key] / true_value - 1.0).abs() < 1.5e-3, "{key}: {} {true_value}", found[key]);
            }
        }
    }

    #[test]
    fn zero_and_one_are_themselves() {
        let mut spread = Spread::of_unit();
        spread.record(&[0.0]);
        assert_eq!(spread.quantiles(&[], 0.0, 0.0)["0.5"], 0.0);
        let mut spread = Spread::of_unit();
        spread.record(&[1.0]);
        assert_eq!(spread.quantiles(&[], 1.0, 1.0)["0.5"], 1.0);
    }

    #[test]
    fn a_range_of_nothing_or_of_the_largest_doubles_still_counts() {
        for largest in [0.0, f64::MIN_POSITIVE, 5e-324, f64::MAX, 1e-300] {
            let mut spread = Spread::up_to(largest);
            spread.record(&[0.0]);
            spread.record(&[largest]);
            assert!(spread.quantiles(&[], 0.0, largest)["0.95"] <= largest);
        }
    }
}
