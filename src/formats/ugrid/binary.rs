//! Binary UGRID: a stream of numbers, or two Fortran records.

use std::ffi::OsStr;
use std::sync::Arc;

use super::{Counts, KINDS, SURFACES, read_counts};
use crate::error::{Error, Result};
use crate::formats::Outline;
use crate::formats::binary::Endian::{self, Big, Little};
use crate::formats::rows::{ElementRecords, NodeRecords, Words};
use crate::input::Input;

/// A way to store the numbers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Variant {
    /// As names of files tell it, before `.ugrid`.
    pub(super) suffix: &'static str,
    pub(super) words: Words,
    /// Whether the counts and the rest are Fortran records, with their length before and after.
    pub(super) records: bool,
}

const fn variant(suffix: &'static str, endian: Endian, word: usize, real: usize, records: bool) -> Variant {
    Variant { suffix, words: Words { endian, word, real }, records }
}

/// Those that are known.
pub(super) static VARIANTS: [Variant; 10] = [
    variant("b8", Big, 4, 8, false),
    variant("lb8", Little, 4, 8, false),
    variant("b4", Big, 4, 4, false),
    variant("lb4", Little, 4, 4, false),
    variant("b8l", Big, 8, 8, false),
    variant("lb8l", Little, 8, 8, false),
    variant("r8", Big, 4, 8, true),
    variant("lr8", Little, 4, 8, true),
    variant("r4", Big, 4, 4, true),
    variant("lr4", Little, 4, 4, true),
];

impl Variant {
    /// Bytes of the counts, with what stands round them.
    fn head(&self) -> usize {
        7 * self.words.word + if self.records { 3 * 4 } else { 0 }
    }

    /// The counts at the start of `bytes`, if they can be those of a mesh.
    fn counts(&self, bytes: &[u8]) -> Option<Counts> {
        let Words { endian, word, .. } = self.words;
        let head = bytes.get(..self.head())?;
        let numbers = if self.records {
            let length = 7 * word as u32;
            if endian.u32(head) != length || endian.u32(&head[4 + 7 * word..]) != length {
                return None;
            }
            &head[4..]
        } else {
            head
        };
        let mut numbers = numbers.chunks(word);
        let most = if word == 4 { i32::MAX as u64 } else { i64::MAX as u64 };
        let counts = read_counts(|| {
            let count = numbers.next().map(|bytes| self.words.integer(bytes)).filter(|count| *count <= most);
            count.ok_or_else(|| Error::malformed("a count", "a number below 0"))
        });
        counts.ok().filter(Counts::is_likely)
    }

    /// Bytes of a file with these counts.
    fn size(&self, counts: &Counts) -> u128 {
        let Words { word, real, .. } = self.words;
        let mut size = self.head() as u128 + u128::from(counts.points) * 3 * real as u128;
        for (k, (kind, count)) in KINDS.iter().zip(counts.elements).enumerate() {
            size += u128::from(count) * ((kind.nodes + usize::from(k < SURFACES)) * word) as u128;
        }
        size + if self.records { 4 } else { 0 }
    }

    /// Whether the coordinates that stand in `head` can be those of a mesh.
    fn has_coordinates(&self, counts: &Counts, head: &[u8]) -> bool {
        let coordinates = head[self.head()..].chunks_exact(self.words.real);
        let likely = |x: f64| x == 0.0 || (1e-30..1e30).contains(&x.abs());
        coordinates.take(counts.points.saturating_mul(3) as usize).all(|bytes| likely(self.words.real(bytes)))
    }
}

/// Whether a file with this head can be one; `whole` says that it has no more bytes.
pub(super) fn is_likely(head: &[u8], whole: bool) -> bool {
    // Letters taken for numbers are counts of a thousand million, seven times over.
    !head.iter().take(28).all(|byte| byte.is_ascii_graphic() || byte.is_ascii_whitespace())
        && VARIANTS.iter().any(|variant| {
            variant.counts(head).is_some_and(|counts| {
                variant.has_coordinates(&counts, head)
                    && (!whole || variant.size(&counts) == head.len() as u128)
            })
        })
}

/// The variant that the file's name tells.
fn named(input: &Input) -> Option<&'static Variant> {
    let mut parts = input.source.path().file_name().and_then(OsStr::to_str)?.rsplit('.');
    let ugrid = parts.find(|part| part.eq_ignore_ascii_case("ugrid")).and_then(|_| parts.next())?;
    VARIANTS.iter().find(|variant| variant.suffix.eq_ignore_ascii_case(ugrid))
}

/// The variant whose counts say the size that the file has. A name only decides between several.
fn choose(input: &Input) -> Result<(&'static Variant, Counts)> {
    let (head, len) = (input.source.peek(0..68), input.source.len());
    let named = named(input);
    let known = named.into_iter().chain(&VARIANTS);
    let likely: Vec<_> = known.filter_map(|v| v.counts(head).map(|counts| (v, counts))).collect();
    if let Some(found) = likely.iter().find(|(v, counts)| v.size(counts) == u128::from(len)) {
        return Ok(*found);
    }
    let meant = match named {
        Some(named) => likely.iter().find(|(variant, _)| variant.suffix == named.suffix),
        None => likely.iter().min_by_key(|(variant, counts)| variant.size(counts)),
    };
    let Some((variant, counts)) = meant else {
        let of = named.map_or("in one of the known variants", |named| named.suffix);
        let what = format!("seven counts of points and elements at the start ({of})");
        return Err(input.source.malformed_binary(0, what, "other numbers"));
    };
    let expected = format!(
        "{} bytes, as the counts of {} points and {:?} elements say ({})",
        variant.size(counts),
        counts.points,
        counts.elements,
        variant.suffix
    );
    Err(input.source.malformed_binary(0, expected, format!("{len} bytes")))
}

pub(super) fn outline(input: &Input, out: &mut dyn Outline) -> Result<()> {
    let (variant, counts) = choose(input)?;
    let words = variant.words;
    let Words { endian, word, real } = words;
    let mut at = variant.head() as u64;
    if variant.records {
        let body = input.source.len() - at - 4;
        for mark in [at - 4, input.source.len() - 4] {
            let found = endian.u32(input.source.peek(mark..mark + 4));
            if u64::from(found) != body {
                let expected = format!("the length of one Fortran record, {body},");
                return Err(input.source.malformed_binary(mark, expected, found.to_string()));
            }
        }
    }
    let source = || Arc::clone(&input.source);
    let width = 3 * real;
    NodeRecords { source: source(), words, at, width, dimension: 3, first: 1 }.outline(counts.points, out)?;
    at += counts.points * width as u64;
    let mut first = 1;
    for (k, (kind, count)) in KINDS.iter().zip(counts.elements).enumerate() {
        if k == SURFACES {
            at += counts.elements[..SURFACES].iter().sum::<u64>() * word as u64;
        }
        let width = kind.nodes * word;
        ElementRecords { source: source(), words, at, width, kind, first }.outline(count, out)?;
        at += count * width as u64;
        first += count;
    }
    Ok(())
}
