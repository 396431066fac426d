//! Which versions are done with, remembered so that a scan need not ask the database about each file each time.

use std::collections::HashSet;
use std::hash::{BuildHasherDefault, Hasher};

use crate::state::Id;

/// How many ids beyond twice those of the last scan may be kept.
const SURPLUS: usize = 1000;

/// Ids of versions that are done with: 9 to 18 bytes each, for a file that stands in the drop.
#[derive(Debug, Default)]
pub struct Done {
    ids: HashSet<u64, BuildHasherDefault<Bits>>,
}

impl Done {
    /// Whether the version is known to be done with.
    pub fn contains(&self, id: Id) -> bool {
        self.ids.contains(&id.short())
    }

    /// The version is done with.
    pub fn insert(&mut self, id: Id) {
        self.ids.insert(id.short());
    }

    /// Forgets everything where most of it is of files that went away; the database knows the rest.
    pub fn prune(&mut self, present: usize) {
        if self.ids.len() > 2 * present + SURPLUS {
            *self = Self::default();
        }
    }
}

/// Ids are hashes already.
#[derive(Debug, Default)]
struct Bits(u64);

impl Hasher for Bits {
    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = self.0.rotate_left(8) ^ u64::from(byte);
        }
    }

    fn write_u64(&mut self, id: u64) {
        self.0 = id;
    }

    fn finish(&self) -> u64 {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;
    use crate::identity::Identity;

    #[test]
    fn what_is_done_is_remembered_until_most_of_it_went_away() {
        let id = |i: usize| Id::of(&PathBuf::from(format!("{i}.msh")), &Identity::default());
        let mut done = Done::default();
        (0..4000).for_each(|i| done.insert(id(i)));
        done.prune(2000);
        assert!((0..4000).all(|i| done.contains(id(i))) && !done.contains(id(4000)));
        done.prune(1000);
        assert!(!done.contains(id(0)));
    }
}
