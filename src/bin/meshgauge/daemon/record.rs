//! What outlives the daemon, in an order that a crash cannot turn into a lost or a doubled result: the claim in the
//! database, the line in the log, the summary under its name, the end in the database.

use std::ffi::OsStr;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::Context;
use meshgauge::Summary;

use super::Places;
use super::done::Done;
use super::fields;
use super::finishing::Verdict;
use super::keeping::Keeping;
use super::log::{Event, Log};
use super::protocol::{Failure, Then};
use super::regression::Watchman;
use crate::baseline::Baselines;
use crate::config::{self, Config};
use crate::identity::Identity;
use crate::publish;
use crate::state::{Failed, Id, Stage, State, Tries};

/// How often the log is looked at, whether it is to be rotated or was moved away.
const BETWEEN_LOOKS: Duration = Duration::from_secs(1);

/// There is room where a file of so many bytes finds some: more than a summary and its line in the log.
const ROOM: usize = 64 << 10;

/// Log, database and summaries.
pub struct Record {
    log: Log,
    state: State,
    done: Done,
    /// The outcome that stands in the log and not yet in the database.
    written: Option<(Id, String)>,
    minded: Instant,
    places: Places,
    quiet: bool,
    watchman: Option<Watchman>,
    keeping: Option<Keeping>,
}

impl Record {
    /// Takes over from an earlier process, and clears away what that had begun.
    pub fn new(log: Log, state: State, places: &Places, quiet: bool) -> anyhow::Result<Self> {
        for folder in state.interrupted_folders()? {
            publish::sweep(&places.results.join(folder));
        }
        let (done, minded, places) = (Done::default(), Instant::now(), places.clone());
        let record =
            Self { log, state, done, written: None, minded, places, quiet, watchman: None, keeping: None };
        record.catch_up()?;
        Ok(record)
    }

    /// What each mesh that is scored is compared with, and for how long its summary is kept, from now on.
    pub fn configure(&mut self, config: &Config) -> anyhow::Result<()> {
        let naming = config.baseline.naming()?;
        let keep = config.history.keep.0;
        self.keeping = (!keep.is_zero()).then(|| Keeping::new(keep, naming.clone()));
        let (baselines, tolerances) = (Baselines::of(&self.places.state), config.compare);
        self.watchman = config.baseline.compare.then_some(Watchman { baselines, naming, tolerances });
        Ok(())
    }

    /// Remembers the outcomes that the log tells and the database may not know of.
    fn catch_up(&self) -> anyhow::Result<()> {
        let transaction = self.state.begin()?;
        if let Some(mark) = self.state.log_mark()? {
            for outcome in self.log.outcomes_since(mark)? {
                self.state.note_logged(&outcome)?;
            }
        }
        self.state.set_log_mark(self.log.mark()?)?;
        Ok(transaction.commit()?)
    }

    /// Writes a line that is about no mesh.
    pub fn event(&mut self, event: Event) -> anyhow::Result<()> {
        self.log.append_durably(event)
    }

    /// An error if there is no room for results, where they are written.
    pub fn find_room(&self) -> anyhow::Result<()> {
        for folder in [self.log.folder(), &self.places.state, &self.places.results] {
            publish::try_writing(folder, ROOM).with_context(|| folder.display().to_string())?;
        }
        Ok(())
    }

    /// Rotates the log if it is time, or begins another if somebody moved it away. No outcome may be half put down.
    pub fn mind_log(&mut self, rules: &config::Log) -> anyhow::Result<()> {
        if self.minded.elapsed() < BETWEEN_LOOKS {
            return Ok(());
        }
        self.minded = Instant::now();
        self.reopen_log()?;
        if let Some(keeping) = &mut self.keeping {
            keeping.forget(&self.state)?;
        }
        let log = self.places.log.display().to_string();
        if let Some(away) = self.log.rotate_if_due(rules).with_context(|| log)? {
            self.log.append(Event::info("log.rotated").with("to", away.to_string_lossy()))?;
            self.state.set_log_mark(self.log.mark()?)?;
        }
        Ok(())
    }

    /// Begins another log if somebody moved ours away.
    pub fn reopen_log(&mut self) -> anyhow::Result<()> {
        self.log.reopen_if_moved().with_context(|| self.places.log.display().to_string())?;
        Ok(())
    }

    /// Whether nothing is left to do for this version.
    pub fn is_done(&mut self, path: &Path, identity: &Identity) -> anyhow::Result<bool> {
        let id = Id::of(path, identity);
        if self.done.contains(id) {
            return Ok(true);
        }
        let done = self.state.is_done(id)?;
        if done {
            self.done.insert(id);
        }
        Ok(done)
    }

    /// The drop was read through and holds so many files.
    pub fn scanned(&mut self, files: usize) {
        self.done.prune(files);
    }

    /// There is a file with the name of a mesh.
    pub fn detected(&mut self, path: &Path, identity: &Identity) -> anyhow::Result<()> {
        self.log.append(Event::info("mesh.detected").mesh(path).with("bytes", identity.size))?;
        self.named(path)
    }

    /// A mesh is there that the summaries of its folder may have to be renamed for. The database is told after the
    /// files have their names: a crash in between is mended by doing it again.
    fn named(&mut self, path: &Path) -> anyhow::Result<()> {
        if self.state.is_named(path)? {
            return Ok(());
        }
        let transaction = self.state.begin()?;
        self.state.name(path)?;
        for mesh in self.state.neighbours(path)? {
            self.rename(&mesh)?;
        }
        Ok(transaction.commit()?)
    }

    /// Gives the summary of a mesh the name that it should have.
    fn rename(&self, mesh: &Path) -> anyhow::Result<()> {
        let Some(name) = self.state.summary(mesh)? else { return Ok(()) };
        let to = self.summary_path(mesh)?;
        let from = to.with_file_name(name);
        if from == to {
            return Ok(());
        }
        match publish::rename(&from, &to) {
            // An earlier process got this far, or somebody took the summary away.
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            result => result.with_context(|| from.display().to_string())?,
        }
        self.state.set_summary(mesh, file_name(&to))
    }

    /// A worker is about to get it.
    pub fn claimed(&mut self, path: &Path, identity: &Identity, announced: bool) -> anyhow::Result<()> {
        let transaction = self.state.begin()?;
        let claim = self.state.claim(path, identity)?;
        transaction.commit()?;
        if claim.again {
            let event = Event::info("mesh.retried").mesh(path).with("id", Id::of(path, identity).to_string());
            self.log.append(event.with("attempt", claim.attempt))?;
        }
        if announced { self.log_claim(path, identity) } else { Ok(()) }
    }

    /// How often the version was tried.
    pub fn tries(&self, path: &Path, identity: &Identity) -> anyhow::Result<Tries> {
        self.state.tries(Id::of(path, identity))
    }

    fn log_claim(&mut self, path: &Path, identity: &Identity) -> anyhow::Result<()> {
        let id = Id::of(path, identity).to_string();
        self.log.append(Event::info("mesh.claimed").mesh(path).with("id", id))
    }

    /// What was not announced turned out to be a mesh.
    pub fn announced(&mut self, path: &Path, identity: &Identity) -> anyhow::Result<()> {
        self.detected(path, identity)?;
        self.log_claim(path, identity)
    }

    /// Writes an outcome to the log, unless it stands there: an earlier process wrote it, or we did before we had to
    /// wait for room.
    fn log_outcome(&mut self, id: Id, event: Event) -> anyhow::Result<()> {
        let key = (id, event.name().to_owned());
        if self.written.as_ref() == Some(&key) || self.state.is_logged(id, &key.1)? {
            return Ok(());
        }
        self.log.append_durably(event)?;
        self.written = Some(key);
        Ok(())
    }

    /// Puts an outcome into the database; what the log tells of it stands before the mark from now on.
    fn end(
        &mut self,
        id: Id,
        stage: Stage,
        put: impl FnOnce(&State) -> anyhow::Result<()>,
    ) -> anyhow::Result<()> {
        let transaction = self.state.begin()?;
        put(&self.state)?;
        self.state.forget_logged(id)?;
        self.state.set_log_mark(self.log.mark()?)?;
        transaction.commit()?;
        self.written = None;
        if stage.is_end() {
            self.done.insert(id);
        }
        Ok(())
    }

    /// It was scored.
    pub fn scored(
        &mut self,
        path: &Path,
        identity: &Identity,
        summary: &Summary,
        time: Duration,
    ) -> anyhow::Result<()> {
        let (id, place) = (Id::of(path, identity), self.summary_path(path)?);
        let seconds = summary.run.as_ref().map_or(time.as_secs_f64(), |run| run.seconds);
        let event = Event::info("mesh.scored").mesh(path).with("id", id.to_string()).with("seconds", seconds);
        self.log_outcome(id, fields::flatten(event, summary).with("summary", place.to_string_lossy()))?;
        self.tell_changes(path, id, summary)?;
        publish::publish(&place, summary.to_json()).with_context(|| place.display().to_string())?;
        let keeps = self.keeping.is_some();
        self.end(id, Stage::Scored, |state| {
            state.score(id, path, summary, file_name(&place))?;
            if keeps { state.keep_summary(id, summary) } else { Ok(()) }
        })?;
        self.say(&fields::line(path, summary, &place));
        Ok(())
    }

    /// Tells what got worse or better since the baseline. A crash just after it makes it be told again. A baseline that
    /// cannot be read or written holds up no mesh.
    fn tell_changes(&mut self, path: &Path, id: Id, summary: &Summary) -> anyhow::Result<()> {
        let Some(watchman) = &self.watchman else { return Ok(()) };
        match watchman.look(path, summary) {
            Ok(Some(event)) => self.log.append_durably(event.with("id", id.to_string())),
            Ok(None) => Ok(()),
            Err(error) => {
                tracing::warn!("{}: not compared with its baseline: {error:#}", path.display());
                Ok(())
            }
        }
    }

    /// It cannot be scored, or not yet.
    pub fn failed(
        &mut self,
        path: &Path,
        identity: &Identity,
        failure: &Failure,
        verdict: Verdict,
    ) -> anyhow::Result<()> {
        let (id, kind) = (Id::of(path, identity), failure.kind.name());
        let (stage, event) = match verdict {
            Verdict::Failed => (Stage::Failed, Event::error("mesh.failed")),
            Verdict::Again(wait) => {
                (Stage::Waiting, Event::error("mesh.failed").with("retry_seconds", wait.as_secs_f64()))
            }
            Verdict::Quarantined => (Stage::Quarantined, Event::error("mesh.quarantined")),
        };
        let event = event.mesh(path).with("id", id.to_string());
        self.log_outcome(id, fields::failure(event, failure))?;
        let abnormal = failure.kind.then() == Then::Quarantine;
        let failed = Failed { kind: &kind, reason: &failure.reason, abnormal };
        self.end(id, stage, |state| state.end(id, stage, Some(failed)))?;
        self.say(&fields::printable(&format!("{}: not scored: {}", path.display(), failure.reason)));
        Ok(())
    }

    /// It is no mesh. That is said once of a path, whatever becomes of it.
    pub fn ignored(&mut self, path: &Path, identity: &Identity, reason: &str) -> anyhow::Result<()> {
        let id = Id::of(path, identity);
        if !self.state.was_ignored(path)? {
            let event = Event::info("mesh.ignored").mesh(path).with("id", id.to_string());
            self.log_outcome(id, event.with("reason", reason))?;
        }
        self.end(id, Stage::Ignored, |state| {
            state.set_ignored(path)?;
            state.ignore(path, identity)
        })
    }

    /// It changed while it was read; what was found is thrown away.
    pub fn changed(&mut self, path: &Path, identity: &Identity, announced: bool) -> anyhow::Result<()> {
        self.state.end(Id::of(path, identity), Stage::Dropped, None)?;
        let reason = "it changed while it was read; it is scored when it stands still";
        if announced {
            self.log.append(Event::warn("mesh.changed").mesh(path).with("reason", reason))?;
        }
        Ok(())
    }

    /// It went away while it was read.
    pub fn gone(&mut self, path: &Path, identity: &Identity, announced: bool) -> anyhow::Result<()> {
        self.state.end(Id::of(path, identity), Stage::Dropped, None)?;
        if announced {
            self.log.append(Event::warn("mesh.gone").mesh(path).with("reason", "it went away"))?;
        }
        Ok(())
    }

    /// Where the summary of the mesh at `path` belongs.
    fn summary_path(&self, path: &Path) -> anyhow::Result<PathBuf> {
        let folder = path.parent().unwrap_or(Path::new(""));
        Ok(self.places.results.join(folder).join(self.state.summary_name(path)?))
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

fn file_name(path: &Path) -> &OsStr {
    path.file_name().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn open(folder: &Path) -> Record {
        let folder = folder.to_owned();
        let log = folder.join("log.jsonl");
        let places = Places { drop: folder.join("drop"), results: folder.clone(), log, state: folder };
        let (log, _) = Log::open(&places.log).expect("a log");
        let state = State::open(&places.state).expect("a database");
        Record::new(log, state, &places, true).expect("a record")
    }

    #[test]
    fn a_result_that_was_logged_is_known_after_any_number_of_crashes() {
        let folder = tempfile::tempdir().expect("a folder");
        let (mesh, identity) = (Path::new("a.msh"), Identity::default());
        let id = Id::of(mesh, &identity);
        let mut record = open(folder.path());
        record.claimed(mesh, &identity, true).expect("claimed");
        record.event(Event::info("mesh.scored").mesh(mesh).with("id", id.to_string())).expect("logged");
        for _ in 0..3 {
            drop(record);
            record = open(folder.path());
            assert!(record.state.is_logged(id, "mesh.scored").expect("read"));
            record.claimed(mesh, &identity, true).expect("claimed again");
        }
    }
}
