//! Bytes: mapped files, what is unpacked to scratch first, and the siblings that a file includes.

mod budget;
mod compression;
mod content;
mod hashing;
mod include;
mod mapped;
mod name;
mod packed;
mod regular;
mod scratch;
mod source;
mod unpack;

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use crate::error::{Bound, Error, Kind, Result};
use packed::Packed;
use twox_hash::XxHash3_64;

pub use budget::Budget;
pub use compression::Compression;
pub use content::looks_like;
pub use include::{Sibling, Siblings};
pub use name::mesh_name;
pub use scratch::{Scratch, ScratchFile, ScratchShare};
pub use source::{Source, Spot, Window};

/// Limits that guard the machine against hostile or broken files. Each has its own error.
#[derive(Debug, Clone)]
pub struct Limits {
    /// Most bytes that a file may have on disk.
    pub file_bytes: u64,
    /// Most bytes that a compressed file may unpack to.
    pub unpacked_bytes: u64,
    /// Most bytes out for a byte in, once 64 MiB have come out.
    pub unpacked_ratio: u64,
    /// Largest memory window that a zstd or xz stream may ask for, in bytes.
    pub window_bytes: u64,
    /// Longest line of a text file, in bytes.
    pub line_bytes: usize,
    /// Deepest nesting of included files.
    pub include_depth: usize,
    /// Most included files.
    pub include_count: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            file_bytes: 16 << 40,
            unpacked_bytes: 2 << 40,
            unpacked_ratio: 1000,
            window_bytes: 128 << 20,
            line_bytes: 1 << 20,
            include_depth: 16,
            include_count: 1000,
        }
    }
}

/// A mesh file that is open: its (unpacked) bytes, its scratch space and its limits.
#[derive(Debug, Clone)]
pub struct Input {
    /// The main file.
    pub source: Arc<Source>,
    /// Where what cannot be mapped goes.
    pub scratch: Scratch,
    /// What tables of the mesh may take of memory before they go to scratch.
    pub memory: Budget,
    /// The limits in force.
    pub limits: Limits,
    /// What the bytes were packed with: `gzip`, `zstd`, `bzip2`, `xz`, `lz4`.
    pub compression: Option<&'static str>,
    /// Number of bytes of the file as it stands on disk, or as it came in.
    pub bytes_on_disk: u64,
    /// The folder that the files which this one names must lie in; a stream has none.
    folder: Option<PathBuf>,
    /// The files of a mesh that is several, the main one first; none, where it is one.
    pub parts: Arc<[Input]>,
    /// What the user calls the mesh, where that is not the main file's name.
    called: Option<PathBuf>,
    xxh3: Arc<OnceLock<u64>>,
}

impl Input {
    /// Opens the mesh file at `path`. A compressed one (its first bytes tell) is unpacked to scratch, then mapped like
    /// any other. One layer of compression is undone; what is packed twice is refused.
    pub fn open(path: &Path, limits: &Limits, scratch: &Scratch) -> Result<Self> {
        let file = regular::open(path)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        Ok(Self { folder: Some(folder.to_owned()), ..Self::open_file(path, &file, limits, scratch)? })
    }

    /// Opens a mesh that is several files, the main one first; the user knows it as `path`, which may be their folder.
    pub fn open_together(path: &Path, files: &[PathBuf], limits: &Limits, scratch: &Scratch) -> Result<Self> {
        let parts = files.iter().map(|file| Self::open(file, limits, scratch));
        let parts: Arc<[Self]> = parts.collect::<Result<_>>()?;
        let Some(main) = parts.first() else { return Self::open(path, limits, scratch) };
        Ok(Self {
            compression: parts.iter().find_map(|part| part.compression),
            bytes_on_disk: parts.iter().map(|part| part.bytes_on_disk).sum(),
            called: Some(path.to_owned()),
            xxh3: Arc::default(),
            parts: Arc::clone(&parts),
            ..main.clone()
        })
    }

    /// The name that the user knows the mesh by.
    pub fn path(&self) -> &Path {
        self.called.as_deref().unwrap_or(self.source.path())
    }

    /// The mesh in an open regular file that the user knows as `path`.
    fn open_file(path: &Path, file: &File, limits: &Limits, scratch: &Scratch) -> Result<Self> {
        let mut packed = Packed::new(path, file, limits.file_bytes);
        if Compression::detect(packed.head(Compression::HEAD_BYTES)?).is_some() {
            return Self::unpack(packed, limits, scratch);
        }
        let source = Source::new(path, file)?;
        if source.len() > limits.file_bytes {
            return Err(Error::limit_of(Bound::FileBytes, "the size of the file", bytes(limits.file_bytes))
                .in_file(path));
        }
        let bytes_on_disk = source.len();
        Self::new(source, None, bytes_on_disk, OnceLock::new(), limits, scratch)
    }

    /// Reads a mesh that comes as a stream, into scratch; it may be compressed as a file may. `name` is what errors
    /// call it; `-` stands for standard input.
    pub fn from_reader(name: &Path, reader: impl Read, limits: &Limits, scratch: &Scratch) -> Result<Self> {
        let name = if name == Path::new("-") { Path::new("standard input") } else { name };
        Self::unpack(Packed::new(name, reader, limits.file_bytes), limits, scratch)
    }

    /// Says that [`Input::xxh3`] will be asked for once the mesh was read: then no byte is brought in for it alone.
    pub fn begin_hash(&self) {
        if self.xxh3.get().is_some() {
            return;
        }
        match &*self.parts {
            [] => self.source.begin_hash(),
            parts => parts.iter().for_each(Self::begin_hash),
        }
    }

    /// The XXH3 (64 bits) of the bytes as they stand on disk, or as they came in. What nobody has looked at yet is read for
    /// it. Of several files it is the XXH3 of theirs, big-endian, one after another.
    pub fn xxh3(&self) -> u64 {
        *self.xxh3.get_or_init(|| match &*self.parts {
            [] => self.source.xxh3(),
            parts => {
                let hashes: Vec<_> = parts.iter().flat_map(|part| part.xxh3().to_be_bytes()).collect();
                XxHash3_64::oneshot(&hashes)
            }
        })
    }

    /// [`Input::xxh3`] as 16 hexadecimal digits.
    pub fn xxh3_hex(&self) -> String {
        format!("{:016x}", self.xxh3())
    }

    fn unpack<R: Read>(mut packed: Packed<'_, R>, limits: &Limits, scratch: &Scratch) -> Result<Self> {
        let path = packed.path();
        let compression = Compression::detect(packed.head(Compression::HEAD_BYTES)?);
        let source = unpack::unpack(compression, &mut packed, limits, scratch)?.into_source(path)?;
        let inner = Compression::detect(source.peek(0..Compression::HEAD_BYTES as u64));
        if let (Some(outer), Some(inner)) = (compression, inner) {
            let what = format!(
                "{} within {}: only one layer of compression is unpacked",
                inner.name(),
                outer.name()
            );
            return Err(Error::unsupported(what).in_file(path));
        }
        let (bytes_on_disk, hash) = packed.seen();
        let compression = compression.map(Compression::name);
        Self::new(source, compression, bytes_on_disk, hash.into(), limits, scratch)
    }

    fn new(
        source: Source,
        compression: Option<&'static str>,
        bytes_on_disk: u64,
        xxh3: OnceLock<u64>,
        limits: &Limits,
        scratch: &Scratch,
    ) -> Result<Self> {
        if source.is_empty() {
            return Err(Error::new(Kind::Empty).in_file(source.path()));
        }
        Ok(Self {
            source: Arc::new(source),
            scratch: scratch.clone(),
            memory: Budget::default(),
            limits: limits.clone(),
            compression,
            bytes_on_disk,
            folder: None,
            parts: Arc::default(),
            called: None,
            xxh3: Arc::new(xxh3),
        })
    }
}

/// A number of bytes in the largest unit that shows it in whole.
fn bytes(count: u64) -> String {
    let units = [(40, "TiB"), (30, "GiB"), (20, "MiB"), (10, "KiB")];
    match units.into_iter().find(|&(log, _)| count > 0 && count.trailing_zeros() >= log) {
        Some((log, unit)) => format!("{} {unit}", count >> log),
        None => format!("{count} bytes"),
    }
}
