//! The table of VTK cell types.

use std::sync::{Arc, LazyLock};

use crate::error::{Error, Result};
use crate::mesh::{ElementType, Shape};

/// VTK 9.7 turned its wedge round, and writers follow either sense.
pub(super) const OWN_ORIENTATION: &[Shape] = &[Shape::Wedge];

/// Highest order of an arbitrary-order cell.
const MAX_ORDER: usize = 32;

/// Corners in our order.
const RING: &[u8] = &[0, 1, 2, 3, 4, 5, 6, 7];
/// Corners in tensor order: x fastest, then y, then z.
const TENSOR: &[u8] = &[0, 1, 3, 2, 4, 5, 7, 6];

/// Numbers of nodes, each with the order that it means.
type Sizes = &'static [(usize, u8)];

/// Cells that are measured: code, name, shape, corner order, sizes.
#[rustfmt::skip]
static MEASURED: &[(u8, &str, Shape, &[u8], Sizes)] = &[
    (5, "VTK_TRIANGLE", Shape::Triangle, RING, &[(3, 1)]),
    (7, "VTK_POLYGON", Shape::Triangle, RING, &[(3, 1)]),
    (7, "VTK_POLYGON", Shape::Quadrilateral, RING, &[(4, 1)]),
    (8, "VTK_PIXEL", Shape::Quadrilateral, TENSOR, &[(4, 1)]),
    (9, "VTK_QUAD", Shape::Quadrilateral, RING, &[(4, 1)]),
    (10, "VTK_TETRA", Shape::Tetrahedron, RING, &[(4, 1)]),
    (11, "VTK_VOXEL", Shape::Hexahedron, TENSOR, &[(8, 1)]),
    (12, "VTK_HEXAHEDRON", Shape::Hexahedron, RING, &[(8, 1)]),
    (13, "VTK_WEDGE", Shape::Wedge, RING, &[(6, 1)]),
    // Gmsh writes its pyramids of 13 nodes under the code of the linear one.
    (14, "VTK_PYRAMID", Shape::Pyramid, RING, &[(5, 1), (13, 2)]),
    (22, "VTK_QUADRATIC_TRIANGLE", Shape::Triangle, RING, &[(6, 2)]),
    (23, "VTK_QUADRATIC_QUAD", Shape::Quadrilateral, RING, &[(8, 2)]),
    (24, "VTK_QUADRATIC_TETRA", Shape::Tetrahedron, RING, &[(10, 2)]),
    (25, "VTK_QUADRATIC_HEXAHEDRON", Shape::Hexahedron, RING, &[(20, 2)]),
    (26, "VTK_QUADRATIC_WEDGE", Shape::Wedge, RING, &[(15, 2)]),
    (27, "VTK_QUADRATIC_PYRAMID", Shape::Pyramid, RING, &[(13, 2)]),
    (28, "VTK_BIQUADRATIC_QUAD", Shape::Quadrilateral, RING, &[(9, 2)]),
    (29, "VTK_TRIQUADRATIC_HEXAHEDRON", Shape::Hexahedron, RING, &[(27, 2)]),
    (30, "VTK_QUADRATIC_LINEAR_QUAD", Shape::Quadrilateral, RING, &[(6, 2)]),
    (31, "VTK_QUADRATIC_LINEAR_WEDGE", Shape::Wedge, RING, &[(12, 2)]),
    (32, "VTK_BIQUADRATIC_QUADRATIC_WEDGE", Shape::Wedge, RING, &[(18, 2)]),
    (33, "VTK_BIQUADRATIC_QUADRATIC_HEXAHEDRON", Shape::Hexahedron, RING, &[(24, 2)]),
    (34, "VTK_BIQUADRATIC_TRIANGLE", Shape::Triangle, RING, &[(7, 2)]),
    (36, "VTK_QUADRATIC_POLYGON", Shape::Triangle, RING, &[(6, 2)]),
    (36, "VTK_QUADRATIC_POLYGON", Shape::Quadrilateral, RING, &[(8, 2)]),
    (37, "VTK_TRIQUADRATIC_PYRAMID", Shape::Pyramid, RING, &[(19, 2)]),
    // Of second order there are also cells with a node in each face and inside.
    (69, "VTK_LAGRANGE_TRIANGLE", Shape::Triangle, RING, &[(7, 2)]),
    (71, "VTK_LAGRANGE_TETRAHEDRON", Shape::Tetrahedron, RING, &[(15, 2)]),
    (73, "VTK_LAGRANGE_WEDGE", Shape::Wedge, RING, &[(21, 2)]),
];

/// Cells of arbitrary order, corners first: code, name, shape.
#[rustfmt::skip]
static ANY_ORDER: &[(u8, &str, Shape)] = &[
    (69, "VTK_LAGRANGE_TRIANGLE", Shape::Triangle),
    (70, "VTK_LAGRANGE_QUADRILATERAL", Shape::Quadrilateral),
    (71, "VTK_LAGRANGE_TETRAHEDRON", Shape::Tetrahedron),
    (72, "VTK_LAGRANGE_HEXAHEDRON", Shape::Hexahedron),
    (73, "VTK_LAGRANGE_WEDGE", Shape::Wedge),
    (74, "VTK_LAGRANGE_PYRAMID", Shape::Pyramid),
    (76, "VTK_BEZIER_TRIANGLE", Shape::Triangle),
    (77, "VTK_BEZIER_QUADRILATERAL", Shape::Quadrilateral),
    (78, "VTK_BEZIER_TETRAHEDRON", Shape::Tetrahedron),
    (79, "VTK_BEZIER_HEXAHEDRON", Shape::Hexahedron),
    (80, "VTK_BEZIER_WEDGE", Shape::Wedge),
    (81, "VTK_BEZIER_PYRAMID", Shape::Pyramid),
];

/// Cells that are counted: code, name, what they are, number of nodes (0: any).
#[rustfmt::skip]
static COUNTED: &[(u8, &str, &str, usize)] = &[
    (0, "VTK_EMPTY_CELL", "empty cell", 0),
    (1, "VTK_VERTEX", "point", 1),
    (2, "VTK_POLY_VERTEX", "point", 0),
    (3, "VTK_LINE", "line", 2),
    (4, "VTK_POLY_LINE", "line", 0),
    (6, "VTK_TRIANGLE_STRIP", "triangle strip", 0),
    (7, "VTK_POLYGON", "polygon", 0),
    (15, "VTK_PENTAGONAL_PRISM", "polyhedron", 10),
    (16, "VTK_HEXAGONAL_PRISM", "polyhedron", 12),
    (21, "VTK_QUADRATIC_EDGE", "line", 3),
    (35, "VTK_CUBIC_LINE", "line", 4),
    (36, "VTK_QUADRATIC_POLYGON", "polygon", 0),
    (41, "VTK_CONVEX_POINT_SET", "polyhedron", 0),
    (42, "VTK_POLYHEDRON", "polyhedron", 0),
    (68, "VTK_LAGRANGE_CURVE", "line", 0),
    (75, "VTK_BEZIER_CURVE", "line", 0),
];

/// What one code stands for.
#[derive(Default)]
struct Code {
    /// By number of nodes, which is the type's own.
    exact: Vec<Arc<ElementType>>,
    /// With any other number of nodes.
    other: Option<Arc<ElementType>>,
}

static CODES: LazyLock<Vec<Code>> = LazyLock::new(|| {
    let mut codes: Vec<Code> = Vec::new();
    codes.resize_with(usize::from(u8::MAX) + 1, Code::default);
    for &(code, name, shape, corners, sizes) in MEASURED {
        for &(nodes, order) in sizes {
            let kind = ElementType::permuted(name, shape, order, nodes, &corners[..shape.corners()]);
            codes[usize::from(code)].exact.push(Arc::new(kind));
        }
    }
    for &(code, name, shape) in ANY_ORDER {
        for order in 1..=MAX_ORDER {
            let kind = ElementType::measured(name, shape, order as u8, nodes_of_order(shape, order));
            codes[usize::from(code)].exact.push(Arc::new(kind));
        }
    }
    for &(code, name, what, nodes) in COUNTED {
        let kind = Arc::new(ElementType::counted(name, what, nodes));
        let code = &mut codes[usize::from(code)];
        if nodes == 0 { code.other = Some(kind) } else { code.exact.push(kind) }
    }
    codes
});

/// Number of nodes of a complete cell of order `n`.
fn nodes_of_order(shape: Shape, n: usize) -> usize {
    match shape {
        Shape::Triangle => (n + 1) * (n + 2) / 2,
        Shape::Quadrilateral => (n + 1) * (n + 1),
        Shape::Tetrahedron => (n + 1) * (n + 2) * (n + 3) / 6,
        Shape::Pyramid => (n + 1) * (n + 2) * (2 * n + 3) / 6,
        Shape::Wedge => (n + 1) * (n + 1) * (n + 2) / 2,
        Shape::Hexahedron => (n + 1) * (n + 1) * (n + 1),
    }
}

/// The type of the cell `cell` of type `code` with `nodes` nodes.
pub fn find(code: u64, nodes: u64, cell: u64) -> Result<&'static Arc<ElementType>> {
    let known = usize::try_from(code).ok().and_then(|code| CODES.get(code));
    let fits = known
        .and_then(|code| code.exact.iter().find(|kind| kind.nodes as u64 == nodes).or(code.other.as_ref()));
    fits.ok_or_else(|| unfit(known, code, nodes, cell))
}

#[cold]
fn unfit(known: Option<&Code>, code: u64, nodes: u64, cell: u64) -> Error {
    let Some(first) = known.and_then(|code| code.exact.first()) else {
        return Error::malformed(
            format!("a known cell type for cell {cell}"),
            format!("type {}", code.cast_signed()),
        );
    };
    let name = &first.name;
    if ANY_ORDER.iter().any(|row| u64::from(row.0) == code) {
        let least = known.into_iter().flat_map(|code| &code.exact).map(|kind| kind.nodes).min().unwrap_or(1);
        return Error::unsupported(format!(
            "cell {cell} is a {name} with {nodes} nodes: only cells of one order from 1 ({least} nodes) to {MAX_ORDER} are read"
        ));
    }
    Error::malformed(format!("{} nodes for cell {cell}, a {name}", first.nodes), format!("{nodes}"))
}
