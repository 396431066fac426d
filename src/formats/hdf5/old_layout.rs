//! Where numbers stand in files of HDF5 before 1.6.3, as MED 2 has them: the layout message had another form then, of
//! which the crate reads the second version two bytes too early.

use crate::formats::binary::Endian::Little;
use crate::input::Source;

/// Types of messages in an object's header.
const LAYOUT: u16 = 0x08;
const CONTINUATION: u16 = 0x10;
/// Most messages that are looked at; a header counts them in 16 bits.
const MOST_MESSAGES: usize = 1 << 16;

/// A layout of the old form.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum OldLayout {
    /// One run of numbers from this place on.
    Plain(u64),
    /// Chunks, or numbers in the header.
    Other,
}

/// Looks for a layout of the old form in the header of the object at `at`, where places have `width` bytes and count from
/// byte `base`. Only headers of the first version have such.
pub(super) fn find(source: &Source, base: u64, at: u64, width: u8) -> Option<OldLayout> {
    let (width, start) = (u64::from(width), base.checked_add(at)?);
    let head = source.peek(start..start.checked_add(16)?);
    if head.len() < 16 || head[0] != 1 {
        return None;
    }
    let mut parts = vec![(start + 16, u64::from(Little.u32(&head[8..])))];
    let mut left = MOST_MESSAGES;
    while let Some((mut at, len)) = parts.pop() {
        let end = at.saturating_add(len).min(source.len());
        while at + 8 <= end && left > 0 {
            left -= 1;
            let head = source.peek(at..at + 8);
            let size = u64::from(Little.u16(&head[2..]));
            let body = source.peek(at + 8..(at + 8 + size).min(end));
            match Little.u16(head) {
                LAYOUT => return layout(body, width),
                CONTINUATION => {
                    if let (Some(place), Some(len)) = (place(body, width), body.get(width as usize..)) {
                        parts.push((base.saturating_add(place), self::place(len, width).unwrap_or(0)));
                    }
                }
                _ => {}
            }
            at += 8 + size;
        }
    }
    None
}

/// Version, number of dimensions, class, five bytes that say nothing, a place.
fn layout(body: &[u8], width: u64) -> Option<OldLayout> {
    match body {
        [1 | 2, _, 1, _, _, _, _, _, rest @ ..] => place(rest, width).map(OldLayout::Plain),
        [1 | 2, ..] => Some(OldLayout::Other),
        _ => None,
    }
}

fn place(bytes: &[u8], width: u64) -> Option<u64> {
    let bytes = bytes.get(..width as usize)?;
    Some(bytes.iter().rev().fold(0, |all, byte| all << 8 | u64::from(*byte)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_place_stands_after_five_bytes_in_both_versions() {
        let body = |version| [version, 1, 1, 0, 0, 0, 0, 0, 0x5c, 0xe0, 0, 0, 0, 0, 0, 0, 4, 0, 0, 0];
        for version in [1, 2] {
            assert_eq!(layout(&body(version), 8), Some(OldLayout::Plain(57436)));
        }
        assert_eq!(layout(&body(3), 8), None);
        assert_eq!(layout(&[2, 2, 2, 0, 0, 0, 0, 0], 8), Some(OldLayout::Other));
    }
}
