//! Where everything stands in the file, as the format outlined it.

use super::{ElementLayout, Ledger, NodeLayout, Outline, Piece};
use crate::error::Result;
use crate::mesh::ElementType;

/// The pieces of a file, in file order.
#[derive(Default)]
pub struct Plan {
    /// Pieces of node records.
    pub nodes: Vec<Piece<dyn NodeLayout>>,
    /// Pieces of element records.
    pub elements: Vec<Piece<dyn ElementLayout>>,
    /// Elements that no piece speaks of.
    pub ledger: Ledger,
}

impl Outline for Plan {
    fn nodes(&mut self, piece: Piece<dyn NodeLayout>) -> Result<()> {
        self.nodes.push(piece);
        Ok(())
    }

    fn elements(&mut self, piece: Piece<dyn ElementLayout>) -> Result<()> {
        self.elements.push(piece);
        Ok(())
    }

    fn count(&mut self, kind: &ElementType, count: u64) -> Result<()> {
        self.ledger.count(kind, count);
        Ok(())
    }
}
