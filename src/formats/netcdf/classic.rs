//! The classic container: a header, then the numbers of each variable, big-endian, one variable after another.
//!
//! CDF-1 has places of 4 bytes, CDF-2 of 8, CDF-5 counts of 8 bytes too. Variables that grow with the record dimension
//! stand interleaved behind the others; no mesh is among them.

use std::collections::HashMap;

use super::{MOST_LETTERS, Variable, Variables};
use crate::error::{Error, Result};
use crate::formats::array::{Number, Origin, Stored, Unpacked, check_fits};
use crate::formats::binary::Endian::Big;
use crate::input::{Source, Spot};

/// Tags of the header's lists.
const DIMENSIONS: u64 = 10;
const VARIABLES: u64 = 11;
const ATTRIBUTES: u64 = 12;
/// Limits, each with its own error. A name has at most 256 bytes by NetCDF's own rules.
const LONGEST_NAME: u64 = 1024;
const MOST_DIMENSIONS: u64 = 1 << 20;
const MOST_VARIABLES: u64 = 1 << 20;
const MOST_RANK: u64 = 1024;
/// Attributes that are longer are passed over.
const LONGEST_TEXT: u64 = 256;

/// Whether a file starts as one of the classic container does.
pub fn detect(head: &[u8]) -> bool {
    matches!(head, [b'C', b'D', b'F', 1 | 2 | 5, ..])
}

/// An open file.
#[derive(Debug)]
pub struct Classic<'i> {
    source: &'i Source,
    variables: Vec<Variable>,
    /// What else is known of each variable, by its name.
    stored: HashMap<String, Entry>,
}

/// Where a variable stands.
#[derive(Debug)]
struct Entry {
    /// `None`: text.
    number: Option<Number>,
    bytes: u64,
    begin: u64,
    is_record: bool,
    texts: Vec<(String, String)>,
}

impl<'i> Classic<'i> {
    /// Reads the header. All variables must lie in the file.
    pub fn open(source: &'i Source) -> Result<Self> {
        let mut header = Header::new(source)?;
        let records = header.record_count()?;
        let dimensions = header.dimensions()?;
        header.attributes()?;
        let count = header.list(VARIABLES, "the list of variables", MOST_VARIABLES)?;
        let mut file = Self { source, variables: Vec::new(), stored: HashMap::new() };
        for _ in 0..count {
            let (variable, entry) = header.variable(&dimensions)?;
            file.stored.insert(variable.name.clone(), entry);
            file.variables.push(variable);
        }
        file.check_end(records)?;
        Ok(file)
    }

    /// A file that is cut short is told by the variable that ends last.
    fn check_end(&self, records: Option<u64>) -> Result<()> {
        let entries = || self.stored.iter();
        let padded = |entry: &Entry| entry.bytes.saturating_add(3) & !3;
        let of_record = || entries().filter(|(_, entry)| entry.is_record);
        // A single variable of records is not padded.
        let record_bytes = match of_record().count() {
            1 => of_record().map(|(_, entry)| entry.bytes).sum(),
            _ => of_record().fold(0, |sum: u64, (_, entry)| sum.saturating_add(padded(entry))),
        };
        for (name, entry) in entries() {
            let before = match (entry.is_record, records) {
                (false, _) => 0,
                (true, Some(records @ 1..)) => (records - 1).saturating_mul(record_bytes),
                (true, _) => continue,
            };
            let end = entry.begin.saturating_add(before).saturating_add(entry.bytes);
            if end > self.source.len() {
                return Err(self.source.truncated(format!("the variable {name}, up to byte {end}")));
            }
        }
        Ok(())
    }
}

impl Variables for Classic<'_> {
    fn variables(&self) -> &[Variable] {
        &self.variables
    }

    fn text(&self, variable: &Variable, attribute: &str) -> Result<Option<String>> {
        let texts = self.stored.get(&variable.name).map_or(&[][..], |entry| &entry.texts);
        Ok(texts.iter().find(|text| text.0 == attribute).map(|text| text.1.clone()))
    }

    fn letters(&self, variable: &Variable) -> Result<Option<Vec<u8>>> {
        let entry =
            self.stored.get(&variable.name).filter(|entry| entry.number.is_none() && !entry.is_record);
        let fits = entry.filter(|entry| entry.bytes <= MOST_LETTERS as u64);
        Ok(fits.map(|entry| self.source.peek(entry.begin..entry.begin.saturating_add(entry.bytes)).to_vec()))
    }

    fn integers(&self, variable: &Variable, most: u64) -> Result<Vec<i64>> {
        let mut values = Vec::new();
        let entry = self.stored.get(&variable.name).filter(|entry| !entry.is_record);
        if let Some((entry, number)) = entry.and_then(|entry| Some((entry, entry.number?)))
            && variable.len() <= most
        {
            number.integers(Big, self.source.peek(entry.begin..entry.begin + entry.bytes), &mut values);
        }
        Ok(values.into_iter().map(u64::cast_signed).collect())
    }

    fn store(&self, variable: &Variable, _: &mut Unpacked<'_>) -> Result<Stored> {
        let refuse = |what: &str| {
            let error = Error::malformed(format!("numbers ({})", variable.name), what);
            self.source.place(error, Spot::Binary(variable.at))
        };
        let entry = self.stored.get(&variable.name).ok_or_else(|| refuse("no such variable"))?;
        if entry.is_record {
            return Err(refuse("a variable that grows with time"));
        }
        let number = entry.number.ok_or_else(|| refuse("text"))?;
        let stored =
            Stored { origin: Origin::File, at: entry.begin, number, endian: Big, count: variable.len() };
        check_fits(self.source, &stored, &variable.name)?;
        Ok(stored)
    }
}

/// A dimension; the one of records has no length.
struct Dimension(u64);

/// Reads the header from its start.
struct Header<'i> {
    source: &'i Source,
    at: u64,
    /// Bytes of a count, and of a place.
    count_bytes: u64,
    place_bytes: u64,
}

impl<'i> Header<'i> {
    fn new(source: &'i Source) -> Result<Self> {
        let (count_bytes, place_bytes) = match source.peek(0..4) {
            b"CDF\x01" => (4, 4),
            b"CDF\x02" => (4, 8),
            b"CDF\x05" => (8, 8),
            _ => return Err(source.malformed_binary(0, "CDF and the version 1, 2 or 5", "another start")),
        };
        Ok(Self { source, at: 4, count_bytes, place_bytes })
    }

    fn word(&mut self, bytes: u64, what: &str) -> Result<u64> {
        let raw = self.source.peek(self.at..self.at.saturating_add(bytes));
        if raw.len() as u64 != bytes {
            return Err(self.source.truncated(what));
        }
        self.at += bytes;
        Ok(if bytes == 4 { u64::from(Big.u32(raw)) } else { Big.u64(raw) })
    }

    /// A count, which is no negative number.
    fn count(&mut self, what: &str) -> Result<u64> {
        let at = self.at;
        let count = self.word(self.count_bytes, what)?;
        if count > (1 << (8 * self.count_bytes - 1)) - 1 {
            return Err(self.source.malformed_binary(at, what, "a negative number"));
        }
        Ok(count)
    }

    /// A count of at most `most`.
    fn limited(&mut self, what: &str, most: u64) -> Result<u64> {
        let at = self.at;
        let count = self.count(what)?;
        if count > most {
            return Err(self.source.place(Error::limit(what, most), Spot::Binary(at)));
        }
        Ok(count)
    }

    /// Number of records; `None` where the file is still being written and does not say.
    fn record_count(&mut self) -> Result<Option<u64>> {
        let count = self.word(self.count_bytes, "the number of records")?;
        let unknown = if self.count_bytes == 4 { u64::from(u32::MAX) } else { u64::MAX };
        Ok((count != unknown).then_some(count))
    }

    /// The head of a list: its tag, or 0 where it is empty, and its length.
    fn list(&mut self, tag: u64, what: &str, most: u64) -> Result<u64> {
        let at = self.at;
        let found = self.word(4, what)?;
        let count = self.limited(what, most)?;
        if found == tag || (found == 0 && count == 0) {
            return Ok(count);
        }
        Err(self.source.malformed_binary(at, format!("{what} (tag {tag})"), format!("tag {found}")))
    }

    fn name(&mut self) -> Result<String> {
        let len = self.limited("the length of a name", LONGEST_NAME)?;
        let raw = self.source.peek(self.at..self.at + len);
        if raw.len() as u64 != len {
            return Err(self.source.truncated("a name"));
        }
        self.at += len.next_multiple_of(4);
        Ok(String::from_utf8_lossy(raw).into_owned())
    }

    fn dimensions(&mut self) -> Result<Vec<Dimension>> {
        let count = self.list(DIMENSIONS, "the list of dimensions", MOST_DIMENSIONS)?;
        let mut found = Vec::new();
        for _ in 0..count {
            self.name()?;
            found.push(Dimension(self.count("the length of a dimension")?));
        }
        Ok(found)
    }

    /// Texts among the attributes.
    fn attributes(&mut self) -> Result<Vec<(String, String)>> {
        let count = self.list(ATTRIBUTES, "the list of attributes", MOST_VARIABLES)?;
        let mut texts = Vec::new();
        for _ in 0..count {
            let name = self.name()?;
            let (width, number) = self.kind()?;
            let len = self.count("the length of an attribute")?;
            let bytes = len.saturating_mul(width);
            let end = self.at.saturating_add(bytes);
            if end > self.source.len() {
                return Err(self.source.truncated(format!("the attribute {name}, {bytes} bytes")));
            }
            if number.is_none() && bytes <= LONGEST_TEXT {
                let text = String::from_utf8_lossy(self.source.peek(self.at..end));
                texts.push((name, text.trim_matches(['\0', ' ']).to_owned()));
            }
            self.at = end.saturating_add(3) & !3;
        }
        Ok(texts)
    }

    /// Bytes of an entry, and the type of number where it is one.
    fn kind(&mut self) -> Result<(u64, Option<Number>)> {
        let at = self.at;
        let number = match self.word(4, "a type")? {
            1 => Number::I8,
            2 => return Ok((1, None)),
            3 => Number::I16,
            4 => Number::I32,
            5 => Number::F32,
            6 => Number::F64,
            7 => Number::U8,
            8 => Number::U16,
            9 => Number::U32,
            10 => Number::I64,
            11 => Number::U64,
            other => return Err(self.source.malformed_binary(at, "a type from 1 to 11", other.to_string())),
        };
        Ok((number.width(), Some(number)))
    }

    fn variable(&mut self, dimensions: &[Dimension]) -> Result<(Variable, Entry)> {
        let at = self.at;
        let name = self.name()?;
        let rank = self.limited("the number of a variable's dimensions", MOST_RANK)?;
        let (mut shape, mut is_record) = (Vec::new(), false);
        for k in 0..rank {
            let place = self.at;
            let id = self.count("the number of a dimension")?;
            let known = usize::try_from(id).ok().and_then(|id| dimensions.get(id));
            let Some(Dimension(length)) = known else {
                let expected = format!("a dimension's number under {}", dimensions.len());
                return Err(self.source.malformed_binary(place, expected, id.to_string()));
            };
            is_record |= k == 0 && *length == 0;
            shape.push(*length);
        }
        let texts = self.attributes()?;
        let (width, number) = self.kind()?;
        // What this says of large variables is wrong by design; the dimensions are right.
        self.word(self.count_bytes, "the size of a variable")?;
        let begin = self.word(self.place_bytes, "the place of a variable")?;
        let inner = shape.iter().skip(usize::from(is_record)).copied().fold(1, u64::saturating_mul);
        let entry = Entry { number, bytes: inner.saturating_mul(width), begin, is_record, texts };
        Ok((Variable { name, shape, at }, entry))
    }
}
