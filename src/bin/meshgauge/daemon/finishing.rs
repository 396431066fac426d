//! What became of a mesh, put down; as often as it takes.

use std::path::Path;
use std::time::{Duration, Instant};

use super::pool::{Found as Scored, Outcome};
use super::protocol::{Failure, FailureKind, Then};
use super::watching::Watching;
use crate::identity::Identity;

/// So often is a file tried that its file system gave an error for.
const TRIES: u32 = 5;

/// Tries come further and further apart, up to this.
const LONGEST_WAIT: Duration = Duration::from_secs(3600);

/// What is left to do for a file that was not scored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Nothing.
    Failed,
    /// Another try, after so long.
    Again(Duration),
    /// Nothing: it ended its workers too often.
    Quarantined,
}

impl Watching<'_> {
    /// Takes an outcome in, and puts down what there is room for.
    pub(super) fn take(&mut self, outcome: Outcome) -> anyhow::Result<()> {
        self.pending.push_back(outcome);
        self.put_down()
    }

    /// Puts down what workers found, unless there is no room: then it is tried again when there is.
    pub(super) fn put_down(&mut self) -> anyhow::Result<()> {
        // We may have stood still since the loop last turned.
        let held = self.record.hold();
        if self.bear(held)?.is_none() {
            return Ok(());
        }
        while let Some(outcome) = self.pending.pop_front() {
            let result = self.finish(&outcome);
            if self.bear(result)?.is_none() {
                self.pending.push_front(outcome);
                break;
            }
            self.tell();
        }
        Ok(())
    }

    /// Puts down what became of a file. It may be called again after it failed half-way.
    fn finish(&mut self, outcome: &Outcome) -> anyhow::Result<()> {
        let Outcome { path, identity, result, time } = outcome;
        let announced = self.tracking.is_announced(path);
        match result {
            Scored::Scored(summary) => {
                self.announce(path, identity, announced)?;
                self.record.scored(path, identity, summary, *time)?;
                self.status = self.status.max(crate::exit::Status::of_verdict(&summary.verdict));
                self.scored += 1;
                self.tracking.remove(path);
            }
            Scored::Failed(failure) if !announced && is_no_mesh(failure) => {
                let reason = "it has neither the extension nor the content of a mesh";
                self.record.ignored(path, identity, reason)?;
                self.tracking.remove(path);
            }
            Scored::Failed(failure) => {
                self.announce(path, identity, announced)?;
                self.fail(path, identity, failure)?;
            }
            Scored::Changed => {
                self.record.changed(path, identity, announced)?;
                // The next look finds out what stands there now.
                self.tracking.unsettle(path, *identity, Instant::now());
            }
            Scored::Gone => {
                self.record.gone(path, identity, announced)?;
                self.tracking.remove(path);
            }
            // Its claim stands in the database; the next start takes it up.
            Scored::Abandoned => drop(self.tracking.remove(path)),
        }
        Ok(())
    }

    fn announce(&mut self, path: &Path, identity: &Identity, announced: bool) -> anyhow::Result<()> {
        if !announced {
            self.record.announced(path, identity)?;
            self.tracking.announce(path);
        }
        Ok(())
    }

    fn fail(&mut self, path: &Path, identity: &Identity, failure: &Failure) -> anyhow::Result<()> {
        let tries = self.record.tries(path, identity)?;
        let worker = &self.config.worker;
        let verdict =
            verdict(failure.kind, tries.attempts, tries.abnormal + 1, worker.quarantine, worker.retry.0);
        self.record.failed(path, identity, failure, verdict)?;
        self.status = self.status.max(failure.status());
        self.failed += 1;
        match verdict {
            Verdict::Again(wait) if !self.mode.once => {
                self.tracking.postpone(path, *identity, Instant::now() + wait);
            }
            _ => drop(self.tracking.remove(path)),
        }
        Ok(())
    }
}

/// What is left to do after a failure of this kind, the `attempts`-th try, by which a worker has ended abnormally
/// `abnormal` times if the kind is an abnormal one.
fn verdict(kind: FailureKind, attempts: u32, abnormal: u32, quarantine: u32, retry: Duration) -> Verdict {
    let doublings = attempts.saturating_sub(1).min(16);
    let again = Verdict::Again(retry.saturating_mul(1 << doublings).min(LONGEST_WAIT.max(retry)));
    match kind.then() {
        Then::Leave => Verdict::Failed,
        Then::Retry => again,
        Then::RetrySome if attempts < TRIES => again,
        Then::RetrySome => Verdict::Failed,
        Then::Quarantine if abnormal < quarantine => Verdict::Again(retry),
        Then::Quarantine => Verdict::Quarantined,
    }
}

/// Whether a failure means that the file is no mesh, if its name says nothing.
fn is_no_mesh(failure: &Failure) -> bool {
    matches!(failure.kind, FailureKind::UnknownFormat | FailureKind::Empty)
}

#[cfg(test)]
mod tests {
    use super::*;

    const MINUTE: Duration = Duration::from_secs(60);

    #[test]
    fn a_file_is_tried_again_as_its_failure_deserves() {
        let after = |kind, attempts, abnormal| verdict(kind, attempts, abnormal, 2, MINUTE);
        assert_eq!(after(FailureKind::Malformed, 1, 1), Verdict::Failed);
        assert_eq!(after(FailureKind::LimitLineBytes, 1, 1), Verdict::Failed);
        assert_eq!(after(FailureKind::WorkerDied, 1, 1), Verdict::Again(MINUTE));
        for kind in [FailureKind::WorkerDied, FailureKind::Timeout, FailureKind::Memory] {
            assert_eq!(after(kind, 2, 2), Verdict::Quarantined);
        }
        let waits: Vec<_> = (1..=5).map(|attempts| after(FailureKind::IoError, attempts, 1)).collect();
        let again = |minutes| Verdict::Again(minutes * MINUTE);
        assert_eq!(waits, [again(1), again(2), again(4), again(8), Verdict::Failed]);
        assert_eq!(after(FailureKind::Resource, 1000, 1), Verdict::Again(LONGEST_WAIT));
    }
}
