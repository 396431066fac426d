//! COMSOL Multiphysics' native text (`.mphtxt`) and binary (`.mphbin`) files: a list of objects, of which those of the
//! class `Mesh` are read, in the versions 1, 2, 4 and 8 of the class, and selections are passed over.

mod entities;
mod layouts;
mod object;
mod reader;
#[cfg(test)]
mod tests;
mod types;

use crate::error::Result;
use crate::formats::binary::Endian;
use crate::formats::words::Words;
use crate::formats::{Format, Outline};
use crate::input::Input;
use layouts::Encoding;
use reader::Reader;

/// COMSOL's files of meshes.
pub(super) struct Comsol;

impl Format for Comsol {
    fn name(&self) -> &'static str {
        "comsol"
    }

    fn title(&self) -> &'static str {
        "COMSOL Multiphysics .mphtxt and .mphbin: meshes of class version 1, 2, 4 and 8"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["mphtxt", "mphbin"]
    }

    fn looks_for(&self) -> &'static str {
        "COMSOL's file version 0 1 and a list of tags, in text or binary"
    }

    fn detect(&self, head: &[u8]) -> bool {
        is_binary(head) || is_text(head)
    }

    fn regions(&self) -> Option<&'static str> {
        Some("domains, boundaries, edges and points of the geometry")
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        // No text has bytes of zero.
        let start = input.source.peek(0..4);
        let encoding = if start == [0; 4] { Encoding::Binary } else { Encoding::Text };
        let mark = if start.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len() as u64 } else { 0 };
        object::outline(Reader::new(input, encoding, mark), out)
    }
}

const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// `0 1`, the number of tags, then a tag as its length and itself.
fn is_text(head: &[u8]) -> bool {
    let mut words = Words::new(0, head.strip_prefix(BYTE_ORDER_MARK).unwrap_or(head));
    let mut number = || words.integer("").ok();
    let (Some(0), Some(1), Some(1..), Some(length)) = (number(), number(), number(), number()) else {
        return false;
    };
    let tag = words.word();
    tag.first().is_some_and(u8::is_ascii_alphabetic) && tag.len() as u64 <= length
}

/// The same in binary, with a number for each character.
fn is_binary(head: &[u8]) -> bool {
    let (numbers, _) = head.as_chunks::<4>();
    let number = |k: usize| numbers.get(k).map(|raw| Endian::Little.u32(raw));
    let letter = |code: u32| u8::try_from(code).is_ok_and(|c| c.is_ascii_alphabetic());
    let printable = |code: &u32| char::from_u32(*code).is_some_and(|c| !c.is_control());
    let (Some(0), Some(1), Some(1..), Some(length)) = (number(0), number(1), number(2), number(3)) else {
        return false;
    };
    let tag: Vec<u32> = (4..).map_while(number).take(length as usize).collect();
    !tag.is_empty() && letter(tag[0]) && tag.iter().all(printable)
}
