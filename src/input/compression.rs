//! The compressions that are undone, each known by its first bytes. A file's name is not asked.

/// A compression that is undone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Compression {
    /// RFC 1952: one or more members.
    Gzip,
    /// RFC 8878: frames, skippable ones among them.
    Zstd,
    /// One or more bzip2 streams.
    Bzip2,
    /// One or more .xz streams.
    Xz,
    /// One or more LZ4 frames.
    Lz4,
}

impl Compression {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Gzip, Self::Zstd, Self::Bzip2, Self::Xz, Self::Lz4];

    /// The most bytes that [`Compression::detect`] looks at.
    pub const HEAD_BYTES: usize = 10;

    /// The name, as it stands in a summary.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gzip => "gzip",
            Self::Zstd => "zstd",
            Self::Bzip2 => "bzip2",
            Self::Xz => "xz",
            Self::Lz4 => "lz4",
        }
    }

    /// The extension that file names bear, without the dot.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Gzip => "gz",
            Self::Zstd => "zst",
            Self::Bzip2 => "bz2",
            Self::Xz => "xz",
            Self::Lz4 => "lz4",
        }
    }

    /// What the file that starts with `head` is packed with.
    pub fn detect(head: &[u8]) -> Option<Self> {
        Self::ALL.into_iter().find(|compression| compression.starts(head))
    }

    fn starts(self, head: &[u8]) -> bool {
        match self {
            Self::Gzip => head.starts_with(b"\x1f\x8b\x08"),
            Self::Zstd => match head {
                // A frame, or a skippable one: seekable and parallel writers put those first.
                [0x28, 0xb5, 0x2f, 0xfd, ..] | [0x50..=0x5f, 0x2a, 0x4d, 0x18, ..] => true,
                _ => false,
            },
            Self::Bzip2 => match head {
                // `BZh9` alone might start a text: the first block's mark, or that of the end, must follow.
                [b'B', b'Z', b'h', b'1'..=b'9', mark @ ..] => {
                    let agrees = |block: &[u8; 6]| mark.iter().zip(block).all(|(a, b)| a == b);
                    agrees(b"\x31\x41\x59\x26\x53\x59") || agrees(b"\x17\x72\x45\x38\x50\x90")
                }
                _ => false,
            },
            Self::Xz => head.starts_with(b"\xfd7zXZ\0"),
            Self::Lz4 => head.starts_with(b"\x04\x22\x4d\x18"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn magic_bytes_decide() {
        let rows: [(&[u8], Option<Compression>); 9] = [
            (b"\x1f\x8b\x08\0", Some(Compression::Gzip)),
            (b"\x28\xb5\x2f\xfd", Some(Compression::Zstd)),
            (b"\x5e\x2a\x4d\x18", Some(Compression::Zstd)),
            (b"BZh91AY&SY", Some(Compression::Bzip2)),
            (b"BZh9\x17\x72\x45\x38\x50\x90", Some(Compression::Bzip2)),
            (b"\xfd7zXZ\0", Some(Compression::Xz)),
            (b"\x04\x22\x4d\x18", Some(Compression::Lz4)),
            (b"BZh9 elements", None),
            (b"", None),
        ];
        for (head, expected) in rows {
            assert_eq!(Compression::detect(head), expected, "{}", head.escape_ascii());
        }
    }

    #[test]
    fn a_text_that_starts_like_bzip2_is_a_text() {
        assert_eq!(Compression::detect(b"BZh1\n*NODE"), None);
    }
}
