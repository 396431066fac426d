//! MED's element types by name. Corners stand first.

use std::borrow::Cow;
use std::sync::{Arc, LazyLock};

use crate::mesh::{Class, ElementType, Shape};

static TYPES: LazyLock<[Arc<ElementType>; 21]> = LazyLock::new(|| {
    [
        ElementType::counted("PO1", "point", 1),
        ElementType::counted("SE2", "line", 2),
        ElementType::counted("SE3", "line", 3),
        ElementType::counted("SE4", "line", 4),
        ElementType::measured("TR3", Shape::Triangle, 1, 3),
        ElementType::measured("TR6", Shape::Triangle, 2, 6),
        ElementType::measured("TR7", Shape::Triangle, 2, 7),
        ElementType::measured("QU4", Shape::Quadrilateral, 1, 4),
        ElementType::measured("QU8", Shape::Quadrilateral, 2, 8),
        ElementType::measured("QU9", Shape::Quadrilateral, 2, 9),
        ElementType::measured("TE4", Shape::Tetrahedron, 1, 4),
        ElementType::measured("T10", Shape::Tetrahedron, 2, 10),
        ElementType::measured("PY5", Shape::Pyramid, 1, 5),
        ElementType::measured("P13", Shape::Pyramid, 2, 13),
        ElementType::measured("PE6", Shape::Wedge, 1, 6),
        ElementType::measured("P15", Shape::Wedge, 2, 15),
        ElementType::measured("P18", Shape::Wedge, 2, 18),
        ElementType::measured("HE8", Shape::Hexahedron, 1, 8),
        ElementType::measured("H20", Shape::Hexahedron, 2, 20),
        ElementType::measured("H27", Shape::Hexahedron, 2, 27),
        // A prism over a hexagon.
        ElementType::counted("OCT", "polyhedron", 12),
    ]
    .map(Arc::new)
});

/// The type of that name whose elements all have as many nodes.
pub(super) fn find(name: &str) -> Option<&'static Arc<ElementType>> {
    TYPES.iter().find(|kind| kind.name == name)
}

/// A type whose elements have any number of nodes, or that is not known; it is counted.
pub(super) fn of_lists(name: &str) -> ElementType {
    let what: Cow<'static, str> = match name {
        "POG" | "PO2" => "polygon".into(),
        "POE" => "polyhedron".into(),
        _ => name.to_owned().into(),
    };
    ElementType { name: name.to_owned().into(), nodes: 0, class: Class::Counted(what) }
}
