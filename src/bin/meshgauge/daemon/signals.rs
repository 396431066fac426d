//! Signals that ask the daemon to stop.

use std::io;

use crossbeam_channel::{Receiver, bounded};
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::iterator::Signals;

/// Gets the name of each signal that asks us to stop.
pub fn stop_requests() -> io::Result<Receiver<&'static str>> {
    let mut signals = Signals::new([SIGTERM, SIGINT])?;
    // The first asks us to finish, the second to stop now; more say nothing new.
    let (sender, requests) = bounded(2);
    std::thread::spawn(move || {
        for signal in signals.forever() {
            let _ = sender.try_send(if signal == SIGINT { "SIGINT" } else { "SIGTERM" });
        }
    });
    Ok(requests)
}
