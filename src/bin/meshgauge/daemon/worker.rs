//! The other end of the pipe: a process that scores one mesh after another, within limits that it sets on itself.

use std::io::{self, BufRead, BufReader, Read, Write, stdin, stdout};
use std::path::PathBuf;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;

use anyhow::Context;
use crossbeam_channel::{RecvTimeoutError, Sender, bounded};
use rustix::process::{Resource, Rlimit, Signal, getppid, getrlimit, setrlimit};

use super::protocol::{Answer, Failure, FailureKind, Progress, Request, Said};

/// How often we say how far we are.
const TELL: Duration = Duration::from_secs(1);

/// Longest request.
const LONGEST_REQUEST: u64 = 1 << 20;

/// Answers the requests on standard input until there are no more, or the process `parent` is gone.
pub fn serve(parent: u32) -> anyhow::Result<()> {
    rustix::process::set_parent_process_death_signal(Some(Signal::KILL))?;
    if getppid().map(|pid| pid.as_raw_nonzero().get().unsigned_abs()) != Some(parent) {
        return Ok(());
    }
    // A core dump of a large mesh would fill the disk.
    lower(Resource::Core, 0);
    let mut requests = BufReader::new(stdin().lock());
    let mut line = Vec::new();
    while requests.by_ref().take(LONGEST_REQUEST).read_until(b'\n', &mut line)? > 0 {
        let request: Request = serde_json::from_slice(&line).context("a request was not understood")?;
        let progress = Arc::new(meshgauge::Progress::default());
        let telling = Telling::start(Arc::clone(&progress))?;
        let answer = answer(request, progress);
        drop(telling);
        say(&Said::Answer(answer))?;
        line.clear();
    }
    Ok(())
}

/// A thread that says how far the run is, until it is dropped.
struct Telling {
    end: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Telling {
    fn start(progress: Arc<meshgauge::Progress>) -> io::Result<Self> {
        let (end, ended) = bounded::<()>(0);
        let tell = move || {
            while ended.recv_timeout(TELL) == Err(RecvTimeoutError::Timeout) {
                // Without the daemon we are about to end anyway.
                let _ = say(&Said::Progress(Progress::from(&*progress)));
            }
        };
        let thread = std::thread::Builder::new().name("progress".into()).spawn(tell)?;
        Ok(Self { end: Some(end), thread: Some(thread) })
    }
}

impl Drop for Telling {
    fn drop(&mut self) {
        self.end = None;
        if let Some(thread) = self.thread.take() {
            // It has nothing to say.
            let _ = thread.join();
        }
    }
}

fn say(what: &Said) -> io::Result<()> {
    let mut line = serde_json::to_vec(what)?;
    line.push(b'\n');
    let mut out = stdout().lock();
    out.write_all(&line)?;
    out.flush()
}

fn answer(request: Request, progress: Arc<meshgauge::Progress>) -> Answer {
    let path = PathBuf::from(request.path);
    lower(Resource::Data, request.config.worker.memory.0);
    let options = match request.config.options() {
        Ok(options) => meshgauge::Options { progress: Some(progress), ..options },
        Err(error) => return Answer::Failed(Failure::new(FailureKind::Usage, error.0)),
    };
    match meshgauge::score(&path, &options) {
        Ok(summary) => Answer::Scored(Box::new(summary)),
        Err(error) => {
            let mut failure = Failure::from(&error);
            // The log names the mesh already.
            let named = format!("{}: ", path.display());
            if let Some(rest) = failure.reason.strip_prefix(&named) {
                failure.reason = rest.to_owned();
            }
            Answer::Failed(failure)
        }
    }
}

/// Lowers a limit of this process. Of memory it is the private, writable part that counts: mapped meshes are free.
fn lower(resource: Resource, limit: u64) {
    let maximum = getrlimit(resource).maximum;
    let current = Some(maximum.map_or(limit, |maximum| maximum.min(limit)));
    if let Err(error) = setrlimit(resource, Rlimit { current, maximum }) {
        tracing::warn!("a limit could not be set: {error}");
    }
}
