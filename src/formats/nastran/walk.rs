//! A walk through the lines of a deck and of what it includes: where the bulk data stand, and what each stretch holds.

use std::ops::Range;
use std::sync::Arc;

use super::cards;
use super::grids::GRID;
use super::include;
use super::lines::{Line, Name, kind};
use super::{BYTE_ORDER_MARK, systems};
use crate::error::{Error, Result};
use crate::formats::PIECE_BYTES;
use crate::formats::text::LineReader;
use crate::input::{Input, Sibling, Siblings, Source, Spot};

/// Whole cards that follow each other in one file.
#[derive(Debug)]
pub(super) struct Stretch {
    pub(super) source: Arc<Source>,
    pub(super) span: Range<u64>,
    pub(super) holds: Holds,
}

/// What cards there are.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Holds {
    pub(super) nodes: bool,
    pub(super) elements: bool,
    /// Coordinate systems and defaults of nodes.
    pub(super) systems: bool,
}

/// A walk as far as it came.
pub(super) struct Walk<'i> {
    siblings: Siblings<'i>,
    found: Vec<Stretch>,
    /// The stretch at hand begins here and holds this.
    from: u64,
    holds: Holds,
    /// Whether BEGIN BULK was met.
    began: bool,
    /// What is wrong if BEGIN BULK does not follow: before it stands what is no bulk data.
    wrong: Option<Error>,
    /// Whether ENDDATA was met.
    ended: bool,
}

/// What a card is to the walk.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Meaning {
    Node,
    Element,
    /// Perhaps an element.
    Unknown,
    System,
    Begin,
    End,
    Include,
    Other,
}

impl Meaning {
    fn of(name: &Name) -> Meaning {
        match name {
            GRID => Meaning::Node,
            b"BEGIN   " => Meaning::Begin,
            b"ENDDATA " | b"END     " => Meaning::End,
            b"INCLUDE " => Meaning::Include,
            _ if systems::is_known(name) => Meaning::System,
            _ if cards::element(name).is_some() => Meaning::Element,
            _ if cards::may_be_element(name) => Meaning::Unknown,
            _ => Meaning::Other,
        }
    }

    /// Whether the mesh hangs on each line of the card.
    fn is_mesh(self) -> bool {
        matches!(self, Meaning::Node | Meaning::Element | Meaning::System)
    }
}

impl<'i> Walk<'i> {
    /// The stretches of a deck that hold something, in file order.
    pub(super) fn of(input: &'i Input) -> Result<Vec<Stretch>> {
        let siblings = Siblings::new(input);
        let main = siblings.main();
        let holds = Holds::default();
        let mut walk =
            Walk { siblings, found: Vec::new(), from: 0, holds, began: false, wrong: None, ended: false };
        walk.file(&main)?;
        walk.wrong.map_or(Ok(walk.found), Err)
    }

    fn file(&mut self, file: &Sibling) -> Result<()> {
        let source = &file.source;
        self.from = if source.peek(0..3) == BYTE_ORDER_MARK { 3 } else { 0 };
        let mut lines = LineReader::new(source, self.siblings.limits(), self.from);
        let (mut card, mut meaning, mut last) = (*b"        ", Meaning::Other, None);
        while !self.ended {
            let Some(line) = lines.next_line()? else { break };
            let at = line.at;
            match kind(line.bytes) {
                Line::Blank | Line::Continuation => {
                    // Whatever else the card is, nobody reads its lines: they may be cut apart.
                    if meaning == Meaning::Other {
                        self.cut(source, at);
                    }
                    last = last.filter(|_| !line.bytes.trim_ascii().is_empty()).map(|_| at);
                }
                Line::Replication if meaning.is_mesh() => self.refuse(|| replication(source, at, &card))?,
                Line::Stray if meaning.is_mesh() => {
                    self.refuse(|| source.malformed_text(at, "a card, a continuation or a comment"))?;
                }
                Line::Replication | Line::Stray => {}
                Line::Card(name) => {
                    if name != card {
                        (card, meaning) = (name, Meaning::of(&name));
                    }
                    self.cut(source, at);
                    last = Some(at);
                    match meaning {
                        Meaning::Node => self.holds.nodes = true,
                        Meaning::Element | Meaning::Unknown => self.holds.elements = true,
                        Meaning::System => self.holds.systems = true,
                        Meaning::Other => {}
                        Meaning::Begin => {
                            self.begin(line.bytes).map_err(|e| source.place(e, Spot::Text(at)))?
                        }
                        Meaning::End => self.ended = ends(line.bytes),
                        Meaning::Include => {
                            self.finish(source, at);
                            let after = self.include(file, at)?;
                            lines.seek(after);
                        }
                    }
                    if matches!(meaning, Meaning::Begin | Meaning::Include) {
                        self.from = lines.position();
                        meaning = Meaning::Other;
                        card = *b"        ";
                    }
                }
            }
        }
        let end = lines.position().min(source.len());
        if !self.ended
            && let Some(last) = last
            && end == source.len()
            && source.peek(end - 1..end) != b"\n"
        {
            // ENDDATA may be missing: a last line without its end may have lost digits, nodes, or most of its card.
            self.refuse(|| source.malformed_text(last, "ENDDATA, or an end of line after the last card"))?;
        }
        self.finish(source, end);
        Ok(())
    }

    fn refuse(&mut self, error: impl FnOnce() -> Error) -> Result<()> {
        if self.began {
            return Err(error());
        }
        self.wrong.get_or_insert_with(error);
        Ok(())
    }

    /// BEGIN BULK: what stood before it is no bulk data.
    fn begin(&mut self, line: &[u8]) -> Result<()> {
        let section = section(line);
        match section.split_first() {
            Some((&"BULK", rest)) if !self.began && rest.iter().all(|word| *word == OTHER) => {
                self.began = true;
                self.wrong = None;
                self.found.clear();
                self.holds = Holds::default();
                Ok(())
            }
            // A title may begin with this word.
            None | Some((&OTHER, _)) if !self.began => Ok(()),
            _ => {
                let what = "a second section of bulk data (superelement, auxiliary model) is not read";
                Err(Error::unsupported(format!("{what}: BEGIN {}", section.join(" "))))
            }
        }
    }

    /// Reads what the INCLUDE statement at `at` names, and says where the statement ends.
    fn include(&mut self, file: &Sibling, at: u64) -> Result<u64> {
        let source = &file.source;
        let place = |e: Error| source.place(e, Spot::Text(at));
        let (name, len) = include::read(source.peek(at..at + include::MOST_BYTES)).map_err(place)?;
        let named = self.siblings.open(file, &name).map_err(place)?;
        self.file(&named)?;
        Ok(at + len as u64)
    }

    /// Ends the stretch at byte `at` if it is long enough.
    #[inline]
    fn cut(&mut self, source: &Arc<Source>, at: u64) {
        if at >= self.from + PIECE_BYTES {
            self.finish(source, at);
        }
    }

    fn finish(&mut self, source: &Arc<Source>, at: u64) {
        let holds = std::mem::take(&mut self.holds);
        if holds != Holds::default() {
            self.found.push(Stretch { source: Arc::clone(source), span: self.from..at, holds });
        }
        self.from = at;
    }
}

/// A word after BEGIN that is not known.
const OTHER: &str = "...";

/// The words after BEGIN, in capitals.
fn section(line: &[u8]) -> Vec<&'static str> {
    let line = &line[..memchr::memchr(b'$', line).unwrap_or(line.len())];
    let words =
        line.split(|b| b.is_ascii_whitespace() || matches!(b, b',' | b'=')).filter(|word| !word.is_empty());
    let known = |word: &[u8]| {
        ["BULK", "SUPER", "AUXMODEL", "MASSID", "MODULE", "ARBMODEL"]
            .into_iter()
            .find(|known| word.eq_ignore_ascii_case(known.as_bytes()))
            .unwrap_or(OTHER)
    };
    words.skip(1).map(known).collect()
}

/// ENDDATA, whatever stands after it, or END BULK.
fn ends(line: &[u8]) -> bool {
    let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
    let first = words.next().unwrap_or_default();
    !first.eq_ignore_ascii_case(b"END") || words.next().is_some_and(|word| word.eq_ignore_ascii_case(b"BULK"))
}

fn replication(source: &Source, at: u64, card: &Name) -> Error {
    let what =
        format!("the replication (=) of a {} card is not expanded", card.trim_ascii_end().escape_ascii());
    source.place(Error::unsupported(what), Spot::Text(at))
}
