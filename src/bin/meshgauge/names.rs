//! The names of summaries.
//!
//! The summary of `pit.inp` is `pit.summary.json`: the name without its compression and mesh extensions. Where two
//! meshes of one folder would share that name, each keeps its whole file name: `pit.inp.summary.json`. Which it is
//! depends on the names alone, not on who came first.

use std::collections::{HashMap, HashSet};
use std::ffi::{OsStr, OsString};
use std::path::Path;

use meshgauge::formats::FORMATS;
use meshgauge::input::mesh_name;

/// What a summary's file name ends with.
pub const SUFFIX: &str = ".summary.json";

/// Whether the file's name has the extension of a mesh format, packed or not.
pub fn has_mesh_extension(file_name: &OsStr) -> bool {
    stem(file_name) != mesh_name(Path::new(file_name), &[])
}

/// The file's name without its compression and mesh extensions.
pub fn stem(file_name: &OsStr) -> OsString {
    let extensions: Vec<_> = FORMATS.iter().flat_map(|format| format.extensions()).copied().collect();
    mesh_name(Path::new(file_name), &extensions)
}

/// The meshes of one folder, to name their summaries so that no two are the same.
#[derive(Debug, Default)]
pub struct Folder {
    meshes: HashSet<OsString>,
    /// Number of meshes by what they might be named: stem or file name.
    taken: HashMap<OsString, u32>,
}

impl Folder {
    /// Adds a mesh by its file name; says whether it is new here and would share a name with another.
    pub fn add(&mut self, file_name: &OsStr) -> bool {
        if !self.meshes.insert(file_name.to_owned()) {
            return false;
        }
        let stem = stem(file_name);
        let mut clash = self.take(&stem);
        if stem != file_name {
            clash |= self.take(file_name);
        }
        clash
    }

    fn take(&mut self, name: &OsStr) -> bool {
        let count = self.taken.entry(name.to_owned()).or_default();
        *count += 1;
        *count > 1
    }

    /// Whether a mesh of this file name was added.
    pub fn contains(&self, file_name: &OsStr) -> bool {
        self.meshes.contains(file_name)
    }

    /// The file name of the summary of a mesh of this folder.
    pub fn summary_name(&self, file_name: &OsStr) -> OsString {
        let stem = stem(file_name);
        let shared = self.taken.get(&stem).is_some_and(|&count| count > 1);
        let mut name = if shared { file_name.to_owned() } else { stem };
        name.push(SUFFIX);
        name
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(file: &str, folder: &[&str]) -> String {
        let mut meshes = Folder::default();
        for name in folder {
            meshes.add(OsStr::new(name));
        }
        meshes.summary_name(OsStr::new(file)).into_string().unwrap_or_default()
    }

    #[test]
    fn a_name_loses_its_mesh_and_compression_extensions() {
        assert_eq!(named("pit.inp", &["pit.inp"]), "pit.summary.json");
        assert_eq!(named("pit.INP.gz", &["pit.INP.gz"]), "pit.summary.json");
        assert_eq!(named("v1.2", &["v1.2"]), "v1.2.summary.json");
        assert_eq!(named(".inp", &[".inp"]), ".inp.summary.json");
    }

    #[test]
    fn meshes_that_would_share_a_name_keep_their_extensions() {
        let folder = ["pit.inp", "pit.msh", "other.msh", "pit.inp.gz"];
        assert_eq!(named("pit.inp", &folder), "pit.inp.summary.json");
        assert_eq!(named("pit.msh", &folder), "pit.msh.summary.json");
        assert_eq!(named("pit.inp.gz", &folder), "pit.inp.gz.summary.json");
        assert_eq!(named("other.msh", &folder), "other.summary.json");
    }

    #[test]
    fn a_stem_that_is_another_files_whole_name_is_not_shared_either() {
        let folder = ["pit.inp", "pit.msh", "pit.inp.inp"];
        let names = folder.map(|file| named(file, &folder));
        assert_eq!(names, ["pit.inp.summary.json", "pit.msh.summary.json", "pit.inp.inp.summary.json"]);
    }
}
