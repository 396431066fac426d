//! A zone: its vertices and its elements.

use std::sync::Arc;

use super::tree::{child, children, data, data_of, integers, text};
use super::types;
use crate::error::{Error, Result};
use crate::formats::Outline;
use crate::formats::array::coded::{Coded, Heads};
use crate::formats::array::elements::{Elements, Labels, NodeRange, UsedNodes};
use crate::formats::array::nodes::Coordinates;
use crate::formats::array::regions::InRegions;
use crate::formats::array::structured;
use crate::formats::array::table::Table;
use crate::formats::array::{Stored, Stores, Unpacked};
use crate::formats::hdf5::Group;
use crate::input::Input;

/// The axes' names.
const AXES: [&str; 3] = ["CoordinateX", "CoordinateY", "CoordinateZ"];

/// Numbers that go on from zone to zone.
pub(super) struct First {
    /// The number of the next zone's first vertex within the file.
    pub(super) node: u64,
    /// Whether there are several zones.
    pub(super) several: bool,
}

/// A zone whose arrays are found.
pub(super) struct Zone {
    name: String,
    vertices: u64,
    coordinates: Vec<Stored>,
    cells: Cells,
}

enum Cells {
    /// Vertices along each axis.
    Structured(Vec<u64>),
    Sections(Vec<Section>),
}

/// A section of elements.
struct Section {
    name: String,
    code: i64,
    /// Number of its first element, and how many there are.
    first: u64,
    count: u64,
    connectivity: Stored,
    has_offsets: bool,
}

impl Zone {
    pub(super) fn find(input: &Input, zone: &Group<'_>, unpacked: &mut Unpacked<'_>) -> Result<Self> {
        let size = data(zone)?;
        let is_structured = match child(zone, "ZoneType_t")? {
            Some(kind) => text(&kind)? == "Structured",
            None => false,
        };
        let sizes = integers(zone)?;
        let axes = match size.shape() {
            [3, axes @ 1..=3] if is_structured || *axes == 1 => *axes as usize,
            other => {
                return Err(size.malformed("the size of a zone: 3 x 1 to 3 numbers", format!("{other:?}")));
            }
        };
        let mut vertices = Vec::new();
        for count in sizes.iter().take(axes) {
            let count = u64::try_from(*count);
            vertices.push(count.map_err(|_| size.malformed("numbers of vertices", "a negative number"))?);
        }
        let count = vertices.iter().copied().fold(1, u64::saturating_mul);
        let coordinates = coordinates(input, zone, count, unpacked)?;
        let cells = if is_structured {
            Cells::Structured(vertices)
        } else {
            let mut sections = Vec::new();
            for section in children(zone, "Elements_t")? {
                sections.push(Section::find(input, &section, unpacked)?);
            }
            sections.sort_by_key(|section| section.first);
            Cells::Sections(sections)
        };
        Ok(Self { name: zone.name().to_owned(), vertices: count, coordinates, cells })
    }

    pub(super) fn outline(self, stores: &Stores, first: &mut First, out: &mut dyn Outline) -> Result<()> {
        let file = Arc::clone(&stores.file);
        if !self.coordinates.is_empty() {
            let arrays = self.coordinates.iter().map(|stored| stores.array(*stored, "coordinates"));
            let table = Table::Columns(arrays.collect::<Result<_>>()?);
            Coordinates { file: Arc::clone(&file), table, first: first.node }.outline(out)?;
        }
        let within = first.several.then_some((1, self.vertices));
        let range = NodeRange { offset: first.node - 1, within };
        match self.cells {
            Cells::Structured(vertices) => {
                let regions = InRegions::named(self.name);
                let (axes, first, ghosts) = (vertices, (first.node, 1), None);
                let cells = structured::Cells { file, axes, first, regions, ghosts };
                cells.outline(types::structured(), out)?;
            }
            Cells::Sections(sections) => {
                for section in sections {
                    // Zones of one file may well name their sections alike.
                    let name = match first.several {
                        true => format!("{}/{}", self.name, section.name),
                        false => section.name.clone(),
                    };
                    section.outline(stores, range, InRegions::named(name), out)?;
                }
            }
        }
        first.node += self.vertices;
        Ok(())
    }
}

/// The arrays of coordinates, one an axis.
fn coordinates(
    input: &Input,
    zone: &Group<'_>,
    count: u64,
    unpacked: &mut Unpacked<'_>,
) -> Result<Vec<Stored>> {
    // Of several the first is the mesh; others are where it moved to.
    let Some(grid) = child(zone, "GridCoordinates_t")? else {
        if count == 0 {
            return Ok(Vec::new());
        }
        return Err(zone.malformed(format!("the coordinates of the zone {}", zone.name()), "none"));
    };
    let mut found = Vec::new();
    for axis in AXES {
        let Some(axis) = data_of(&grid, axis)? else { break };
        if axis.len() != count {
            let expected = format!("{count} coordinates, as many as the zone {} has vertices", zone.name());
            let rind = if child(&grid, "Rind_t")?.is_some() { " with a rind, which is not read" } else { "" };
            return Err(axis.malformed(expected, format!("{}{rind}", axis.len())));
        }
        found.push(axis.store(input, unpacked)?);
    }
    if found.is_empty() {
        let names: Vec<_> =
            children(&grid, "DataArray_t")?.iter().map(|array| array.name().to_owned()).collect();
        return Err(grid.malformed("CoordinateX, CoordinateY, CoordinateZ", names.join(", ")));
    }
    Ok(found)
}

impl Section {
    fn find(input: &Input, section: &Group<'_>, unpacked: &mut Unpacked<'_>) -> Result<Self> {
        let code = integers(section)?.first().copied().unwrap_or(0);
        let Some(range) = section.group("ElementRange")? else {
            return Err(section.malformed("ElementRange", "none of that name"));
        };
        let ends = integers(&range)?;
        let [Ok(first), Ok(last)] = [0, 1].map(|k| u64::try_from(ends.get(k).copied().unwrap_or(-1))) else {
            return Err(range.malformed("the first and last number of elements", format!("{ends:?}")));
        };
        let count = (last + 1).saturating_sub(first);
        let Some(connectivity) = data_of(section, "ElementConnectivity")? else {
            return Err(section.malformed("ElementConnectivity", "none of that name"));
        };
        let has_offsets = section.group("ElementStartOffset")?.is_some();
        let connectivity = connectivity.store(input, unpacked)?;
        Ok(Self { name: section.name().to_owned(), code, first, count, connectivity, has_offsets })
    }

    fn outline(
        self,
        stores: &Stores,
        range: NodeRange,
        regions: InRegions,
        out: &mut dyn Outline,
    ) -> Result<()> {
        let file = Arc::clone(&stores.file);
        let elements = (self.first, self.count);
        let connectivity = stores.array(self.connectivity, &self.name)?;
        let place = |error| Err(file.place(error, connectivity.spot(0)));
        match self.code {
            types::MIXED => {
                let heads = Heads::Codes(types::head);
                Coded::outline(&file, (connectivity, heads), elements, range, regions, out)
            }
            types::NFACE => out.count(types::polyhedron(), self.count),
            // Before version 3.4 a count stood before each list.
            types::NGON if !self.has_offsets => {
                let heads = Heads::Counts(types::polygon());
                Coded::outline(&file, (connectivity, heads), elements, range, regions, out)
            }
            types::NGON => {
                out.count(types::polygon(), self.count)?;
                UsedNodes { file, nodes: connectivity, range }.outline(out)
            }
            code => {
                let Some(kind) = u64::try_from(code).ok().and_then(types::find) else {
                    let what = format!("elements of the type {code} (section {}) are not read", self.name);
                    return place(Error::unsupported(what));
                };
                let expected = self.count.saturating_mul(kind.nodes as u64);
                if connectivity.len() != expected {
                    let what = format!("{expected} nodes of {} elements (section {})", self.count, self.name);
                    return place(Error::malformed(what, connectivity.len().to_string()));
                }
                let (kind, labels) = (Arc::clone(kind), Labels::From(self.first));
                let nodes = Table::Rows(connectivity, kind.nodes);
                Elements { file, kind, nodes, labels, range, regions }.outline(out)
            }
        }
    }
}
