//! Diagnostics: what the program says about itself, on stderr. The log of results is another thing.

use std::io::{IsTerminal, stderr};

use tracing_subscriber::EnvFilter;

/// The environment variable that overrides the level, in the syntax of `tracing`: `meshgauge=debug`.
pub const VARIABLE: &str = "MESHGAUGE_LOG";

/// Starts diagnostics at `level`, or `verbose` steps above it.
pub fn start(level: &str, verbose: u8) {
    const LEVELS: [&str; 5] = ["error", "warn", "info", "debug", "trace"];
    let start = LEVELS.iter().position(|l| *l == level).unwrap_or(1);
    let level = LEVELS[(start + usize::from(verbose)).min(LEVELS.len() - 1)];
    let filter = EnvFilter::try_from_env(VARIABLE).unwrap_or_else(|_| EnvFilter::new(level));
    let colour = stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty());
    tracing_subscriber::fmt().with_writer(stderr).with_env_filter(filter).with_ansi(colour).init();
}
