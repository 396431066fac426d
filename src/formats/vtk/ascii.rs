//! Arrays that are written as text, unpacked to binary numbers.

use std::ops::Range;

use crate::error::Result;
use crate::formats::binary::Endian;
use crate::formats::text::{self, LineReader};
use crate::input::Input;

use super::role::Role;
use crate::formats::array::{Number, Origin, Stored, Unpacked};

/// Unpacks the `count` numbers between blanks at the start of `range`, or as many as stand before the next `<` where
/// there is no count. Gives the array and the byte at which it ended.
pub fn unpack(
    input: &Input,
    range: Range<u64>,
    count: Option<u64>,
    role: Role,
    declared: Number,
    out: &mut Unpacked<'_>,
) -> Result<(Stored, u64)> {
    let number = role.unpacked(declared);
    let (from, at) = (range.start, out.len());
    let most = count.unwrap_or(u64::MAX);
    let what = if role == Role::Mark { "a number" } else { "a coordinate" };
    let end = match number {
        Number::F32 => run(input, range, most, what, out, |token| {
            let value = fast_float2::parse::<f32, _>(token).ok();
            value.or_else(|| text::real(token).map(|v| v as f32)).map(f32::to_le_bytes)
        }),
        Number::F64 => run(input, range, most, what, out, |token| text::real(token).map(f64::to_le_bytes)),
        Number::U8 => run(input, range, most, "a cell type (0 to 255)", out, |token| {
            text::integer(token).and_then(|v| u8::try_from(v).ok()).map(u8::to_le_bytes)
        }),
        Number::U32 => run(input, range, most, "a point's number (0 to 4294967295)", out, |token| {
            text::integer(token).and_then(|v| u32::try_from(v).ok()).map(u32::to_le_bytes)
        }),
        _ => run(input, range, most, "a whole number, 0 or more", out, |token| {
            text::integer(token).map(u64::to_le_bytes)
        }),
    }?;
    let found = (out.len() - at) / number.width();
    if let Some(count) = count.filter(|count| *count != found) {
        let expected = format!("{count} numbers ({}), of which {found} are there", role.name());
        return Err(input.source.malformed_text(end, expected));
    }
    let origin = Origin::Text { from, base: at };
    Ok((Stored { origin, at, number, endian: Endian::Little, count: found }, end))
}

/// Unpacks up to `most` numbers as `convert` says; gives the byte after the last one, or of the `<` or the end.
fn run<const N: usize>(
    input: &Input,
    range: Range<u64>,
    most: u64,
    what: &str,
    out: &mut Unpacked<'_>,
    convert: impl Fn(&[u8]) -> Option<[u8; N]>,
) -> Result<u64> {
    let mut left = most;
    let mut buffer = Vec::new();
    tokens(input, range, |at, token| {
        if left == 0 || token[0] == b'<' {
            return Ok(false);
        }
        match convert(token) {
            Some(bytes) => buffer.extend_from_slice(&bytes),
            None => {
                let number = most - left + 1;
                let of = if most == u64::MAX { String::new() } else { format!(" of {most}") };
                return Err(input.source.malformed_text(at, format!("{what} as number {number}{of}")));
            }
        }
        if buffer.len() >= 1 << 16 {
            out.write(&buffer)?;
            buffer.clear();
        }
        left -= 1;
        Ok(true)
    })
    .and_then(|end| out.write(&buffer).map(|()| end))
}

/// Goes over `count` tokens that are not needed; gives the byte after the last one.
pub fn skip(input: &Input, range: Range<u64>, count: u64) -> Result<u64> {
    let mut left = count;
    let end = tokens(input, range, |_, _| {
        let more = left > 0;
        left = left.saturating_sub(1);
        Ok(more)
    })?;
    if left > 0 {
        return Err(input.source.malformed_text(end, format!("{left} more values")));
    }
    Ok(end)
}

/// Goes over `count` lines after the one of byte `at`; gives the byte after the last one.
pub fn skip_lines(input: &Input, at: u64, count: u64) -> Result<u64> {
    let mut lines = LineReader::new(&input.source, &input.limits, at);
    lines.next_line()?;
    for left in (1..=count).rev() {
        if lines.next_line()?.is_none() {
            return Err(input.source.malformed_text(lines.position(), format!("{left} more lines")));
        }
    }
    Ok(lines.position())
}

/// Calls `token` with each token of `range` and its place until it says no. Gives the place of that token, or where the
/// text ends. A `<` starts a token of its own.
fn tokens(
    input: &Input,
    range: Range<u64>,
    mut token: impl FnMut(u64, &[u8]) -> Result<bool>,
) -> Result<u64> {
    const STEP: u64 = 1 << 20;
    let end = range.end.min(input.source.len());
    let mut at = range.start;
    while at < end {
        let window = input.source.window(at..end.min(at + STEP));
        let is_last = at + window.len() as u64 == end;
        let bytes: &[u8] = &window;
        let mut i = 0;
        loop {
            while i < bytes.len() && bytes[i] <= b' ' {
                i += 1;
            }
            let start = i;
            while i < bytes.len() && bytes[i] > b' ' && (bytes[i] != b'<' || i == start) {
                i += 1;
            }
            if i == bytes.len() && !is_last {
                // The token may go on in the next window.
                i = start;
                break;
            }
            if start == i {
                break;
            }
            if !token(at + start as u64, &bytes[start..i])? {
                return Ok(at + start as u64);
            }
        }
        if i == 0 && !is_last {
            return Err(text::too_long(&input.source, "a number", STEP as usize, at));
        }
        at += i as u64;
    }
    Ok(end)
}
