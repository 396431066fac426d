//! The daemon: what happens to files that arrive, change, fail, and to a daemon that is stopped or killed.
#![cfg(feature = "program")]

mod arriving;
mod daemon;
mod failing;
mod naming;
mod status;
mod stopping;
