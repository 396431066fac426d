//! XDMF's topologies by name and by code. Corners stand first, as in VTK.

use std::sync::{Arc, LazyLock};

use crate::formats::array::coded::Head;
use crate::mesh::{ElementType, Shape};

/// Code, names, shape, order, nodes.
#[rustfmt::skip]
static MEASURED: &[(u64, &[&str], Shape, u8, usize)] = &[
    (4, &["Triangle"], Shape::Triangle, 1, 3),
    (5, &["Quadrilateral"], Shape::Quadrilateral, 1, 4),
    (6, &["Tetrahedron"], Shape::Tetrahedron, 1, 4),
    (7, &["Pyramid"], Shape::Pyramid, 1, 5),
    (8, &["Wedge"], Shape::Wedge, 1, 6),
    (9, &["Hexahedron"], Shape::Hexahedron, 1, 8),
    (35, &["Quadrilateral_9", "Quad_9"], Shape::Quadrilateral, 2, 9),
    (36, &["Triangle_6", "Tri_6"], Shape::Triangle, 2, 6),
    (37, &["Quadrilateral_8", "Quad_8"], Shape::Quadrilateral, 2, 8),
    (38, &["Tetrahedron_10", "Tet_10"], Shape::Tetrahedron, 2, 10),
    (39, &["Pyramid_13"], Shape::Pyramid, 2, 13),
    (40, &["Wedge_15"], Shape::Wedge, 2, 15),
    (41, &["Wedge_18"], Shape::Wedge, 2, 18),
    (48, &["Hexahedron_20", "Hex_20"], Shape::Hexahedron, 2, 20),
    (49, &["Hexahedron_24", "Hex_24"], Shape::Hexahedron, 2, 24),
    (50, &["Hexahedron_27", "Hex_27"], Shape::Hexahedron, 2, 27),
    (51, &["Hexahedron_64", "Hex_64"], Shape::Hexahedron, 3, 64),
    (52, &["Hexahedron_125", "Hex_125"], Shape::Hexahedron, 4, 125),
    (53, &["Hexahedron_216", "Hex_216"], Shape::Hexahedron, 5, 216),
    (54, &["Hexahedron_343", "Hex_343"], Shape::Hexahedron, 6, 343),
    (55, &["Hexahedron_512", "Hex_512"], Shape::Hexahedron, 7, 512),
    (56, &["Hexahedron_729", "Hex_729"], Shape::Hexahedron, 8, 729),
    (57, &["Hexahedron_1000", "Hex_1000"], Shape::Hexahedron, 9, 1000),
    (58, &["Hexahedron_1331", "Hex_1331"], Shape::Hexahedron, 10, 1331),
];

/// Those of any number of nodes: code, name, what they are.
static ANY: &[(u64, &str, &str)] = &[
    (1, "Polyvertex", "point"),
    (2, "Polyline", "line"),
    (3, "Polygon", "polygon"),
    (16, "Polyhedron", "polyhedron"),
];

static CODES: LazyLock<Vec<(u64, Arc<ElementType>)>> = LazyLock::new(|| {
    let measured = MEASURED.iter().map(|&(code, names, shape, order, nodes)| {
        (code, ElementType::measured(names[0], shape, order, nodes))
    });
    let any = ANY.iter().map(|&(code, name, what)| (code, ElementType::counted(name, what, 0)));
    let edge = [(34, ElementType::counted("Edge_3", "line", 3))];
    measured.chain(any).chain(edge).map(|(code, kind)| (code, Arc::new(kind))).collect()
});

/// The type of that name in small letters; `nodes` is for those that have any number.
pub(super) fn named(name: &str, nodes: usize) -> Option<Arc<ElementType>> {
    let is = |other: &&str| other.eq_ignore_ascii_case(name);
    if let Some(row) = ANY.iter().find(|row| is(&row.1) && row.0 != 16) {
        let nodes = if row.0 == 2 { nodes.max(2) } else { nodes };
        return Some(Arc::new(ElementType { nodes, ..ElementType::counted(row.1, row.2, 0) }));
    }
    let code = match MEASURED.iter().find(|row| row.1.iter().any(is)) {
        Some(row) => row.0,
        None if name == "edge_3" => 34,
        None => return None,
    };
    CODES.iter().find(|row| row.0 == code).map(|row| Arc::clone(&row.1))
}

/// What follows a code among mixed elements.
pub(super) fn head(code: u64) -> Option<Head> {
    let (_, kind) = CODES.iter().find(|row| row.0 == code)?;
    Some(match code {
        1..=3 => Head::Counted(kind),
        16 => Head::Faces(kind),
        _ => Head::Fixed(kind),
    })
}
