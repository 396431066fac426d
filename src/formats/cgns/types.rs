//! CGNS's element types by their codes. Corners stand first.

use std::sync::{Arc, LazyLock};

use crate::formats::array::coded::Head;
use crate::formats::array::structured::Kinds;
use crate::mesh::{ElementType, Shape};

/// Elements of several types, each with its code.
pub(super) const MIXED: i64 = 20;
/// Polygons: faces of polyhedra.
pub(super) const NGON: i64 = 22;
/// Polyhedra: lists of polygons.
pub(super) const NFACE: i64 = 23;

#[rustfmt::skip]
static MEASURED: &[(u64, &str, Shape, u8, usize)] = &[
    (5, "TRI_3", Shape::Triangle, 1, 3), (6, "TRI_6", Shape::Triangle, 2, 6),
    (25, "TRI_9", Shape::Triangle, 3, 9), (26, "TRI_10", Shape::Triangle, 3, 10),
    (41, "TRI_12", Shape::Triangle, 4, 12), (42, "TRI_15", Shape::Triangle, 4, 15),
    (7, "QUAD_4", Shape::Quadrilateral, 1, 4), (8, "QUAD_8", Shape::Quadrilateral, 2, 8),
    (9, "QUAD_9", Shape::Quadrilateral, 2, 9), (27, "QUAD_12", Shape::Quadrilateral, 3, 12),
    (28, "QUAD_16", Shape::Quadrilateral, 3, 16), (43, "QUAD_P4_16", Shape::Quadrilateral, 4, 16),
    (44, "QUAD_25", Shape::Quadrilateral, 4, 25),
    (10, "TETRA_4", Shape::Tetrahedron, 1, 4), (11, "TETRA_10", Shape::Tetrahedron, 2, 10),
    (29, "TETRA_16", Shape::Tetrahedron, 3, 16), (30, "TETRA_20", Shape::Tetrahedron, 3, 20),
    (45, "TETRA_22", Shape::Tetrahedron, 4, 22), (46, "TETRA_34", Shape::Tetrahedron, 4, 34),
    (47, "TETRA_35", Shape::Tetrahedron, 4, 35),
    (12, "PYRA_5", Shape::Pyramid, 1, 5), (21, "PYRA_13", Shape::Pyramid, 2, 13),
    (13, "PYRA_14", Shape::Pyramid, 2, 14), (31, "PYRA_21", Shape::Pyramid, 3, 21),
    (32, "PYRA_29", Shape::Pyramid, 3, 29), (33, "PYRA_30", Shape::Pyramid, 3, 30),
    (48, "PYRA_P4_29", Shape::Pyramid, 4, 29), (49, "PYRA_50", Shape::Pyramid, 4, 50),
    (50, "PYRA_55", Shape::Pyramid, 4, 55),
    (14, "PENTA_6", Shape::Wedge, 1, 6), (15, "PENTA_15", Shape::Wedge, 2, 15),
    (16, "PENTA_18", Shape::Wedge, 2, 18), (34, "PENTA_24", Shape::Wedge, 3, 24),
    (35, "PENTA_38", Shape::Wedge, 3, 38), (36, "PENTA_40", Shape::Wedge, 3, 40),
    (51, "PENTA_33", Shape::Wedge, 4, 33), (52, "PENTA_66", Shape::Wedge, 4, 66),
    (53, "PENTA_75", Shape::Wedge, 4, 75),
    (17, "HEXA_8", Shape::Hexahedron, 1, 8), (18, "HEXA_20", Shape::Hexahedron, 2, 20),
    (19, "HEXA_27", Shape::Hexahedron, 2, 27), (37, "HEXA_32", Shape::Hexahedron, 3, 32),
    (38, "HEXA_56", Shape::Hexahedron, 3, 56), (39, "HEXA_64", Shape::Hexahedron, 3, 64),
    (54, "HEXA_44", Shape::Hexahedron, 4, 44), (55, "HEXA_98", Shape::Hexahedron, 4, 98),
    (56, "HEXA_125", Shape::Hexahedron, 4, 125),
];

#[rustfmt::skip]
static COUNTED: &[(u64, &str, &str, usize)] = &[
    (2, "NODE", "point", 1), (3, "BAR_2", "line", 2), (4, "BAR_3", "line", 3), (24, "BAR_4", "line", 4),
    (40, "BAR_5", "line", 5),
];

static TYPES: LazyLock<Vec<Option<Arc<ElementType>>>> = LazyLock::new(|| {
    let mut types = Vec::new();
    types.resize_with(57, || None);
    for &(code, name, shape, order, nodes) in MEASURED {
        types[code as usize] = Some(Arc::new(ElementType::measured(name, shape, order, nodes)));
    }
    for &(code, name, what, nodes) in COUNTED {
        types[code as usize] = Some(Arc::new(ElementType::counted(name, what, nodes)));
    }
    types
});

static POLYGON: LazyLock<Arc<ElementType>> =
    LazyLock::new(|| Arc::new(ElementType::counted("NGON_n", "polygon", 0)));
static POLYHEDRON: LazyLock<Arc<ElementType>> =
    LazyLock::new(|| Arc::new(ElementType::counted("NFACE_n", "polyhedron", 0)));

static STRUCTURED: LazyLock<Kinds> = LazyLock::new(|| Kinds {
    line: Arc::new(ElementType::counted("structured BAR_2", "line", 2)),
    quadrilateral: Arc::new(ElementType::measured("structured QUAD_4", Shape::Quadrilateral, 1, 4)),
    hexahedron: Arc::new(ElementType::measured("structured HEXA_8", Shape::Hexahedron, 1, 8)),
});

/// The types of cells of structured zones.
pub(super) fn structured() -> &'static Kinds {
    &STRUCTURED
}

/// The type with that code whose elements all have as many nodes.
pub(super) fn find(code: u64) -> Option<&'static Arc<ElementType>> {
    TYPES.get(usize::try_from(code).ok()?)?.as_ref()
}

/// What follows a code among mixed elements.
pub(super) fn head(code: u64) -> Option<Head> {
    find(code).map(Head::Fixed)
}

/// The type of faces that are polygons.
pub(super) fn polygon() -> &'static Arc<ElementType> {
    &POLYGON
}

/// The type of polyhedra.
pub(super) fn polyhedron() -> &'static Arc<ElementType> {
    &POLYHEDRON
}
