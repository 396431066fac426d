//! What a mesh holds, in words that tests compare.

use super::reading::Mesh;
use crate::mesh::Shape;

/// Nodes and elements by type, as `8 nodes, C3D8:1 line:2`.
pub(crate) fn holds(mesh: &Mesh) -> String {
    let mut types: Vec<_> = mesh.ledger.types.iter().map(|t| format!("{}:{}", t.name, t.count)).collect();
    types.sort();
    format!("{} nodes, {}", mesh.nodes.count(), types.join(" "))
}

/// Corners of the elements of each shape, in an order of their own.
pub(crate) fn corners(mesh: &Mesh) -> Vec<(Shape, String)> {
    let rounded = |p: &[f64; 3]| format!("{:.6} {:.6} {:.6}", p[0] + 0.0, p[1] + 0.0, p[2] + 0.0);
    let all = mesh.elements.iter();
    let mut corners: Vec<_> =
        all.map(|(_, shape, p)| (*shape, p.iter().map(rounded).collect::<Vec<_>>().join(", "))).collect();
    corners.sort();
    corners
}
