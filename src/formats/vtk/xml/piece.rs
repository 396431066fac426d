//! A piece of a grid: its arrays found, its points and cells handed out.

use std::sync::Arc;

use super::super::grid::{self, Lattice};
use super::super::layout::Cells;
use super::super::lists::{Lists, Types};
use super::super::points::Points;
use super::attributes::Uniform;
use super::document::{Document, Piece};
use super::section::{Kind, Slot};
use crate::error::{Error, Result};
use crate::formats::Outline;
use crate::formats::array::regions::{InRegions, Keys};
use crate::formats::array::structured::Places;
use crate::formats::array::{Array, Stored, Stores, Unpacked};
use crate::input::{Input, Spot};

/// Numbers that go on from piece to piece.
#[derive(Default)]
pub(super) struct First {
    point: u64,
    cell: u64,
    /// Whether there are several pieces.
    pub(super) several: bool,
}

/// A piece whose arrays can be read.
pub(super) struct Ready {
    at: u64,
    kind: Kind,
    points: u64,
    cells: Vec<u64>,
    /// First vertex, and number of vertices, along each axis.
    extent: ([i64; 3], [u64; 3]),
    uniform: Uniform,
    arrays: Vec<(Slot, Stored)>,
}

impl Piece {
    /// Finds the numbers of the arrays, or unpacks them.
    pub(super) fn unpack(&self, input: &Input, document: &Document, out: &mut Unpacked<'_>) -> Result<Ready> {
        let extent = self.extent(input)?;
        let (mut points, mut all_cells) =
            (self.points, self.cells.iter().copied().fold(0, u64::saturating_add));
        if self.extent.is_some() {
            points = grid::points(&extent.1);
            all_cells = grid::cells(&extent.1);
        }
        let mut arrays = Vec::new();
        for (slot, array) in &self.arrays {
            let count = match slot {
                Slot::Points => Some(points.saturating_mul(3)),
                Slot::Planes(axis) => extent.1.get(*axis).copied(),
                Slot::Connectivity(_) => None,
                Slot::Offsets(list) => Some(self.cells[*list]),
                Slot::Types | Slot::Ghosts(_) | Slot::Regions(_) => Some(all_cells),
            };
            // Arrays of nothing may have no bytes at all.
            let of_cells =
                matches!(slot, Slot::Connectivity(list) | Slot::Offsets(list) if self.cells[*list] == 0);
            if count == Some(0) || of_cells || matches!(slot, Slot::Planes(3..)) {
                continue;
            }
            arrays.push((*slot, array.unpack(input, document, slot.role(), count, out)?));
        }
        let (kind, cells, uniform) = (document.kind, self.cells.clone(), document.uniform);
        Ok(Ready { at: self.at, kind, points, cells, extent, uniform, arrays })
    }

    /// First vertex, and number of vertices, along each axis of a structured grid.
    fn extent(&self, input: &Input) -> Result<([i64; 3], [u64; 3])> {
        let [x, to_x, y, to_y, z, to_z] = self.extent.unwrap_or_default();
        let count = |(from, to): (i64, i64)| {
            let last = to.checked_sub(from)?.checked_add(1)?;
            u64::try_from(last).ok()
        };
        match [(x, to_x), (y, to_y), (z, to_z)].map(count) {
            [Some(a), Some(b), Some(c)] => Ok(([x, y, z], [a, b, c])),
            _ => {
                let found = format!("{x} {to_x} {y} {to_y} {z} {to_z}");
                let error = Error::malformed("an Extent of a first and a last vertex along each axis", found);
                Err(input.source.place(error, Spot::Text(self.at)))
            }
        }
    }
}

impl Ready {
    fn array(&self, stores: &Stores, wanted: impl Fn(Slot) -> bool) -> Result<Option<(Slot, Array)>> {
        match self.arrays.iter().find(|(slot, _)| wanted(*slot)) {
            Some((slot, stored)) => Ok(Some((*slot, stores.array(*stored, slot.role().name())?))),
            None => Ok(None),
        }
    }

    /// The array in a slot; one that has no numbers where there is none.
    fn needed(&self, stores: &Stores, wanted: Slot) -> Result<Array> {
        let found = self.array(stores, |slot| slot == wanted)?;
        Ok(found.map_or_else(|| stores.nothing(), |found| found.1))
    }

    /// Hands out points and cells.
    pub(super) fn outline(
        self,
        input: &Input,
        stores: &Stores,
        block: &InRegions,
        first: &mut First,
        out: &mut dyn Outline,
    ) -> Result<()> {
        let file = Arc::clone(&stores.file);
        let ghosts = match self.array(stores, |slot| matches!(slot, Slot::Ghosts(_)))? {
            Some((Slot::Ghosts(mask), array)) => Some((array, mask)),
            _ => None,
        };
        let regions = match self.array(stores, |slot| matches!(slot, Slot::Regions(_)))? {
            Some((_, keys)) if matches!(block, InRegions::Unknown) => {
                InRegions::Keyed(Keys { keys, names: Arc::default() })
            }
            _ => block.clone(),
        };
        let places = match self.kind {
            Kind::Rectilinear => {
                let plane = |axis| self.needed(stores, Slot::Planes(axis));
                Some(Places::Axes([plane(0)?, plane(1)?, plane(2)?]))
            }
            Kind::Uniform => Some(grid::steps(
                &self.uniform.origin,
                &self.uniform.spacing,
                &self.uniform.direction,
                self.extent.0,
            )),
            _ => None,
        };
        match places {
            Some(places) => {
                let lattice = Lattice { counts: self.extent.1, places, at: self.at };
                lattice.outline(input, &file, out)?;
            }
            None => {
                let coordinates = self.needed(stores, Slot::Points)?;
                Points { file: Arc::clone(&file), coordinates }.outline(out)?;
            }
        }
        if self.kind.lists().is_empty() {
            let cells = grid::Block {
                file,
                counts: self.extent.1,
                first: (first.point, first.cell),
                regions,
                ghosts,
            };
            cells.outline(self.kind == Kind::Structured, out)?;
            first.cell = first.cell.saturating_add(grid::cells(&self.extent.1));
            first.point = first.point.saturating_add(self.points);
            return Ok(());
        }
        let mut before = 0;
        for (k, (list, count)) in self.kind.lists().iter().zip(self.cells.iter().copied()).enumerate() {
            if count == 0 {
                continue;
            }
            let connectivity = self.needed(stores, Slot::Connectivity(k))?;
            let lists = Lists::Ends(self.needed(stores, Slot::Offsets(k))?);
            let types = match list.code {
                Some(code) => Types::All(code),
                None => Types::Each(self.needed(stores, Slot::Types)?),
            };
            let span = before..before + count;
            let cells = Cells {
                file: Arc::clone(&file),
                connectivity,
                lists,
                types,
                count,
                first_cell: first.cell + before,
                first_point: first.point,
                points: first.several.then_some(self.points),
                regions: regions.part(span.clone()),
                ghosts: ghosts.as_ref().map(|(array, mask)| (array.part(span), *mask)),
            };
            cells.outline(out)?;
            before += count;
        }
        first.cell += before;
        first.point += self.points;
        Ok(())
    }
}
