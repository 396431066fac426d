//! One attempt at a file: on a thread of its own, against the clock and the cap of the heap.

use std::path::Path;
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::time::Duration;

use meshgauge::error::{At, Kind};
use meshgauge::{Error, Options, Result, Summary, score};

use crate::{COMPANIONS, heap};

/// Longer takes no attempt, even on a machine that is busy with other things.
const DEADLINE: Duration = Duration::from_secs(60);

pub fn options() -> Options {
    Options { threads: 2, run_info: false, memory: 64 << 20, ..Options::default() }
}

/// The result of `score`, in time and within the cap. What it is about is said in `what`.
#[track_caller]
pub fn attempt_with(path: &Path, options: &Options, what: &str) -> Result<Summary> {
    let (send, receive) = sync_channel(1);
    let (path, options) = (path.to_owned(), options.clone());
    let thread = std::thread::spawn(move || {
        let _ = send.send(score(&path, &options));
    });
    let result = match receive.recv_timeout(DEADLINE) {
        Ok(result) => result,
        Err(RecvTimeoutError::Timeout) => panic!("{what}: still at it after {DEADLINE:?}"),
        Err(RecvTimeoutError::Disconnected) => panic!("{what}: panicked: {:?}", thread.join()),
    };
    assert!(heap::peak() < heap::CAP, "{what}: {} bytes in use", heap::peak());
    result
}

#[track_caller]
pub fn attempt(path: &Path, what: &str) -> Result<Summary> {
    attempt_with(path, &options(), what)
}

/// Writes the bytes to a file of this name and has a go at it.
#[track_caller]
pub fn attempt_bytes(name: &str, bytes: &[u8], what: &str) -> Result<Summary> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).expect("written");
    attempt(&path, what)
}

/// Has a go at the bytes in place of those of a mesh: under its name, and with what stands beside it.
#[track_caller]
pub fn attempt_in_place(mesh: &Path, bytes: &[u8], what: &str) -> Result<Summary> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join(mesh.file_name().expect("a name"));
    std::fs::write(&path, bytes).expect("written");
    for extension in COMPANIONS {
        let companion = mesh.with_extension(extension);
        if companion.exists() {
            std::fs::copy(&companion, path.with_extension(extension)).expect("copied");
        }
    }
    attempt(&path, what)
}

#[track_caller]
pub fn refused(result: Result<Summary>, what: &str) -> Error {
    match result {
        Err(error) => {
            assert_tells_all(&error, what);
            error
        }
        Ok(summary) => panic!("{what}: scored: {} elements", summary.elements.count),
    }
}

/// The message names file, format and place, what was expected and what stood there.
#[track_caller]
pub fn assert_tells_all(error: &Error, what: &str) {
    let path = error.path().unwrap_or_else(|| panic!("{what}: no file: {error}"));
    assert!(error.to_string().contains(&*path.to_string_lossy()), "{what}: {error}");
    match error.kind() {
        Kind::Empty | Kind::NotAFile(_) | Kind::UnknownFormat(_) => return,
        Kind::Malformed { expected, found } => {
            assert!(!expected.trim().is_empty() && !found.trim().is_empty(), "{what}: {error}");
        }
        Kind::Unsupported(text) => assert!(!text.trim().is_empty(), "{what}"),
        Kind::Limit { .. } | Kind::MissingNode { .. } => {}
        // The name of a file beside this one was changed.
        Kind::Unreadable(cause) if cause.to_string().starts_with("included file") => {}
        other => panic!("{what}: {other:?}: {error}"),
    }
    assert!(error.format().is_some(), "{what}: no format: {error}");
    assert!(error.place().is_some(), "{what}: no place: {error}");
}

/// The error is about a line of a text.
#[track_caller]
pub fn assert_line(error: &Error, what: &str) {
    let found = error.format().is_none() || matches!(error.place(), Some(At::Line(_)));
    assert!(found, "{what}: no line: {error}");
}
