//! The exit status: one meaning each, the highest of several wins.

use std::fmt;
use std::io;
use std::process::ExitCode;

use meshgauge::error::Kind;

/// What the program ends with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum Status {
    /// Everything was scored, and nothing failed a threshold. A warning is fine.
    #[default]
    Fine = 0,
    /// Scored, but a threshold failed.
    Failed = 1,
    /// Wrong usage or configuration.
    Usage = 2,
    /// A mesh could not be read.
    Unreadable = 3,
    /// The machine ran out of something.
    Resource = 4,
}

impl Status {
    /// What an error of the library means for the exit status.
    pub fn of(error: &meshgauge::Error) -> Self {
        match error.kind() {
            Kind::Usage(_) => Status::Usage,
            Kind::Resource { .. } | Kind::Unwritable(_) => Status::Resource,
            _ => Status::Unreadable,
        }
    }

    /// What a verdict means for the exit status.
    pub fn of_verdict(verdict: &meshgauge::summary::Verdict) -> Self {
        match verdict.status {
            meshgauge::summary::Status::Fail => Status::Failed,
            meshgauge::summary::Status::Pass | meshgauge::summary::Status::Warn => Status::Fine,
        }
    }

    /// What an error that ended the program means. A reader that has seen enough (`| head`) is no error.
    pub fn of_failure(failure: &anyhow::Error) -> Self {
        for cause in failure.chain() {
            if cause.is::<Usage>() {
                return Status::Usage;
            }
            if let Some(error) = cause.downcast_ref::<meshgauge::Error>() {
                return Status::of(error);
            }
            if is_broken_pipe(cause) {
                return Status::Fine;
            }
        }
        Status::Resource
    }
}

impl From<Status> for ExitCode {
    fn from(status: Status) -> Self {
        ExitCode::from(status as u8)
    }
}

/// Whether the reader of our output went away.
pub fn is_broken_pipe(cause: &(dyn std::error::Error + 'static)) -> bool {
    cause.downcast_ref::<io::Error>().is_some_and(|e| e.kind() == io::ErrorKind::BrokenPipe)
}

/// Wrong usage or configuration, in words for the user.
#[derive(Debug)]
pub struct Usage(pub String);

impl fmt::Display for Usage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Usage {}
