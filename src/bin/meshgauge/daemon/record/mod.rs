//! What outlives the daemon, in an order that a crash cannot turn into a lost or a doubled result: the claim in the
//! database, the line in the log, the summary under its name, the end in the database.

mod meeting;
mod outcomes;

use std::ffi::OsStr;
use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::Context;

use super::Places;
use super::done::Done;
use super::keeping::Keeping;
use super::log::{Event, Log};
use super::owner::Owner;
use super::regression::Watchman;
use crate::config::{self, Config};
use crate::identity::Identity;
use crate::publish;
use crate::state::{Id, Stage, State};

/// How often the log is looked at, whether it is to be rotated or was moved away.
const BETWEEN_LOOKS: Duration = Duration::from_secs(1);

/// There is room where a file of so many bytes finds some: more than a summary and its line in the log.
const ROOM: usize = 64 << 10;

/// Log, database and summaries.
pub struct Record {
    log: Log,
    state: State,
    done: Done,
    /// What stands in the log of the outcome that is being put down, and not yet in the database.
    written: Vec<(Id, String)>,
    minded: Instant,
    places: Places,
    quiet: bool,
    watchman: Option<Watchman>,
    keeping: Option<Keeping>,
    /// Our name in the state folder, where other machines may reach it.
    owner: Option<Owner>,
}

impl Record {
    /// Takes over from an earlier process, and clears away what that had begun.
    pub fn new(log: Log, state: State, places: &Places, quiet: bool) -> anyhow::Result<Self> {
        for folder in state.interrupted_folders()? {
            publish::sweep(&places.results.join(folder));
        }
        let (done, minded, places) = (Done::default(), Instant::now(), places.clone());
        let record = Self {
            log,
            state,
            done,
            written: Vec::new(),
            minded,
            places,
            quiet,
            watchman: None,
            keeping: None,
            owner: None,
        };
        record.catch_up()?;
        Ok(record)
    }

    /// Nothing is written once another machine's daemon took the state folder from this owner.
    pub fn belongs_to(&mut self, owner: Option<Owner>) {
        self.owner = owner;
    }

    /// Makes sure that the state folder is still ours.
    pub fn hold(&mut self) -> anyhow::Result<()> {
        self.owner.as_mut().map_or(Ok(()), Owner::hold)
    }

    /// What each mesh that is scored is compared with, and for how long its summary is kept, from now on.
    pub fn configure(&mut self, config: &Config) -> anyhow::Result<()> {
        let keep = config.history.keep.0;
        let naming = config.baseline.naming()?;
        self.keeping = (!keep.is_zero()).then(|| Keeping::new(keep, naming));
        self.watchman = Watchman::of(config, &self.places)?;
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
        transaction.commit()?;
        // Without a mark on disk a loss of power would leave a log of which nothing is known.
        self.state.sync()
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
        is_done(&mut self.done, &self.state, Id::of(path, identity))
    }

    /// Which of these versions something is left to do for. To ask about many at a time is what makes a scan of many files
    /// quick.
    pub fn undone<T>(&mut self, versions: Vec<T>, id: impl Fn(&T) -> Id) -> anyhow::Result<Vec<T>> {
        let reading = self.state.begin()?;
        let mut undone = Vec::new();
        for version in versions {
            if !is_done(&mut self.done, &self.state, id(&version))? {
                undone.push(version);
            }
        }
        reading.commit()?;
        Ok(undone)
    }

    /// The drop was read through and holds so many files.
    pub fn scanned(&mut self, files: usize) {
        self.done.prune(files);
    }

    /// Whether the log tells this of a version: an earlier process wrote it, or we did before we had to wait for room.
    fn is_told(&self, id: Id, event: &str) -> anyhow::Result<bool> {
        let ours = self.written.iter().any(|(of, told)| *of == id && told == event);
        Ok(ours || self.state.is_logged(id, event)?)
    }

    /// Writes what is told once of a version to the log, unless it stands there.
    fn tell_once(&mut self, id: Id, event: Event) -> anyhow::Result<()> {
        let name = event.name().to_owned();
        if !self.is_told(id, &name)? {
            self.log.append_durably(event)?;
            self.written.push((id, name));
        }
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
        self.written.clear();
        if stage.is_end() {
            self.done.insert(id);
        }
        Ok(())
    }
}

/// Whether nothing is left to do for a version: as far as we remember, or else as the database has it.
fn is_done(done: &mut Done, state: &State, id: Id) -> anyhow::Result<bool> {
    if done.contains(id) {
        return Ok(true);
    }
    let is_done = state.is_done(id)?;
    if is_done {
        done.insert(id);
    }
    Ok(is_done)
}

/// Makes the folders that are written to.
pub fn make_folders(folders: [&Path; 2]) -> anyhow::Result<()> {
    for folder in folders {
        publish::make_folder(folder).with_context(|| folder.display().to_string())?;
    }
    Ok(())
}

fn file_name(path: &Path) -> &OsStr {
    path.file_name().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use std::fs::{self, File};
    use std::io::{BufRead, BufReader};

    use meshgauge::Summary;

    use super::*;

    fn open(folder: &Path) -> Record {
        let folder = folder.to_owned();
        let log = folder.join("log.jsonl");
        let places = Places { drop: folder.join("drop"), results: folder.clone(), log, state: folder };
        let (log, _) = Log::open(&places.log).expect("a log");
        let state = State::open(&places.state).expect("a database");
        Record::new(log, state, &places, true).expect("a record")
    }

    /// Nodes of one tetrahedron; the lower its height, the worse it is.
    fn summary(height: &str) -> Summary {
        let text = format!(
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 {height}\n$EndNodes\n\
             $Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n"
        );
        let file = tempfile::NamedTempFile::new().expect("a file");
        fs::write(file.path(), text).expect("written");
        meshgauge::score(file.path(), &meshgauge::Options::default()).expect("a mesh")
    }

    #[test]
    fn a_regression_is_told_once_though_its_summary_could_not_be_written_before_a_crash() {
        let folder = tempfile::tempdir().expect("a folder");
        let config = config::Config::default();
        let (mesh, time) = (Path::new("a.msh"), Duration::from_secs(1));
        let (sound, bad) = (Identity::default(), Identity { size: 1, ..Identity::default() });
        let reopen = || {
            let mut record = open(folder.path());
            record.configure(&config).expect("sound");
            record
        };
        let mut record = reopen();
        record.claimed(mesh, &sound, true).expect("claimed");
        record.scored(mesh, &sound, &summary("1"), time).expect("the baseline");
        record.claimed(mesh, &bad, true).expect("claimed");
        // Nothing can take the place of a folder that is not empty.
        let place = folder.path().join("a.summary.json");
        fs::remove_file(&place).and_then(|()| fs::create_dir_all(place.join("x"))).expect("a folder");
        for _ in 0..2 {
            assert!(record.scored(mesh, &bad, &summary("0.01"), time).is_err(), "as if there were no room");
        }
        for _ in 0..2 {
            record = reopen();
            record.claimed(mesh, &bad, true).expect("claimed again");
            assert!(record.scored(mesh, &bad, &summary("0.01"), time).is_err());
        }
        fs::remove_dir_all(&place).expect("there is room");
        record.scored(mesh, &bad, &summary("0.01"), time).expect("put down");
        let log = File::open(folder.path().join("log.jsonl")).expect("a log");
        let lines: Vec<_> = BufReader::new(log).lines().map(|line| line.expect("UTF-8")).collect();
        let told = |event: &str| lines.iter().filter(|line| line.contains(&format!("\"{event}\""))).count();
        assert_eq!((told("mesh.scored"), told("mesh.regressed")), (2, 1), "{lines:?}");
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
