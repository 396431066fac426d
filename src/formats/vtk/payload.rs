//! What an array of a VTU file is wrapped in: base64, and blocks that are compressed one by one.

use flate2::{Decompress, FlushDecompress};
use liblzma::stream::{Action, Stream as XzStream};

use crate::error::{Error, Result};
use crate::formats::binary::Endian;
use crate::input::{Input, Source};

use crate::formats::array::Unpacked;

/// Largest block that is unpacked, in bytes. VTK's own blocks have 32 KiB.
const LARGEST_BLOCK: u64 = 1 << 30;

/// How blocks are compressed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Compressor {
    /// A zlib stream a block.
    Zlib,
    /// A bare LZ4 block.
    Lz4,
    /// An xz file a block.
    Lzma,
}

impl Compressor {
    /// The compressor that a file names.
    pub fn find(name: &str) -> Option<Self> {
        match name {
            "vtkZLibDataCompressor" => Some(Self::Zlib),
            "vtkLZ4DataCompressor" => Some(Self::Lz4),
            "vtkLZMADataCompressor" => Some(Self::Lzma),
            _ => None,
        }
    }
}

/// The numbers in front of an array: lengths and counts.
#[derive(Debug, Clone, Copy)]
pub struct HeaderType {
    /// Number of bytes: 4 or 8.
    pub width: u64,
    /// The file's byte order.
    pub endian: Endian,
}

impl HeaderType {
    fn number(self, bytes: &[u8]) -> u64 {
        if self.width == 4 { u64::from(self.endian.u32(bytes)) } else { self.endian.u64(bytes) }
    }
}

/// Bytes one after another, with base64 taken off where there is some.
#[derive(Debug)]
pub struct Bytes<'i> {
    source: &'i Source,
    at: u64,
    base64: Option<Base64>,
}

#[derive(Debug, Default)]
struct Base64 {
    /// Characters that make no whole group yet.
    carry: Vec<u8>,
    decoded: Vec<u8>,
    /// How much of `decoded` was taken.
    taken: usize,
}

impl<'i> Bytes<'i> {
    /// The bytes of `source` from `at` on.
    pub fn raw(source: &'i Source, at: u64) -> Self {
        Self { source, at, base64: None }
    }

    /// The bytes that the base64 text from `at` on stands for; it ends at a `<`. Runs with padding may follow each other.
    pub fn base64(source: &'i Source, at: u64) -> Self {
        Self { source, at, base64: Some(Base64::default()) }
    }

    /// Appends the next `count` bytes to `out`.
    pub fn take(&mut self, count: u64, out: &mut Vec<u8>) -> Result<()> {
        const STEP: u64 = 1 << 20;
        let mut left = count;
        while left > 0 {
            let had = out.len();
            match &mut self.base64 {
                None => {
                    out.extend_from_slice(
                        &self.source.window(self.at..self.at.saturating_add(left.min(STEP))),
                    );
                    self.at += (out.len() - had) as u64;
                }
                Some(base64) => {
                    if base64.taken == base64.decoded.len() {
                        self.at += base64.refill(self.source, self.at, left)?;
                    }
                    let ready = &base64.decoded[base64.taken..];
                    let ready = &ready[..ready.len().min(usize::try_from(left).unwrap_or(usize::MAX))];
                    out.extend_from_slice(ready);
                    base64.taken += ready.len();
                }
            }
            if out.len() == had {
                return Err(Error::malformed(format!("{left} more bytes of the array"), "its end"));
            }
            left -= (out.len() - had) as u64;
        }
        Ok(())
    }

    /// The next number of a header.
    pub fn number(&mut self, kind: HeaderType) -> Result<u64> {
        let mut bytes = Vec::with_capacity(8);
        self.take(kind.width, &mut bytes)?;
        Ok(kind.number(&bytes))
    }

    /// Whether base64 is taken off.
    pub fn is_base64(&self) -> bool {
        self.base64.is_some()
    }

    /// Where the next byte stands in the file. Makes sense without base64 only.
    pub fn position(&self) -> u64 {
        self.at
    }

    /// Unpacks the next `count` bytes as they are.
    pub fn copy(&mut self, count: u64, out: &mut Unpacked<'_>) -> Result<()> {
        let mut buffer = Vec::new();
        let mut left = count;
        while left > 0 {
            buffer.clear();
            let step = left.min(1 << 20);
            self.take(step, &mut buffer)?;
            out.write(&buffer)?;
            left -= step;
        }
        Ok(())
    }
}

impl Base64 {
    /// Decodes more text, enough for about `wanted` bytes. Gives the number of characters read.
    fn refill(&mut self, source: &Source, at: u64, wanted: u64) -> Result<u64> {
        const MOST: u64 = 256 << 10;
        const LEAST: u64 = 64;
        let window = source.window(at..at.saturating_add((wanted.min(MOST) / 3 * 4).max(LEAST)));
        let text = &window[..memchr::memchr(b'<', &window).unwrap_or(window.len())];
        self.carry.extend(text.iter().filter(|byte| !byte.is_ascii_whitespace()));
        self.decoded.clear();
        self.taken = 0;
        let whole = self.carry.len() / 4 * 4;
        let mut rest = &self.carry[..whole];
        while !rest.is_empty() {
            // Padding ends a run; another may follow.
            let (run, next) = rest.split_at(memchr::memchr(b'=', rest).map_or(rest.len(), |k| k / 4 * 4 + 4));
            let done = base64_simd::STANDARD.decode_append(run, &mut self.decoded);
            done.map_err(|_| Error::malformed("base64 text", crate::error::excerpt(run)))?;
            rest = next;
        }
        self.carry.drain(..whole);
        if self.decoded.is_empty() && !text.is_empty() {
            // Nothing but blanks and a part of a group.
            return Ok(text.len() as u64 + self.refill(source, at + text.len() as u64, wanted)?);
        }
        Ok(text.len() as u64)
    }
}

/// Unpacks an array of compressed blocks; `expected` is the number of bytes that it should have, where that is known.
pub fn unpack_blocks(
    input: &Input,
    bytes: &mut Bytes<'_>,
    kind: HeaderType,
    compressor: Compressor,
    expected: Option<u64>,
    out: &mut Unpacked<'_>,
) -> Result<()> {
    let (blocks, full, last) = (bytes.number(kind)?, bytes.number(kind)?, bytes.number(kind)?);
    let last = if last == 0 { full } else { last };
    let total = blocks.checked_sub(1).map_or(Some(0), |n| n.checked_mul(full)?.checked_add(last));
    if total.is_none() || expected.is_some_and(|expected| total != Some(expected)) {
        return Err(Error::malformed(
            format!("blocks of {} bytes in all", expected.unwrap_or(input.limits.unpacked_bytes)),
            format!("{blocks} blocks of {full} bytes, the last of {last}"),
        ));
    }
    if full.max(last) > LARGEST_BLOCK {
        return Err(Error::limit("size of a compressed block", format!("{LARGEST_BLOCK} bytes")));
    }
    let mut sizes = Vec::new();
    bytes.take(blocks.saturating_mul(kind.width), &mut sizes)?;
    let mut unpacker = Unpacker::new(compressor, input.limits.window_bytes);
    let mut packed = Vec::new();
    for (k, size) in sizes.chunks_exact(kind.width as usize).enumerate() {
        packed.clear();
        bytes.take(kind.number(size), &mut packed)?;
        let len = if k as u64 + 1 == blocks { last } else { full };
        unpacker.block(&packed, len as usize, out)?;
    }
    Ok(())
}

fn broken(len: usize, found: impl Into<String>) -> Error {
    Error::malformed(format!("a compressed block of {len} bytes"), found)
}

/// Unpacks blocks.
struct Unpacker {
    compressor: Compressor,
    zlib: Decompress,
    xz_memory: u64,
    buffer: Vec<u8>,
}

impl Unpacker {
    fn new(compressor: Compressor, xz_memory: u64) -> Self {
        Self { compressor, zlib: Decompress::new(true), xz_memory, buffer: Vec::new() }
    }

    /// Unpacks one block, which must come to `len` bytes.
    fn block(&mut self, packed: &[u8], len: usize, out: &mut Unpacked<'_>) -> Result<()> {
        match self.compressor {
            Compressor::Zlib => {
                self.zlib.reset(true);
                let zlib = &mut self.zlib;
                drain(&mut self.buffer, len, out, |buffer| {
                    let (read, written) = (zlib.total_in() as usize, zlib.total_out());
                    let status = zlib.decompress(&packed[read..], buffer, FlushDecompress::None);
                    let status = status.map_err(|e| broken(len, e.to_string()))?;
                    Ok(((zlib.total_out() - written) as usize, status == flate2::Status::StreamEnd))
                })
            }
            Compressor::Lzma => {
                let xz = XzStream::new_stream_decoder(self.xz_memory, 0);
                let mut xz = xz.map_err(|e| broken(len, e.to_string()))?;
                drain(&mut self.buffer, len, out, |buffer| {
                    let (read, written) = (xz.total_in() as usize, xz.total_out());
                    let status = xz.process(&packed[read..], buffer, Action::Run);
                    let status = status.map_err(|e| broken(len, e.to_string()))?;
                    let at_end = status == liblzma::stream::Status::StreamEnd;
                    Ok(((xz.total_out() - written) as usize, at_end))
                })
            }
            Compressor::Lz4 => {
                // A byte of LZ4 stands for 255 at most: what is allocated was paid for.
                if len / 255 > packed.len() {
                    return Err(broken(len, format!("{} bytes of LZ4", packed.len())));
                }
                self.buffer.resize(len, 0);
                match lz4_flex::block::decompress_into(packed, &mut self.buffer) {
                    Ok(found) if found == len => out.write(&self.buffer),
                    Ok(found) => Err(broken(len, format!("{found} bytes"))),
                    Err(error) => Err(broken(len, error.to_string())),
                }
            }
        }
    }
}

/// Drains a decoder, which says how much it put into the buffer and whether it is at its end.
fn drain(
    buffer: &mut Vec<u8>,
    len: usize,
    out: &mut Unpacked<'_>,
    mut more: impl FnMut(&mut [u8]) -> Result<(usize, bool)>,
) -> Result<()> {
    buffer.resize(64 << 10, 0);
    let mut found = 0;
    loop {
        let (written, at_end) = more(buffer)?;
        found += written;
        if found > len {
            return Err(broken(len, "more than that"));
        }
        out.write(&buffer[..written])?;
        if at_end && found == len {
            return Ok(());
        }
        if at_end || written == 0 {
            return Err(broken(len, format!("{found} bytes")));
        }
    }
}
