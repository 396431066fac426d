//! XDMF, versions 2 and 3: an XML file that describes grids, with the numbers in it, in HDF5 files beside it, or in plain
//! binary ones.
//!
//! Of a collection over time the first grid is read, of one over space all. Elements have no numbers: theirs is their
//! position, from 1; nodes count from 0 in each grid.

mod heavy;
mod light;
mod structured;
#[cfg(test)]
mod tests;
mod types;

use std::sync::Arc;

use crate::error::{Error, Result};
use crate::formats::array::Stores;
use crate::formats::array::coded::{Coded, Heads};
use crate::formats::array::elements::{Elements, Labels, NodeRange};
use crate::formats::array::nodes::Coordinates;
use crate::formats::array::regions::InRegions;
use crate::formats::array::table::Table;
use crate::formats::{Format, Outline};
use crate::input::{Input, Spot};
use crate::mesh::{ElementType, Shape};
use heavy::{Files, Found};
use light::{Geometry, Grid, Topology};
use structured::Lattice;

/// Most nodes of one element.
const MOST_NODES: u64 = 4096;

/// The format's row in the table of formats.
pub(super) struct Xdmf;

impl Format for Xdmf {
    fn name(&self) -> &'static str {
        "xdmf"
    }

    fn title(&self) -> &'static str {
        "XDMF 2 and 3: unstructured and structured grids; numbers in the file, in HDF5 or in binary files beside it"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["xdmf", "xmf"]
    }

    fn looks_for(&self) -> &'static str {
        "the XML element <Xdmf"
    }

    fn own_orientation(&self) -> &'static [Shape] {
        &[Shape::Wedge]
    }

    fn detect(&self, head: &[u8]) -> bool {
        let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
        head.trim_ascii_start().starts_with(b"<") && memchr::memmem::find(head, b"<Xdmf").is_some()
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        let grids = light::read(input)?;
        let mut files = Files::new(input);
        let mut ready = Vec::new();
        for grid in &grids {
            ready.push(find(input, grid, &mut files)?);
        }
        let stores = files.finish()?;
        let several = ready.len() > 1;
        let mut first = First { node: 0, element: 1 };
        for grid in ready {
            match grid {
                AnyGrid::Listed(grid) => grid.outline(&stores, several, &mut first, out)?,
                AnyGrid::Structured(grid) => {
                    let (nodes, elements) = grid.counts();
                    grid.outline(input, &stores, (first.node, first.element), out)?;
                    first.node = first.node.saturating_add(nodes);
                    first.element = first.element.saturating_add(elements);
                }
            }
        }
        Ok(())
    }
}

/// A grid whose numbers are found.
enum AnyGrid {
    /// Its elements are listed.
    Listed(Ready),
    /// They follow from its nodes.
    Structured(Lattice),
}

/// Finds the numbers of a grid.
fn find(input: &Input, grid: &Grid, files: &mut Files<'_>) -> Result<AnyGrid> {
    let missing = |what: &str| {
        let error = Error::malformed(format!("a grid with {what}"), "none");
        Err(input.source.place(error, Spot::Text(grid.at)))
    };
    let Some(geometry) = &grid.geometry else { return missing("a Geometry") };
    let Some(topology) = &grid.topology else { return missing("a Topology") };
    Ok(match structured::axes_of(&topology.kind) {
        Some(axes) => AnyGrid::Structured(Lattice::find(input, (geometry, topology), axes, files)?),
        None => AnyGrid::Listed(Ready::find(input, grid.at, (geometry, topology), files)?),
    })
}

/// Numbers that go on from grid to grid.
struct First {
    node: u64,
    element: u64,
}

/// A grid whose elements are listed.
struct Ready {
    at: u64,
    coordinates: Vec<Found>,
    /// Coordinates of a node in each array.
    width: usize,
    base: u64,
    topology: Found,
    cells: Cells,
}

/// How the elements stand in their array.
enum Cells {
    Uniform(Arc<ElementType>),
    /// Of several types; so many elements.
    Mixed(u64),
}

fn refused(input: &Input, at: u64, what: impl Into<String>) -> Error {
    input.source.place(Error::unsupported(what.into()), Spot::Text(at))
}

impl Ready {
    fn find(
        input: &Input,
        at: u64,
        (geometry, topology): (&Geometry, &Topology),
        files: &mut Files<'_>,
    ) -> Result<Self> {
        let width = width(input, geometry)?;
        let mut coordinates = Vec::new();
        for item in &geometry.items {
            coordinates.push(files.find(item, true)?);
        }
        let [item] = &topology.items[..] else {
            let error = Error::malformed("a Topology with one DataItem", topology.items.len().to_string());
            return Err(input.source.place(error, Spot::Text(topology.at)));
        };
        let cells = cells(input, topology)?;
        let (topology, base) = (files.find(item, false)?, topology.base);
        Ok(Self { at, coordinates, width, base, topology, cells })
    }

    fn outline(self, stores: &Stores, several: bool, first: &mut First, out: &mut dyn Outline) -> Result<()> {
        let wrong = |expected: String, found: u64| {
            Err(stores.file.place(Error::malformed(expected, found.to_string()), Spot::Text(self.at)))
        };
        let mut arrays = Vec::new();
        for found in &self.coordinates {
            arrays.push(found.array(stores)?);
        }
        let file = Arc::clone(arrays.first().map_or(&stores.file, |array| array.source()));
        let mut arrays = arrays.into_iter();
        let table = match (arrays.next(), self.width) {
            (Some(array), 2..) if !array.len().is_multiple_of(self.width as u64) => {
                return wrong(format!("{} coordinates a node", self.width), array.len());
            }
            (Some(array), width @ 2..) => Table::Rows(array, width),
            (Some(array), _) => Table::Columns([array].into_iter().chain(arrays).collect()),
            (None, _) => Table::Columns(Vec::new()),
        };
        let nodes = table.len();
        let first_node = if several { first.node } else { self.base };
        Coordinates { file, table, first: first_node }.outline(out)?;
        let within = several.then_some((self.base, (self.base + nodes).saturating_sub(1)));
        let range = NodeRange { offset: first_node.wrapping_sub(self.base), within };
        let array = self.topology.array(stores)?;
        let file = Arc::clone(array.source());
        let count = match self.cells {
            Cells::Mixed(count) => {
                let (stream, elements) = ((array, Heads::Codes(types::head)), (first.element, count));
                Coded::outline(&file, stream, elements, range, InRegions::Unknown, out)?;
                count
            }
            Cells::Uniform(kind) => {
                let width = kind.nodes as u64;
                if !array.len().is_multiple_of(width) {
                    return wrong(format!("{width} nodes an element"), array.len());
                }
                let (count, labels) = (array.len() / width, Labels::From(first.element));
                let nodes = Table::Rows(array, kind.nodes);
                let regions = InRegions::Unknown;
                Elements { file, kind, nodes, labels, range, regions }.outline(out)?;
                count
            }
        };
        first.node += nodes;
        first.element += count;
        Ok(())
    }
}

/// Coordinates of a node in each array of a geometry.
fn width(input: &Input, geometry: &Geometry) -> Result<usize> {
    let (width, arrays) = match geometry.kind.as_str() {
        "xyz" => (3, 1),
        "xy" => (2, 1),
        "x_y_z" => (1, 3),
        "x_y" => (1, 2),
        other => {
            return Err(refused(
                input,
                geometry.at,
                format!("XDMF geometry of the type {other} is not read"),
            ));
        }
    };
    if geometry.items.len() != arrays {
        let error = Error::malformed(
            format!("{arrays} DataItem in a geometry of the type {}", geometry.kind),
            geometry.items.len().to_string(),
        );
        return Err(input.source.place(error, Spot::Text(geometry.at)));
    }
    Ok(width)
}

fn cells(input: &Input, topology: &Topology) -> Result<Cells> {
    if topology.kind == "mixed" {
        let Some(count) = topology.count else {
            let error = Error::malformed("the attribute NumberOfElements of mixed elements", "none");
            return Err(input.source.place(error, Spot::Text(topology.at)));
        };
        return Ok(Cells::Mixed(count));
    }
    let nodes = topology.nodes.unwrap_or(1);
    if nodes == 0 || nodes > MOST_NODES {
        let error = Error::malformed(format!("NodesPerElement from 1 to {MOST_NODES}"), nodes.to_string());
        return Err(input.source.place(error, Spot::Text(topology.at)));
    }
    match types::named(&topology.kind, nodes as usize) {
        Some(kind) => Ok(Cells::Uniform(kind)),
        None => Err(refused(
            input,
            topology.at,
            format!("XDMF topology of the type {} is not read", topology.kind),
        )),
    }
}
