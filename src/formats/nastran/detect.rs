//! Whether a file is a Nastran deck: it says BEGIN BULK, or has executive control, or begins with cards at once.

use super::cards;
use super::fields::Fields;
use super::grids::GRID;
use super::lines::{Cards, Line, Name, kind};
use super::{BYTE_ORDER_MARK, systems};
use crate::formats::{HEAD_BYTES, text};

/// Cards that long punch files begin with before the mesh.
const LOADS: [&[u8; 8]; 16] = [
    b"PSHELL  ",
    b"PSOLID  ",
    b"PBAR    ",
    b"PCOMP   ",
    b"MAT1    ",
    b"MAT8    ",
    b"SPC     ",
    b"SPC1    ",
    b"SPCADD  ",
    b"FORCE   ",
    b"MOMENT  ",
    b"PLOAD2  ",
    b"PLOAD4  ",
    b"TEMP    ",
    b"TEMPD   ",
    b"EIGRL   ",
];

/// Whether the head of a file is that of a deck.
pub(super) fn is_bulk_data(head: &[u8]) -> bool {
    let mut head = head.strip_prefix(BYTE_ORDER_MARK).unwrap_or(head);
    if head.len() + BYTE_ORDER_MARK.len() >= HEAD_BYTES {
        head = &head[..memchr::memrchr(b'\n', head).unwrap_or(0)];
    }
    let (mut solution, mut control, mut cards, mut odd) = (false, false, 0, head.contains(&0));
    for line in text::lines(0, head).map(|line| line.bytes) {
        match kind(line) {
            Line::Card(name) => {
                let second = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).nth(1);
                match &name {
                    b"BEGIN   " if second.is_some_and(|word| word.eq_ignore_ascii_case(b"BULK")) => {
                        return true;
                    }
                    b"SOL     " => solution |= second.is_some(),
                    b"CEND    " => control = true,
                    _ => cards += usize::from(is_card(&name, line)),
                }
            }
            Line::Stray => odd = true,
            Line::Continuation | Line::Replication => odd |= cards == 0,
            Line::Blank => {}
        }
    }
    (solution && control) || (cards > 0 && !odd)
}

/// Whether a line is the first of a card that is known, with the numbers that belong there.
fn is_card(name: &Name, line: &[u8]) -> bool {
    let mut fields = Fields::new();
    if fields.read(line, &mut Cards::new(&[]), 0).is_err() || fields.positive(0, "").is_err() {
        return false;
    }
    let numbers = |range: std::ops::Range<usize>| range.into_iter().all(|k| fields.positive(k, "").is_ok());
    match name {
        GRID => fields.optional(1, "").is_ok() && fields.point(2).is_ok(),
        _ if systems::is_known(name) => fields.optional(1, "").is_ok(),
        _ => match cards::element(name) {
            Some(cards::Card::Measured(card)) => numbers(card.first..card.first + 2),
            Some(cards::Card::Counted(card)) => {
                card.nodes.first().is_some_and(|&k| fields.positive(k.into(), "").is_ok())
            }
            None => LOADS.contains(&name),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decks_are_told_from_their_likes() {
        let rows: &[(&[u8], bool)] = &[
            (b"SOL 101\nCEND\nTITLE=a deck\nBEGIN BULK\nENDDATA\n", true),
            (b"$ note\r\nsol 101\r\ncend\r\n  SUBCASE 1\r\n", true),
            (b"begin bulk $ note\n", true),
            (b"\xef\xbb\xbfGRID,1,,0.,0.,0.\n", true),
            (b"$ Created by Gmsh\nGRID    1       0       0.00E+000.00E+001.000000\n", true),
            (b"GRID*   1                               1.              2.\n*       3.\n", true),
            (b"CTETRA\t1\t1\t5\t6\t7\t8\n", true),
            (b"PLOAD4       103  131001    .001\n", true),
            (b"GRID x y\n", false),
            (b"GRID    1       0       zero\n", false),
            (b"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", false),
            (b"*NODE\n1,0.,0.,0.\n", false),
            (b"$# LS-DYNA\n*KEYWORD\n*NODE\n", false),
            (b"/PREP7\nET,1,185\n", false),
            (b"    -1\n  2411\n", false),
            (b"$TITLE\nM100 case\n$POINTS\n1.\n", false),
            (b"solid cube\nfacet normal 0 0 1\n", false),
            (b"CEND\n", false),
            (b"BEGIN OBJECT\n", false),
            (b"GRID,1,,0.,0.,0.\0", false),
            (b"", false),
        ];
        for (head, deck) in rows {
            assert_eq!(is_bulk_data(head), *deck, "{}", head.escape_ascii());
        }
    }
}
