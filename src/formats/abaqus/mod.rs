//! Abaqus and CalculiX decks (`.inp`), as Abaqus/CAE, Cubit, HyperMesh and Gmsh write them too.
//!
//! A flat deck yields its pieces as they are found. Parts wait for their instances: numbers begin anew in every part,
//! so that a node is known by its instance (bits 40 and up) and its own number. What is read: `*NODE` with its systems,
//! `*SYSTEM`, `*ELEMENT`, `*USER ELEMENT`, `*PART`, `*ASSEMBLY`, `*INSTANCE`, `*INCLUDE`, `INPUT=` and `*PARAMETER`. Keywords
//! that make nodes or elements out of others are expanded (`make`) or refused by name; every other keyword is no mesh and is
//! skipped with its data.

mod assembly;
mod deck;
mod detect;
mod elements;
mod fields;
mod keywords;
mod make;
mod nodes;
mod parameters;
mod placement;
mod points;
mod types;

#[cfg(test)]
mod tests;

use std::sync::Arc;

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
/// Whenever parameters were given values the rest is read with these in place.
fn read(deck: &mut Deck<'_>, siblings: &mut Siblings<'_>, file: &Sibling) -> Result<()> {
    let mut source = Arc::clone(&file.source);
    let mut from = start(&source);
    let mut has_values = deck.parameters.changes() > 0;
    loop {
        if has_values {
            source = deck.put_in_parameters(&source, from)?;
        }
        match read_from(deck, siblings, (file, &source), from, has_values)? {
            Some(at) => (from, has_values) = (at, true),
            None => return Ok(()),
        }
    }
}

/// Reads a file from byte `at` on, up to its end or the place from which on parameters have new values; `has_values` says
/// that their values are in place up to the next include.
fn read_from(
    deck: &mut Deck<'_>,
    siblings: &mut Siblings<'_>,
    (file, source): (&Sibling, &Arc<Source>),
    mut at: u64,
    has_values: bool,
) -> Result<Option<u64>> {
    let mut scanner = Scanner::new(source);
    loop {
        let star = scanner.next(at);
        deck.data(source, at..star.unwrap_or(source.len()))?;
        let Some(star) = star else { return Ok(None) };
        let keyword = Keyword::read(source, star, siblings.limits())?;
        at = keyword.end;
        let place = |e: Error| source.place(e, Spot::Text(star));
        if keyword.name == "PARAMETER" && !has_values {
            return Ok(Some(star));
        }
        let includes = keyword.name == "INCLUDE";
        if !includes {
            deck.keyword(&keyword, source)?;
        }
        if !includes && !matches!(keyword.name.as_str(), "NODE" | "ELEMENT") {
            continue;
        }
        match keyword.input() {
            Some(name) => {
                let named = siblings.open(file, &name).map_err(place)?;
                if includes {
                    read(deck, siblings, &named)?;
                } else {
                    deck.data(&named.source, start(&named.source)..named.source.len())?;
                }
                if deck.parameters.changes() > 0 {
                    return Ok(Some(at));
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
