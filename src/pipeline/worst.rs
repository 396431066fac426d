//! The worst elements of a measure: as many as were asked for, whatever the order in which they are offered.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use crate::mesh::Shape;

/// An element that may be among the worst.
#[derive(Debug, Clone, Copy)]
pub(super) struct Candidate {
    pub value: f64,
    /// Its position in the file, which decides between equal values.
    pub position: u64,
    pub label: u64,
    pub region: u32,
    /// Its corners as rows of the node table; the shape says how many.
    pub corners: [u32; Shape::MAX_CORNERS],
}

impl Candidate {
    fn key(&self, other: &Self) -> Ordering {
        self.value.total_cmp(&other.value).then(self.position.cmp(&other.position))
    }
}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        self.key(other)
    }
}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Candidate {}

/// The worst elements so far: never more than were asked for.
#[derive(Debug, Clone)]
pub(super) struct Worst {
    most: usize,
    /// The best of them comes first.
    kept: BinaryHeap<Candidate>,
}

impl Worst {
    /// None yet, of at most `most`.
    pub(super) fn new(most: usize) -> Self {
        Self { most, kept: BinaryHeap::new() }
    }

    /// Whether an element of this value could be among them.
    #[inline]
    pub(super) fn wants(&self, value: f64) -> bool {
        self.kept.len() < self.most || self.kept.peek().is_some_and(|best| value <= best.value)
    }

    /// Takes in an element, if it is among them.
    pub(super) fn offer(&mut self, candidate: Candidate) {
        if self.kept.len() < self.most {
            self.kept.push(candidate);
        } else if let Some(mut best) = self.kept.peek_mut()
            && candidate < *best
        {
            *best = candidate;
        }
    }

    /// Takes in those of another worker.
    pub(super) fn merge(&mut self, other: &Self) {
        other.kept.iter().for_each(|candidate| self.offer(*candidate));
    }

    /// The elements, the worst first.
    pub(super) fn sorted(&self) -> Vec<Candidate> {
        self.kept.clone().into_sorted_vec()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn candidate(value: f64, position: u64) -> Candidate {
        Candidate { value, position, label: position, region: 0, corners: [0; Shape::MAX_CORNERS] }
    }

    #[test]
    fn the_same_elements_are_kept_in_any_order_of_offers() {
        let all: Vec<_> = (0..1000).map(|k| candidate(f64::from(k as u32 * 37 % 50), k)).collect();
        let mut sorted = all.clone();
        sorted.sort();
        for most in [0, 1, 7, 100, 2000] {
            for turn in [0, 1, 499, 999] {
                let (mut one, mut two) = (Worst::new(most), Worst::new(most));
                for (i, k) in (0..1000).map(|i| (i + turn) % 1000).enumerate() {
                    let worker = if i % 3 == 0 { &mut one } else { &mut two };
                    if worker.wants(all[k].value) {
                        worker.offer(all[k]);
                    }
                }
                one.merge(&two);
                assert_eq!(one.sorted(), sorted[..most.min(1000)], "{most} {turn}");
            }
        }
    }
}
