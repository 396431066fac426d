//! What the daemon and its workers say to each other: a JSON line each way.

use std::io;

use meshgauge::error::{At, Bound, Kind};
use meshgauge::{Error, Summary};
use serde::{Deserialize, Serialize};

use crate::config::Config;
use crate::exit::Status;
use crate::path_text::PathText;

/// Score this mesh.
#[derive(Debug, Serialize, Deserialize)]
pub struct Request {
    /// The mesh.
    pub path: PathText,
    /// How.
    pub config: Config,
}

/// What became of it.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Answer {
    /// It was scored.
    Scored(Box<Summary>),
    /// It was not.
    Failed(Failure),
}

/// What a worker says.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Said {
    /// It is being scored.
    Progress(Progress),
    /// It is done with.
    Answer(Answer),
}

/// How far a worker is with its mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Progress {
    /// Pieces (about 1 MiB each) that are known.
    pub pieces: u64,
    /// Pieces that are done.
    pub pieces_done: u64,
    /// Elements that are measured.
    pub elements: u64,
}

impl Progress {
    /// The phase, in words.
    pub fn phase(self) -> &'static str {
        match self {
            Progress { pieces: 0, .. } => "opening",
            Progress { elements: 0, .. } => "reading nodes",
            Progress { .. } => "measuring elements",
        }
    }
}

impl From<&meshgauge::Progress> for Progress {
    fn from(progress: &meshgauge::Progress) -> Self {
        Self { pieces: progress.pieces(), pieces_done: progress.pieces_done(), elements: progress.elements() }
    }
}

/// Why a mesh could not be scored.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Failure {
    /// What sort of failure.
    pub kind: FailureKind,
    /// In words.
    pub reason: String,
    /// The format, where it is known.
    pub format: Option<String>,
    /// The line, where it is known.
    pub line: Option<u64>,
    /// The byte, where it is known.
    pub byte: Option<u64>,
}

/// What sort of failure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FailureKind {
    /// The file could not be opened or read.
    Unreadable,
    /// The file system gave an error that may pass.
    IoError,
    /// It is no regular file.
    NotAFile,
    /// It holds no bytes.
    Empty,
    /// No format knows it.
    UnknownFormat,
    /// It is not as its format demands.
    Malformed,
    /// It uses something that is not read.
    Unsupported,
    /// It passes a limit that a format has by itself.
    Limit,
    /// It passes `limits.file_bytes`.
    LimitFileBytes,
    /// It passes `limits.unpacked_bytes`.
    LimitUnpackedBytes,
    /// It passes `limits.unpacked_ratio`.
    LimitUnpackedRatio,
    /// It passes `limits.window_bytes`.
    LimitWindowBytes,
    /// It passes `limits.line_bytes`.
    LimitLineBytes,
    /// It passes `limits.include_depth`.
    LimitIncludeDepth,
    /// It passes `limits.include_count`.
    LimitIncludeCount,
    /// Elements name nodes that it does not define.
    MissingNodes,
    /// The machine ran out of something.
    Resource,
    /// The configuration makes no sense.
    Usage,
    /// It passes `worker.time`.
    Timeout,
    /// It passes `worker.memory`.
    Memory,
    /// The worker ended while it had the mesh.
    WorkerDied,
}

/// What is done after a failure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Then {
    /// Nothing: the same file fails the same way.
    Leave,
    /// Another try, as often as it takes: the machine is at fault.
    Retry,
    /// Other tries, but not for ever.
    RetrySome,
    /// Another try; a file that ends its workers again and again is left alone.
    Quarantine,
}

impl FailureKind {
    /// The name that the log uses.
    pub fn name(self) -> String {
        let name = serde_json::to_value(self).ok();
        name.and_then(|name| name.as_str().map(String::from)).unwrap_or_default()
    }

    /// What is done after it.
    pub fn then(self) -> Then {
        match self {
            FailureKind::Resource => Then::Retry,
            FailureKind::IoError => Then::RetrySome,
            FailureKind::Timeout | FailureKind::Memory | FailureKind::WorkerDied => Then::Quarantine,
            _ => Then::Leave,
        }
    }

    fn of_limit(bound: Bound) -> Self {
        match bound {
            Bound::Fixed => FailureKind::Limit,
            Bound::FileBytes => FailureKind::LimitFileBytes,
            Bound::UnpackedBytes => FailureKind::LimitUnpackedBytes,
            Bound::UnpackedRatio => FailureKind::LimitUnpackedRatio,
            Bound::WindowBytes => FailureKind::LimitWindowBytes,
            Bound::LineBytes => FailureKind::LimitLineBytes,
            Bound::IncludeDepth => FailureKind::LimitIncludeDepth,
            Bound::IncludeCount => FailureKind::LimitIncludeCount,
        }
    }

    fn of_reading(error: &io::Error) -> Self {
        // EIO, ENOMEM, ETIMEDOUT, ESTALE, EREMOTEIO: what servers and disks give now and then.
        match error.raw_os_error() {
            Some(5 | 12 | 110 | 116 | 121) => FailureKind::IoError,
            _ => FailureKind::Unreadable,
        }
    }
}

impl Failure {
    /// A failure that no error of the library stands for.
    pub fn new(kind: FailureKind, reason: impl Into<String>) -> Self {
        Self { kind, reason: reason.into(), format: None, line: None, byte: None }
    }

    /// The worker died; how, in words, with what it said last.
    pub fn of_death(how: String) -> Self {
        // What Rust says before it aborts.
        let memory = how.contains("memory allocation of") && how.contains("failed");
        Self::new(if memory { FailureKind::Memory } else { FailureKind::WorkerDied }, how)
    }

    /// What it means for the exit status.
    pub fn status(&self) -> Status {
        match self.kind {
            FailureKind::Usage => Status::Usage,
            FailureKind::Resource => Status::Resource,
            _ => Status::Unreadable,
        }
    }
}

impl From<&Error> for Failure {
    fn from(error: &Error) -> Self {
        let kind = match error.kind() {
            Kind::NotAFile(_) => FailureKind::NotAFile,
            Kind::Empty => FailureKind::Empty,
            Kind::UnknownFormat(_) => FailureKind::UnknownFormat,
            Kind::Malformed { .. } => FailureKind::Malformed,
            Kind::Unsupported(_) => FailureKind::Unsupported,
            Kind::Limit { bound, .. } => FailureKind::of_limit(*bound),
            Kind::MissingNode { .. } => FailureKind::MissingNodes,
            Kind::Resource { .. } | Kind::Unwritable(_) => FailureKind::Resource,
            Kind::Usage(_) => FailureKind::Usage,
            Kind::Unreadable(cause) => FailureKind::of_reading(cause),
            _ => FailureKind::Unreadable,
        };
        let (line, byte) = match error.place() {
            Some(At::Line(line)) => (Some(line), None),
            Some(At::Byte(byte)) => (None, Some(byte)),
            None => (None, None),
        };
        Self { kind, reason: error.to_string(), format: error.format().map(String::from), line, byte }
    }
}
