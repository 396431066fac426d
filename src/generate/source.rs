//! A mesh that is walked through and never held.

use std::io;

use crate::mesh::Shape;

/// Takes the coordinates of one node.
pub type VisitNode<'a> = &'a mut dyn FnMut([f64; 3]) -> io::Result<()>;

/// Takes the corners of one element as positions of nodes, from 0, in the order that [`Shape`] documents.
pub type VisitElement<'a> = &'a mut dyn FnMut(&[u64]) -> io::Result<()>;

/// All elements of one shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Block {
    /// Their shape.
    pub shape: Shape,
    /// How many there are.
    pub elements: u64,
}

/// A mesh that is walked through and never held. Every walk gives the same, so that a writer may walk as often as its
/// format asks.
///
/// Elements are numbered block after block. Every element has a positive volume, or on the plane z = 0 a positive area.
pub trait MeshSource: Send + Sync {
    /// Number of nodes.
    fn nodes(&self) -> u64;
    /// The blocks of elements in the order of their numbers, no shape twice and none empty.
    fn blocks(&self) -> Vec<Block>;
    /// Visits all nodes in order. An error of the visitor ends the walk.
    fn each_node(&self, visit: VisitNode<'_>) -> io::Result<()>;
    /// Visits all elements of the block of `shape` in order. An error of the visitor ends the walk.
    fn each_element(&self, shape: Shape, visit: VisitElement<'_>) -> io::Result<()>;

    /// Number of elements in all blocks.
    fn elements(&self) -> u64 {
        self.blocks().iter().map(|block| block.elements).sum()
    }

    /// The dimension of the mesh: that of its shapes.
    fn dimension(&self) -> usize {
        self.blocks().iter().map(|block| block.shape.dimension()).max().unwrap_or(3)
    }
}
