//! Elements of several types in one stream of numbers: each begins with the code of its type, or with the number of its
//! nodes, or with both.

use std::ops::Range;
use std::sync::Arc;

use super::elements::NodeRange;
use super::regions::InRegions;
use super::{Array, Reader};
use crate::error::{Error, Result};
use crate::formats::{ElementLayout, ElementSink, Outline, PIECE_BYTES, Piece};
use crate::input::Source;
use crate::mesh::ElementType;

/// What stands at the head of an element.
#[derive(Debug, Clone, Copy)]
pub enum Heads {
    /// The code of its type; what follows that, the function tells.
    Codes(fn(u64) -> Option<Head>),
    /// The number of its nodes: all are of one type.
    #[cfg(feature = "hdf5")]
    Counts(&'static Arc<ElementType>),
}

/// What follows the code of a type.
#[derive(Debug, Clone, Copy)]
pub enum Head {
    /// As many nodes as the type has.
    Fixed(&'static Arc<ElementType>),
    /// A count and so many nodes.
    Counted(&'static Arc<ElementType>),
    /// A count of faces, and for each a count and so many nodes.
    Faces(&'static Arc<ElementType>),
}

/// Elements of several types.
#[derive(Debug)]
pub struct Coded {
    file: Arc<Source>,
    stream: Array,
    heads: Heads,
    /// Some elements, and where they start in the stream.
    starts: Vec<(u64, u64)>,
    /// The number of the first element.
    first: u64,
    range: NodeRange,
    regions: InRegions,
}

/// An element of the stream.
struct Found {
    kind: &'static Arc<ElementType>,
    /// Its nodes, unless it is a polyhedron.
    nodes: Range<u64>,
    /// Where each face's count stands, of a polyhedron: from here on so many faces.
    faces: Option<u64>,
    end: u64,
}

impl Coded {
    /// Walks through `count` elements, checks that they fill the stream, and hands them out, cut into pieces.
    pub fn outline(
        file: &Arc<Source>,
        (stream, heads): (Array, Heads),
        (first, count): (u64, u64),
        range: NodeRange,
        regions: InRegions,
        out: &mut dyn Outline,
    ) -> Result<()> {
        let file = Arc::clone(file);
        let mut coded = Self { file, stream, heads, starts: Vec::new(), first, range, regions };
        coded.walk(count).map_err(|(error, at)| coded.file.place(error, coded.stream.spot(at)))?;
        let cuts: Vec<u64> = coded.starts.iter().map(|start| start.0).collect();
        let layout: Arc<dyn ElementLayout> = Arc::new(coded);
        for (k, start) in cuts.iter().enumerate() {
            let span = *start..cuts.get(k + 1).copied().unwrap_or(count);
            out.elements(Piece { layout: Arc::clone(&layout), span })?;
        }
        Ok(())
    }

    fn walk(&mut self, count: u64) -> std::result::Result<(), (Error, u64)> {
        let (mut at, mut starts) = (0, Vec::new());
        let mut reader = Reader::new(&self.stream);
        let step = PIECE_BYTES / self.stream.width();
        for element in 0..count {
            if starts.last().is_none_or(|(_, start)| at - start >= step) {
                starts.push((element, at));
            }
            at = self.element(&mut reader, at, self.first + element).map_err(|error| (error, at))?.end;
        }
        if at != self.stream.len() {
            let expected = format!("{} numbers for {count} elements", self.stream.len());
            return Err((Error::malformed(expected, at.to_string()), at));
        }
        self.starts = starts;
        Ok(())
    }

    /// The number at `at`.
    fn number(&self, reader: &mut Reader<'_>, at: u64, label: u64) -> Result<u64> {
        if at < self.stream.len() {
            return Ok(reader.get(at..at + 1, self.stream.len())[0]);
        }
        Err(Error::malformed(format!("element {label}"), "the end of the elements"))
    }

    /// The end of a list that starts at `start`.
    fn list_end(&self, start: u64, nodes: u64, label: u64) -> Result<u64> {
        match start.checked_add(nodes) {
            Some(end) if end <= self.stream.len() => Ok(end),
            _ => Err(Error::malformed(
                format!("at most {} nodes for element {label}", self.stream.len().saturating_sub(start)),
                format!("{}", nodes.cast_signed()),
            )),
        }
    }

    fn element(&self, reader: &mut Reader<'_>, at: u64, label: u64) -> Result<Found> {
        let number = self.number(reader, at, label)?;
        let (kind, start, nodes) = match self.heads {
            #[cfg(feature = "hdf5")]
            Heads::Counts(kind) => (kind, at + 1, number),
            Heads::Codes(find) => match find(number) {
                Some(Head::Fixed(kind)) => (kind, at + 1, kind.nodes as u64),
                Some(Head::Counted(kind)) => (kind, at + 2, self.number(reader, at + 1, label)?),
                Some(Head::Faces(kind)) => return self.faces(reader, kind, at + 1, label),
                None => {
                    let expected = format!("the code of a known type for element {label}");
                    return Err(Error::malformed(expected, number.cast_signed().to_string()));
                }
            },
        };
        let end = self.list_end(start, nodes, label)?;
        Ok(Found { kind, nodes: start..end, faces: None, end })
    }

    fn faces(
        &self,
        reader: &mut Reader<'_>,
        kind: &'static Arc<ElementType>,
        at: u64,
        label: u64,
    ) -> Result<Found> {
        let faces = self.number(reader, at, label)?;
        let mut end = at + 1;
        for _ in 0..faces {
            let nodes = self.number(reader, end, label)?;
            end = self.list_end(end + 1, nodes, label)?;
        }
        Ok(Found { kind, nodes: at + 1..at + 1, faces: Some(faces), end })
    }

    /// Hands on the nodes of a list: as an element's, or as used only.
    fn list(
        &self,
        reader: &mut Reader<'_>,
        list: Range<u64>,
        label: u64,
        kind: Option<&Arc<ElementType>>,
        out: &mut ElementSink<'_>,
    ) -> Result<()> {
        // Only an element of any number of nodes is longer than a batch.
        let mut from = list.start;
        let mut kind = kind;
        loop {
            let run = from..list.end.min(from + Reader::BATCH);
            from = run.end;
            let ids = reader.get(run, self.stream.len());
            self.range.resolve(label, ids)?;
            match kind.take() {
                Some(kind) => out.element(label, kind, ids)?,
                None => out.mark_used(ids),
            }
            if from >= list.end {
                return Ok(());
            }
        }
    }
}

impl ElementLayout for Coded {
    fn source(&self) -> &Source {
        &self.file
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        let known = self.starts.binary_search_by_key(&span.start, |start| start.0);
        let mut at = known.map_or(0, |k| self.starts[k].1);
        let (mut heads, mut nodes) = (Reader::new(&self.stream), Reader::new(&self.stream));
        let regions = self.regions.begin(span.clone(), out)?;
        for (k, element) in span.enumerate() {
            let label = self.first + element;
            if let Some(region) = regions.get(k) {
                self.regions.enter(*region, out)?;
            }
            out.at = self.stream.spot(at);
            let found = self.element(&mut heads, at, label)?;
            self.list(&mut nodes, found.nodes.clone(), label, Some(found.kind), out)?;
            let mut face = found.nodes.end;
            for _ in 0..found.faces.unwrap_or(0) {
                let count = self.number(&mut heads, face, label)?;
                self.list(&mut nodes, face + 1..face + 1 + count, label, None, out)?;
                face += 1 + count;
            }
            at = found.end;
        }
        Ok(())
    }
}
