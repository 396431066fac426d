//! The node stage: pieces are decoded by several threads and put into the table in the order of the file.

use super::Progress;
use super::in_order::in_order;
use crate::error::Result;
use crate::formats::{NodeBatch, NodeLayout, Piece};
use crate::mesh::{Nodes, NodesBuilder};

/// Reads all nodes.
pub(super) fn read_nodes(
    pieces: &[Piece<dyn NodeLayout>],
    threads: usize,
    mut builder: NodesBuilder,
    progress: &Progress,
) -> Result<Nodes> {
    let decode = |number: usize, mut batch: NodeBatch| {
        let Piece { layout, span } = &pieces[number];
        batch.clear();
        let done = layout.decode(span.clone(), &mut batch);
        done.map_err(|error| layout.source().place(error, batch.at)).map(|()| batch)
    };
    in_order(pieces.len(), threads, decode, |number, batch| {
        if number == 0 {
            builder.expect(batch.rows().len().saturating_mul(pieces.len()));
        }
        builder.extend(batch.ids(), batch.rows())?;
        progress.done(0);
        Ok(batch)
    })?;
    builder.finish()
}
