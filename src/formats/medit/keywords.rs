//! The keywords whose tables hold elements: `libmeshb7.h`. Corners stand first in every record, in the order that we
//! use.

use std::borrow::Cow;
use std::sync::{Arc, LazyLock};

use crate::mesh::Shape::{self, Hexahedron, Pyramid, Quadrilateral, Tetrahedron, Triangle, Wedge};
use crate::mesh::{Class, ElementType};

/// A keyword with a table of elements.
pub(super) struct Keyword {
    /// As it stands in text.
    pub(super) name: &'static str,
    /// As it stands in binary files.
    code: u32,
    /// The types that its rows may be of, the usual one first: Gmsh writes second order under the names of the first.
    kinds: Vec<Arc<ElementType>>,
}

impl Keyword {
    /// The type of records that list `nodes` nodes.
    pub(super) fn with_nodes(&self, nodes: usize) -> Option<&Arc<ElementType>> {
        self.kinds.iter().find(|kind| kind.nodes == nodes)
    }

    /// The usual type.
    pub(super) fn usual(&self) -> &Arc<ElementType> {
        &self.kinds[0]
    }

    /// Whether records may be of several types.
    pub(super) fn is_ambiguous(&self) -> bool {
        self.kinds.len() > 1
    }

    /// Whether its elements are measured.
    pub(super) fn is_measured(&self) -> bool {
        self.usual().shape().is_some()
    }
}

/// The keyword that text names.
pub(super) fn by_name(name: &[u8]) -> Option<&'static Keyword> {
    let alias = ALIASES.iter().find(|alias| alias.0.as_bytes().eq_ignore_ascii_case(name));
    let name = alias.map_or(name, |alias| alias.1.as_bytes());
    KEYWORDS.iter().find(|keyword| keyword.name.as_bytes().eq_ignore_ascii_case(name))
}

/// Whether a keyword that is not known, in small letters, names elements, by how it begins.
pub(super) fn is_of_elements(name: &[u8]) -> bool {
    const BEGINNINGS: [&str; 7] =
        ["triangles", "quadrilaterals", "tetrahedra", "pyramids", "prisms", "pentahedra", "hexahedra"];
    BEGINNINGS.iter().any(|beginning| name.starts_with(beginning.as_bytes())) && !name.ends_with(b"ordering")
}

/// The type of elements of such a keyword: counted under its name.
pub(super) fn unknown(name: String) -> ElementType {
    let name: Cow<'static, str> = name.into();
    ElementType { name: name.clone(), nodes: 0, class: Class::Counted(name) }
}

/// The keyword of a binary file.
pub(super) fn by_code(code: u32) -> Option<&'static Keyword> {
    KEYWORDS.iter().find(|keyword| keyword.code == code)
}

/// The keyword whose records the code gives an order of their own to: pairs of second and third order.
pub(super) fn ordered_by(code: u32) -> Option<&'static str> {
    const FIRST: u32 = 127;
    const NAMES: [&str; 14] = [
        "EdgesP2",
        "EdgesP3",
        "TrianglesP2",
        "TrianglesP3",
        "QuadrilateralsQ2",
        "QuadrilateralsQ3",
        "TetrahedraP2",
        "TetrahedraP3",
        "PyramidsP2",
        "PyramidsP3",
        "PrismsP2",
        "PrismsP3",
        "HexahedraQ2",
        "HexahedraQ3",
    ];
    NAMES.get(code.checked_sub(FIRST)? as usize).copied()
}

/// A keyword with a row for every polygon or polyhedron, which are counted. A row of headers says where in another table
/// the nodes or faces begin; others leave room for a fixed number.
pub(super) struct Polytopes {
    /// As it stands in text.
    pub(super) name: &'static str,
    code: u32,
    what: &'static str,
    /// Numbers in a row.
    pub(super) width: usize,
}

impl Polytopes {
    /// The type of all its rows.
    pub(super) fn kind(&self) -> ElementType {
        ElementType::counted(self.name, self.what, 0)
    }

    /// The keyword that text names.
    pub(super) fn by_name(name: &[u8]) -> Option<&'static Self> {
        POLYTOPES.iter().find(|keyword| keyword.name.as_bytes().eq_ignore_ascii_case(name))
    }

    /// The keyword of a binary file.
    pub(super) fn by_code(code: u32) -> Option<&'static Self> {
        POLYTOPES.iter().find(|keyword| keyword.code == code)
    }
}

/// Inner polygons are no elements but the faces of polyhedra.
static POLYTOPES: [Polytopes; 3] = [
    Polytopes { name: "Polyhedra", code: 46, what: "polyhedron", width: 33 },
    Polytopes { name: "BoundaryPolygonHeaders", code: 203, what: "polygon", width: 2 },
    Polytopes { name: "PolyhedraHeaders", code: 207, what: "polyhedron", width: 2 },
];

/// Other names of old versions.
const ALIASES: [(&str, &str); 3] =
    [("Pentahedra", "Prisms"), ("QuadrilateralsP2", "QuadrilateralsQ2"), ("HexahedraP2", "HexahedraQ2")];

static KEYWORDS: LazyLock<Vec<Keyword>> = LazyLock::new(|| {
    let mut keywords: Vec<Keyword> = Vec::new();
    for &(code, name, nodes, order, shape) in ROWS {
        let kind = Arc::new(match shape {
            Some(shape) => ElementType::measured(name, shape, order, nodes),
            None => ElementType::counted(name, "line", nodes),
        });
        match keywords.iter_mut().find(|keyword| keyword.code == code) {
            Some(keyword) => keyword.kinds.push(kind),
            None => keywords.push(Keyword { name, code, kinds: vec![kind] }),
        }
    }
    keywords
});

/// Code, name, number of nodes, order, shape.
#[rustfmt::skip]
static ROWS: &[(u32, &str, usize, u8, Option<Shape>)] = &[
    (5, "Edges", 2, 1, None),
    (6, "Triangles", 3, 1, Some(Triangle)),
    (7, "Quadrilaterals", 4, 1, Some(Quadrilateral)),
    (7, "Quadrilaterals", 8, 2, Some(Quadrilateral)),
    (7, "Quadrilaterals", 9, 2, Some(Quadrilateral)),
    (8, "Tetrahedra", 4, 1, Some(Tetrahedron)),
    (9, "Prisms", 6, 1, Some(Wedge)),
    (10, "Hexahedra", 8, 1, Some(Hexahedron)),
    (10, "Hexahedra", 20, 2, Some(Hexahedron)),
    (10, "Hexahedra", 27, 2, Some(Hexahedron)),
    (24, "TrianglesP2", 6, 2, Some(Triangle)),
    (25, "EdgesP2", 3, 2, None),
    (27, "QuadrilateralsQ2", 9, 2, Some(Quadrilateral)),
    (30, "TetrahedraP2", 10, 2, Some(Tetrahedron)),
    (33, "HexahedraQ2", 27, 2, Some(Hexahedron)),
    (49, "Pyramids", 5, 1, Some(Pyramid)),
    (86, "PrismsP2", 18, 2, Some(Wedge)),
    (87, "PyramidsP2", 14, 2, Some(Pyramid)),
    (88, "QuadrilateralsQ3", 16, 3, Some(Quadrilateral)),
    (89, "QuadrilateralsQ4", 25, 4, Some(Quadrilateral)),
    (90, "TrianglesP3", 10, 3, Some(Triangle)),
    (91, "TrianglesP4", 15, 4, Some(Triangle)),
    (92, "EdgesP3", 4, 3, None),
    (93, "EdgesP4", 5, 4, None),
    (96, "TetrahedraP3", 20, 3, Some(Tetrahedron)),
    (97, "TetrahedraP4", 35, 4, Some(Tetrahedron)),
    (98, "HexahedraQ3", 64, 3, Some(Hexahedron)),
    (99, "HexahedraQ4", 125, 4, Some(Hexahedron)),
    (100, "PyramidsP3", 30, 3, Some(Pyramid)),
    (101, "PyramidsP4", 55, 4, Some(Pyramid)),
    (102, "PrismsP3", 40, 3, Some(Wedge)),
    (103, "PrismsP4", 75, 4, Some(Wedge)),
];
