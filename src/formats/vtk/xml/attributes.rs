//! What attributes of tags say: numbers, the places of a uniform grid, where appended data begin.

use super::super::markup::Tag;
use crate::error::Result;
use crate::formats::text;
use crate::input::Input;

/// Where appended data start, after the `_`.
#[derive(Clone, Copy)]
pub(super) struct Appended {
    pub(super) at: u64,
    pub(super) is_base64: bool,
}

impl Appended {
    /// Appended data start after an underscore. Nobody can tell where they end but by the end of the file.
    pub(super) fn find(input: &Input, tag: &Tag) -> Result<Self> {
        let source = &input.source;
        let is_base64 = match tag.attribute(source, "encoding")?.as_deref() {
            Some("raw") => false,
            Some("base64") => true,
            _ => return Err(source.malformed_text(tag.at, "the attribute encoding, \"raw\" or \"base64\"")),
        };
        let head = source.peek(tag.end..tag.end + 4096);
        let blanks = head.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
        if head.get(blanks) != Some(&b'_') {
            return Err(source.malformed_text(tag.end + blanks as u64, "_ before the appended data"));
        }
        let tail = source.peek(source.len().saturating_sub(4096)..source.len());
        if !tail.trim_ascii_end().ends_with(b"</VTKFile>") {
            return Err(source.truncated("</VTKFile>"));
        }
        Ok(Self { at: tag.end + blanks as u64 + 1, is_base64 })
    }
}

/// Origin, spacing and the directions of the axes of a uniform grid.
#[derive(Clone, Copy)]
pub(super) struct Uniform {
    pub(super) origin: [f64; 3],
    pub(super) spacing: [f64; 3],
    /// Row after row; the axes are its columns.
    pub(super) direction: [f64; 9],
}

impl Default for Uniform {
    fn default() -> Self {
        let direction = [1., 0., 0., 0., 1., 0., 0., 0., 1.];
        Self { origin: [0.0; 3], spacing: [1.0; 3], direction }
    }
}

impl Uniform {
    /// What the tag of a uniform grid says.
    pub(super) fn read(&mut self, input: &Input, tag: &Tag) -> Result<()> {
        numbers(input, tag, "Origin", &mut self.origin, text::real)?;
        numbers(input, tag, "Spacing", &mut self.spacing, text::real)?;
        numbers(input, tag, "Direction", &mut self.direction, text::real)?;
        Ok(())
    }
}

/// The numbers of an attribute; whether it is there.
pub(super) fn numbers<T, const N: usize>(
    input: &Input,
    tag: &Tag,
    name: &str,
    out: &mut [T; N],
    read: impl Fn(&[u8]) -> Option<T>,
) -> Result<bool> {
    let Some(value) = tag.attribute(&input.source, name)? else { return Ok(false) };
    let mut words = value.split_ascii_whitespace();
    for number in out {
        let found = words.next().and_then(|word| read(word.as_bytes()));
        *number = found.ok_or_else(|| {
            input.source.malformed_text(tag.at, format!("{N} numbers in the attribute {name}"))
        })?;
    }
    Ok(true)
}

/// The attribute `name`, a number.
pub(super) fn count(input: &Input, tag: &Tag, name: &str) -> Result<u64> {
    let value = tag.attribute(&input.source, name)?;
    let count = value.and_then(|value| text::integer(value.as_bytes()));
    count.ok_or_else(|| input.source.malformed_text(tag.at, format!("the attribute {name}, a number")))
}
