//! What became of a mesh.

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::Context;
use meshgauge::Summary;

use super::{Record, file_name};
use crate::daemon::fields;
use crate::daemon::finishing::Verdict;
use crate::daemon::log::{CHANGES, Event};
use crate::daemon::protocol::{Failure, Then};
use crate::identity::Identity;
use crate::publish;
use crate::state::{Failed, Id, Stage};

impl Record {
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
        self.tell_once(id, fields::flatten(event, summary).with("summary", place.to_string_lossy()))?;
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

    /// Tells what got worse or better since the baseline; of one version once, even where another baseline was accepted
    /// between a crash and the next start. A baseline that cannot be read or written holds up no mesh.
    fn tell_changes(&mut self, path: &Path, id: Id, summary: &Summary) -> anyhow::Result<()> {
        for event in CHANGES {
            if self.is_told(id, event)? {
                return Ok(());
            }
        }
        let Some(watchman) = &self.watchman else { return Ok(()) };
        match watchman.look(path, summary) {
            Ok(Some(event)) => self.tell_once(id, event.with("id", id.to_string())),
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
        self.tell_once(id, fields::failure(event, failure))?;
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
            self.tell_once(id, event.with("reason", reason))?;
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
    pub(super) fn summary_path(&self, path: &Path) -> anyhow::Result<PathBuf> {
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
