//! What the log of results is told is counted: each outcome has its line, so nothing is missed or counted twice.

use std::collections::VecDeque;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use serde_json::{Map, Value};

use super::metrics::Metrics;
use crate::path_text::PathText;
use crate::status::{LastError, Rates};

/// So many of the last errors are kept.
const ERRORS: usize = 20;

/// Rates are taken over this time.
const WINDOW: Duration = Duration::from_secs(300);

/// What has been heard since the start.
pub struct Heard {
    metrics: Metrics,
    errors: Mutex<VecDeque<LastError>>,
    /// Meshes and bytes that were done with, since the start, at some times of the last minutes.
    samples: Mutex<VecDeque<(Instant, u64, u64)>>,
}

impl Heard {
    /// Nothing yet.
    pub fn new(metrics: Metrics) -> Self {
        let samples = Mutex::new(VecDeque::from([(Instant::now(), 0, 0)]));
        Self { metrics, errors: Mutex::default(), samples }
    }

    /// A line that is written to the log.
    pub fn hear(&self, event: &Map<String, Value>) {
        let text = |key: &str| event.get(key).and_then(Value::as_str);
        let number = |key: &str| event.get(key).and_then(Value::as_u64).unwrap_or(0);
        self.metrics.log_lines.inc();
        let name = text("event").unwrap_or_default();
        match name {
            "mesh.detected" | "mesh.claimed" => {}
            "log.repaired" => self.metrics.log_repairs.inc(),
            _ => {
                if let Some(outcome) = name.strip_prefix("mesh.") {
                    self.metrics.meshes.with_label_values(&[outcome]).inc();
                }
            }
        }
        if name == "mesh.scored" {
            self.metrics.verdicts.with_label_values(&[text("status").unwrap_or_default()]).inc();
            self.metrics.bytes.inc_by(number("bytes"));
            self.metrics.elements.inc_by(number("elements"));
            self.metrics.durations.observe(event.get("seconds").and_then(Value::as_f64).unwrap_or(0.0));
        }
        if let Some(kind) = text("kind")
            && name == "mesh.failed"
        {
            self.metrics.failures.with_label_values(&[kind]).inc();
        }
        if text("level") == Some("error") {
            self.went_wrong(LastError {
                timestamp: text("timestamp").unwrap_or_default().into(),
                mesh: mesh(event),
                kind: text("kind").unwrap_or(name).into(),
                reason: text("reason").unwrap_or_default().into(),
            });
        }
    }

    /// Something went wrong that the log of results may not tell of.
    pub fn went_wrong(&self, error: LastError) {
        let mut errors = self.errors.lock().unwrap_or_else(PoisonError::into_inner);
        errors.push_back(error);
        while errors.len() > ERRORS {
            errors.pop_front();
        }
    }

    /// The last things that went wrong, the latest last.
    pub fn errors(&self) -> Vec<LastError> {
        self.errors.lock().unwrap_or_else(PoisonError::into_inner).iter().cloned().collect()
    }

    /// How fast it has been of late. To be asked every few seconds: each time is a sample.
    pub fn rates(&self, now: Instant) -> Rates {
        let meshes = Metrics::counts(&self.metrics.meshes);
        let done = ["scored", "failed", "ignored", "quarantined"];
        let done = done.iter().filter_map(|outcome| meshes.get(*outcome)).sum();
        let bytes = self.metrics.bytes.get();
        let mut samples = self.samples.lock().unwrap_or_else(PoisonError::into_inner);
        while samples.len() > 1 && samples[1].0 + WINDOW <= now {
            samples.pop_front();
        }
        samples.push_back((now, done, bytes));
        let (then, meshes_then, bytes_then) = samples[0];
        let seconds = now.duration_since(then).as_secs_f64();
        let per_second = |count: u64| if seconds > 0.0 { count as f64 / seconds } else { 0.0 };
        Rates {
            seconds,
            meshes_per_second: per_second(done - meshes_then),
            bytes_per_second: per_second(bytes - bytes_then),
        }
    }
}

/// The mesh that a line is about.
fn mesh(event: &Map<String, Value>) -> Option<PathText> {
    let bytes = event.get("mesh_bytes").or_else(|| event.get("mesh"))?;
    serde_json::from_value(bytes.clone()).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn event(text: &str) -> Map<String, Value> {
        serde_json::from_str(text).expect("an object")
    }

    #[test]
    fn outcomes_are_counted_and_errors_kept() {
        let metrics = Metrics::new().expect("metrics");
        let heard = Heard::new(metrics.clone());
        heard.hear(&event(r#"{"level":"info","event":"mesh.detected","mesh":"a.msh"}"#));
        let scored =
            r#"{"level":"info","event":"mesh.scored","mesh":"a.msh","status":"warn","bytes":7,"elements":3}"#;
        heard.hear(&event(scored));
        for line in 0..30 {
            let failed = r#"{"level":"error","event":"mesh.failed","mesh":"b","kind":"limit","reason":"R"}"#;
            heard.hear(&event(&failed.replace('R', &line.to_string())));
        }
        let counts = Metrics::counts(&metrics.meshes);
        assert_eq!(counts.into_iter().collect::<Vec<_>>(), [("failed".into(), 30), ("scored".into(), 1)]);
        assert_eq!((metrics.bytes.get(), metrics.elements.get(), metrics.log_lines.get()), (7, 3, 32));
        assert_eq!(metrics.failures.with_label_values(&["limit"]).get(), 30);
        let errors = heard.errors();
        assert_eq!((errors.len(), errors[19].reason.as_str()), (ERRORS, "29"));
    }

    #[test]
    fn rates_are_over_the_last_minutes() {
        let metrics = Metrics::new().expect("metrics");
        let heard = Heard::new(metrics.clone());
        let start = Instant::now();
        metrics.meshes.with_label_values(&["scored"]).inc_by(100);
        for second in (0..=1000).step_by(5) {
            heard.rates(start + Duration::from_secs(second));
        }
        metrics.meshes.with_label_values(&["failed"]).inc_by(30);
        let rates = heard.rates(start + Duration::from_secs(1005));
        assert!(
            (rates.meshes_per_second - 0.1).abs() < 1e-9 && (rates.seconds - 300.0).abs() < 1e-9,
            "{rates:?}"
        );
    }
}
