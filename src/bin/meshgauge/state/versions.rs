//! Versions of meshes, and how far each has come.

use std::path::Path;

use rusqlite::{OptionalExtension, params};

use super::{Id, State, now};
use crate::identity::Identity;

/// How far a version has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// A worker has it.
    Claimed,
    /// Its summary is published.
    Scored,
    /// It cannot be scored; the log says why.
    Failed,
    /// It failed for a reason that may pass.
    Waiting,
    /// Workers ended abnormally over it too often.
    Quarantined,
    /// It is no mesh.
    Ignored,
    /// It changed or went away before it was scored.
    Dropped,
}

/// Why a version has no score.
#[derive(Debug, Clone, Copy)]
pub struct Failed<'t> {
    /// The sort.
    pub kind: &'t str,
    /// In words.
    pub reason: &'t str,
    /// Whether the worker ended abnormally.
    pub abnormal: bool,
}

/// A version that a worker is about to get.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Claim {
    /// How often that is.
    pub attempt: u32,
    /// Whether it is because an earlier attempt failed.
    pub again: bool,
}

/// What was tried with a version.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Tries {
    /// How often a worker got it.
    pub attempts: u32,
    /// How often that worker ended abnormally.
    pub abnormal: u32,
}

/// All stages.
const STAGES: [Stage; 7] = [
    Stage::Claimed,
    Stage::Scored,
    Stage::Failed,
    Stage::Waiting,
    Stage::Quarantined,
    Stage::Ignored,
    Stage::Dropped,
];

/// The stages of versions that nothing is left to do for.
const END: [Stage; 4] = [Stage::Scored, Stage::Failed, Stage::Quarantined, Stage::Ignored];

impl Stage {
    /// The name that stands in the database.
    pub fn name(self) -> &'static str {
        match self {
            Stage::Claimed => "claimed",
            Stage::Scored => "scored",
            Stage::Failed => "failed",
            Stage::Waiting => "waiting",
            Stage::Quarantined => "quarantined",
            Stage::Ignored => "ignored",
            Stage::Dropped => "dropped",
        }
    }

    /// The stage of that name.
    pub(super) fn of_name(name: &str) -> Option<Self> {
        STAGES.into_iter().find(|stage| stage.name() == name)
    }

    /// Whether nothing is left to do for a version at this stage.
    pub fn is_end(self) -> bool {
        END.contains(&self)
    }
}

impl State {
    /// Whether nothing is left to do for the version.
    pub fn is_done(&self, id: Id) -> anyhow::Result<bool> {
        let query = "SELECT stage FROM version WHERE id = ?1";
        let mut statement = self.connection.prepare_cached(query)?;
        let stage = statement.query_row([id.to_string()], |row| row.get::<_, String>(0)).optional()?;
        Ok(stage.is_some_and(|stage| END.iter().any(|end| end.name() == stage)))
    }

    /// Puts down that a worker is about to get the version. Versions that came to nothing before are forgotten.
    pub fn claim(&self, path: &Path, identity: &Identity) -> anyhow::Result<Claim> {
        let (mesh, id) = (self.mesh(path)?, Id::of(path, identity).to_string());
        let forget =
            "DELETE FROM version WHERE mesh = ?1 AND id <> ?2 AND stage IN ('dropped', 'claimed', 'waiting')";
        self.connection.prepare_cached(forget)?.execute(params![mesh, id])?;
        self.insert(mesh, &id, identity, Stage::Claimed)?;
        let query = "SELECT attempts, stage = 'waiting' FROM version WHERE id = ?1";
        let mut statement = self.connection.prepare_cached(query)?;
        let (attempts, again): (u32, bool) =
            statement.query_row([&id], |row| Ok((row.get(0)?, row.get(1)?)))?;
        let update =
            "UPDATE version SET stage = 'claimed', attempts = attempts + 1, claimed = ?2 WHERE id = ?1";
        self.connection.prepare_cached(update)?.execute(params![id, now()])?;
        Ok(Claim { attempt: attempts.saturating_add(1), again })
    }

    /// What was tried with the version.
    pub fn tries(&self, id: Id) -> anyhow::Result<Tries> {
        let query = "SELECT attempts, abnormal FROM version WHERE id = ?1";
        let tries = self
            .connection
            .prepare_cached(query)?
            .query_row([id.to_string()], |row| Ok(Tries { attempts: row.get(0)?, abnormal: row.get(1)? }));
        Ok(tries.optional()?.unwrap_or_default())
    }

    fn insert(&self, mesh: i64, id: &str, identity: &Identity, stage: Stage) -> anyhow::Result<()> {
        let insert = "INSERT INTO version (id, mesh, bytes, inode, modified_ns, changed_ns, stage)
                      VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7) ON CONFLICT (id) DO NOTHING";
        self.connection.prepare_cached(insert)?.execute(params![
            id,
            mesh,
            // Numbers of 64 bits without sign keep their bits.
            identity.size.cast_signed(),
            identity.inode.cast_signed(),
            nanoseconds(identity.modified),
            nanoseconds(identity.changed),
            stage.name()
        ])?;
        Ok(())
    }

    /// Puts down that the version is no mesh. Of a path that is none, one version is remembered.
    pub fn ignore(&self, path: &Path, identity: &Identity) -> anyhow::Result<()> {
        let (mesh, id) = (self.mesh(path)?, Id::of(path, identity).to_string());
        let forget = "DELETE FROM version WHERE mesh = ?1 AND id <> ?2 AND stage IN ('ignored', 'dropped')";
        self.connection.prepare_cached(forget)?.execute(params![mesh, id])?;
        self.insert(mesh, &id, identity, Stage::Ignored)?;
        self.end(Id::of(path, identity), Stage::Ignored, None)
    }

    /// Puts down what became of a version.
    pub fn end(&self, id: Id, stage: Stage, failed: Option<Failed<'_>>) -> anyhow::Result<()> {
        let update =
            "UPDATE version SET stage = ?2, ended = ?3, kind = ?4, reason = ?5, abnormal = abnormal + ?6
                      WHERE id = ?1";
        let (kind, reason) = (failed.map(|f| f.kind), failed.map(|f| f.reason));
        let abnormal = failed.is_some_and(|failed| failed.abnormal);
        let mut statement = self.connection.prepare_cached(update)?;
        statement.execute(params![id.to_string(), stage.name(), now(), kind, reason, abnormal])?;
        Ok(())
    }

    /// The number of the version's row.
    pub(super) fn version(&self, id: Id) -> rusqlite::Result<i64> {
        let query = "SELECT version FROM version WHERE id = ?1";
        self.connection.prepare_cached(query)?.query_row([id.to_string()], |row| row.get(0))
    }
}

/// Seconds and nanoseconds as nanoseconds; times that do not fit (beyond the year 2262) as the nearest that does.
fn nanoseconds((seconds, nanoseconds): (i64, i64)) -> i64 {
    seconds.saturating_mul(1_000_000_000).saturating_add(nanoseconds)
}

#[cfg(test)]
mod tests {
    use super::super::tests::open;
    use super::*;

    fn identity(size: u64) -> Identity {
        Identity { device: 1, inode: u64::MAX, size, modified: (3, 4), changed: (5, 6), blocks: 8 }
    }

    #[test]
    fn what_is_done_is_known_after_a_restart_and_another_version_is_not() {
        let (state, folder) = open();
        let mesh = Path::new("a/pit.inp");
        let id = |size| Id::of(mesh, &identity(size));
        state.claim(mesh, &identity(1)).expect("claimed");
        assert!(!state.is_done(id(1)).expect("read"));
        state.end(id(1), Stage::Scored, None).expect("ended");
        drop(state);
        let state = State::open(folder.path()).expect("opened again");
        assert!(state.is_done(id(1)).expect("read"));
        let another_mount = Identity { device: 9, blocks: 0, ..identity(1) };
        assert_eq!(Id::of(mesh, &another_mount), id(1));
        assert!(!state.is_done(id(2)).expect("read"));
        state.claim(mesh, &identity(2)).expect("claimed");
        let failed = Failed { kind: "malformed", reason: "expected a number", abnormal: false };
        state.end(id(2), Stage::Failed, Some(failed)).expect("ended");
        assert!(state.is_done(id(1)).expect("read") && state.is_done(id(2)).expect("read"));
    }

    #[test]
    fn attempts_and_abnormal_ends_are_counted_over_restarts() {
        let (mut state, folder) = open();
        let (mesh, identity) = (Path::new("pit.inp"), identity(1));
        let id = Id::of(mesh, &identity);
        for attempt in 1..4 {
            let claim = state.claim(mesh, &identity).expect("claimed");
            assert_eq!(claim, Claim { attempt, again: attempt > 1 });
            let died = Failed { kind: "worker_died", reason: "SIGKILL", abnormal: true };
            state.end(id, Stage::Waiting, Some(died)).expect("ended");
            drop(state);
            state = State::open(folder.path()).expect("opened again");
            let tries = Tries { attempts: attempt, abnormal: attempt };
            assert_eq!(state.tries(id).expect("read"), tries);
            assert!(!state.is_done(id).expect("read"));
        }
    }

    #[test]
    fn a_path_that_is_no_mesh_takes_one_row_however_often_it_changes() {
        let (state, _folder) = open();
        for size in 1..10 {
            state.claim(Path::new("notes.txt"), &identity(size)).expect("claimed");
            state.ignore(Path::new("notes.txt"), &identity(size)).expect("ignored");
        }
        let count = state.connection.query_row("SELECT count(*) FROM version", [], |row| row.get(0));
        assert_eq!(count, Ok(1));
        assert!(state.is_done(Id::of(Path::new("notes.txt"), &identity(9))).expect("read"));
    }
}
