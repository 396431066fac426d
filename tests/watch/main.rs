//! The daemon: what happens to files that arrive, change, fail, and to a daemon that is stopped or killed.

mod arriving;
mod daemon;
mod failing;
mod naming;
mod stopping;
