//! The daemon: what happens to files that arrive, change, fail, and to a daemon that is stopped or killed.
#![cfg(feature = "program")]

mod arriving;
mod coordinates;
mod daemon;
mod failing;
mod full;
mod limits;
mod live;
mod mounts;
mod naming;
mod operating;
mod quarantine;
mod status;
mod stopping;
mod whole;
