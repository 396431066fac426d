//! What the daemon and its workers say to each other: a JSON line each way.

use meshgauge::error::{At, Kind};
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
    /// It passes a limit.
    Limit,
    /// Elements name nodes that it does not define.
    MissingNodes,
    /// The machine ran out of something.
    Resource,
    /// The configuration makes no sense.
    Usage,
    /// It took too long.
    Timeout,
    /// The worker ended while it had the mesh.
    WorkerDied,
}

impl FailureKind {
    /// The name that the log uses.
    pub fn name(self) -> String {
        let name = serde_json::to_value(self).ok();
        name.and_then(|name| name.as_str().map(String::from)).unwrap_or_default()
    }

    /// Whether the machine is at fault, so that another try may succeed.
    pub fn is_resource(self) -> bool {
        self == FailureKind::Resource
    }
}

impl Failure {
    /// A failure that no error of the library stands for.
    pub fn new(kind: FailureKind, reason: impl Into<String>) -> Self {
        Self { kind, reason: reason.into(), format: None, line: None, byte: None }
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
            Kind::Limit { .. } => FailureKind::Limit,
            Kind::MissingNode { .. } => FailureKind::MissingNodes,
            Kind::Resource { .. } | Kind::Unwritable(_) => FailureKind::Resource,
            Kind::Usage(_) => FailureKind::Usage,
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
