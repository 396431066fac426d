//! An array of a file: text, base64 or appended, and perhaps compressed.

use super::super::ascii;
use super::super::markup::Tag;
use super::super::payload::{Bytes, unpack_blocks};
use super::super::role::Role;
use super::attributes::count;
use super::document::Document;
use crate::error::{Error, Result};
use crate::formats::array::{Number, Origin, Stored, Unpacked, check_fits};
use crate::input::{Input, Spot};

/// An array as its tag describes it.
pub(super) struct DataArray {
    at: u64,
    number: Number,
    place: Place,
}

enum Place {
    Text(u64),
    Base64(u64),
    Appended(u64),
}

/// The type of numbers that the file calls `name`.
fn number(name: &str) -> Option<Number> {
    Some(match name {
        "Int8" => Number::I8,
        "UInt8" => Number::U8,
        "Int16" => Number::I16,
        "UInt16" => Number::U16,
        "Int32" => Number::I32,
        "UInt32" => Number::U32,
        "Int64" => Number::I64,
        "UInt64" => Number::U64,
        "Float32" => Number::F32,
        "Float64" => Number::F64,
        _ => return None,
    })
}

impl DataArray {
    /// The array that a tag describes.
    pub(super) fn of(input: &Input, tag: &Tag, role: Role) -> Result<Self> {
        let source = &input.source;
        let kind = tag.attribute(source, "type")?.unwrap_or_default();
        let Some(number) = number(&kind).filter(|number| role.allows(*number)) else {
            return Err(source.malformed_text(tag.at, format!("a type of numbers for {}", role.name())));
        };
        let place = match tag.attribute(source, "format")?.as_deref() {
            Some("appended") => Place::Appended(count(input, tag, "offset")?),
            Some("ascii") => Place::Text(tag.end),
            Some("binary") => Place::Base64(tag.end),
            _ => return Err(source.malformed_text(tag.at, "the attribute format: ascii, binary or appended")),
        };
        Ok(Self { at: tag.at, number, place })
    }

    /// Finds the array's numbers, or unpacks them; there must be `count`, where that is known.
    pub(super) fn unpack(
        &self,
        input: &Input,
        document: &Document,
        role: Role,
        count: Option<u64>,
        out: &mut Unpacked<'_>,
    ) -> Result<Stored> {
        let done = self.find(input, document, role, count, out);
        done.map_err(|error| input.source.place(error, Spot::Text(self.at)))
    }

    fn find(
        &self,
        input: &Input,
        document: &Document,
        role: Role,
        count: Option<u64>,
        out: &mut Unpacked<'_>,
    ) -> Result<Stored> {
        let source = &input.source;
        let mut bytes = match (&self.place, document.appended) {
            (Place::Text(at), _) => {
                return Ok(ascii::unpack(input, *at..source.len(), count, role, self.number, out)?.0);
            }
            (Place::Base64(at), _) => Bytes::base64(source, *at),
            (Place::Appended(offset), Some(appended)) => {
                let at = appended.at.saturating_add(*offset);
                if appended.is_base64 { Bytes::base64(source, at) } else { Bytes::raw(source, at) }
            }
            (Place::Appended(_), None) => return Err(Error::malformed("appended data", "none")),
        };
        let (number, endian, width) = (self.number, document.header.endian, self.number.width());
        let expected = count.map(|count| count.saturating_mul(width));
        let mut stored = Stored { origin: Origin::Tag(self.at), at: out.len(), number, endian, count: 0 };
        if let Some(compressor) = document.compressor {
            unpack_blocks(input, &mut bytes, document.header, compressor, expected, out)?;
            stored.count = whole(out.len() - stored.at, width)?;
            return Ok(stored);
        }
        let len = bytes.number(document.header)?;
        if expected.is_some_and(|expected| expected != len) {
            return Err(wrong_len(expected.unwrap_or(0), role, len));
        }
        stored.count = whole(len, width)?;
        if bytes.is_base64() {
            bytes.copy(len, out)?;
        } else {
            stored = Stored { origin: Origin::File, at: bytes.position(), ..stored };
            check_fits(source, &stored, role.name())?;
        }
        Ok(stored)
    }
}

fn wrong_len(expected: u64, role: Role, found: u64) -> Error {
    Error::malformed(format!("{expected} bytes of {}", role.name()), format!("{found} bytes"))
}

/// Number of numbers in so many bytes.
fn whole(bytes: u64, width: u64) -> Result<u64> {
    if bytes.is_multiple_of(width) {
        return Ok(bytes / width);
    }
    Err(Error::malformed(format!("an array of numbers of {width} bytes"), format!("{bytes} bytes")))
}
