//! Whether the process that wrote a status still lives, by what `/proc` says: nothing is asked of the process itself.

use std::fs::File;
use std::io::{self, Read};

use rustix::time::{ClockId, clock_gettime};
use serde::{Deserialize, Serialize};

use super::Status;

/// A process, so that no other is taken for it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Process {
    /// Its number.
    pub pid: u32,
    /// When it started, in ticks of the kernel since the machine's start.
    pub start_ticks: u64,
    /// The machine's start.
    pub boot: String,
    /// The machine.
    pub host: String,
}

/// How a daemon is, as far as can be seen from outside.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Health {
    /// It lives, and its status is fresh.
    Well,
    /// The same, but something keeps it from working as it should.
    Degraded,
    /// It lives, but its loop has not turned for too long.
    Hung,
    /// It lives, but was stopped by a signal.
    Stopped,
    /// It ended in good order.
    Ended,
    /// It is gone, and did not say why.
    Dead,
    /// It runs on another machine, and its status is all that is known.
    Elsewhere,
}

/// A status that missed so many of its times is old.
const MISSED: f64 = 6.0;

impl Process {
    /// This process.
    pub fn this() -> Self {
        Self {
            pid: std::process::id(),
            start_ticks: state_and_start(std::process::id()).map_or(0, |(_, start)| start),
            boot: boot(),
            host: rustix::system::uname().nodename().to_string_lossy().into_owned(),
        }
    }

    /// Seconds since the machine's start, the time that it slept included.
    pub fn now() -> f64 {
        let now = clock_gettime(ClockId::Boottime);
        now.tv_sec as f64 + now.tv_nsec as f64 / 1e9
    }

    /// Whether it was started on this machine since that was started.
    fn is_here(&self) -> bool {
        self.boot == boot()
    }

    /// The letter that stands for what it does, if it lives.
    fn state(&self) -> Option<char> {
        let (state, start) = state_and_start(self.pid).ok()?;
        (start == self.start_ticks && !matches!(state, 'Z' | 'X')).then_some(state)
    }
}

/// How the daemon is that wrote the status, and how old its status is in seconds where that can be told.
pub fn health(status: &Status) -> (Health, Option<f64>) {
    let process = &status.process;
    if !process.is_here() {
        let same_host = process.host == Process::this().host;
        let ended = status.ended.is_some();
        let health = if ended {
            Health::Ended
        } else if same_host {
            Health::Dead
        } else {
            Health::Elsewhere
        };
        return (health, None);
    }
    let age = (Process::now() - status.written_at).max(0.0);
    let old = age > MISSED * status.interval_seconds.max(1.0);
    let health = match process.state() {
        _ if status.ended.is_some() => Health::Ended,
        None => Health::Dead,
        Some('T' | 't') => Health::Stopped,
        Some(_) if old => Health::Hung,
        Some(_) if !status.degraded.is_empty() => Health::Degraded,
        Some(_) => Health::Well,
    };
    (health, Some(age))
}

/// What `/proc/PID/stat` says of a process: the letter of its state, and its start in ticks.
fn state_and_start(pid: u32) -> io::Result<(char, u64)> {
    let line = first_bytes(&format!("/proc/{pid}/stat"))?;
    // The name stands in parentheses and may hold anything.
    let fields: Vec<&str> =
        line.rsplit_once(')').map(|(_, rest)| rest.split_whitespace().collect()).unwrap_or_default();
    let state = fields.first().and_then(|field| field.chars().next());
    let start = fields.get(19).and_then(|field| field.parse().ok());
    state
        .zip(start)
        .ok_or_else(|| io::Error::new(io::ErrorKind::InvalidData, "/proc/PID/stat is not as known"))
}

fn boot() -> String {
    let boot = first_bytes("/proc/sys/kernel/random/boot_id").unwrap_or_default();
    boot.trim().to_owned()
}

fn first_bytes(path: &str) -> io::Result<String> {
    let mut bytes = Vec::new();
    io::copy(&mut File::open(path)?.take(4096), &mut bytes)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn this_process_lives_and_another_with_its_number_is_another() {
        let this = Process::this();
        assert!(this.is_here());
        assert!(this.state().is_some_and(|state| state != 'T'));
        let earlier = Process { start_ticks: this.start_ticks - 1, ..this };
        assert_eq!(earlier.state(), None);
    }
}
