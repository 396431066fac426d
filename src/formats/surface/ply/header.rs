//! The header: encoding, tables ("elements" in PLY's words) in the order in which they stand, and their columns.

use std::sync::Arc;

use crate::error::{Error, Result};
use crate::formats::binary::Endian;
use crate::formats::text::{self, LineReader};
use crate::input::{Input, Source, Spot};

/// Most columns in all tables.
const MOST_COLUMNS: usize = 4096;

/// How rows are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    /// A line a row.
    Text,
    /// Numbers one after another.
    Binary(Endian),
}

/// How a number is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Number {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Number {
    fn find(word: &[u8]) -> Option<Self> {
        Some(match word {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    /// Number of bytes.
    pub(super) fn width(self) -> u64 {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// Whether only whole numbers are stored.
    pub(super) fn is_whole(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

/// A column ("property").
#[derive(Debug, Clone)]
pub(super) struct Column {
    name: String,
    /// Of lists: how the length is stored.
    pub(super) length: Option<Number>,
    pub(super) number: Number,
}

/// A table ("element").
#[derive(Debug, Clone)]
pub(super) struct Table {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) columns: Vec<Column>,
    /// Of vertices: the columns of x, y and z.
    pub(super) axes: [usize; 3],
    /// Of faces: the column that lists the vertices.
    pub(super) corners: usize,
}

impl Table {
    /// Number of bytes of a row, where there are no lists.
    pub(super) fn width(&self) -> Option<u64> {
        self.columns.iter().map(|c| c.length.is_none().then(|| c.number.width())).sum()
    }

    fn find(&self, names: &[&str], is_list: bool) -> Option<usize> {
        self.columns.iter().position(|c| c.length.is_some() == is_list && names.contains(&c.name.as_str()))
    }

    /// Finds the columns that matter; an error says what is missing.
    fn resolve(&mut self) -> Result<()> {
        let missing = |what: &str, table: &Self| {
            let columns: Vec<_> = table.columns.iter().map(|column| column.name.as_str()).collect();
            Error::malformed(format!("{what} of element {}", table.name), columns.join(", "))
        };
        match self.name.as_str() {
            "vertex" => {
                for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
                    let column = self.find(&[name], false);
                    self.axes[axis] = column.ok_or_else(|| missing("properties x, y and z", self))?;
                }
            }
            "face" => {
                let column = self.find(&["vertex_indices", "vertex_index"], true);
                let column = column.filter(|column| self.columns[*column].number.is_whole());
                self.corners =
                    column.ok_or_else(|| missing("a list vertex_indices of whole numbers", self))?;
            }
            _ => {}
        }
        Ok(())
    }
}

/// What the header says.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) tables: Vec<Arc<Table>>,
    /// The byte after it.
    pub(super) end: u64,
}

impl Header {
    pub(super) fn read(input: &Input) -> Result<Self> {
        let source = &input.source;
        let mut lines = LineReader::new(source, &input.limits, 0);
        let mut encoding = None;
        let mut tables: Vec<Table> = Vec::new();
        let mut columns = 0;
        let mut at = 0;
        while let Some(line) = lines.next_line()? {
            let words: Vec<_> = text::tokens(line.at, line.bytes).map(|word| word.bytes).take(6).collect();
            let malformed = |expected: &str| Err(source.malformed_text(line.at, expected));
            match words[..] {
                [b"ply"] if line.at == 0 => {}
                [b"comment" | b"obj_info", ..] | [] => {}
                [b"format", word, version] => match (word, version) {
                    (b"ascii", b"1.0") => encoding = Some(Encoding::Text),
                    (b"binary_little_endian", b"1.0") => encoding = Some(Encoding::Binary(Endian::Little)),
                    (b"binary_big_endian", b"1.0") => encoding = Some(Encoding::Binary(Endian::Big)),
                    _ => {
                        return malformed("format ascii, binary_little_endian or binary_big_endian, and 1.0");
                    }
                },
                [b"element", name, count] => {
                    let Some(count) = text::integer(count) else {
                        return malformed("an element's name and number of rows");
                    };
                    let name = String::from_utf8_lossy(name).into_owned();
                    if tables.iter().any(|table| table.name == name) {
                        return malformed("an element that is not there yet");
                    }
                    tables.push(Table { name, count, columns: Vec::new(), axes: [0; 3], corners: 0 });
                    columns += 1;
                }
                [b"property", ref rest @ ..] => {
                    let Some((table, column)) = tables.last_mut().zip(column(rest)) else {
                        return malformed("a property of an element: its type (perhaps a list) and name");
                    };
                    table.columns.push(column);
                    columns += 1;
                }
                [b"end_header"] => {
                    let end = lines.position().min(source.len());
                    return Self::finish(source, encoding, tables, end);
                }
                _ => {
                    return malformed(
                        "a line of the header: format, comment, element, property or end_header",
                    );
                }
            }
            if columns > MOST_COLUMNS {
                let error = Error::limit("number of elements and properties of the header", MOST_COLUMNS);
                return Err(source.place(error, Spot::Text(line.at)));
            }
            at = lines.position();
        }
        Err(source.malformed_text(at, "end_header"))
    }

    fn finish(source: &Source, encoding: Option<Encoding>, mut tables: Vec<Table>, end: u64) -> Result<Self> {
        let Some(encoding) = encoding else {
            return Err(source.malformed_text(0, "a line \"format\" in the header"));
        };
        for table in &mut tables {
            table.resolve().map_err(|error| source.place(error, Spot::Text(0)))?;
        }
        if tables.iter().any(|table| table.name == "tristrips") {
            return Err(source
                .place(Error::unsupported("strips of triangles (tristrips) are not read"), Spot::Text(0)));
        }
        Ok(Self { encoding, tables: tables.into_iter().map(Arc::new).collect(), end })
    }

    /// The table of faces.
    pub(super) fn faces(&self) -> Option<&Table> {
        self.tables.iter().map(|table| &**table).find(|table| table.name == "face")
    }
}

/// `float x` or `list uchar int vertex_indices`.
fn column(words: &[&[u8]]) -> Option<Column> {
    let (length, number, name) = match *words {
        [b"list", length, number, name] => {
            (Some(Number::find(length).filter(|n| n.is_whole())?), Number::find(number)?, name)
        }
        [number, name] => (None, Number::find(number)?, name),
        _ => return None,
    };
    Some(Column { name: String::from_utf8_lossy(name).into_owned(), length, number })
}
