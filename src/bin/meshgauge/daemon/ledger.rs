//! What was scored: a durable record, so that no version of a mesh is scored twice.
//!
//! A file of JSON lines that is only appended to, each record on disk before the daemon goes on; the last record of a
//! path counts. It is written anew, without what was overtaken, at each start. A record that a crash tore is the last
//! and is left out.

use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::{self, BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::identity::Identity;
use crate::path_text::PathText;
use crate::publish::publish;

/// How far a version of a mesh has come.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Stage {
    /// A worker has it. The log's length at that moment tells where to look for its outcome after a crash.
    Claimed {
        /// Bytes of the log.
        log: u64,
    },
    /// Its summary is published.
    Scored,
    /// It cannot be scored; the log says why.
    Failed,
    /// It is no mesh.
    Ignored,
    /// It changed or went away before it was scored.
    Dropped,
}

/// What is known of a path.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Entry {
    /// The version.
    pub identity: Identity,
    /// How far it has come.
    pub stage: Stage,
    /// File name of the summary of this or an earlier version, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub summary: Option<PathText>,
    /// Whether this or an earlier version was no mesh.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub was_ignored: bool,
}

#[derive(Serialize, Deserialize)]
struct Record {
    path: PathText,
    #[serde(flatten)]
    entry: Entry,
}

/// The record, open to append to.
pub struct Ledger {
    path: PathBuf,
    file: File,
    entries: BTreeMap<PathBuf, Entry>,
}

/// Records are shorter by far: a path has at most 4096 bytes.
const LONGEST_RECORD: u64 = 1 << 16;

impl Ledger {
    /// Opens the record in the folder `state`.
    pub fn open(state: &Path) -> anyhow::Result<Self> {
        let path = state.join("ledger.jsonl");
        Self::read(&path).map_err(|e| anyhow::anyhow!("{}: {e}", path.display()))
    }

    fn read(path: &Path) -> io::Result<Self> {
        let mut entries = BTreeMap::new();
        match File::open(path) {
            Ok(file) => read_entries(file, &mut entries)?,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            Err(error) => return Err(error),
        }
        entries.retain(|_, entry| entry.stage != Stage::Dropped || entry.summary.is_some());
        let text: String = entries.iter().map(|(path, entry)| line(path, entry)).collect();
        publish(path, &text)?;
        let file = OpenOptions::new().append(true).open(path)?;
        Ok(Self { path: path.to_owned(), file, entries })
    }

    /// What is known of a path.
    pub fn get(&self, path: &Path) -> Option<&Entry> {
        self.entries.get(path)
    }

    /// Every path that something is known of, in order.
    pub fn entries(&self) -> impl Iterator<Item = (&Path, &Entry)> {
        self.entries.iter().map(|(path, entry)| (path.as_path(), entry))
    }

    /// Whether nothing is left to do for this version.
    pub fn is_done(&self, path: &Path, identity: &Identity) -> bool {
        self.entries.get(path).is_some_and(|entry| {
            matches!(entry.stage, Stage::Scored | Stage::Failed | Stage::Ignored)
                && entry.identity.same_version(identity)
        })
    }

    /// Where in the log to look for the outcome of an open claim of this version.
    pub fn claim(&self, path: &Path, identity: &Identity) -> Option<u64> {
        let entry = self.entries.get(path).filter(|entry| entry.identity.same_version(identity))?;
        match entry.stage {
            Stage::Claimed { log } => Some(log),
            _ => None,
        }
    }

    /// Puts down how far a version has come. An earlier summary stays known.
    pub fn note(&mut self, path: &Path, identity: Identity, stage: Stage) -> anyhow::Result<()> {
        let before = self.entries.get(path);
        let summary = before.and_then(|entry| entry.summary.clone());
        let was_ignored = stage == Stage::Ignored || before.is_some_and(|entry| entry.was_ignored);
        self.write(path, Entry { identity, stage, summary, was_ignored })
    }

    /// Puts down that the version is scored and its summary has the given file name.
    pub fn note_scored(&mut self, path: &Path, identity: Identity, summary: &Path) -> anyhow::Result<()> {
        let summary = Some(PathText::from(summary));
        self.write(path, Entry { identity, stage: Stage::Scored, summary, was_ignored: false })
    }

    /// Puts down that the summary has another file name now.
    pub fn note_renamed(&mut self, path: &Path, summary: &Path) -> anyhow::Result<()> {
        match self.entries.get(path).cloned() {
            Some(entry) => self.write(path, Entry { summary: Some(summary.into()), ..entry }),
            None => Ok(()),
        }
    }

    fn write(&mut self, path: &Path, entry: Entry) -> anyhow::Result<()> {
        let line = line(path, &entry);
        self.file
            .write_all(line.as_bytes())
            .and_then(|()| self.file.sync_data())
            .map_err(|e| anyhow::anyhow!("{}: {e}", self.path.display()))?;
        self.entries.insert(path.to_owned(), entry);
        Ok(())
    }
}

fn line(path: &Path, entry: &Entry) -> String {
    let record = Record { path: path.into(), entry: entry.clone() };
    let mut line = serde_json::to_string(&record).expect("a record has string keys and whole numbers");
    line.push('\n');
    line
}

fn read_entries(file: File, entries: &mut BTreeMap<PathBuf, Entry>) -> io::Result<()> {
    let mut lines = BufReader::new(file);
    let mut line = Vec::new();
    while lines.by_ref().take(LONGEST_RECORD).read_until(b'\n', &mut line)? > 0 {
        match serde_json::from_slice::<Record>(&line) {
            Ok(record) => {
                entries.insert(record.path.into(), record.entry);
            }
            Err(error) => tracing::warn!("a record of what was scored is lost: {error}"),
        }
        line.clear();
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn identity(size: u64) -> Identity {
        Identity { device: 1, inode: 2, size, modified: (3, 4), changed: (5, 6), blocks: 8 }
    }

    #[test]
    fn what_is_done_is_known_after_a_restart_and_another_version_is_not() {
        let state = tempfile::tempdir().expect("a folder");
        let (mesh, summary) = (Path::new("a/pit.inp"), Path::new("pit.summary.json"));
        let mut ledger = Ledger::open(state.path()).expect("opened");
        ledger.note(mesh, identity(1), Stage::Claimed { log: 0 }).expect("noted");
        assert!(!ledger.is_done(mesh, &identity(1)));
        ledger.note_scored(mesh, identity(1), summary).expect("noted");
        let mut ledger = Ledger::open(state.path()).expect("opened again");
        assert!(ledger.is_done(mesh, &identity(1)));
        assert!(ledger.is_done(mesh, &Identity { device: 9, blocks: 0, ..identity(1) }), "another mount");
        assert!(!ledger.is_done(mesh, &identity(2)));
        ledger.note(mesh, identity(2), Stage::Failed).expect("noted");
        let ledger = Ledger::open(state.path()).expect("opened a third time");
        assert!(ledger.is_done(mesh, &identity(2)));
        assert_eq!(ledger.get(mesh).and_then(|e| e.summary.clone()), Some(summary.into()));
    }

    #[test]
    fn a_torn_record_costs_itself_alone() {
        let state = tempfile::tempdir().expect("a folder");
        let mut ledger = Ledger::open(state.path()).expect("opened");
        ledger.note(Path::new("a.inp"), identity(1), Stage::Failed).expect("noted");
        ledger.note(Path::new("b.inp"), identity(1), Stage::Failed).expect("noted");
        let file = OpenOptions::new().write(true).open(state.path().join("ledger.jsonl")).expect("there");
        file.set_len(file.metadata().expect("there").len() - 7).expect("torn");
        let mut ledger = Ledger::open(state.path()).expect("opened again");
        assert!(ledger.is_done(Path::new("a.inp"), &identity(1)));
        assert!(!ledger.is_done(Path::new("b.inp"), &identity(1)));
        ledger.note(Path::new("b.inp"), identity(1), Stage::Failed).expect("noted");
        let ledger = Ledger::open(state.path()).expect("opened a third time");
        assert!(ledger.is_done(Path::new("b.inp"), &identity(1)));
    }
}
