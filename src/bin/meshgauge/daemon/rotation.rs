//! Rotation of the log: the full one gets a name with the time, and stays in its folder.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Instant, SystemTime};

use crate::config;

/// When the log that was opened was begun, by the monotonic clock: a clock that is set must not rotate it.
pub fn begun(log: &File) -> Instant {
    let now = Instant::now();
    let age = log.metadata().and_then(|data| data.created()).ok().and_then(|begun| begun.elapsed().ok());
    age.and_then(|age| now.checked_sub(age)).unwrap_or(now)
}

/// Whether a log of so many bytes, begun then, is to be rotated.
pub fn is_due(rules: &config::Log, bytes: u64, begun: Instant) -> bool {
    let (most, oldest) = (rules.rotate_bytes.0, rules.rotate_age.0);
    bytes > 0 && ((most > 0 && bytes >= most) || (!oldest.is_zero() && begun.elapsed() >= oldest))
}

/// Gives the log its name with the time, and returns that.
pub fn put_away(log: &Path) -> io::Result<PathBuf> {
    let now = humantime::format_rfc3339_millis(SystemTime::now()).to_string();
    let now: String = now.chars().filter(char::is_ascii_alphanumeric).collect();
    let mut name = log.as_os_str().to_owned();
    name.push(format!(".{now}"));
    let mut to = PathBuf::from(name);
    // A clock that was set back must not overwrite a log.
    while to.exists() {
        let mut name = to.into_os_string();
        name.push("-1");
        to = name.into();
    }
    fs::rename(log, &to)?;
    Ok(to)
}

/// Removes the oldest of the logs that were put away, until `keep` are left; 0 keeps all.
pub fn thin_out(log: &Path, keep: usize) -> io::Result<()> {
    let mut logs = put_away_before(log)?;
    logs.sort();
    let surplus = if keep == 0 { 0 } else { logs.len().saturating_sub(keep) };
    logs.iter().take(surplus).try_for_each(fs::remove_file)
}

/// The logs that were put away, by us or by others that only add to the name.
pub fn put_away_before(log: &Path) -> io::Result<Vec<PathBuf>> {
    let folder = log.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut prefix: OsString = log.file_name().unwrap_or_default().to_owned();
    prefix.push(".");
    let mut logs = Vec::new();
    for entry in fs::read_dir(folder)? {
        let name = entry?.file_name();
        if name.as_encoded_bytes().starts_with(prefix.as_encoded_bytes()) {
            logs.push(folder.join(name));
        }
    }
    Ok(logs)
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use crate::quantity::{Size, Span};

    #[test]
    fn a_log_is_due_by_size_or_age() {
        let rules = |bytes, seconds| config::Log {
            rotate_bytes: Size(bytes),
            rotate_age: Span(Duration::from_secs(seconds)),
            ..config::Log::default()
        };
        let old = Instant::now().checked_sub(Duration::from_secs(20)).expect("the machine runs that long");
        assert!(is_due(&rules(100, 0), 100, old) && !is_due(&rules(100, 0), 99, old));
        assert!(is_due(&rules(0, 10), 1, old) && !is_due(&rules(0, 30), 1, old));
        assert!(!is_due(&rules(0, 10), 0, old), "nothing to put away");
        assert!(!is_due(&rules(0, 0), u64::MAX, old));
    }

    #[test]
    fn logs_are_put_away_side_by_side_and_the_oldest_go() {
        let folder = tempfile::tempdir().expect("a folder");
        let log = folder.path().join("meshgauge.jsonl");
        let mut away = Vec::new();
        for _ in 0..5 {
            fs::write(&log, "{}\n").expect("written");
            away.push(put_away(&log).expect("put away"));
        }
        assert!(!log.exists() && away.iter().all(|log| log.exists()));
        away.sort();
        thin_out(&log, 2).expect("thinned out");
        let left: Vec<_> = away.iter().map(|log| log.exists()).collect();
        assert_eq!(left, [false, false, false, true, true]);
        thin_out(&log, 0).expect("nothing to do");
        assert_eq!(put_away_before(&log).expect("listed").len(), 2);
    }
}
