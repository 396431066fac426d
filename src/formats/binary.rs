//! What binary formats share: numbers of either byte order, and cutting runs of equal records.

use std::ops::Range;

use crate::error::Result;
use crate::formats::PIECE_BYTES;

/// The order of a number's bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Endian {
    /// Least significant first.
    Little,
    /// Most significant first.
    Big,
}

macro_rules! read {
    ($($name:ident $type:ty),*) => { $(
        /// The number at the start of `bytes`, which must hold one.
        #[inline]
        pub fn $name(self, bytes: &[u8]) -> $type {
            let mut raw = [0; size_of::<$type>()];
            raw.copy_from_slice(&bytes[..size_of::<$type>()]);
            match self {
                Endian::Little => <$type>::from_le_bytes(raw),
                Endian::Big => <$type>::from_be_bytes(raw),
            }
        }
    )* };
}

impl Endian {
    /// The machine's own.
    pub const NATIVE: Endian = if cfg!(target_endian = "little") { Endian::Little } else { Endian::Big };

    read!(u16 u16, u32 u32, i32 i32, u64 u64, i64 i64, f32 f32, f64 f64);
}

/// Cuts `count` records of `width` bytes into runs of about [`PIECE_BYTES`]; gives their record numbers.
pub fn cut_records(count: u64, width: u64, mut run: impl FnMut(Range<u64>) -> Result<()>) -> Result<()> {
    let step = (PIECE_BYTES / width.max(1)).max(1);
    let mut from = 0;
    while from < count {
        let to = count.min(from + step);
        run(from..to)?;
        from = to;
    }
    Ok(())
}
