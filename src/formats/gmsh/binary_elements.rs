//! Elements in binary sections: blocks of records of one type. MSH 2 has four-byte numbers and tags before the nodes,
//! and some writers make a block of every element; 4.1 has numbers of the writer's `size_t`.

use std::ops::Range;
use std::sync::Arc;

use super::groups::Groups;
use super::walk::{Gathered, Walk};
use super::words::Binary;
use super::{Version, types};
use crate::error::{Error, Result};
use crate::formats::binary::cut_records;
use crate::formats::{BLOCK, ElementLayout, ElementSink, Outline, PIECE_BYTES, Piece};
use crate::input::{Source, Spot};
use crate::mesh::ElementType;

/// Finds the blocks of a section.
pub(super) fn outline(
    walk: &mut Walk<'_>,
    version: Version,
    binary: Binary,
    groups: Arc<Groups>,
    out: &mut dyn Outline,
) -> Result<()> {
    let tagged = version == Version::V2;
    let (blocks, elements) = if tagged {
        // As many blocks as it takes.
        (u64::MAX, walk.row("the number of elements", |row| row.integer("the number of elements"))?)
    } else {
        binary.block_counts(walk)?
    };
    let layout = Arc::new(ElementBlocks { source: Arc::clone(walk.source), binary, tagged, groups });
    let emit = |out: &mut dyn Outline, span: Option<Range<u64>>| match span {
        Some(span) => out.elements(Piece { layout: layout.clone(), span }),
        None => Ok(()),
    };
    let (mut found, mut block_number) = (0, 0);
    let mut gathered = Gathered::new(walk.at());
    while block_number < blocks && (!tagged || found < elements) {
        let start = walk.at();
        let head = walk.bytes(layout.head(), "the head of a block of elements")?;
        let block = Block::read(binary, tagged, head).map_err(|e| walk.place(e, start))?;
        let width = block.width(binary) as u64;
        let expected = || format!("{} elements of a block", block.elements);
        let body = walk.pass(block.elements.checked_mul(width), &expected())?;
        found += block.elements;
        block_number += 1;
        if body.end - body.start <= PIECE_BYTES {
            emit(out, gathered.add(body.end))?;
            continue;
        }
        emit(out, gathered.take(start))?;
        gathered = Gathered::new(body.end);
        let run = Arc::new(ElementRecords {
            source: Arc::clone(walk.source),
            binary,
            block,
            groups: layout.groups.clone(),
        });
        cut_records(run.block.elements, width, |span| {
            let span = body.start + span.start * width..body.start + span.end * width;
            out.elements(Piece { layout: run.clone(), span })
        })?;
    }
    emit(out, gathered.take(walk.at()))?;
    walk.same_count(elements, found, "elements")
}

/// Records of a long block; a span is a range of bytes.
#[derive(Debug)]
struct ElementRecords {
    source: Arc<Source>,
    binary: Binary,
    block: Block,
    groups: Arc<Groups>,
}

impl ElementLayout for ElementRecords {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        self.block.decode(self.binary, &self.groups, span.start, &self.source.window(span), out)
    }
}

/// Whole blocks; a span is a range of bytes.
#[derive(Debug)]
struct ElementBlocks {
    source: Arc<Source>,
    binary: Binary,
    tagged: bool,
    groups: Arc<Groups>,
}

impl ElementBlocks {
    /// Bytes of a block's head.
    fn head(&self) -> usize {
        if self.tagged { 12 } else { self.binary.block_head() }
    }
}

impl ElementLayout for ElementBlocks {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        let window = self.source.window(span.clone());
        let mut rest = &window[..];
        while let Some((head, body)) = rest.split_at_checked(self.head()) {
            let at = span.end - body.len() as u64;
            out.at = Spot::Binary(at - head.len() as u64);
            let block = Block::read(self.binary, self.tagged, head)?;
            let bytes = (block.elements as usize).saturating_mul(block.width(self.binary));
            let Some((records, after)) = body.split_at_checked(bytes) else {
                return Err(Error::malformed("a whole block of elements", "less"));
            };
            block.decode(self.binary, &self.groups, at, records, out)?;
            rest = after;
        }
        Ok(())
    }
}

/// The head of a block.
#[derive(Debug, Clone, Copy)]
struct Block {
    kind: &'static Arc<ElementType>,
    elements: u64,
    /// Number of words between an element's number and its nodes.
    tags: usize,
    /// Dimension and tag of the entity, in MSH 4.
    entity: Option<(u8, i64)>,
}

impl Block {
    fn read(binary: Binary, tagged: bool, head: &[u8]) -> Result<Self> {
        let endian = binary.endian;
        if !tagged {
            let dimension = binary.dimension(head)? as u8;
            let entity = Some((dimension, i64::from(endian.u32(&head[4..]) as i32)));
            let (kind, elements) =
                (types::by_number(endian.u32(&head[8..]).into())?, binary.count(&head[12..])?);
            return Ok(Self { kind, elements, tags: 0, entity });
        }
        let kind = types::by_number(endian.u32(head).into())?;
        let elements = binary.count(&head[4..])?;
        let tags = binary.count(&head[8..])? as usize;
        if kind.nodes == 0 {
            let what =
                format!("binary Gmsh MSH 2 does not store the nodes of a {}: it cannot be read", kind.name);
            return Err(Error::unsupported(what));
        }
        Ok(Self { kind, elements, tags, entity: None })
    }

    /// Bytes of a record: number, tags, nodes.
    fn width(&self, binary: Binary) -> usize {
        binary.word * (1 + self.tags + self.kind.nodes)
    }

    /// Decodes whole records, which start at byte `at` of the file.
    fn decode(
        &self,
        binary: Binary,
        groups: &Groups,
        at: u64,
        records: &[u8],
        out: &mut ElementSink<'_>,
    ) -> Result<()> {
        match self.entity {
            Some((dimension, entity)) => groups.enter_entity(dimension, entity, out)?,
            None if out.wants_regions() => return self.decode_tagged(binary, groups, at, records, out),
            None => {}
        }
        match binary.word {
            4 => self.decode_words::<4>(binary, at, records, out),
            _ => self.decode_words::<8>(binary, at, records, out),
        }
    }

    /// Decodes records of MSH 2, whose first tag is their physical group, run by run of one group.
    fn decode_tagged(
        &self,
        binary: Binary,
        groups: &Groups,
        at: u64,
        records: &[u8],
        out: &mut ElementSink<'_>,
    ) -> Result<()> {
        let group = |record: &[u8]| match self.tags {
            0 => 0,
            _ => i64::from(binary.endian.u32(&record[binary.word..]) as i32),
        };
        let width = self.width(binary);
        let (mut from, mut to) = (0, 0);
        while from < records.len() {
            let tag = group(&records[from..]);
            while to < records.len() && group(&records[to..]) == tag {
                to += width;
            }
            groups.enter(self.kind, tag, out)?;
            self.decode_words::<4>(binary, at + from as u64, &records[from..to], out)?;
            from = to;
        }
        Ok(())
    }

    /// The numbers of nodes that nearly all meshes are made of have a loop of their own.
    fn decode_words<const WORD: usize>(
        &self,
        binary: Binary,
        at: u64,
        records: &[u8],
        out: &mut ElementSink<'_>,
    ) -> Result<()> {
        match self.kind.nodes {
            2 => self.decode_nodes::<WORD, 2>(binary, at, records, out),
            3 => self.decode_nodes::<WORD, 3>(binary, at, records, out),
            4 => self.decode_nodes::<WORD, 4>(binary, at, records, out),
            5 => self.decode_nodes::<WORD, 5>(binary, at, records, out),
            6 => self.decode_nodes::<WORD, 6>(binary, at, records, out),
            8 => self.decode_nodes::<WORD, 8>(binary, at, records, out),
            10 => self.decode_nodes::<WORD, 10>(binary, at, records, out),
            _ => self.decode_any::<WORD>(binary, at, records, out),
        }
    }

    fn decode_nodes<const WORD: usize, const NODES: usize>(
        &self,
        binary: Binary,
        at: u64,
        records: &[u8],
        out: &mut ElementSink<'_>,
    ) -> Result<()> {
        let skip = WORD * (1 + self.tags);
        let width = skip + WORD * NODES;
        let (mut labels, mut ids) = ([0; BLOCK], [[0; NODES]; BLOCK]);
        for (number, block) in records.chunks(BLOCK * width).enumerate() {
            let count = block.len() / width;
            // Those over the largest have a bit that it has not.
            let mut bits = 0;
            for (record, (label, ids)) in block.chunks_exact(width).zip(labels.iter_mut().zip(&mut ids)) {
                let (head, nodes) = record.split_at(skip);
                *label = binary.word::<WORD>(head);
                bits |= *label;
                for (id, raw) in ids.iter_mut().zip(nodes.as_chunks::<WORD>().0) {
                    *id = binary.word::<WORD>(raw);
                    bits |= *id;
                }
            }
            if bits & !binary.most != 0
                || !out.block(self.kind, &labels[..count], ids[..count].as_flattened())?
            {
                self.decode_any::<WORD>(binary, at + (number * BLOCK * width) as u64, block, out)?;
            }
        }
        Ok(())
    }

    /// Record by record: elements with many nodes, and blocks with an error in them, which this finds.
    fn decode_any<const WORD: usize>(
        &self,
        binary: Binary,
        at: u64,
        records: &[u8],
        out: &mut ElementSink<'_>,
    ) -> Result<()> {
        let skip = WORD * (1 + self.tags);
        let width = skip + WORD * self.kind.nodes;
        let mut ids = vec![0; self.kind.nodes];
        for (k, record) in records.chunks_exact(width).enumerate() {
            out.at = Spot::Binary(at + (k * width) as u64);
            let label = binary.tag::<WORD>(record, 0)?;
            binary.tags::<WORD>(&record[skip..], &mut ids)?;
            out.element(label, self.kind, &ids)?;
        }
        Ok(())
    }
}
