//! Faults, done to the daemon again and again: `docs/RELIABILITY.md` has the table of them.
//!
//! Each is repeated a few times here, and as often as the table says with `MESHGAUGE_FAULTS=full`. What needs root or a
//! program that is not there says aloud that it is skipped.
#![cfg(feature = "program")]

#[path = "../watch/daemon.rs"]
#[expect(dead_code, reason = "other tests use the rest of it")]
mod daemon;

mod arrivals;
mod clocks;
mod disks;
mod kills;
mod machine;
mod many;
mod names;
mod operators;
mod oracle;
mod pairs;
mod power;
mod readers;
mod tools;
mod truncation;
mod volumes;
