//! Legacy VTK files: `# vtk DataFile Version`, text or big-endian binary, versions 1 to 5.
//!
//! Unstructured, structured, rectilinear and uniform grids and polygonal data are read. Up to version 4.2 a cell's list of points starts
//! with their number; from 5.0 on there are `OFFSETS` and `CONNECTIVITY`. Other sections are
//! gone over.

mod attributes;
mod reader;
mod structured;

use std::sync::Arc;

use crate::error::{Error, Result};
use crate::formats::{Format, Outline};
use crate::input::{Input, Spot};
use crate::mesh::Shape;

use super::layout::Cells;
use super::lists::{Lists, Types, walk_counted};
use super::points::Points;
use super::role::Role;
use crate::formats::array::regions::{InRegions, Keys};
use crate::formats::array::{Array, Number, Stored, Stores};
use attributes::Data;
use reader::Reader;

/// Legacy VTK.
#[derive(Debug)]
pub struct Legacy;

const MAGIC: &[u8] = b"# vtk DataFile Version";

impl Format for Legacy {
    fn name(&self) -> &'static str {
        "vtk"
    }

    fn title(&self) -> &'static str {
        "VTK legacy, versions 1.0 to 5.1, ASCII and binary: unstructured, polygonal, structured, rectilinear and uniform data"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["vtk"]
    }

    fn looks_for(&self) -> &'static str {
        "\"# vtk DataFile Version\" in the first line"
    }

    fn own_orientation(&self) -> &'static [Shape] {
        super::cells::OWN_ORIENTATION
    }

    fn detect(&self, head: &[u8]) -> bool {
        head.get(..MAGIC.len()).is_some_and(|start| start.eq_ignore_ascii_case(MAGIC))
    }

    fn regions(&self) -> Option<&'static str> {
        Some("cell data of a material, region, block or part")
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        let mut reader = Reader::open(input)?;
        let grid = reader.grid()?;
        let stores = reader.unpacked.finish()?;
        grid.outline(input, &stores, out)
    }
}

/// What is known of the grid.
#[derive(Default)]
struct Grid {
    points: Option<Stored>,
    cells: Vec<Section>,
    types: Option<Stored>,
    /// What follows from the dimensions, of other than unstructured grids and polygonal data.
    block: Option<structured::Block>,
    data: Data,
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
    fn outline(self, input: &Input, stores: &Stores, out: &mut dyn Outline) -> Result<()> {
        let data = |stored: Stored| stores.array(stored, Role::Mark.name());
        let regions = match self.data.regions {
            Some((_, stored)) => InRegions::Keyed(Keys { keys: data(stored)?, names: Arc::default() }),
            None => InRegions::Unknown,
        };
        let ghosts =
            self.data.ghosts.map(|(stored, mask)| data(stored).map(|array| (array, mask))).transpose()?;
        if let Some(block) = self.block {
            return block.outline(input, stores, self.points, (regions, ghosts), out);
        }
        let points = self.points.expect("the reader asks for points");
        let (file, coordinates) = (stores.file.clone(), stores.array(points, Role::Coordinate.name())?);
        Points { file, coordinates }.outline(out)?;
        let mut first_cell = 0;
        for section in self.cells {
            let types = match section.code {
                Some(code) => Types::All(code),
                None => {
                    let types = self.types.expect("the reader asks for types");
                    Types::Each(stores.array(types, Role::Code.name())?)
                }
            };
            let (lists, connectivity) = section.lists.open(stores, section.count)?;
            let (file, count) = (stores.file.clone(), section.count);
            let span = first_cell..first_cell + count;
            let ghosts = ghosts.as_ref().map(|(array, mask)| (array.part(span.clone()), *mask));
            let regions = regions.part(span);
            let (first_point, points) = (0, None);
            Cells {
                file,
                connectivity,
                lists,
                types,
                count,
                first_cell,
                first_point,
                points,
                regions,
                ghosts,
            }
            .outline(out)?;
            first_cell += count;
        }
        Ok(())
    }
}

impl StoredLists {
    fn open(self, stores: &Stores, cells: u64) -> Result<(Lists, Array)> {
        match self {
            StoredLists::Counted(lists) => {
                let lists = stores.array(lists, Role::Point.name())?;
                Ok((Lists::Counted(walk_counted(&stores.file, &lists, cells)?), lists))
            }
            StoredLists::Offsets { offsets, connectivity } => {
                let offsets = stores.array(offsets, Role::Offset.name())?;
                let mut first = Vec::new();
                offsets.integers(0..1, &mut first);
                if let Some(first) = first.first().filter(|first| **first != 0) {
                    let error = Error::malformed("0 as the first offset", format!("{}", first.cast_signed()));
                    return Err(stores.file.place(error, offsets.spot(0)));
                }
                let connectivity = stores.array(connectivity, Role::Point.name())?;
                Ok((Lists::Ends(offsets.without_first()), connectivity))
            }
        }
    }
}

impl Reader<'_> {
    /// Reads all sections.
    fn grid(&mut self) -> Result<Grid> {
        self.keyword("DATASET")?;
        let dataset = self.word("the name of a dataset")?;
        let is_polygonal = match &dataset.text[..] {
            "UNSTRUCTURED_GRID" => false,
            "POLYDATA" => true,
            "FIELD" => {
                let error = Error::unsupported("a dataset of the kind FIELD is not read: it is no mesh");
                return Err(self.input.source.place(error, Spot::Text(dataset.at)));
            }
            _ => return self.structured(&dataset),
        };
        let sections = if is_polygonal { "POLYGONS" } else { "CELLS, CELL_TYPES" };
        let mut grid = Grid::default();
        let mut data = Data::default();
        while let Some(section) = self.next_word()? {
            let code = POLYGONAL.iter().find(|row| is_polygonal && row.0 == section.text).map(|row| row.1);
            match &section.text[..] {
                "POINTS" if grid.points.is_none() => grid.points = Some(self.points()?),
                "CELLS" if !is_polygonal && grid.cells.is_empty() => grid.cells.push(self.cells(None)?),
                "CELL_TYPES" if !is_polygonal && grid.types.is_none() => {
                    let count = self.count("the number of cell types")?;
                    grid.types = Some(self.numbers(Number::I32, Role::Code, count)?);
                }
                _ if code.is_some() => grid.cells.push(self.cells(code)?),
                _ => {
                    let sections = format!("a section: POINTS, {sections} ...");
                    self.other_section(&section, &sections, &mut data)?;
                }
            }
        }
        let cells = grid.cells.iter().fold(0, |sum: u64, section| sum.saturating_add(section.count));
        grid.data = data.of_cells(cells);
        if grid.points.is_none() {
            return Err(self.truncated("the section POINTS"));
        }
        if grid.cells.is_empty() {
            return Err(self.truncated(&format!("a section: {sections}")));
        }
        if grid.types.is_none() && !is_polygonal {
            return Err(self.truncated("the section CELL_TYPES"));
        }
        Ok(grid)
    }

    fn points(&mut self) -> Result<Stored> {
        let count = self.count("the number of points")?;
        let Some(numbers) = count.checked_mul(3) else {
            return Err(self.truncated(&format!("{count} points")));
        };
        let number = self.number(Role::Coordinate)?;
        self.numbers(number, Role::Coordinate, numbers)
    }

    fn cells(&mut self, code: Option<u64>) -> Result<Section> {
        let first = self.count("the number of cells")?;
        let second = self.count("the size of the cells' lists")?;
        // Binary lists start with the length of a list, which is never as large as these letters.
        if self.follows("OFFSETS") {
            self.keyword("OFFSETS")?;
        } else {
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
}
