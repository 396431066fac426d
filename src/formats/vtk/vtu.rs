//! VTU: unstructured grids in VTK's XML files.
//!
//! The tags say where the arrays stand: as text or base64 between tags, or behind `AppendedData`, where the file stops
//! being XML and offsets rule. A file may have several pieces; the numbers of points start anew in each.

use crate::error::{Error, Result};
use crate::formats::array::{Number, Origin, Stored, Stores, Unpacked, check_fits};
use crate::formats::binary::Endian;
use crate::formats::{Format, Outline};
use crate::input::{Input, Spot};
use crate::mesh::Shape;

use super::ascii;
use super::layout::{Cells, Lists, Points, Types};
use super::markup::{Tag, Tags};
use super::payload::{Bytes, Compressor, HeaderType, unpack_blocks};
use super::role::Role;

/// VTK's XML unstructured grids.
#[derive(Debug)]
pub struct Vtu;

impl Format for Vtu {
    fn name(&self) -> &'static str {
        "vtu"
    }

    fn title(&self) -> &'static str {
        "VTK XML unstructured grid: ascii, binary and appended data, plain or compressed by zlib, LZ4 or LZMA"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["vtu", "pvtu"]
    }

    fn looks_for(&self) -> &'static str {
        "the XML element <VTKFile"
    }

    fn own_orientation(&self) -> &'static [Shape] {
        super::cells::OWN_ORIENTATION
    }

    fn detect(&self, head: &[u8]) -> bool {
        let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
        head.trim_ascii_start().starts_with(b"<") && memchr::memmem::find(head, b"<VTKFile").is_some()
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        let file = read_tags(input)?;
        let mut unpacked = Unpacked::new(input);
        let grids = file.pieces.iter().map(|piece| piece.unpack(input, &file, &mut unpacked));
        let grids = grids.collect::<Result<Vec<_>>>()?;
        let stores = unpacked.finish()?;
        let (mut first_point, mut first_cell) = (0, 0);
        let several = grids.len() > 1;
        for grid in grids {
            let (points, cells) = (grid.points, grid.cells);
            grid.outline(&stores, first_point, first_cell, several, out)?;
            first_point += points;
            first_cell += cells;
        }
        Ok(())
    }
}

/// What the tags say.
struct File {
    header: HeaderType,
    compressor: Option<Compressor>,
    pieces: Vec<Piece>,
    appended: Option<Appended>,
}

/// Where appended data start, after the `_`.
#[derive(Clone, Copy)]
struct Appended {
    at: u64,
    is_base64: bool,
}

/// A piece of a grid as its tags describe it.
struct Piece {
    at: u64,
    points: u64,
    cells: u64,
    /// By role.
    arrays: [Option<DataArray>; 4],
}

/// An array as its tag describes it.
struct DataArray {
    at: u64,
    number: Number,
    place: Place,
}

enum Place {
    Text(u64),
    Base64(u64),
    Appended(u64),
}

/// A piece of a grid whose arrays can be read.
struct Grid {
    points: u64,
    cells: u64,
    /// By role.
    arrays: [Stored; 4],
}

const ROLES: [Role; 4] = [Role::Coordinate, Role::Point, Role::Offset, Role::Code];

/// Reads all tags that matter.
fn read_tags(input: &Input) -> Result<File> {
    let source = &input.source;
    let mut tags = Tags::new(input);
    let mut file: Option<File> = None;
    let mut piece: Option<Piece> = None;
    // The section of the piece that the tag at hand is in.
    let mut section = None;
    while let Some(tag) = tags.next_tag()? {
        let Some(known) = &mut file else {
            file = Some(read_head(input, &tag)?);
            continue;
        };
        match (tag.name(), tag.closes) {
            ("VTKFile", true) => {
                return file.filter(|_| piece.is_none()).ok_or_else(|| unclosed(input, &tag));
            }
            ("Piece", false) if piece.is_none() => {
                let (points, cells) =
                    (count(input, &tag, "NumberOfPoints")?, count(input, &tag, "NumberOfCells")?);
                let new = Piece { at: tag.at, points, cells, arrays: [const { None }; 4] };
                if tag.is_empty { known.pieces.extend(new.checked(input)?) } else { piece = Some(new) }
            }
            ("Piece", true) => {
                if let Some(piece) = piece.take() {
                    known.pieces.extend(piece.checked(input)?);
                }
            }
            ("Points" | "Cells", closes) => {
                section = (!closes && !tag.is_empty).then(|| tag.name() == "Points")
            }
            ("DataArray", false) => {
                if let (Some(piece), Some(is_points)) = (&mut piece, section) {
                    piece.take_array(input, &tag, is_points)?;
                }
            }
            ("AppendedData", false) => {
                known.appended = Some(read_appended(input, &tag)?);
                return file.filter(|_| piece.is_none()).ok_or_else(|| unclosed(input, &tag));
            }
            _ => {}
        }
    }
    Err(source.truncated(if file.is_none() { "<VTKFile>" } else { "</VTKFile>" }))
}

fn unclosed(input: &Input, tag: &Tag) -> Error {
    input.source.malformed_text(tag.at, "</Piece>")
}

fn read_head(input: &Input, tag: &Tag) -> Result<File> {
    let source = &input.source;
    let refuse = |what: String| source.place(Error::unsupported(what), Spot::Text(tag.at));
    if tag.name() != "VTKFile" || tag.closes {
        return Err(source.malformed_text(tag.at, "<VTKFile>"));
    }
    match tag.attribute(source, "type")?.as_deref() {
        Some("UnstructuredGrid") => {}
        Some("PUnstructuredGrid") => {
            return Err(refuse(
                "this file names its pieces by reference: score the pieces (.vtu) instead".into(),
            ));
        }
        Some(other) => {
            return Err(refuse(format!(
                "a VTK file of the type {other} is not read: only UnstructuredGrid is"
            )));
        }
        None => return Err(source.malformed_text(tag.at, "the attribute type")),
    }
    let endian = match tag.attribute(source, "byte_order")?.as_deref() {
        Some("LittleEndian") | None => Endian::Little,
        Some("BigEndian") => Endian::Big,
        Some(other) => return Err(refuse(format!("unknown byte_order {other}"))),
    };
    let width = match tag.attribute(source, "header_type")?.as_deref() {
        Some("UInt32") | None => 4,
        Some("UInt64") => 8,
        Some(other) => return Err(refuse(format!("unknown header_type {other}"))),
    };
    let compressor = match tag.attribute(source, "compressor")?.as_deref() {
        None | Some("") => None,
        Some(name) => {
            Some(Compressor::find(name).ok_or_else(|| refuse(format!("unknown compressor {name}")))?)
        }
    };
    Ok(File { header: HeaderType { width, endian }, compressor, pieces: Vec::new(), appended: None })
}

/// Appended data start after an underscore. Nobody can tell where they end but by the end of the file.
fn read_appended(input: &Input, tag: &Tag) -> Result<Appended> {
    let source = &input.source;
    let is_base64 = match tag.attribute(source, "encoding")?.as_deref() {
        Some("raw") => false,
        Some("base64") => true,
        _ => return Err(source.malformed_text(tag.at, "the attribute encoding, \"raw\" or \"base64\"")),
    };
    let head = source.peek(tag.end..tag.end + 4096);
    let blanks = head.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
    if head.get(blanks) != Some(&b'_') {
        return Err(source.malformed_text(tag.end + blanks as u64, "_ before the appended data"));
    }
    let tail = source.peek(source.len().saturating_sub(4096)..source.len());
    if !tail.trim_ascii_end().ends_with(b"</VTKFile>") {
        return Err(source.truncated("</VTKFile>"));
    }
    Ok(Appended { at: tag.end + blanks as u64 + 1, is_base64 })
}

fn count(input: &Input, tag: &Tag, name: &str) -> Result<u64> {
    let value = tag.attribute(&input.source, name)?;
    let count = value.and_then(|value| crate::formats::text::integer(value.as_bytes()));
    count.ok_or_else(|| input.source.malformed_text(tag.at, format!("the attribute {name}, a number")))
}

/// The type of numbers that the file calls `name`.
fn number(name: &str) -> Option<Number> {
    Some(match name {
        "Int8" => Number::I8,
        "UInt8" => Number::U8,
        "Int16" => Number::I16,
        "UInt16" => Number::U16,
        "Int32" => Number::I32,
        "UInt32" => Number::U32,
        "Int64" => Number::I64,
        "UInt64" => Number::U64,
        "Float32" => Number::F32,
        "Float64" => Number::F64,
        _ => return None,
    })
}

impl Piece {
    /// Keeps what the tag of an array says, if it is one that matters.
    fn take_array(&mut self, input: &Input, tag: &Tag, is_points: bool) -> Result<()> {
        let source = &input.source;
        let role = if is_points {
            Role::Coordinate
        } else {
            let name = tag.attribute(source, "Name")?.unwrap_or_default();
            match ROLES.iter().find(|role| role.name() == name) {
                Some(role) => *role,
                None => return Ok(()),
            }
        };
        if is_points && tag.attribute(source, "NumberOfComponents")?.as_deref() != Some("3") {
            return Err(source.malformed_text(tag.at, "points with NumberOfComponents=\"3\""));
        }
        let kind = tag.attribute(source, "type")?.unwrap_or_default();
        let Some(number) = number(&kind).filter(|number| role.allows(*number)) else {
            return Err(source.malformed_text(tag.at, format!("a type of numbers for {}", role.name())));
        };
        let place = match tag.attribute(source, "format")?.as_deref() {
            Some("appended") => Place::Appended(count(input, tag, "offset")?),
            Some("ascii") => Place::Text(tag.end),
            Some("binary") => Place::Base64(tag.end),
            _ => return Err(source.malformed_text(tag.at, "the attribute format: ascii, binary or appended")),
        };
        self.arrays[role as usize] = Some(DataArray { at: tag.at, number, place });
        Ok(())
    }

    /// The piece if it holds anything; it then must have all its arrays.
    fn checked(self, input: &Input) -> Result<Option<Self>> {
        if self.points == 0 && self.cells == 0 {
            return Ok(None);
        }
        let needed = if self.cells == 0 { &ROLES[..1] } else { &ROLES };
        for role in needed {
            if self.arrays[*role as usize].is_none() {
                let expected = format!("a piece with an array of {}", role.name());
                return Err(input.source.malformed_text(self.at, expected));
            }
        }
        Ok(Some(self))
    }

    fn unpack(&self, input: &Input, file: &File, out: &mut Unpacked<'_>) -> Result<Grid> {
        let nothing = Stored {
            origin: Origin::Tag(self.at),
            at: 0,
            number: Number::U8,
            endian: Endian::Little,
            count: 0,
        };
        let mut arrays = [nothing; 4];
        for (role, stored) in ROLES.into_iter().zip(&mut arrays) {
            let count = match role {
                Role::Coordinate => Some(self.points.saturating_mul(3)),
                Role::Point => None,
                Role::Offset | Role::Code => Some(self.cells),
            };
            if let Some(array) = &self.arrays[role as usize]
                && count != Some(0)
                && (self.cells > 0 || role == Role::Coordinate)
            {
                let done = array.unpack(input, file, role, count, out);
                *stored = done.map_err(|e| input.source.place(e, Spot::Text(array.at)))?;
            }
        }
        Ok(Grid { points: self.points, cells: self.cells, arrays })
    }
}

impl DataArray {
    /// Finds the array's numbers, or unpacks them. Errors without a place are about the tag.
    fn unpack(
        &self,
        input: &Input,
        file: &File,
        role: Role,
        count: Option<u64>,
        out: &mut Unpacked<'_>,
    ) -> Result<Stored> {
        let source = &input.source;
        let mut bytes = match (&self.place, file.appended) {
            (Place::Text(at), _) => {
                return Ok(ascii::unpack(input, *at..source.len(), count, role, self.number, out)?.0);
            }
            (Place::Base64(at), _) => Bytes::base64(source, *at),
            (Place::Appended(offset), Some(appended)) => {
                let at = appended.at.saturating_add(*offset);
                if appended.is_base64 { Bytes::base64(source, at) } else { Bytes::raw(source, at) }
            }
            (Place::Appended(_), None) => return Err(Error::malformed("appended data", "none")),
        };
        let (number, endian, width) = (self.number, file.header.endian, self.number.width());
        let expected = count.map(|count| count.saturating_mul(width));
        let mut stored = Stored { origin: Origin::Tag(self.at), at: out.len(), number, endian, count: 0 };
        if let Some(compressor) = file.compressor {
            unpack_blocks(input, &mut bytes, file.header, compressor, expected, out)?;
            stored.count = whole(out.len() - stored.at, width)?;
            return Ok(stored);
        }
        let len = bytes.number(file.header)?;
        if expected.is_some_and(|expected| expected != len) {
            return Err(wrong_len(expected.unwrap_or(0), role, len));
        }
        stored.count = whole(len, width)?;
        if bytes.is_base64() {
            bytes.copy(len, out)?;
        } else {
            stored = Stored { origin: Origin::File, at: bytes.position(), ..stored };
            check_fits(source, &stored, role.name())?;
        }
        Ok(stored)
    }
}

fn wrong_len(expected: u64, role: Role, found: u64) -> Error {
    Error::malformed(format!("{expected} bytes of {}", role.name()), format!("{found} bytes"))
}

/// Number of numbers in so many bytes.
fn whole(bytes: u64, width: u64) -> Result<u64> {
    if bytes.is_multiple_of(width) {
        return Ok(bytes / width);
    }
    Err(Error::malformed(format!("an array of numbers of {width} bytes"), format!("{bytes} bytes")))
}

impl Grid {
    fn outline(
        self,
        stores: &Stores,
        first_point: u64,
        first_cell: u64,
        several: bool,
        out: &mut dyn Outline,
    ) -> Result<()> {
        let array = |role: Role| stores.array(self.arrays[role as usize], role.name());
        let file = stores.file.clone();
        Points { file: file.clone(), coordinates: array(Role::Coordinate)? }.outline(out)?;
        let (lists, types) = (Lists::Ends(array(Role::Offset)?), Types::Each(array(Role::Code)?));
        let (connectivity, count) = (array(Role::Point)?, self.cells);
        let points = several.then_some(self.points);
        Cells { file, connectivity, lists, types, count, first_cell, first_point, points }.outline(out)
    }
}
