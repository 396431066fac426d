//! Lines of bulk data: what each one is, and the cards that they make.

/// A card's name in capitals, filled up with blanks.
pub(super) type Name = [u8; 8];

/// What a line is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Line {
    /// Nothing but blanks or a comment.
    Blank,
    /// The first line of a card.
    Card(Name),
    /// Goes on with the card before: its first field is blank, `+`, `*`, or either with a name.
    Continuation,
    /// `=`: fields of the card before, once more.
    Replication,
    /// Something else.
    Stray,
}

/// What a line is, without its end.
#[inline]
pub(super) fn kind(line: &[u8]) -> Line {
    let Some(first) = line.iter().position(|b| *b != b' ') else { return Line::Blank };
    match line[first] {
        // A DOS end of file may stand on the last line.
        b'$' | 0x1a => Line::Blank,
        b'\t' => match line[first..].trim_ascii_start() {
            [] | [b'$', ..] => Line::Blank,
            _ => Line::Continuation,
        },
        b'+' | b'*' | b',' => Line::Continuation,
        b'=' => Line::Replication,
        _ if first >= 8 => Line::Continuation,
        b if b.is_ascii_alphabetic() => Line::Card(name(&line[first..])),
        _ => Line::Stray,
    }
}

/// The letters and digits that `text` begins with.
fn name(text: &[u8]) -> Name {
    let mut name = [b' '; 8];
    for (to, from) in name.iter_mut().zip(text) {
        if !from.is_ascii_alphanumeric() {
            break;
        }
        *to = from.to_ascii_uppercase();
    }
    name
}

/// Goes through the cards of a stretch.
#[derive(Debug)]
pub(super) struct Cards<'w> {
    bytes: &'w [u8],
    /// The next line starts here.
    next: usize,
    /// The card at hand starts here.
    pub(super) at: usize,
}

impl<'w> Cards<'w> {
    pub(super) fn new(bytes: &'w [u8]) -> Self {
        Self { bytes, next: 0, at: 0 }
    }

    /// Name and first line of the next card.
    #[inline]
    pub(super) fn next_card(&mut self) -> Option<(Name, &'w [u8])> {
        loop {
            let at = self.next;
            let line = self.line()?;
            if let Line::Card(name) = kind(line) {
                self.at = at;
                return Some((name, line));
            }
        }
    }

    /// The next line of the card at hand.
    #[inline]
    pub(super) fn continuation(&mut self) -> Option<&'w [u8]> {
        loop {
            let at = self.next;
            let line = self.line()?;
            match kind(line) {
                Line::Blank => {}
                Line::Continuation => return Some(line),
                _ => {
                    self.next = at;
                    return None;
                }
            }
        }
    }

    #[inline]
    fn line(&mut self) -> Option<&'w [u8]> {
        let rest = self.bytes.get(self.next..).filter(|rest| !rest.is_empty())?;
        let len = memchr::memchr(b'\n', rest).unwrap_or(rest.len());
        self.next += len + 1;
        let line = &rest[..len];
        Some(line.strip_suffix(b"\r").unwrap_or(line))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_told_apart() {
        let rows: &[(&str, Line)] = &[
            ("", Line::Blank),
            ("   \t ", Line::Blank),
            ("            $ note", Line::Blank),
            ("\t$ note", Line::Blank),
            ("\x1a", Line::Blank),
            ("GRID    1", Line::Card(*b"GRID    ")),
            ("grid*,1", Line::Card(*b"GRID    ")),
            ("  CTETRA,1", Line::Card(*b"CTETRA  ")),
            ("PRTMAXIM YES", Line::Card(*b"PRTMAXIM")),
            ("include'x'", Line::Card(*b"INCLUDE ")),
            ("+E1     5", Line::Continuation),
            ("*       5", Line::Continuation),
            (",5", Line::Continuation),
            (" , 5", Line::Continuation),
            ("        5", Line::Continuation),
            ("\t5", Line::Continuation),
            ("            ENDT", Line::Continuation),
            ("=,*(1),==", Line::Replication),
            ("7,8", Line::Stray),
        ];
        for (text, expected) in rows {
            assert_eq!(kind(text.as_bytes()), *expected, "{text:?}");
        }
    }

    #[test]
    fn continuations_belong_to_their_card() {
        let mut cards = Cards::new(b"+stray\nGRID,1\r\n$\n\n,2\n+,3\nMAT1\n,4\nGRID,5\n,6");
        assert_eq!(cards.next_card(), Some((*b"GRID    ", &b"GRID,1"[..])));
        assert_eq!(cards.at, 7);
        assert_eq!(cards.continuation(), Some(&b",2"[..]));
        assert_eq!(cards.continuation(), Some(&b"+,3"[..]));
        assert_eq!(cards.continuation(), None);
        assert_eq!(cards.next_card(), Some((*b"MAT1    ", &b"MAT1"[..])));
        assert_eq!(cards.next_card(), Some((*b"GRID    ", &b"GRID,5"[..])));
        assert_eq!(cards.continuation(), Some(&b",6"[..]));
        assert_eq!((cards.continuation(), cards.next_card()), (None, None));
    }
}
