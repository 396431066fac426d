//! Sets of nodes and of elements: `*NSET`, `*ELSET`, and those that other keywords fill.

use std::collections::HashMap;
use std::ops::Range;

use crate::error::{Error, Result};
use crate::formats::abaqus::fields::Fields;
use crate::formats::abaqus::keywords::{Keyword, label};
use crate::input::{Source, Spot};

/// Numbers from, to, and the step.
pub(super) type Ranges = Vec<[u64; 3]>;

/// A `*NSET` or `*ELSET` line.
#[derive(Clone)]
pub(in crate::formats::abaqus) struct SetHead {
    pub(super) of_nodes: bool,
    pub(super) name: Vec<u8>,
    generate: bool,
    pub(super) unsorted: bool,
    /// Its members are said in a way that is not read: by elements, or by instance.
    unknown: bool,
}

impl SetHead {
    /// The head of a set, if the keyword names one.
    pub(in crate::formats::abaqus) fn of(keyword: &Keyword) -> Option<Self> {
        let of_nodes = keyword.name == "NSET";
        let name = keyword.label(if of_nodes { "NSET" } else { "ELSET" }).ok()??;
        let has = |option: &str| keyword.value(option).is_some();
        let unknown = has("INSTANCE") || (of_nodes && has("ELSET"));
        Some(Self { of_nodes, name, generate: has("GENERATE"), unsorted: has("UNSORTED"), unknown })
    }

    /// Whether data lines do not tell the members.
    pub(in crate::formats::abaqus) fn is_unknown(&self) -> bool {
        self.unknown
    }

    /// The members on the data lines; none where they are not known.
    pub(super) fn read(
        &self,
        source: &Source,
        range: Range<u64>,
        known: &HashMap<Vec<u8>, Set>,
    ) -> Result<Option<Ranges>> {
        if self.unknown {
            return Ok(None);
        }
        let window = source.window(range.clone());
        let mut fields = Fields::new(&window);
        let done = self.lines(&mut fields, known);
        done.map_err(|e| source.place(e, Spot::Text(range.start + fields.at as u64)))
    }

    fn lines(&self, fields: &mut Fields<'_>, known: &HashMap<Vec<u8>, Set>) -> Result<Option<Ranges>> {
        let mut ranges = Ranges::new();
        while fields.next_line()? {
            if self.generate {
                let [first, last, step] = fields.integers([None, None, Some(1)])?;
                if step == 0 || last < first {
                    return Err(Error::malformed(
                        "a first number, a last one and a step",
                        format!("{first}, {last}, {step}"),
                    ));
                }
                ranges.push([first, last, step]);
                continue;
            }
            loop {
                if !fields.is_blank() {
                    let token = fields.token();
                    if token.first().is_some_and(u8::is_ascii_digit) {
                        let number = fields.number("a number")?;
                        ranges.push([number, number, 1]);
                    } else {
                        fields.at += token.len();
                        match known.get(&label(token)).and_then(|set| set.ranges.as_ref()) {
                            Some(members) => ranges.extend_from_slice(members),
                            None => return Ok(None),
                        }
                    }
                }
                if !fields.comma()? || fields.ends_line() {
                    break;
                }
            }
        }
        Ok(Some(ranges))
    }
}

/// A set.
#[derive(Clone)]
pub(super) struct Set {
    /// None where the members are not known.
    ranges: Option<Ranges>,
    unsorted: bool,
}

impl Default for Set {
    fn default() -> Self {
        Self { ranges: Some(Ranges::new()), unsorted: false }
    }
}

impl Set {
    /// Adds members.
    pub(super) fn add(&mut self, members: Ranges) {
        self.add_as(Some(members), false);
    }

    /// Adds members, perhaps such that are not known, perhaps in an order of their own.
    pub(super) fn add_as(&mut self, members: Option<Ranges>, unsorted: bool) {
        self.unsorted |= unsorted;
        self.ranges = match (self.ranges.take(), members) {
            (Some(mut ranges), Some(members)) => {
                ranges.extend(members);
                Some(ranges)
            }
            _ => None,
        };
    }

    /// How many members there are at the most; none where they are not known.
    pub(super) fn count(&self) -> Option<u64> {
        let count = |[first, last, step]: &[u64; 3]| (last - first) / step + 1;
        self.ranges.as_ref().map(|ranges| ranges.iter().map(count).fold(0, u64::saturating_add))
    }

    /// The members as first and last numbers of runs; none where they are not known.
    pub(super) fn runs(&self) -> impl Iterator<Item = (u64, u64)> {
        self.ranges.iter().flatten().flat_map(|&[first, last, step]| {
            let (length, step) = if step == 1 { (last - first, u64::MAX) } else { (0, step) };
            (first..=last)
                .step_by(usize::try_from(step).unwrap_or(usize::MAX))
                .map(move |from| (from, from + length))
        })
    }

    /// The members, sorted unless the deck says otherwise.
    pub(super) fn members(&self) -> Vec<u64> {
        let ranges = self.ranges.iter().flatten();
        let mut members: Vec<_> =
            ranges.flat_map(|[first, last, step]| (*first..=*last).step_by(*step as usize)).collect();
        if !self.unsorted {
            members.sort_unstable();
            members.dedup();
        }
        members
    }
}
