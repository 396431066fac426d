//! COMSOL's element types by name. Corners stand first and in tensor order: a quadrilateral's third and fourth corner
//! change places to make a ring.

use std::borrow::Cow;
use std::sync::{Arc, LazyLock};

use crate::mesh::{Class, ElementType, Shape};

static TYPES: LazyLock<[Arc<ElementType>; 16]> = LazyLock::new(|| {
    const QUADRILATERAL: &[u8] = &[0, 1, 3, 2];
    const PYRAMID: &[u8] = &[0, 1, 3, 2, 4];
    const HEXAHEDRON: &[u8] = &[0, 1, 3, 2, 4, 5, 7, 6];
    [
        ElementType::counted("vtx", "point", 1),
        ElementType::counted("vtx2", "point", 1),
        ElementType::counted("edg", "line", 2),
        ElementType::counted("edg2", "line", 3),
        ElementType::measured("tri", Shape::Triangle, 1, 3),
        ElementType::measured("tri2", Shape::Triangle, 2, 6),
        ElementType::permuted("quad", Shape::Quadrilateral, 1, 4, QUADRILATERAL),
        ElementType::permuted("quad2", Shape::Quadrilateral, 2, 9, QUADRILATERAL),
        ElementType::measured("tet", Shape::Tetrahedron, 1, 4),
        ElementType::measured("tet2", Shape::Tetrahedron, 2, 10),
        ElementType::permuted("pyr", Shape::Pyramid, 1, 5, PYRAMID),
        ElementType::permuted("pyr2", Shape::Pyramid, 2, 14, PYRAMID),
        ElementType::measured("prism", Shape::Wedge, 1, 6),
        ElementType::measured("prism2", Shape::Wedge, 2, 18),
        ElementType::permuted("hex", Shape::Hexahedron, 1, 8, HEXAHEDRON),
        ElementType::permuted("hex2", Shape::Hexahedron, 2, 27, HEXAHEDRON),
    ]
    .map(Arc::new)
});

/// The type of that name, if it is known.
pub(super) fn by_name(name: &str) -> Option<&'static Arc<ElementType>> {
    TYPES.iter().find(|kind| kind.name == name)
}

/// Number of dimensions of an element.
pub(super) fn dimension(kind: &ElementType) -> usize {
    match &kind.class {
        Class::Measured { shape, .. } => shape.dimension(),
        Class::Counted(what) => usize::from(what == "line"),
    }
}

/// A type that is not known: counted under its own name.
pub(super) fn unknown(name: String, nodes: usize) -> ElementType {
    let name: Cow<'static, str> = name.into();
    ElementType { name: name.clone(), nodes, class: Class::Counted(name) }
}
