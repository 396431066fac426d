//! A fixed number of threads, each with a worker process that it replaces when that dies.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, Sender, bounded};
use meshgauge::Summary;

use super::process::{NoAnswer, Process, deadline};
use super::protocol::{Answer, Failure, FailureKind, Request};
use super::work::Work;
use crate::config::Config;
use crate::identity::Identity;
use crate::path_text::PathText;

/// A mesh to score.
pub struct Job {
    /// Its path within the drop.
    pub path: PathBuf,
    /// The version that settled.
    pub identity: Identity,
    /// How it is to be scored.
    pub config: Arc<Config>,
}

/// What became of a job.
pub struct Outcome {
    /// The mesh's path within the drop.
    pub path: PathBuf,
    /// The version that settled.
    pub identity: Identity,
    /// What was found.
    pub result: Found,
    /// How long it took.
    pub time: Duration,
}

/// What was found.
pub enum Found {
    /// A summary of the version that settled.
    Scored(Box<Summary>),
    /// The reason why there is none.
    Failed(Failure),
    /// Another version.
    Changed,
    /// Nothing.
    Gone,
    /// We had to give up.
    Abandoned,
}

/// The threads.
pub struct Pool {
    drop: PathBuf,
    jobs: Sender<Job>,
    queue: Receiver<Job>,
    sender: Sender<Outcome>,
    outcomes: Receiver<Outcome>,
    abandoned: Arc<AtomicBool>,
    work: Work,
    seats: usize,
}

/// Never more threads than this, whatever hangs.
pub const MOST_SEATS: usize = 1024;

impl Pool {
    /// No threads yet; what they are at is put down in `work`.
    pub fn new(drop: &Path, work: Work) -> Self {
        let (jobs, queue) = bounded(MOST_SEATS);
        let (sender, outcomes) = bounded(MOST_SEATS);
        let abandoned = Arc::new(AtomicBool::new(false));
        Self { drop: drop.to_owned(), jobs, queue, sender, outcomes, abandoned, work, seats: 0 }
    }

    /// Hands a job over, where `running` others are not done. There is a thread for each, so this does not wait; its
    /// process starts with its first mesh.
    pub fn give(&mut self, job: Job, running: usize) -> anyhow::Result<()> {
        if running >= self.seats {
            self.start();
        }
        self.jobs.send(job).map_err(|_| anyhow::anyhow!("the threads that mind the workers are gone"))
    }

    fn start(&mut self) {
        self.seats += 1;
        let (queue, sender) = (self.queue.clone(), self.sender.clone());
        let mut seat = Seat {
            drop: self.drop.clone(),
            process: None,
            abandoned: Arc::clone(&self.abandoned),
            work: self.work.clone(),
        };
        std::thread::spawn(move || {
            for job in queue {
                let start = Instant::now();
                seat.work.begin(&job.path, job.identity.size);
                let result = seat.score(&job);
                seat.work.end(&job.path);
                let Job { path, identity, .. } = job;
                if sender.send(Outcome { path, identity, result, time: start.elapsed() }).is_err() {
                    break;
                }
            }
        });
    }

    /// Gets what became of the jobs.
    pub fn outcomes(&self) -> &Receiver<Outcome> {
        &self.outcomes
    }

    /// Gives up on all jobs.
    pub fn abandon(&self) {
        self.abandoned.store(true, Ordering::Relaxed);
    }
}

/// The configuration for one of several workers that share the processors.
pub fn shared_out(mut config: Config) -> Config {
    if config.score.threads == 0 {
        let processors = std::thread::available_parallelism().map_or(1, usize::from);
        config.score.threads = (processors / config.worker.count).max(1);
    }
    config
}

/// One thread's place.
struct Seat {
    drop: PathBuf,
    process: Option<Process>,
    abandoned: Arc<AtomicBool>,
    work: Work,
}

impl Seat {
    fn score(&mut self, job: &Job) -> Found {
        let path = self.drop.join(&job.path);
        if let Some(other) = other_version(&path, &job.identity) {
            return other;
        }
        let found = match self.ask(&path, job) {
            Ok(Answer::Scored(summary)) => Found::Scored(summary),
            Ok(Answer::Failed(failure)) => Found::Failed(failure),
            Err(NoAnswer::Abandoned) => return Found::Abandoned,
            Err(NoAnswer::TimedOut) => {
                let reason = format!("it took longer than {}", job.config.worker.time);
                Found::Failed(Failure::new(FailureKind::Timeout, reason))
            }
            Err(NoAnswer::Died(how)) => Found::Failed(Failure::of_death(how)),
        };
        // Whatever was found is about one version only if it is still that one.
        other_version(&path, &job.identity).unwrap_or(found)
    }

    fn ask(&mut self, path: &Path, job: &Job) -> Result<Answer, NoAnswer> {
        let request = Request { path: PathText::from(path), config: Config::clone(&job.config) };
        let mut line = serde_json::to_vec(&request).map_err(|e| NoAnswer::Died(e.to_string()))?;
        line.push(b'\n');
        let mut process = match self.ready(&line) {
            Ok(process) => process,
            Err(error) => {
                let reason = format!("no worker could be started: {error}");
                return Ok(Answer::Failed(Failure::new(FailureKind::Resource, reason)));
            }
        };
        let abandoned = Arc::clone(&self.abandoned);
        let answer = process.answer(
            deadline(job.config.worker.time.0),
            || abandoned.load(Ordering::Relaxed),
            |progress| self.work.heard(&job.path, progress),
        );
        if answer.is_ok() {
            self.process = Some(process);
        }
        answer
    }

    /// A worker that has the request. One that died idle is no mesh's fault and is replaced.
    fn ready(&mut self, request: &[u8]) -> io::Result<Process> {
        if let Some(mut process) = self.process.take()
            && process.is_alive()
            && process.send(request).is_ok()
        {
            return Ok(process);
        }
        let mut process = Process::start()?;
        process.send(request)?;
        Ok(process)
    }
}

/// What stands under the name, if it is not the version that settled.
fn other_version(path: &Path, identity: &Identity) -> Option<Found> {
    match Identity::of(path) {
        Ok(now) if identity.same_version(&now) => None,
        Ok(_) => Some(Found::Changed),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Some(Found::Gone),
        // The worker will meet the same error and say so.
        Err(_) => None,
    }
}
