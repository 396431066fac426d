//! One generator on one problem: it is run with smaller or larger elements until the number of nodes is in the window.

use std::fs;
use std::hash::Hasher;
use std::path::{Path, PathBuf};

use anyhow::Context;
use meshgauge::Summary;
use meshgauge::summary::Expectation;
use twox_hash::XxHash3_64;

use super::command::{self, Ending, Ran};
use super::definition::{Generator, Problem, Suite, Versions};
use super::row::{Outcome, Row};
use super::{Run, Scored};
use crate::config_file;
use crate::names::SUFFIX;
use crate::publish::publish;

/// One generator on one problem.
pub struct Trial<'a> {
    pub run: &'a Run,
    pub problem: &'a Problem,
    pub generator: &'a Generator,
    pub template: &'a [String],
}

/// A mesh that a run made.
struct Made {
    size: f64,
    ran: Ran,
    command: Vec<String>,
    summary: Summary,
    nodes: u64,
}

/// How much larger or smaller the next size may be: two runs can say little of one far away.
const LARGEST_STEP: f64 = 2.0;

/// How far off the true area or volume a mesh may be. What a coarse polygon lacks of its circle is far less.
const FAR_OFF: f64 = 0.1;

/// The mesh's area or volume beside the true one.
fn relative_error(summary: &Summary) -> Option<f64> {
    summary.expected.as_ref().map(|expected| expected.relative_error)
}

impl Trial<'_> {
    /// The row, from the results where it stands there already.
    pub fn carry_out(&self, versions: &mut Versions) -> anyhow::Result<Scored> {
        let version = versions.of(&self.generator.version, &self.run.suite);
        let key = self.key(version.as_deref().unwrap_or_default());
        if !self.run.fresh
            && let Some(known) = self.known(&key)
        {
            return Ok(known);
        }
        let mut row = self.blank(key);
        let summary = match version {
            Err(reason) => {
                (row.outcome, row.reason) = (Outcome::Missing, Some(reason));
                None
            }
            Ok(version) => {
                row.version = Some(version);
                self.search(&mut row)?
            }
        };
        self.keep(&row, summary.as_ref())?;
        Ok((row, summary))
    }

    fn blank(&self, key: String) -> Row {
        Row {
            problem: self.problem.name.clone(),
            generator: self.generator.name.clone(),
            title: self.generator.title.clone(),
            version: None,
            outcome: Outcome::Missing,
            reason: None,
            size: None,
            tries: 0,
            command: Vec::new(),
            seconds: None,
            cpu_seconds: None,
            peak_rss_bytes: None,
            nodes: None,
            elements: None,
            relative_error: None,
            key,
        }
    }

    /// Runs the generator until the number of nodes is in the window; fills the row.
    fn search(&self, row: &mut Row) -> anyhow::Result<Option<Summary>> {
        let fixed = !self.template.iter().any(|word| word.contains("{size}"));
        let tries = if fixed { 1 } else { self.run.suite.tries.max(1) };
        let mut size = self.problem.size * self.generator.size_factor;
        let mut best: Option<Made> = None;
        let mut last: Option<(f64, u64)> = None;
        for attempt in 1..=tries {
            row.tries = attempt;
            let made = match self.attempt(size, row)? {
                Some(made) => made,
                None if best.is_some() => break,
                None => return Ok(None),
            };
            let (nodes, is_right) = (made.nodes, self.is_in_window(made.nodes));
            if best.as_ref().is_none_or(|best| self.distance(nodes) < self.distance(best.nodes)) {
                fs::rename(self.draft(), self.mesh())?;
                best = Some(made);
            }
            if is_right {
                break;
            }
            let growth = self.growth((size, nodes), last);
            last = Some((size, nodes));
            let step = (nodes.max(1) as f64 / self.middle()).powf(1.0 / growth);
            size *= step.clamp(1.0 / LARGEST_STEP, LARGEST_STEP);
        }
        let Some(made) = best else { return Ok(None) };
        self.fill(row, &made);
        Ok(Some(made.summary))
    }

    /// By which power of the element size the nodes become fewer. A mesh of one size has the dimension of its domain;
    /// one that is graded has less, as most of it stays as it is, so two runs tell.
    fn growth(&self, (size, nodes): (f64, u64), last: Option<(f64, u64)>) -> f64 {
        let dimension = f64::from(Suite::dimension(self.problem));
        let Some((last_size, last_nodes)) = last else { return dimension };
        let seen = (last_nodes.max(1) as f64 / nodes.max(1) as f64).ln() / (size / last_size).ln();
        // A generator that did not follow, or no other number of nodes, says nothing.
        if seen.is_finite() && seen > 0.0 { seen.clamp(0.25, dimension) } else { dimension }
    }

    /// One run and the mesh that it made. Without one, the row says why.
    fn attempt(&self, size: f64, row: &mut Row) -> anyhow::Result<Option<Made>> {
        let folder = self.folder().join(format!(".{}.work", self.generator.name));
        fs::create_dir_all(&folder)?;
        let draft = std::path::absolute(self.draft())?;
        // What stands there from before must not be taken for this run's.
        let _ = fs::remove_file(&draft);
        let (size_text, draft_text) = (size.to_string(), draft.to_string_lossy());
        let given = [("size", size_text.as_str()), ("output", &draft_text)];
        let command = command::fill(self.template, &self.run.suite.variables, &given);
        let limit = self.run.suite.timeout.0;
        let ran = command::run(&command, &folder, limit, &self.run.stop);
        let _ = fs::remove_dir_all(&folder);
        row.command = command.clone();
        row.size = Some(size);
        let ran = match ran {
            Ok(ran) => ran,
            Err(error) => return Ok(self.without(row, Outcome::Failed, format!("{}: {error}", command[0]))),
        };
        (row.seconds, row.cpu_seconds) = (Some(ran.seconds), Some(ran.cpu_seconds));
        row.peak_rss_bytes = Some(ran.peak_rss_bytes);
        match ran.ending {
            Ending::Fine => {}
            Ending::Failed(_) => return Ok(self.without(row, Outcome::Failed, ran.told())),
            Ending::TimedOut => return Ok(self.without(row, Outcome::TimedOut, ran.told())),
            Ending::Stopped => anyhow::bail!("interrupted; the same command goes on from here"),
        }
        if !draft.exists() {
            return Ok(self.without(row, Outcome::Failed, format!("wrote no {}", self.mesh().display())));
        }
        let summary = match self.score(&draft) {
            Ok(summary) => summary,
            Err(error) => return Ok(self.without(row, Outcome::Unreadable, shortened(&error.to_string()))),
        };
        if summary.dimension() != Suite::dimension(self.problem) as usize {
            let reason = format!("the mesh has {} dimensions", summary.dimension());
            return Ok(self.without(row, Outcome::Unreadable, reason));
        }
        if let Some(error) = relative_error(&summary).filter(|error| error.abs() > FAR_OFF) {
            let what = if self.problem.volume.is_some() { "volume" } else { "area" };
            let reason = format!("the mesh's {what} is off by {:.1} %", 100.0 * error);
            return Ok(self.without(row, Outcome::WrongDomain, reason));
        }
        let nodes = summary.nodes.count - summary.nodes.unused;
        Ok(Some(Made { size, ran, command, summary, nodes }))
    }

    fn without(&self, row: &mut Row, outcome: Outcome, reason: String) -> Option<Made> {
        (row.outcome, row.reason) = (outcome, Some(reason));
        None
    }

    fn score(&self, path: &Path) -> meshgauge::Result<Summary> {
        let mut options = self.run.options.clone();
        let value = self.problem.volume.or(self.problem.area).unwrap_or(0.0);
        let volume = self.problem.volume.is_some();
        options.judgement.expectation = Some(Expectation { volume, value, tolerance_percent: 1.0 });
        options.run_info = false;
        let mut summary = meshgauge::score(path, &options)?;
        summary.mesh.name.clone_from(&self.generator.name);
        summary.mesh.path = self.mesh().to_string_lossy().into_owned();
        Ok(summary)
    }

    fn fill(&self, row: &mut Row, made: &Made) {
        let inside = self.is_in_window(made.nodes);
        row.outcome = if inside { Outcome::Fine } else { Outcome::OutsideWindow };
        row.reason = (!inside).then(|| {
            let [least, most] = self.problem.nodes.unwrap_or_default();
            format!("{} nodes instead of {least} to {most}", made.nodes)
        });
        row.size = Some(made.size);
        row.command.clone_from(&made.command);
        (row.seconds, row.cpu_seconds) = (Some(made.ran.seconds), Some(made.ran.cpu_seconds));
        row.peak_rss_bytes = Some(made.ran.peak_rss_bytes);
        row.nodes = Some(made.nodes);
        row.elements = Some(made.summary.main_shapes().map(|(_, found)| found.count).sum());
        row.relative_error = relative_error(&made.summary);
    }

    fn is_in_window(&self, nodes: u64) -> bool {
        self.problem.nodes.is_none_or(|[least, most]| (least..=most).contains(&nodes))
    }

    /// The number of nodes that is aimed at.
    fn middle(&self) -> f64 {
        let [least, most] = self.problem.nodes.unwrap_or_default();
        f64::midpoint(least as f64, most as f64)
    }

    fn distance(&self, nodes: u64) -> f64 {
        (nodes.max(1) as f64 / self.middle()).ln().abs()
    }

    /// What the row depends on: problem, command, version, and the scripts that the command names.
    fn key(&self, version: &str) -> String {
        let suite = &self.run.suite;
        let mut hash = XxHash3_64::new();
        let words = command::fill(self.template, &suite.variables, &[]);
        let p = self.problem;
        let facts = format!(
            "{:?} {:?} {:?} {} {} {:?} {version}",
            p.area,
            p.volume,
            p.nodes,
            p.size * self.generator.size_factor,
            suite.tries,
            suite.timeout
        );
        hash.write(facts.as_bytes());
        for word in &words {
            hash.write(word.as_bytes());
            hash.write(&[0]);
            if let Some(script) = self.script(word) {
                hash.write(script.as_bytes());
            }
        }
        format!("{:016x}", hash.finish())
    }

    /// The text of a script that lies beside the suite.
    fn script(&self, word: &str) -> Option<String> {
        let folder = self.run.suite.variables.get("suite")?;
        let is_ours = Path::new(word).starts_with(folder) && Path::new(word).is_file();
        is_ours.then(|| config_file::read(Path::new(word)).ok()).flatten()
    }

    fn folder(&self) -> PathBuf {
        self.run.results.join(&self.problem.name)
    }

    fn file(&self, end: &str) -> PathBuf {
        self.folder().join(format!("{}{end}", self.generator.name))
    }

    fn mesh(&self) -> PathBuf {
        self.file(&format!(".{}", self.generator.output))
    }

    fn draft(&self) -> PathBuf {
        self.folder().join(format!(".{}.draft.{}", self.generator.name, self.generator.output))
    }

    /// The row of an earlier run with the same key. One that is missing is looked for again.
    fn known(&self, key: &str) -> Option<Scored> {
        let row: Row = serde_json::from_str(&config_file::read(&self.file(".run.json")).ok()?).ok()?;
        let summary =
            || -> Option<Summary> { serde_json::from_str(&config_file::read(&self.file(SUFFIX)).ok()?).ok() };
        let same = row.key == key && row.outcome != Outcome::Missing;
        match row.outcome.has_mesh() {
            _ if !same => None,
            true => summary().map(|summary| (row, Some(summary))),
            false => Some((row, None)),
        }
    }

    fn keep(&self, row: &Row, summary: Option<&Summary>) -> anyhow::Result<()> {
        // Summary before row: a row that is there has its summary.
        let place = self.file(SUFFIX);
        match summary {
            Some(summary) => {
                publish(&place, summary.to_json()).with_context(|| place.display().to_string())?
            }
            None => {
                let _ = fs::remove_file(&place);
            }
        }
        let _ = fs::remove_file(self.draft());
        let place = self.file(".run.json");
        let text = serde_json::to_string_pretty(row)?;
        publish(&place, &(text + "\n")).with_context(|| place.display().to_string())
    }
}

/// The start of an error: where no format knows a file, the rest lists them all.
fn shortened(error: &str) -> String {
    const LENGTH: usize = 160;
    match error.char_indices().nth(LENGTH) {
        Some((end, _)) => format!("{}…", &error[..end]),
        None => error.to_owned(),
    }
}
