//! Reads a folder through: what stands in it.
//!
//! Files are looked at and not opened, so a FIFO cannot hold us up. Names of files that are still being written are
//! passed over, as are our own results. A folder that is one mesh, such as a case of OpenFOAM, stands among the files and
//! is not looked into. What is found is told as it is found, so a folder of a million files takes no more memory than a
//! small one.

use std::ffi::{OsStr, OsString};
use std::fs::{self, Metadata, OpenOptions};
use std::io;
use std::ops::ControlFlow;
use std::os::unix::fs::{FileTypeExt, MetadataExt, OpenOptionsExt};
use std::path::{Path, PathBuf};

use meshgauge::formats;
use rustix::fs::OFlags;

use crate::config::{Symlinks, Watch};
use crate::identity::Identity;

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

    /// What stands under the name of a file now; `None` if nothing does. A look that is `fresh` opens the file, because
    /// network file systems ask the server then, and else answer from memory.
    pub fn look(&self, path: &Path, fresh: bool) -> Option<Found> {
        if !self.is_reached_without_links(path) {
            return None;
        }
        if fresh {
            // A FIFO must not hold us up.
            let flags = (OFlags::NONBLOCK | OFlags::NOFOLLOW | OFlags::NOCTTY).bits().cast_signed();
            let file = OpenOptions::new().read(true).custom_flags(flags).open(self.root.join(path));
            if let Ok(data) = file.and_then(|file| file.metadata())
                && data.is_file()
            {
                return Some(Found::File(Identity::from(&data)));
            }
        }
        let data = fs::symlink_metadata(self.root.join(path)).ok()?;
        let mesh = data.is_dir().then(|| self.mesh_of_folder(path)).flatten();
        Some(mesh.map_or_else(|| self.found(path, &data), |(found, _)| found))
    }

    /// Whether the folders on the way to a file are folders still: a scan does not follow links to folders, and one
    /// that took the place of a folder since the last scan must not lead us out.
    fn is_reached_without_links(&self, path: &Path) -> bool {
        let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) else { return true };
        let here = |path: &Path| fs::canonicalize(path);
        here(&self.root)
            .is_ok_and(|root| here(&self.root.join(folder)).is_ok_and(|way| way == root.join(folder)))
    }

    /// What the mesh is that a folder holds, and its files, if the folder is one mesh.
    fn mesh_of_folder(&self, path: &Path) -> Option<(Found, Vec<PathBuf>)> {
        let path = self.root.join(path);
        // Where it cannot be read the reader will say why.
        let files = formats::files(&path)?.unwrap_or_default();
        let leads_out = |file: &PathBuf| self.symlinks != Symlinks::All && !self.is_inside(file);
        if files.iter().any(|file| file.exists() && leads_out(file)) {
            return Some((Found::Other("a mesh with files outside of the folder"), files));
        }
        Identity::of(&path).ok().map(|identity| (Found::File(identity), files))
    }

    /// Whether a file belongs to a mesh that another file stands for.
    fn is_part(&self, path: &Path) -> bool {
        let path = self.root.join(path);
        let files = formats::files(&path).and_then(Result::ok);
        files.is_some_and(|files| files.first().and_then(|main| main.file_name()) != path.file_name())
    }

    /// Tells of the folder that the files of a mesh lie in: its changes are worth a look.
    fn follow_mesh(
        &self,
        files: &[PathBuf],
        tell: &mut dyn FnMut(Sight) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let folder = files.first().and_then(|file| file.parent());
        if let Some(folder) = folder
            && let (Ok(inner), Ok(data)) = (folder.strip_prefix(&self.root), fs::metadata(folder))
        {
            tell(Sight::Folder(inner.to_owned(), place(&data)))?;
        }
        ControlFlow::Continue(())
    }

    /// Whether a file lies in the folder that is walked through, wherever symbolic links lead.
    fn is_inside(&self, file: &Path) -> bool {
        let root = fs::canonicalize(&self.root);
        root.and_then(|root| Ok(fs::canonicalize(file)?.starts_with(root))).unwrap_or(false)
    }

    fn found(&self, path: &Path, data: &Metadata) -> Found {
        let kind = data.file_type();
        if kind.is_file() {
            Found::File(data.into())
        } else if kind.is_symlink() {
            self.follow(&self.root.join(path))
        } else if kind.is_fifo() {
            Found::Other("a FIFO")
        } else if kind.is_socket() {
            Found::Other("a socket")
        } else if kind.is_dir() {
            Found::Other("a folder")
        } else {
            Found::Other("a device")
        }
    }

    fn follow(&self, link: &Path) -> Found {
        if self.symlinks == Symlinks::None {
            return Found::Other("a symbolic link");
        }
        let Ok(data) = fs::metadata(link) else {
            return Found::Other("a symbolic link that leads nowhere");
        };
        if !data.is_file() {
            Found::Other("a symbolic link to something other than a file")
        } else if self.symlinks == Symlinks::Inside && !self.is_inside(link) {
            Found::Other("a symbolic link that leads out of the folder")
        } else {
            Found::File(Identity::from(&data))
        }
    }
}

/// The first of the patterns that a name fits.
pub fn ignored_by<'p>(patterns: &'p [String], name: &OsStr) -> Option<&'p str> {
    patterns.iter().find(|pattern| fits(pattern, name)).map(String::as_str)
}

/// Whether a name fits a pattern in which `*` stands for anything.
pub fn fits(pattern: &str, name: &OsStr) -> bool {
    matches(pattern.as_bytes(), name.as_encoded_bytes())
}

/// Device and inode: the same for every name that leads to one file.
fn place(data: &Metadata) -> (u64, u64) {
    (data.dev(), data.ino())
}

fn matches(pattern: &[u8], name: &[u8]) -> bool {
    match pattern.iter().position(|&b| b == b'*') {
        None => pattern == name,
        Some(star) => {
            let (head, tail) = (&pattern[..star], &pattern[star + 1..]);
            name.starts_with(head) && (head.len()..=name.len()).any(|from| matches(tail, &name[from..]))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_know_one_sign() {
        let cases = [
            (".*", ".nfs0001", true),
            (".*", "pit.inp", false),
            ("*.tmp", "pit.inp.tmp", true),
            ("*.tmp", "tmp", false),
            ("*~", "pit.inp~", true),
            ("a*b*c", "a-b-b-c", true),
            ("a*b*c", "a-c-b", false),
            ("*", "", true),
        ];
        for (pattern, name, expected) in cases {
            assert_eq!(matches(pattern.as_bytes(), name.as_bytes()), expected, "{pattern} {name}");
        }
    }

    #[test]
    fn a_folder_that_became_a_link_is_not_followed() {
        let (folder, outside) =
            (tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("another"));
        fs::create_dir(folder.path().join("sub")).expect("a folder");
        for place in [folder.path().join("sub"), outside.path().to_owned()] {
            fs::write(place.join("a.msh"), "x").expect("written");
        }
        let walk = Walk::new(folder.path(), &Watch::default());
        assert!(walk.look(Path::new("sub/a.msh"), false).is_some());
        fs::remove_dir_all(folder.path().join("sub")).expect("removed");
        std::os::unix::fs::symlink(outside.path(), folder.path().join("sub")).expect("linked");
        assert_eq!(walk.look(Path::new("sub/a.msh"), false), None);
    }

    #[test]
    fn a_link_out_of_the_folder_is_not_followed_by_default() {
        let outside = tempfile::NamedTempFile::new().expect("a file");
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("in.msh"), "x").expect("written");
        std::os::unix::fs::symlink(outside.path(), folder.path().join("out.msh")).expect("linked");
        std::os::unix::fs::symlink("in.msh", folder.path().join("to-in.msh")).expect("linked");
        std::os::unix::fs::symlink(".", folder.path().join("loop")).expect("linked");
        let scan = Walk::new(folder.path(), &Watch::default()).scan();
        let regular: Vec<_> = scan.files.iter().map(|(_, f)| matches!(f, Found::File(_))).collect();
        assert_eq!(regular, [true, false, false, true], "in, loop, out, to-in");
    }
}
