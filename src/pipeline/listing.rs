//! Hands every measured element to whoever takes them, in the order of the file.

use super::each::Rows;
use crate::error::Result;
use crate::measures::{self, measures};
use crate::mesh::{ElementWriter, Regions, ScoredElement, Shape};

/// Who takes the elements, and what is known of their regions.
pub(super) struct Listing<'a> {
    writer: &'a mut dyn ElementWriter,
    regions: &'a Regions,
    /// Names of the regions met so far, by number; the first is that of none.
    names: Vec<Option<String>>,
}

impl<'a> Listing<'a> {
    pub(super) fn new(writer: &'a mut dyn ElementWriter, regions: &'a Regions) -> Self {
        Self { writer, regions, names: vec![None] }
    }

    /// Hands on the elements of a piece: those of all its chunks, which are of one shape each.
    pub(super) fn piece(&mut self, chunks: Vec<(Shape, Box<Rows>)>) -> Result<()> {
        let places = chunks.iter().enumerate().flat_map(|(c, (_, rows))| {
            rows.tags.iter().enumerate().map(move |(row, tag)| (tag.ordinal, c, row))
        });
        let mut places: Vec<_> = places.collect();
        places.sort_unstable();
        let mut scores = vec![f64::NAN; measures().count()];
        let mut last = None;
        for (_, c, row) in places {
            let (shape, rows) = &chunks[c];
            if last != Some(*shape) {
                // The columns of another shape are not those of this one.
                scores.fill(f64::NAN);
                last = Some(*shape);
            }
            fill(&mut scores, *shape, rows, row);
            self.hand_on(*shape, rows, row, &scores)?;
        }
        Ok(())
    }

    fn hand_on(&mut self, shape: Shape, rows: &Rows, row: usize, scores: &[f64]) -> Result<()> {
        let region = rows.tags[row].region as usize;
        while self.names.len() <= region {
            self.names.push(self.regions.name(self.names.len() as u32));
        }
        let corners = shape.corners();
        self.writer.write(&ScoredElement {
            label: rows.labels[row],
            shape,
            region: self.names[region].as_deref(),
            corners: &rows.corners[row * corners..][..corners],
            centroid: rows.centroids[row],
            extent: rows.extents[row],
            size: rows.sizes[row],
            scores,
        })
    }
}

/// The scores of one element, in the order of the table of measures.
fn fill(scores: &mut [f64], shape: Shape, rows: &Rows, row: usize) {
    for (subject, what) in measures::subjects(shape).iter().enumerate() {
        let first = measures().take_while(|measure| measure.family != what.family).count();
        for (score, column) in scores[first..].iter_mut().zip(&rows.scores[subject]) {
            if let Some(value) = column.get(row) {
                *score = *value;
            }
        }
    }
}
