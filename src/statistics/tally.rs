//! Counts by place, for loops that do little else than count.
//!
//! The hot loop counts in sixteen bits: a table that four measures share the first-level cache with is a quarter as large.
//! Before a place could overflow all are added to the wide counts.

/// Values whose places are worked out side by side before they are counted one by one.
const STEP: usize = 64;

/// Counts by place.
#[derive(Debug, Clone)]
pub(super) struct Tally {
    /// What was counted since the last time that all was added to `counts`.
    recent: Vec<u16>,
    /// How many values that were.
    pending: usize,
    counts: Vec<u64>,
}

impl Tally {
    /// No counts, for so many places.
    pub(super) fn new(places: usize) -> Self {
        Self { recent: vec![0; places], pending: 0, counts: vec![0; places] }
    }

    /// Counts values by whatever `place` says.
    #[inline(always)]
    pub(super) fn count_by(&mut self, values: &[f64], place: impl Fn(f64) -> u32) {
        let mut places = [0; STEP];
        for values in values.chunks(STEP) {
            for (at, value) in places.iter_mut().zip(values) {
                *at = place(*value);
            }
            if self.pending + STEP > usize::from(u16::MAX) {
                self.settle();
            }
            self.pending += values.len();
            let recent = &mut *self.recent;
            for at in &places[..values.len()] {
                recent[*at as usize] += 1;
            }
        }
    }

    /// Adds `count` at a place.
    pub(super) fn add(&mut self, place: usize, count: u64) {
        self.counts[place] += count;
    }

    /// Counts from the place `first` on.
    pub(super) fn from(&self, first: usize) -> impl Iterator<Item = u64> {
        self.counts[first..]
            .iter()
            .zip(&self.recent[first..])
            .map(|(count, recent)| count + u64::from(*recent))
    }

    /// Adds the counts of another, made for as many places.
    pub(super) fn merge(&mut self, other: &Self) {
        for (mine, theirs) in self.counts.iter_mut().zip(other.from(0)) {
            *mine += theirs;
        }
    }

    #[cold]
    fn settle(&mut self) {
        // Most places are empty: values are near each other.
        for (counts, recent) in self.counts.chunks_mut(STEP).zip(self.recent.chunks_mut(STEP)) {
            if recent.iter().fold(0, |all, count| all | count) > 0 {
                for (count, recent) in counts.iter_mut().zip(recent) {
                    *count += u64::from(std::mem::take(recent));
                }
            }
        }
        self.pending = 0;
    }
}

impl PartialEq for Tally {
    fn eq(&self, other: &Self) -> bool {
        self.from(0).eq(other.from(0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_that_gets_everything_does_not_overflow() {
        let mut tally = Tally::new(3);
        let mut twice = Tally::new(3);
        for _ in 0..3000 {
            tally.count_by(&[1.0; 77], |value| value as u32);
        }
        tally.count_by(&[2.0], |value| value as u32);
        assert_eq!(tally.from(0).collect::<Vec<_>>(), [0, 231_000, 1]);
        twice.merge(&tally);
        twice.merge(&tally);
        twice.add(0, 5);
        assert_eq!(twice.from(0).collect::<Vec<_>>(), [5, 462_000, 2]);
    }
}
