//! Which region elements are in: the part or instance, and the set that their keyword names with them; where it names none,
//! the set that a section is assigned to, or in decks without sections the first `*ELSET` that lists them.

use std::collections::{BTreeMap, HashMap};
use std::ops::Range;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use super::sets::{Set, SetHead};
use crate::error::{Error, Result};
use crate::formats::ElementSink;
use crate::formats::abaqus::keywords::plain;
use crate::input::{Budget, Source};

/// Most lists of elements, and sections, that are kept of a part.
const MOST: usize = 1 << 16;
/// About what a run of numbers takes.
const RUN_BYTES: u64 = 64;

/// What a part says of its element sets.
#[derive(Default)]
pub(in crate::formats::abaqus) struct Listed {
    lists: Vec<(SetHead, Arc<Source>, Range<u64>)>,
    sections: Vec<Vec<u8>>,
}

impl Listed {
    /// Takes in the data of an `*ELSET`.
    pub(in crate::formats::abaqus) fn list(&mut self, head: SetHead, source: Arc<Source>, range: Range<u64>) {
        if !head.of_nodes && self.lists.len() < MOST {
            self.lists.push((head, source, range));
        }
    }

    /// Takes in the set that a section is assigned to.
    pub(in crate::formats::abaqus) fn section(&mut self, set: Vec<u8>) {
        if self.sections.len() < MOST {
            self.sections.push(set);
        }
    }

    /// Reads the lists: which runs of elements are in which set. Of several sets the first counts.
    fn read(&self, budget: &Budget) -> Result<Sets> {
        let mut known: HashMap<Vec<u8>, Set> = HashMap::new();
        let mut order = Vec::new();
        for (head, source, range) in &self.lists {
            let ranges = head.read(source, range.clone(), &known)?;
            if !known.contains_key(&head.name) {
                order.push(head.name.clone());
            }
            known.entry(head.name.clone()).or_default().add_as(ranges, false);
        }
        let wanted = if self.sections.is_empty() { &order } else { &self.sections };
        let mut sets = Sets::default();
        for name in wanted {
            let Some(set) = known.get(name) else { continue };
            let number = sets.names.len() as u32;
            sets.names.push(plain(name));
            for run in set.runs() {
                if !budget.take(RUN_BYTES) {
                    return Err(Error::limit("memory for the lists of *ELSET", "the run's budget"));
                }
                sets.add(run, number);
            }
        }
        Ok(sets)
    }
}

/// Sets by element.
#[derive(Default)]
pub(in crate::formats::abaqus) struct Sets {
    names: Vec<String>,
    /// First and last number of each run, and its set; runs do not overlap.
    runs: BTreeMap<u64, (u64, u32)>,
}

impl Sets {
    /// Adds a run of numbers as far as they are in no set yet.
    fn add(&mut self, (first, last): (u64, u64), set: u32) {
        let before = self.runs.range(..=first).next_back().map(|(_, (last, _))| *last);
        let mut from = before.map_or(first, |known| first.max(known.saturating_add(1)));
        let inner: Vec<_> =
            self.runs.range(from..).take_while(|run| *run.0 <= last).map(|r| (*r.0, r.1.0)).collect();
        for (start, end) in inner {
            if from < start {
                self.runs.insert(from, (start - 1, set));
            }
            from = end.saturating_add(1);
        }
        if from <= last {
            self.runs.insert(from, (last, set));
        }
    }

    /// The set of an element, from 1; 0 where it is in none.
    fn of(&self, element: u64) -> u64 {
        match self.runs.range(..=element).next_back() {
            Some((_, (last, set))) if element <= *last => u64::from(*set) + 1,
            _ => 0,
        }
    }
}

/// The sets of a part, once the deck was read to its end.
#[derive(Default)]
pub(in crate::formats::abaqus) struct SetsOfPart {
    listed: OnceLock<(Listed, Budget)>,
    read: Mutex<Option<Arc<Sets>>>,
}

impl SetsOfPart {
    /// All that the part says of sets.
    pub(in crate::formats::abaqus) fn fill(&self, listed: Listed, budget: &Budget) {
        // What comes second says nothing new.
        let _ = self.listed.set((listed, budget.clone()));
    }

    fn sets(&self) -> Result<Arc<Sets>> {
        let mut read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(sets) = &*read {
            return Ok(Arc::clone(sets));
        }
        let sets = match self.listed.get() {
            Some((listed, budget)) => Arc::new(listed.read(budget)?),
            None => Arc::default(),
        };
        *read = Some(Arc::clone(&sets));
        Ok(sets)
    }
}

/// Where elements belong.
#[derive(Clone)]
pub(in crate::formats::abaqus) struct Belonging {
    /// The part or instance.
    pub(in crate::formats::abaqus) owner: Option<Arc<str>>,
    /// The set that all of them are in.
    pub(in crate::formats::abaqus) set: Option<Arc<str>>,
    /// The sets of the part.
    pub(in crate::formats::abaqus) sets: Arc<SetsOfPart>,
}

impl Belonging {
    /// Puts the elements that follow into their region. Where each must be asked for, as somebody wants to know, gives the
    /// sets to ask.
    pub(in crate::formats::abaqus) fn begin(&self, out: &mut ElementSink<'_>) -> Result<Option<Arc<Sets>>> {
        if self.set.is_none() && out.wants_regions() {
            let sets = self.sets.sets()?;
            if !sets.names.is_empty() {
                return Ok(Some(sets));
            }
        }
        out.region(0, || self.region(self.set.as_deref()))?;
        Ok(None)
    }

    /// Puts the element that follows into its region.
    pub(in crate::formats::abaqus) fn enter(
        &self,
        sets: &Sets,
        element: u64,
        out: &mut ElementSink<'_>,
    ) -> Result<()> {
        let key = sets.of(element);
        out.region(key, || self.region(sets.names.get((key as usize).wrapping_sub(1)).map(String::as_str)))
    }

    /// `STEEL`, `PART-1-1`, `PART-1-1.STEEL`; nothing where there is neither.
    fn region(&self, set: Option<&str>) -> String {
        match (self.owner.as_deref(), set) {
            (Some(owner), Some(set)) => format!("{owner}.{set}"),
            (owner, set) => owner.or(set).unwrap_or_default().to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_several_sets_the_first_counts() {
        let mut sets = Sets::default();
        for (run, set) in [((10, 19), 0), ((30, 39), 0), ((5, 34), 1), ((1, 50), 2), ((12, 12), 3)] {
            sets.add(run, set);
        }
        let found: Vec<_> = [0, 1, 4, 5, 9, 10, 19, 20, 29, 30, 39, 40, 50, 51].map(|n| sets.of(n)).into();
        assert_eq!(found, [0, 3, 3, 2, 2, 1, 1, 2, 2, 1, 1, 3, 3, 0]);
    }
}
