//! Unpacking to scratch: a stream goes through one decoder and one buffer, and what comes out is counted before it is
//! kept. A stream that ends early, a wrong check sum and bytes that belong to no stream are errors: nothing short or
//! doubtful is handed on.
//!
//! What cannot be seen: a file of several members that was cut exactly between two of them.

use std::io::{self, BufRead, Read};

use liblzma::stream as lzma;
use zstd::zstd_safe;

use super::packed::Packed;
use super::{Compression, Limits, Scratch, ScratchFile, bytes};
use crate::error::{At, Bound, Error, Result, excerpt};

/// The ratio of bytes out to bytes in is held against its limit once so much has come out.
const RATIO_HOLDS_FROM: u64 = 64 << 20;

/// What an xz decoder needs beside the window.
const XZ_STATE_BYTES: u64 = 1 << 20;

const BUFFER_BYTES: usize = 256 << 10;

/// Brings the whole of `packed` to scratch; as it is, where it is not compressed.
pub(super) fn unpack<R: Read>(
    compression: Option<Compression>,
    packed: &mut Packed<'_, R>,
    limits: &Limits,
    scratch: &Scratch,
) -> Result<ScratchFile> {
    let path = packed.path();
    let place = |error: Error| match compression {
        Some(compression) => error.in_format(compression.name()).in_file(path),
        None => error.in_file(path),
    };
    let mut out = Unpacked { file: scratch.file()?, buffer: vec![0; BUFFER_BYTES], limits };
    loop {
        out.stream(compression, packed).map_err(place)?;
        match compression {
            Some(compression) if another(compression, packed).map_err(place)? => {}
            _ => return Ok(out.file),
        }
    }
}

/// Whether another stream follows; anything else but the end of the file is an error.
fn another<R: Read>(compression: Compression, packed: &mut Packed<'_, R>) -> Result<bool> {
    if matches!(compression, Compression::Gzip | Compression::Xz) {
        // Both allow zero bytes as padding: tapes and block devices make it.
        while packed.head(1)?.first() == Some(&0) {
            let there = packed.head(1)?;
            let zeros = there.iter().position(|&b| b != 0).unwrap_or(there.len());
            packed.consume(zeros);
        }
    }
    let at = packed.position().get();
    let head = packed.head(Compression::HEAD_BYTES)?;
    if head.is_empty() {
        return Ok(false);
    }
    if Compression::detect(head) == Some(compression) {
        return Ok(true);
    }
    let expected = format!("another {} stream or the end of the file", compression.name());
    Err(Error::malformed(expected, excerpt(head)).at(At::Byte(at)))
}

/// What has come out so far.
struct Unpacked<'l> {
    file: ScratchFile,
    buffer: Vec<u8>,
    limits: &'l Limits,
}

impl Unpacked<'_> {
    /// One stream (member, frame) to its end.
    fn stream<R: Read>(
        &mut self,
        compression: Option<Compression>,
        packed: &mut Packed<'_, R>,
    ) -> Result<()> {
        let position = packed.position();
        let mut decoder = decoder(compression, packed, self.limits)?;
        let done = loop {
            match decoder.read(&mut self.buffer) {
                Ok(0) => break Ok(()),
                Ok(count) => self.keep(count, position.get())?,
                Err(e) if e.kind() == io::ErrorKind::Interrupted => {}
                Err(e) => break Err(e),
            }
        };
        drop(decoder);
        match (done, compression) {
            // This decoder alone takes the end of the file for the end of the frame.
            (Ok(()), Some(Compression::Lz4)) if packed.ended() => {
                Err(self.fault(compression, io::ErrorKind::UnexpectedEof.into(), packed))
            }
            (Ok(()), _) => Ok(()),
            (Err(e), _) => Err(self.fault(compression, e, packed)),
        }
    }

    /// Keeps the first `count` bytes of the buffer, if the limits allow.
    fn keep(&mut self, count: usize, packed_bytes: u64) -> Result<()> {
        let total = self.file.len() + count as u64;
        if total > self.limits.unpacked_bytes {
            return Err(Error::limit_of(
                Bound::UnpackedBytes,
                "the size of the content",
                bytes(self.limits.unpacked_bytes),
            ));
        }
        let ratio = self.limits.unpacked_ratio;
        if total > RATIO_HOLDS_FROM && total > packed_bytes.saturating_mul(ratio) {
            return Err(Error::limit_of(
                Bound::UnpackedRatio,
                "the number of bytes that a packed byte yields",
                ratio,
            ));
        }
        self.file.write(&self.buffer[..count])
    }

    /// What a decoder's error means.
    fn fault<R: Read>(
        &self,
        compression: Option<Compression>,
        error: io::Error,
        packed: &mut Packed<'_, R>,
    ) -> Error {
        if let Some(cause) = packed.stopped() {
            return cause;
        }
        let name = compression.map_or("packed", Compression::name);
        let at = At::Byte(packed.position().get());
        if asks_too_much(&error) {
            let what = format!("the window that the {name} stream asks for");
            return Error::limit_of(Bound::WindowBytes, what, bytes(self.limits.window_bytes)).at(at);
        }
        if error.kind() == io::ErrorKind::UnexpectedEof {
            return Error::malformed(format!("the rest of the {name} stream"), "the end of the file").at(at);
        }
        Error::malformed(format!("sound {name} data"), error.to_string()).at(at)
    }
}

/// A decoder of the one stream that `packed` stands before.
fn decoder<'d, R: Read>(
    compression: Option<Compression>,
    packed: &'d mut Packed<'_, R>,
    limits: &Limits,
) -> Result<Box<dyn Read + 'd>> {
    let memory = |e: io::Error| Error::resource("memory", e);
    Ok(match compression {
        None => Box::new(packed),
        Some(Compression::Gzip) => Box::new(flate2::bufread::GzDecoder::new(packed)),
        Some(Compression::Bzip2) => Box::new(bzip2::bufread::BzDecoder::new(packed)),
        Some(Compression::Lz4) => Box::new(lz4_flex::frame::FrameDecoder::new(packed)),
        Some(Compression::Xz) => {
            let limit = limits.window_bytes.saturating_add(XZ_STATE_BYTES);
            let stream = lzma::Stream::new_stream_decoder(limit, 0).map_err(|e| memory(e.into()))?;
            Box::new(liblzma::bufread::XzDecoder::new_stream(packed, stream))
        }
        Some(Compression::Zstd) => {
            let mut decoder = zstd::Decoder::with_buffer(packed).map_err(memory)?.single_frame();
            decoder.window_log_max(window_log(limits.window_bytes)).map_err(memory)?;
            Box::new(decoder)
        }
    })
}

/// The largest power of two within `window_bytes`, within what zstd knows.
fn window_log(window_bytes: u64) -> u32 {
    window_bytes.max(1).ilog2().clamp(10, 31)
}

/// Whether the decoder refused a stream for the memory that it asks for.
fn asks_too_much(error: &io::Error) -> bool {
    let Some(inner) = error.get_ref() else { return false };
    if let Some(inner) = inner.downcast_ref::<lzma::Error>() {
        return *inner == lzma::Error::MemLimit;
    }
    // The zstd crate gives the code's name alone. The C library counts its codes down from zero.
    let code = zstd_safe::zstd_sys::ZSTD_ErrorCode::ZSTD_error_frameParameter_windowTooLarge as usize;
    inner.to_string() == zstd_safe::get_error_name(0usize.wrapping_sub(code))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn window_limit_is_rounded_down_to_a_power_of_two() {
        assert_eq!(window_log(128 << 20), 27);
        assert_eq!(window_log((128 << 20) - 1), 26);
        assert_eq!(window_log(0), 10);
        assert_eq!(window_log(u64::MAX), 31);
    }
}
