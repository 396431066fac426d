//! Why a file has not been scored yet.
//!
//! The answer comes from the status file, from the configuration in it and from the file itself, in the order in
//! which the daemon would decide.

use std::fs;
use std::path::{Component, Path, PathBuf};

use serde::Serialize;

use super::{Health, MOST_WAITING, Status, Waits};
use crate::folder::{Found, Walk, ignored_by};
use crate::path_text::PathText;
use crate::state::{Id, Known, Stage, State};

/// What is the matter with a file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Answer {
    /// The file, within the drop where it is there.
    pub mesh: PathText,
    /// One word or two that a program can tell apart.
    pub state: Cause,
    /// The same in words.
    pub words: String,
}

/// What a file is or waits for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Cause {
    /// This version has its result.
    Scored,
    /// This version cannot be scored.
    Failed,
    /// It ended its worker too often.
    Quarantined,
    /// It is no mesh.
    Ignored,
    /// It does not lie below a watched folder.
    Outside,
    /// Its name says that it is still being written, or not meant to be scored.
    IgnoredName,
    /// It is one of our own files.
    Ours,
    /// It lies too deep.
    TooDeep,
    /// Nothing is there.
    Absent,
    /// It is no regular file.
    NotAFile,
    /// It is there and cannot be looked at or read.
    Unreadable,
    /// A worker has it.
    Running,
    /// It must stand still for longer.
    Settling,
    /// It waits for a free worker.
    Queued,
    /// It is to be tried again.
    Postponed,
    /// Its producer has not said that it is whole.
    Awaiting,
    /// The daemon has not come across it.
    NotSeen,
}

impl Cause {
    /// Whether the file has a result or will have one by itself.
    pub fn is_pending(self) -> bool {
        use Cause::*;
        matches!(self, Running | Settling | Queued | Postponed | Awaiting | NotSeen)
    }
}

/// Explains the file at `path`, which counts from here or from the drop. What was done about its version stands in the
/// database of the state folder.
pub fn explain(status: &Status, health: Health, path: &Path, state: &Path) -> anyhow::Result<Answer> {
    let Some((drop, mesh)) = within(status, path) else {
        let drops: Vec<_> =
            status.watches.iter().map(|w| PathBuf::from(w.drop.clone()).display().to_string()).collect();
        let words = format!("it does not lie below a watched folder ({})", drops.join(", "));
        return Ok(Answer { mesh: path.into(), state: Cause::Outside, words });
    };
    let (cause, mut words) = match by_name(status, &drop, &mesh) {
        Some(found) => found,
        None => by_content(status, &drop, &mesh, state)?,
    };
    if cause.is_pending() {
        let but = match health {
            Health::Well | Health::Degraded | Health::Elsewhere => "",
            Health::Hung => "; but the daemon hangs",
            Health::Stopped => "; but the daemon is stopped by a signal (SIGCONT lets it go on)",
            Health::Ended | Health::Dead => "; but no daemon runs",
        };
        words.push_str(but);
    }
    Ok(Answer { mesh: mesh.as_path().into(), state: cause, words })
}

/// The watched folder that a path lies in, and the path within it.
fn within(status: &Status, path: &Path) -> Option<(PathBuf, PathBuf)> {
    let whole = absolute(path);
    let drops = || status.watches.iter().map(|watched| PathBuf::from(watched.drop.clone()));
    for drop in drops() {
        if let Ok(mesh) = whole.strip_prefix(absolute(&drop)) {
            return Some((drop, mesh.to_owned()));
        }
    }
    let inner = path.is_relative() && !path.components().any(|part| part == Component::ParentDir);
    drops().find(|drop| inner && fs::symlink_metadata(drop.join(path)).is_ok()).map(|d| (d, path.to_owned()))
}

/// Absolute, with the links in the folders resolved but not the last name, which may be a link that is looked at.
fn absolute(path: &Path) -> PathBuf {
    let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let (Some(folder), Some(name)) = (whole.parent(), whole.file_name()) else { return whole };
    fs::canonicalize(folder).map_or(whole.clone(), |folder| folder.join(name))
}

/// What the name alone says.
fn by_name(status: &Status, drop: &Path, mesh: &Path) -> Option<(Cause, String)> {
    let rules = &status.config.watch;
    for name in mesh.iter() {
        if let Some(pattern) = ignored_by(&rules.ignore, name) {
            let name = name.to_string_lossy();
            let words = format!(
                "{name} fits \"{pattern}\" of watch.ignore: it is still being written, or not meant to be scored; \
                 rename it when it is done"
            );
            return Some((Cause::IgnoredName, words));
        }
    }
    let depth = mesh.iter().count();
    if depth > rules.depth {
        let words = format!("it lies {depth} folders deep, watch.depth is {}", rules.depth);
        return Some((Cause::TooDeep, words));
    }
    let whole = absolute(&drop.join(mesh));
    let ours =
        [&status.places.results, &status.places.log].map(|path| absolute(&PathBuf::from(path.clone())));
    let ours = ours.iter().any(|path| whole.starts_with(path));
    ours.then(|| (Cause::Ours, "it lies among the results, which are not scanned".into()))
}

/// What the file is, and how far the daemon has come with it.
fn by_content(status: &Status, drop: &Path, mesh: &Path, state: &Path) -> anyhow::Result<(Cause, String)> {
    let path = drop.join(mesh);
    if let Err(error) = fs::symlink_metadata(&path) {
        return Ok(match error.kind() {
            std::io::ErrorKind::NotFound => (Cause::Absent, "there is no such file".into()),
            _ => (Cause::Unreadable, format!("it cannot be looked at: {error}")),
        });
    }
    let identity = match Walk::new(drop, &status.config.watch).look(mesh, true) {
        Some(Found::File(identity)) => identity,
        Some(Found::Other(what)) => return Ok((Cause::NotAFile, format!("it is {what}"))),
        None => return Ok((Cause::Absent, "it went away just now".into())),
    };
    if let Some(found) = in_hand(status, mesh) {
        return Ok(found);
    }
    let known = match State::read(state)? {
        Some(state) => state.known(Id::of(mesh, &identity))?,
        None => None,
    };
    if let Some(found) = known.and_then(|known| done(status, mesh, known)) {
        return Ok(found);
    }
    let queue = &status.queue;
    if queue.settling + queue.queued + queue.postponed + queue.awaiting > MOST_WAITING as u64 {
        let words = format!("it waits behind the first {MOST_WAITING}: {} are queued", queue.queued);
        return Ok((Cause::Queued, words));
    }
    let scan = status.config.watch.scan;
    Ok((
        Cause::NotSeen,
        match status.watches.first().and_then(|watched| watched.scanned.as_deref()) {
            Some(last) => {
                format!("the daemon has not come across it: it scans every {scan}, the last time at {last}")
            }
            None => "the daemon has not read the drop through yet".into(),
        },
    ))
}

/// What was done about this version, if that was its end.
fn done(status: &Status, mesh: &Path, known: Known) -> Option<(Cause, String)> {
    let when = known.ended.map(|ended| format!(" at {ended}")).unwrap_or_default();
    let why = known.failure.map(|(kind, reason)| format!(": {kind}: {reason}")).unwrap_or_default();
    Some(match known.stage {
        Stage::Scored => {
            let folder =
                PathBuf::from(status.places.results.clone()).join(mesh.parent().unwrap_or(Path::new("")));
            let summary =
                known.summary.map(|name| folder.join(name).display().to_string()).unwrap_or_default();
            (Cause::Scored, format!("it was scored{when}: {}: {summary}", known.verdict.unwrap_or_default()))
        }
        Stage::Failed => (Cause::Failed, format!("this version cannot be scored{when}{why}")),
        Stage::Quarantined => {
            (Cause::Quarantined, format!("it ended its worker too often and is in quarantine{when}{why}"))
        }
        Stage::Ignored => (Cause::Ignored, format!("it is no mesh, neither by name nor by content{when}")),
        Stage::Claimed | Stage::Waiting | Stage::Dropped => return None,
    })
}

/// What the daemon has in hand.
fn in_hand(status: &Status, mesh: &Path) -> Option<(Cause, String)> {
    let is = |path: &PathText| PathBuf::from(path.clone()) == mesh;
    if let Some(running) = status.running.iter().find(|running| is(&running.mesh)) {
        let words = format!("a worker has had it for {:.0} s: {}", running.seconds, running.phase);
        return Some((Cause::Running, words));
    }
    let waiting = status.waiting.iter().find(|waiting| is(&waiting.mesh))?;
    Some(match waiting.waits {
        Waits::Settling(more) => (
            Cause::Settling,
            format!(
                "it must stand still for {more:.1} s more; seen {:.0} s ago, {} bytes",
                waiting.seconds, waiting.bytes
            ),
        ),
        Waits::Queued(place) => (
            Cause::Queued,
            format!("it waits for a free worker at place {place}; {} are at work", status.queue.running),
        ),
        Waits::Postponed(more) => (
            Cause::Postponed,
            format!("it failed for a reason that may pass and is tried again in {more:.0} s"),
        ),
        Waits::Word => (
            Cause::Awaiting,
            format!(
                "no file beside it says that it is whole ({})",
                status.config.watch.sidecars.iter().map(|s| format!("*{s}")).collect::<Vec<_>>().join(", ")
            ),
        ),
    })
}
