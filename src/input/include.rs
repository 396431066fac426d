//! The files that a mesh file names. They are opened beneath the main file's folder only: neither an absolute name, nor
//! `..`, nor a symbolic link leads out of it.

use std::fs::File;
use std::io;
use std::os::fd::{AsFd, OwnedFd};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use rustix::fs::{Mode, OFlags};
use rustix::io::Errno;

use super::regular::not_regular;
use super::{Input, Limits, Source};
use crate::error::{Bound, Error, Kind, Result};

/// `O_NONBLOCK`, for a FIFO would wait for a writer.
const FLAGS: OFlags = OFlags::RDONLY.union(OFlags::CLOEXEC).union(OFlags::NONBLOCK).union(OFlags::NOCTTY);

/// Opens the files that one mesh file names, and holds them to the limits.
#[derive(Debug)]
pub struct Siblings<'i> {
    input: &'i Input,
    folder: Option<OwnedFd>,
    opened: usize,
}

/// A file of a mesh: the main one, or one that it names, directly or through others.
#[derive(Debug, Clone)]
pub struct Sibling {
    /// The bytes.
    pub source: Arc<Source>,
    /// The file's folder, as seen from the main file's.
    folder: PathBuf,
    /// Device and inode of the files that lead here, the main one first, this one last.
    chain: Vec<(u64, u64)>,
}

impl<'i> Siblings<'i> {
    /// Nothing opened yet.
    pub fn new(input: &'i Input) -> Self {
        Self { input, folder: None, opened: 0 }
    }

    /// The limits in force.
    pub fn limits(&self) -> &'i Limits {
        &self.input.limits
    }

    /// The main file.
    pub fn main(&self) -> Sibling {
        // A main file that is gone by now cannot be included either: any identity does.
        let identity = std::fs::metadata(self.input.source.path()).map_or((0, 0), |m| (m.dev(), m.ino()));
        Sibling { source: Arc::clone(&self.input.source), folder: PathBuf::new(), chain: vec![identity] }
    }

    /// Opens the file that `from` calls `name`: beside `from`, or else beside the main file. Errors do not name the
    /// place of the reference; the caller knows it.
    pub fn open(&mut self, from: &Sibling, name: &Path) -> Result<Sibling> {
        let limits = &self.input.limits;
        if self.opened >= limits.include_count {
            return Err(Error::limit_of(
                Bound::IncludeCount,
                "number of included files",
                limits.include_count,
            ));
        }
        if from.chain.len() > limits.include_depth {
            return Err(Error::limit_of(
                Bound::IncludeDepth,
                "nesting of included files",
                limits.include_depth,
            ));
        }
        self.opened += 1;
        let Some(root) = &self.input.folder else {
            return Err(Error::unsupported(
                "a mesh that comes as a stream cannot include files: it has no folder",
            ));
        };
        let mut path = from.folder.join(name);
        let mut found = self.beneath(root, &path);
        if found.as_ref().is_err_and(|e| *e == Errno::NOENT) && path != name {
            path = name.to_owned();
            found = self.beneath(root, &path);
        }
        let file = File::from(found.map_err(|e| refusal(e.into(), name))?);
        let metadata = file.metadata().map_err(|e| refusal(e, name))?;
        if let Some(other) = not_regular(metadata.file_type()) {
            return Err(Error::new(Kind::NotAFile(other)));
        }
        let identity = (metadata.dev(), metadata.ino());
        if from.chain.contains(&identity) {
            let expected = "an include that does not lead back to itself";
            return Err(Error::malformed(expected, format!("\"{}\"", name.display())));
        }
        let mut chain = from.chain.clone();
        chain.push(identity);
        let full = root.join(&path);
        let source = match metadata.len() {
            // No mesh, but a part of one may well be empty.
            0 => Arc::new(Source::new(&full, &file)?),
            _ => Input::open_file(&full, &file, limits, &self.input.scratch)?.source,
        };
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        Ok(Sibling { source, folder, chain })
    }

    fn beneath(&mut self, root: &Path, path: &Path) -> rustix::io::Result<OwnedFd> {
        let folder = match self.folder.take() {
            Some(folder) => folder,
            None => rustix::fs::open(root, FLAGS | OFlags::DIRECTORY, Mode::empty())?,
        };
        let found = open_beneath(&folder, root, path);
        self.folder = Some(folder);
        found
    }
}

/// Opens `path` beneath `folder`, whose name is `root`.
fn open_beneath(folder: &impl AsFd, root: &Path, path: &Path) -> rustix::io::Result<OwnedFd> {
    #[cfg(target_os = "linux")]
    {
        use rustix::fs::{ResolveFlags, openat2};
        let resolve = ResolveFlags::BENEATH | ResolveFlags::NO_MAGICLINKS;
        // AGAIN: something was renamed meanwhile. NOSYS, PERM: an old kernel, or a container that hides the call.
        for _ in 0..8 {
            match openat2(folder, path, FLAGS, Mode::empty(), resolve) {
                Err(Errno::AGAIN) => {}
                Err(Errno::NOSYS | Errno::PERM) => break,
                done => return done,
            }
        }
    }
    open_checked(folder, root, path)
}

/// The same without the system's help: the name is resolved, compared, and opened as resolved.
fn open_checked(folder: &impl AsFd, root: &Path, path: &Path) -> rustix::io::Result<OwnedFd> {
    let errno = |e: io::Error| Errno::from_io_error(&e).unwrap_or(Errno::IO);
    let root = root.canonicalize().map_err(errno)?;
    let real = root.join(path).canonicalize().map_err(errno)?;
    match real.strip_prefix(&root) {
        Ok(inside) if path.is_relative() => {
            rustix::fs::openat(folder, inside, FLAGS | OFlags::NOFOLLOW, Mode::empty())
        }
        _ => Err(Errno::XDEV),
    }
}

/// The error of a file that could not be opened.
fn refusal(cause: io::Error, name: &Path) -> Error {
    if matches!(Errno::from_io_error(&cause), Some(Errno::XDEV | Errno::LOOP)) {
        let expected = "the name of a file beneath the mesh's own folder";
        return Error::malformed(expected, format!("\"{}\"", name.display()));
    }
    let text = format!("included file \"{}\": {cause}", name.display());
    Error::new(Kind::Unreadable(io::Error::new(cause.kind(), text)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::Scratch;
    use std::fs;
    use std::os::unix::fs::symlink;

    struct Folder(tempfile::TempDir);

    impl Folder {
        fn new() -> Self {
            let folder = tempfile::tempdir().expect("a scratch folder");
            fs::create_dir_all(folder.path().join("in/sub")).expect("a folder");
            for (name, text) in
                [("out.inp", "out"), ("in/main.inp", "main"), ("in/a.inp", "a"), ("in/sub/b.inp", "b")]
            {
                fs::write(folder.path().join(name), text).expect("a file");
            }
            let packed = zstd::encode_all(&b"unpacked"[..], 0).expect("packed");
            fs::write(folder.path().join("in/packed.inp.zst"), packed).expect("a file");
            fs::write(folder.path().join("in/empty.inp"), "").expect("a file");
            symlink("../out.inp", folder.path().join("in/leak.inp")).expect("a link");
            symlink("sub/b.inp", folder.path().join("in/kept.inp")).expect("a link");
            Self(folder)
        }

        fn input(&self) -> Input {
            let scratch = Scratch::new(self.0.path(), 1 << 20);
            Input::open(&self.0.path().join("in/main.inp"), &Limits::default(), &scratch).expect("a file")
        }
    }

    #[test]
    fn names_are_found_beside_the_includer_and_beside_the_main_file() {
        let folder = Folder::new();
        let input = folder.input();
        let mut siblings = Siblings::new(&input);
        let main = siblings.main();
        let b = siblings.open(&main, Path::new("sub/b.inp")).expect("beside the main file");
        assert_eq!(b.source.peek(0..9), b"b");
        let a = siblings.open(&b, Path::new("a.inp")).expect("beside the main file");
        assert_eq!(a.source.peek(0..9), b"a");
        assert!(siblings.open(&b, Path::new("../a.inp")).is_ok(), "still beneath");
        assert!(siblings.open(&main, Path::new("kept.inp")).is_ok(), "a link that stays inside");
    }

    #[test]
    fn nothing_outside_the_folder_is_opened() {
        let folder = Folder::new();
        let input = folder.input();
        let mut siblings = Siblings::new(&input);
        let main = siblings.main();
        for name in ["../out.inp", "leak.inp", "/etc/passwd", "sub/../../out.inp"] {
            let error = siblings.open(&main, Path::new(name)).expect_err(name).to_string();
            assert!(error.contains("beneath the mesh's own folder"), "{name}: {error}");
            let root = folder.0.path().join("in");
            let fd = rustix::fs::open(&root, FLAGS | OFlags::DIRECTORY, Mode::empty()).expect("the folder");
            assert!(open_checked(&fd, &root, Path::new(name)).is_err(), "{name} without openat2");
        }
        let root = folder.0.path().join("in");
        let fd = rustix::fs::open(&root, FLAGS | OFlags::DIRECTORY, Mode::empty()).expect("the folder");
        for name in ["a.inp", "kept.inp", "sub/../a.inp"] {
            assert!(open_checked(&fd, &root, Path::new(name)).is_ok(), "{name} without openat2");
        }
    }

    #[test]
    fn directories_fifos_and_cycles_are_errors() {
        let folder = Folder::new();
        let fifo = folder.0.path().join("in/fifo");
        rustix::fs::mknodat(rustix::fs::CWD, &fifo, rustix::fs::FileType::Fifo, Mode::RUSR | Mode::WUSR, 0)
            .expect("a FIFO");
        let input = folder.input();
        let mut siblings = Siblings::new(&input);
        let main = siblings.main();
        for (name, text) in [
            ("sub", "found a directory"),
            ("fifo", "found a FIFO"),
            ("main.inp", "lead back to itself"),
            ("none.inp", "none.inp"),
        ] {
            let error = siblings.open(&main, Path::new(name)).expect_err(name).to_string();
            assert!(error.contains(text), "{name}: {error}");
        }
    }

    #[test]
    fn included_files_may_be_packed_or_empty() {
        let folder = Folder::new();
        let input = folder.input();
        let mut siblings = Siblings::new(&input);
        let main = siblings.main();
        let packed = siblings.open(&main, Path::new("packed.inp.zst")).expect("unpacked");
        assert_eq!(packed.source.peek(0..99), b"unpacked");
        assert!(siblings.open(&main, Path::new("empty.inp")).expect("empty").source.is_empty());
    }

    #[test]
    fn a_stream_has_no_folder_to_include_from() {
        let scratch = Scratch::new(&std::env::temp_dir(), 1 << 20);
        let input =
            Input::from_reader(Path::new("-"), &b"main"[..], &Limits::default(), &scratch).expect("read");
        let mut siblings = Siblings::new(&input);
        let main = siblings.main();
        let error = siblings.open(&main, Path::new("Cargo.toml")).expect_err("no folder").to_string();
        assert!(error.contains("comes as a stream"), "{error}");
    }

    #[test]
    fn number_and_nesting_have_limits() {
        let folder = Folder::new();
        let mut input = folder.input();
        input.limits.include_depth = 1;
        input.limits.include_count = 3;
        let mut siblings = Siblings::new(&input);
        let main = siblings.main();
        let a = siblings.open(&main, Path::new("a.inp")).expect("depth 1");
        let error = siblings.open(&a, Path::new("sub/b.inp")).expect_err("depth 2").to_string();
        assert!(error.contains("nesting of included files is over the limit of 1"), "{error}");
        siblings.open(&main, Path::new("a.inp")).expect("again is no cycle");
        siblings.open(&main, Path::new("a.inp")).expect("the third");
        let error = siblings.open(&main, Path::new("a.inp")).expect_err("the fourth").to_string();
        assert!(error.contains("number of included files is over the limit of 3"), "{error}");
    }
}
