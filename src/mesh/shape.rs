//! The six shapes that are measured, as rows: corners, edges and faces in local numbers.
//!
//! Local numbering is that of Abaqus, Gmsh and VTK 9.7: the base ring first, counter-clockwise seen from inside
//! the solid's far side, then the upper ring or the apex. With it a sound element has a positive volume.

use std::fmt;

use serde::{Deserialize, Serialize};

/// A shape that the report's measures are defined for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Shape {
    /// Three corners.
    Triangle,
    /// Four corners in order round it.
    Quadrilateral,
    /// Four corners.
    Tetrahedron,
    /// A quadrilateral base and an apex.
    Pyramid,
    /// Two triangles joined by three quadrilaterals.
    Wedge,
    /// Two quadrilaterals joined by four.
    Hexahedron,
}

/// The facts of a shape: everything that other modules loop over.
#[derive(Debug)]
pub struct Facts {
    /// The shape's name in summaries.
    pub name: &'static str,
    /// The number that VTK, and SU2 after it, give the linear cell.
    pub vtk_cell: u8,
    /// Number of corner nodes.
    pub corners: usize,
    /// 2 for surfaces, 3 for solids.
    pub dimension: usize,
    /// Pairs of local corners.
    pub edges: &'static [[usize; 2]],
    /// Triangular faces as local corners; a triangle is its own face.
    pub triangles: &'static [[usize; 3]],
    /// Quadrilateral faces as local corners in order round them; a quadrilateral is its own face.
    pub quadrilaterals: &'static [[usize; 4]],
}

impl Shape {
    /// Every shape, in the order of a summary.
    pub const ALL: [Shape; 6] = [
        Shape::Triangle,
        Shape::Quadrilateral,
        Shape::Tetrahedron,
        Shape::Pyramid,
        Shape::Wedge,
        Shape::Hexahedron,
    ];

    /// The largest number of corners of any shape.
    pub const MAX_CORNERS: usize = 8;

    /// The shape's row.
    pub const fn facts(self) -> &'static Facts {
        match self {
            Shape::Triangle => &TRIANGLE,
            Shape::Quadrilateral => &QUADRILATERAL,
            Shape::Tetrahedron => &TETRAHEDRON,
            Shape::Pyramid => &PYRAMID,
            Shape::Wedge => &WEDGE,
            Shape::Hexahedron => &HEXAHEDRON,
        }
    }

    /// The shape's name in summaries.
    pub const fn name(self) -> &'static str {
        self.facts().name
    }

    /// Number of corner nodes.
    pub const fn corners(self) -> usize {
        self.facts().corners
    }

    /// 2 for surfaces, 3 for solids.
    pub const fn dimension(self) -> usize {
        self.facts().dimension
    }

    /// The place of the shape in [`Shape::ALL`].
    pub const fn index(self) -> usize {
        self as usize
    }
}

impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

static TRIANGLE: Facts = Facts {
    name: "triangle",
    vtk_cell: 5,
    corners: 3,
    dimension: 2,
    edges: &[[0, 1], [1, 2], [2, 0]],
    triangles: &[[0, 1, 2]],
    quadrilaterals: &[],
};

static QUADRILATERAL: Facts = Facts {
    name: "quadrilateral",
    vtk_cell: 9,
    corners: 4,
    dimension: 2,
    edges: &[[0, 1], [1, 2], [2, 3], [3, 0]],
    triangles: &[],
    quadrilaterals: &[[0, 1, 2, 3]],
};

static TETRAHEDRON: Facts = Facts {
    name: "tetrahedron",
    vtk_cell: 10,
    corners: 4,
    dimension: 3,
    edges: &[[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]],
    triangles: &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
    quadrilaterals: &[],
};

static PYRAMID: Facts = Facts {
    name: "pyramid",
    vtk_cell: 14,
    corners: 5,
    dimension: 3,
    edges: &[[0, 1], [1, 2], [2, 3], [3, 0], [0, 4], [1, 4], [2, 4], [3, 4]],
    triangles: &[[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
    quadrilaterals: &[[0, 3, 2, 1]],
};

static WEDGE: Facts = Facts {
    name: "wedge",
    vtk_cell: 13,
    corners: 6,
    dimension: 3,
    edges: &[[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3], [0, 3], [1, 4], [2, 5]],
    triangles: &[[0, 2, 1], [3, 4, 5]],
    quadrilaterals: &[[0, 1, 4, 3], [1, 2, 5, 4], [2, 0, 3, 5]],
};

static HEXAHEDRON: Facts = Facts {
    name: "hexahedron",
    vtk_cell: 12,
    corners: 8,
    dimension: 3,
    edges: &[[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]],
    triangles: &[],
    quadrilaterals: &[[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]],
};
