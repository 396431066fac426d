//! The XXH3 of a file, taken along the way: a byte is hashed when a window on it is given back and it is in memory anyway,
//! so that nothing is brought in, mapped or read from disk for the hash alone.
//!
//! The hash needs the bytes in their order, and windows come in any. Who gives back a window that stands where the hash
//! stands hashes it; who gives back one further on hashes as much, where the hash stands, so that it catches up. What
//! no window was on is hashed in the end.

use std::hash::Hasher;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use twox_hash::XxHash3_64;

use super::mapped::Mapped;

/// How much is looked at, and given back, at a time where no window is.
const STEP: u64 = 1 << 20;
/// Smaller windows are looks ahead, and no reason to catch up.
const WORTH: u64 = 64 << 10;

/// The hash as far as it goes.
#[derive(Debug, Default)]
pub(super) struct Hashing {
    wanted: AtomicBool,
    seen: Mutex<Seen>,
}

#[derive(Debug, Default)]
struct Seen {
    hash: Hash,
    /// All bytes before this one are in the hash.
    upto: u64,
}

#[derive(Default)]
struct Hash(XxHash3_64);

impl std::fmt::Debug for Hash {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:016x}", self.0.finish())
    }
}

impl Hashing {
    /// Says that somebody will ask for the hash: windows are hashed from now on.
    pub(super) fn begin(&self) {
        self.wanted.store(true, Ordering::Relaxed);
    }

    /// Takes in a window that is about to be given back, if its turn has come.
    pub(super) fn take_in(&self, mapped: &Mapped, window: Range<u64>) {
        if !self.wanted.load(Ordering::Relaxed) {
            return;
        }
        // Whoever finds somebody else at it goes on: what it leaves is made up for.
        let Ok(mut seen) = self.seen.try_lock() else { return };
        let bytes = window.end - window.start;
        if window.start <= seen.upto {
            if seen.upto < window.end {
                let bytes = mapped.peek(seen.upto..window.end);
                seen.add(bytes, window.end);
            }
        } else if bytes >= WORTH {
            let upto = window.end.min(seen.upto + 2 * bytes);
            seen.go_through(mapped, upto);
        }
    }

    /// The hash of all bytes.
    pub(super) fn finish(&self, mapped: &Mapped) -> u64 {
        let mut seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        seen.go_through(mapped, mapped.len());
        seen.hash.0.finish()
    }
}

impl Seen {
    fn add(&mut self, bytes: &[u8], upto: u64) {
        self.hash.0.write(bytes);
        self.upto = upto;
    }

    /// Hashes what nobody has a window on.
    fn go_through(&mut self, mapped: &Mapped, upto: u64) {
        while self.upto < upto {
            let step = upto.min(self.upto + STEP);
            self.add(&mapped.window(self.upto..step), step);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;
    use std::path::Path;

    use crate::input::Source;

    #[test]
    fn windows_in_any_order_give_the_hash_of_the_bytes_in_theirs() {
        const STEP: u64 = 100_000;
        let bytes: Vec<u8> = (0..3_000_000u32).map(|k| (k.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
        let mut file = tempfile::tempfile().expect("a folder for temporary files");
        file.write_all(&bytes).expect("room");
        let expected = xxhash_rust::xxh3::xxh3_64(&bytes);
        let steps = bytes.len() as u64 / STEP;
        let orders: [Vec<u64>; 5] = [
            (0..steps).collect(),
            (0..steps).rev().collect(),
            (0..steps).map(|k| k * 7 % steps).collect(),
            // As of two workers; and with what is never looked at, or twice.
            (0..steps).map(|k| k ^ 1).collect(),
            vec![3, 4, 4, 0, 29, 3],
        ];
        for order in orders {
            let source = Source::new(Path::new("bytes"), &file).expect("it was written");
            source.begin_hash();
            for step in &order {
                drop(source.window(step * STEP..(step + 1) * STEP));
                drop(source.window(step * STEP..step * STEP + 9));
            }
            assert_eq!(source.xxh3(), expected, "{order:?}");
            assert_eq!(source.xxh3(), expected, "asked twice");
        }
    }
}
