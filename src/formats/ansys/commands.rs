//! Command lines, and the Fortran formats that follow those of blocks.

use crate::error::{Error, Result, excerpt};
use crate::formats::text;

/// Longest name of a command.
const LONGEST: usize = 8;

/// A command line: a name and its arguments, parted by commas.
pub(super) struct Command<'l> {
    name: [u8; LONGEST],
    len: usize,
    arguments: &'l [u8],
}

impl<'l> Command<'l> {
    pub(super) fn new(line: &'l [u8]) -> Self {
        let line = line.trim_ascii_start();
        let end = line.iter().take(LONGEST + 1).position(|b| *b == b',').unwrap_or(0);
        let mut name = [0; LONGEST];
        let given = line[..end].trim_ascii();
        name[..given.len()].copy_from_slice(given);
        name.make_ascii_uppercase();
        Self { name, len: given.len(), arguments: line.get(end + 1..).unwrap_or_default() }
    }

    /// In capitals; empty where the line has no command with arguments that could matter.
    pub(super) fn name(&self) -> &[u8] {
        &self.name[..self.len]
    }

    /// The argument number `k`, from 0, without blanks and comment.
    pub(super) fn argument(&self, k: usize) -> &'l [u8] {
        let text = self.arguments.split(|b| *b == b'!').next().unwrap_or_default();
        text.split(|b| *b == b',').nth(k).unwrap_or_default().trim_ascii()
    }
}

/// Whether the rows of an `EBLOCK` are those of solids, with eleven numbers before the nodes, or short ones.
pub(super) fn elements_follow(command: &Command<'_>) -> Result<bool> {
    let key = command.argument(1);
    if key.eq_ignore_ascii_case(b"SOLID") {
        Ok(true)
    } else if key.is_empty() {
        Ok(false)
    } else if key.eq_ignore_ascii_case(b"COMPACT") {
        Err(Error::unsupported("compact EBLOCKs are not read: write the archive with the key SOLID"))
    } else {
        Err(Error::malformed("EBLOCK with the key SOLID or none", excerpt(key)))
    }
}

/// A Fortran format: integers, then reals.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Edit {
    /// Number of integers.
    pub(super) count: usize,
    /// Columns of an integer.
    pub(super) width: usize,
    /// Columns of a real; 0 where the format has none.
    pub(super) real_width: usize,
}

impl Edit {
    /// Reads `(3i9,6e21.13e3)`, `(19i10)` or `(2i9,19a9)`.
    pub(super) fn read(line: &[u8]) -> Option<Self> {
        let line = line.trim_ascii().strip_prefix(b"(")?;
        let inner = &line[..line.iter().position(|b| *b == b')')?];
        let mut parts = inner.split(|b| *b == b',');
        let (count, letter, width) = repeated(parts.next()?.trim_ascii())?;
        if letter != b'I' {
            return None;
        }
        let real_width = match parts.next() {
            None => 0,
            Some(part) => match repeated(part.trim_ascii())? {
                (_, b'E' | b'F' | b'G' | b'D', width) => width,
                _ => 0,
            },
        };
        Some(Self { count, width, real_width })
    }
}

/// `6e21.13e3` as 6, E and 21.
fn repeated(part: &[u8]) -> Option<(usize, u8, usize)> {
    const WIDEST: u64 = 64;
    let letter = part.iter().position(u8::is_ascii_alphabetic)?;
    let count = if letter == 0 { 1 } else { text::integer(&part[..letter])? };
    let width = part[letter + 1..].split(|b| !b.is_ascii_digit()).next().and_then(text::integer)?;
    let sound = (1..=WIDEST).contains(&count) && (1..=WIDEST).contains(&width);
    sound.then_some((count as usize, part[letter].to_ascii_uppercase(), width as usize))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_of_real_archives() {
        let edit = |count, width, real_width| Some(Edit { count, width, real_width });
        for (text, expected) in [
            ("(3i8,6e16.9)", edit(3, 8, 16)),
            ("(3i9,6e21.13e3)", edit(3, 9, 21)),
            ("(1i9,3e20.9e3)  ", edit(1, 9, 20)),
            ("(19i10)", edit(19, 10, 0)),
            ("(2i9,19a9)", edit(2, 9, 0)),
            ("(19i0)", None),
            ("(99999999999i10)", None),
            ("(e21)", None),
            ("19i10", None),
            ("", None),
        ] {
            assert_eq!(Edit::read(text.as_bytes()), expected, "{text}");
        }
    }

    #[test]
    fn commands_and_their_arguments() {
        let command = Command::new(b" et,  2 , SOLID185 ! a brick");
        assert_eq!(command.name(), b"ET");
        assert_eq!((command.argument(0), command.argument(1)), (&b"2"[..], &b"SOLID185"[..]));
        assert_eq!(command.argument(2), b"");
        for line in [&b""[..], b"FINISH", b"averylongname,1", b",", b"!"] {
            assert_eq!(Command::new(line).name(), b"");
        }
    }
}
