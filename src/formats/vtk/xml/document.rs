//! What the tags of a file say.

use super::super::markup::{Tag, Tags};
use super::super::payload::{Compressor, HeaderType};
use super::attributes::{Appended, Uniform, count, numbers};
use super::data_array::DataArray;
use super::section::{Kind, Section, Slot};
use crate::error::{Error, Result};
use crate::formats::binary::Endian;
use crate::formats::text;
use crate::input::{Input, Spot};

/// Most names of other files.
const MOST_REFERENCES: usize = 1 << 20;
/// Longest name of a block.
const LONGEST_NAME: usize = 256;

/// A file as its tags describe it.
pub(super) struct Document {
    pub(super) kind: Kind,
    pub(super) header: HeaderType,
    pub(super) compressor: Option<Compressor>,
    pub(super) appended: Option<Appended>,
    pub(super) pieces: Vec<Piece>,
    pub(super) references: Vec<Reference>,
    /// Where the vertices of a uniform grid stand.
    pub(super) uniform: Uniform,
}

/// A piece of a grid as its tags describe it.
pub(super) struct Piece {
    pub(super) at: u64,
    pub(super) points: u64,
    /// Cells of each list.
    pub(super) cells: Vec<u64>,
    /// First and last vertex along each axis, of a structured grid.
    pub(super) extent: Option<[i64; 6]>,
    pub(super) arrays: Vec<(Slot, DataArray)>,
}

/// The name of a file that holds a piece or a block.
pub(super) struct Reference {
    pub(super) at: u64,
    pub(super) name: String,
    pub(super) block: Option<String>,
}

impl Document {
    /// Reads all tags that matter.
    pub(super) fn read(input: &Input) -> Result<Self> {
        let mut tags = Tags::new(input);
        let Some(head) = tags.next_tag()? else { return Err(input.source.truncated("<VTKFile>")) };
        let mut reader = Reader {
            input,
            document: Self::of_head(input, &head)?,
            piece: None,
            section: None,
            blocks: Vec::new(),
            step: None,
        };
        while let Some(tag) = tags.next_tag()? {
            if reader.tag(&tag)? {
                return match reader.piece {
                    None => Ok(reader.document),
                    Some(_) => Err(input.source.malformed_text(tag.at, "</Piece>")),
                };
            }
        }
        Err(input.source.truncated("</VTKFile>"))
    }

    fn of_head(input: &Input, tag: &Tag) -> Result<Self> {
        let source = &input.source;
        let refuse = |what: String| source.place(Error::unsupported(what), Spot::Text(tag.at));
        if tag.name() != "VTKFile" || tag.closes {
            return Err(source.malformed_text(tag.at, "<VTKFile>"));
        }
        let Some(kind) = tag.attribute(source, "type")? else {
            return Err(source.malformed_text(tag.at, "the attribute type"));
        };
        let kind =
            Kind::find(&kind).ok_or_else(|| refuse(format!("a VTK file of the type {kind} is not read")))?;
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
        let uniform = Uniform::default();
        let header = HeaderType { width, endian };
        Ok(Self {
            kind,
            header,
            compressor,
            appended: None,
            pieces: Vec::new(),
            references: Vec::new(),
            uniform,
        })
    }
}

/// Goes from tag to tag.
struct Reader<'i> {
    input: &'i Input,
    document: Document,
    piece: Option<Piece>,
    /// The section of the piece that the tag at hand is in, and how many of its arrays matter so far.
    section: Option<(Section, usize)>,
    /// The names of the open blocks.
    blocks: Vec<Option<String>>,
    /// The time step that is read of a collection.
    step: Option<String>,
}

impl Reader<'_> {
    /// Takes in a tag; whether it is the last that matters.
    fn tag(&mut self, tag: &Tag) -> Result<bool> {
        let source = &self.input.source;
        match (tag.name(), tag.closes) {
            ("VTKFile", true) => return Ok(true),
            ("Piece", false) if self.piece.is_none() => {
                if let Some(name) = tag.attribute(source, "Source")? {
                    self.reference(tag, name, None)?;
                } else if self.document.kind != Kind::References {
                    let piece = Piece::of(self.input, tag, self.document.kind)?;
                    if tag.is_empty { self.end_piece(piece)? } else { self.piece = Some(piece) }
                }
            }
            ("Piece", true) => {
                if let Some(piece) = self.piece.take() {
                    self.end_piece(piece)?;
                }
            }
            ("DataArray", false) => self.array(tag)?,
            ("AppendedData", false) => {
                self.document.appended = Some(Appended::find(self.input, tag)?);
                return Ok(true);
            }
            ("ImageData", false) if self.document.kind == Kind::Uniform => {
                self.document.uniform.read(self.input, tag)?;
            }
            ("Block" | "Partitions", true) => drop(self.blocks.pop()),
            ("Block" | "Partitions", false) if !tag.is_empty => {
                self.blocks.push(tag.attribute(source, "name")?.filter(|name| !name.is_empty()));
            }
            ("DataSet", false) if self.document.kind == Kind::References => self.data_set(tag)?,
            (name, closes) => {
                if self.piece.is_some()
                    && let Some(section) = Section::find(self.document.kind, name)
                {
                    self.section = (!closes && !tag.is_empty).then_some((section, 0));
                }
            }
        }
        Ok(false)
    }

    /// A file of a block, or of a time step.
    fn data_set(&mut self, tag: &Tag) -> Result<()> {
        let source = &self.input.source;
        let Some(file) = tag.attribute(source, "file")? else { return Ok(()) };
        if let Some(step) = tag.attribute(source, "timestep")?
            && *self.step.get_or_insert_with(|| step.clone()) != step
        {
            return Ok(());
        }
        let own = tag.attribute(source, "name")?.filter(|name| !name.is_empty());
        let block = own.or_else(|| self.blocks.iter().rev().flatten().next().cloned());
        self.reference(tag, file, block)
    }

    fn reference(&mut self, tag: &Tag, name: String, block: Option<String>) -> Result<()> {
        if self.document.references.len() >= MOST_REFERENCES {
            let error = Error::limit("number of files that a file names", MOST_REFERENCES);
            return Err(self.input.source.place(error, Spot::Text(tag.at)));
        }
        let block = block.map(|block| block.chars().take(LONGEST_NAME).collect());
        self.document.references.push(Reference { at: tag.at, name, block });
        Ok(())
    }

    /// Keeps what the tag of an array says, if it is one that matters.
    fn array(&mut self, tag: &Tag) -> Result<()> {
        let (Some(piece), Some((section, so_far))) = (&mut self.piece, &mut self.section) else {
            return Ok(());
        };
        let source = &self.input.source;
        let name = tag.attribute(source, "Name")?.unwrap_or_default();
        let Some(slot) = section.slot(&name, *so_far) else { return Ok(()) };
        let components = tag.attribute(source, "NumberOfComponents")?;
        match slot {
            Slot::Points if components.as_deref() != Some("3") => {
                return Err(source.malformed_text(tag.at, "points with NumberOfComponents=\"3\""));
            }
            Slot::Ghosts(_) | Slot::Regions(_) if components.as_ref().is_some_and(|count| count != "1") => {
                return Ok(());
            }
            _ => {}
        }
        *so_far += 1;
        piece.arrays.retain(|known| known.0 != slot);
        piece.arrays.push((slot, DataArray::of(self.input, tag, slot.role())?));
        Ok(())
    }

    fn end_piece(&mut self, piece: Piece) -> Result<()> {
        self.section = None;
        self.document.pieces.extend(piece.checked(self.input, self.document.kind)?);
        Ok(())
    }
}

impl Piece {
    fn of(input: &Input, tag: &Tag, kind: Kind) -> Result<Self> {
        let mut piece = Self { at: tag.at, points: 0, cells: Vec::new(), extent: None, arrays: Vec::new() };
        if kind.lists().is_empty() {
            let mut extent = [0; 6];
            if !numbers(input, tag, "Extent", &mut extent, text::signed)? {
                return Err(input.source.malformed_text(tag.at, "the attribute Extent"));
            }
            piece.extent = Some(extent);
            return Ok(piece);
        }
        piece.points = count(input, tag, "NumberOfPoints")?;
        for list in kind.lists() {
            // Lists that are empty need not be named.
            let is_needed = list.code.is_none() || tag.attribute(&input.source, list.count)?.is_some();
            piece.cells.push(if is_needed { count(input, tag, list.count)? } else { 0 });
        }
        Ok(piece)
    }

    /// The piece if it holds anything; it then must have all its arrays.
    fn checked(mut self, input: &Input, kind: Kind) -> Result<Option<Self>> {
        let all_cells = self.cells.iter().copied().fold(0, u64::saturating_add);
        if self.points == 0 && all_cells == 0 && self.extent.is_none() {
            return Ok(None);
        }
        let mut needed = Vec::new();
        match kind {
            Kind::Rectilinear => needed.extend([0, 1, 2].map(Slot::Planes)),
            Kind::Uniform | Kind::References => {}
            Kind::Unstructured | Kind::Polygonal | Kind::Structured => needed.push(Slot::Points),
        }
        for (k, list) in kind.lists().iter().enumerate().filter(|(k, _)| self.cells[*k] > 0) {
            needed.extend([Slot::Connectivity(k), Slot::Offsets(k)]);
            needed.extend(list.code.is_none().then_some(Slot::Types));
        }
        for slot in needed {
            if !self.arrays.iter().any(|array| array.0 == slot) {
                let expected = format!("a piece with an array of {}", slot.role().name());
                return Err(input.source.malformed_text(self.at, expected));
            }
        }
        // Of several arrays that might say which region a cell is in the best known counts.
        let rank = |slot: &Slot| if let Slot::Regions(rank) = slot { Some(*rank) } else { None };
        let best = self.arrays.iter().filter_map(|array| rank(&array.0)).min();
        self.arrays.retain(|array| rank(&array.0).is_none_or(|rank| Some(rank) == best));
        Ok(Some(self))
    }
}
