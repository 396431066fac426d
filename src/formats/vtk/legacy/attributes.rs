//! What a legacy file holds besides the mesh: gone over, so that a file that ends too early is found out.

use crate::error::Result;
use crate::formats::text::{self, LineReader};

use super::super::ascii;
use super::reader::{Reader, Word, number};

impl Reader<'_> {
    /// Goes over one section of the data of `tuples` points or cells.
    pub fn skip_attribute(&mut self, section: &Word, tuples: u64) -> Result<()> {
        let components = match &section.text[..] {
            "METADATA" => return self.skip_metadata(),
            "FIELD" => return self.skip_field(),
            "LOOKUP_TABLE" => return self.skip_lookup_table(),
            "SCALARS" => return self.skip_scalars(tuples),
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
    fn skip_scalars(&mut self, tuples: u64) -> Result<()> {
        self.word("the name of an array")?;
        let kind = self.word("a type")?;
        let mut components = 1;
        let before = self.at;
        match text::integer(self.word("LOOKUP_TABLE")?.text.as_bytes()) {
            Some(count) => components = count,
            None => self.at = before,
        }
        self.keyword("LOOKUP_TABLE")?;
        self.word("the name of a table")?;
        self.skip_values(&kind, tuples.saturating_mul(components))
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

    /// A field is a list of arrays: name, components, tuples, type, then the values.
    pub fn skip_field(&mut self) -> Result<()> {
        self.word("the name of a field")?;
        let arrays = self.count("the number of arrays")?;
        for _ in 0..arrays {
            let mut name = self.word("the name of an array")?;
            if name.text == "METADATA" {
                self.skip_metadata()?;
                name = self.word("the name of an array")?;
            }
            if name.text == "NULL_ARRAY" {
                continue;
            }
            let components = self.count("the number of components")?;
            let tuples = self.count("the number of tuples")?;
            let kind = self.word("a type")?;
            self.skip_values(&kind, components.saturating_mul(tuples))?;
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
