//! Opening regular files, and nothing else: a FIFO must not hang the reader, nor a device be touched.

use std::fs::{File, FileType, Metadata, OpenOptions};
use std::os::unix::fs::{FileTypeExt, OpenOptionsExt};
use std::path::Path;

use rustix::fs::OFlags;

use crate::error::{Error, Kind, Result};

/// Opens the regular file at `path` for reading; symbolic links are followed.
pub(super) fn open(path: &Path) -> Result<File> {
    let unreadable = |e| Error::unreadable(path, e);
    // Looked at twice: before, as opening a device may do something to it; after, as the name may stand for another
    // file by then, which is also why the open itself must not wait for a FIFO's writer.
    check(path, &std::fs::metadata(path).map_err(unreadable)?)?;
    let flags = OFlags::NONBLOCK | OFlags::NOCTTY;
    let file =
        OpenOptions::new().read(true).custom_flags(flags.bits() as i32).open(path).map_err(unreadable)?;
    check(path, &file.metadata().map_err(unreadable)?)?;
    Ok(file)
}

fn check(path: &Path, metadata: &Metadata) -> Result<()> {
    match not_regular(metadata.file_type()) {
        Some(found) => Err(Error::new(Kind::NotAFile(found)).in_file(path)),
        None => Ok(()),
    }
}

/// What stands there, if it is no regular file.
pub(super) fn not_regular(kind: FileType) -> Option<&'static str> {
    match kind {
        _ if kind.is_file() => None,
        _ if kind.is_dir() => Some("a directory"),
        _ if kind.is_fifo() => Some("a FIFO"),
        _ if kind.is_socket() => Some("a socket"),
        _ if kind.is_char_device() => Some("a character device"),
        _ if kind.is_block_device() => Some("a block device"),
        _ => Some("a special file"),
    }
}
