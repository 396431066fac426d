//! The configuration: defaults, then the file, then the command line.

use std::collections::BTreeMap;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::Context;
use meshgauge::Options;
use meshgauge::compare::Tolerances;
use meshgauge::mesh::{Frame, System};
use meshgauge::summary::{Judgement, PRESETS, Rule};
use serde::{Deserialize, Serialize};

use crate::config_file;
use crate::exit::Usage;
use crate::quantity::{Size, Span};
use crate::series::Naming;
use crate::{measuring, rules, selection};

/// Every setting. `config/meshgauge.toml` says what each means.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Config {
    /// How a mesh is scored.
    pub score: Score,
    /// What makes a mesh fail.
    pub verdict: Verdict,
    /// How much may change between two meshes.
    pub compare: Tolerances,
    /// What the daemon compares each mesh with.
    pub baseline: Baseline,
    /// What the daemon keeps of past scores.
    pub history: History,
    /// Limits that guard the machine.
    pub limits: Limits,
    /// The daemon.
    pub watch: Watch,
    /// The daemon's log of results.
    pub log: Log,
    /// The processes that score for the daemon.
    pub worker: Worker,
    /// What the daemon tells of itself.
    pub telemetry: Telemetry,
    /// What the program says about itself.
    pub diagnostics: Diagnostics,
}

/// `[score]`
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[allow(missing_docs)]
pub struct Score {
    pub threads: usize,
    pub memory: Size,
    pub scratch: PathBuf,
    pub scratch_limit: Size,
    pub measures: String,
    pub frame: System,
    pub stretch: [f64; 3],
    pub worst: usize,
    pub by_region: bool,
    pub checks: Checks,
    pub allow_missing_nodes: bool,
    pub run_info: bool,
}

/// Which checks are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Checks {
    /// Those that cost next to nothing.
    Standard,
    /// Duplicate elements and coincident nodes too.
    All,
}

/// `[verdict]`
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[allow(missing_docs)]
pub struct Verdict {
    pub preset: String,
    pub fail_under: BTreeMap<String, f64>,
    pub rules: Vec<rules::Row>,
}

/// `[baseline]`
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[allow(missing_docs)]
pub struct Baseline {
    pub compare: bool,
    pub pattern: String,
}

/// `[history]`
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[allow(missing_docs)]
pub struct History {
    pub keep: Span,
}

/// `[limits]`
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[allow(missing_docs)]
pub struct Limits {
    pub file_bytes: Size,
    pub unpacked_bytes: Size,
    pub unpacked_ratio: u64,
    pub window_bytes: Size,
    pub line_bytes: Size,
    pub include_depth: usize,
    pub include_count: usize,
    pub regions: usize,
}

/// `[watch]`
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[allow(missing_docs)]
pub struct Watch {
    pub drop: PathBuf,
    pub results: PathBuf,
    pub log: PathBuf,
    pub state: PathBuf,
    pub done: Done,
    pub sidecars: Vec<String>,
    pub settle: Span,
    pub scan: Span,
    pub settle_network: Span,
    pub scan_network: Span,
    pub events: bool,
    pub depth: usize,
    pub symlinks: Symlinks,
    pub ignore: Vec<String>,
    pub patience: Span,
    pub drain: Span,
    pub rules: Vec<measuring::Row>,
}

/// How a file is known to be whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Done {
    /// It stands still.
    Settle,
    /// It was renamed into place, or stands still.
    Rename,
    /// Another file beside it says so.
    Sidecar,
}

/// `[log]`
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[allow(missing_docs)]
pub struct Log {
    pub rotate_bytes: Size,
    pub rotate_age: Span,
    pub keep: usize,
}

/// Which symbolic links to files are followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Symlinks {
    /// Those that end inside the folder.
    Inside,
    /// All.
    All,
    /// None.
    None,
}

/// `[worker]`
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[allow(missing_docs)]
pub struct Worker {
    pub count: usize,
    pub time: Span,
    pub memory: Size,
    pub retry: Span,
    pub quarantine: u32,
}

/// `[telemetry]`
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[allow(missing_docs)]
pub struct Telemetry {
    pub interval: Span,
    pub metrics_file: PathBuf,
    pub listen: String,
    pub stalled: Span,
}

impl Telemetry {
    /// Where to listen, if anywhere.
    pub fn address(&self) -> Result<Option<SocketAddr>, Usage> {
        if self.listen.is_empty() {
            return Ok(None);
        }
        let wrong =
            |what: &str| Usage(format!("telemetry.listen: expected {what}, found \"{}\"", self.listen));
        let address: SocketAddr =
            self.listen.parse().map_err(|_| wrong("an address such as 127.0.0.1:9817"))?;
        if address.ip().is_loopback() { Ok(Some(address)) } else { Err(wrong("a loopback address")) }
    }
}

/// `[diagnostics]`
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[allow(missing_docs)]
pub struct Diagnostics {
    pub level: String,
}

impl Default for Score {
    fn default() -> Self {
        Self {
            threads: 0,
            memory: Size(256 << 20),
            scratch: PathBuf::new(),
            scratch_limit: Size(4 << 40),
            measures: "all".into(),
            frame: Frame::OWN.system,
            stretch: Frame::OWN.stretch,
            worst: 0,
            by_region: false,
            checks: Checks::Standard,
            allow_missing_nodes: false,
            run_info: true,
        }
    }
}

impl Default for Verdict {
    fn default() -> Self {
        Self { preset: PRESETS[0].name.into(), fail_under: BTreeMap::new(), rules: Vec::new() }
    }
}

impl Default for Baseline {
    fn default() -> Self {
        Self { compare: true, pattern: String::new() }
    }
}

impl Baseline {
    /// Which meshes are one part.
    pub fn naming(&self) -> Result<Naming, Usage> {
        Naming::new(&self.pattern).map_err(|why| Usage(format!("baseline.pattern: {why}")))
    }
}

impl Default for History {
    fn default() -> Self {
        Self { keep: Span(Duration::from_secs(90 * 24 * 3600)) }
    }
}

impl Default for Limits {
    fn default() -> Self {
        let limits = meshgauge::input::Limits::default();
        Self {
            file_bytes: Size(limits.file_bytes),
            unpacked_bytes: Size(limits.unpacked_bytes),
            unpacked_ratio: limits.unpacked_ratio,
            window_bytes: Size(limits.window_bytes),
            line_bytes: Size(limits.line_bytes as u64),
            include_depth: limits.include_depth,
            include_count: limits.include_count,
            regions: Options::default().most_regions,
        }
    }
}

impl Default for Watch {
    fn default() -> Self {
        let still_written = [
            ".*",
            "*~",
            "*.tmp",
            "*.part",
            "*.partial",
            "*.filepart",
            "*.inprogress",
            "*.crdownload",
            "*.PROCESSING",
        ];
        Self {
            drop: "drop".into(),
            results: "results".into(),
            log: PathBuf::new(),
            state: PathBuf::new(),
            done: Done::Settle,
            sidecars: [".done", ".ok"].map(String::from).to_vec(),
            settle: Span(Duration::from_secs(2)),
            scan: Span(Duration::from_secs(15)),
            settle_network: Span(Duration::from_secs(90)),
            scan_network: Span(Duration::from_secs(30)),
            events: true,
            depth: 32,
            symlinks: Symlinks::Inside,
            ignore: still_written.map(String::from).to_vec(),
            patience: Span(Duration::from_secs(60)),
            drain: Span(Duration::from_secs(60)),
            rules: Vec::new(),
        }
    }
}

impl Default for Log {
    fn default() -> Self {
        Self { rotate_bytes: Size(256 << 20), rotate_age: Span(Duration::ZERO), keep: 0 }
    }
}

impl Default for Worker {
    fn default() -> Self {
        Self {
            count: 2,
            time: Span(Duration::from_secs(3600)),
            memory: Size(1 << 30),
            retry: Span(Duration::from_secs(300)),
            quarantine: 2,
        }
    }
}

impl Default for Telemetry {
    fn default() -> Self {
        Self {
            interval: Span(Duration::from_secs(5)),
            metrics_file: PathBuf::new(),
            listen: String::new(),
            stalled: Span(Duration::from_secs(60)),
        }
    }
}

impl Default for Diagnostics {
    fn default() -> Self {
        Self { level: "warn".into() }
    }
}

/// The most elements that a list of the worst may have: more belong into a file of all elements.
pub const MOST_WORST: usize = 10_000;

impl Config {
    /// Reads the file at `path`, or takes the defaults where none is given.
    pub fn read(path: Option<&Path>) -> anyhow::Result<Self> {
        let Some(path) = path else { return Ok(Config::default()) };
        let text = config_file::read(path).map_err(|e| Usage(format!("{}: {e}", path.display())))?;
        let config = config_file::parse(&text).map_err(|e| Usage(format!("{}: {e}", path.display())))?;
        config.check().with_context(|| path.display().to_string())?;
        Ok(config)
    }

    /// Says what makes no sense in settings that are well-formed each on its own.
    pub fn check(&self) -> Result<(), Usage> {
        selection::measures(&self.score.measures)?;
        self.verdict.judgement()?;
        self.telemetry.address()?;
        self.baseline.naming()?;
        let levels = ["error", "warn", "info", "debug", "trace"];
        measuring::check(&self.watch.rules).map_err(Usage)?;
        let wrong = [
            (!self.compare.is_sound(), "compare: tolerances are numbers from 0 up".to_owned()),
            (
                !measuring::is_stretch(&self.score.stretch),
                "score.stretch must be three numbers over 0".to_owned(),
            ),
            (self.score.worst > MOST_WORST, format!("score.worst must be at most {MOST_WORST}")),
            (self.watch.settle.0.is_zero(), "watch.settle must be longer than 0s".to_owned()),
            (self.watch.scan.0.is_zero(), "watch.scan must be longer than 0s".to_owned()),
            (self.watch.settle_network.0.is_zero(), "watch.settle_network must be longer than 0s".to_owned()),
            (self.watch.scan_network.0.is_zero(), "watch.scan_network must be longer than 0s".to_owned()),
            (
                self.watch.sidecars.iter().any(String::is_empty),
                "watch.sidecars must not hold \"\"".to_owned(),
            ),
            (
                self.watch.done == Done::Sidecar && self.watch.sidecars.is_empty(),
                "watch.sidecars must name an ending where watch.done is \"sidecar\"".to_owned(),
            ),
            (self.worker.quarantine == 0, "worker.quarantine must be at least 1".to_owned()),
            (self.watch.depth == 0, "watch.depth must be at least 1".to_owned()),
            (!(1..=1024).contains(&self.worker.count), "worker.count must be from 1 to 1024".to_owned()),
            (self.worker.time.0.is_zero(), "worker.time must be longer than 0s".to_owned()),
            (
                self.worker.memory <= self.score.memory,
                format!(
                    "worker.memory ({}) must be over score.memory ({})",
                    self.worker.memory, self.score.memory
                ),
            ),
            (
                self.telemetry.interval.0 < Duration::from_millis(100),
                "telemetry.interval must be at least 100ms".to_owned(),
            ),
            (
                self.telemetry.stalled <= self.telemetry.interval,
                "telemetry.stalled must be over telemetry.interval".to_owned(),
            ),
            (
                !levels.contains(&self.diagnostics.level.as_str()),
                format!("diagnostics.level must be one of {}", levels.join(", ")),
            ),
        ];
        match wrong.into_iter().find(|(wrong, _)| *wrong) {
            Some((_, why)) => Err(Usage(why)),
            None => Ok(()),
        }
    }

    /// The settings as the library takes them.
    pub fn options(&self) -> Result<Options, Usage> {
        let defaults = Options::default();
        let Config { score, limits, .. } = self;
        Ok(Options {
            threads: if score.threads == 0 { defaults.threads } else { score.threads },
            memory: score.memory.0,
            scratch: if score.scratch.as_os_str().is_empty() {
                defaults.scratch
            } else {
                score.scratch.clone()
            },
            scratch_bytes: score.scratch_limit.0,
            format: None,
            measures: selection::measures(&score.measures)?,
            frame: Frame { system: score.frame, stretch: score.stretch },
            allow_missing_nodes: score.allow_missing_nodes,
            limits: meshgauge::input::Limits {
                file_bytes: limits.file_bytes.0,
                unpacked_bytes: limits.unpacked_bytes.0,
                unpacked_ratio: limits.unpacked_ratio,
                window_bytes: limits.window_bytes.0,
                line_bytes: usize::try_from(limits.line_bytes.0).unwrap_or(usize::MAX),
                include_depth: limits.include_depth,
                include_count: limits.include_count,
            },
            judgement: self.verdict.judgement()?,
            worst: score.worst,
            by_region: score.by_region,
            all_checks: score.checks == Checks::All || self.verdict.needs_all_checks(),
            most_regions: limits.regions,
            run_info: score.run_info,
            progress: None,
        })
    }
}

impl Verdict {
    /// Whether a rule is about a check that is not always made.
    fn needs_all_checks(&self) -> bool {
        self.rules.iter().any(|row| meshgauge::summary::Checks::COSTLY.contains(&row.measure.as_str()))
    }

    /// What a mesh is judged by.
    fn judgement(&self) -> Result<Judgement, Usage> {
        let mut own = Vec::new();
        for (measure, &limit) in &self.fail_under {
            own.push(Rule::fail_under(selection::known(measure)?, limit));
        }
        own.extend(rules::rules(&self.rules)?);
        Ok(Judgement { rules: own, presets: rules::presets(&self.preset)?, expectation: None })
    }
}
