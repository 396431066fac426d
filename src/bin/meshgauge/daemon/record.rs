//! What outlives the daemon, in an order that a crash cannot turn into a lost or a doubled result: the claim in the
//! ledger, the line in the log, the summary under its name, the end in the ledger.

use std::collections::{HashMap, HashSet};
use std::ffi::OsStr;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::Context;
use meshgauge::Summary;
use xxhash_rust::xxh3::xxh3_64;

use super::fields;
use super::ledger::{Ledger, Stage};
use super::log::{Event, Log};
use super::protocol::Failure;
use crate::identity::Identity;
use crate::names::{Folder, has_mesh_extension};
use crate::publish;

/// Log, ledger and summaries.
pub struct Record {
    log: Log,
    ledger: Ledger,
    results: PathBuf,
    /// The meshes of each folder of the drop, present or past.
    folders: HashMap<PathBuf, Folder>,
    /// Ids of results that an earlier process wrote to the log and then did not finish.
    logged: HashSet<String>,
    quiet: bool,
}

impl Record {
    /// Takes over from an earlier process, and ends what that had begun.
    pub fn new(log: Log, ledger: Ledger, results: &Path, quiet: bool) -> anyhow::Result<Self> {
        let results = results.to_owned();
        let mut record =
            Self { log, ledger, results, folders: HashMap::new(), logged: HashSet::new(), quiet };
        let known: Vec<_> =
            record.ledger.entries().map(|(path, entry)| (path.to_owned(), entry.clone())).collect();
        for (path, entry) in &known {
            if entry.summary.is_some() || has_mesh_extension(file_name(path)) {
                record.folder(path).add(file_name(path));
            }
        }
        for (path, entry) in &known {
            record.rename(path)?;
            let Stage::Claimed { log } = entry.stage else { continue };
            let id = id(path, &entry.identity);
            publish::sweep(&record.summary_path(path));
            match record.log.outcome(&id, log)?.as_deref() {
                Some("mesh.failed") => record.ledger.note(path, entry.identity, Stage::Failed)?,
                Some("mesh.ignored") => record.ledger.note(path, entry.identity, Stage::Ignored)?,
                Some(_) => drop(record.logged.insert(id)),
                None => {}
            }
        }
        Ok(record)
    }

    /// Writes a line that is about no mesh.
    pub fn event(&mut self, event: Event) -> anyhow::Result<()> {
        self.log.append(event)
    }

    /// Whether nothing is left to do for this version.
    pub fn is_done(&self, path: &Path, identity: &Identity) -> bool {
        self.ledger.is_done(path, identity)
    }

    /// There is a file with the name of a mesh.
    pub fn detected(&mut self, path: &Path, identity: &Identity) -> anyhow::Result<()> {
        self.log.append(Event::info("mesh.detected").mesh(path).with("bytes", identity.size))?;
        self.named(path)
    }

    /// A mesh is there that a summary may have to be named for.
    pub fn named(&mut self, path: &Path) -> anyhow::Result<()> {
        if self.folder(path).add(file_name(path)) {
            self.rename_clashing(path)?;
        }
        Ok(())
    }

    /// A worker is about to get it. A claim that is made again keeps its place in the log: an earlier process may have
    /// written the result there.
    pub fn claimed(&mut self, path: &Path, identity: &Identity, announced: bool) -> anyhow::Result<()> {
        let log = self.ledger.claim(path, identity).unwrap_or(self.log.length());
        self.ledger.note(path, *identity, Stage::Claimed { log })?;
        if announced { self.log_claim(path, identity) } else { Ok(()) }
    }

    fn log_claim(&mut self, path: &Path, identity: &Identity) -> anyhow::Result<()> {
        self.log.append(Event::info("mesh.claimed").mesh(path).with("id", id(path, identity)))
    }

    /// What was not announced turned out to be a mesh.
    pub fn announced(&mut self, path: &Path, identity: &Identity) -> anyhow::Result<()> {
        self.detected(path, identity)?;
        self.log_claim(path, identity)
    }

    /// It was scored.
    pub fn scored(
        &mut self,
        path: &Path,
        identity: &Identity,
        summary: &Summary,
        time: Duration,
    ) -> anyhow::Result<()> {
        let (id, place) = (id(path, identity), self.summary_path(path));
        if !self.logged.remove(&id) {
            let seconds = summary.run.as_ref().map_or(time.as_secs_f64(), |run| run.seconds);
            let event = Event::info("mesh.scored").mesh(path).with("id", id).with("seconds", seconds);
            let event = fields::flatten(event, summary).with("summary", place.to_string_lossy());
            self.log.append(event)?;
        }
        publish::publish(&place, &summary.to_json()).with_context(|| place.display().to_string())?;
        self.ledger.note_scored(path, *identity, Path::new(file_name(&place)))?;
        self.say(&fields::line(path, summary, &place));
        Ok(())
    }

    /// It cannot be scored. If the machine is at fault it stays to be done.
    pub fn failed(&mut self, path: &Path, identity: &Identity, failure: &Failure) -> anyhow::Result<()> {
        let mut event = Event::error("mesh.failed")
            .mesh(path)
            .with("id", id(path, identity))
            .with("kind", failure.kind.name())
            .with("reason", failure.reason.as_str());
        if let Some(format) = &failure.format {
            event = event.with("format", format.as_str());
        }
        if let Some(line) = failure.line {
            event = event.with("line", line);
        }
        if let Some(byte) = failure.byte {
            event = event.with("byte", byte);
        }
        self.log.append(event)?;
        let stage = if failure.kind.is_resource() { Stage::Dropped } else { Stage::Failed };
        self.ledger.note(path, *identity, stage)?;
        self.say(&fields::printable(&format!("{}: not scored: {}", path.display(), failure.reason)));
        Ok(())
    }

    /// It is no mesh. That is said once of a path, whatever becomes of it.
    pub fn ignored(&mut self, path: &Path, identity: &Identity, reason: &str) -> anyhow::Result<()> {
        if !self.was_ignored(path) {
            self.log.append(
                Event::info("mesh.ignored").mesh(path).with("id", id(path, identity)).with("reason", reason),
            )?;
        }
        self.ledger.note(path, *identity, Stage::Ignored)
    }

    /// Whether the log tells that this path is no mesh.
    pub fn was_ignored(&self, path: &Path) -> bool {
        self.ledger.get(path).is_some_and(|entry| entry.was_ignored)
    }

    /// It changed while it was read; what was found is thrown away.
    pub fn changed(&mut self, path: &Path, identity: &Identity, announced: bool) -> anyhow::Result<()> {
        self.ledger.note(path, *identity, Stage::Dropped)?;
        let reason = "it changed while it was read; it is scored when it stands still";
        if announced {
            self.log.append(Event::warn("mesh.changed").mesh(path).with("reason", reason))?;
        }
        Ok(())
    }

    /// It went away while it was read.
    pub fn gone(&mut self, path: &Path, identity: &Identity, announced: bool) -> anyhow::Result<()> {
        self.ledger.note(path, *identity, Stage::Dropped)?;
        if announced {
            self.log.append(Event::warn("mesh.gone").mesh(path).with("reason", "it went away"))?;
        }
        Ok(())
    }

    fn folder(&mut self, path: &Path) -> &mut Folder {
        self.folders.entry(parent(path).to_owned()).or_default()
    }

    /// Where the summary of the mesh at `path` belongs.
    fn summary_path(&mut self, path: &Path) -> PathBuf {
        let folder = self.folder(path);
        folder.add(file_name(path));
        let name = folder.summary_name(file_name(path));
        self.results.join(parent(path)).join(name)
    }

    /// Renames the summaries of the folder that have a name which is no longer theirs alone.
    fn rename_clashing(&mut self, newcomer: &Path) -> anyhow::Result<()> {
        let here = |path: &Path| parent(path) == parent(newcomer);
        let meshes: Vec<_> = self
            .ledger
            .entries()
            .map(|(path, _)| path)
            .filter(|path| here(path))
            .map(Path::to_owned)
            .collect();
        meshes.iter().try_for_each(|mesh| self.rename(mesh))
    }

    /// Gives the summary of a mesh the name that it should have.
    fn rename(&mut self, mesh: &Path) -> anyhow::Result<()> {
        let Some(name) = self.ledger.get(mesh).and_then(|entry| entry.summary.clone()) else {
            return Ok(());
        };
        let to = self.summary_path(mesh);
        let from = to.with_file_name(PathBuf::from(name));
        if from == to {
            return Ok(());
        }
        match publish::rename(&from, &to) {
            // An earlier process got this far, or somebody took the summary away.
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            result => result.with_context(|| from.display().to_string())?,
        }
        self.ledger.note_renamed(mesh, Path::new(file_name(&to)))
    }

    /// Tells people. That nobody listens is no reason to stop.
    fn say(&self, line: &str) {
        if !self.quiet {
            let _ = writeln!(io::stdout(), "{line}");
        }
    }
}

/// Makes the folders that are written to.
pub fn make_folders(folders: [&Path; 2]) -> anyhow::Result<()> {
    for folder in folders {
        fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    }
    Ok(())
}

/// Names a version of a mesh in the log: the same after a restart.
fn id(path: &Path, identity: &Identity) -> String {
    let mut bytes = path.as_os_str().as_encoded_bytes().to_vec();
    for part in identity.version() {
        bytes.extend_from_slice(&part.to_le_bytes());
    }
    format!("{:016x}", xxh3_64(&bytes))
}

fn file_name(path: &Path) -> &OsStr {
    path.file_name().unwrap_or_default()
}

fn parent(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn open(folder: &Path) -> Record {
        let (log, _) = Log::open(&folder.join("log.jsonl")).expect("a log");
        Record::new(log, Ledger::open(folder).expect("a ledger"), folder, true).expect("a record")
    }

    #[test]
    fn a_result_that_was_logged_is_known_after_any_number_of_crashes() {
        let folder = tempfile::tempdir().expect("a folder");
        let (mesh, identity) = (Path::new("a.msh"), Identity::default());
        let mut record = open(folder.path());
        record.claimed(mesh, &identity, true).expect("claimed");
        let line = Event::info("mesh.scored").mesh(mesh).with("id", id(mesh, &identity));
        record.event(line).expect("logged");
        for _ in 0..3 {
            drop(record);
            record = open(folder.path());
            assert!(record.logged.contains(&id(mesh, &identity)));
            record.claimed(mesh, &identity, true).expect("claimed again");
        }
    }
}
