//! What a legacy file holds besides the mesh: gone over, so that a file that ends too early is found out.

use crate::error::Result;
use crate::formats::text::{self, LineReader};

use super::super::role::Role;
use super::super::{ascii, marks};
use super::reader::{Reader, Word, number};
use crate::formats::array::Stored;

/// What of the data matters to the mesh.
#[derive(Default)]
pub(super) struct Data {
    /// What data are given for, once they are: how many points or cells, and whether these are cells.
    of: Option<(u64, bool)>,
    /// How well it is known that it says which region a cell is in, and the array.
    pub(super) regions: Option<(usize, Stored)>,
    /// Marks of cells, and those that say that a cell is left out.
    pub(super) ghosts: Option<(Stored, u64)>,
}

impl Data {
    /// The regions and marks of so many cells; those of another number of cells are not.
    pub(super) fn of_cells(self, cells: u64) -> Self {
        let regions = self.regions.filter(|(_, stored)| stored.count == cells);
        let ghosts = self.ghosts.filter(|(stored, _)| stored.count == cells);
        Self { regions, ghosts, ..self }
    }

    /// Whether an array of that name, of one number a cell, matters.
    fn wants(&self, name: &str) -> bool {
        let is_better = |rank: usize| self.regions.is_none_or(|(known, _)| rank < known);
        marks::hidden(name).is_some() || marks::region(name).is_some_and(is_better)
    }

    fn take(&mut self, name: &str, stored: Stored) {
        match (marks::hidden(name), marks::region(name)) {
            (Some(mask), _) => self.ghosts = Some((stored, mask)),
            (None, Some(rank)) => self.regions = Some((rank, stored)),
            (None, None) => {}
        }
    }
}

impl Reader<'_> {
    /// Goes over a section that is neither points nor cells; `expected` tells what else might stand here.
    pub(super) fn other_section(&mut self, section: &Word, expected: &str, data: &mut Data) -> Result<()> {
        match (&section.text[..], data.of) {
            ("METADATA", _) => self.skip_metadata(),
            ("FIELD", None) => self.skip_field(&mut Data::default()),
            ("FIELD", Some(_)) => self.skip_field(data),
            ("POINT_DATA" | "CELL_DATA", _) => {
                let count = self.count("the number of points or cells")?;
                data.of = Some((count, section.text == "CELL_DATA"));
                Ok(())
            }
            ("SCALARS", Some((tuples, true))) => self.scalars(tuples, data),
            (_, Some((tuples, _))) => self.skip_attribute(section, tuples),
            (_, None) => Err(self.expected(section, expected)),
        }
    }

    /// Goes over one section of the data of `tuples` points or cells.
    pub fn skip_attribute(&mut self, section: &Word, tuples: u64) -> Result<()> {
        let components = match &section.text[..] {
            "LOOKUP_TABLE" => return self.skip_lookup_table(),
            "SCALARS" => return self.scalars(tuples, &mut Data::default()),
            "COLOR_SCALARS" => return self.skip_colors(tuples),
            "TEXTURE_COORDINATES" => {
                self.word("the name of an array")?;
                let components = self.count("the number of components")?;
                let kind = self.word("a type")?;
                return self.skip_values(&kind, tuples.saturating_mul(components));
            }
            "VECTORS" | "NORMALS" => 3,
            "TENSORS" => 9,
            "TENSORS6" => 6,
            "GLOBAL_IDS" | "PEDIGREE_IDS" | "EDGE_FLAGS" => 1,
            _ => return Err(self.expected(section, "a section of data (SCALARS, VECTORS, FIELD ...)")),
        };
        self.word("the name of an array")?;
        let kind = self.word("a type")?;
        self.skip_values(&kind, tuples.saturating_mul(components))
    }

    /// The number of components is optional; the name of a table of colours follows.
    fn scalars(&mut self, tuples: u64, data: &mut Data) -> Result<()> {
        let name = self.name()?;
        let kind = self.word("a type")?;
        let mut components = 1;
        let before = self.at;
        match text::integer(self.word("LOOKUP_TABLE")?.text.as_bytes()) {
            Some(count) => components = count,
            None => self.at = before,
        }
        self.keyword("LOOKUP_TABLE")?;
        self.word("the name of a table")?;
        self.values(&name, &kind, (components, tuples), data)
    }

    /// The name of an array as it stands there.
    fn name(&mut self) -> Result<String> {
        let word = self.word("the name of an array")?;
        let raw = self.input.source.peek(word.at..self.at);
        Ok(String::from_utf8_lossy(raw).into_owned())
    }

    /// Takes in the values of an array of cell data that matters; goes over others.
    fn values(
        &mut self,
        name: &str,
        kind: &Word,
        (components, tuples): (u64, u64),
        data: &mut Data,
    ) -> Result<()> {
        let is_of_cells = data.of.is_some_and(|(count, of_cells)| of_cells && count == tuples);
        match number(&kind.text) {
            Some(number) if is_of_cells && components == 1 && data.wants(name) => {
                let stored = self.numbers(number, Role::Mark, tuples)?;
                data.take(name, stored);
                Ok(())
            }
            _ => self.skip_values(kind, tuples.saturating_mul(components)),
        }
    }

    /// Bytes in binary files, real numbers in text.
    fn skip_colors(&mut self, tuples: u64) -> Result<()> {
        self.word("the name of an array")?;
        let components = self.count("the number of components")?;
        self.skip_bytes_or_words(tuples.saturating_mul(components))
    }

    fn skip_lookup_table(&mut self) -> Result<()> {
        self.word("the name of a table")?;
        let colors = self.count("the number of colours")?;
        self.skip_bytes_or_words(colors.saturating_mul(4))
    }

    fn skip_bytes_or_words(&mut self, count: u64) -> Result<()> {
        let kind = Word { at: self.at, text: "UNSIGNED_CHAR".into() };
        self.skip_values(&kind, count)
    }

    /// Metadata end with an empty line.
    pub fn skip_metadata(&mut self) -> Result<()> {
        let mut lines = LineReader::new(&self.input.source, &self.input.limits, self.at);
        lines.next_line()?;
        while lines.next_line()?.is_some_and(|line| !line.bytes.trim_ascii().is_empty()) {}
        self.at = lines.position();
        Ok(())
    }

    /// Goes over a field, a list of arrays: name, components, tuples, type, then the values.
    pub(super) fn skip_field(&mut self, data: &mut Data) -> Result<()> {
        self.word("the name of a field")?;
        let arrays = self.count("the number of arrays")?;
        for _ in 0..arrays {
            let mut name = self.name()?;
            if name.eq_ignore_ascii_case("METADATA") {
                self.skip_metadata()?;
                name = self.name()?;
            }
            if name.eq_ignore_ascii_case("NULL_ARRAY") {
                continue;
            }
            let components = self.count("the number of components")?;
            let tuples = self.count("the number of tuples")?;
            let kind = self.word("a type")?;
            self.values(&name, &kind, (components, tuples), data)?;
        }
        Ok(())
    }

    fn skip_values(&mut self, kind: &Word, values: u64) -> Result<()> {
        let source = &self.input.source;
        if self.is_text {
            self.at = match &kind.text[..] {
                "STRING" => ascii::skip_lines(self.input, self.at, values)?,
                _ => ascii::skip(self.input, self.at..source.len(), values)?,
            };
            return Ok(());
        }
        let bytes = match (&kind.text[..], number(&kind.text)) {
            ("STRING", _) => return self.skip_strings(values),
            ("BIT", _) => Some(values.div_ceil(8)),
            (_, Some(number)) => values.checked_mul(number.width()),
            _ => return Err(self.expected(kind, "a type of values")),
        };
        self.end_line()?;
        // Too many to count are too many for the file.
        self.skip_bytes(bytes.unwrap_or(u64::MAX))
    }

    /// In binary files a string starts with its length: the first two bits say how many bytes that takes.
    fn skip_strings(&mut self, count: u64) -> Result<()> {
        self.end_line()?;
        for _ in 0..count {
            let head = self.input.source.peek(self.at..self.at + 8);
            let width = match head.first() {
                Some(byte) => 8 >> (byte >> 6),
                None => return Err(self.truncated("a string")),
            };
            let mut bytes = [0; 8];
            let head = &head[..head.len().min(width)];
            bytes[8 - width..][..head.len()].copy_from_slice(head);
            bytes[8 - width] &= 0x3f;
            self.skip_bytes((width as u64).saturating_add(u64::from_be_bytes(bytes)))?;
        }
        Ok(())
    }

    fn skip_bytes(&mut self, bytes: u64) -> Result<()> {
        let source = &self.input.source;
        match self.at.checked_add(bytes) {
            Some(end) if end <= source.len() => self.at = end,
            _ => return Err(source.truncated(format!("{bytes} bytes from byte {}", self.at))),
        }
        Ok(())
    }
}
