//! The daemon's loop.

use std::collections::HashSet;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, select};

use super::Mode;
use super::hints::Hints;
use super::log::Event;
use super::pool::{Found as Scored, Job, Outcome, Pool};
use super::protocol::{Failure, FailureKind};
use super::record::Record;
use super::service::Service;
use super::telemetry::Telemetry;
use super::tracking::Tracking;
use crate::config::Config;
use crate::exit::Status;
use crate::folder::{Found, Walk};
use crate::identity::Identity;
use crate::names::has_mesh_extension;

/// How long the threads have to let go of their workers when we stop at once.
const LETTING_GO: Duration = Duration::from_secs(2);

/// Everything that the loop owns.
pub struct Watching {
    config: Config,
    mode: Mode,
    walk: Walk,
    hints: Hints,
    tracking: Tracking,
    pool: Pool,
    record: Record,
    service: Service,
    telemetry: Telemetry,
    status: Status,
    scored: u64,
    failed: u64,
    next_scan: Instant,
    next_look: Instant,
    /// When the drop was last read through, and how long that took.
    scanned: Option<(Instant, Duration)>,
}

/// Why the loop ended.
enum End {
    /// All is done that `--once` asks for.
    Drained,
    /// A signal.
    Asked(&'static str),
}

impl Watching {
    /// Ready to run.
    pub fn new(config: Config, walk: Walk, record: Record, telemetry: Telemetry, mode: Mode) -> Self {
        let now = Instant::now();
        Self {
            hints: Hints::new(config.watch.events && !mode.once),
            tracking: Tracking::new(config.watch.settle.0),
            pool: Pool::start(walk.root(), &config, &telemetry.work()),
            service: Service::new(),
            telemetry,
            status: Status::Fine,
            scored: 0,
            failed: 0,
            next_scan: now,
            next_look: now,
            scanned: None,
            config,
            mode,
            walk,
            record,
        }
    }

    /// Runs until there is a reason to stop, then stops in good order.
    pub fn run(mut self, stop: &Receiver<&'static str>) -> anyhow::Result<Status> {
        let end = self.watch(stop)?;
        let reason = match end {
            End::Drained => "everything is scored",
            End::Asked(signal) => signal,
        };
        self.service.stopping();
        let stopping = Event::info("daemon.stopping")
            .with("reason", reason)
            .with("running", self.tracking.running())
            .with("scored", self.scored)
            .with("failed", self.failed);
        self.record.event(stopping)?;
        self.drain(stop)?;
        self.telemetry.ended(reason, &self.tracking);
        Ok(if self.mode.once { self.status } else { Status::Fine })
    }

    fn watch(&mut self, stop: &Receiver<&'static str>) -> anyhow::Result<End> {
        loop {
            self.look()?;
            self.claim()?;
            self.service.alive();
            self.telemetry.turned(&self.tracking);
            if self.mode.once && self.tracking.is_empty() {
                return Ok(End::Drained);
            }
            select! {
                recv(stop) -> signal => return Ok(End::Asked(signal.unwrap_or("no more signals"))),
                recv(self.pool.outcomes()) -> outcome => self.finish(outcome?)?,
                recv(self.hints.due()) -> _ => self.hurry(),
                default(self.pause()) => {}
            }
        }
    }

    /// How long there is nothing to do, unless something happens.
    fn pause(&self) -> Duration {
        let next =
            if self.tracking.settling() > 0 { self.next_look.min(self.next_scan) } else { self.next_scan };
        let next = if self.mode.once { self.next_look } else { next };
        let pause = next.saturating_duration_since(Instant::now());
        let pause = pause.min(self.telemetry.longest_round());
        self.service.longest_round().map_or(pause, |longest| pause.min(longest))
    }

    /// An event: the next scan comes sooner. A scan that takes long is not made at every event.
    fn hurry(&mut self) {
        if let Some((end, took)) = self.scanned {
            self.next_scan = self.next_scan.min(end + self.between_looks().max(took * 10));
        }
    }

    /// How long to wait between two looks at a file that may still be changing.
    fn between_looks(&self) -> Duration {
        (self.config.watch.settle.0 / 4).clamp(Duration::from_millis(20), Duration::from_secs(5))
    }

    /// Looks at what is due to be looked at.
    fn look(&mut self) -> anyhow::Result<()> {
        let now = Instant::now();
        let scan_due = if self.mode.once { self.scanned.is_none() } else { now >= self.next_scan };
        if scan_due {
            self.scan()?;
        }
        if now >= self.next_look && self.tracking.settling() > 0 {
            for path in self.tracking.unsettled() {
                match self.walk.look(&path) {
                    Some(Found::File(identity)) => self.tracking.look(&path, identity, Instant::now()),
                    Some(Found::Other(_)) | None => drop(self.tracking.remove(&path)),
                }
            }
            self.give_up();
        }
        if now >= self.next_look {
            self.next_look = Instant::now() + self.between_looks();
        }
        Ok(())
    }

    /// Reads the drop through.
    fn scan(&mut self) -> anyhow::Result<()> {
        let start = Instant::now();
        let scan = self.walk.scan();
        for (path, error) in &scan.problems {
            tracing::warn!("{}: {error}", self.walk.root().join(path).display());
            if self.mode.once {
                self.status = self.status.max(Status::Unreadable);
            }
        }
        self.hints.follow(self.walk.root(), &scan.folders);
        let present: HashSet<_> = scan.files.iter().map(|(path, _)| path.as_path()).collect();
        self.tracking.keep(&present);
        let now = Instant::now();
        for (path, found) in &scan.files {
            match found {
                Found::Other(what) => {
                    if !self.record.is_done(path, &Identity::default())? {
                        self.record.ignored(path, &Identity::default(), &format!("it is {what}"))?;
                    }
                }
                Found::File(identity) if self.tracking.contains(path) => {
                    self.tracking.look(path, *identity, now);
                }
                Found::File(identity) if self.record.is_done(path, identity)? => {}
                Found::File(identity) => {
                    let is_mesh = has_mesh_extension(path.file_name().unwrap_or_default());
                    let announced = is_mesh || self.walk.root().join(path).is_dir();
                    if announced {
                        self.record.detected(path, identity)?;
                    }
                    self.tracking.add(path.clone(), *identity, now, announced);
                }
            }
        }
        self.record.scanned(scan.files.len());
        let end = Instant::now();
        if self.scanned.is_none() {
            self.service.ready();
        }
        self.telemetry.scanned(&scan, end - start);
        self.scanned = Some((end, end - start));
        self.next_scan = end + self.config.watch.scan.0;
        self.tell();
        Ok(())
    }

    /// With `--once` a file that is written for ever must not keep us for ever.
    fn give_up(&mut self) {
        if self.mode.once {
            for path in self.tracking.give_up(Instant::now(), self.config.watch.patience.0) {
                let path = self.walk.root().join(path);
                eprintln!("meshgauge: {}: it is still being written; left for the next run", path.display());
                self.status = self.status.max(Status::Unreadable);
            }
        }
    }

    /// Hands files to free workers.
    fn claim(&mut self) -> anyhow::Result<()> {
        while self.tracking.running() < self.config.worker.count {
            let Some((path, identity, announced)) = self.tracking.next() else { break };
            self.record.claimed(&path, &identity, announced)?;
            self.pool.give(Job { path, identity })?;
        }
        Ok(())
    }

    /// Puts down what became of a file.
    fn finish(&mut self, outcome: Outcome) -> anyhow::Result<()> {
        let Outcome { path, identity, result, time } = outcome;
        let announced = self.tracking.is_announced(&path);
        match result {
            Scored::Scored(summary) => {
                if !announced {
                    self.record.announced(&path, &identity)?;
                }
                self.record.scored(&path, &identity, &summary, time)?;
                self.status = self.status.max(Status::of_verdict(&summary.verdict));
                self.scored += 1;
                self.tracking.remove(&path);
            }
            Scored::Failed(failure) if !announced && is_no_mesh(&failure) => {
                let reason = "it has neither the extension nor the content of a mesh";
                self.record.ignored(&path, &identity, reason)?;
                self.tracking.remove(&path);
            }
            Scored::Failed(failure) => {
                if !announced {
                    self.record.announced(&path, &identity)?;
                }
                self.fail(path, &identity, &failure)?;
            }
            Scored::Changed => self.start_over(path, &identity, announced)?,
            Scored::Gone => {
                self.record.gone(&path, &identity, announced)?;
                self.tracking.remove(&path);
            }
            // Its claim stands in the ledger; the next start takes it up.
            Scored::Abandoned => drop(self.tracking.remove(&path)),
        }
        self.tell();
        Ok(())
    }

    fn fail(&mut self, path: PathBuf, identity: &Identity, failure: &Failure) -> anyhow::Result<()> {
        self.record.failed(&path, identity, failure)?;
        self.status = self.status.max(failure.status());
        self.failed += 1;
        if failure.kind.is_resource() && !self.mode.once {
            let retry = Instant::now() + self.config.worker.retry.0;
            self.tracking.postpone(&path, *identity, retry);
        } else {
            self.tracking.remove(&path);
        }
        Ok(())
    }

    /// The file changed while it was read.
    fn start_over(&mut self, path: PathBuf, identity: &Identity, announced: bool) -> anyhow::Result<()> {
        self.record.changed(&path, identity, announced)?;
        match self.walk.look(&path) {
            Some(Found::File(now)) => self.tracking.unsettle(&path, now, Instant::now()),
            Some(Found::Other(_)) | None => drop(self.tracking.remove(&path)),
        }
        Ok(())
    }

    /// Finishes what is running, within the time that is allowed; a further signal ends it now.
    fn drain(&mut self, stop: &Receiver<&'static str>) -> anyhow::Result<()> {
        let mut deadline = Instant::now() + self.config.watch.drain.0;
        let mut abandoned = false;
        while self.tracking.running() > 0 {
            let left = deadline.saturating_duration_since(Instant::now());
            let left = left.min(self.telemetry.longest_round());
            let round = self.service.longest_round().map_or(left, |longest| left.min(longest));
            self.service.alive();
            self.telemetry.turned(&self.tracking);
            select! {
                recv(self.pool.outcomes()) -> outcome => self.finish(outcome?)?,
                recv(stop) -> _ => deadline = Instant::now(),
                default(round) => {}
            }
            if Instant::now() >= deadline {
                if abandoned {
                    break;
                }
                self.pool.abandon();
                (abandoned, deadline) = (true, Instant::now() + LETTING_GO);
            }
        }
        Ok(())
    }

    fn tell(&self) {
        let waiting = self.tracking.len() - self.tracking.running();
        let running = self.tracking.running();
        let (scored, failed) = (self.scored, self.failed);
        self.service
            .status(&format!("{running} running, {waiting} waiting, {scored} scored, {failed} failed"));
    }
}

/// Whether a failure means that the file is no mesh, if its name says nothing.
fn is_no_mesh(failure: &Failure) -> bool {
    matches!(failure.kind, FailureKind::UnknownFormat | FailureKind::Empty)
}
