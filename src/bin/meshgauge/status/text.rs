//! A status for people.

use std::fmt::Write;
use std::path::PathBuf;

use bytesize::ByteSize;

use super::{Health, Running, Status, Watched};
use crate::daemon::fields::printable;
use crate::path_text::PathText;

/// So many of the waiting are shown.
const WAITING: usize = 5;

/// Columns beside a bar, and most columns of one.
const MARGIN: usize = 10;
const WIDEST: usize = 60;

/// A status for people: how the daemon is, then what it does. On a terminal of so many columns meshes in work have bars.
pub fn text(status: &Status, health: Health, age: Option<f64>, columns: Option<u16>) -> String {
    let mut out = String::new();
    head(&mut out, status, health, age);
    for watched in &status.watches {
        drop_folder(&mut out, watched);
    }
    let q = &status.queue;
    let _ = writeln!(
        out,
        "files    {} at work, {} queued, {} settling, {} to be tried again; the oldest is {:.0} s old",
        q.running, q.queued, q.settling, q.postponed, q.oldest_seconds
    );
    status.running.iter().for_each(|running| at_work(&mut out, running, columns));
    for waiting in status.waiting.iter().take(WAITING) {
        let _ = writeln!(out, "  next   {}", shown(&waiting.mesh));
    }
    let outcomes: Vec<_> =
        status.outcomes.iter().map(|(outcome, count)| format!("{count} {outcome}")).collect();
    let outcomes = if outcomes.is_empty() { "none".into() } else { outcomes.join(", ") };
    let _ = writeln!(out, "outcomes {outcomes}, since {}", status.started);
    let r = &status.rates;
    let _ = writeln!(
        out,
        "rates    {:.3} meshes/s, {}/s over the last {:.0} s",
        r.meshes_per_second,
        ByteSize(r.bytes_per_second as u64),
        r.seconds
    );
    for error in &status.last_errors {
        let mesh = error.mesh.as_ref().map(|mesh| format!("{}: ", shown(mesh))).unwrap_or_default();
        let _ =
            writeln!(out, "error    {} {mesh}{}: {}", error.timestamp, error.kind, printable(&error.reason));
    }
    out
}

fn head(out: &mut String, status: &Status, health: Health, age: Option<f64>) {
    let process = &status.process;
    let how = match health {
        Health::Well => "running".into(),
        Health::Degraded => "running, but not as it should".into(),
        Health::Hung => "hangs: it lives, but its loop does not turn".into(),
        Health::Stopped => "stopped by a signal (SIGCONT lets it go on)".into(),
        Health::Ended => {
            format!("ended: {}", status.ended.as_deref().unwrap_or("before the machine was started anew"))
        }
        Health::Dead => {
            "dead: the process is gone and did not say why; the next start takes up its work".into()
        }
        Health::Elsewhere => format!("runs on {}, as far as its file tells", process.host),
    };
    let written = age.map_or_else(|| format!("as of {}", status.written), |age| format!("{age:.1} s ago"));
    let _ = writeln!(out, "daemon   {how}; {written}");
    let _ = writeln!(
        out,
        "process  {} on {}, meshgauge {}, since {}",
        process.pid, process.host, status.meshgauge, status.started
    );
    for reason in &status.degraded {
        let _ = writeln!(out, "degraded {reason}");
    }
}

fn drop_folder(out: &mut String, watched: &Watched) {
    let _ = writeln!(out, "drop     {}", shown(&watched.drop));
    for mount in &watched.mounts {
        let hangs =
            mount.hangs_seconds.map(|s| format!(", has not answered for {s:.0} s")).unwrap_or_default();
        let how = if mount.network { "scanned" } else { "events and scans" };
        let _ = writeln!(out, "  mount  {} ({}, {how}{hangs})", shown(&mount.path), mount.kind);
    }
    match &watched.scanned {
        Some(last) => {
            let _ = writeln!(
                out,
                "  scan   {} files, {} folders in {:.3} s at {last}",
                watched.files, watched.folders, watched.scan_seconds
            );
        }
        None => out.push_str("  scan   none yet\n"),
    }
    for problem in &watched.problems {
        let _ = writeln!(out, "  cannot {problem}");
    }
}

fn at_work(out: &mut String, running: &Running, columns: Option<u16>) {
    let (done, known) = running.pieces;
    let share = (100 * done).checked_div(known).map(|share| format!(", {share} %")).unwrap_or_default();
    let silent = if running.silent_seconds > 10.0 {
        format!(", silent for {:.0} s", running.silent_seconds)
    } else {
        String::new()
    };
    let _ = writeln!(
        out,
        "  work   {} ({}): {}{share}, {:.0} s{silent}",
        shown(&running.mesh),
        ByteSize(running.bytes),
        running.phase,
        running.seconds
    );
    if let Some(columns) = columns {
        let width = usize::from(columns).saturating_sub(MARGIN).min(WIDEST);
        let filled = (done as f64 / known.max(1) as f64 * width as f64) as usize;
        let _ = writeln!(
            out,
            "         {}{}",
            "█".repeat(filled.min(width)),
            "░".repeat(width.saturating_sub(filled))
        );
    }
}

/// A path that may have been named by anybody.
fn shown(path: &PathText) -> String {
    printable(&PathBuf::from(path.clone()).display().to_string())
}
