//! Reads a whole small mesh on one thread: what the formats' own tests hold against known counts.

use std::path::Path;

use super::{Chunks, ElementSink, Format, Ledger, NodeBatch, Plan};
use crate::error::Result;
use crate::input::{Limits, Scratch};
use crate::mesh::{Chunk, Nodes, NodesBuilder, Shape};

/// A mesh in memory.
#[derive(Debug)]
pub(crate) struct Mesh {
    pub(crate) nodes: Nodes,
    /// Element number, shape and corner coordinates.
    pub(crate) elements: Vec<(u64, Shape, Vec<[f64; 3]>)>,
    pub(crate) ledger: Ledger,
}

#[derive(Default)]
struct Kept(Vec<Chunk>);

impl Chunks for Kept {
    fn empty(&mut self) -> Result<Chunk> {
        Ok(Chunk::new())
    }

    fn hand_on(&mut self, chunk: Chunk) -> Result<()> {
        self.0.push(chunk);
        Ok(())
    }
}

/// Reads `path` as `format`.
pub(crate) fn read(format: &dyn Format, path: &Path) -> Result<Mesh> {
    let scratch = Scratch::new(&std::env::temp_dir(), 1 << 30);
    let input = super::open(path, &Limits::default(), &scratch)?;
    let mut pieces = Plan::default();
    format.outline(&input, &mut pieces)?;
    let mut builder = NodesBuilder::new(&input.memory, &scratch);
    let mut batch = NodeBatch::default();
    for piece in &pieces.nodes {
        batch.clear();
        let done = piece.layout.decode(piece.span.clone(), &mut batch);
        done.map_err(|e| piece.layout.source().place(e, batch.at))?;
        builder.extend(batch.ids(), batch.rows())?;
    }
    let nodes = builder.finish()?;
    let (mut kept, mut ledger) = (Kept::default(), pieces.ledger);
    for (number, piece) in pieces.elements.iter().enumerate() {
        let mut sink = ElementSink::new(&nodes, &mut kept, number as u64, false);
        let done = piece.layout.decode(piece.span.clone(), &mut sink);
        done.map_err(|e| piece.layout.source().place(e, sink.at))?;
        ledger.merge(&sink.finish()?.0);
    }
    let mut elements = Vec::new();
    for chunk in kept.0 {
        for (label, rows) in chunk.labels().iter().zip(chunk.rows().chunks(chunk.shape().corners())) {
            let corners = rows.iter().map(|&row| nodes.rows()[row as usize]).collect();
            elements.push((*label, chunk.shape(), corners));
        }
    }
    Ok(Mesh { nodes, elements, ledger })
}

impl Mesh {
    /// Number of measured elements of a shape.
    pub(crate) fn count(&self, shape: Shape) -> usize {
        self.elements.iter().filter(|e| e.1 == shape).count()
    }
}
