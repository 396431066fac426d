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

/// A mesh that takes a worker a while: so many elements, all the same.
pub fn large_mesh(elements: u32) -> String {
    let rows: String = (1..=elements).map(|i| format!("{i} 4 2 1 1 1 2 3 4\n")).collect();
    MESH.replace("1\n1 4 2 1 1 1 2 3 4\n", &format!("{elements}\n{rows}"))
}

/// Nothing takes longer, even on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// Folders for a daemon, outliving it.
pub struct Site {
    folder: TempDir,
    log: &'static str,
}

impl Site {
    /// Empty folders.
    pub fn new() -> Self {
        Self::with_log("results/meshgauge.jsonl")
    }

    /// Empty folders for a daemon that is told to log elsewhere.
    pub fn with_log(log: &'static str) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        fs::create_dir(folder.path().join("drop")).expect("a drop");
        Self { folder, log }
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
        lines(&self.path(self.log))
    }

    /// The log and those that were put away.
    pub fn logs(&self) -> Vec<PathBuf> {
        let log = self.path(self.log);
        let name = log.file_name().expect("a name").to_string_lossy().into_owned();
        let entries = fs::read_dir(log.parent().expect("a folder")).expect("a folder");
        let paths = entries.map(|entry| entry.expect("an entry").path());
        paths
            .filter(|path| path.file_name().is_some_and(|n| n.to_string_lossy().starts_with(&name)))
            .collect()
    }

    /// All lines of all logs.
    pub fn all_logs(&self) -> Vec<Value> {
        self.logs().iter().flat_map(|log| lines(log)).collect()
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

fn lines(log: &Path) -> Vec<Value> {
    let Ok(file) = File::open(log) else { return Vec::new() };
    let lines = BufReader::new(file).lines();
    lines.map(|line| serde_json::from_str(&line.expect("UTF-8")).expect("each line is JSON")).collect()
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
        let workers = self.workers();
        assert_eq!(workers.len(), 1, "with one seat there is one worker");
        workers[0]
    }

    /// Whether it runs.
    pub fn is_alive(&mut self) -> bool {
        self.child.try_wait().expect("a child").is_none()
    }

    /// The daemon's workers.
    pub fn workers(&self) -> Vec<u32> {
        let children = format!("/proc/{}/task", self.child.id());
        let mut workers = Vec::new();
        for thread in fs::read_dir(children).expect("the daemon's threads") {
            let path = thread.expect("a thread").path().join("children");
            // The thread may have ended.
            let Ok(file) = File::open(path) else { continue };
            let line = BufReader::new(file).lines().next();
            let line = line.and_then(Result::ok).unwrap_or_default();
            workers.extend(line.split_whitespace().map(|pid| pid.parse::<u32>().expect("a number")));
        }
        workers
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

/// A file system that is mounted for a test.
pub struct Mounted(PathBuf);

impl Mounted {
    /// Memory as a file system, at a folder of the site. `None`, said aloud, where nobody may mount.
    pub fn memory(at: PathBuf, options: &str) -> Option<Self> {
        let mut mount = Command::new("mount");
        mount.args(["-t", "tmpfs", "-o", options, "meshgauge-test"]).arg(&at);
        Self::by(mount, at)
    }

    /// The folder `from` at the folder `at`, by a program that can be stopped. `None`, said aloud, where there is no
    /// bindfs.
    pub fn bound(from: &Path, at: PathBuf) -> Option<Self> {
        let mut mount = Command::new("bindfs");
        mount.arg(from).arg(&at);
        Self::by(mount, at)
    }

    fn by(mut mount: Command, at: PathBuf) -> Option<Self> {
        fs::create_dir_all(&at).expect("a folder");
        let program = mount.get_program().to_owned();
        match mount.stderr(Stdio::null()).status() {
            Ok(status) if status.success() => Some(Self(at)),
            _ => {
                eprintln!("skipped: {} does not work here", program.display());
                None
            }
        }
    }
}

impl Drop for Mounted {
    fn drop(&mut self) {
        // It may be gone already.
        let _ = Command::new("umount").arg("-l").arg(&self.0).stderr(Stdio::null()).status();
    }
}
