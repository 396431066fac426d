//! What stands under a name: looked at, not opened, until it is known to be a regular file.

use std::fs::{self, Metadata, OpenOptions};
use std::ops::ControlFlow;
use std::os::unix::fs::{FileTypeExt, OpenOptionsExt};
use std::path::{Path, PathBuf};

use meshgauge::formats;
use rustix::fs::OFlags;

use super::{Found, Sight, Walk, place};
use crate::config::Symlinks;
use crate::identity::Identity;

impl Walk {
    /// Tells what stands under each of the names now, `None` where nothing does, until told to stop. A look that is `fresh`
    /// opens the file, because network file systems ask the server then, and else answer from memory.
    pub fn look_at(
        &self,
        paths: Vec<PathBuf>,
        fresh: bool,
        tell: &mut dyn FnMut(PathBuf, Option<Found>) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        // The way to a folder is gone once for all of its files that stand together.
        let mut way: Option<(PathBuf, bool)> = None;
        for path in paths {
            let folder = path.parent().unwrap_or(Path::new(""));
            let is_sound = match &way {
                Some((known, is_sound)) if known == folder => *is_sound,
                _ => way.insert((folder.to_owned(), self.is_reached_without_links(folder))).1,
            };
            let found = if is_sound { self.find(&path, fresh) } else { None };
            tell(path, found)?;
        }
        ControlFlow::Continue(())
    }

    /// What stands under one name now, as [`Walk::look_at`] tells it.
    pub fn look(&self, path: &Path, fresh: bool) -> Option<Found> {
        let is_sound = self.is_reached_without_links(path.parent().unwrap_or(Path::new("")));
        is_sound.then(|| self.find(path, fresh)).flatten()
    }

    fn find(&self, path: &Path, fresh: bool) -> Option<Found> {
        if fresh {
            // A FIFO must not hold us up.
            let flags = (OFlags::NONBLOCK | OFlags::NOFOLLOW | OFlags::NOCTTY).bits().cast_signed();
            let file = OpenOptions::new().read(true).custom_flags(flags).open(self.root.join(path));
            if let Ok(data) = file.and_then(|file| file.metadata())
                && data.is_file()
            {
                return Some(Found::File(Identity::from(&data)));
            }
        }
        let data = fs::symlink_metadata(self.root.join(path)).ok()?;
        let mesh = data.is_dir().then(|| self.mesh_of_folder(path)).flatten();
        Some(mesh.map_or_else(|| self.found(path, &data), |(found, _)| found))
    }

    /// Whether the folders on the way to a folder are folders still: a scan does not follow links to folders, and one
    /// that took the place of a folder since the last scan must not lead us out.
    fn is_reached_without_links(&self, folder: &Path) -> bool {
        let here = |path: &Path| fs::canonicalize(path);
        folder.as_os_str().is_empty()
            || here(&self.root)
                .is_ok_and(|root| here(&self.root.join(folder)).is_ok_and(|way| way == root.join(folder)))
    }

    /// What the mesh is that a folder holds, and its files, if the folder is one mesh.
    pub(super) fn mesh_of_folder(&self, path: &Path) -> Option<(Found, Vec<PathBuf>)> {
        let path = self.root.join(path);
        // Where it cannot be read the reader will say why.
        let files = formats::files_of(&path, true)?.unwrap_or_default();
        let leads_out = |file: &PathBuf| self.symlinks != Symlinks::All && !self.is_inside(file);
        if files.iter().any(|file| file.exists() && leads_out(file)) {
            return Some((Found::Other("a mesh with files outside of the folder"), files));
        }
        Identity::of(&path).ok().map(|identity| (Found::File(identity), files))
    }

    /// Whether a file belongs to a mesh that another file stands for.
    pub(super) fn is_part(&self, path: &Path) -> bool {
        let path = self.root.join(path);
        let files = formats::files_of(&path, false).and_then(Result::ok);
        files.is_some_and(|files| files.first().and_then(|main| main.file_name()) != path.file_name())
    }

    /// Tells of the folder that the files of a mesh lie in: its changes are worth a look.
    pub(super) fn follow_mesh(
        &self,
        files: &[PathBuf],
        tell: &mut dyn FnMut(Sight) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let folder = files.first().and_then(|file| file.parent());
        if let Some(folder) = folder
            && let (Ok(inner), Ok(data)) = (folder.strip_prefix(&self.root), fs::metadata(folder))
        {
            tell(Sight::Folder(inner.to_owned(), place(&data)))?;
        }
        ControlFlow::Continue(())
    }

    /// Whether a file lies in the folder that is walked through, wherever symbolic links lead.
    fn is_inside(&self, file: &Path) -> bool {
        let root = fs::canonicalize(&self.root);
        root.and_then(|root| Ok(fs::canonicalize(file)?.starts_with(root))).unwrap_or(false)
    }

    pub(super) fn found(&self, path: &Path, data: &Metadata) -> Found {
        let kind = data.file_type();
        if kind.is_file() {
            Found::File(data.into())
        } else if kind.is_symlink() {
            self.follow(&self.root.join(path))
        } else if kind.is_fifo() {
            Found::Other("a FIFO")
        } else if kind.is_socket() {
            Found::Other("a socket")
        } else if kind.is_dir() {
            Found::Other("a folder")
        } else {
            Found::Other("a device")
        }
    }

    fn follow(&self, link: &Path) -> Found {
        if self.symlinks == Symlinks::None {
            return Found::Other("a symbolic link");
        }
        let Ok(data) = fs::metadata(link) else {
            return Found::Other("a symbolic link that leads nowhere");
        };
        if !data.is_file() {
            Found::Other("a symbolic link to something other than a file")
        } else if self.symlinks == Symlinks::Inside && !self.is_inside(link) {
            Found::Other("a symbolic link that leads out of the folder")
        } else {
            Found::File(Identity::from(&data))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Watch;

    #[test]
    fn a_folder_that_became_a_link_is_not_followed() {
        let (folder, outside) =
            (tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("another"));
        fs::create_dir(folder.path().join("sub")).expect("a folder");
        for place in [folder.path().join("sub"), outside.path().to_owned()] {
            fs::write(place.join("a.msh"), "x").expect("written");
        }
        let walk = Walk::new(folder.path(), &Watch::default());
        let look = || {
            let mut found = Vec::new();
            let _ = walk.look_at(vec!["sub/a.msh".into(), "sub/b.msh".into()], false, &mut |_, seen| {
                found.push(seen.is_some());
                ControlFlow::Continue(())
            });
            found
        };
        assert_eq!(look(), [true, false]);
        fs::remove_dir_all(folder.path().join("sub")).expect("removed");
        std::os::unix::fs::symlink(outside.path(), folder.path().join("sub")).expect("linked");
        assert_eq!(look(), [false, false]);
    }

    #[test]
    fn a_link_out_of_the_folder_is_not_followed_by_default() {
        let outside = tempfile::NamedTempFile::new().expect("a file");
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("in.msh"), "x").expect("written");
        std::os::unix::fs::symlink(outside.path(), folder.path().join("out.msh")).expect("linked");
        std::os::unix::fs::symlink("in.msh", folder.path().join("to-in.msh")).expect("linked");
        std::os::unix::fs::symlink(".", folder.path().join("loop")).expect("linked");
        let scan = Walk::new(folder.path(), &Watch::default()).scan();
        let regular: Vec<_> = scan.files.iter().map(|(_, f)| matches!(f, Found::File(_))).collect();
        assert_eq!(regular, [true, false, false, true], "in, loop, out, to-in");
    }
}
