//! Whether a file is an Abaqus deck. LS-DYNA writes keyword lines with stars too: there `$` begins a comment, names
//! have underscores, parameters stand on lines of their own, and numbers in columns.

use super::keywords::{BYTE_ORDER_MARK, plain};

/// Keywords that decks begin with, without blanks.
const KNOWN: [&str; 22] = [
    "HEADING",
    "PREPRINT",
    "INCLUDE",
    "PART",
    "ASSEMBLY",
    "NODE",
    "ELEMENT",
    "NSET",
    "ELSET",
    "MATERIAL",
    "ELASTIC",
    "SURFACE",
    "STEP",
    "SYSTEM",
    "NGEN",
    "ENDPART",
    "USERELEMENT",
    "SOLIDSECTION",
    "SHELLSECTION",
    "NODEPRINT",
    "RESTART",
    "BOUNDARY",
];

/// Whether the head of a file is that of a deck.
pub(super) fn is_abaqus(head: &[u8]) -> bool {
    if is_utf16(head) {
        // Known for what it is, to be refused with its reason.
        let narrow: Vec<u8> = head.iter().copied().filter(|b| b.is_ascii() && *b != 0).collect();
        return looks_like_deck(&narrow);
    }
    looks_like_deck(head.strip_prefix(BYTE_ORDER_MARK).unwrap_or(head))
}

/// Whether text has two bytes a character.
pub(super) fn is_utf16(head: &[u8]) -> bool {
    head.starts_with(b"\xff\xfe")
        || head.starts_with(b"\xfe\xff")
        || matches!(head, [0, b, ..] | [b, 0, ..] if *b != 0)
}

fn is_number(line: &[u8]) -> bool {
    line.iter().all(u8::is_ascii_digit)
}

fn looks_like_deck(head: &[u8]) -> bool {
    let mut lines = head.split(|b| *b == b'\n').map(<[u8]>::trim_ascii);
    let mut lines = lines.by_ref().filter(|line| !line.is_empty() && !line.starts_with(b"**")).peekable();
    let mut known = false;
    let mut first = true;
    while let Some(line) = lines.next() {
        if line.starts_with(b"$") {
            return false;
        }
        if !line.starts_with(b"*") {
            if first {
                return false;
            }
            continue;
        }
        first = false;
        let mut fields = line[1..].split(|b| *b == b',');
        let name = plain(fields.next().unwrap_or_default());
        let has_parameter = |p: &str| fields.clone().any(|f| plain(f).starts_with(p));
        if name == "KEYWORD" || name.contains('_') || !name.starts_with(|c: char| c.is_ascii_alphabetic()) {
            return false;
        }
        let next = lines.peek().copied().unwrap_or(b"*");
        known |= KNOWN.contains(&name.as_str())
            && match name.as_str() {
                // A node at the origin may be a number alone; in LS-DYNA coordinates stand beside it.
                "NODE" if !(next.starts_with(b"*") || next.contains(&b',') || is_number(next)) => {
                    return false;
                }
                "PART" | "ASSEMBLY" => has_parameter("NAME="),
                "INCLUDE" => has_parameter("INPUT="),
                "ELEMENT" => has_parameter("TYPE=") || line.ends_with(b","),
                _ => true,
            };
    }
    known
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decks_are_told_from_their_likes() {
        let rows: &[(&[u8], bool)] = &[
            (b"*HEADING\nanything\n", true),
            (b"\r\n** made by hand\r\n  *Node, nset=all\r\n1, 0.\r\n", true),
            (b"\xef\xbb\xbf*NODE\n1, 0., 0.", true),
            (b"*NODE, INPUT=nodes.inp\n*ELEMENT, TYPE=S4, INPUT=e.inp", true),
            (b"*INCLUDE, INPUT=mesh.inp\n", true),
            (b"*Part, name=P\n*End Part", true),
            (b"*NODE\n1\n2, 10.\n", true),
            (b"*NODE\n       1 0.0 0.0 0.0\n", false),
            (b"*NODE\n$ comment\n1, 0., 0.\n", false),
            (b"$# LS-DYNA\n*KEYWORD\n*NODE\n1, 0, 0, 0\n", false),
            (b"*KEYWORD\n*NODE\n1, 0, 0, 0\n", false),
            (b"*NODE\n1, 0, 0, 0\n*ELEMENT_SOLID\n", false),
            (b"*PART\nboxshell\n", false),
            (b"*INCLUDE\nmesh.k\n", false),
            (b"25 20 0 0 0\n1 2 3\n", false),
            (b"/PREP7\n*SET,A,1\n", false),
            (b"*SET,A,1\n*ENDIF\n", false),
            (b"** only comments\n", false),
            (b"", false),
            (b"*", false),
        ];
        for (head, deck) in rows {
            assert_eq!(is_abaqus(head), *deck, "{}", head.escape_ascii());
            let wide: Vec<u8> = head.iter().flat_map(|b| [*b, 0]).collect();
            assert_eq!(is_abaqus(&wide), *deck, "UTF-16 of {}", head.escape_ascii());
        }
    }
}
