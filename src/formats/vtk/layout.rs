//! How cells are decoded, wherever their arrays came from.

use std::ops::Range;
use std::sync::Arc;

use crate::error::{Error, Result};
use crate::formats::array::regions::InRegions;
use crate::formats::array::{Array, Reader};
use crate::formats::binary::cut_records;
use crate::formats::{BLOCK, ElementLayout, ElementSink, Outline, Piece};
use crate::input::{Source, Spot};
use crate::mesh::{Class, ElementType};

use super::cells;
use super::lists::{Lists, Types, list_end};

/// Most cells that are looked at in one go.
const STEP: u64 = 4096;

/// Cells of one piece of a grid.
#[derive(Debug)]
pub struct Cells {
    /// The mesh file, for errors.
    pub file: Arc<Source>,
    /// Points of the cells, one cell after another.
    pub connectivity: Array,
    /// Where in it each cell stands.
    pub lists: Lists,
    /// The cells' types.
    pub types: Types,
    /// Number of cells.
    pub count: u64,
    /// Number of the first cell within the file.
    pub first_cell: u64,
    /// Number of the first point of this piece of the grid within the file.
    pub first_point: u64,
    /// Number of points of this piece, where the file has several: numbers beyond would be another piece's points.
    pub points: Option<u64>,
    /// Which regions the cells are in.
    pub regions: InRegions,
    /// Marks of each cell, and those that say that it is left out: another piece has it, or the file hides it.
    pub ghosts: Option<(Array, u64)>,
}

impl Cells {
    /// Checks what can be checked without reading the cells, and hands them out, cut into pieces.
    pub fn outline(self, out: &mut dyn Outline) -> Result<()> {
        self.check()?;
        let count = self.count;
        let cuts: Option<Vec<u64>> = match &self.lists {
            Lists::Counted(starts) => Some(starts.iter().map(|start| start.0).collect()),
            Lists::Ends(_) => None,
        };
        let width = self.connectivity.width() * (self.connectivity.len() / count.max(1)).max(1);
        let layout: Arc<dyn ElementLayout> = Arc::new(self);
        let mut piece = |span| out.elements(Piece { layout: Arc::clone(&layout), span });
        let Some(cuts) = cuts else { return cut_records(count, width, piece) };
        for (k, start) in cuts.iter().enumerate() {
            piece(*start..cuts.get(k + 1).copied().unwrap_or(count))?;
        }
        Ok(())
    }

    fn check(&self) -> Result<()> {
        let wrong = |what: &str, expected: u64, found: u64, spot: Spot| {
            let error = Error::malformed(format!("{expected} {what}"), format!("{found}"));
            Err(self.file.place(error, spot))
        };
        if let Types::Each(types) = &self.types
            && types.len() != self.count
        {
            return wrong("cell types, one for each cell", self.count, types.len(), types.spot(0));
        }
        if let Lists::Ends(ends) = &self.lists {
            if ends.len() != self.count {
                return wrong("offsets, one for each cell", self.count, ends.len(), ends.spot(0));
            }
            let mut last = Vec::new();
            ends.integers(self.count.saturating_sub(1)..self.count, &mut last);
            let last = last.first().copied().unwrap_or(0);
            if last != self.connectivity.len() {
                return wrong(
                    "entries in the connectivity, as the last offset says",
                    last,
                    self.connectivity.len(),
                    ends.spot(self.count.saturating_sub(1)),
                );
            }
        }
        Ok(())
    }

    /// Where the list of cell `cell` starts, or a list before it.
    fn start_of(&self, cell: u64) -> u64 {
        match &self.lists {
            Lists::Ends(_) if cell == 0 => 0,
            Lists::Ends(ends) => {
                let mut start = Vec::new();
                ends.integers(cell - 1..cell, &mut start);
                start.first().copied().unwrap_or(0)
            }
            Lists::Counted(starts) => {
                starts.binary_search_by_key(&cell, |start| start.0).map_or(0, |k| starts[k].1)
            }
        }
    }
}

impl ElementLayout for Cells {
    fn source(&self) -> &Source {
        &self.file
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        let (mut ends, mut codes, mut marks) = (Vec::new(), Vec::new(), Vec::new());
        let hidden = self.ghosts.as_ref().map_or(0, |ghosts| ghosts.1);
        let mut connectivity = Reader::new(&self.connectivity);
        let len = self.connectivity.len();
        let mut kind = LastKind::default();
        let mut at = self.start_of(span.start);
        let mut from = span.start;
        while from < span.end {
            let step = from..span.end.min(from + STEP);
            match &self.types {
                Types::Each(types) => types.integers(step.clone(), &mut codes),
                Types::All(code) => codes.resize((step.end - step.start) as usize, *code),
            }
            let regions = self.regions.begin(step.clone(), out)?;
            if let Some((array, _)) = &self.ghosts {
                array.integers(step.clone(), &mut marks);
            }
            let are_alike = regions.is_empty() && marks.is_empty();
            let ahead = match &self.lists {
                Lists::Ends(array) => {
                    array.integers(step.clone(), &mut ends);
                    ends.last().copied().unwrap_or(0).min(len)
                }
                Lists::Counted(_) => len,
            };
            let mut cells = step.clone().enumerate();
            while let Some((k, cell)) = cells.next() {
                if are_alike
                    && k.is_multiple_of(BLOCK)
                    && let Lists::Ends(_) = &self.lists
                    && let Some(end) =
                        self.block(at, &ends[k..], &codes[k..], cell, ahead, &mut connectivity, out)?
                {
                    at = end;
                    cells.nth(BLOCK - 2);
                    continue;
                }
                let label = self.first_cell + cell;
                out.at = self.connectivity.spot(at);
                let list = match &self.lists {
                    Lists::Ends(_) => at..self.checked_end(at, ends[k], label)?,
                    Lists::Counted(_) => {
                        let nodes = connectivity.get(at..at + 1, ahead)[0];
                        at + 1..list_end(at + 1, nodes, len, label)?
                    }
                };
                let kind = kind.find(codes[k], list.end - list.start, label)?;
                at = list.end;
                out.ghosts(marks.get(k).is_some_and(|mark| mark & hidden != 0));
                if let Some(region) = regions.get(k) {
                    self.regions.enter(*region, out)?;
                }
                self.cell(label, kind, list, ahead, &mut connectivity, out)?;
            }
            from = step.end;
        }
        Ok(())
    }
}

impl Cells {
    /// Hands on [`BLOCK`] cells at once, where they are of one type; gives the end of their lists. `ends` and `codes` begin
    /// with those of `cell`.
    #[expect(
        clippy::too_many_arguments,
        reason = "a place in each of the arrays that are walked side by side"
    )]
    fn block(
        &self,
        at: u64,
        ends: &[u64],
        codes: &[u64],
        cell: u64,
        ahead: u64,
        connectivity: &mut Reader<'_>,
        out: &mut ElementSink<'_>,
    ) -> Result<Option<u64>> {
        let (Some(ends), Some(codes)) = (ends.first_chunk::<BLOCK>(), codes.first_chunk::<BLOCK>()) else {
            return Ok(None);
        };
        let (nodes, end) = (ends[0].wrapping_sub(at), ends[BLOCK - 1]);
        let mut expected = at;
        let alike = ends.iter().zip(codes).fold(true, |alike, (end, code)| {
            expected = expected.wrapping_add(nodes);
            alike & (*end == expected) & (*code == codes[0])
        });
        if !alike || nodes * BLOCK as u64 > Reader::BATCH || end > self.connectivity.len() {
            return Ok(None);
        }
        // What is wrong with these cells is found one by one.
        let Ok(kind) = cells::find(codes[0], nodes, cell) else { return Ok(None) };
        if kind.nodes as u64 != nodes || self.points.is_some() {
            return Ok(None);
        }
        let labels: [u64; BLOCK] = std::array::from_fn(|k| self.first_cell + cell + k as u64);
        let ids = connectivity.get(at..end, ahead);
        Ok(out.block(kind, &labels, ids)?.then_some(end))
    }

    #[inline]
    fn checked_end(&self, start: u64, end: u64, label: u64) -> Result<u64> {
        if end < start || end > self.connectivity.len() {
            return Err(Error::malformed(
                format!("an offset from {start} to {} for cell {label}", self.connectivity.len()),
                format!("{}", end.cast_signed()),
            ));
        }
        Ok(end)
    }

    #[inline]
    fn cell(
        &self,
        label: u64,
        kind: &Arc<ElementType>,
        list: Range<u64>,
        ahead: u64,
        connectivity: &mut Reader<'_>,
        out: &mut ElementSink<'_>,
    ) -> Result<()> {
        // Only a cell of any number of points (one vertex cell may hold all of a mesh) is longer than a batch.
        let first = list.start..list.end.min(list.start + Reader::BATCH);
        let mut from = first.end;
        out.element(label, kind, self.checked_ids(label, connectivity.get(first, ahead))?)?;
        while from < list.end {
            debug_assert!(matches!(kind.class, Class::Counted(_)));
            let run = from..list.end.min(from + Reader::BATCH);
            from = run.end;
            out.mark_used(self.checked_ids(label, connectivity.get(run, list.end))?);
        }
        Ok(())
    }

    /// Numbers of points within the file, from those within this piece of the grid.
    #[inline]
    fn checked_ids<'i>(&self, label: u64, ids: &'i mut [u64]) -> Result<&'i [u64]> {
        if ids.iter().fold(0, |all, id| all | id) > i64::MAX as u64 {
            return Err(wrong_point(label, ids, "a point's number, 0 or more,", |id| id > i64::MAX as u64));
        }
        if let Some(points) = self.points {
            if ids.iter().any(|id| *id >= points) {
                let expected = format!("a point's number under {points}");
                return Err(wrong_point(label, ids, &expected, |id| id >= points));
            }
            ids.iter_mut().for_each(|id| *id += self.first_point);
        }
        Ok(ids)
    }
}

#[cold]
fn wrong_point(label: u64, ids: &[u64], expected: &str, wrong: impl Fn(u64) -> bool) -> Error {
    let found = ids.iter().copied().find(|id| wrong(*id)).unwrap_or_default();
    Error::malformed(format!("{expected} in cell {label}"), format!("{}", found.cast_signed()))
}

/// The type of the last cell: most cells are like the one before.
#[derive(Default)]
struct LastKind {
    known: Option<(u64, u64, &'static Arc<ElementType>)>,
}

impl LastKind {
    #[inline]
    fn find(&mut self, code: u64, nodes: u64, label: u64) -> Result<&'static Arc<ElementType>> {
        match self.known {
            Some((last_code, last_nodes, kind)) if last_code == code && last_nodes == nodes => Ok(kind),
            _ => {
                let kind = cells::find(code, nodes, label)?;
                self.known = Some((code, nodes, kind));
                Ok(kind)
            }
        }
    }
}
