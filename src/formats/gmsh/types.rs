//! The element types of Gmsh by number: `GmshDefines.h`, with the names that Gmsh prints. Corners stand first in every
//! record, in the order that we use; the nodes of edges, faces and insides follow.

use std::sync::{Arc, LazyLock};

use crate::error::{Error, Result};
use crate::mesh::ElementType;
use crate::mesh::Shape::{self, Hexahedron, Pyramid, Quadrilateral, Tetrahedron, Triangle, Wedge};

/// The type with the number `number`. A type of no nodes has a number of its own in each record.
#[inline]
pub(super) fn by_number(number: u64) -> Result<&'static Arc<ElementType>> {
    match TYPES.get(number as usize) {
        Some(Some(kind)) => Ok(kind),
        _ => Err(Error::malformed("the number of an element type of Gmsh (1 to 140)", format!("{number}"))),
    }
}

/// The number of a type.
pub(super) fn number_of(kind: &Arc<ElementType>) -> Option<u64> {
    TYPES
        .iter()
        .position(|known| known.as_ref().is_some_and(|known| Arc::ptr_eq(known, kind)))
        .map(|n| n as u64)
}

static TYPES: LazyLock<Vec<Option<Arc<ElementType>>>> = LazyLock::new(|| {
    let most = ROWS.iter().map(|row| row.0).max().unwrap_or(0);
    let mut types = vec![None; most + 1];
    for (number, kind) in ROWS {
        types[*number] = Some(Arc::new(kind.clone()));
    }
    types
});

const fn measured(
    number: usize,
    name: &'static str,
    shape: Shape,
    order: u8,
    nodes: usize,
) -> (usize, ElementType) {
    (number, ElementType::measured(name, shape, order, nodes))
}

const fn counted(
    number: usize,
    name: &'static str,
    what: &'static str,
    nodes: usize,
) -> (usize, ElementType) {
    (number, ElementType::counted(name, what, nodes))
}

/// Number, name, shape, order and number of nodes. Elements of order 0 have one node, in the middle.
static ROWS: &[(usize, ElementType)] = &[
    counted(1, "Line 2", "line", 2),
    measured(2, "Triangle 3", Triangle, 1, 3),
    measured(3, "Quadrilateral 4", Quadrilateral, 1, 4),
    measured(4, "Tetrahedron 4", Tetrahedron, 1, 4),
    measured(5, "Hexahedron 8", Hexahedron, 1, 8),
    measured(6, "Prism 6", Wedge, 1, 6),
    measured(7, "Pyramid 5", Pyramid, 1, 5),
    counted(8, "Line 3", "line", 3),
    measured(9, "Triangle 6", Triangle, 2, 6),
    measured(10, "Quadrilateral 9", Quadrilateral, 2, 9),
    measured(11, "Tetrahedron 10", Tetrahedron, 2, 10),
    measured(12, "Hexahedron 27", Hexahedron, 2, 27),
    measured(13, "Prism 18", Wedge, 2, 18),
    measured(14, "Pyramid 14", Pyramid, 2, 14),
    counted(15, "Point", "point", 1),
    measured(16, "Quadrilateral 8", Quadrilateral, 2, 8),
    measured(17, "Hexahedron 20", Hexahedron, 2, 20),
    measured(18, "Prism 15", Wedge, 2, 15),
    measured(19, "Pyramid 13", Pyramid, 2, 13),
    measured(20, "Triangle 9", Triangle, 3, 9),
    measured(21, "Triangle 10", Triangle, 3, 10),
    measured(22, "Triangle 12", Triangle, 4, 12),
    measured(23, "Triangle 15", Triangle, 4, 15),
    measured(24, "Triangle 15I", Triangle, 5, 15),
    measured(25, "Triangle 21", Triangle, 5, 21),
    counted(26, "Line 4", "line", 4),
    counted(27, "Line 5", "line", 5),
    counted(28, "Line 6", "line", 6),
    measured(29, "Tetrahedron 20", Tetrahedron, 3, 20),
    measured(30, "Tetrahedron 35", Tetrahedron, 4, 35),
    measured(31, "Tetrahedron 56", Tetrahedron, 5, 56),
    measured(32, "Tetrahedron 22", Tetrahedron, 4, 22),
    measured(33, "Tetrahedron 28", Tetrahedron, 5, 28),
    counted(34, "Polygon", "polygon", 0),
    counted(35, "Polyhedron", "polyhedron", 0),
    measured(36, "Quadrilateral 16", Quadrilateral, 3, 16),
    measured(37, "Quadrilateral 25", Quadrilateral, 4, 25),
    measured(38, "Quadrilateral 36", Quadrilateral, 5, 36),
    measured(39, "Quadrilateral 12", Quadrilateral, 3, 12),
    measured(40, "Quadrilateral 16I", Quadrilateral, 4, 16),
    measured(41, "Quadrilateral 20", Quadrilateral, 5, 20),
    measured(42, "Triangle 28", Triangle, 6, 28),
    measured(43, "Triangle 36", Triangle, 7, 36),
    measured(44, "Triangle 45", Triangle, 8, 45),
    measured(45, "Triangle 55", Triangle, 9, 55),
    measured(46, "Triangle 66", Triangle, 10, 66),
    measured(47, "Quadrilateral 49", Quadrilateral, 6, 49),
    measured(48, "Quadrilateral 64", Quadrilateral, 7, 64),
    measured(49, "Quadrilateral 81", Quadrilateral, 8, 81),
    measured(50, "Quadrilateral 100", Quadrilateral, 9, 100),
    measured(51, "Quadrilateral 121", Quadrilateral, 10, 121),
    measured(52, "Triangle 18", Triangle, 6, 18),
    measured(53, "Triangle 21I", Triangle, 7, 21),
    measured(54, "Triangle 24", Triangle, 8, 24),
    measured(55, "Triangle 27", Triangle, 9, 27),
    measured(56, "Triangle 30", Triangle, 10, 30),
    measured(57, "Quadrilateral 24", Quadrilateral, 6, 24),
    measured(58, "Quadrilateral 28", Quadrilateral, 7, 28),
    measured(59, "Quadrilateral 32", Quadrilateral, 8, 32),
    measured(60, "Quadrilateral 36I", Quadrilateral, 9, 36),
    measured(61, "Quadrilateral 40", Quadrilateral, 10, 40),
    counted(62, "Line 7", "line", 7),
    counted(63, "Line 8", "line", 8),
    counted(64, "Line 9", "line", 9),
    counted(65, "Line 10", "line", 10),
    counted(66, "Line 11", "line", 11),
    counted(67, "Line Border", "line", 2),
    measured(68, "Triangle Border", Triangle, 1, 3),
    counted(69, "Polygon Border", "polygon", 0),
    counted(70, "Line Child", "line", 2),
    measured(71, "Tetrahedron 84", Tetrahedron, 6, 84),
    measured(72, "Tetrahedron 120", Tetrahedron, 7, 120),
    measured(73, "Tetrahedron 165", Tetrahedron, 8, 165),
    measured(74, "Tetrahedron 220", Tetrahedron, 9, 220),
    measured(75, "Tetrahedron 286", Tetrahedron, 10, 286),
    measured(79, "Tetrahedron 34", Tetrahedron, 6, 34),
    measured(80, "Tetrahedron 40", Tetrahedron, 7, 40),
    measured(81, "Tetrahedron 46", Tetrahedron, 8, 46),
    measured(82, "Tetrahedron 52", Tetrahedron, 9, 52),
    measured(83, "Tetrahedron 58", Tetrahedron, 10, 58),
    counted(84, "Line 1", "line", 1),
    counted(85, "Triangle 1", "element of order 0", 1),
    counted(86, "Quadrilateral 1", "element of order 0", 1),
    counted(87, "Tetrahedron 1", "element of order 0", 1),
    counted(88, "Hexahedron 1", "element of order 0", 1),
    counted(89, "Prism 1", "element of order 0", 1),
    measured(90, "Prism 40", Wedge, 3, 40),
    measured(91, "Prism 75", Wedge, 4, 75),
    measured(92, "Hexahedron 64", Hexahedron, 3, 64),
    measured(93, "Hexahedron 125", Hexahedron, 4, 125),
    measured(94, "Hexahedron 216", Hexahedron, 5, 216),
    measured(95, "Hexahedron 343", Hexahedron, 6, 343),
    measured(96, "Hexahedron 512", Hexahedron, 7, 512),
    measured(97, "Hexahedron 729", Hexahedron, 8, 729),
    measured(98, "Hexahedron 1000", Hexahedron, 9, 1000),
    measured(99, "Hexahedron 32", Hexahedron, 3, 32),
    measured(100, "Hexahedron 44", Hexahedron, 4, 44),
    measured(101, "Hexahedron 56", Hexahedron, 5, 56),
    measured(102, "Hexahedron 68", Hexahedron, 6, 68),
    measured(103, "Hexahedron 80", Hexahedron, 7, 80),
    measured(104, "Hexahedron 92", Hexahedron, 8, 92),
    measured(105, "Hexahedron 104", Hexahedron, 9, 104),
    measured(106, "Prism 126", Wedge, 5, 126),
    measured(107, "Prism 196", Wedge, 6, 196),
    measured(108, "Prism 288", Wedge, 7, 288),
    measured(109, "Prism 405", Wedge, 8, 405),
    measured(110, "Prism 550", Wedge, 9, 550),
    measured(111, "Prism 24", Wedge, 3, 24),
    measured(112, "Prism 33", Wedge, 4, 33),
    measured(113, "Prism 42", Wedge, 5, 42),
    measured(114, "Prism 51", Wedge, 6, 51),
    measured(115, "Prism 60", Wedge, 7, 60),
    measured(116, "Prism 69", Wedge, 8, 69),
    measured(117, "Prism 78", Wedge, 9, 78),
    measured(118, "Pyramid 30", Pyramid, 3, 30),
    measured(119, "Pyramid 55", Pyramid, 4, 55),
    measured(120, "Pyramid 91", Pyramid, 5, 91),
    measured(121, "Pyramid 140", Pyramid, 6, 140),
    measured(122, "Pyramid 204", Pyramid, 7, 204),
    measured(123, "Pyramid 285", Pyramid, 8, 285),
    measured(124, "Pyramid 385", Pyramid, 9, 385),
    measured(125, "Pyramid 21", Pyramid, 3, 21),
    measured(126, "Pyramid 29", Pyramid, 4, 29),
    measured(127, "Pyramid 37", Pyramid, 5, 37),
    measured(128, "Pyramid 45", Pyramid, 6, 45),
    measured(129, "Pyramid 53", Pyramid, 7, 53),
    measured(130, "Pyramid 61", Pyramid, 8, 61),
    measured(131, "Pyramid 69", Pyramid, 9, 69),
    counted(132, "Pyramid 1", "element of order 0", 1),
    counted(133, "Point Xfem", "xfem part", 1),
    counted(134, "Line Xfem", "xfem part", 2),
    counted(135, "Triangle Xfem", "xfem part", 3),
    counted(136, "Tetrahedron Xfem", "xfem part", 4),
    measured(137, "Tetrahedron 16", Tetrahedron, 3, 16),
    counted(140, "Trihedron 4", "trihedron", 4),
];
