//! The dictionary `FoamFile` that every file of OpenFOAM begins with: what the file holds, and how numbers are written.

use crate::error::{Error, Result};
use crate::formats::HEAD_BYTES;
use crate::formats::binary::Endian;
use crate::input::{Source, Spot};

/// How the numbers of a file are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Header {
    pub(super) binary: bool,
    /// Faces are two lists: where each begins, and all their points.
    pub(super) compact: bool,
    pub(super) endian: Endian,
    /// Bytes of a label and of a scalar: 4 or 8.
    pub(super) label: u64,
    pub(super) scalar: u64,
    /// The byte after the header.
    pub(super) end: u64,
}

/// Keys and values, quotes removed, as they stand.
struct Entries<'t> {
    rows: Vec<(&'t [u8], Vec<u8>)>,
    end: usize,
}

/// Whether a file is one of those that cells follow from.
pub(super) fn is_of_mesh(head: &[u8]) -> bool {
    let Some(entries) = entries(head) else { return false };
    let object =
        entries.get(b"object").map(|value| super::unpacked(std::str::from_utf8(value).unwrap_or("")));
    let lists = [&b"faceList"[..], b"faceCompactList"];
    object.is_some_and(|name| super::LISTS.contains(&name))
        || entries.get(b"class").is_some_and(|class| lists.contains(&class))
}

/// Reads the header of a file.
pub(super) fn read(source: &Source) -> Result<Header> {
    let head = source.peek(0..HEAD_BYTES as u64);
    let Some(entries) = entries(head) else {
        let at = after_comments(head, 0).unwrap_or(head.len());
        return Err(source.malformed_text(at as u64, "a header FoamFile { ... }"));
    };
    let refuse = |key: &str, expected: &str, value: &[u8]| {
        let error = Error::malformed(format!("{key} {expected}"), value.escape_ascii().to_string());
        source.place(error, Spot::Text(0))
    };
    let format = entries.get(b"format").unwrap_or(b"ascii");
    let binary = match format {
        b"ascii" => false,
        b"binary" => true,
        other => return Err(refuse("format", "ascii or binary", other)),
    };
    let compact = entries.get(b"class") == Some(b"faceCompactList");
    let mut header =
        Header { binary, compact, endian: Endian::Little, label: 4, scalar: 8, end: entries.end as u64 };
    // Files without `arch` are from machines and times where this was all that there was.
    if let Some(arch) = entries.get(b"arch") {
        for word in arch.split(|&b| b == b';') {
            match word.trim_ascii() {
                b"LSB" => header.endian = Endian::Little,
                b"MSB" => header.endian = Endian::Big,
                b"label=32" => header.label = 4,
                b"label=64" => header.label = 8,
                b"scalar=32" => header.scalar = 4,
                b"scalar=64" => header.scalar = 8,
                _ => return Err(refuse("arch", "as \"LSB;label=32;scalar=64\"", arch)),
            }
        }
    }
    Ok(header)
}

impl Entries<'_> {
    fn get(&self, key: &[u8]) -> Option<&[u8]> {
        self.rows.iter().find(|row| row.0 == key).map(|row| &row.1[..])
    }
}

/// The entries of the dictionary `FoamFile`, if the text begins with one and it ends.
fn entries(head: &[u8]) -> Option<Entries<'_>> {
    const NAME: &[u8] = b"FoamFile";
    let mut at = after_comments(head, 0)?;
    if !head[at..].starts_with(NAME) {
        return None;
    }
    at = after_comments(head, at + NAME.len())?;
    if head.get(at) != Some(&b'{') {
        return None;
    }
    at += 1;
    let mut rows = Vec::new();
    loop {
        at = after_comments(head, at)?;
        if head.get(at) == Some(&b'}') {
            return Some(Entries { rows, end: at + 1 });
        }
        let word = head[at..].iter().position(|b| b.is_ascii_whitespace() || *b == b';')?;
        let key = &head[at..at + word];
        at += word;
        let (mut value, mut quoted) = (Vec::new(), false);
        loop {
            match *head.get(at)? {
                b'"' => quoted = !quoted,
                b';' if !quoted => break,
                byte => value.push(byte),
            }
            at += 1;
        }
        at += 1;
        rows.push((key, value.trim_ascii().to_vec()));
    }
}

/// The first byte from `at` on that is neither blank nor in a comment; a script's first line is one, too.
fn after_comments(text: &[u8], mut at: usize) -> Option<usize> {
    loop {
        at += text[at..].iter().position(|b| !b.is_ascii_whitespace())?;
        let rest = &text[at..];
        let len = if rest.starts_with(b"//") || (at == 0 && rest.starts_with(b"#!")) {
            memchr::memchr(b'\n', rest)?
        } else if rest.starts_with(b"/*") {
            memchr::memmem::find(rest, b"*/")? + 2
        } else {
            return Some(at);
        };
        at += len;
    }
}
