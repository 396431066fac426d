//! Abaqus and CalculiX decks (`.inp`), as Abaqus/CAE, Cubit, HyperMesh and Gmsh write them too.
//!
//! A flat deck yields its pieces as they are found. Parts wait for their instances: numbers begin anew in every part,
//! so that a node is known by its instance (bits 40 and up) and its own number. What is read: `*NODE` with its systems,
//! `*SYSTEM`, `*ELEMENT`, `*USER ELEMENT`, `*PART`, `*ASSEMBLY`, `*INSTANCE`, `*INCLUDE` and `INPUT=`. Keywords that make
//! nodes or elements out of others are expanded (`make`) or refused by name; every other keyword is no mesh and is skipped
//! with its data.

mod assembly;
mod deck;
mod detect;
mod elements;
mod fields;
mod keywords;
mod make;
mod nodes;
mod placement;
mod points;
mod types;

#[cfg(test)]
mod tests;

use crate::error::{Error, Result};
use crate::formats::{Format, HEAD_BYTES, Outline};
use crate::input::{Input, Sibling, Siblings, Source, Spot};

use deck::Deck;
use keywords::{BYTE_ORDER_MARK, Keyword, Scanner};

/// Abaqus and CalculiX decks.
pub struct Abaqus;

impl Format for Abaqus {
    fn name(&self) -> &'static str {
        "abaqus"
    }

    fn title(&self) -> &'static str {
        "Abaqus and CalculiX input decks: flat, with parts and instances, with includes"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["inp"]
    }

    fn looks_for(&self) -> &'static str {
        "keyword lines as *HEADING, *NODE or *PART"
    }

    fn detect(&self, head: &[u8]) -> bool {
        detect::is_abaqus(head)
    }

    fn regions(&self) -> Option<&'static str> {
        Some("element sets and instances")
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        if detect::is_utf16(input.source.peek(0..HEAD_BYTES as u64)) {
            let error = Error::malformed("text of one byte a character, as ASCII or UTF-8", "UTF-16");
            return Err(input.source.place(error, Spot::Binary(0)));
        }
        let mut deck = Deck::new(input, out);
        let mut siblings = Siblings::new(input);
        let main = siblings.main();
        read(&mut deck, &mut siblings, &main)?;
        deck.finish()
    }
}

/// Reads a file of the deck. The data before its first keyword belong to the last keyword of the file that includes it.
fn read(deck: &mut Deck<'_>, siblings: &mut Siblings<'_>, file: &Sibling) -> Result<()> {
    let source = &file.source;
    let mut scanner = Scanner::new(source);
    let mut at = start(source);
    loop {
        let star = scanner.next(at);
        deck.data(source, at..star.unwrap_or(source.len()))?;
        let Some(star) = star else { return Ok(()) };
        let keyword = Keyword::read(source, star, siblings.limits())?;
        at = keyword.end;
        let includes = keyword.name == "INCLUDE";
        if !includes {
            deck.keyword(&keyword, source)?;
        }
        if !includes && !matches!(keyword.name.as_str(), "NODE" | "ELEMENT") {
            continue;
        }
        let place = |e: Error| source.place(e, Spot::Text(star));
        match keyword.input() {
            Some(name) => {
                let named = siblings.open(file, &name).map_err(place)?;
                if includes {
                    read(deck, siblings, &named)?;
                } else {
                    deck.data(&named.source, start(&named.source)..named.source.len())?;
                }
            }
            None if includes => {
                return Err(place(Error::malformed("INPUT= with a file's name", "*INCLUDE without")));
            }
            None => {}
        }
    }
}

/// The first byte of the text.
fn start(source: &Source) -> u64 {
    if source.peek(0..3) == BYTE_ORDER_MARK { 3 } else { 0 }
}
