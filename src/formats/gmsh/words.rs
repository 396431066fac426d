//! Numbers of binary sections: tags and counts as words of four or eight bytes.

use super::no_dimension;
use super::walk::Walk;
use crate::error::{Error, Result};
use crate::formats::binary::Endian;

/// How numbers stand in binary sections.
#[derive(Debug, Clone, Copy)]
pub(super) struct Binary {
    pub(super) endian: Endian,
    /// Number of bytes of a tag or a count: 4 in MSH 2, those of the writer's `size_t` in 4.1.
    pub(super) word: usize,
    /// The largest tag or count.
    pub(super) most: u64,
}

impl Binary {
    /// The word at the start of `bytes`.
    #[inline]
    pub(super) fn word<const WORD: usize>(self, bytes: &[u8]) -> u64 {
        if WORD == 4 { self.endian.u32(bytes).into() } else { self.endian.u64(bytes) }
    }

    /// The tag at the start of `bytes`, `least` or more.
    #[inline]
    pub(super) fn tag<const WORD: usize>(self, bytes: &[u8], least: u64) -> Result<u64> {
        let tag = self.word::<WORD>(bytes);
        if tag < least || tag > self.most { Err(self.no_tag::<WORD>(tag)) } else { Ok(tag) }
    }

    /// The tags that fill `bytes`, as many as `tags` has room for.
    #[inline]
    pub(super) fn tags<const WORD: usize>(self, bytes: &[u8], tags: &mut [u64]) -> Result<()> {
        // Those over the largest have a bit that it has not.
        let mut bits = 0;
        for (tag, raw) in tags.iter_mut().zip(bytes.chunks_exact(WORD)) {
            *tag = self.word::<WORD>(raw);
            bits |= *tag;
        }
        if bits & !self.most == 0 {
            return Ok(());
        }
        Err(self.no_tag::<WORD>(tags.iter().copied().find(|&tag| tag > self.most).unwrap_or(bits)))
    }

    #[cold]
    fn no_tag<const WORD: usize>(self, tag: u64) -> Error {
        let found = if WORD == 4 { i64::from(tag as i32) } else { tag as i64 };
        Error::malformed("a positive tag", format!("{found}"))
    }

    /// The count at the start of `bytes`.
    pub(super) fn count(self, bytes: &[u8]) -> Result<u64> {
        let count = if self.word == 4 { self.word::<4>(bytes) } else { self.word::<8>(bytes) };
        if count > self.most {
            return Err(Error::malformed("a count", format!("{}", count as i64)));
        }
        Ok(count)
    }

    /// Bytes of the head of a block of MSH 4.1: three numbers of four bytes, and a count.
    pub(super) fn block_head(self) -> usize {
        12 + self.word
    }

    /// The dimension of the entity that a block of MSH 4.1 belongs to.
    pub(super) fn dimension(self, head: &[u8]) -> Result<usize> {
        match self.endian.u32(head) {
            dimension @ 0..=3 => Ok(dimension as usize),
            other => Err(no_dimension(i64::from(other as i32))),
        }
    }

    /// The head of a section of MSH 4.1, as `Version::block_counts` in text.
    pub(super) fn block_counts(self, walk: &mut Walk<'_>) -> Result<(u64, u64)> {
        let at = walk.at();
        let head = walk.bytes(4 * self.word, "the numbers of blocks and nodes or elements")?;
        let counts = self.count(head).and_then(|blocks| Ok((blocks, self.count(&head[self.word..])?)));
        counts.map_err(|e| walk.place(e, at))
    }
}
