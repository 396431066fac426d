//! Binary STL: 80 bytes of anything, the number of facets, and 50 bytes a facet, little-endian.

use super::weld::Welder;
use crate::error::Result;
use crate::formats::binary::Endian;
use crate::input::{Source, Spot};

const HEADER: u64 = 84;
const FACET: u64 = 50;
const COUNT: std::ops::Range<usize> = 80..84;

/// The number of facets that the header states.
fn count(head: &[u8]) -> Option<u64> {
    head.get(COUNT).map(|bytes| u64::from(Endian::Little.u32(bytes)))
}

/// Whether a file has the very size that its number of facets asks for.
pub(super) fn has_size_of_binary(source: &Source) -> bool {
    count(source.peek(0..HEADER)).is_some_and(|count| source.len() == HEADER + FACET * count)
}

/// Whether the first bytes of a file are those of a binary file: by its size, where they are all of it, else by facets
/// with unit normals.
pub(super) fn is_binary(head: &[u8], is_whole: bool) -> bool {
    let Some(count) = count(head).filter(|count| *count > 0) else { return false };
    if is_whole && head.len() as u64 == HEADER + FACET * count {
        return true;
    }
    let facets = head[HEADER as usize..].chunks_exact(FACET as usize);
    (1..=count).contains(&(facets.len() as u64))
        && facets.clone().all(is_facet)
        && facets.into_iter().any(|facet| facet[12..48].iter().any(|byte| *byte != 0))
}

/// Whether bytes look like a facet: its normal is of length one or not given. Of whole numbers and text taken for reals
/// both would be far too small.
fn is_facet(bytes: &[u8]) -> bool {
    let reals: [f64; 12] = std::array::from_fn(|k| f64::from(Endian::Little.f32(&bytes[4 * k..])));
    let normal: f64 = reals[..3].iter().map(|value| value * value).sum();
    (normal == 0.0 || (normal - 1.0).abs() < 0.01)
        && reals[3..].iter().all(|value| *value == 0.0 || (1e-30..=1e15).contains(&value.abs()))
}

/// Takes in all facets.
pub(super) fn read(source: &Source, welder: &mut Welder) -> Result<()> {
    const STEP: u64 = FACET * (64 << 10);
    let count = count(source.peek(0..HEADER)).ok_or_else(|| source.truncated("a header of 84 bytes"))?;
    let end = HEADER + FACET * count;
    if source.len() != end {
        let expected = format!("{end} bytes for {count} facets");
        let found = format!("{} bytes", source.len());
        return Err(source.malformed_binary(COUNT.start as u64, expected, found));
    }
    let mut from = HEADER;
    while from < end {
        let window = source.window(from..end.min(from + STEP));
        for (bytes, at) in window.chunks_exact(FACET as usize).zip((from..).step_by(FACET as usize)) {
            let corner =
                |k: usize| [0, 4, 8].map(|axis| f64::from(Endian::Little.f32(&bytes[12 * (k + 1) + axis..])));
            let facet = [corner(0), corner(1), corner(2)];
            welder.facet(facet).map_err(|error| source.place(error, Spot::Binary(at)))?;
        }
        from += STEP;
    }
    Ok(())
}
