//! Who works with a state folder that several machines reach.
//!
//! The lock on `STATE/lock` says so as well as its file system does; some, as sshfs, keep locks on each machine for
//! itself. So on network file systems the daemon also writes its name into `STATE/owner`, again and again. Another
//! machine's daemon begins only after that has stood still for long enough, and one that finds another's name there, as
//! after it was stopped for a while, ends before it writes anything else. No clocks are compared.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::Context;
use serde::{Deserialize, Serialize};

use crate::status::Process;

/// How often the name is written.
const BEAT: Duration = Duration::from_secs(5);

/// A name that was not written anew for so long is that of a daemon that is gone.
const PATIENCE: Duration = Duration::from_secs(30);

/// Larger files are none of ours.
const LARGEST: u64 = 4096;

/// Our name in the state folder. It is taken away when dropped, if it is still ours.
#[derive(Debug)]
pub struct Owner {
    path: PathBuf,
    entry: Entry,
    /// When the name was last known to be ours.
    held: Instant,
}

/// What stands in the file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct Entry {
    process: Process,
    /// Grows with each time that it is written.
    beat: u64,
}

impl Owner {
    /// Takes the folder, unless a daemon on another machine works with it: that takes a while to find out where another's
    /// name stands there.
    pub fn take(state: &Path) -> anyhow::Result<Self> {
        Self::take_after(state, PATIENCE)
    }

    fn take_after(state: &Path, patience: Duration) -> anyhow::Result<Self> {
        let (path, process) = (state.join("owner"), Process::this());
        let first = read(&path)?;
        if let Some(other) = first.as_ref().filter(|entry| is_elsewhere(&entry.process, &process)) {
            let host = &other.process.host;
            tracing::warn!("{}: held by a daemon on {host}; waiting whether it is alive", path.display());
            let start = Instant::now();
            while start.elapsed() < patience {
                std::thread::sleep(patience / 10);
                let now = read(&path)?;
                anyhow::ensure!(
                    now.is_none() || now == first,
                    "{}: a meshgauge watch on {host} works with this state folder",
                    state.display()
                );
                if now.is_none() {
                    break;
                }
            }
        }
        let mut owner = Self { path, entry: Entry { process, beat: 0 }, held: Instant::now() };
        owner.write()?;
        Ok(owner)
    }

    /// Makes sure that the folder is still ours, where that has not been looked at for a while.
    pub fn hold(&mut self) -> anyhow::Result<()> {
        if self.held.elapsed() >= BEAT { self.beat() } else { Ok(()) }
    }

    fn beat(&mut self) -> anyhow::Result<()> {
        match read(&self.path)? {
            Some(entry) if entry.process == self.entry.process => {}
            // Who removed it wants us gone as little as who emptied it.
            None => {}
            Some(other) => anyhow::bail!(
                "{}: a meshgauge watch on {} took this state folder over while this one stood still",
                self.path.display(),
                other.process.host
            ),
        }
        self.entry.beat += 1;
        self.write()
    }

    /// In place: network file systems ask the server about a file that is opened, not always about its name.
    fn write(&mut self) -> anyhow::Result<()> {
        let write = || {
            let mut file = OpenOptions::new().write(true).create(true).truncate(true).open(&self.path)?;
            file.write_all(&serde_json::to_vec(&self.entry)?)?;
            file.sync_data()
        };
        write().with_context(|| self.path.display().to_string())?;
        self.held = Instant::now();
        Ok(())
    }
}

impl Drop for Owner {
    fn drop(&mut self) {
        let ours = |entry: Option<Entry>| entry.is_some_and(|entry| entry.process == self.entry.process);
        if read(&self.path).is_ok_and(ours) {
            // Who comes next waits a little longer if it stays.
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// On one machine the lock tells.
fn is_elsewhere(other: &Process, this: &Process) -> bool {
    (&other.host, &other.boot) != (&this.host, &this.boot)
}

/// What stands there; nothing where it is absent, or half written.
fn read(path: &Path) -> anyhow::Result<Option<Entry>> {
    let mut text = Vec::new();
    match File::open(path).and_then(|file| io::copy(&mut file.take(LARGEST), &mut text)) {
        Ok(_) => Ok(serde_json::from_slice(&text).ok()),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error).with_context(|| path.display().to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const QUICK: Duration = Duration::from_millis(300);

    fn elsewhere(folder: &Path, beat: u64) {
        let process = Process { host: "elsewhere".into(), ..Process::this() };
        let text = serde_json::to_vec(&Entry { process, beat }).expect("JSON");
        fs::write(folder.join("owner"), text).expect("written");
    }

    #[test]
    fn a_folder_is_taken_from_a_machine_that_is_gone_and_not_from_one_that_works() {
        let folder = tempfile::tempdir().expect("a folder");
        drop(Owner::take_after(folder.path(), QUICK).expect("nobody has it"));
        assert!(!folder.path().join("owner").exists(), "who ends leaves no name");
        elsewhere(folder.path(), 7);
        let start = Instant::now();
        let owner = Owner::take_after(folder.path(), QUICK).expect("the other one is gone");
        assert!(start.elapsed() >= QUICK);
        drop(owner);
        elsewhere(folder.path(), 8);
        std::thread::scope(|threads| {
            threads.spawn(|| {
                std::thread::sleep(QUICK / 3);
                elsewhere(folder.path(), 9);
            });
            let error = Owner::take_after(folder.path(), QUICK).expect_err("the other one works");
            assert!(error.to_string().contains("a meshgauge watch on elsewhere"), "{error}");
        });
    }

    #[test]
    fn who_finds_another_name_ends_and_leaves_it_there() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut owner = Owner::take_after(folder.path(), QUICK).expect("nobody has it");
        owner.beat().expect("it is ours");
        elsewhere(folder.path(), 1);
        assert!(owner.beat().is_err());
        drop(owner);
        assert!(folder.path().join("owner").exists());
    }
}
