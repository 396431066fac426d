//! The costly checks: elements that name the same corners, and nodes at the same place.
//!
//! Each element and each node becomes a fingerprint of 128 bits (XXH3). Fingerprints go to scratch, parted by their first
//! bits, so that each part is sorted in memory: equal ones stand together then. That two different ones among 10^10 are
//! taken for equal has a chance of 10^-19.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek};

use twox_hash::XxHash3_128;

use crate::error::{Error, Result};
use crate::input::{Scratch, ScratchFile};
use crate::mesh::{Chunk, Nodes, Shape};

/// Bytes of a mesh for which there is a part.
const BYTES_OF_A_PART: u64 = 64 << 20;
/// The most parts: each has a buffer.
const MOST_PARTS: u64 = 128;

/// Fingerprints on scratch, in parts that have no fingerprint in common.
pub(super) struct Fingerprints {
    parts: Vec<ScratchFile>,
}

impl Fingerprints {
    /// None yet, of a mesh of so many bytes.
    pub(super) fn new(bytes: u64, scratch: &Scratch) -> Result<Self> {
        let parts = (bytes / BYTES_OF_A_PART + 1).min(MOST_PARTS);
        Ok(Self { parts: (0..parts).map(|_| scratch.file()).collect::<Result<_>>()? })
    }

    /// Adds one.
    pub(super) fn add(&mut self, fingerprint: u128) -> Result<()> {
        // The first bits, scaled to the number of parts.
        let part = ((fingerprint >> 96) as u64 * self.parts.len() as u64) >> 32;
        self.parts[part as usize].write(&fingerprint.to_le_bytes())
    }

    /// How many are equal to another that is counted already.
    pub(super) fn repeated(self) -> Result<u64> {
        let mut repeated = 0;
        for part in self.parts {
            let count = part.len() / 16;
            let (file, _share) = part.into_file()?;
            let mut all = read(file, count).map_err(|e| Error::resource("scratch space", e))?;
            all.sort_unstable();
            repeated += all.windows(2).filter(|pair| pair[0] == pair[1]).count() as u64;
        }
        Ok(repeated)
    }
}

fn read(mut file: File, count: u64) -> io::Result<Vec<u128>> {
    file.rewind()?;
    let mut file = BufReader::with_capacity(1 << 16, file);
    let mut word = [0; 16];
    let next = |_| file.read_exact(&mut word).map(|()| u128::from_le_bytes(word));
    (0..count).map(next).collect()
}

/// The fingerprints of a chunk's elements: of the shape and the corners, whatever their order.
pub(super) fn of_elements(chunk: &Chunk) -> Vec<u128> {
    let corners = chunk.shape().corners();
    let of = |rows: &[u32]| {
        let mut sorted = [0; Shape::MAX_CORNERS + 1];
        sorted[..corners].copy_from_slice(rows);
        sorted[..corners].sort_unstable();
        sorted[corners] = chunk.shape().index() as u32;
        XxHash3_128::oneshot(bytemuck::bytes_of(&sorted))
    };
    chunk.rows().chunks_exact(corners).map(of).collect()
}

/// Number of nodes that stand where another stands that is counted already.
pub(super) fn coincident_nodes(nodes: &Nodes, bytes: u64, scratch: &Scratch) -> Result<u64> {
    let mut all = Fingerprints::new(bytes, scratch)?;
    nodes.try_each_row(|row| {
        // 0 and -0 are one place.
        let place = nodes.rows()[row].map(|x| (x + 0.0).to_bits());
        all.add(XxHash3_128::oneshot(bytemuck::bytes_of(&place)))
    })?;
    all.repeated()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_equal_is_found_whatever_the_number_of_parts() {
        let scratch = Scratch::new(&std::env::temp_dir(), 1 << 30);
        for bytes in [0, 3 * BYTES_OF_A_PART, u64::MAX] {
            let mut all = Fingerprints::new(bytes, &scratch).expect("scratch");
            for k in 0..10_000u64 {
                all.add(XxHash3_128::oneshot(&(k % 9_000).to_le_bytes())).expect("scratch");
            }
            all.add(u128::MAX).expect("scratch");
            assert_eq!(all.repeated().expect("scratch"), 1000, "{bytes}");
        }
        assert_eq!(scratch.used(), 0);
    }
}
