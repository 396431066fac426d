//! What the XML says: grids, and where their numbers stand.

use crate::error::{Error, Result};
use crate::formats::array::Number;
use crate::formats::binary::Endian;
use crate::formats::text;
use crate::formats::vtk::markup::{Tag, Tags};
use crate::input::{Input, Source, Spot};

/// Limits, each with its own error.
const DEEPEST: usize = 64;
const MOST_GRIDS: usize = 1 << 20;
const MOST_AXES: usize = 16;

/// A grid of elements.
#[derive(Debug, Default)]
pub(super) struct Grid {
    pub(super) at: u64,
    pub(super) geometry: Option<Geometry>,
    pub(super) topology: Option<Topology>,
}

/// Coordinates.
#[derive(Debug)]
pub(super) struct Geometry {
    pub(super) at: u64,
    /// In small letters.
    pub(super) kind: String,
    pub(super) items: Vec<Item>,
}

/// Elements.
#[derive(Debug)]
pub(super) struct Topology {
    pub(super) at: u64,
    /// In small letters.
    pub(super) kind: String,
    /// Number of elements, of one or of several dimensions, and of nodes of each.
    pub(super) count: Option<u64>,
    pub(super) dimensions: Vec<u64>,
    pub(super) nodes: Option<u64>,
    /// The number of the first node.
    pub(super) base: u64,
    pub(super) items: Vec<Item>,
}

/// An array of numbers.
#[derive(Debug)]
pub(super) struct Item {
    /// The byte of its tag, and the byte after that.
    pub(super) at: u64,
    pub(super) from: u64,
    pub(super) count: u64,
    pub(super) number: Number,
    pub(super) place: Place,
}

/// Where the numbers of an item stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    /// Between its tags.
    Text,
    /// In a dataset of an HDF5 file.
    Hdf,
    /// In a file of plain numbers, from a byte on.
    Binary(Endian, u64),
}

/// An open `Grid` tag.
struct Open {
    at: u64,
    is_temporal: bool,
    /// Grids directly in it so far.
    inner: usize,
    /// Whether it is one of the later grids of a collection over time, or in one.
    passed_over: bool,
    is_uniform: bool,
    /// Whether its mesh is that of a grid before it.
    repeats: bool,
    grid: Grid,
}

/// The part of a grid that the tag at hand is in.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Section {
    Geometry,
    Topology,
}

/// Reads the whole file.
pub(super) fn read(input: &Input) -> Result<Vec<Grid>> {
    let source = &input.source;
    let mut tags = Tags::new(input).passing_doctype();
    let mut reader = Reader { source, open: Vec::new(), section: None, items: 0, grids: Vec::new() };
    let mut is_whole = false;
    while let Some(tag) = tags.next_tag()? {
        is_whole |= tag.name() == "Xdmf" && (tag.closes || tag.is_empty);
        reader.tag(&tag)?;
    }
    if !is_whole {
        return Err(source.truncated("</Xdmf>"));
    }
    if reader.grids.is_empty() {
        let error = Error::malformed("a Grid of the type Uniform", "none");
        return Err(source.place(error, Spot::Text(0)));
    }
    Ok(reader.grids)
}

struct Reader<'i> {
    source: &'i Source,
    open: Vec<Open>,
    section: Option<Section>,
    /// Open items.
    items: usize,
    grids: Vec<Grid>,
}

impl Reader<'_> {
    fn tag(&mut self, tag: &Tag) -> Result<()> {
        match (tag.name(), tag.closes) {
            ("Grid", false) => self.open_grid(tag)?,
            ("Grid", true) => self.close_grid(tag)?,
            ("Geometry" | "Topology", true) => (self.section, self.items) = (None, 0),
            ("DataItem", true) => self.items = self.items.saturating_sub(1),
            _ if tag.closes || !self.is_wanted() => {}
            ("Geometry", false) => self.geometry(tag)?,
            ("Topology", false) => self.topology(tag)?,
            ("DataItem", false) => self.item(tag)?,
            ("xi:include" | "include", false) => match self.open.last_mut() {
                // Of a series over time each step fetches the mesh that stands before.
                Some(open) if !self.grids.is_empty() => open.repeats = true,
                _ => return Err(self.refused(tag, "an XInclude")),
            },
            _ => {}
        }
        Ok(())
    }

    /// Whether a grid is open that is to be read.
    fn is_wanted(&self) -> bool {
        self.open.last().is_some_and(|open| open.is_uniform && !open.passed_over)
    }

    fn refused(&self, tag: &Tag, what: &str) -> Error {
        self.source.place(Error::unsupported(format!("{what} is not read in XDMF files")), Spot::Text(tag.at))
    }

    /// An attribute in small letters.
    fn word(&self, tag: &Tag, names: &[&str]) -> Result<Option<String>> {
        for name in names {
            if let Some(value) = tag.attribute(self.source, name)? {
                return Ok(Some(value.to_ascii_lowercase()));
            }
        }
        Ok(None)
    }

    /// The numbers of an attribute.
    fn counts(&self, tag: &Tag, names: &[&str]) -> Result<Option<Vec<u64>>> {
        let Some(value) = self.word(tag, names)? else { return Ok(None) };
        let counts: Option<Vec<_>> =
            value.split_ascii_whitespace().map(|word| text::integer(word.as_bytes())).collect();
        let expected = || self.source.malformed_text(tag.at, format!("the attribute {}, a number", names[0]));
        counts.map(Some).ok_or_else(expected)
    }

    /// Their product.
    fn count(&self, tag: &Tag, names: &[&str]) -> Result<Option<u64>> {
        Ok(self.counts(tag, names)?.map(|counts| counts.into_iter().fold(1, u64::saturating_mul)))
    }

    fn open_grid(&mut self, tag: &Tag) -> Result<()> {
        let kind = self.word(tag, &["GridType", "Type"])?.unwrap_or_default();
        let is_temporal = kind == "collection"
            && self.word(tag, &["CollectionType"])?.is_some_and(|kind| kind == "temporal");
        let is_uniform = match kind.as_str() {
            "" | "uniform" => true,
            "collection" | "tree" => false,
            _ => return Err(self.refused(tag, &format!("a Grid of the type {kind}"))),
        };
        let mut passed_over = false;
        if let Some(parent) = self.open.last_mut() {
            passed_over = parent.passed_over || (parent.is_temporal && parent.inner > 0);
            parent.inner += 1;
        }
        if self.open.len() >= DEEPEST {
            return Err(self.source.place(Error::limit("nesting of grids", DEEPEST), Spot::Text(tag.at)));
        }
        if !tag.is_empty {
            let grid = Grid { at: tag.at, ..Grid::default() };
            let (at, inner, repeats) = (tag.at, 0, false);
            self.open.push(Open { at, is_temporal, inner, passed_over, is_uniform, repeats, grid });
        }
        Ok(())
    }

    fn close_grid(&mut self, tag: &Tag) -> Result<()> {
        let Some(open) = self.open.pop() else {
            return Err(self.source.malformed_text(tag.at, "<Grid> before </Grid>"));
        };
        self.section = None;
        if !open.is_uniform || open.passed_over {
            return Ok(());
        }
        if self.grids.len() >= MOST_GRIDS {
            return Err(self.source.place(Error::limit("number of grids", MOST_GRIDS), Spot::Text(open.at)));
        }
        // A grid of grids may leave out its type.
        if open.inner == 0 && !open.repeats {
            self.grids.push(open.grid);
        }
        Ok(())
    }

    fn no_reference(&self, tag: &Tag) -> Result<()> {
        match tag.attribute(self.source, "Reference")? {
            Some(_) => Err(self.refused(tag, &format!("a {} that refers to another", tag.name()))),
            None => Ok(()),
        }
    }

    fn geometry(&mut self, tag: &Tag) -> Result<()> {
        self.no_reference(tag)?;
        let kind = self.word(tag, &["GeometryType", "Type"])?.unwrap_or_else(|| "xyz".into());
        self.section = (!tag.is_empty).then_some(Section::Geometry);
        if let Some(open) = self.open.last_mut() {
            open.grid.geometry = Some(Geometry { at: tag.at, kind, items: Vec::new() });
        }
        Ok(())
    }

    fn topology(&mut self, tag: &Tag) -> Result<()> {
        self.no_reference(tag)?;
        let kind = self.word(tag, &["TopologyType", "Type"])?.unwrap_or_default();
        let dimensions = self.counts(tag, &["NumberOfElements", "Dimensions"])?;
        let count = dimensions.as_ref().map(|counts| counts.iter().copied().fold(1, u64::saturating_mul));
        let dimensions = dimensions.unwrap_or_default();
        let nodes = self.count(tag, &["NodesPerElement"])?;
        let base = self.count(tag, &["BaseOffset"])?.unwrap_or(0).min(1 << 32);
        self.section = (!tag.is_empty).then_some(Section::Topology);
        if let Some(open) = self.open.last_mut() {
            let (at, items) = (tag.at, Vec::new());
            open.grid.topology = Some(Topology { at, kind, count, dimensions, nodes, base, items });
        }
        Ok(())
    }

    fn item(&mut self, tag: &Tag) -> Result<()> {
        let Some(section) = self.section else { return Ok(()) };
        self.no_reference(tag)?;
        let kind = self.word(tag, &["ItemType"])?.unwrap_or_else(|| "uniform".into());
        if kind != "uniform" || self.items > 0 {
            return Err(self.refused(tag, &format!("a DataItem of the type {kind} within a grid")));
        }
        let Some(count) = self.count(tag, &["Dimensions"])? else {
            return Err(self.source.malformed_text(tag.at, "the attribute Dimensions"));
        };
        let item =
            Item { at: tag.at, from: tag.end, count, number: self.number(tag)?, place: self.place(tag)? };
        if section == Section::Topology && matches!(item.number, Number::F32 | Number::F64) {
            // Writers leave the type of whole numbers out, and Float is what is then meant by the book.
            let is_text = item.place == Place::Text;
            if !is_text && self.word(tag, &["NumberType", "DataType"])?.is_some() {
                return Err(self.source.malformed_text(tag.at, "whole numbers in a Topology"));
            }
        }
        self.items += usize::from(!tag.is_empty);
        let Some(grid) = self.open.last_mut().map(|open| &mut open.grid) else { return Ok(()) };
        let items = match section {
            Section::Geometry => grid.geometry.as_mut().map(|geometry| &mut geometry.items),
            Section::Topology => grid.topology.as_mut().map(|topology| &mut topology.items),
        };
        if let Some(items) = items.filter(|items| items.len() < MOST_AXES) {
            items.push(item);
        }
        Ok(())
    }

    fn number(&self, tag: &Tag) -> Result<Number> {
        let kind = self.word(tag, &["NumberType", "DataType"])?.unwrap_or_else(|| "float".into());
        let precision = self.count(tag, &["Precision"])?;
        Ok(match (kind.as_str(), precision) {
            ("float", None | Some(4)) => Number::F32,
            ("float", Some(8)) => Number::F64,
            ("char", _) | ("int", Some(1)) => Number::I8,
            ("uchar", _) | ("uint", Some(1)) => Number::U8,
            ("short", _) | ("int", Some(2)) => Number::I16,
            ("ushort", _) | ("uint", Some(2)) => Number::U16,
            ("int", None | Some(4)) => Number::I32,
            ("uint", None | Some(4)) => Number::U32,
            ("int", Some(8)) => Number::I64,
            ("uint", Some(8)) => Number::U64,
            _ => return Err(self.source.malformed_text(tag.at, "a NumberType and Precision of numbers")),
        })
    }

    fn place(&self, tag: &Tag) -> Result<Place> {
        if self.word(tag, &["Compression"])?.is_some_and(|packed| packed != "raw") {
            return Err(self.refused(tag, "a compressed binary file"));
        }
        Ok(match self.word(tag, &["Format"])?.as_deref() {
            Some("xml") | None => Place::Text,
            Some("hdf") => Place::Hdf,
            Some("binary") => {
                let endian = match self.word(tag, &["Endian"])?.as_deref() {
                    Some("little") => Endian::Little,
                    Some("big") => Endian::Big,
                    _ => Endian::NATIVE,
                };
                Place::Binary(endian, self.count(tag, &["Seek"])?.unwrap_or(0))
            }
            Some(_) => {
                return Err(self.source.malformed_text(tag.at, "the attribute Format: XML, HDF or Binary"));
            }
        })
    }
}
