//! MATLAB's MAT-files of version 5 (`save` without `-v7.3`), with a mesh of the PDE toolbox (`p`, `e`, `t`), of a mesh
//! object's arrays (`Nodes`, `Elements`) or of names like these, alone or in structures and cells, either way up.

mod choose;
mod contents;
mod store;
#[cfg(test)]
mod tests;
mod unpack;

use std::ops::Range;
use std::sync::Arc;

use crate::error::{Error, Result};
use crate::formats::binary::cut_records;
use crate::formats::{ElementLayout, ElementSink, Format, NodeBatch, NodeLayout, Outline, Piece};
use crate::input::{Input, Source, Spot};
use choose::{Choice, Group};
use store::Records;

/// The format's row in the table of formats.
pub(super) struct Matlab;

impl Format for Matlab {
    fn name(&self) -> &'static str {
        "matlab"
    }

    fn title(&self) -> &'static str {
        "MATLAB MAT-files of version 5, plain or compressed: p, e, t or Nodes, Elements"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["mat"]
    }

    fn looks_for(&self) -> &'static str {
        "MATLAB 5.0 MAT-file"
    }

    fn detect(&self, head: &[u8]) -> bool {
        head.starts_with(b"MATLAB 5.0 MAT-file") || head.starts_with(b"MATLAB 7.3 MAT-file")
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        let source = &input.source;
        let Choice { points, groups, edges } =
            choose::choose(contents::read(input)?).map_err(|e| source.place(e, Spot::Binary(0)))?;
        let (count, width) = (points.count(), 8 * points.width() as u64);
        let layout = Arc::new(Points { source: Arc::clone(source), records: points });
        cut_records(count, width, |span| out.nodes(Piece { layout: layout.clone(), span }))?;
        let mut first = 1;
        for group in groups {
            let (count, width) = (group.records.count(), 8 * group.records.width() as u64);
            let layout = Arc::new(Elements { source: Arc::clone(source), group, first });
            cut_records(count, width, |span| out.elements(Piece { layout: layout.clone(), span }))?;
            first += count;
        }
        match edges {
            Some(edges) => out.count(choose::line(), edges),
            None => Ok(()),
        }
    }
}

/// Points; a span is a range of their numbers, from 0.
#[derive(Debug)]
struct Points {
    source: Arc<Source>,
    records: Records,
}

impl NodeLayout for Points {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let mut values = Vec::new();
        self.records.read(span.clone(), &mut values);
        for (record, number) in values.chunks_exact(self.records.width()).zip(span) {
            out.at = self.records.spot(number);
            let z = record.get(2).copied().unwrap_or(0.0);
            out.push(number + 1, [record[0], record[1], z])?;
        }
        Ok(())
    }
}

/// Elements; a span is a range of their numbers within the group, from 0.
#[derive(Debug)]
struct Elements {
    source: Arc<Source>,
    group: Group,
    /// Number of the group's first element within the file.
    first: u64,
}

impl ElementLayout for Elements {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        let Group { records, kind } = &self.group;
        let (mut values, mut ids) = (Vec::new(), Vec::new());
        records.read(span.clone(), &mut values);
        for (record, number) in values.chunks_exact(records.width()).zip(span) {
            out.at = records.spot(number);
            ids.clear();
            for value in &record[..kind.nodes] {
                ids.push(id(*value).ok_or_else(|| {
                    let expected =
                        format!("a point's number, 1 or more, in {} of element", records.matrix.path);
                    Error::malformed(format!("{expected} {}", self.first + number), value.to_string())
                })?);
            }
            out.element(self.first + number, kind, &ids)?;
        }
        Ok(())
    }
}

/// A number that counts something from 1.
#[inline]
fn id(value: f64) -> Option<u64> {
    const MOST: f64 = (1u64 << 53) as f64;
    let id = value as u64;
    ((1.0..=MOST).contains(&value) && id as f64 == value).then_some(id)
}
