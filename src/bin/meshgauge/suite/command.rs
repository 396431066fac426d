//! Commands: their placeholders, and how they are run: with a time limit, and with what they took.

use std::collections::BTreeMap;
use std::io::{self, Read};
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use crossbeam_channel::{RecvTimeoutError, bounded};
use rustix::process::{Pid, Signal, kill_process_group};
use wait4::{ResUse, Wait4};

use super::group::processor_time;

/// What a command may be given besides the suite's own variables.
const GIVEN: [&str; 3] = ["size", "output", "suite"];

/// How much of what a command prints is kept.
const KEPT: usize = 4096;

/// How often we look whether to stop.
const PATIENCE: Duration = Duration::from_millis(100);

/// A command that does not use its processor time ends after so many times as long by the clock: it sleeps or hangs.
const SLEEPY: u32 = 10;

/// How a command ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Ending {
    /// With status 0.
    Fine,
    /// With another status, or by a signal.
    Failed(String),
    /// It was killed for taking too long.
    TimedOut,
    /// It was killed because we are to stop.
    Stopped,
}

/// What a command did and took.
#[derive(Debug, Clone)]
pub struct Ran {
    /// How it ended.
    pub ending: Ending,
    /// Seconds on the clock.
    pub seconds: f64,
    /// Seconds of all its threads and children that it waited for.
    pub cpu_seconds: f64,
    /// Most memory that one of its processes had, in bytes.
    pub peak_rss_bytes: u64,
    /// The last of what it printed.
    pub printed: String,
    /// The last of what it complained.
    pub complained: String,
}

impl Ran {
    /// In words, why it did not end well.
    pub fn told(&self) -> String {
        let last = |text: &str| text.lines().map(str::trim).rfind(|line| !line.is_empty()).map(str::to_owned);
        let how = match &self.ending {
            Ending::Fine => "printed nothing".to_owned(),
            Ending::Failed(how) => how.clone(),
            Ending::TimedOut => {
                format!(
                    "took too long: {:.0} s of a processor, {:.0} s in all",
                    self.cpu_seconds, self.seconds
                )
            }
            Ending::Stopped => "was stopped".to_owned(),
        };
        match last(&self.complained).or_else(|| last(&self.printed)) {
            Some(line) => format!("{how}: {line}"),
            None => how,
        }
    }
}

/// Says which placeholder is not known.
pub fn check(command: &[String], variables: &BTreeMap<String, String>) -> Result<(), String> {
    if command.is_empty() {
        return Err("a command has no words".into());
    }
    for word in command {
        for name in placeholders(word) {
            if !GIVEN.contains(&name) && !variables.contains_key(name) {
                return Err(format!("nothing is known of {{{name}}} in \"{word}\""));
            }
        }
    }
    Ok(())
}

/// Names in braces: letters only, so that a brace of a script's own is let be.
fn placeholders(word: &str) -> impl Iterator<Item = &str> {
    let names = word.split('{').skip(1).filter_map(|rest| rest.split_once('}').map(|(name, _)| name));
    names.filter(|name| !name.is_empty() && name.chars().all(|c| c.is_ascii_lowercase()))
}

/// The words with their placeholders filled in.
pub fn fill(command: &[String], variables: &BTreeMap<String, String>, given: &[(&str, &str)]) -> Vec<String> {
    let fill = |word: &String| {
        let mut filled = word.clone();
        for name in placeholders(word) {
            let given = given.iter().find(|(known, _)| *known == name).map(|(_, value)| *value);
            if let Some(value) = given.or_else(|| variables.get(name).map(String::as_str)) {
                filled = filled.replace(&format!("{{{name}}}"), value);
            }
        }
        filled
    };
    command.iter().map(fill).collect()
}

/// Runs a command in a folder. It is killed, with the processes that it started, when the limit is over and they had a
/// processor for as long, so that a busy machine costs nobody a mesh; or when `stop` is set.
/// An error means that it could not be started.
pub fn run(words: &[String], folder: &Path, limit: Duration, stop: &AtomicBool) -> io::Result<Ran> {
    let started = Instant::now();
    let mut child = Command::new(&words[0])
        .args(&words[1..])
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .process_group(0)
        .spawn()?;
    let group = Pid::from_child(&child);
    let (stdout, stderr) = (child.stdout.take(), child.stderr.take());
    thread::scope(|scope| {
        let printed = scope.spawn(|| stdout.map(last_of).unwrap_or_default());
        let complained = scope.spawn(|| stderr.map(last_of).unwrap_or_default());
        let (ended, end) = bounded(1);
        scope.spawn(move || ended.send(child.wait4()));
        let mut killed = None;
        let used: io::Result<ResUse> = loop {
            match end.recv_timeout(PATIENCE) {
                Ok(used) => break used,
                Err(RecvTimeoutError::Disconnected) => {
                    break Err(io::Error::other("nobody waits for the command"));
                }
                Err(RecvTimeoutError::Timeout) => {}
            }
            if killed.is_none() {
                killed = if stop.load(Ordering::Relaxed) {
                    Some(Ending::Stopped)
                } else {
                    is_over(group, started, limit).then_some(Ending::TimedOut)
                };
            }
            if killed.is_some() {
                // Gone already, perhaps.
                let _ = kill_process_group(group, Signal::KILL);
            }
        };
        let seconds = started.elapsed().as_secs_f64();
        // What it left running would hold the pipes open.
        let _ = kill_process_group(group, Signal::KILL);
        let used = used?;
        let text = |thread: thread::ScopedJoinHandle<'_, String>| thread.join().unwrap_or_default();
        Ok(Ran {
            ending: killed.unwrap_or_else(|| ending(used.status)),
            seconds,
            cpu_seconds: (used.rusage.utime + used.rusage.stime).as_secs_f64(),
            peak_rss_bytes: used.rusage.maxrss,
            printed: text(printed),
            complained: text(complained),
        })
    })
}

fn is_over(group: Pid, started: Instant, limit: Duration) -> bool {
    let elapsed = started.elapsed();
    elapsed > limit.saturating_mul(SLEEPY) || (elapsed > limit && processor_time(group) > limit)
}

fn ending(status: ExitStatus) -> Ending {
    match (status.code(), status.signal()) {
        (Some(0), _) => Ending::Fine,
        (Some(code), _) => Ending::Failed(format!("ended with status {code}")),
        (None, signal) => Ending::Failed(format!("was ended by signal {}", signal.unwrap_or(0))),
    }
}

/// Reads to the end and keeps the last of it.
fn last_of(mut pipe: impl Read) -> String {
    let (mut kept, mut block) = (Vec::new(), vec![0; 1 << 16]);
    while let Ok(read @ 1..) = pipe.read(&mut block) {
        kept.extend_from_slice(&block[..read]);
        let surplus = kept.len().saturating_sub(KEPT);
        kept.drain(..surplus);
    }
    String::from_utf8_lossy(&kept).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shell(script: &str, limit: f64) -> Ran {
        let words = ["sh", "-c", script].map(str::to_owned);
        run(&words, Path::new("."), Duration::from_secs_f64(limit), &AtomicBool::new(false)).expect("a shell")
    }

    #[test]
    fn a_command_is_told_by_its_end_and_its_last_words() {
        let fine = shell("echo one; echo two", 30.0);
        assert_eq!((fine.ending, fine.printed.as_str()), (Ending::Fine, "one\ntwo\n"));
        assert!(fine.peak_rss_bytes > 100_000, "{}", fine.peak_rss_bytes);
        assert_eq!(shell("echo no mesh >&2; exit 3", 30.0).told(), "ended with status 3: no mesh");
        assert_eq!(shell("kill -SEGV $$", 30.0).told(), "was ended by signal 11");
        assert!(
            run(&["/no/such/program".into()], Path::new("."), Duration::MAX, &AtomicBool::default()).is_err()
        );
    }

    #[test]
    fn a_command_that_takes_too_long_is_killed_with_its_children() {
        let slow = shell("sleep 60 & sleep 60", 0.2);
        assert_eq!(slow.ending, Ending::TimedOut);
        assert!(slow.seconds < 30.0);
        let busy = shell("(while :; do :; done) & while :; do :; done", 0.5);
        assert_eq!(busy.ending, Ending::TimedOut);
        assert!(busy.told().contains("took too long"), "{}", busy.told());
        // A child that is left behind keeps nobody waiting.
        assert!(shell("sleep 60 &", 30.0).seconds < 30.0);
    }

    #[test]
    fn placeholders_are_filled_and_unknown_ones_named() {
        let variables = BTreeMap::from([("python".to_owned(), "python3".to_owned())]);
        let words = ["{python}", "-h={size}", "{output}", "{}", "{a b}"].map(str::to_owned);
        assert_eq!(check(&words, &variables), Ok(()));
        let filled = fill(&words, &variables, &[("size", "0.5"), ("output", "/tmp/{size}")]);
        assert_eq!(filled, ["python3", "-h=0.5", "/tmp/{size}", "{}", "{a b}"]);
        assert!(check(&["{pyhton}".to_owned()], &variables).is_err_and(|e| e.contains("{pyhton}")));
        assert!(check(&[], &variables).is_err());
    }
}
