//! Signals that ask something of the daemon.

use std::io;

use crossbeam_channel::{Receiver, bounded};
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGUSR1};
use signal_hook::iterator::Signals;

/// What is asked for.
pub struct Requests {
    /// The name of each signal that asks us to stop: the first to finish, the second to stop now.
    pub stop: Receiver<&'static str>,
    /// SIGHUP: read the configuration again.
    pub reload: Receiver<()>,
    /// SIGUSR1: open the log again, which somebody moved away.
    pub reopen: Receiver<()>,
}

/// Listens from now on.
pub fn requests() -> io::Result<Requests> {
    let mut signals = Signals::new([SIGTERM, SIGINT, SIGHUP, SIGUSR1])?;
    // More than fit say nothing new.
    let (stopping, stop) = bounded(2);
    let (reloading, reload) = bounded(1);
    let (reopening, reopen) = bounded(1);
    std::thread::spawn(move || {
        for signal in signals.forever() {
            let _ = match signal {
                SIGHUP => reloading.try_send(()).is_ok(),
                SIGUSR1 => reopening.try_send(()).is_ok(),
                SIGINT => stopping.try_send("SIGINT").is_ok(),
                _ => stopping.try_send("SIGTERM").is_ok(),
            };
        }
    });
    Ok(Requests { stop, reload, reopen })
}
