//! What must hold whatever was done: each version of a mesh has one outcome in the log, each summary is whole and tells
//! of the file that stands there, and no line is torn.

use std::collections::HashMap;
use std::fs::{self, File};
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use serde_json::Value;

use crate::daemon::Site;

/// What the log tells.
#[derive(Debug, Default)]
pub struct Told {
    /// Number of `mesh.scored` lines by mesh.
    pub scored: HashMap<String, u64>,
    /// Number of `mesh.failed` lines by mesh.
    pub failed: HashMap<String, u64>,
    /// Number of outcomes (scored, failed, ignored) by id.
    pub outcomes: HashMap<String, u64>,
}

/// Reads the log: every line must be whole.
pub fn told(log: &Path) -> Told {
    let mut told = Told::default();
    let Ok(file) = File::open(log) else { return told };
    for (number, line) in BufReader::new(file).lines().enumerate() {
        let line = line.expect("UTF-8");
        let event: Value = serde_json::from_str(&line)
            .unwrap_or_else(|e| panic!("{}, line {}: {e}: {line}", log.display(), number + 1));
        let text = |key: &str| event[key].as_str().unwrap_or_default().to_owned();
        match event["event"].as_str() {
            Some("mesh.scored") => *told.scored.entry(text("mesh")).or_default() += 1,
            Some("mesh.failed") => *told.failed.entry(text("mesh")).or_default() += 1,
            Some("mesh.ignored") => {}
            _ => continue,
        }
        *told.outcomes.entry(text("id")).or_default() += 1;
    }
    told
}

/// What was lost and what was doubled, of meshes that must each have been scored at least once.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Verdict {
    /// Meshes without a `mesh.scored` line.
    pub lost: Vec<String>,
    /// Versions with more than one outcome.
    pub doubled: Vec<String>,
    /// Summaries that are not there, not whole, or of another version than stands there.
    pub wrong: Vec<String>,
}

/// Judges meshes by their names within the drop; each has a name of its own without its extension.
pub fn judge<'n>(site: &Site, meshes: impl IntoIterator<Item = &'n str>) -> Verdict {
    let told = told(&site.path("results/meshgauge.jsonl"));
    let doubled = told.outcomes.iter().filter(|(_, count)| **count > 1).map(|(id, _)| id.clone()).collect();
    let mut verdict = Verdict { doubled, ..Verdict::default() };
    for mesh in meshes {
        if !told.scored.contains_key(mesh) {
            verdict.lost.push(mesh.to_owned());
        }
        let stem = mesh.rsplit_once('.').map_or(mesh, |(stem, _)| stem);
        let summary = site.path("results").join(format!("{stem}.summary.json"));
        let summary: Option<Value> =
            File::open(summary).ok().and_then(|file| serde_json::from_reader(BufReader::new(file)).ok());
        let hash = format!("{:016x}", xxhash_rust::xxh3::xxh3_64(&bytes(&site.path("drop").join(mesh))));
        if summary.is_none_or(|summary| summary["mesh"]["xxh3"] != hash.as_str()) {
            verdict.wrong.push(mesh.to_owned());
        }
    }
    verdict
}

/// Asserts that nothing was lost or doubled, and all summaries are right. A daemon that runs publishes a summary just
/// after its line in the log, so it is given some time.
pub fn all_well<'n>(site: &Site, meshes: impl IntoIterator<Item = &'n str>) {
    let meshes: Vec<_> = meshes.into_iter().collect();
    let start = std::time::Instant::now();
    let mut verdict = judge(site, meshes.iter().copied());
    while verdict != Verdict::default() && start.elapsed().as_secs() < 20 {
        std::thread::sleep(std::time::Duration::from_millis(100));
        verdict = judge(site, meshes.iter().copied());
    }
    assert!(verdict == Verdict::default(), "{verdict:?}");
}

/// The bytes of a small file; none if it is not there.
pub fn bytes(path: &Path) -> Vec<u8> {
    let mut bytes = Vec::new();
    if let Ok(file) = File::open(path) {
        let _ = std::io::copy(&mut file.take(1 << 30), &mut bytes);
    }
    bytes
}

/// Private memory of a process in KiB, as `/proc` has it; the most that it ever had resident.
pub fn memory(process: u32) -> (u64, u64) {
    let text = bytes(Path::new(&format!("/proc/{process}/status")));
    let text = String::from_utf8_lossy(&text).into_owned();
    let field = |name: &str| {
        let line = text.lines().find(|line| line.starts_with(name))?;
        line.split_whitespace().nth(1)?.parse().ok()
    };
    (field("RssAnon:").unwrap_or(0), field("VmHWM:").unwrap_or(0))
}

/// Number of files that a process has open.
pub fn open_files(process: u32) -> usize {
    fs::read_dir(format!("/proc/{process}/fd")).map_or(0, |entries| entries.count())
}

/// Reads a log as it grows.
pub struct Follower {
    path: std::path::PathBuf,
    reader: Option<BufReader<File>>,
    line: String,
}

impl Follower {
    /// From the log's start on; it may not be there yet.
    pub fn new(log: &Path) -> Self {
        Self { path: log.to_owned(), reader: None, line: String::new() }
    }

    /// The next line, if there is one already.
    pub fn next(&mut self) -> Option<Value> {
        if self.reader.is_none() {
            self.reader = File::open(&self.path).ok().map(BufReader::new);
        }
        self.reader.as_mut()?.read_line(&mut self.line).expect("UTF-8");
        if !self.line.ends_with('\n') {
            return None;
        }
        let line = std::mem::take(&mut self.line);
        Some(serde_json::from_str(&line).unwrap_or_else(|e| panic!("{e}: {line}")))
    }

    /// Waits for a line so many seconds.
    pub fn wait(&mut self, seconds: u64, mut wanted: impl FnMut(&Value) -> bool) -> Option<Value> {
        let start = std::time::Instant::now();
        while start.elapsed().as_secs() < seconds {
            match self.next() {
                Some(event) if wanted(&event) => return Some(event),
                Some(_) => {}
                None => std::thread::sleep(std::time::Duration::from_millis(5)),
            }
        }
        None
    }

    /// Waits until so many lines of an event were seen, and counts them by mesh.
    pub fn count(&mut self, seconds: u64, event: &str, number: usize) -> HashMap<String, u64> {
        let mut meshes = HashMap::new();
        let mut seen = 0;
        if number > 0 {
            self.wait(seconds, |line| {
                if line["event"] == event {
                    *meshes.entry(line["mesh"].as_str().unwrap_or_default().to_owned()).or_default() += 1;
                    seen += 1;
                }
                seen == number
            });
        }
        meshes
    }
}
