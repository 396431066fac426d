//! Where the bytes of a generated mesh go: whole and under its name, or not at all.

use std::fs::{self, File, Permissions};
use std::io::{self, Write};
use std::os::unix::fs::PermissionsExt;
use std::path::Path;

use flate2::write::GzEncoder;

use super::{Counts, Encoding, write_error, writer_for};
use crate::error::Result;
use crate::generate::Problem;

/// A compression of the whole file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Compression {
    None,
    Gzip,
    Zstd,
}

/// The name without the extension of a compression, and which that is.
pub(super) fn split_compression(path: &Path) -> (&Path, Compression) {
    let compression = match path.extension().and_then(|e| e.to_str()) {
        Some("gz") => Compression::Gzip,
        Some("zst") => Compression::Zstd,
        _ => return (path, Compression::None),
    };
    (path.file_stem().map_or(path, Path::new), compression)
}

/// Writes the problem's mesh to the file at `path`, in the format and the compression of its extensions.
///
/// The bytes go to a temporary file beside it that takes its name when it is complete: nobody sees half a mesh. Where
/// something other than a file stands under the name (a pipe, a terminal) they go straight to it. A standard output that
/// has no name is written by [`Writer::write`](super::Writer::write).
pub fn write_file(problem: &Problem, encoding: Encoding, path: &Path) -> Result<Counts> {
    let writer = writer_for(path)?;
    // A usage error must not cost the file that stands there.
    let encoding = writer.encoding(encoding)?;
    let (_, compression) = split_compression(path);
    let write = |file: &mut File| compressed(compression, file, |out| writer.stream(problem, encoding, out));
    place(path, write).map_err(|cause| write_error(cause).in_file(path))?;
    Ok(Counts { nodes: problem.mesh().nodes(), elements: problem.mesh().elements() })
}

/// Has `write` write through the compression to `file`.
fn compressed(
    compression: Compression,
    file: &mut File,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    match compression {
        Compression::None => write(file),
        Compression::Gzip => {
            let mut encoder = GzEncoder::new(file, flate2::Compression::default());
            write(&mut encoder)?;
            encoder.finish().map(drop)
        }
        Compression::Zstd => {
            let mut encoder = zstd::Encoder::new(file, zstd::DEFAULT_COMPRESSION_LEVEL)?;
            write(&mut encoder)?;
            encoder.finish().map(drop)
        }
    }
}

/// Has `write` fill the file at `path`, which is there whole or not at all.
fn place(path: &Path, write: impl FnOnce(&mut File) -> io::Result<()>) -> io::Result<()> {
    // Through a link to the file itself, so that renaming does not replace the link.
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    if fs::metadata(&target).is_ok_and(|found| !found.is_file()) {
        return write(&mut File::options().write(true).open(&target)?);
    }
    let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut file = tempfile::Builder::new()
        .prefix(".")
        .suffix(".tmp")
        // Those that a new file has, less the umask: the default is for the owner's eyes alone.
        .permissions(Permissions::from_mode(0o666))
        .tempfile_in(folder)?;
    write(file.as_file_mut())?;
    file.persist(&target)?;
    Ok(())
}
