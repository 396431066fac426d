//! What a program did to a folder, out of the output of `strace -f -y -xx`.

use std::collections::HashMap;
use std::ffi::OsString;
use std::fmt;
use std::os::unix::ffi::OsStringExt;
use std::path::{Component, Path, PathBuf};

/// The calls that change a folder, or have it on disk.
pub const CALLS: [&str; 22] = [
    "openat",
    "open",
    "creat",
    "write",
    "writev",
    "pwrite64",
    "pwritev",
    "fsync",
    "fdatasync",
    "sync_file_range",
    "rename",
    "renameat",
    "renameat2",
    "unlink",
    "unlinkat",
    "rmdir",
    "ftruncate",
    "truncate",
    "mkdir",
    "mkdirat",
    "link",
    "linkat",
];

/// One thing that was done. Paths are within the folder; the folder itself is the empty path.
#[derive(Debug, Clone)]
pub enum Step {
    /// A file was opened that may have been made by that, or emptied.
    Open { path: PathBuf, emptied: bool },
    /// A folder was made.
    Folder(PathBuf),
    /// Bytes were written: at their place, or behind what was written before.
    Write { path: PathBuf, at: Option<u64>, bytes: Vec<u8> },
    /// A file got another length.
    Cut { path: PathBuf, length: u64 },
    /// A file, or the names in a folder, are on disk.
    Sync(PathBuf),
    /// Another name.
    Rename { from: PathBuf, to: PathBuf },
    /// A name went.
    Remove(PathBuf),
}

impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Open { path, .. } => write!(f, "opened {}", path.display()),
            Self::Folder(path) => write!(f, "made {}", path.display()),
            Self::Write { path, at, bytes } => {
                write!(f, "wrote {} bytes to {} at {at:?}", bytes.len(), path.display())
            }
            Self::Cut { path, length } => write!(f, "cut {} to {length}", path.display()),
            Self::Sync(path) => write!(f, "synced {}", path.display()),
            Self::Rename { from, to } => write!(f, "renamed {} to {}", from.display(), to.display()),
            Self::Remove(path) => write!(f, "removed {}", path.display()),
        }
    }
}

/// The steps within `folder`, in the order in which they ended.
pub fn steps(trace: &str, folder: &Path) -> Vec<Step> {
    let mut begun: HashMap<&str, String> = HashMap::new();
    let mut steps = Vec::new();
    for line in trace.lines() {
        let Some((process, call)) = line.split_once(' ') else { continue };
        let call = call.trim_start();
        if let Some(head) = call.strip_suffix("<unfinished ...>") {
            begun.insert(process, head.trim_end().to_owned());
        } else if let Some((_, tail)) =
            call.strip_prefix("<... ").and_then(|rest| rest.split_once(" resumed>"))
        {
            let head = begun.remove(process).unwrap_or_default();
            steps.extend(step(&(head + tail), folder));
        } else {
            steps.extend(step(call, folder));
        }
    }
    steps
}

fn step(call: &str, folder: &Path) -> Option<Step> {
    let (name, rest) = call.split_once('(')?;
    let (arguments, result) = rest.rsplit_once(") ")?;
    // What failed did nothing; what has no result was cut off with its process.
    let result = result.trim_start().strip_prefix("= ").filter(|result| !result.starts_with(['-', '?']))?;
    let arguments = split(arguments);
    let argument = |at: usize| arguments.get(at).copied().unwrap_or_default();
    let within = |path: PathBuf| plain(&path).strip_prefix(folder).ok().map(Path::to_owned);
    // A path that is given is relative to the working folder, beside the results.
    let named = |at: usize| within(folder.parent()?.join(text(argument(at))?));
    let open = |at: usize| within(behind(argument(at))?);
    let number = |at: usize| argument(at).trim().parse::<u64>().ok();
    Some(match name {
        "openat" | "open" | "creat" => {
            let flags = argument(if name == "openat" { 2 } else { 1 });
            if !flags.contains("O_CREAT") && !flags.contains("O_TRUNC") && name != "creat" {
                return None;
            }
            Step::Open {
                path: within(behind(result)?)?,
                emptied: flags.contains("O_TRUNC") || name == "creat",
            }
        }
        "write" => Step::Write { path: open(0)?, at: None, bytes: raw(argument(1))? },
        "pwrite64" => Step::Write { path: open(0)?, at: number(3), bytes: raw(argument(1))? },
        "fsync" | "fdatasync" => Step::Sync(open(0)?),
        "rename" => Step::Rename { from: named(0)?, to: named(1)? },
        "renameat" | "renameat2" => Step::Rename { from: named(1)?, to: named(3)? },
        "unlink" | "rmdir" => Step::Remove(named(0)?),
        "unlinkat" => Step::Remove(named(1)?),
        "mkdir" => Step::Folder(named(0)?),
        "mkdirat" => Step::Folder(named(1)?),
        "ftruncate" => Step::Cut { path: open(0)?, length: number(1)? },
        "truncate" => Step::Cut { path: named(0)?, length: number(1)? },
        // A call that is not understood would be a hole in what is known.
        _ => match open(0).or_else(|| named(0)).or_else(|| named(1)) {
            Some(path) => panic!("{name} of {} is not known to this test", path.display()),
            None => return None,
        },
    })
}

/// The arguments of a call. All text is in hexadecimal, so that no comma or bracket of it is met.
fn split(arguments: &str) -> Vec<&str> {
    arguments.split(", ").collect()
}

/// The path in `7<\x2f\x74>`.
fn behind(argument: &str) -> Option<PathBuf> {
    let (_, path) = argument.split_once('<')?;
    let (path, _) = path.split_once('>')?;
    Some(OsString::from_vec(hexadecimal(path)?).into())
}

/// The path in `"\x2f\x74"`.
fn text(argument: &str) -> Option<PathBuf> {
    Some(OsString::from_vec(raw(argument)?).into())
}

/// The bytes in `"\x2f\x74"`, all of them.
fn raw(argument: &str) -> Option<Vec<u8>> {
    assert!(!argument.ends_with("..."), "strace cut what was written");
    hexadecimal(argument.strip_prefix('"')?.strip_suffix('"')?)
}

fn hexadecimal(text: &str) -> Option<Vec<u8>> {
    text.split("\\x").skip(1).map(|digits| u8::from_str_radix(digits.get(..2)?, 16).ok()).collect()
}

/// Without `.` and `..`.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir => drop(plain.pop()),
            part => plain.push(part),
        }
    }
    plain
}
