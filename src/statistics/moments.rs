//! Moments of up to five values that are observed together: means, deviations, co-moments, extremes.
//!
//! A block of values is summed in two passes (mean, then deviations from it); blocks are merged by the pairwise update
//! of Chan, Golub and LeVeque (1979), which is Welford's for blocks of one.

use super::lanes::{extremes, sum, sum_of_products};

/// The most values that are observed together.
pub const MOST: usize = 5;
/// Pairs of them.
const PAIRS: usize = MOST * (MOST - 1) / 2;

/// Smallest value with the position that it was met at first, and largest value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extremes {
    /// Smallest value.
    pub min: f64,
    /// Position in the file where the smallest value was met first: it decides between equal ones.
    pub min_at: u64,
    /// What stands there, once somebody has looked it up.
    pub min_label: u64,
    /// Largest value.
    pub max: f64,
}

impl Extremes {
    /// Of nothing.
    pub const NONE: Extremes =
        Extremes { min: f64::INFINITY, min_at: u64::MAX, min_label: 0, max: f64::NEG_INFINITY };

    /// Takes in a block of values that stand at `first`, `first + 1` and so on.
    #[inline(always)]
    pub fn extend(&mut self, values: &[f64], first: u64) {
        let (min, max) = extremes(values);
        // Where it stands is looked up only where it counts.
        if min <= self.min {
            let place = values.iter().position(|&v| v == min).unwrap_or(0);
            self.merge(&Self { min, min_at: first + place as u64, min_label: 0, max });
        }
        self.max = self.max.max(max);
    }

    /// Takes in others. Of equal minima the one with the smaller position stays.
    pub fn merge(&mut self, other: &Self) {
        if other.min < self.min || (other.min == self.min && other.min_at < self.min_at) {
            (self.min, self.min_at, self.min_label) = (other.min, other.min_at, other.min_label);
        }
        self.max = self.max.max(other.max);
    }
}

/// Moments of values that are observed together; `extremes` speak of positions within what was counted.
#[derive(Debug, Clone, PartialEq)]
pub struct Moments {
    /// Number of observations.
    pub count: u64,
    /// Mean of each value.
    pub mean: [f64; MOST],
    /// Sum of squared deviations of each value from its mean.
    pub deviations: [f64; MOST],
    /// Sum of products of the deviations of two values; see [`pair`].
    co_deviations: [f64; PAIRS],
    /// Extremes of each value.
    pub extremes: [Extremes; MOST],
}

/// The place of the pair `i < j` among the pairs.
const fn pair(i: usize, j: usize) -> usize {
    j * (j - 1) / 2 + i
}

impl Default for Moments {
    fn default() -> Self {
        Self {
            count: 0,
            mean: [0.0; MOST],
            deviations: [0.0; MOST],
            co_deviations: [0.0; PAIRS],
            extremes: [Extremes::NONE; MOST],
        }
    }
}

impl Moments {
    /// Takes in a block: `columns[value][observation]`, all of one length. Observation k stands at position `first + k`,
    /// after all that was taken in before.
    #[inline(always)]
    pub fn extend(&mut self, columns: &[&[f64]], first: u64) {
        let mut block = Self { count: columns.first().map_or(0, |c| c.len() as u64), ..Self::default() };
        if block.count == 0 {
            return;
        }
        for (i, column) in columns.iter().enumerate() {
            block.mean[i] = sum(column) / block.count as f64;
            block.deviations[i] = sum_of_products(column, block.mean[i], column, block.mean[i]);
            for (j, other) in columns[..i].iter().enumerate() {
                block.co_deviations[pair(j, i)] =
                    sum_of_products(column, block.mean[i], other, block.mean[j]);
            }
            self.extremes[i].extend(column, first);
        }
        self.merge_first(&block, columns.len());
    }

    /// Takes in others, whose observations come after these.
    pub fn merge(&mut self, other: &Self) {
        self.merge_first(other, MOST);
    }

    /// The same where only the first so many values are there.
    #[inline(always)]
    fn merge_first(&mut self, other: &Self, values: usize) {
        for (mine, theirs) in self.extremes.iter_mut().zip(&other.extremes) {
            mine.merge(theirs);
        }
        if other.count == 0 || self.count == 0 {
            if self.count == 0 {
                let extremes = self.extremes;
                *self = Self { extremes, ..other.clone() };
            }
            return;
        }
        let (n, m) = (self.count as f64, other.count as f64);
        let share = m / (n + m);
        let weight = n * share;
        let mut delta = [0.0; MOST];
        for i in 0..values {
            delta[i] = other.mean[i] - self.mean[i];
            self.mean[i] += delta[i] * share;
            self.deviations[i] += other.deviations[i] + delta[i] * delta[i] * weight;
            for j in 0..i {
                self.co_deviations[pair(j, i)] +=
                    other.co_deviations[pair(j, i)] + delta[i] * delta[j] * weight;
            }
        }
        self.count += other.count;
    }

    /// Standard deviation of the population.
    pub fn sd(&self, value: usize) -> f64 {
        if self.is_steady(value) { 0.0 } else { (self.deviations[value] / self.count as f64).sqrt() }
    }

    /// Whether a value does not vary; the deviations then hold rounding errors of the mean.
    fn is_steady(&self, value: usize) -> bool {
        self.count == 0 || self.extremes[value].min == self.extremes[value].max
    }

    /// Pearson's correlation of two values; `None` where one of them does not vary.
    pub fn correlation(&self, i: usize, j: usize) -> Option<f64> {
        if self.is_steady(i) || self.is_steady(j) {
            return None;
        }
        let product = self.deviations[i].sqrt() * self.deviations[j].sqrt();
        let r = self.co_deviations[pair(i.min(j), i.max(j))] / product;
        r.is_finite().then(|| r.clamp(-1.0, 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(columns: &[&[f64]], first: u64) -> Moments {
        let mut moments = Moments::default();
        moments.extend(columns, first);
        moments
    }

    /// Plain two-pass statistics, the other way round.
    fn plain(x: &[f64]) -> (f64, f64) {
        let mean = x.iter().rev().sum::<f64>() / x.len() as f64;
        let variance = x.iter().rev().map(|v| (v - mean) * (v - mean)).sum::<f64>() / x.len() as f64;
        (mean, variance.sqrt())
    }

    fn noise(n: usize, seed: u64) -> Vec<f64> {
        let mut state = seed;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        (0..n).map(|_| next()).collect()
    }

    #[test]
    fn blocks_of_any_length_merge_to_plain_statistics() {
        let (x, y) = (noise(1000, 1), noise(1000, 2));
        let z: Vec<f64> = x.iter().zip(&y).map(|(x, y)| x + 0.1 * y).collect();
        for step in [1, 3, 8, 64, 999, 1000] {
            let mut all = Moments::default();
            for k in (0..1000).step_by(step) {
                let end = (k + step).min(1000);
                all.merge(&of(&[&x[k..end], &y[k..end], &z[k..end]], k as u64));
            }
            for (i, column) in [&x, &y, &z].into_iter().enumerate() {
                let (mean, sd) = plain(column);
                assert!((all.mean[i] - mean).abs() < 1e-14 && (all.sd(i) - sd).abs() < 1e-14);
                let least = column.iter().copied().fold(f64::INFINITY, f64::min);
                assert_eq!(column[all.extremes[i].min_at as usize], least);
            }
            let r = all.correlation(0, 2).expect("both vary");
            assert!(r > 0.99 && r < 1.0, "{r}");
            assert!(all.correlation(0, 1).expect("both vary").abs() < 0.1);
        }
    }

    #[test]
    fn of_equal_minima_the_first_stays() {
        let mut all = of(&[&[3.0, 1.0, 1.0]], 10);
        all.merge(&of(&[&[1.0, 2.0]], 13));
        assert_eq!((all.extremes[0].min, all.extremes[0].min_at), (1.0, 11));
        let mut late = of(&[&[1.0]], 20);
        late.merge(&of(&[&[1.0]], 5));
        assert_eq!(late.extremes[0].min_at, 5);
    }

    #[test]
    fn what_does_not_vary_has_no_correlation() {
        assert_eq!(of(&[&[1.0, 1.0], &[1.0, 2.0]], 0).correlation(0, 1), None);
    }
}
