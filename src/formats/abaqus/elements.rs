//! The data of `*ELEMENT`: a number and the nodes, over as many lines as the writer liked.
//!
//! A record ends when the nodes of its type are complete, whether commas end its lines or not. Where the type does not
//! say how many they are, a line that ends with a comma goes on.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use super::fields::{Fields, LARGEST_NUMBER};
use super::keywords::label;
use super::make::Belonging;
use super::types::Kind;
use crate::error::{Error, Kind as Fault, Result};
use crate::formats::plain::{Columns, PlainRows};
use crate::formats::text::LineReader;
use crate::formats::{ElementLayout, ElementSink, PIECE_BYTES};
use crate::input::{Input, Source, Spot};
use crate::mesh::Class;

/// The most nodes that a record may have.
pub(super) const MOST_NODES: usize = 1 << 16;

/// Decodes the records of one `*ELEMENT` block for one instance.
pub(super) struct ElementLines {
    pub(super) source: Arc<Source>,
    pub(super) kind: Kind,
    /// The element set and the instance that the elements are in.
    pub(super) belonging: Belonging,
    /// The instance, in the bits above the nodes' own numbers.
    pub(super) scope: u64,
    /// Scopes by instance name, for elements of the assembly: `Part-1-1.12`.
    pub(super) instances: Option<Arc<HashMap<Vec<u8>, u64>>>,
}

impl ElementLayout for ElementLines {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        let window = self.source.window(span.clone());
        let mut fields = Fields::new(&window);
        let done = self.records(&mut fields, span.start, out);
        if done.is_err() {
            out.at = Spot::Text(span.start + fields.at as u64);
        }
        done
    }
}

impl ElementLines {
    /// Shows the number and the nodes of each record of `span`.
    pub(super) fn each(
        &self,
        span: Range<u64>,
        mut see: impl FnMut(u64, &[u64]) -> Result<()>,
    ) -> Result<()> {
        let window = self.source.window(span.clone());
        let (mut fields, mut ids) = (Fields::new(&window), Vec::new());
        let mut next = || -> Result<bool> {
            if !fields.next_line()? {
                return Ok(false);
            }
            let start = fields.at;
            let element = fields.number("an element number")?;
            self.nodes(element, &mut fields, &mut ids, start)?;
            see(element, &ids).map(|()| true)
        };
        let done = loop {
            match next() {
                Ok(true) => {}
                done => break done,
            }
        };
        done.map(|_| ()).map_err(|e| self.source.place(e, Spot::Text(span.start + fields.at as u64)))
    }

    /// An error leaves `fields` on the line that it is about.
    fn records(&self, fields: &mut Fields<'_>, base: u64, out: &mut ElementSink<'_>) -> Result<()> {
        let sets = self.belonging.begin(out)?;
        let mut ids = Vec::with_capacity(self.kind.of.nodes.min(MOST_NODES));
        let Kind { of, least } = &self.kind;
        let columns = Columns { kind: of, first: None, before: (&[], 0), after: 0, scope: self.scope };
        let mut plain = (*least == of.nodes && self.instances.is_none() && sets.is_none())
            .then(|| PlainRows::new(b',', &columns))
            .flatten();
        while fields.next_line()? {
            if let Some(plain) = &mut plain {
                let taken = plain.take(fields.rest(), &columns, u64::MAX, out)?;
                fields.at += taken.bytes;
                if taken.rows > 0 {
                    continue;
                }
            }
            let start = fields.at;
            out.at = Spot::Text(base + start as u64);
            let element = fields.number("an element number")?;
            self.nodes(element, fields, &mut ids, start)?;
            if let Some(sets) = &sets {
                self.belonging.enter(sets, element, out)?;
            }
            out.element(element, &self.kind.of, &ids).map_err(|e| {
                fields.at = start;
                plain_number(e)
            })?;
        }
        Ok(())
    }

    /// The nodes of a record, from after its number to the line after it.
    #[inline]
    fn nodes(&self, element: u64, fields: &mut Fields<'_>, ids: &mut Vec<u64>, start: usize) -> Result<()> {
        ids.clear();
        let mut read = 0;
        let mut comma = fields.comma()?;
        loop {
            if !comma || fields.ends_line() {
                if is_complete(&self.kind, read, comma) {
                    return Ok(());
                }
                if !fields.next_line()? {
                    fields.at = start;
                    return Err(self.too_few(element, read));
                }
            }
            if let Some(id) = self.node(read, fields)? {
                ids.push(id);
            }
            read += 1;
            comma = fields.comma()?;
        }
    }

    /// The node that stands here, as the node table knows it. `None` where a place is left empty that may be.
    #[inline]
    fn node(&self, read: usize, fields: &mut Fields<'_>) -> Result<Option<u64>> {
        let Kind { of, least } = &self.kind;
        let counted = matches!(of.class, Class::Counted(_));
        if read >= of.nodes && (!counted || read >= MOST_NODES) {
            let most = if counted { MOST_NODES } else { of.nodes };
            return Err(fields.malformed(format!("at most {most} nodes of type {}", of.name)));
        }
        if fields.is_blank() && (counted || read >= *least) {
            return Ok(None);
        }
        if let Some(instances) = &self.instances {
            return labelled(fields, instances);
        }
        match fields.integer("a node number")? {
            0 if counted || read >= *least => Ok(None),
            0 => Err(Error::malformed(format!("a node number from 1 to {LARGEST_NUMBER}"), "0")),
            id => Ok(Some(self.scope | id)),
        }
    }

    #[cold]
    fn too_few(&self, element: u64, read: usize) -> Error {
        let least = self.kind.least.max(read + 1);
        let of = &self.kind.of.name;
        Error::malformed(
            format!("{least} nodes for element {element} of type {of}"),
            format!("{read} before the end of its data"),
        )
    }
}

/// A node of the assembly, `12`, or of an instance, `Part-1-1.12`.
fn labelled(fields: &mut Fields<'_>, instances: &HashMap<Vec<u8>, u64>) -> Result<Option<u64>> {
    let token = fields.token();
    let Some(dot) = memchr::memrchr(b'.', token) else {
        return fields.integer("a node number").map(|id| (id > 0).then_some(id));
    };
    let Some(scope) = instances.get(&label(&token[..dot])) else {
        return Err(fields.malformed("a node of a known instance"));
    };
    fields.at += dot + 1;
    fields.number("a node number").map(|id| Some(scope | id))
}

/// Takes the instance out of the node's number that an error names.
pub(super) fn plain_number(error: Error) -> Error {
    match error.kind() {
        Fault::MissingNode { element, node } => {
            Error::new(Fault::MissingNode { element: *element, node: node & LARGEST_NUMBER })
        }
        _ => error,
    }
}

/// Whether a record is complete at the end of a line, with so many nodes read and perhaps a comma at the end.
#[inline]
fn is_complete(kind: &Kind, read: usize, comma: bool) -> bool {
    (read >= kind.of.nodes && kind.of.nodes > 0) || (read >= kind.least && !comma)
}

/// Cuts the data of an `*ELEMENT` block into pieces of about [`PIECE_BYTES`] that begin with a record.
pub(super) fn cut_at_records(
    input: &Input,
    source: &Source,
    kind: &Kind,
    range: Range<u64>,
) -> Result<Vec<Range<u64>>> {
    let mut pieces = Vec::new();
    let mut from = range.start;
    while from < range.end {
        let near = from + PIECE_BYTES;
        let mut to = range.end;
        if near < range.end {
            let line = crate::formats::text::end_of_line(input, source, near, range.end)?;
            to = match record_near(input, source, kind, line..range.end)? {
                Some(record) => record,
                None => record_after(input, source, kind, from..range.end, line)?,
            };
        }
        pieces.push(from..to);
        from = to;
    }
    Ok(pieces)
}

/// The start of a record on one of the next lines, where it can be told without knowing what stands before.
fn record_near(input: &Input, source: &Source, kind: &Kind, range: Range<u64>) -> Result<Option<u64>> {
    const LINES: usize = 32;
    let mut lines = LineReader::new(source, &input.limits, range.start);
    for _ in 0..LINES {
        let Some(line) = lines.next_line()?.filter(|line| line.at < range.end) else { break };
        let (at, numbers, comma) = (line.at, numbers(line.bytes), ends_with_comma(line.bytes));
        if numbers == 0 {
            continue;
        }
        if kind.of.nodes == 0 {
            if !comma {
                return Ok(Some(lines.position().min(range.end)));
            }
        } else if kind.least == kind.of.nodes && numbers > kind.of.nodes {
            // A whole record in one line: were it the rest of another, that would have too many nodes.
            return Ok(Some(at));
        }
    }
    Ok(None)
}

/// The first record at or after byte `near`, counted from the record at the start of `range`.
fn record_after(input: &Input, source: &Source, kind: &Kind, range: Range<u64>, near: u64) -> Result<u64> {
    let mut lines = LineReader::new(source, &input.limits, range.start);
    let mut read = 0;
    while let Some(line) = lines.next_line()?.filter(|line| line.at < range.end) {
        let numbers = numbers(line.bytes);
        if numbers == 0 {
            continue;
        }
        if read == 0 && line.at >= near {
            return Ok(line.at);
        }
        read += numbers;
        if is_complete(kind, read - 1, ends_with_comma(line.bytes)) {
            read = 0;
        }
    }
    Ok(range.end)
}

/// How many fields stand on a line; none on a blank line and in a comment.
fn numbers(line: &[u8]) -> usize {
    let line = line.trim_ascii();
    if line.is_empty() || line.starts_with(b"**") {
        return 0;
    }
    memchr::memchr_iter(b',', line).count() + usize::from(!line.ends_with(b","))
}

fn ends_with_comma(line: &[u8]) -> bool {
    line.trim_ascii_end().ends_with(b",")
}
