//! Regions: what a file divides its elements into. Parts, materials, physical groups, domains, as its format has them.

use std::collections::HashMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::error::{Error, Result};

/// Longer names are cut: they come from files.
const LONGEST_NAME: usize = 256;

/// The region of elements that are in none.
pub const NO_REGION: u32 = 0;

/// The names of the regions met so far, each with a number from 1 on. Several threads add to them, so that the numbers
/// differ from run to run: what is shown is put in order by name.
#[derive(Debug)]
pub struct Regions {
    most: usize,
    known: Mutex<Known>,
}

#[derive(Debug, Default)]
struct Known {
    names: Vec<String>,
    numbers: HashMap<String, u32>,
}

impl Regions {
    /// None yet; more than `most` are an error.
    pub fn new(most: usize) -> Self {
        Self { most: most.min(u32::MAX as usize - 1), known: Mutex::default() }
    }

    /// The number of the region with this name.
    pub fn number(&self, mut name: String) -> Result<u32> {
        if let Some((end, _)) = name.char_indices().nth(LONGEST_NAME) {
            name.truncate(end);
        }
        let mut known = self.known();
        if let Some(number) = known.numbers.get(&name) {
            return Ok(*number);
        }
        if known.names.len() >= self.most {
            return Err(Error::limit("number of regions (limits.regions)", self.most));
        }
        known.names.push(name.clone());
        let number = known.names.len() as u32;
        known.numbers.insert(name, number);
        Ok(number)
    }

    /// The name of a region; nothing for [`NO_REGION`].
    pub fn name(&self, number: u32) -> Option<String> {
        self.known().names.get((number as usize).checked_sub(1)?).cloned()
    }

    fn known(&self) -> MutexGuard<'_, Known> {
        // A thread that panicked here has left whole names behind.
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_keeps_its_number_and_too_many_are_an_error() {
        let regions = Regions::new(2);
        let number = |name: &str| regions.number(name.to_owned());
        assert_eq!(
            (number("steel").ok(), number("pit").ok(), number("steel").ok()),
            (Some(1), Some(2), Some(1))
        );
        assert!(number("air").is_err_and(|e| e.to_string().contains("regions")));
        let long = Regions::new(1);
        assert_eq!(long.number("é".repeat(1000)).ok(), Some(1));
        assert_eq!(long.name(1).map(|name| name.chars().count()), Some(LONGEST_NAME));
        assert_eq!((regions.name(2).as_deref(), regions.name(NO_REGION)), (Some("pit"), None));
    }
}
