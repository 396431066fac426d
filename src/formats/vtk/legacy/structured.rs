//! Datasets whose cells follow from their dimensions.

use std::sync::Arc;

use super::super::grid::{self, Lattice};
use super::super::points::Points;
use super::super::role::Role;
use super::Grid;
use super::attributes::Data;
use super::reader::{Reader, Word};
use crate::error::{Error, Result};
use crate::formats::array::regions::InRegions;
use crate::formats::array::structured::Places;
use crate::formats::array::{Array, Stored, Stores};
use crate::formats::{Outline, text};
use crate::input::{Input, Spot};

/// What is known of such a dataset besides its points.
pub(super) struct Block {
    at: u64,
    counts: [u64; 3],
    /// First vertex along each axis, in steps from the origin.
    from: [i64; 3],
    origin: [f64; 3],
    spacing: [f64; 3],
    planes: Vec<Stored>,
    kind: Kind,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// Points are listed.
    Listed,
    /// At crossings of planes.
    Rectilinear,
    /// At equal steps.
    Uniform,
}

/// Sections of the planes along each axis.
const PLANES: [&str; 3] = ["X_COORDINATES", "Y_COORDINATES", "Z_COORDINATES"];

impl Reader<'_> {
    /// Reads all sections of such a dataset.
    pub(super) fn structured(&mut self, dataset: &Word) -> Result<Grid> {
        let kind = match &dataset.text[..] {
            "STRUCTURED_GRID" => Kind::Listed,
            "RECTILINEAR_GRID" => Kind::Rectilinear,
            "STRUCTURED_POINTS" => Kind::Uniform,
            _ => return Err(self.expected(dataset, "UNSTRUCTURED_GRID, POLYDATA or another kind of dataset")),
        };
        let (mut grid, mut data, mut counts) = (Grid::default(), Data::default(), None);
        let mut block = Block {
            at: dataset.at,
            counts: [0; 3],
            from: [0; 3],
            origin: [0.0; 3],
            spacing: [1.0; 3],
            planes: Vec::new(),
            kind,
        };
        while let Some(section) = self.next_word()? {
            match &section.text[..] {
                "DIMENSIONS" if counts.is_none() => {
                    let mut count = || self.count("the number of points along an axis");
                    counts = Some([count()?, count()?, count()?]);
                }
                "EXTENT" if counts.is_none() => {
                    let mut found = [0; 3];
                    for (count, from) in found.iter_mut().zip(&mut block.from) {
                        let first = self.signed("the first point along an axis")?;
                        let last = self.signed("the last point along an axis")?;
                        let points =
                            last.checked_sub(first).and_then(|n| u64::try_from(n).ok()?.checked_add(1));
                        *count =
                            points.ok_or_else(|| self.expected(&section, "EXTENT with points in order"))?;
                        *from = first;
                    }
                    counts = Some(found);
                }
                "ORIGIN" => block.origin = self.three("the origin")?,
                "SPACING" | "ASPECT_RATIO" => block.spacing = self.three("the spacing")?,
                "POINTS" if kind == Kind::Listed && grid.points.is_none() => {
                    grid.points = Some(self.points()?)
                }
                name if kind == Kind::Rectilinear && PLANES.get(block.planes.len()) == Some(&name) => {
                    let count = self.count("the number of planes")?;
                    let number = self.number(Role::Coordinate)?;
                    block.planes.push(self.numbers(number, Role::Coordinate, count)?);
                }
                _ => self.other_section(&section, "a section: DIMENSIONS, POINTS, SPACING ...", &mut data)?,
            }
        }
        block.counts = match counts {
            Some(counts) => counts,
            None => return Err(self.truncated("the section DIMENSIONS")),
        };
        if kind == Kind::Listed && grid.points.is_none() {
            return Err(self.truncated("the section POINTS"));
        }
        if kind == Kind::Rectilinear && block.planes.len() < 3 {
            return Err(self.truncated(&format!("the section {}", PLANES[block.planes.len()])));
        }
        grid.data = data.of_cells(grid::cells(&block.counts));
        grid.block = Some(block);
        Ok(grid)
    }

    fn signed(&mut self, expected: &str) -> Result<i64> {
        let word = self.word(expected)?;
        text::signed(word.text.as_bytes()).ok_or_else(|| self.expected(&word, expected))
    }

    fn three(&mut self, expected: &str) -> Result<[f64; 3]> {
        let mut numbers = [0.0; 3];
        for number in &mut numbers {
            let word = self.word(expected)?;
            *number = text::real(word.text.as_bytes())
                .ok_or_else(|| self.expected(&word, &format!("{expected}, three numbers")))?;
        }
        Ok(numbers)
    }
}

impl Block {
    /// Hands out points and cells.
    pub(super) fn outline(
        self,
        input: &Input,
        stores: &Stores,
        points: Option<Stored>,
        (regions, ghosts): (InRegions, Option<(Array, u64)>),
        out: &mut dyn Outline,
    ) -> Result<()> {
        let file = Arc::clone(&stores.file);
        let wrong = |what: &str, expected: u64, found: u64| {
            let error = Error::malformed(format!("{expected} {what}"), found.to_string());
            Err(file.place(error, Spot::Text(self.at)))
        };
        let places = match self.kind {
            Kind::Listed => None,
            Kind::Uniform => {
                let direction = [1., 0., 0., 0., 1., 0., 0., 0., 1.];
                Some(grid::steps(&self.origin, &self.spacing, &direction, self.from))
            }
            Kind::Rectilinear => {
                let mut planes = Vec::new();
                for (stored, count) in self.planes.iter().zip(self.counts) {
                    if stored.count != count {
                        return wrong("planes along an axis, as DIMENSIONS says", count, stored.count);
                    }
                    planes.push(stores.array(*stored, Role::Coordinate.name())?);
                }
                <[Array; 3]>::try_from(planes).ok().map(Places::Axes)
            }
        };
        match (places, points) {
            (Some(places), _) => {
                Lattice { counts: self.counts, places, at: self.at }.outline(input, &file, out)?
            }
            (None, Some(stored)) => {
                let expected = grid::points(&self.counts);
                if stored.count != expected.saturating_mul(3) {
                    return wrong("points, as DIMENSIONS says", expected, stored.count / 3);
                }
                let coordinates = stores.array(stored, Role::Coordinate.name())?;
                Points { file: Arc::clone(&file), coordinates }.outline(out)?;
            }
            (None, None) => {}
        }
        let cells =
            grid::Block { file: Arc::clone(&file), counts: self.counts, first: (0, 0), regions, ghosts };
        cells.outline(self.kind == Kind::Listed, out)
    }
}
