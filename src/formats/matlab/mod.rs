//! MATLAB's MAT-files of versions 4, 5 and 7.3 (an HDF5 file), with a mesh of the PDE toolbox (`p`, `e`, `t`), of a mesh
//! object's arrays (`Nodes`, `Elements`) or of names like these, alone or in structures and cells, either way up.

mod choose;
mod contents;
mod store;
#[cfg(test)]
mod tests;
mod unpack;
mod version4;
#[cfg(feature = "hdf5")]
mod version73;

use std::ops::Range;
use std::sync::Arc;

use crate::error::{Error, Result};
use crate::formats::binary::cut_records;
use crate::formats::{ElementLayout, ElementSink, Format, HEAD_BYTES, NodeBatch, NodeLayout, Outline, Piece};
use crate::input::{Input, Source, Spot};
use choose::{Choice, Group};
use contents::Contents;
use store::Records;

/// What a file of version 7.3 starts with, before the HDF5 file in it.
const HDF5: &[u8] = b"MATLAB 7.3 MAT-file";

/// The format's row in the table of formats.
pub(super) struct Matlab;

impl Format for Matlab {
    fn name(&self) -> &'static str {
        "matlab"
    }

    fn title(&self) -> &'static str {
        "MATLAB MAT-files of versions 4, 5 and 7.3, plain or compressed: p, e, t or Nodes, Elements"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["mat"]
    }

    fn looks_for(&self) -> &'static str {
        "MATLAB 5.0 MAT-file, MATLAB 7.3 MAT-file, or the head of a matrix of version 4"
    }

    fn detect(&self, head: &[u8]) -> bool {
        head.starts_with(b"MATLAB 5.0 MAT-file") || head.starts_with(HDF5) || version4::detect(head)
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        let source = &input.source;
        let contents = read(input)?;
        let Choice { points, groups, edges } =
            choose::choose(contents).map_err(|e| source.place(e, Spot::Binary(0)))?;
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

/// What the file holds, whatever its version.
fn read(input: &Input) -> Result<Contents> {
    let head = input.source.peek(0..HEAD_BYTES as u64);
    if head.starts_with(HDF5) {
        #[cfg(feature = "hdf5")]
        return version73::read(input);
        #[cfg(not(feature = "hdf5"))]
        return Err(input.source.place(
            Error::unsupported(
                "MAT-files of version 7.3 (HDF5) are not read: this program was built without",
            ),
            Spot::Binary(0),
        ));
    }
    if version4::detect(head) { version4::read(&input.source) } else { contents::read(input) }
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
