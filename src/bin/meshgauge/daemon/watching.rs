//! The daemon's loop: one thread owns all state, and waits for whatever comes first.

use std::collections::{HashSet, VecDeque};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, select};

use super::degraded::Degraded;
use super::hints::Hints;
use super::log::Event;
use super::mount::Mount;
use super::pool::{Job, MOST_SEATS, Outcome, Pool, shared_out};
use super::producer::Producer;
use super::record::Record;
use super::scanners::{Rules, Scanners};
use super::service::Service;
use super::signals::Requests;
use super::telemetry::Telemetry;
use super::tracking::{State, Tracking};
use super::{Mode, Places, ReadConfig};
use crate::config::Config;
use crate::exit::Status;
use crate::folder::Walk;
use crate::measuring;

/// How long the threads have to let go of their workers when we stop at once.
const LETTING_GO: Duration = Duration::from_secs(2);

/// No round of the loop is longer, so that what is due by the clock is done in time.
const LONGEST_ROUND: Duration = Duration::from_secs(2);

/// Everything that the loop owns.
pub struct Watching<'c> {
    pub(super) config: Arc<Config>,
    /// That of the start.
    pub(super) started: Arc<Config>,
    /// The same, for workers that share the processors.
    pub(super) worker_config: Arc<Config>,
    pub(super) read_config: ReadConfig<'c>,
    pub(super) places: Places,
    pub(super) mode: Mode,
    /// The drop as an absolute path without links, once it could be found out.
    pub(super) root: Option<PathBuf>,
    pub(super) rules: Arc<Rules>,
    pub(super) scanners: Scanners,
    pub(super) hints: Hints,
    /// What arrived by rename and was not come upon yet.
    pub(super) renamed: HashSet<PathBuf>,
    /// What could not be looked at, to complain about it once.
    pub(super) problems: HashSet<PathBuf>,
    pub(super) tracking: Tracking,
    pub(super) looked_for_stragglers: Instant,
    pub(super) pool: Pool,
    /// What workers found and is not put down yet.
    pub(super) pending: VecDeque<Outcome>,
    pub(super) degraded: Option<Degraded>,
    pub(super) record: Record,
    pub(super) service: Service,
    pub(super) telemetry: Telemetry,
    pub(super) status: Status,
    pub(super) scored: u64,
    pub(super) failed: u64,
    pub(super) ready: bool,
}

/// Why the loop ended.
enum End {
    /// All is done that `--once` asks for.
    Drained,
    /// A signal.
    Asked(&'static str),
}

impl<'c> Watching<'c> {
    /// Ready to run.
    pub fn new(
        config: Config,
        places: Places,
        mode: Mode,
        record: Record,
        telemetry: Telemetry,
        read_config: ReadConfig<'c>,
    ) -> Self {
        let rules = Arc::new(rules(&config, &places));
        let worker_config = Arc::new(shared_out(config.clone()));
        let config = Arc::new(config);
        Self {
            root: std::fs::canonicalize(&places.drop).ok(),
            scanners: Scanners::new(),
            hints: Hints::new(config.watch.events && !mode.once),
            renamed: HashSet::new(),
            problems: HashSet::new(),
            tracking: Tracking::default(),
            looked_for_stragglers: Instant::now(),
            pool: Pool::new(&places.drop, telemetry.work()),
            pending: VecDeque::new(),
            degraded: None,
            service: Service::new(),
            telemetry,
            status: Status::Fine,
            scored: 0,
            failed: 0,
            ready: false,
            worker_config,
            started: Arc::clone(&config),
            config,
            read_config,
            places,
            mode,
            rules,
            record,
        }
    }

    /// Runs until there is a reason to stop, then stops in good order.
    pub fn run(mut self, requests: &Requests) -> anyhow::Result<Status> {
        let end = self.watch(requests)?;
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
        let told = self.record.event(stopping);
        self.bear(told)?;
        self.drain(&requests.stop)?;
        self.telemetry.ended(reason, &self.tracking);
        Ok(if self.mode.once { self.status } else { Status::Fine })
    }

    fn watch(&mut self, requests: &Requests) -> anyhow::Result<End> {
        loop {
            let held = self.record.hold();
            self.bear(held)?;
            self.recover()?;
            self.mind_log()?;
            self.ask_scanners()?;
            self.claim()?;
            self.turned();
            if self.mode.once && self.is_all_done() {
                return Ok(End::Drained);
            }
            select! {
                recv(requests.stop) -> signal => return Ok(End::Asked(signal.unwrap_or("no more signals"))),
                recv(requests.reload) -> _ => self.reload()?,
                recv(requests.reopen) -> _ => self.reopen()?,
                recv(self.pool.outcomes()) -> outcome => self.take(outcome?)?,
                recv(self.scanners.reports()) -> report => self.hear(report?)?,
                recv(self.hints.due()) -> _ => self.hurry(),
                default(self.pause()) => {}
            }
        }
    }

    fn is_all_done(&self) -> bool {
        self.tracking.is_empty()
            && self.pending.is_empty()
            && self.scanners.mounts().values().all(|mount| {
                (mount.scanned.is_some() && mount.left_over == 0 && mount.busy.is_none())
                    || mount.hangs().is_some()
            })
    }

    /// How long there is nothing to do, unless something happens.
    fn pause(&self) -> Duration {
        let due = match &self.degraded {
            Some(degraded) => Some(degraded.next_try),
            None => {
                let mounts = self.scanners.mounts().values().filter(|mount| mount.busy.is_none());
                mounts.filter_map(|mount| self.due(mount)).min()
            }
        };
        let now = Instant::now();
        let pause = due.map_or(LONGEST_ROUND, |due| due.saturating_duration_since(now)).min(LONGEST_ROUND);
        let pause = pause.min(self.telemetry.longest_round());
        self.service.longest_round().map_or(pause, |longest| pause.min(longest))
    }

    /// When something is to be asked of a mount whose thread has nothing to do.
    fn due(&self, mount: &Mount) -> Option<Instant> {
        let look = (self.tracking.settling() > 0).then_some(mount.next_look);
        let scan = (!self.mode.once).then_some(mount.next_scan);
        [look, scan].into_iter().flatten().min()
    }

    /// Hands files to workers.
    fn claim(&mut self) -> anyhow::Result<()> {
        let most = (self.config.worker.count + self.stuck()).min(MOST_SEATS);
        while self.degraded.is_none() && self.tracking.running() < most {
            let Some(next) = self.tracking.next() else { break };
            let claimed = self.record.claimed(&next.path, &next.identity, next.announced);
            if self.bear(claimed)?.is_none() {
                break;
            }
            let config = measuring::config_for(&self.worker_config, &next.path);
            let job = Job { path: next.path.clone(), identity: next.identity, config };
            self.pool.give(job, self.tracking.running())?;
            self.tracking.run(&next);
        }
        Ok(())
    }

    /// How many workers have a file on a mount that hangs, and are none to reckon with.
    fn stuck(&self) -> usize {
        let hanging: Vec<_> = self
            .scanners
            .mounts()
            .values()
            .filter(|mount| mount.hangs().is_some())
            .map(|mount| mount.id)
            .collect();
        if hanging.is_empty() {
            return 0;
        }
        let running = self.tracking.files().filter(|(_, file)| matches!(file.state, State::Running));
        running.filter(|(_, file)| hanging.contains(&file.mount)).count()
    }

    /// Finishes what is running, within the time that is allowed; a further signal ends it now.
    fn drain(&mut self, stop: &Receiver<&'static str>) -> anyhow::Result<()> {
        let mut deadline = Instant::now() + self.config.watch.drain.0;
        let mut abandoned = false;
        self.put_down()?;
        // What cannot be put down for want of room is scored again after the next start.
        while self.tracking.running() > self.pending.len() {
            let left = deadline.saturating_duration_since(Instant::now());
            let left = left.min(self.telemetry.longest_round());
            let round = self.service.longest_round().map_or(left, |longest| left.min(longest));
            self.turned();
            select! {
                recv(self.pool.outcomes()) -> outcome => self.take(outcome?)?,
                recv(stop) -> _ => deadline = Instant::now(),
                // The threads that look at the drop are waited for by nobody.
                recv(self.scanners.reports()) -> _ => {}
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

    /// Tells whoever watches us that the loop turned.
    fn turned(&mut self) {
        self.service.alive();
        self.telemetry.mounts(self.scanners.mounts());
        self.telemetry.turned(&self.tracking);
    }

    /// Tells the service manager what is going on.
    pub(super) fn tell(&self) {
        let waiting = self.tracking.len() - self.tracking.running();
        let running = self.tracking.running();
        let (scored, failed) = (self.scored, self.failed);
        let counts = format!("{running} running, {waiting} waiting, {scored} scored, {failed} failed");
        match &self.degraded {
            Some(degraded) => self.service.status(&format!("{}; {counts}", degraded.reason)),
            None => self.service.status(&counts),
        }
    }
}

/// How the drop is looked at.
pub(super) fn rules(config: &Config, places: &Places) -> Rules {
    let mut walk = Walk::new(&places.drop, &config.watch);
    for ours in
        [&places.results, &places.state, &places.log, &config.score.scratch, &config.telemetry.metrics_file]
    {
        walk.exclude(ours);
    }
    Rules { walk, producer: Producer::new(&config.watch) }
}
