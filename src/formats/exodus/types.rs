//! Exodus names types in free words: `HEX`, `hex8`, `HEX27`, `SHELL4`. The word and the number of nodes tell what is meant.

use std::borrow::Cow;
use std::sync::Arc;

use crate::mesh::{Class, ElementType, IN_ORDER, Shape};

/// Words, their shape, and the numbers of nodes of first and of second order.
type Row = (&'static [&'static str], Shape, &'static [usize], &'static [usize]);

#[rustfmt::skip]
static MEASURED: &[Row] = &[
    (&["TRI", "TRIANGLE", "TRISHELL"], Shape::Triangle, &[3], &[4, 6, 7]),
    (&["QUAD", "QUADRILATERAL", "SHELL"], Shape::Quadrilateral, &[4], &[5, 8, 9]),
    (&["SHELL"], Shape::Triangle, &[3], &[6, 7]),
    (&["TET", "TETRA", "TETRAHEDRON"], Shape::Tetrahedron, &[4], &[8, 10, 11, 14, 15]),
    (&["PYR", "PYRA", "PYRAMID"], Shape::Pyramid, &[5], &[13, 14, 18, 19]),
    (&["WED", "WEDGE", "PRISM"], Shape::Wedge, &[6], &[12, 15, 16, 18, 20, 21]),
    (&["HEX", "HEXA", "HEXAHEDRON"], Shape::Hexahedron, &[8], &[9, 20, 21, 27]),
];

#[rustfmt::skip]
static COUNTED: &[(&[&str], &str)] = &[
    (&["BAR", "BEAM", "EDGE", "LINE", "ROD", "TRUSS", "SPRING"], "line"),
    (&["SPHERE", "CIRCLE", "POINT", "PARTICLE", "NODE", "MASS"], "point"),
];

/// The type of a block that is called `text` and whose elements have so many nodes, in a mesh of so many axes.
pub(super) fn of_block(text: &str, nodes: usize, axes: usize) -> Arc<ElementType> {
    let word = word(text);
    let is = |words: &[&str]| words.contains(&word.as_str());
    let order = |row: &Row| match () {
        () if row.2.contains(&nodes) => Some(1),
        () if row.3.contains(&nodes) => Some(2),
        () => None,
    };
    // In the plane a shell is a line.
    let is_line = word.contains("SHELL") && (axes < 3 || nodes < 3);
    let measured = MEASURED.iter().filter(|row| is(row.0) && !is_line);
    let class = match measured.filter_map(|row| Some((row.1, order(row)?))).next() {
        Some((shape, order)) => {
            Class::Measured { shape, order, corners: IN_ORDER.split_at(shape.corners()).0 }
        }
        None => {
            let what =
                if is_line { Some("line") } else { COUNTED.iter().find(|row| is(row.0)).map(|row| row.1) };
            Class::Counted(what.map_or_else(|| unknown(text, nodes), Cow::Borrowed))
        }
    };
    Arc::new(ElementType { name: text.to_owned().into(), nodes, class })
}

/// The type of a block of polygons or polyhedra.
pub(super) fn of_lists(text: &str) -> Arc<ElementType> {
    let what = match word(text).as_str() {
        "NSIDED" => "polygon".into(),
        "NFACED" => "polyhedron".into(),
        _ => text.to_owned().into(),
    };
    Arc::new(ElementType { name: text.to_owned().into(), nodes: 0, class: Class::Counted(what) })
}

/// The letters before any digit, as capitals.
fn word(text: &str) -> String {
    text.chars().take_while(|letter| letter.is_alphabetic()).flat_map(char::to_uppercase).collect()
}

/// A type that is not known by this word, or not with so many nodes.
fn unknown(text: &str, nodes: usize) -> Cow<'static, str> {
    format!("{text} of {nodes} nodes").into()
}
