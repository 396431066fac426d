//! LS-DYNA keyword decks (`.k`, `.key`).
//!
//! Cards stand in fixed columns, or free with commas, line by line as the writer likes. `*NODE`, the solids, shells and
//! thick shells are read; other elements are counted. What would move, generate or renumber nodes is refused by name.

mod cards;
mod deck;
mod keyword;
mod solids;
#[cfg(test)]
mod tests;

use crate::error::Result;
use crate::formats::columns::cut_off;
use crate::formats::{Format, Outline, text};
use crate::input::{Input, Siblings};
use deck::Deck;
use keyword::Keyword;

/// LS-DYNA keyword decks.
pub(super) struct Lsdyna;

impl Format for Lsdyna {
    fn name(&self) -> &'static str {
        "lsdyna"
    }

    fn title(&self) -> &'static str {
        "LS-DYNA keyword decks: solids, shells, thick shells; includes; degenerate bricks told by their nodes"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["k", "key", "dyn"]
    }

    fn looks_for(&self) -> &'static str {
        "keyword lines as *KEYWORD or *ELEMENT_SOLID, or *NODE before columns"
    }

    fn detect(&self, head: &[u8]) -> bool {
        let mut lines = text::lines(0, head)
            .map(|line| line.bytes)
            .filter(|line| !line.starts_with(b"$") && !line.trim_ascii().is_empty())
            .peekable();
        let mut first = true;
        while let Some(line) = lines.next() {
            if first && (!line.starts_with(b"*") || line.starts_with(b"**") || line.contains(&b',')) {
                return false;
            }
            first = false;
            if !line.starts_with(b"*") {
                continue;
            }
            let name = Keyword::read(line).name;
            // Abaqus has *NODE with parameters, *NODE PRINT, and commas.
            let columns = line[1..].trim_ascii().len() <= "NODE +".len()
                && lines.peek().is_some_and(|next| {
                    !next.contains(&b',') && next.trim_ascii_start().first().is_some_and(u8::is_ascii_digit)
                });
            let families = ["ELEMENT_", "SECTION_", "CONTROL_", "DATABASE_", "MAT_", "INITIAL_", "DEFINE_"];
            if name == "KEYWORD"
                || (name == "NODE" && columns)
                || families.iter().any(|family| name.starts_with(family))
            {
                return true;
            }
        }
        false
    }

    fn regions(&self) -> Option<&'static str> {
        Some("parts")
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        let mut siblings = Siblings::new(input);
        let main = siblings.main();
        let mut deck = Deck::new(input, out);
        deck.read(&mut siblings, &main)?;
        match (deck.nodes, deck.elements) {
            (true, true) => Ok(()),
            (false, _) => Err(cut_off(&input.source, "*NODE cards")),
            (true, false) => Err(cut_off(&input.source, "*ELEMENT cards")),
        }
    }
}
