//! How far two histograms lie apart.

/// The Wasserstein-1 distance between two distributions on \[0, 1\], told by direction: how much mass has to move how
/// far. Up is towards 1.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Shift {
    /// The part of the distance that moves mass up.
    pub up: f64,
    /// The part of the distance that moves mass down.
    pub down: f64,
}

impl Shift {
    /// The Wasserstein-1 distance: the area between the two cumulative distributions.
    pub fn distance(self) -> f64 {
        self.up + self.down
    }
}

/// The shift that turns one histogram into the other. Both have the same bins of equal width over \[0, 1\] and are
/// normalised by their own sums, so meshes of different sizes can be compared. Its resolution is that of the bins.
///
/// `None` where the numbers of bins differ, or where a histogram is empty.
pub fn shift(base: &[u64], new: &[u64]) -> Option<Shift> {
    let sum = |bins: &[u64]| bins.iter().map(|&count| count as f64).sum::<f64>();
    let (all_base, all_new) = (sum(base), sum(new));
    if base.len() != new.len() || all_base == 0.0 || all_new == 0.0 {
        return None;
    }
    let width = 1.0 / base.len() as f64;
    let (mut below_base, mut below_new) = (0.0, 0.0);
    let mut shift = Shift::default();
    for (&base, &new) in base.iter().zip(new) {
        below_base += base as f64;
        below_new += new as f64;
        let gap = below_new / all_new - below_base / all_base;
        if gap > 0.0 {
            shift.down += gap * width;
        } else {
            shift.up -= gap * width;
        }
    }
    Some(shift)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bins(at: &[(usize, u64)]) -> Vec<u64> {
        let mut bins = vec![0; 100];
        for &(bin, count) in at {
            bins[bin] = count;
        }
        bins
    }

    #[test]
    fn distances_known_from_the_definition() {
        let rows = [
            // (base, new, up, down)
            (bins(&[(50, 10)]), bins(&[(50, 3)]), 0.0, 0.0),
            (bins(&[(50, 1)]), bins(&[(60, 1)]), 0.1, 0.0),
            (bins(&[(99, 4)]), bins(&[(0, 8)]), 0.0, 0.99),
            (bins(&[(50, 4)]), bins(&[(40, 1), (50, 2), (60, 1)]), 0.025, 0.025),
            (bins(&[(80, 99_999)]), bins(&[(80, 99_998), (0, 1)]), 0.0, 0.8 / 99_999.0),
        ];
        for (base, new, up, down) in rows {
            let found = shift(&base, &new).expect("of equal length, not empty");
            assert!(
                (found.up - up).abs() < 1e-12 && (found.down - down).abs() < 1e-12,
                "{found:?} {up} {down}"
            );
            let back = shift(&new, &base).expect("of equal length, not empty");
            assert!(
                (back.up - found.down).abs() < 1e-12 && (back.distance() - found.distance()).abs() < 1e-12
            );
        }
    }

    #[test]
    fn what_cannot_be_compared_has_no_distance() {
        assert_eq!(shift(&[1, 2], &[1, 2, 3]), None);
        assert_eq!(shift(&[0, 0], &[1, 2]), None);
        assert_eq!(shift(&[], &[]), None);
        assert!(shift(&[u64::MAX; 100], &[u64::MAX; 100]).is_some_and(|s| s.distance() == 0.0));
    }
}
