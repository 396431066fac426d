//! What the producer of a file says of it: whole, not yet, or nothing.

use std::ffi::OsStr;
use std::fs;
use std::os::unix::fs::MetadataExt;
use std::path::Path;

use crate::config::{Done, Watch};
use crate::identity::Identity;

/// The producer's word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Word {
    /// None: the file must stand still.
    None,
    /// The file is whole.
    Whole,
    /// The file is not to be touched yet.
    NotYet,
}

/// How producers give their word.
#[derive(Debug, Clone)]
pub struct Producer {
    /// Endings of the files that say that the file beside them is whole; none where nobody is asked.
    sidecars: Vec<String>,
}

impl Producer {
    /// As the configuration says.
    pub fn new(watch: &Watch) -> Self {
        let sidecars = if watch.done == Done::Sidecar { watch.sidecars.clone() } else { Vec::new() };
        Self { sidecars }
    }

    /// Whether the file is not a mesh but somebody's word about one.
    pub fn is_word(&self, name: &OsStr) -> bool {
        let name = name.as_encoded_bytes();
        self.sidecars.iter().any(|ending| name.ends_with(ending.as_bytes()))
    }

    /// The word about the file at `path`. A word that is older than the file is about an earlier version: this one must
    /// stand still.
    pub fn word(&self, path: &Path, identity: &Identity) -> Word {
        if self.sidecars.is_empty() {
            return Word::None;
        }
        let mut word = Word::NotYet;
        for ending in &self.sidecars {
            let mut sidecar = path.as_os_str().to_owned();
            sidecar.push(ending);
            let Ok(data) = fs::metadata(sidecar) else { continue };
            if (data.ctime(), data.ctime_nsec()) >= identity.changed {
                return Word::Whole;
            }
            word = Word::None;
        }
        word
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_counts_if_it_came_after_the_file() {
        let folder = tempfile::tempdir().expect("a folder");
        let (mesh, sidecar) = (folder.path().join("a.msh"), folder.path().join("a.msh.ok"));
        let producer = Producer::new(&Watch { done: Done::Sidecar, ..Watch::default() });
        let word = || {
            let data = fs::metadata(&mesh).expect("a mesh");
            producer.word(&mesh, &Identity::from(&data))
        };
        fs::write(&mesh, "x").expect("written");
        assert_eq!(word(), Word::NotYet);
        fs::write(&sidecar, "").expect("written");
        assert_eq!(word(), Word::Whole);
        // Times of files are as coarse as the kernel's clock.
        while fs::metadata(&mesh).expect("a mesh").ctime_nsec()
            == fs::metadata(&sidecar).expect("a word").ctime_nsec()
        {
            fs::write(&mesh, "xy").expect("written");
        }
        assert_eq!(word(), Word::None);
        assert!(producer.is_word(OsStr::new("a.msh.ok")) && !producer.is_word(OsStr::new("a.msh")));
        assert_eq!(Producer::new(&Watch::default()).word(&mesh, &Identity::default()), Word::None);
    }
}
