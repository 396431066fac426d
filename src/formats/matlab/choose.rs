//! Which matrices are the mesh: by name, then by size. Where two sets would do, nobody guesses.

use std::sync::{Arc, LazyLock};

use super::contents::Contents;
use super::store::{Matrix, Records};
use crate::error::{Error, Result};
use crate::mesh::{ElementType, Shape};

/// Names of points, in small letters.
const POINTS: &[&str] = &["p", "nodes", "node", "points", "coordinates", "coords", "vertices", "xy", "xyz"];
/// Names of elements, in small letters.
#[rustfmt::skip]
const ELEMENTS: &[&str] = &[
    "t", "elements", "element", "elem", "elems", "tri", "triangles", "tet", "tets", "tetrahedra", "conn",
    "connectivity", "connectivitylist",
];
/// The name of the edges of a mesh of the PDE toolbox.
const EDGES: &str = "e";

/// Whether a matrix of this name may be of a mesh.
pub(super) fn may_be_of_mesh(name: &str) -> bool {
    is_one_of(name, POINTS) || is_one_of(name, ELEMENTS) || name == EDGES
}

fn is_one_of(name: &str, names: &[&str]) -> bool {
    names.iter().any(|known| known.eq_ignore_ascii_case(name))
}

/// The mesh.
#[derive(Debug)]
pub(super) struct Choice {
    pub(super) points: Records,
    pub(super) groups: Vec<Group>,
    /// Number of edges of the boundary.
    pub(super) edges: Option<u64>,
}

/// Elements of one type.
#[derive(Debug)]
pub(super) struct Group {
    pub(super) records: Records,
    pub(super) kind: Arc<ElementType>,
}

/// Finds the mesh.
pub(super) fn choose(contents: Contents) -> Result<Choice> {
    let named = |names: &'static [&'static str]| {
        contents.matrices.iter().filter(move |matrix| is_one_of(matrix.leaf(), names))
    };
    let points: Vec<_> = named(POINTS).filter_map(points).collect();
    let [points] = &points[..] else {
        let what = "one matrix of points (p, Nodes): 2 or 3 coordinates of 3 points or more";
        return Err(unclear(what, points.iter().map(|records| &records.matrix), &contents));
    };
    let dimension = points.width();
    let candidates: Vec<_> = named(ELEMENTS).filter(|matrix| !widths(matrix, points).is_empty()).collect();
    let what = format!("one matrix of elements (t, Elements) for points of {dimension} coordinates");
    let Some(first) = candidates.first() else { return Err(unclear(&what, [].into_iter(), &contents)) };
    // The groups of a cell array are one set.
    if candidates.iter().any(|other| family(&other.path) != family(&first.path)) {
        return Err(unclear(&what, candidates.into_iter(), &contents));
    }
    let is_second_order = candidates.len() > 1
        && candidates.iter().any(|matrix| widths(matrix, points).iter().any(|(width, _)| *width == 6));
    let mut groups = Vec::new();
    for matrix in candidates {
        let [(width, in_rows)] = widths(matrix, points)[..] else {
            return Err(unclear(&what, [matrix].into_iter(), &contents));
        };
        let kind = match width {
            // Beside triangles of six nodes, three nodes are one of their edges.
            3 if is_second_order && dimension == 2 => &KINDS.line_3,
            width => kind(matrix.leaf(), dimension, width).unwrap_or(&KINDS.line),
        };
        let records = Records { matrix: matrix.clone(), in_rows };
        groups.push(Group { records, kind: Arc::clone(kind) });
    }
    let edges = contents.matrices.iter().find(|matrix| matrix.leaf() == EDGES);
    let edges = edges.and_then(|matrix| match (matrix.rows, matrix.columns) {
        (7, count) | (count, 7) => Some(count),
        _ => None,
    });
    Ok(Choice { points: points.clone(), groups, edges })
}

/// A matrix as points, if it can be that.
fn points(matrix: &Matrix) -> Option<Records> {
    let fits = |width: u64, count: u64| (2..=3).contains(&width) && count >= 3;
    let in_rows = match (fits(matrix.rows, matrix.columns), fits(matrix.columns, matrix.rows)) {
        (true, false) => false,
        (false, true) => true,
        // Of three points with three coordinates the toolbox's own way is taken.
        (true, true) => false,
        (false, false) => return None,
    };
    Some(Records { matrix: matrix.clone(), in_rows })
}

/// How a matrix can be read as elements: numbers of a record, and whether records stand in rows. Where both ways would
/// do, the points' way is taken.
fn widths(matrix: &Matrix, points: &Records) -> Vec<(u64, bool)> {
    let fits = |width: u64, count: u64| count > 0 && kind(matrix.leaf(), points.width(), width).is_some();
    let ways = [(matrix.rows, matrix.columns, false), (matrix.columns, matrix.rows, true)];
    let mut found: Vec<_> =
        ways.into_iter().filter(|way| fits(way.0, way.1)).map(|way| (way.0, way.2)).collect();
    if found.len() == 2 {
        found.retain(|way| way.1 == points.in_rows);
    }
    found
}

/// A name without the numbers of cells and entries.
fn family(path: &str) -> String {
    let mut depth = 0;
    path.chars()
        .filter(|letter| {
            depth += i32::from(matches!(letter, '{' | '('));
            let outside = depth == 0;
            depth -= i32::from(matches!(letter, '}' | ')'));
            outside
        })
        .collect()
}

/// The types.
struct Kinds {
    line: Arc<ElementType>,
    line_3: Arc<ElementType>,
    triangle: Arc<ElementType>,
    triangle_6: Arc<ElementType>,
    quadrilateral: Arc<ElementType>,
    tetrahedron: Arc<ElementType>,
    tetrahedron_10: Arc<ElementType>,
}

static KINDS: LazyLock<Kinds> = LazyLock::new(|| Kinds {
    line: Arc::new(ElementType::counted("edge", "line", 2)),
    line_3: Arc::new(ElementType::counted("edge of 3 nodes", "line", 3)),
    triangle: Arc::new(ElementType::measured("triangle", Shape::Triangle, 1, 3)),
    triangle_6: Arc::new(ElementType::measured("triangle of 6 nodes", Shape::Triangle, 2, 6)),
    quadrilateral: Arc::new(ElementType::measured("quadrilateral", Shape::Quadrilateral, 1, 4)),
    tetrahedron: Arc::new(ElementType::measured("tetrahedron", Shape::Tetrahedron, 1, 4)),
    tetrahedron_10: Arc::new(ElementType::measured("tetrahedron of 10 nodes", Shape::Tetrahedron, 2, 10)),
});

/// The type of edges.
pub(super) fn line() -> &'static ElementType {
    &KINDS.line
}

/// The type of elements whose records have so many numbers. In the toolbox's own `t` a subdomain follows the nodes.
fn kind(name: &str, dimension: usize, width: u64) -> Option<&'static Arc<ElementType>> {
    let is_toolbox = name == "t";
    let is_triangle = name.to_ascii_lowercase().starts_with("tri");
    match (dimension, width) {
        (_, 3) => Some(&KINDS.triangle),
        (_, 6) => Some(&KINDS.triangle_6),
        (2, 4) if is_toolbox => Some(&KINDS.triangle),
        (2, 7) if is_toolbox => Some(&KINDS.triangle_6),
        (2, 4) if !is_triangle => Some(&KINDS.quadrilateral),
        (3, 4) if !is_triangle => Some(&KINDS.tetrahedron),
        (3, 10) if !is_triangle => Some(&KINDS.tetrahedron_10),
        (3, 5) if is_toolbox => Some(&KINDS.tetrahedron),
        (3, 11) if is_toolbox => Some(&KINDS.tetrahedron_10),
        _ => None,
    }
}

/// The error of a file in which no mesh is found, or several are; it lists what is there.
fn unclear<'m>(what: &str, fitting: impl Iterator<Item = &'m Matrix>, contents: &Contents) -> Error {
    const MOST: usize = 10;
    let mut fitting: Vec<_> = fitting.take(MOST).map(Matrix::describe).collect();
    let found = if fitting.is_empty() {
        fitting.extend(contents.matrices.iter().take(MOST).map(Matrix::describe));
        fitting.extend(contents.others.iter().take(MOST).cloned());
        if fitting.is_empty() { "no variable".into() } else { format!("none among {}", fitting.join(", ")) }
    } else {
        fitting.join(", ")
    };
    Error::malformed(what, found)
}
