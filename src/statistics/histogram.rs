//! The report's distribution: 100 bins of equal width over [0, 1].

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

/// Counts by bin: bin k holds `k / 100 <= value < (k + 1) / 100`, and 1 is in the last.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Histogram {
    counts: [u64; BINS],
}

impl Default for Histogram {
    fn default() -> Self {
        Self { counts: [0; BINS] }
    }
}

impl Histogram {
    /// Counts a value of [0, 1].
    #[inline]
    pub fn record(&mut self, value: f64) {
        self.counts[bin(value)] += 1;
    }

    /// Adds the counts of another histogram.
    pub fn merge(&mut self, other: &Self) {
        for (mine, theirs) in self.counts.iter_mut().zip(&other.counts) {
            *mine += theirs;
        }
    }

    /// Counts by bin.
    pub fn counts(&self) -> &[u64; BINS] {
        &self.counts
    }
}

/// The bin of a value. Adding `ROUND` leaves the nearest whole number in the low bits of the double, without a
/// conversion; that guess, and any product that rounds over an edge (0.29 * 100 < 29), is one bin off at most.
#[inline]
fn bin(value: f64) -> usize {
    const ROUND: f64 = 1.5 * (1u64 << 52) as f64;
    let guess = ((value * BINS as f64 - 0.5 + ROUND).to_bits() & 0x7f) as usize;
    let guess = guess.min(BINS - 1);
    let low = usize::from(value < EDGES[guess]);
    let high = usize::from(value >= EDGES[guess + 1] && guess + 1 < BINS);
    guess - low + high
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_on_an_edge_are_in_the_upper_bin_and_one_is_in_the_last() {
        for k in 0..BINS {
            let edge: f64 = format!("0.{k:02}").parse().expect("a number");
            assert_eq!(bin(edge), k, "{edge}");
            assert_eq!(bin(edge.next_down().max(0.0)), k.saturating_sub(1), "under {edge}");
        }
        assert_eq!(bin(1.0), 99);
        assert_eq!(bin(1.0f64.next_down()), 99);
    }
}
