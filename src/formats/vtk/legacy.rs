//! Legacy VTK files: `# vtk DataFile Version`, text or big-endian binary, versions 1 to 5.
//!
//! Unstructured grids are read whole; of polygonal data the polygons. Up to version 4.2 a cell's list of points starts
//! with their number; from 5.0 on there are `OFFSETS` and `CONNECTIVITY`. Attributes that follow the cells are not looked at.

use crate::error::{Error, Result};
use crate::formats::binary::Endian;
use crate::formats::text::{self, LineReader};
use crate::formats::{Format, Outline};
use crate::input::{Input, Spot};

use super::array::{Array, Number, Role, Stored, Stores, Unpacked, check_fits};
use super::ascii;
use super::layout::{Cells, Lists, Points, Types, walk_counted};

/// Legacy VTK.
#[derive(Debug)]
pub struct Legacy;

const MAGIC: &[u8] = b"# vtk DataFile Version";

impl Format for Legacy {
    fn name(&self) -> &'static str {
        "vtk"
    }

    fn title(&self) -> &'static str {
        "VTK legacy, versions 1.0 to 5.1, ASCII and binary: unstructured grids and polygonal data"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["vtk"]
    }

    fn looks_for(&self) -> &'static str {
        "\"# vtk DataFile Version\" in the first line"
    }

    fn detect(&self, head: &[u8]) -> bool {
        head.get(..MAGIC.len()).is_some_and(|start| start.eq_ignore_ascii_case(MAGIC))
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        let mut reader = Reader::open(input)?;
        let grid = reader.grid()?;
        let stores = reader.unpacked.finish()?;
        grid.outline(&stores, out)
    }
}

/// What is known of the grid.
#[derive(Default)]
struct Grid {
    points: Option<Stored>,
    cells: Vec<Section>,
    types: Option<Stored>,
}

/// A section of cells.
struct Section {
    count: u64,
    lists: StoredLists,
    /// The type of all of them, where it follows from the section's name.
    code: Option<u64>,
}

enum StoredLists {
    Counted(Stored),
    Offsets { offsets: Stored, connectivity: Stored },
}

/// Sections of polygonal data and the type of their cells.
const POLYGONAL: [(&str, u64); 4] = [("VERTICES", 2), ("LINES", 4), ("POLYGONS", 7), ("TRIANGLE_STRIPS", 6)];

impl Grid {
    fn outline(self, stores: &Stores, out: &mut dyn Outline) -> Result<()> {
        let truncated = |what: &str| stores.file.truncated(format!("the section {what}"));
        let points = self.points.ok_or_else(|| truncated("POINTS"))?;
        let (file, coordinates) = (stores.file.clone(), stores.array(points, Role::Coordinate)?);
        Points { file, coordinates }.outline(out)?;
        let mut first_cell = 0;
        for section in self.cells {
            let types = match (section.code, self.types) {
                (Some(code), _) => Types::All(code),
                (None, Some(types)) => Types::Each(stores.array(types, Role::Code)?),
                (None, None) => return Err(truncated("CELL_TYPES")),
            };
            let (lists, connectivity) = section.lists.open(stores, section.count)?;
            let count = section.count;
            let file = stores.file.clone();
            let cells =
                Cells { file, connectivity, lists, types, count, first_cell, first_point: 0, points: None };
            cells.outline(out)?;
            first_cell += count;
        }
        Ok(())
    }
}

impl StoredLists {
    fn open(self, stores: &Stores, cells: u64) -> Result<(Lists, Array)> {
        match self {
            StoredLists::Counted(lists) => {
                let lists = stores.array(lists, Role::Point)?;
                Ok((Lists::Counted(walk_counted(&stores.file, &lists, cells)?), lists))
            }
            StoredLists::Offsets { offsets, connectivity } => {
                let offsets = stores.array(offsets, Role::Offset)?;
                let mut first = Vec::new();
                offsets.integers(0..1, &mut first);
                if let Some(first) = first.first().filter(|first| **first != 0) {
                    let error = Error::malformed("0 as the first offset", format!("{}", first.cast_signed()));
                    return Err(stores.file.place(error, offsets.spot(0)));
                }
                let connectivity = stores.array(connectivity, Role::Point)?;
                Ok((Lists::Ends(offsets.without_first()), connectivity))
            }
        }
    }
}

/// Reads a file from section to section.
struct Reader<'i> {
    input: &'i Input,
    at: u64,
    is_text: bool,
    unpacked: Unpacked<'i>,
}

impl<'i> Reader<'i> {
    /// Reads the three lines that every file starts with.
    fn open(input: &'i Input) -> Result<Self> {
        let mut lines = LineReader::new(&input.source, &input.limits, 0);
        let mut line = |expected: &str| match lines.next_line()? {
            Some(line) => Ok((line.at, line.bytes.trim_ascii().to_ascii_uppercase(), line.at + line.bytes.len() as u64)),
            None => Err(input.source.truncated(expected)),
        };
        let (at, magic, _) = line("\"# vtk DataFile Version\"")?;
        if !Legacy.detect(&magic) {
            return Err(input.source.malformed_text(at, "\"# vtk DataFile Version\""));
        }
        line("a title")?;
        let (at, encoding, end) = line("ASCII or BINARY")?;
        let is_text = match &encoding[..] {
            b"ASCII" => true,
            b"BINARY" => false,
            _ => return Err(input.source.malformed_text(at, "ASCII or BINARY")),
        };
        Ok(Self { input, at: end, is_text, unpacked: Unpacked::new(input) })
    }

    /// Reads the sections up to the cells' types, or the end of polygonal data.
    fn grid(&mut self) -> Result<Grid> {
        self.keyword("DATASET")?;
        let dataset = self.word("the name of a dataset")?;
        let is_polygonal = match &dataset.text[..] {
            "UNSTRUCTURED_GRID" => false,
            "POLYDATA" => true,
            "STRUCTURED_POINTS" | "STRUCTURED_GRID" | "RECTILINEAR_GRID" | "FIELD" => {
                let error = Error::unsupported(format!(
                    "a dataset of the kind {} is not read: only UNSTRUCTURED_GRID and POLYDATA are",
                    dataset.text
                ));
                return Err(self.input.source.place(error, Spot::Text(dataset.at)));
            }
            _ => return Err(self.expected(&dataset, "UNSTRUCTURED_GRID or POLYDATA")),
        };
        let mut grid = Grid::default();
        while let Some(section) = self.next_word()? {
            let code = POLYGONAL.iter().find(|row| is_polygonal && row.0 == section.text).map(|row| row.1);
            match &section.text[..] {
                "POINTS" if grid.points.is_none() => grid.points = Some(self.points()?),
                "CELLS" if !is_polygonal && grid.cells.is_empty() => grid.cells.push(self.cells(None)?),
                "CELL_TYPES" if !is_polygonal && grid.types.is_none() => {
                    let count = self.count("the number of cell types")?;
                    grid.types = Some(self.numbers(Number::I32, Role::Code, count)?);
                }
                "METADATA" => self.skip_metadata()?,
                "FIELD" => self.skip_field()?,
                "POINT_DATA" | "CELL_DATA" => break,
                _ if code.is_some() => grid.cells.push(self.cells(code)?),
                _ => {
                    let sections = if is_polygonal { "POLYGONS" } else { "CELLS, CELL_TYPES" };
                    return Err(self.expected(&section, &format!("a section (POINTS, {sections}, CELL_DATA ...)")));
                }
            }
        }
        if grid.cells.is_empty() {
            let sections = if is_polygonal { "POLYGONS" } else { "CELLS" };
            return Err(self.input.source.truncated(format!("the section {sections}")));
        }
        Ok(grid)
    }

    fn points(&mut self) -> Result<Stored> {
        let count = self.count("the number of points")?;
        let Some(numbers) = count.checked_mul(3) else {
            return Err(self.input.source.truncated(format!("{count} points")));
        };
        let number = self.number(Role::Coordinate)?;
        self.numbers(number, Role::Coordinate, numbers)
    }

    fn cells(&mut self, code: Option<u64>) -> Result<Section> {
        let first = self.count("the number of cells")?;
        let second = self.count("the size of the cells' lists")?;
        let before = self.at;
        // Binary lists start with a small number: with bytes that are no word.
        let has_offsets = self.next_word()?.is_some_and(|word| word.text == "OFFSETS");
        if !has_offsets {
            self.at = before;
            let lists = self.numbers(Number::I32, Role::Point, second)?;
            return Ok(Section { count: first, lists: StoredLists::Counted(lists), code });
        }
        let number = self.number(Role::Offset)?;
        let offsets = self.numbers(number, Role::Offset, first)?;
        self.keyword("CONNECTIVITY")?;
        let number = self.number(Role::Point)?;
        let connectivity = self.numbers(number, Role::Point, second)?;
        let lists = StoredLists::Offsets { offsets, connectivity };
        Ok(Section { count: first.saturating_sub(1), lists, code })
    }

    /// The `count` numbers that follow: where they stand, or what was unpacked of them.
    fn numbers(&mut self, number: Number, role: Role, count: u64) -> Result<Stored> {
        if self.is_text {
            let text = self.at..self.input.source.len();
            let (stored, end) = ascii::unpack(self.input, text, Some(count), role, number, &mut self.unpacked)?;
            self.at = end;
            return Ok(stored);
        }
        self.end_line()?;
        let stored = Stored { in_scratch: false, at: self.at, number, endian: Endian::Big, count };
        self.at = check_fits(&self.input.source, &stored, role)?;
        Ok(stored)
    }

    /// Metadata end with an empty line.
    fn skip_metadata(&mut self) -> Result<()> {
        let mut lines = LineReader::new(&self.input.source, &self.input.limits, self.at);
        lines.next_line()?;
        while lines.next_line()?.is_some_and(|line| !line.bytes.trim_ascii().is_empty()) {}
        self.at = lines.position();
        Ok(())
    }

    /// A field is a list of arrays: name, components, tuples, type, then the values.
    fn skip_field(&mut self) -> Result<()> {
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
            let Some(values) = components.checked_mul(tuples) else {
                return Err(self.input.source.truncated(format!("{components} x {tuples} values")));
            };
            self.skip_values(&kind, values)?;
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
        self.skip_bytes(bytes.unwrap_or(u64::MAX))
    }

    /// In binary files a string starts with its length: the first two bits say how many bytes that takes.
    fn skip_strings(&mut self, count: u64) -> Result<()> {
        self.end_line()?;
        for _ in 0..count {
            let head = self.input.source.peek(self.at..self.at + 8);
            let width = match head.first() {
                Some(byte) => 8 >> (byte >> 6),
                None => return Err(self.input.source.truncated("a string")),
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

    /// Goes to the start of the next line, where binary numbers start.
    fn end_line(&mut self) -> Result<()> {
        let rest = self.input.source.peek(self.at..self.at + 256);
        match memchr::memchr(b'\n', rest) {
            Some(end) if rest[..end].iter().all(u8::is_ascii_whitespace) => {
                self.at += end as u64 + 1;
                Ok(())
            }
            _ => Err(self.input.source.malformed_text(self.at, "the end of the line before binary numbers")),
        }
    }

    /// The next word in upper case; `None` at the end of the file.
    fn next_word(&mut self) -> Result<Option<Word>> {
        const STEP: u64 = 256;
        let source = &self.input.source;
        loop {
            let bytes = source.peek(self.at..self.at + STEP);
            let Some(start) = bytes.iter().position(|b| !b.is_ascii_whitespace()) else {
                if bytes.is_empty() {
                    return Ok(None);
                }
                self.at += bytes.len() as u64;
                continue;
            };
            let at = self.at + start as u64;
            let bytes = source.peek(at..at + STEP);
            let len = bytes.iter().position(u8::is_ascii_whitespace).unwrap_or(bytes.len());
            if len as u64 == STEP {
                return Err(source.malformed_text(at, "a word of less than 256 bytes"));
            }
            self.at = at + len as u64;
            let text = bytes[..len].escape_ascii().to_string().to_ascii_uppercase();
            return Ok(Some(Word { at, text }));
        }
    }

    fn word(&mut self, expected: &str) -> Result<Word> {
        match self.next_word()? {
            Some(word) => Ok(word),
            None => Err(self.input.source.truncated(expected)),
        }
    }

    fn keyword(&mut self, expected: &str) -> Result<()> {
        let word = self.word(expected)?;
        if word.text == expected { Ok(()) } else { Err(self.expected(&word, expected)) }
    }

    fn count(&mut self, expected: &str) -> Result<u64> {
        let word = self.word(expected)?;
        text::integer(word.text.as_bytes()).ok_or_else(|| self.expected(&word, expected))
    }

    /// A type that an array of the role may have.
    fn number(&mut self, role: Role) -> Result<Number> {
        let word = self.word("a type of numbers")?;
        let found = number(&word.text).filter(|number| role.allows(*number));
        found.ok_or_else(|| self.expected(&word, &format!("a type of numbers for {}", role.name())))
    }

    fn expected(&self, word: &Word, expected: &str) -> Error {
        self.input.source.malformed_text(word.at, expected)
    }
}

/// A word of the file.
struct Word {
    at: u64,
    text: String,
}

/// The type of numbers that the file calls `name`.
fn number(name: &str) -> Option<Number> {
    Some(match name {
        "CHAR" | "SIGNED_CHAR" | "VTKTYPEINT8" => Number::I8,
        "UNSIGNED_CHAR" | "VTKTYPEUINT8" => Number::U8,
        "SHORT" | "VTKTYPEINT16" => Number::I16,
        "UNSIGNED_SHORT" | "VTKTYPEUINT16" => Number::U16,
        // VTK writes its ids as `int` under this name, whatever their size in memory.
        "INT" | "VTKIDTYPE" | "VTKTYPEINT32" => Number::I32,
        "UNSIGNED_INT" | "VTKTYPEUINT32" => Number::U32,
        // As VTK does on all systems but Windows.
        "LONG" | "VTKTYPEINT64" => Number::I64,
        "UNSIGNED_LONG" | "VTKTYPEUINT64" => Number::U64,
        "FLOAT" => Number::F32,
        "DOUBLE" => Number::F64,
        _ => return None,
    })
}
