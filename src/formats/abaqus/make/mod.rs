//! Keywords that make nodes and elements out of others: `*NGEN`, `*NFILL`, `*NCOPY`, `*ELGEN`, `*ELCOPY`.
//!
//! What was defined before is noted as it goes by, and read only once such a keyword asks for it. What is expanded is what
//! the keyword manual states without room for doubt; options beyond that are refused by name.

mod belonging;
mod elements;
mod made;
mod nodes;
mod sets;
mod tables;

use std::cell::Cell;
use std::ops::Range;
use std::sync::Arc;

use super::assembly::Block;
use super::fields::Fields;
use super::keywords::{Keyword, plain};
use super::placement::Placement;
use super::points::Row;
use super::types::Kind;
use crate::error::{Error, Result};
use crate::input::{Budget, Input, Scratch, Source, Spot};

pub(super) use belonging::{Belonging, Listed, SetsOfPart};
pub(super) use made::{MadeElements, MadeNodes};
pub(super) use sets::SetHead;
use tables::Tables;

/// More blocks than this are not noted: hand-written decks, which these keywords are for, have few.
const MOST_NOTED: usize = 1 << 16;

/// A definition that went by.
pub(super) enum Noted {
    Nodes(Arc<Block<Placement>>, Option<Vec<u8>>),
    Elements(Arc<Block<Kind>>, Option<Vec<u8>>),
    Set(SetHead, Arc<Source>, Range<u64>),
}

/// A keyword that makes others.
pub(super) struct Command {
    what: What,
    /// The set that what is made goes to.
    set: Option<Vec<u8>>,
}

enum What {
    /// `*NGEN`: nodes on a line, or on an arc.
    Line { arc: bool, framed: bool },
    /// `*NFILL`.
    Fill,
    /// `*NCOPY`.
    CopyNodes { old: Vec<u8>, change: u64, how: nodes::Copy },
    /// `*ELGEN`.
    Elements,
    /// `*ELCOPY`.
    CopyElements { old: Vec<u8>, change: u64, nodes: u64 },
}

/// What is made by one keyword.
#[derive(Default)]
pub(super) struct Made {
    pub(super) nodes: Option<MadeNodes>,
    pub(super) elements: Vec<MadeElements>,
    /// The set that they go to.
    pub(super) set: Option<Arc<str>>,
}

impl Command {
    /// The command of a keyword; `framed`: a `*SYSTEM` is in force.
    pub(super) fn of(keyword: &Keyword, framed: bool) -> Result<Self> {
        let unread = |option: &str| {
            keyword
                .value(option)
                .is_some()
                .then(|| Error::unsupported(format!("*{} with {option} is not expanded", keyword.name)))
        };
        let refuse = |options: &[&str]| options.iter().find_map(|option| unread(option)).map_or(Ok(()), Err);
        let number = |name: &str| {
            let value = keyword.required(name)?;
            Fields::new(&value).integer(&format!("a number after {name}="))
        };
        let (what, set) = match keyword.name.as_str() {
            "NGEN" => {
                refuse(&["SYSTEM"])?;
                let arc = match keyword.label("LINE")?.as_deref() {
                    None => false,
                    Some(b"C") => true,
                    Some(other) => {
                        let text = format!("*NGEN with LINE={} is not expanded", other.escape_ascii());
                        return Err(Error::unsupported(text));
                    }
                };
                (What::Line { arc, framed }, "NSET")
            }
            "NFILL" => {
                refuse(&["BIAS", "SINGULAR", "TWOSTEP"])?;
                (What::Fill, "NSET")
            }
            "NCOPY" => {
                refuse(&["POLE", "MULTIPLE"])?;
                if framed {
                    return Err(Error::unsupported("*NCOPY within a *SYSTEM is not expanded"));
                }
                let how = nodes::Copy::of(keyword)?;
                (
                    What::CopyNodes {
                        old: keyword.required("OLDSET")?,
                        change: number("CHANGENUMBER")?,
                        how,
                    },
                    "NEWSET",
                )
            }
            "ELGEN" => (What::Elements, "ELSET"),
            _ => {
                refuse(&["REFLECT"])?;
                let (change, nodes) = (number("ELEMENTSHIFT")?, number("SHIFTNODES")?);
                (What::CopyElements { old: keyword.required("OLDSET")?, change, nodes }, "NEWSET")
            }
        };
        Ok(Self { what, set: keyword.label(set)? })
    }

    /// Whether each data line makes something; else all of them together do.
    pub(super) fn is_by_line(&self) -> bool {
        matches!(self.what, What::Line { .. } | What::Fill | What::Elements)
    }
}

/// Makes nodes and elements in one part, instance or flat deck.
#[derive(Default)]
pub(super) struct Maker {
    noted: Vec<Noted>,
    /// How many of them were read.
    read: usize,
    overflown: bool,
    tables: Tables,
}

impl Maker {
    /// Notes a definition that a later keyword may draw on.
    pub(super) fn note(&mut self, noted: Noted) {
        self.overflown |= self.noted.len() == MOST_NOTED;
        if !self.overflown {
            self.noted.push(noted);
        }
    }

    /// Runs a command on its data lines, or on its rows of points.
    pub(super) fn run(
        &mut self,
        command: &Command,
        input: &Input,
        (source, range): (&Arc<Source>, Range<u64>),
        rows: &[Row],
    ) -> Result<Made> {
        self.tables.budget.get_or_insert_with(|| input.memory.clone());
        self.catch_up()?;
        let store = Store {
            budget: &input.memory,
            scratch: &input.scratch,
            source,
            at: range.start,
            line: Cell::new(0),
        };
        let window = source.window(range.clone());
        let mut fields = Fields::new(&window);
        let made = self.make(command, &store, &mut fields, rows);
        made.map_err(|e| source.place(e, Spot::Text(range.start + store.line.get() as u64)))
    }

    fn make(
        &mut self,
        command: &Command,
        store: &Store<'_>,
        fields: &mut Fields<'_>,
        rows: &[Row],
    ) -> Result<Made> {
        let (tables, set) = (&mut self.tables, command.set.as_deref());
        let mut made = Made { set: set.map(|set| plain(set).into()), ..Made::default() };
        match &command.what {
            What::Line { arc, framed } => {
                made.nodes = Some(nodes::lines(tables, store, fields, set, (*arc, *framed))?)
            }
            What::Fill => made.nodes = Some(nodes::fill(tables, store, fields, set)?),
            What::CopyNodes { old, change, how } => {
                made.nodes = Some(nodes::copy(tables, store, (old, *change, set), how, rows)?);
            }
            What::Elements => made.elements = elements::rows(tables, store, fields, set)?,
            What::CopyElements { old, change, nodes } => {
                made.elements = elements::copy(tables, store, (old, set), (*change, *nodes))?;
            }
        }
        Ok(made)
    }

    /// Reads what was noted since the last time.
    fn catch_up(&mut self) -> Result<()> {
        if self.overflown {
            return Err(Error::limit("number of blocks before a keyword that makes others", MOST_NOTED));
        }
        for noted in &self.noted[self.read..] {
            match noted {
                Noted::Nodes(block, set) => self.tables.read_nodes(block, set.as_deref())?,
                Noted::Elements(block, set) => self.tables.read_elements(block, set.as_deref())?,
                Noted::Set(head, source, range) => self.tables.read_set(head, source, range.clone())?,
            }
        }
        self.read = self.noted.len();
        Ok(())
    }
}

/// Where what is made goes, and where the keyword stands.
struct Store<'s> {
    budget: &'s Budget,
    scratch: &'s Scratch,
    source: &'s Arc<Source>,
    at: u64,
    /// The data line at hand, from `at` on.
    line: Cell<usize>,
}
