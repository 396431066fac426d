//! Files to open: a mesh's text, packed or not, in a folder of its own.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use meshgauge::error::{Error, Kind, Result};
use meshgauge::input::{Compression, Input, Limits, Scratch};
use tempfile::TempDir;

pub fn scratch() -> Scratch {
    Scratch::new(&std::env::temp_dir(), 1 << 30)
}

/// A file named `name` in a folder of its own.
pub fn file(name: &str, content: &[u8]) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join(name);
    fs::write(&path, content).expect("the file can be written");
    (folder, path)
}

pub fn open(path: &Path) -> Result<Input> {
    Input::open(path, &Limits::default(), &scratch())
}

pub fn open_bytes(name: &str, content: &[u8]) -> Result<Input> {
    let (_folder, path) = file(name, content);
    open(&path)
}

pub fn content(input: &Input) -> Vec<u8> {
    input.source.window(0..input.source.len()).to_vec()
}

/// Lines that do not pack too well.
pub fn mesh(lines: u64) -> Vec<u8> {
    let mut text = b"*NODE\n".to_vec();
    for n in 1..=lines {
        let x = n.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 11;
        writeln!(text, "{n}, {}, {}., 0.", x as f64 * 1e-16, x % 97).expect("memory takes it");
    }
    text
}

/// One stream, with the check sums that the command-line tools write.
pub fn pack(compression: Compression, content: &[u8]) -> Vec<u8> {
    let packed = match compression {
        Compression::Gzip => {
            let mut out = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::new(9));
            out.write_all(content).and_then(|()| out.finish())
        }
        Compression::Zstd => {
            let mut out = zstd::Encoder::new(Vec::new(), 3).expect("an encoder");
            out.include_checksum(true).expect("a known parameter");
            out.write_all(content).and_then(|()| out.finish())
        }
        Compression::Bzip2 => {
            let mut out = bzip2::write::BzEncoder::new(Vec::new(), bzip2::Compression::best());
            out.write_all(content).and_then(|()| out.finish())
        }
        Compression::Xz => {
            let mut out = liblzma::write::XzEncoder::new(Vec::new(), 6);
            out.write_all(content).and_then(|()| out.finish())
        }
        Compression::Lz4 => {
            let info = lz4_flex::frame::FrameInfo::new().content_checksum(true);
            let mut out = lz4_flex::frame::FrameEncoder::with_frame_info(info, Vec::new());
            out.write_all(content).and_then(|()| out.finish().map_err(io::Error::other))
        }
    };
    packed.expect("memory takes it")
}

pub fn limit(error: &Error) -> String {
    match error.kind() {
        Kind::Limit { .. } => error.kind().to_string(),
        _ => panic!("expected a limit, found {error}"),
    }
}
