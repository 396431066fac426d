//! A daemon with folders of its own, and what it logged.

use std::fs::{self, File};
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process};
use serde_json::Value;
use tempfile::TempDir;

/// One tetrahedron at the corner of a cube; its M31 is 12 sqrt(3) / 27.
pub const MESH: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n\
    $EndNodes\n$Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n";

/// The same with an edge twice as long.
pub const LONGER: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 2\n\
    $EndNodes\n$Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n";

/// A mesh whose second node has no coordinates.
pub const BAD: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n2\n1 0 0 0\n2 x 0 0\n$EndNodes\n$Elements\n0\n\
    $EndElements\n";

/// Nothing takes longer, even on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// Folders for a daemon, outliving it.
pub struct Site {
    folder: TempDir,
}

impl Site {
    /// Empty folders.
    pub fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        fs::create_dir(folder.path().join("drop")).expect("a drop");
        Self { folder }
    }

    /// A path within the site.
    pub fn path(&self, path: &str) -> PathBuf {
        self.folder.path().join(path)
    }

    /// Writes a file within the site.
    pub fn write(&self, path: &str, text: &str) {
        let path = self.path(path);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, text).expect("written");
    }

    /// The daemon's command; files settle in 300 ms unless the options say otherwise.
    pub fn command(&self, options: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_meshgauge"));
        let settle = if options.contains(&"--settle") { &[][..] } else { &["--settle", "300ms"] };
        command
            .args(["watch", "drop"])
            .args(settle)
            .args(options)
            .current_dir(self.folder.path())
            .env_remove("MESHGAUGE_CONFIG")
            .env_remove("STATE_DIRECTORY")
            .stdout(Stdio::null())
            .stderr(Stdio::piped());
        command
    }

    /// Runs `watch --once` and returns its exit status.
    pub fn once(&self, options: &[&str]) -> Option<i32> {
        self.command(options).arg("--once").status().expect("the program runs").code()
    }

    /// Starts a daemon that has read the drop through once.
    pub fn start(&self, options: &[&str]) -> Daemon<'_> {
        let before = self.events("daemon.started").len();
        let child = self.command(options).spawn().expect("the program runs");
        let daemon = Daemon { site: self, child };
        daemon.wait("the start", || self.events("daemon.started").len() > before);
        daemon
    }

    /// The text of a small file, if it is there.
    pub fn text(&self, path: &str) -> Option<String> {
        let mut text = Vec::new();
        let file = File::open(self.path(path)).ok()?;
        std::io::copy(&mut std::io::Read::take(file, 1 << 20), &mut text).ok()?;
        String::from_utf8(text).ok()
    }

    /// All lines of the log.
    pub fn log(&self) -> Vec<Value> {
        let Ok(file) = File::open(self.path("results/meshgauge.jsonl")) else { return Vec::new() };
        let lines = BufReader::new(file).lines();
        lines.map(|line| serde_json::from_str(&line.expect("UTF-8")).expect("each line is JSON")).collect()
    }

    /// The lines of an event.
    pub fn events(&self, event: &str) -> Vec<Value> {
        self.log().into_iter().filter(|line| line["event"] == event).collect()
    }

    /// The lines of an event about a mesh.
    pub fn events_of(&self, event: &str, mesh: &str) -> Vec<Value> {
        self.events(event).into_iter().filter(|line| line["mesh"] == mesh).collect()
    }

    /// A summary. It is published just after its line in the log: a test that has seen the line may be sooner.
    pub fn summary(&self, name: &str) -> Value {
        let path = self.path("results").join(name);
        let start = Instant::now();
        while !path.exists() && start.elapsed() < PATIENCE {
            sleep(Duration::from_millis(10));
        }
        let file = File::open(path).expect("the summary is there");
        serde_json::from_reader(BufReader::new(file)).expect("the summary is JSON")
    }

    /// The names of all summaries, sub-folders too.
    pub fn summaries(&self) -> Vec<String> {
        let mut names = Vec::new();
        let root = self.path("results");
        collect(&root, &root, &mut names);
        names.sort();
        names
    }
}

fn collect(root: &Path, folder: &Path, names: &mut Vec<String>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            collect(root, &path, names);
        } else if path.to_string_lossy().ends_with(".summary.json") {
            names.push(path.strip_prefix(root).expect("below").to_string_lossy().into_owned());
        }
    }
}

/// A daemon that runs; it is killed at the end.
pub struct Daemon<'a> {
    site: &'a Site,
    child: Child,
}

impl Daemon<'_> {
    /// Its process.
    pub fn process(&self) -> u32 {
        self.child.id()
    }

    /// Waits until something holds.
    pub fn wait(&self, what: &str, holds: impl Fn() -> bool) {
        let start = Instant::now();
        while !holds() {
            assert!(start.elapsed() < PATIENCE, "waited in vain for {what}: {:#?}", self.site.log());
            sleep(Duration::from_millis(10));
        }
    }

    /// Waits for an event about a mesh.
    pub fn wait_for(&self, event: &str, mesh: &str) {
        self.wait(&format!("{event} of {mesh}"), || !self.site.events_of(event, mesh).is_empty());
    }

    /// Sends the daemon a signal.
    pub fn signal(&self, signal: Signal) {
        send(self.child.id(), signal);
    }

    /// Waits for the daemon's end.
    pub fn end(&mut self) -> ExitStatus {
        let start = Instant::now();
        loop {
            if let Some(status) = self.child.try_wait().expect("a child") {
                return status;
            }
            assert!(start.elapsed() < PATIENCE, "the daemon does not end");
            sleep(Duration::from_millis(10));
        }
    }

    /// The daemon's only worker, after a first mesh has made it start one.
    pub fn worker(&self) -> u32 {
        self.site.write("drop/first.msh", MESH);
        self.wait_for("mesh.scored", "first.msh");
        let children = format!("/proc/{}/task", self.child.id());
        let mut workers = Vec::new();
        for thread in fs::read_dir(children).expect("the daemon's threads") {
            let path = thread.expect("a thread").path().join("children");
            let line = BufReader::new(File::open(path).expect("its children")).lines().next();
            let line = line.map(|line| line.expect("numbers")).unwrap_or_default();
            workers.extend(line.split_whitespace().map(|pid| pid.parse::<u32>().expect("a number")));
        }
        assert_eq!(workers.len(), 1, "with one seat there is one worker");
        workers[0]
    }
}

impl Drop for Daemon<'_> {
    fn drop(&mut self) {
        // It may have ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Sends a process a signal.
pub fn send(process: u32, signal: Signal) {
    let pid = Pid::from_raw(process.cast_signed()).expect("a process");
    kill_process(pid, signal).expect("the process is there");
}

/// A configuration with one worker, so that tests know which it is.
pub fn one_worker(site: &Site, more: &str) {
    site.write("meshgauge.toml", &format!("[worker]\ncount = 1\n{more}"));
}

/// The option that names it.
pub const ONE_WORKER: [&str; 2] = ["--config", "meshgauge.toml"];
