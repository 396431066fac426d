//! A worker process, as the daemon sees it: a request goes in, an answer comes out, or it ends.

use std::io::{self, Read, Write};
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStderr, ChildStdin, ChildStdout, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use memchr::memchr;
use rustix::event::{PollFd, PollFlags, Timespec, poll};

use super::protocol::{Answer, Progress, Said};

/// Longest answer: a summary has a few hundred numbers and some names out of the mesh.
const LONGEST_ANSWER: usize = 64 << 20;

/// How much of what a worker says on stderr is kept to tell why it died.
const LAST_WORDS: usize = 400;

/// How often we look whether to give up.
const PATIENCE: Timespec = Timespec { tv_sec: 0, tv_nsec: 100_000_000 };

/// A worker process. It is killed when dropped.
pub struct Process {
    child: Child,
    requests: ChildStdin,
    answers: ChildStdout,
    complaints: ChildStderr,
    last_words: Vec<u8>,
}

/// Why there is no answer.
#[derive(Debug)]
pub enum NoAnswer {
    /// The process ended by itself; how, and what it said last.
    Died(String),
    /// It took longer than allowed.
    TimedOut,
    /// We were told to give up.
    Abandoned,
}

impl Process {
    /// Starts a worker.
    pub fn start() -> io::Result<Self> {
        let program = own_program()?;
        let mut child = Command::new(&program)
            .arg0("meshgauge")
            .arg("worker")
            .arg("--parent")
            .arg(std::process::id().to_string())
            // Without memory a backtrace waits for ever for a lock that it holds itself.
            .env("RUST_BACKTRACE", "0")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            // Ctrl-C in a terminal is for the daemon, which then decides.
            .process_group(0)
            .spawn()?;
        let closed = || io::Error::other("a worker's pipe is missing");
        Ok(Self {
            requests: child.stdin.take().ok_or_else(closed)?,
            answers: child.stdout.take().ok_or_else(closed)?,
            complaints: child.stderr.take().ok_or_else(closed)?,
            last_words: Vec::new(),
            child,
        })
    }

    /// Whether it still runs.
    pub fn is_alive(&mut self) -> bool {
        matches!(self.child.try_wait(), Ok(None))
    }

    /// Hands a request over; an error means that the worker is gone.
    pub fn send(&mut self, request: &[u8]) -> io::Result<()> {
        self.last_words.clear();
        self.requests.write_all(request)?;
        self.requests.flush()
    }

    /// Waits for the answer to the request; what the worker says on the way goes to `heard`.
    pub fn answer(
        &mut self,
        deadline: Instant,
        abandoned: impl Fn() -> bool,
        heard: impl Fn(Progress),
    ) -> Result<Answer, NoAnswer> {
        let mut answer = Vec::new();
        let mut block = vec![0; 1 << 16];
        let mut complains = true;
        loop {
            if abandoned() {
                return Err(NoAnswer::Abandoned);
            }
            if Instant::now() >= deadline {
                return Err(NoAnswer::TimedOut);
            }
            let (answers, complaints) = self.wait(complains);
            if complaints {
                complains = self.listen(&mut block);
            }
            if !answers {
                continue;
            }
            let read = self.answers.read(&mut block).unwrap_or(0);
            if read == 0 {
                return Err(NoAnswer::Died(self.obituary(&mut block, complains)));
            }
            answer.extend_from_slice(&block[..read]);
            while let Some(end) = memchr(b'\n', &answer) {
                let line: Vec<u8> = answer.drain(..=end).collect();
                match serde_json::from_slice(&line) {
                    Ok(Said::Progress(progress)) => heard(progress),
                    Ok(Said::Answer(answer)) => return Ok(answer),
                    Err(error) => {
                        return Err(NoAnswer::Died(format!(
                            "the worker's answer was not understood: {error}"
                        )));
                    }
                }
            }
            if answer.len() > LONGEST_ANSWER {
                return Err(NoAnswer::Died("the worker's answer has no end".into()));
            }
        }
    }

    /// Waits a moment; says whether there is something to read in the answers, and in the complaints.
    fn wait(&self, complains: bool) -> (bool, bool) {
        let mut pipes = vec![PollFd::new(&self.answers, PollFlags::IN)];
        if complains {
            pipes.push(PollFd::new(&self.complaints, PollFlags::IN));
        }
        // An interrupted wait is a short one.
        let _ = poll(&mut pipes, Some(&PATIENCE));
        let ready = |pipe: Option<&PollFd<'_>>| pipe.is_some_and(|pipe| !pipe.revents().is_empty());
        (ready(pipes.first()), ready(pipes.get(1)))
    }

    /// Passes on what the worker says on stderr; says whether there may be more.
    fn listen(&mut self, block: &mut [u8]) -> bool {
        let read = self.complaints.read(block).unwrap_or(0);
        // Our own stderr may be closed; that must not matter.
        let _ = io::stderr().write_all(&block[..read]);
        self.last_words.extend_from_slice(&block[..read]);
        let surplus = self.last_words.len().saturating_sub(LAST_WORDS);
        self.last_words.drain(..surplus);
        read > 0
    }

    /// How the worker ended, and what it said last.
    fn obituary(&mut self, block: &mut [u8], mut complains: bool) -> String {
        while complains {
            complains = self.listen(block);
        }
        let how = self.child.wait().map_or_else(|e| e.to_string(), describe);
        let words = String::from_utf8_lossy(&self.last_words);
        match words.lines().map(str::trim).rfind(|line| !line.is_empty()) {
            Some(line) => format!("the worker {how}: {line}"),
            None => format!("the worker {how}"),
        }
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // It may be gone already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The program that is running, even if another was installed in its place meanwhile.
fn own_program() -> io::Result<PathBuf> {
    let running = Path::new("/proc/self/exe");
    if running.exists() { Ok(running.to_owned()) } else { std::env::current_exe() }
}

fn describe(status: ExitStatus) -> String {
    let Some(signal) = status.signal() else {
        return format!("ended with status {}", status.code().unwrap_or(-1));
    };
    match signal {
        6 => "was aborted (SIGABRT), as when it is out of memory".into(),
        7 => "was ended by SIGBUS: the file was cut while it was read".into(),
        9 => "was killed (SIGKILL)".into(),
        11 => "was ended by SIGSEGV".into(),
        _ => format!("was ended by signal {signal}"),
    }
}

/// When a task that may take `time` must be done.
pub fn deadline(time: Duration) -> Instant {
    let now = Instant::now();
    // A limit beyond what the clock can count is none.
    now.checked_add(time).unwrap_or_else(|| now + Duration::from_secs(1 << 30))
}
