//! `*PARAMETER`: named values, put in where `<name>` stands.
//!
//! The text from the first `*PARAMETER` on is written to scratch with the values in place, line by line, so that errors
//! still name the lines of the deck. What is not plain arithmetic ([`expression`]) has no value; its name then stays
//! where it is, and is refused there.

mod expression;

use std::collections::HashMap;
use std::sync::Arc;

use super::keywords::plain;
use crate::error::{Error, Result};
use crate::formats::text::LineReader;
use crate::input::{Input, Source, Spot};
use expression::Value;

/// Most parameters of a deck.
const MOST: usize = 100_000;
/// Longest text that stands for a name.
const LONGEST: usize = 256;

/// The parameters that are known so far.
#[derive(Debug, Default)]
pub(super) struct Parameters {
    values: HashMap<Vec<u8>, Value>,
    /// How often one was given a value.
    changes: u64,
}

/// What the line at hand belongs to.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Within {
    /// A `*PARAMETER` whose lines give values.
    Definitions,
    /// A `*PARAMETER` of another kind: its lines are neither definitions nor data.
    Tables,
    /// Anything else.
    Data,
    /// What comes after an `*INCLUDE`, whose file may change the values.
    Rest,
}

impl Parameters {
    /// A number that grows whenever a parameter is given a value.
    pub(super) fn changes(&self) -> u64 {
        self.changes
    }

    /// The text of `source` with the values in place of the names from byte `from`, the start of a line, up to the next
    /// `*INCLUDE`. Definitions on the way are taken in.
    pub(super) fn put_in(&mut self, input: &Input, source: &Source, from: u64) -> Result<Arc<Source>> {
        let mut out = input.scratch.file()?;
        let mut at = 0;
        while at < from {
            let window = source.window(at..from.min(at + (8 << 20)));
            out.write(&window)?;
            at += window.len() as u64;
        }
        let mut lines = LineReader::new(source, &input.limits, from);
        let mut within = Within::Data;
        loop {
            let start = lines.position();
            let Some(line) = lines.next_line()? else { break };
            let text = line.bytes.trim_ascii();
            let mut next = within;
            if text.starts_with(b"*") && !text.starts_with(b"**") && within != Within::Rest {
                within = Within::of(text);
                next = within;
                if within == Within::Rest {
                    within = Within::Data;
                }
            }
            match within {
                Within::Data => out.write(&self.replaced(line.bytes))?,
                _ => {
                    if within == Within::Definitions && !text.starts_with(b"*") {
                        self.define(text).map_err(|e| source.place(e, Spot::Text(start)))?;
                    }
                    out.write(line.bytes)?;
                }
            }
            let end = start + line.bytes.len() as u64;
            let rest = source.peek(end..end + 2);
            let end = memchr::memchr(b'\n', rest).map_or(0, |k| k + 1);
            out.write(&rest[..end])?;
            within = next;
        }
        Ok(Arc::new(out.into_source(source.path())?))
    }

    /// Takes in the line of a definition: `name = expression # comment`. What has no value is forgotten.
    fn define(&mut self, line: &[u8]) -> Result<()> {
        let Some(equals) = line.iter().position(|b| *b == b'=') else { return Ok(()) };
        let name = line[..equals].trim_ascii().to_vec();
        self.changes += 1;
        match expression::value(&line[equals + 1..], |name| self.values.get(name)) {
            Some(value) if name.len() <= LONGEST => {
                self.values.insert(name, value);
            }
            _ => drop(self.values.remove(&name)),
        }
        if self.values.len() > MOST {
            return Err(Error::limit("number of parameters", MOST));
        }
        Ok(())
    }

    /// A line with the values of the names that are known.
    fn replaced(&self, line: &[u8]) -> Vec<u8> {
        let mut out = Vec::with_capacity(line.len());
        let mut rest = line;
        while let Some(open) = memchr::memchr(b'<', rest) {
            out.extend_from_slice(&rest[..open]);
            let named =
                memchr::memchr(b'>', &rest[open..]).map(|len| (&rest[open + 1..open + len], open + len + 1));
            match named.and_then(|(name, end)| Some((self.values.get(name.trim_ascii())?, end))) {
                Some((value, end)) => {
                    out.extend_from_slice(value.to_string().as_bytes());
                    rest = &rest[end..];
                }
                None => {
                    out.push(b'<');
                    rest = &rest[open + 1..];
                }
            }
        }
        out.extend_from_slice(rest);
        out
    }
}

impl Within {
    /// What a keyword line begins.
    fn of(line: &[u8]) -> Self {
        let mut words = line[1..].split(|b| *b == b',').map(plain);
        let name = words.next();
        match (name.as_deref(), words.all(|word| word.is_empty() || word == "INDEPENDENT")) {
            (Some("PARAMETER"), true) => Within::Definitions,
            (Some("PARAMETER"), false) => Within::Tables,
            (Some("INCLUDE"), _) => Within::Rest,
            _ => Within::Data,
        }
    }
}
