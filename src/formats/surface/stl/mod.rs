//! STL, text and binary: facets that each bring their own corners. Corners with the same coordinates, to the bit, become
//! one node; the first facet has the number 0.

mod binary;
mod text;
mod weld;

use crate::error::Result;
use crate::formats::{Format, HEAD_BYTES, Outline};
use crate::input::Input;
use weld::Welder;

/// The format's row in the table of formats.
pub(in crate::formats) struct Stl;

impl Format for Stl {
    fn name(&self) -> &'static str {
        "stl"
    }

    fn title(&self) -> &'static str {
        "STL surfaces, text and binary, equal corners joined"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["stl"]
    }

    fn looks_for(&self) -> &'static str {
        "solid and facet, or 84 bytes and 50 for each facet"
    }

    fn detect(&self, head: &[u8]) -> bool {
        text::is_text(head) || binary::is_binary(head, head.len() < HEAD_BYTES)
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        let source = &input.source;
        let mut welder = Welder::new(input)?;
        // Binary files that begin with "solid" are about: the size tells, or else the zero bytes.
        let head = source.peek(0..HEAD_BYTES as u64);
        if !binary::has_size_of_binary(source) && text::begins(head) && !head.contains(&0) {
            text::read(input, &mut welder)?;
        } else {
            binary::read(source, &mut welder)?;
        }
        if welder.facets() == 0 {
            return Err(source.malformed_binary(source.len(), "one facet or more", "none"));
        }
        welder.outline(out)
    }
}
