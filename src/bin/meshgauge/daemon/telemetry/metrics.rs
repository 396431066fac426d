//! What Prometheus is told; `docs/METRICS.md` lists it.
//!
//! Labels have a few values each, fixed by the program; never a path. The text is that of the classic exposition
//! format, which node_exporter's textfile collector reads too.

use std::collections::BTreeMap;

use prometheus::core::Collector;
use prometheus::{
    Counter, Encoder, Gauge, Histogram, HistogramOpts, IntCounter, IntCounterVec, IntGauge, IntGaugeVec,
    Opts, Registry, TextEncoder,
};

/// Upper ends of the classes of times that meshes take, in seconds.
const DURATIONS: [f64; 13] =
    [0.005, 0.01, 0.05, 0.1, 0.5, 1.0, 5.0, 10.0, 60.0, 300.0, 1800.0, 3600.0, 14400.0];

/// All of it. Clones share their numbers.
#[derive(Clone)]
pub struct Metrics {
    registry: Registry,
    pub meshes: IntCounterVec,
    pub verdicts: IntCounterVec,
    pub failures: IntCounterVec,
    pub bytes: IntCounter,
    pub elements: IntCounter,
    pub durations: Histogram,
    pub files: IntGaugeVec,
    pub oldest: Gauge,
    pub drop_files: IntGauge,
    pub drop_folders: IntGauge,
    pub drop_problems: IntGauge,
    pub scans: IntCounter,
    pub scan_seconds: Gauge,
    pub scan_time: Gauge,
    pub degraded: IntGaugeVec,
    pub log_lines: IntCounter,
    pub log_repairs: IntCounter,
    pub resident: IntGauge,
    pub open_files: IntGauge,
    pub processor: Counter,
}

impl Metrics {
    /// Everything at its start.
    pub fn new() -> prometheus::Result<Self> {
        let registry = Registry::new();
        let build = Opts::new("meshgauge_build_info", "Version of meshgauge; always 1.")
            .const_label("version", env!("CARGO_PKG_VERSION"));
        registered(&registry, IntGauge::with_opts(build)?)?.set(1);
        let start = "Start of the daemon since the Unix epoch in seconds.";
        registered(&registry, Gauge::new("meshgauge_start_time_seconds", start)?)?.set(seconds_since_epoch());
        let durations =
            HistogramOpts::new("meshgauge_score_duration_seconds", "Time that scoring a mesh took.")
                .buckets(DURATIONS.to_vec());
        let r = &registry;
        Ok(Self {
            meshes: counters(r, "meshgauge_meshes_total", "Meshes by what became of them.", "outcome")?,
            verdicts: counters(r, "meshgauge_verdicts_total", "Scored meshes by verdict.", "status")?,
            failures: counters(r, "meshgauge_failures_total", "Meshes that failed, by kind.", "kind")?,
            bytes: counter(r, "meshgauge_scored_bytes_total", "Bytes of the meshes that were scored.")?,
            elements: counter(
                r,
                "meshgauge_scored_elements_total",
                "Elements of the meshes that were scored.",
            )?,
            durations: registered(r, Histogram::with_opts(durations)?)?,
            files: gauges(
                r,
                "meshgauge_files",
                "Files that are not done with, by what they wait for.",
                "state",
            )?,
            oldest: gauge(
                r,
                "meshgauge_oldest_file_seconds",
                "Time since the oldest of them was first seen.",
            )?,
            drop_files: whole(r, "meshgauge_drop_files", "Files in the drop-folder at the last scan.")?,
            drop_folders: whole(r, "meshgauge_drop_folders", "Folders in the drop-folder at the last scan.")?,
            drop_problems: whole(
                r,
                "meshgauge_drop_problems",
                "Files and folders that could not be looked at, at the last scan.",
            )?,
            scans: counter(r, "meshgauge_scans_total", "Times that the drop-folder was read through.")?,
            scan_seconds: gauge(r, "meshgauge_last_scan_duration_seconds", "Time that the last scan took.")?,
            scan_time: gauge(
                r,
                "meshgauge_last_scan_timestamp_seconds",
                "End of the last scan since the Unix epoch in seconds.",
            )?,
            degraded: gauges(
                r,
                "meshgauge_degraded",
                "Whether something keeps the daemon from working as it should, by reason.",
                "reason",
            )?,
            log_lines: counter(r, "meshgauge_log_lines_total", "Lines written to the log of results.")?,
            log_repairs: counter(r, "meshgauge_log_repairs_total", "Torn lines that were cut off the log.")?,
            resident: whole(
                r,
                "meshgauge_resident_memory_bytes",
                "Resident memory of the daemon, without workers.",
            )?,
            open_files: whole(r, "meshgauge_open_fds", "Open file descriptors of the daemon.")?,
            processor: registered(
                r,
                Counter::new(
                    "meshgauge_cpu_seconds_total",
                    "Processor time of the daemon, without workers.",
                )?,
            )?,
            registry,
        })
    }

    /// The text that Prometheus reads.
    pub fn text(&self) -> prometheus::Result<String> {
        let mut text = Vec::new();
        TextEncoder::new().encode(&self.registry.gather(), &mut text)?;
        String::from_utf8(text).map_err(|e| prometheus::Error::Msg(e.to_string()))
    }

    /// What a family of counters stands at, by the value of its only label.
    pub fn counts(family: &IntCounterVec) -> BTreeMap<String, u64> {
        let families = family.collect();
        let metrics = families.iter().flat_map(|family| family.get_metric());
        metrics
            .filter_map(|metric| {
                let label = metric.get_label().first()?;
                Some((label.value().to_owned(), metric.get_counter().get_value() as u64))
            })
            .collect()
    }
}

/// The present time as Prometheus writes times.
pub fn seconds_since_epoch() -> f64 {
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    now.map_or(0.0, |since| since.as_secs_f64())
}

fn registered<C: Collector + Clone + 'static>(registry: &Registry, collector: C) -> prometheus::Result<C> {
    registry.register(Box::new(collector.clone()))?;
    Ok(collector)
}

fn counter(registry: &Registry, name: &str, help: &str) -> prometheus::Result<IntCounter> {
    registered(registry, IntCounter::new(name, help)?)
}

fn counters(registry: &Registry, name: &str, help: &str, label: &str) -> prometheus::Result<IntCounterVec> {
    registered(registry, IntCounterVec::new(Opts::new(name, help), &[label])?)
}

fn whole(registry: &Registry, name: &str, help: &str) -> prometheus::Result<IntGauge> {
    registered(registry, IntGauge::new(name, help)?)
}

fn gauge(registry: &Registry, name: &str, help: &str) -> prometheus::Result<Gauge> {
    registered(registry, Gauge::new(name, help)?)
}

fn gauges(registry: &Registry, name: &str, help: &str, label: &str) -> prometheus::Result<IntGaugeVec> {
    registered(registry, IntGaugeVec::new(Opts::new(name, help), &[label])?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_metric_is_documented_with_its_type() {
        let metrics = Metrics::new().expect("names are well-formed");
        metrics.meshes.with_label_values(&["scored"]).inc();
        metrics.verdicts.with_label_values(&["pass"]).inc();
        metrics.failures.with_label_values(&["malformed"]).inc();
        metrics.files.with_label_values(&["queued"]).set(1);
        metrics.degraded.with_label_values(&["disk"]).set(1);
        let documented = include_str!("../../../../../docs/METRICS.md");
        let text = metrics.text().expect("text");
        let types: Vec<_> = text.lines().filter_map(|line| line.strip_prefix("# TYPE ")).collect();
        assert_eq!(types.len(), 22);
        for line in types {
            let (name, kind) = line.split_once(' ').expect("a name and a type");
            let row = documented.lines().find(|row| row.starts_with(&format!("| `{name}`")));
            let row = row.unwrap_or_else(|| panic!("docs/METRICS.md has no row for {name}"));
            assert!(row.contains(kind), "{row}: expected {kind}");
        }
        assert_eq!(Metrics::counts(&metrics.meshes), BTreeMap::from([("scored".into(), 1)]));
    }
}
