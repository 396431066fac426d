//! Puts a file where readers look, so that they see the old one or the new one whole, even after a power loss.

use std::ffi::OsStr;
use std::fs::{self, File, Permissions};
use std::io::{self, Write};
use std::os::unix::fs::PermissionsExt;
use std::path::Path;

use tempfile::NamedTempFile;

/// How the names of files that are not yet published begin and end.
const UNFINISHED: (&str, &str) = (".meshgauge-", ".tmp");

/// Replaces `path` for readers, without waiting for the disk: for what is of no worth after a crash.
pub fn replace(path: &Path, content: impl AsRef<[u8]>) -> io::Result<()> {
    unfinished(path, content.as_ref())?.persist(path).map_err(|e| e.error)?;
    Ok(())
}

/// Writes `content` to `path`: temporary file in the same folder, fsync, rename, fsync of the folder.
pub fn publish(path: &Path, content: impl AsRef<[u8]>) -> io::Result<()> {
    let file = unfinished(path, content.as_ref())?;
    file.as_file().sync_all()?;
    file.persist(path).map_err(|e| e.error)?;
    sync_folder(folder_of(path))
}

/// A temporary file beside `path` that holds this.
fn unfinished(path: &Path, content: &[u8]) -> io::Result<NamedTempFile> {
    let folder = folder_of(path);
    make_folder(folder)?;
    let mut file = tempfile::Builder::new()
        .prefix(UNFINISHED.0)
        .suffix(UNFINISHED.1)
        .permissions(Permissions::from_mode(0o666))
        .tempfile_in(folder)?;
    file.write_all(content)?;
    Ok(file)
}

/// Writes so many bytes to a file in the folder, has them on disk, and takes them away again.
pub fn try_writing(folder: &Path, bytes: usize) -> io::Result<()> {
    let mut file = tempfile::Builder::new().prefix(UNFINISHED.0).suffix(UNFINISHED.1).tempfile_in(folder)?;
    // Zeros might be taken for a hole.
    file.write_all(&vec![b'x'; bytes])?;
    file.as_file().sync_all()
}

/// Gives a published file another name in the same folder.
pub fn rename(from: &Path, to: &Path) -> io::Result<()> {
    fs::rename(from, to)?;
    sync_folder(folder_of(to))
}

/// Removes what a killed process left unfinished in the folder.
pub fn sweep(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        if is_unfinished(&entry.file_name())
            && let Err(error) = fs::remove_file(entry.path())
        {
            tracing::warn!("{}: {error}", entry.path().display());
        }
    }
}

fn is_unfinished(name: &OsStr) -> bool {
    name.to_str().is_some_and(|name| name.starts_with(UNFINISHED.0) && name.ends_with(UNFINISHED.1))
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Makes a folder, and those above it that are missing, so that its name is there after a power loss.
pub fn make_folder(folder: &Path) -> io::Result<()> {
    if folder.is_dir() {
        return Ok(());
    }
    let made = match fs::create_dir(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            make_folder(folder_of(folder))?;
            fs::create_dir(folder)
        }
        made => made,
    };
    match made {
        // Another process was quicker.
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists && folder.is_dir() => {}
        made => made?,
    }
    sync_folder(folder_of(folder))
}

/// Has the names in a folder on disk.
pub fn sync_folder(folder: &Path) -> io::Result<()> {
    File::open(folder)?.sync_all()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_made_with_those_above_it_and_a_file_is_none() {
        let folder = tempfile::tempdir().expect("a folder");
        let deep = folder.path().join("a/b/c");
        for _ in 0..2 {
            make_folder(&deep).expect("made, or there");
        }
        fs::write(deep.join("file"), "").expect("written");
        let error = make_folder(&deep.join("file")).expect_err("a file");
        assert_eq!(error.kind(), io::ErrorKind::AlreadyExists);
        assert!(make_folder(&deep.join("file/below")).is_err());
    }

    #[test]
    fn a_published_file_replaces_the_old_one_and_leaves_nothing_beside() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("sub/pit.summary.json");
        publish(&path, "old").expect("published");
        publish(&path, "new").expect("published again");
        assert_eq!(fs::metadata(&path).map(|data| data.len()).ok(), Some(3));
        assert_eq!(fs::read_dir(path.parent().expect("sub")).expect("sub").count(), 1);
    }
}
