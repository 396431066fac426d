//! Hexahedra of a structured grid, as they are or each cut into five tetrahedra.

use std::io;

use super::parameter::{Parameter, Range};
use super::{Block, MeshSource, VisitElement, VisitNode};
use crate::mesh::Shape;

/// Takes one brick: its corners in the order of a hexahedron, and whether the first of them is dark.
pub(super) type VisitBrick<'a> = &'a mut dyn FnMut(&[u64; 8], bool) -> io::Result<()>;

/// A grid of bricks whose nodes are coloured like a chessboard: of the two ends of an edge one is dark.
///
/// Every simply connected grid of bricks can be coloured so. The diagonals that join the dark corners of a face are then
/// the same from both of its sides.
pub(super) trait BrickGrid: Send + Sync {
    /// Number of nodes.
    fn nodes(&self) -> u64;
    /// Number of bricks.
    fn bricks(&self) -> u64;
    /// Visits all nodes in order.
    fn each_node(&self, visit: VisitNode<'_>) -> io::Result<()>;
    /// Visits all bricks in order.
    fn each_brick(&self, visit: VisitBrick<'_>) -> io::Result<()>;
}

/// What bricks become.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Cells {
    Hexahedra,
    Tetrahedra,
}

/// The bricks of a grid as a mesh.
pub(super) struct Bricks<G> {
    pub(super) grid: G,
    pub(super) cells: Cells,
}

/// The choice between hexahedra and tetrahedra; `default` is the place of one in this list.
pub(super) const fn cells_parameter(default: f64) -> Parameter {
    Parameter {
        name: "elements",
        meaning: "what the mesh is made of",
        default,
        range: Range::Choice(&["hexahedra", "tetrahedra"]),
    }
}

/// One regular tetrahedron on the corners of one colour and four on the others: each brick's first corner is in the
/// first tetrahedron where it is dark.
const FIVE: [[[usize; 4]; 5]; 2] = [
    [[1, 3, 4, 6], [0, 1, 3, 4], [2, 3, 1, 6], [5, 4, 6, 1], [7, 6, 4, 3]],
    [[0, 2, 7, 5], [1, 2, 0, 5], [3, 0, 2, 7], [4, 7, 5, 0], [6, 5, 7, 2]],
];

impl<G: BrickGrid> MeshSource for Bricks<G> {
    fn nodes(&self) -> u64 {
        self.grid.nodes()
    }

    fn blocks(&self) -> Vec<Block> {
        let bricks = self.grid.bricks();
        vec![match self.cells {
            Cells::Hexahedra => Block { shape: Shape::Hexahedron, elements: bricks },
            Cells::Tetrahedra => Block { shape: Shape::Tetrahedron, elements: 5 * bricks },
        }]
    }

    fn each_node(&self, visit: VisitNode<'_>) -> io::Result<()> {
        self.grid.each_node(visit)
    }

    fn each_element(&self, shape: Shape, visit: VisitElement<'_>) -> io::Result<()> {
        match (self.cells, shape) {
            (Cells::Hexahedra, Shape::Hexahedron) => self.grid.each_brick(&mut |corners, _| visit(corners)),
            (Cells::Tetrahedra, Shape::Tetrahedron) => self.grid.each_brick(&mut |corners, dark| {
                FIVE[usize::from(dark)].iter().try_for_each(|four| visit(&four.map(|corner| corners[corner])))
            }),
            _ => Ok(()),
        }
    }
}
