//! Legacy VTK files: `# vtk DataFile Version`, text or big-endian binary, versions 1 to 5.
//!
//! Unstructured grids are read whole; of polygonal data the polygons. Up to version 4.2 a cell's list of points starts
//! with their number; from 5.0 on there are `OFFSETS` and `CONNECTIVITY`. Other sections are
//! gone over.

mod attributes;
mod reader;

use crate::error::{Error, Result};
use crate::formats::{Format, Outline};
use crate::input::{Input, Spot};
use crate::mesh::Shape;

use super::layout::{Cells, Lists, Points, Types, walk_counted};
use super::role::Role;
use crate::formats::array::{Array, Number, Stored, Stores};
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
        "VTK legacy, versions 1.0 to 5.1, ASCII and binary: unstructured grids and polygonal data"
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
            "STRUCTURED_POINTS" | "STRUCTURED_GRID" | "RECTILINEAR_GRID" | "FIELD" => {
                let error = Error::unsupported(format!(
                    "a dataset of the kind {} is not read: only UNSTRUCTURED_GRID and POLYDATA are",
                    dataset.text
                ));
                return Err(self.input.source.place(error, Spot::Text(dataset.at)));
            }
            _ => return Err(self.expected(&dataset, "UNSTRUCTURED_GRID or POLYDATA")),
        };
        let sections = if is_polygonal { "POLYGONS" } else { "CELLS, CELL_TYPES" };
        let mut grid = Grid::default();
        // Number of points or cells that data are given for, once data are what follows.
        let mut tuples = None;
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
                "POINT_DATA" | "CELL_DATA" => tuples = Some(self.count("the number of points or cells")?),
                _ if code.is_some() => grid.cells.push(self.cells(code)?),
                _ => match tuples {
                    Some(tuples) => self.skip_attribute(&section, tuples)?,
                    None => {
                        return Err(self.expected(&section, &format!("a section: POINTS, {sections} ...")));
                    }
                },
            }
        }
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
