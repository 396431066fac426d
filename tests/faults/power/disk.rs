//! A disk that promises no more than POSIX does: data are there once their file was synced, names once their folder was.
//!
//! Of what was not synced, names of one folder come in order, as in the journal of a file system; what was written behind
//! the end of a file may be there up to any byte, and zeros after; what was written elsewhere may be there or not.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

use super::trace::Step;
use crate::tools::Random;

/// What the power took of that which was not synced.
#[derive(Debug, Clone, Copy)]
pub enum Lost {
    /// All.
    All,
    /// Nothing, as when only the process is killed.
    Nothing,
    /// Data of files, not names: files without a byte.
    Data,
    /// Names, not data.
    Names,
    /// This and that.
    Random(u64),
}

/// A file: what was done to it, and how much of that is on disk.
#[derive(Debug, Clone, Default)]
struct File {
    synced: Vec<u8>,
    /// The same with all that was written since.
    whole: Vec<u8>,
    pending: Vec<Change>,
}

#[derive(Debug, Clone)]
enum Change {
    Write { at: usize, bytes: Vec<u8>, appended: bool },
    Cut(usize),
}

/// What happened to the names of a folder.
#[derive(Debug, Clone)]
enum Name {
    /// It leads to the file of this number; `None` for a folder.
    Leads(PathBuf, Option<usize>),
    Gone(PathBuf),
    /// Both happen at once.
    Moved(PathBuf, PathBuf, usize),
}

/// The disk, and what is not on it yet.
#[derive(Debug, Clone, Default)]
pub struct Disk {
    files: Vec<File>,
    /// As the program sees it.
    seen: BTreeMap<PathBuf, Option<usize>>,
    /// As it is on disk.
    synced: BTreeMap<PathBuf, Option<usize>>,
    pending: HashMap<PathBuf, Vec<Name>>,
}

impl Disk {
    /// A disk that holds these files and folders.
    pub fn holding(image: BTreeMap<PathBuf, Option<Vec<u8>>>) -> Self {
        let mut disk = Self::default();
        for (path, content) in image {
            let number = content.map(|bytes| {
                disk.files.push(File { synced: bytes.clone(), whole: bytes, pending: Vec::new() });
                disk.files.len() - 1
            });
            disk.seen.insert(path.clone(), number);
            disk.synced.insert(path, number);
        }
        disk
    }

    /// The next thing is done.
    pub fn take(&mut self, step: &Step) {
        match step {
            Step::Open { path, emptied } => {
                if !self.seen.contains_key(path) {
                    self.files.push(File::default());
                    self.name(Name::Leads(path.clone(), Some(self.files.len() - 1)));
                } else if *emptied {
                    self.change(path, Change::Cut(0));
                }
            }
            Step::Folder(path) => self.name(Name::Leads(path.clone(), None)),
            Step::Write { path, at, bytes } => {
                let Some(file) = self.file(path) else { return };
                let end = file.whole.len();
                let at = at.map_or(end, |at| at as usize);
                self.change(path, Change::Write { at, bytes: bytes.clone(), appended: at == end });
            }
            Step::Cut { path, length } => self.change(path, Change::Cut(*length as usize)),
            Step::Sync(path) => self.sync(path),
            Step::Remove(path) => self.name(Name::Gone(path.clone())),
            Step::Rename { from, to } => {
                let number = self.seen.get(from).copied().flatten();
                self.name(Name::Moved(from.clone(), to.clone(), number.expect("a file that was made")));
            }
        }
    }

    fn file(&mut self, path: &Path) -> Option<&mut File> {
        let number = self.seen.get(path).copied().flatten()?;
        Some(&mut self.files[number])
    }

    fn change(&mut self, path: &Path, change: Change) {
        let Some(file) = self.file(path) else { return };
        change.apply(&mut file.whole);
        file.pending.push(change);
    }

    fn name(&mut self, name: Name) {
        let path = match &name {
            Name::Leads(path, _) | Name::Gone(path) | Name::Moved(path, ..) => path,
        };
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        name.apply(&mut self.seen);
        // Whoever removed a folder's name is done with it; the results themselves are always there.
        if !path.as_os_str().is_empty() {
            self.pending.entry(folder).or_default().push(name);
        }
    }

    fn sync(&mut self, path: &Path) {
        match self.seen.get(path).copied() {
            Some(Some(number)) => {
                let file = &mut self.files[number];
                file.synced.clone_from(&file.whole);
                file.pending.clear();
            }
            _ => {
                let names = self.pending.remove(path).unwrap_or_default();
                names.iter().for_each(|name| name.apply(&mut self.synced));
            }
        }
    }

    /// What is on disk of a file whatever was lost.
    pub fn synced(&self, path: &Path) -> Vec<u8> {
        let number = self.synced.get(path).copied().flatten();
        // A name that leads nowhere without its folder.
        let number = number.filter(|_| self.has_folders(path));
        number.map(|number| self.files[number].synced.clone()).unwrap_or_default()
    }

    fn has_folders(&self, path: &Path) -> bool {
        path.ancestors()
            .skip(1)
            .all(|folder| folder.as_os_str().is_empty() || self.synced.contains_key(folder))
    }

    /// The files and folders that are found after the power was lost.
    pub fn after(&self, lost: Lost) -> BTreeMap<PathBuf, Option<Vec<u8>>> {
        let mut random = Random(if let Lost::Random(seed) = lost { seed } else { 0 });
        let mut names = self.synced.clone();
        let mut folders: Vec<_> = self.pending.iter().collect();
        folders.sort_by_key(|(folder, _)| *folder);
        for (_, pending) in folders {
            let kept = match lost {
                Lost::All | Lost::Names => 0,
                Lost::Nothing | Lost::Data => pending.len(),
                Lost::Random(_) => random.below(pending.len() as u64 + 1) as usize,
            };
            pending[..kept].iter().for_each(|name| name.apply(&mut names));
        }
        let reached = |path: &Path| {
            path.ancestors().skip(1).all(|folder| folder.as_os_str().is_empty() || names.contains_key(folder))
        };
        let found = names.iter().filter(|(path, _)| reached(path) && !is_memory(path));
        found
            .map(|(path, number)| (path.clone(), number.map(|n| self.files[n].after(lost, &mut random))))
            .collect()
    }
}

/// What SQLite shares between processes; it makes it anew when it is the first to open the database.
fn is_memory(path: &Path) -> bool {
    path.to_string_lossy().ends_with("-shm")
}

impl File {
    fn after(&self, lost: Lost, random: &mut Random) -> Vec<u8> {
        let mut bytes = self.synced.clone();
        // A file that only grows is there up to some byte.
        let mut grows = true;
        for change in &self.pending {
            match lost {
                Lost::All | Lost::Data => {}
                Lost::Nothing | Lost::Names => change.apply(&mut bytes),
                Lost::Random(_) => match change {
                    Change::Write { bytes: written, appended: true, .. } if grows => {
                        let kept = random.below(2 * written.len() as u64 + 1) as usize;
                        grows = kept >= written.len();
                        bytes.extend_from_slice(&written[..kept.min(written.len())]);
                        if !grows && random.below(2) == 0 {
                            // Its length came to the disk before its end did.
                            bytes.resize(bytes.len() + written.len() - kept, 0);
                        }
                    }
                    Change::Write { appended: true, .. } => {}
                    change if random.below(2) == 0 => change.apply(&mut bytes),
                    _ => {}
                },
            }
        }
        bytes
    }
}

impl Change {
    fn apply(&self, file: &mut Vec<u8>) {
        match self {
            Self::Write { at, bytes, .. } => {
                let end = at + bytes.len();
                file.resize(file.len().max(end), 0);
                file[*at..end].copy_from_slice(bytes);
            }
            Self::Cut(length) => file.resize(*length, 0),
        }
    }
}

impl Name {
    fn apply(&self, names: &mut BTreeMap<PathBuf, Option<usize>>) {
        match self {
            Self::Leads(path, number) => drop(names.insert(path.clone(), *number)),
            Self::Gone(path) => drop(names.remove(path)),
            Self::Moved(from, to, number) => {
                names.remove(from);
                names.insert(to.clone(), Some(*number));
            }
        }
    }
}
