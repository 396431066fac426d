//! What a MAT-file holds: walks its variables, into structures and cells too, and notes the matrices that may be a mesh's.

use std::ops::Range;
use std::sync::Arc;

use super::choose;
use super::store::{Matrix, leaf};
use super::unpack::unpack;
use crate::error::{Error, Result};
use crate::formats::array::{Array, Number, Origin, Stored};
use crate::formats::binary::Endian;
use crate::input::{Input, Source, Spot};

/// The size of the header.
const HEADER: u64 = 128;
/// Types of data elements.
const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;
/// Limits, each with its own error.
const MOST_VARIABLES: usize = 100_000;
pub(super) const MOST_MATRICES: usize = 10_000;
pub(super) const MOST_DEPTH: usize = 16;
/// Most bytes of a name, of the names of a structure's fields, or of a matrix's sizes.
const MOST_NAMES: u64 = 256 << 10;
/// Most variables that an error lists.
const MOST_OTHERS: usize = 20;

/// What was found.
#[derive(Debug, Default)]
pub(super) struct Contents {
    /// Matrices with a name that a mesh may have.
    pub(super) matrices: Vec<Matrix>,
    /// Some of the others, described.
    pub(super) others: Vec<String>,
}

impl Contents {
    pub(super) fn other(&mut self, path: &str, what: &str) {
        if self.others.len() < MOST_OTHERS {
            self.others.push(format!("{path} ({what})"));
        }
    }
}

/// Where a variable stands: the contents of its data element.
struct Variable {
    /// Its first byte in the file.
    at: u64,
    in_file: bool,
    range: Range<u64>,
}

/// Reads what the file holds; what is compressed, and may be needed, is unpacked to scratch.
pub(super) fn read(input: &Input) -> Result<Contents> {
    let source = &input.source;
    let endian = header(source)?;
    let mut contents = Contents::default();
    let mut unpacked = input.scratch.file()?;
    let mut variables = Vec::new();
    let mut at = HEADER;
    while at < source.len() {
        let walk = Walk { file: source, source, in_file: true, origin: at, endian };
        let tag = walk.tag(at, source.len())?;
        match tag.kind {
            MATRIX => variables.push(Variable { at, in_file: true, range: tag.data }),
            COMPRESSED => {
                let from = unpacked.len();
                let mut wanted = None;
                unpack(input, tag.data, |bytes| {
                    if !*wanted.get_or_insert_with(|| is_wanted(bytes, endian, &mut contents)) {
                        return Ok(false);
                    }
                    unpacked.write(bytes)?;
                    Ok(true)
                })?;
                if wanted == Some(true) {
                    variables.push(Variable { at, in_file: false, range: from..unpacked.len() });
                }
            }
            other => {
                let expected = "a variable: a data element of type 14 or 15";
                return Err(source.malformed_binary(at, expected, format!("type {other}")));
            }
        }
        if variables.len() > MOST_VARIABLES {
            let error = Error::limit("number of variables", MOST_VARIABLES);
            return Err(source.place(error, Spot::Binary(at)));
        }
        // What follows compressed data is not padded.
        at = if tag.kind == COMPRESSED { tag.end } else { tag.next };
    }
    let unpacked = Arc::new(unpacked.into_source(source.path())?);
    for Variable { at, in_file, range } in variables {
        let stored = if in_file { source } else { &unpacked };
        let walk = Walk { file: source, source: stored, in_file, origin: at, endian };
        let range = if in_file {
            range
        } else {
            let tag = walk.tag(range.start, range.end)?;
            if tag.kind != MATRIX {
                return Err(walk.malformed(range.start, "a matrix", format!("type {}", tag.kind)));
            }
            tag.data
        };
        walk.matrix(range, None, 0, &mut contents)?;
    }
    Ok(contents)
}

/// Reads the header; gives the byte order.
fn header(source: &Source) -> Result<Endian> {
    let head = source.peek(0..HEADER);
    match head.get(124..128) {
        None => Err(source.truncated("a header of 128 bytes")),
        Some([0, 1, b'I', b'M']) => Ok(Endian::Little),
        Some([1, 0, b'M', b'I']) => Ok(Endian::Big),
        Some(other) => {
            let found = format!("\"{}\"", other.escape_ascii());
            Err(source.malformed_binary(124, "version 0x0100 and IM or MI", found))
        }
    }
}

/// Whether a variable that begins with `bytes` may hold a mesh: only then is it unpacked. In doubt it is.
fn is_wanted(bytes: &[u8], endian: Endian, contents: &mut Contents) -> bool {
    let word = |at: usize| bytes.get(at..at + 4).map(|bytes| endian.u32(bytes));
    let (Some(flags), Some(size)) = (word(16), word(28)) else { return true };
    let name_at = 32 + (size as usize).next_multiple_of(8);
    let Some(tag) = word(name_at) else { return true };
    let (from, len) = match tag >> 16 {
        0 => (name_at + 8, word(name_at + 4).unwrap_or(0) as usize),
        len => (name_at + 4, len as usize),
    };
    let Some(name) = bytes.get(from..from.saturating_add(len)) else { return true };
    let name = String::from_utf8_lossy(name);
    match Class::of(flags) {
        Class::Cell | Class::Struct | Class::Object | Class::Opaque => true,
        Class::Numeric => {
            let wanted = choose::may_be_of_mesh(&name);
            if !wanted {
                contents.other(&name, "numbers");
            }
            wanted
        }
        Class::Other(what) => {
            contents.other(&name, what);
            false
        }
    }
}

/// Classes of arrays.
enum Class {
    Cell,
    Struct,
    Object,
    Numeric,
    Opaque,
    Other(&'static str),
}

impl Class {
    fn of(flags: u32) -> Self {
        match flags & 0xff {
            1 => Self::Cell,
            2 => Self::Struct,
            3 => Self::Object,
            6..=15 if flags & 0x800 != 0 => Self::Other("complex numbers"),
            6..=15 => Self::Numeric,
            17 => Self::Opaque,
            4 => Self::Other("text"),
            5 => Self::Other("a sparse matrix"),
            _ => Self::Other("neither numbers nor a structure"),
        }
    }
}

/// The head of a data element.
struct Tag {
    kind: u32,
    data: Range<u64>,
    /// The byte after the data.
    end: u64,
    /// The byte after the padding.
    next: u64,
}

/// Walks through one variable.
struct Walk<'a> {
    file: &'a Source,
    source: &'a Arc<Source>,
    in_file: bool,
    /// The variable's first byte in the file.
    origin: u64,
    endian: Endian,
}

impl Walk<'_> {
    fn malformed(&self, at: u64, expected: impl Into<String>, found: impl Into<String>) -> Error {
        let at = if self.in_file { at } else { self.origin };
        self.file.malformed_binary(at, expected, found)
    }

    fn word(&self, at: u64) -> u32 {
        self.endian.u32(self.source.peek(at..at + 4))
    }

    /// The head of the data element at `at`, all of which lies before `end`.
    fn tag(&self, at: u64, end: u64) -> Result<Tag> {
        let cut = || self.malformed(at, "a data element", "the end of what should hold it");
        if at.saturating_add(8) > end.min(self.source.len()) {
            return Err(cut());
        }
        let word = self.word(at);
        let (kind, start, len) = match word >> 16 {
            0 => (word, at + 8, u64::from(self.word(at + 4))),
            len => (word & 0xffff, at + 4, u64::from(len)),
        };
        let data_end = start + len;
        let small = start == at + 4;
        if data_end > end.min(self.source.len()) || (small && len > 4) {
            let found = format!("one of {len} bytes, {} before the end of what holds it", end - start);
            return Err(self.malformed(at, "a data element", found));
        }
        let next = if small { at + 8 } else { start + len.next_multiple_of(8) };
        Ok(Tag { kind, data: start..data_end, end: data_end, next })
    }

    /// The data element at `at`, of one of the types `kinds`.
    fn part(&self, at: u64, end: u64, kinds: &[u32], what: &str) -> Result<Tag> {
        let tag = self.tag(at, end)?;
        if !kinds.contains(&tag.kind) || tag.end - tag.data.start > MOST_NAMES {
            let found = format!("type {} of {} bytes", tag.kind, tag.end - tag.data.start);
            return Err(self.malformed(at, what, found));
        }
        Ok(tag)
    }

    fn text(&self, range: Range<u64>) -> String {
        let bytes = self.source.peek(range);
        let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
        String::from_utf8_lossy(&bytes[..end]).into_owned()
    }

    /// Notes what the matrix with its contents at `range` is. Within a structure or cell it is called `path`.
    fn matrix(
        &self,
        range: Range<u64>,
        path: Option<String>,
        depth: usize,
        found: &mut Contents,
    ) -> Result<()> {
        let end = range.end;
        if range.is_empty() {
            return Ok(());
        }
        if depth > MOST_DEPTH {
            let error = Error::limit("depth of structures and cells", MOST_DEPTH);
            return Err(self.file.place(error, Spot::Binary(self.origin)));
        }
        let flags = self.part(range.start, end, &[6], "array flags")?;
        if flags.end - flags.data.start != 8 {
            return Err(self.malformed(range.start, "array flags of 8 bytes", "others"));
        }
        let class = Class::of(self.word(flags.data.start));
        if let Class::Opaque = class {
            let name = self.part(flags.next, end, &[1, 2, 16], "a name")?;
            let own = self.text(name.data);
            found
                .other(path.as_deref().unwrap_or(&own), "an object, which MATLAB saves in a form of its own");
            return Ok(());
        }
        let sizes = self.part(flags.next, end, &[5, 6], "the sizes of an array")?;
        let name = self.part(sizes.next, end, &[1, 2, 16], "the name of an array")?;
        let path = path.unwrap_or_else(|| self.text(name.data.clone()));
        let sizes: Vec<u64> = sizes.data.step_by(4).map(|at| u64::from(self.word(at.min(end - 4)))).collect();
        match class {
            Class::Cell => self.cells(name.next..end, &path, &sizes, depth, found),
            Class::Struct => self.fields(name.next..end, &path, &sizes, depth, found),
            Class::Object => {
                let class = self.part(name.next, end, &[1, 2, 16], "the name of a class")?;
                self.fields(class.next..end, &path, &sizes, depth, found)
            }
            Class::Numeric if choose::may_be_of_mesh(leaf(&path)) => {
                self.numbers(name.next..end, path, &sizes, found)
            }
            Class::Numeric | Class::Opaque => {
                let sizes: Vec<_> = sizes.iter().take(4).map(u64::to_string).collect();
                found.other(&path, &sizes.join(" x "));
                Ok(())
            }
            Class::Other(what) => {
                found.other(&path, what);
                Ok(())
            }
        }
    }

    fn numbers(&self, range: Range<u64>, path: String, sizes: &[u64], found: &mut Contents) -> Result<()> {
        let &[rows, columns] = sizes else { return Ok(()) };
        let tag = self.tag(range.start, range.end)?;
        let Some(number) = number_of_tag(tag.kind) else {
            return Err(self.malformed(range.start, "numbers", format!("type {}", tag.kind)));
        };
        let bytes = rows.checked_mul(columns).and_then(|count| count.checked_mul(number.width()));
        if bytes != Some(tag.end - tag.data.start) {
            let expected = format!("{rows} x {columns} numbers of {} bytes ({path})", number.width());
            return Err(self.malformed(range.start, expected, format!("{} bytes", tag.end - tag.data.start)));
        }
        if found.matrices.len() >= MOST_MATRICES {
            return Err(Error::limit("number of matrices that may be of a mesh", MOST_MATRICES));
        }
        let origin = if self.in_file { Origin::File } else { Origin::Record(self.origin) };
        let stored =
            Stored { origin, at: tag.data.start, number, endian: self.endian, count: rows * columns };
        let numbers = Array::in_file(self.source, stored);
        found.matrices.push(Matrix { path, rows, columns, numbers });
        Ok(())
    }

    /// The matrix at `at`, which is a part of another; gives the byte after it.
    fn inner(&self, at: u64, end: u64, path: String, depth: usize, found: &mut Contents) -> Result<u64> {
        let tag = self.tag(at, end)?;
        if tag.kind != MATRIX {
            return Err(self.malformed(at, format!("the matrix {path}"), format!("type {}", tag.kind)));
        }
        self.matrix(tag.data, Some(path), depth + 1, found)?;
        Ok(tag.next)
    }

    fn cells(
        &self,
        range: Range<u64>,
        path: &str,
        sizes: &[u64],
        depth: usize,
        found: &mut Contents,
    ) -> Result<()> {
        let mut at = range.start;
        for number in 1..=product(sizes) {
            at = self.inner(at, range.end, format!("{path}{{{number}}}"), depth, found)?;
        }
        Ok(())
    }

    fn fields(
        &self,
        range: Range<u64>,
        path: &str,
        sizes: &[u64],
        depth: usize,
        found: &mut Contents,
    ) -> Result<()> {
        let width = self.part(range.start, range.end, &[5], "the length of field names")?;
        let names = self.part(width.next, range.end, &[1, 2, 16], "the names of fields")?;
        let width = u64::from(self.word(width.data.start));
        let (count, mut at) = (product(sizes), names.next);
        if width == 0 || names.data.is_empty() {
            return Ok(());
        }
        let fields: Vec<_> = (names.data.start..names.end)
            .step_by(width as usize)
            .map(|at| self.text(at..names.end.min(at + width)))
            .collect();
        for number in 1..=count {
            for field in &fields {
                let path =
                    if count == 1 { format!("{path}.{field}") } else { format!("{path}({number}).{field}") };
                at = self.inner(at, range.end, path, depth, found)?;
            }
        }
        Ok(())
    }
}

/// The type of numbers with the tag of a data element. MATLAB packs whole numbers into the smallest type: the class of an
/// array says nothing about it.
fn number_of_tag(tag: u32) -> Option<Number> {
    Some(match tag {
        1 => Number::I8,
        2 => Number::U8,
        3 => Number::I16,
        4 => Number::U16,
        5 => Number::I32,
        6 => Number::U32,
        7 => Number::F32,
        9 => Number::F64,
        12 => Number::I64,
        13 => Number::U64,
        _ => return None,
    })
}

/// The number of entries of an array. Each takes eight bytes or more, so that a false one is noticed soon.
fn product(sizes: &[u64]) -> u64 {
    sizes.iter().copied().fold(1, u64::saturating_mul)
}
