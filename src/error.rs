//! One error type for the whole library: what went wrong, and the place in the file where it did.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// The library's result.
pub type Result<T> = std::result::Result<T, Error>;

/// What went wrong, and where.
#[derive(Debug)]
pub struct Error(Box<Inner>);

#[derive(Debug)]
struct Inner {
    kind: Kind,
    path: Option<PathBuf>,
    format: Option<&'static str>,
    at: Option<At>,
}

/// A place inside a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum At {
    /// A line of a text file, from 1.
    Line(u64),
    /// A byte of a binary file, from 0.
    Byte(u64),
}

/// Which limit was passed: one of [`crate::input::Limits`], or one that stands in the code.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Bound {
    /// A limit that nobody can set.
    #[default]
    Fixed,
    /// `file_bytes`
    FileBytes,
    /// `unpacked_bytes`
    UnpackedBytes,
    /// `unpacked_ratio`
    UnpackedRatio,
    /// `window_bytes`
    WindowBytes,
    /// `line_bytes`; also what stands in its place where a format knows no lines: the length of one word
    LineBytes,
    /// `include_depth`
    IncludeDepth,
    /// `include_count`
    IncludeCount,
}

/// What went wrong.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Kind {
    /// The file could not be opened, read or mapped.
    #[error("{0}")]
    Unreadable(#[source] io::Error),
    /// A file could not be made or written.
    #[error("could not be written: {0}")]
    Unwritable(#[source] io::Error),
    /// Something other than a regular file stands under the name.
    #[error("expected a regular file, found {0}")]
    NotAFile(&'static str),
    /// The file holds no bytes.
    #[error("expected a mesh, found an empty file")]
    Empty,
    /// No format knows the content. The text lists what was looked for.
    #[error("{0}")]
    UnknownFormat(String),
    /// The bytes at the place are not what the format allows.
    #[error("expected {expected}, found {found}")]
    Malformed {
        /// What the format asks for.
        expected: String,
        /// An excerpt of what stood there.
        found: String,
    },
    /// The file is sound as far as it goes, but uses something that is not read; by name.
    #[error("{0}")]
    Unsupported(String),
    /// A limit that guards the machine was passed.
    #[error("{what} is over the limit of {limit}")]
    Limit {
        /// What was counted.
        what: String,
        /// The limit, with its unit.
        limit: String,
        /// Which one.
        bound: Bound,
    },
    /// An element names a node that the file does not define.
    #[error("element {element} names node {node}, which the file does not define")]
    MissingNode {
        /// The element's own number.
        element: u64,
        /// The node's number as it stands in the file.
        node: u64,
    },
    /// The machine ran out of something: scratch space, memory budget.
    #[error("out of {what}: {cause}")]
    Resource {
        /// What ran out.
        what: &'static str,
        /// The cause, as the system gave it.
        cause: io::Error,
    },
    /// The caller asked for something that does not exist or makes no sense.
    #[error("{0}")]
    Usage(String),
}

impl Error {
    /// An error of the given kind, without a place yet.
    pub fn new(kind: Kind) -> Self {
        Self(Box::new(Inner { kind, path: None, format: None, at: None }))
    }

    /// The file at `path` could not be read.
    pub fn unreadable(path: &Path, cause: io::Error) -> Self {
        Self::new(Kind::Unreadable(cause)).in_file(path)
    }

    /// Bytes that the format does not allow.
    pub fn malformed(expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self::new(Kind::Malformed { expected: expected.into(), found: found.into() })
    }

    /// A part of the format that is not read, by name.
    pub fn unsupported(what: impl Into<String>) -> Self {
        Self::new(Kind::Unsupported(what.into()))
    }

    /// A limit was passed that nobody can set.
    pub fn limit(what: impl Into<String>, limit: impl fmt::Display) -> Self {
        Self::limit_of(Bound::Fixed, what, limit)
    }

    /// A limit was passed.
    pub fn limit_of(bound: Bound, what: impl Into<String>, limit: impl fmt::Display) -> Self {
        Self::new(Kind::Limit { what: what.into(), limit: limit.to_string(), bound })
    }

    /// A resource of the machine ran out.
    pub fn resource(what: &'static str, cause: io::Error) -> Self {
        Self::new(Kind::Resource { what, cause })
    }

    /// The caller's request makes no sense.
    pub fn usage(what: impl Into<String>) -> Self {
        Self::new(Kind::Usage(what.into()))
    }

    /// Adds the file, unless one is known already.
    pub fn in_file(mut self, path: &Path) -> Self {
        self.0.path.get_or_insert_with(|| path.to_owned());
        self
    }

    /// Adds the format, unless one is known already.
    pub fn in_format(mut self, format: &'static str) -> Self {
        self.0.format.get_or_insert(format);
        self
    }

    /// Adds the place in the file, unless one is known already.
    pub fn at(mut self, at: At) -> Self {
        self.0.at.get_or_insert(at);
        self
    }

    /// What went wrong.
    pub fn kind(&self) -> &Kind {
        &self.0.kind
    }

    /// The file, where one is known.
    pub fn path(&self) -> Option<&Path> {
        self.0.path.as_deref()
    }

    /// The format's name, where one is known.
    pub fn format(&self) -> Option<&'static str> {
        self.0.format
    }

    /// The place in the file, where one is known.
    pub fn place(&self) -> Option<At> {
        self.0.at
    }

    /// Whether the machine, not the mesh, is at fault: another try later may succeed.
    pub fn is_resource(&self) -> bool {
        matches!(self.0.kind, Kind::Resource { .. })
    }

    /// Whether the caller, not the mesh, is at fault.
    pub fn is_usage(&self) -> bool {
        matches!(self.0.kind, Kind::Usage(_))
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Inner { kind, path, format, at } = &*self.0;
        if let Some(path) = path {
            write!(f, "{}: ", path.display())?;
        }
        if let Some(format) = format {
            write!(f, "{format}: ")?;
        }
        match at {
            Some(At::Line(line)) => write!(f, "line {line}: ")?,
            Some(At::Byte(byte)) => write!(f, "byte {byte}: ")?,
            None => {}
        }
        write!(f, "{kind}")
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        self.0.kind.source()
    }
}

/// At most 40 bytes of what stood at a place, made safe to print on one line.
pub fn excerpt(bytes: &[u8]) -> String {
    if bytes.is_empty() {
        return "the end of the file".into();
    }
    let line = bytes.split(|&b| b == b'\n').next().unwrap_or_default();
    let line = line.strip_suffix(b"\r").unwrap_or(line);
    if line.is_empty() {
        return "an empty line".into();
    }
    let cut = &line[..line.len().min(40)];
    let more = if line.len() > 40 { "..." } else { "" };
    format!("\"{}{more}\"", cut.escape_ascii())
}
