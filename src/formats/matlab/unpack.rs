//! Unpacking: each variable of a MAT-file may be a zlib stream of its own.

use std::ops::Range;

use flate2::{Decompress, FlushDecompress, Status};

use crate::error::{Bound, Error, Result};
use crate::input::{Input, Spot};

/// Unpacks the zlib stream at `range` and hands on what comes out, piece by piece, until `take` says no.
pub(super) fn unpack(
    input: &Input,
    range: Range<u64>,
    mut take: impl FnMut(&[u8]) -> Result<bool>,
) -> Result<()> {
    const STEP: u64 = 1 << 20;
    /// The ratio is not looked at before so many bytes have come out.
    const FREE: u64 = 64 << 20;
    let source = &input.source;
    let mut zlib = Decompress::new(true);
    let mut buffer = vec![0; 256 << 10];
    let mut at = range.start;
    loop {
        let window = source.window(at..range.end.min(at + STEP));
        let (read, written) = (zlib.total_in(), zlib.total_out());
        let status = zlib.decompress(&window, &mut buffer, FlushDecompress::None);
        let status = status.map_err(|error| broken(error.to_string(), input, at))?;
        at += zlib.total_in() - read;
        let found = (zlib.total_out() - written) as usize;
        let (packed, total) = (at - range.start, zlib.total_out());
        let limits = &input.limits;
        if total > limits.unpacked_bytes {
            let error = Error::limit_of(
                Bound::UnpackedBytes,
                "unpacked size of a variable",
                format!("{} bytes", limits.unpacked_bytes),
            );
            return Err(source.place(error, Spot::Binary(range.start)));
        }
        if total > FREE && total / limits.unpacked_ratio > packed {
            let error =
                Error::limit_of(Bound::UnpackedRatio, "bytes unpacked from one byte", limits.unpacked_ratio);
            return Err(source.place(error, Spot::Binary(range.start)));
        }
        if !take(&buffer[..found])? || status == Status::StreamEnd {
            return Ok(());
        }
        if found == 0 && zlib.total_in() == read {
            return Err(broken("its end".into(), input, at));
        }
    }
}

fn broken(found: String, input: &Input, at: u64) -> Error {
    input.source.malformed_binary(at, "a whole zlib stream", found)
}
