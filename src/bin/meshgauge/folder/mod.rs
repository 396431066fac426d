//! Reads a folder through: what stands in it.
//!
//! Files are looked at and not opened, so a FIFO cannot hold us up. Names of files that are still being written are
//! passed over, as are our own results. A folder that is one mesh, such as a case of OpenFOAM, stands among the files and
//! is not looked into. What is found is told as it is found, so a folder of a million files takes no more memory than a
//! small one.

mod looking;
mod pattern;

use std::ffi::OsString;
use std::fs::{self, Metadata};
use std::io;
use std::ops::ControlFlow;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

use crate::config::{Symlinks, Watch};
use crate::identity::Identity;

pub use pattern::{fits, ignored_by};

/// So many names of a folder are read before they are looked at, in their order.
const NAMES_AT_A_TIME: usize = 4096;

/// How a folder is read through.
#[derive(Debug, Clone)]
pub struct Walk {
    root: PathBuf,
    /// Where the walk begins, within the root.
    start: PathBuf,
    depth: usize,
    symlinks: Symlinks,
    ignore: Vec<String>,
    excluded: Vec<PathBuf>,
    barred: Vec<PathBuf>,
}

/// What a walk comes upon; paths are within the root.
#[derive(Debug)]
pub enum Sight {
    /// A file, or something else that is no folder.
    File(PathBuf, Found),
    /// A folder, with its device and inode, before what stands in it.
    Folder(PathBuf, (u64, u64)),
    /// Something that could not be looked at.
    Problem(PathBuf, io::Error),
}

/// What a folder holds.
#[derive(Default)]
pub struct Scan {
    /// Files by their path within the folder, in the order of the names.
    pub files: Vec<(PathBuf, Found)>,
    /// What could not be looked at.
    pub problems: Vec<(PathBuf, io::Error)>,
}

/// What stands under a name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Found {
    /// A regular file, or a mesh that is several in a folder.
    File(Identity),
    /// Anything else, in words.
    Other(&'static str),
}

impl Walk {
    /// A walk through `root` by the rules of the configuration.
    pub fn new(root: &Path, rules: &Watch) -> Self {
        Self {
            root: root.to_owned(),
            start: PathBuf::new(),
            depth: rules.depth,
            symlinks: rules.symlinks,
            ignore: rules.ignore.clone(),
            excluded: Vec::new(),
            barred: Vec::new(),
        }
    }

    /// Leaves out the file or folder at `path`, whatever name leads to it.
    pub fn exclude(&mut self, path: &Path) {
        self.excluded.push(path.to_owned());
    }

    /// Begins at the sub-folder `start`, and leaves out the sub-folders in `barred` without so much as a look.
    pub fn part(&self, start: PathBuf, barred: Vec<PathBuf>) -> Self {
        Self { start, barred, ..self.clone() }
    }

    /// The folder that is walked through.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Reads the folder through, and keeps it all.
    pub fn scan(&self) -> Scan {
        let mut scan = Scan::default();
        let _ = self.each(&mut |sight| {
            match sight {
                Sight::File(path, found) => scan.files.push((path, found)),
                Sight::Problem(path, error) => scan.problems.push((path, error)),
                Sight::Folder(..) => {}
            }
            ControlFlow::Continue(())
        });
        scan.files.sort_by(|a, b| a.0.cmp(&b.0));
        scan
    }

    /// Reads the folder through, and tells each thing as it is found, until told to stop.
    pub fn each(&self, tell: &mut dyn FnMut(Sight) -> ControlFlow<()>) -> ControlFlow<()> {
        let excluded = self.excluded.iter().filter_map(|path| fs::metadata(path).ok());
        let excluded: Vec<_> = excluded.map(|data| place(&data)).collect();
        // Folders that are still to be read, the next one last.
        let mut pending = vec![(self.start.clone(), self.start.components().count())];
        while let Some((folder, depth)) = pending.pop() {
            let mut below = Vec::new();
            match self.read(&folder, &excluded, tell, &mut below) {
                Ok(flow) => flow?,
                Err(error) => {
                    tell(Sight::Problem(folder, error))?;
                    continue;
                }
            }
            if depth + 1 < self.depth {
                below.sort_by(|a, b| b.cmp(a));
                pending.extend(below.into_iter().map(|path| (path, depth + 1)));
            } else if !below.is_empty() {
                let cause = io::Error::other("its sub-folders lie deeper than the limit on depth");
                tell(Sight::Problem(folder, cause))?;
            }
        }
        ControlFlow::Continue(())
    }

    /// Reads one folder: files are told, its sub-folders go to `below`.
    fn read(
        &self,
        folder: &Path,
        excluded: &[(u64, u64)],
        tell: &mut dyn FnMut(Sight) -> ControlFlow<()>,
        below: &mut Vec<PathBuf>,
    ) -> io::Result<ControlFlow<()>> {
        let here = self.root.join(folder);
        let data = fs::metadata(&here)?;
        if excluded.contains(&place(&data)) {
            return Ok(ControlFlow::Continue(()));
        }
        let mut entries = fs::read_dir(&here)?;
        if tell(Sight::Folder(folder.to_owned(), place(&data))).is_break() {
            return Ok(ControlFlow::Break(()));
        }
        loop {
            let mut names = Vec::new();
            for entry in entries.by_ref().take(NAMES_AT_A_TIME) {
                names.push(entry?.file_name());
            }
            if names.is_empty() {
                return Ok(ControlFlow::Continue(()));
            }
            names.sort();
            for name in names {
                if self.meet(folder, name, excluded, tell, below).is_break() {
                    return Ok(ControlFlow::Break(()));
                }
            }
        }
    }

    /// Looks at one entry of a folder.
    fn meet(
        &self,
        folder: &Path,
        name: OsString,
        excluded: &[(u64, u64)],
        tell: &mut dyn FnMut(Sight) -> ControlFlow<()>,
        below: &mut Vec<PathBuf>,
    ) -> ControlFlow<()> {
        let path = folder.join(&name);
        if ignored_by(&self.ignore, &name).is_some() || self.barred.contains(&path) {
            return ControlFlow::Continue(());
        }
        let data = match fs::symlink_metadata(self.root.join(&path)) {
            // It went away since the folder was read.
            Err(error) if error.kind() == io::ErrorKind::NotFound => return ControlFlow::Continue(()),
            Err(error) => return tell(Sight::Problem(path, error)),
            Ok(data) => data,
        };
        if excluded.contains(&place(&data)) {
            return ControlFlow::Continue(());
        }
        if !data.is_dir() {
            if self.is_part(&path) {
                return ControlFlow::Continue(());
            }
            let found = self.found(&path, &data);
            return tell(Sight::File(path, found));
        }
        let Some((found, files)) = self.mesh_of_folder(&path) else {
            below.push(path);
            return ControlFlow::Continue(());
        };
        self.follow_mesh(&files, tell)?;
        tell(Sight::File(path, found))
    }
}

/// Device and inode: the same for every name that leads to one file.
fn place(data: &Metadata) -> (u64, u64) {
    (data.dev(), data.ino())
}
