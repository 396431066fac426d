//! Degenerate elements: tetrahedra, pyramids and wedges that are written as bricks, triangles that are written as
//! quadrilaterals, by naming a node more than once. ANSYS and LS-DYNA have no records of their own for them.

use std::borrow::Cow;
use std::sync::{Arc, LazyLock};

use crate::error::{Error, Result};
use crate::formats::ElementSink;
use crate::mesh::{Class, ElementType, IN_ORDER, Shape};

/// What the corners of a record turn out to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Collapsed {
    /// The shape that is left.
    pub shape: Shape,
    corners: [u8; 8],
}

impl Collapsed {
    /// For each corner of the shape, in our order, its place in the record.
    pub fn corners(&self) -> &[u8] {
        &self.corners[..self.shape.corners()]
    }
}

/// The documented patterns, each brick corner by the first one that names the same node; the shape's corners as places
/// in the record.
const DOCUMENTED: [([u8; 8], Shape, [u8; 8]); 5] = [
    // ANSYS: I J K K M N O O.
    ([0, 1, 2, 2, 4, 5, 6, 6], Shape::Wedge, [0, 1, 2, 4, 5, 6, 0, 0]),
    // LS-DYNA: N1 N2 N3 N4 N5 N5 N6 N6.
    ([0, 1, 2, 3, 4, 4, 6, 6], Shape::Wedge, [0, 4, 1, 3, 6, 2, 0, 0]),
    // Both: I J K L M M M M.
    ([0, 1, 2, 3, 4, 4, 4, 4], Shape::Pyramid, [0, 1, 2, 3, 4, 0, 0, 0]),
    // ANSYS: I J K K M M M M.
    ([0, 1, 2, 2, 4, 4, 4, 4], Shape::Tetrahedron, [0, 1, 2, 4, 0, 0, 0, 0]),
    // LS-DYNA: N1 N2 N3 N4 N4 N4 N4 N4.
    ([0, 1, 2, 3, 3, 3, 3, 3], Shape::Tetrahedron, [0, 1, 2, 3, 0, 0, 0, 0]),
];

/// A quarter turn about the third axis, and one about the first: together they make all 24 turns of a brick.
const QUARTER_TURNS: [[u8; 8]; 2] = [[1, 2, 3, 0, 5, 6, 7, 4], [3, 2, 6, 7, 0, 1, 5, 4]];

const BRICK: Collapsed = Collapsed { shape: Shape::Hexahedron, corners: IN_ORDER };

/// The documented patterns, turned in every way that a brick can be numbered; sorted by pattern.
static PATTERNS: LazyLock<Vec<(u32, Collapsed)>> = LazyLock::new(|| {
    let mut turns = vec![IN_ORDER];
    let mut next = 0;
    while let Some(turn) = turns.get(next).copied() {
        next += 1;
        for quarter in QUARTER_TURNS {
            let turned = quarter.map(|k| turn[k as usize]);
            if !turns.contains(&turned) {
                turns.push(turned);
            }
        }
    }
    let mut patterns: Vec<(u32, Collapsed)> = Vec::new();
    // The documented order itself comes first: a pattern may be a turn of several.
    for turn in &turns {
        for (nodes, shape, places) in DOCUMENTED {
            let turned = turn.map(|k| u64::from(nodes[k as usize]));
            let place = |node: u8| turned.iter().position(|n| *n == u64::from(node)).map_or(0, |k| k as u8);
            let corners = places.map(|k| place(nodes[k as usize]));
            let key = pattern(&turned);
            if patterns.iter().all(|(known, _)| *known != key) {
                patterns.push((key, Collapsed { shape, corners }));
            }
        }
    }
    patterns.sort_unstable_by_key(|row| row.0);
    patterns
});

/// Each corner by the first one that names the same node, three bits a corner.
#[inline]
fn pattern(ids: &[u64; 8]) -> u32 {
    let mut key = 0;
    for (k, id) in ids.iter().enumerate() {
        let first = ids[..k].iter().position(|other| other == id).unwrap_or(k);
        key = key << 3 | first as u32;
    }
    key
}

/// What a brick with these corners is. A pattern that is not documented leaves it a hexahedron.
#[inline]
pub fn brick(ids: &[u64; 8]) -> Collapsed {
    const DISTINCT: u32 = 0o01_234_567;
    let key = pattern(ids);
    if key == DISTINCT {
        return BRICK;
    }
    PATTERNS.binary_search_by_key(&key, |row| row.0).map_or(BRICK, |row| PATTERNS[row].1)
}

/// What a quadrilateral with these corners is: a triangle if just two that follow one another are the same node.
#[inline]
pub fn quadrilateral(ids: &[u64; 4]) -> Collapsed {
    let [a, b, c, d] = ids;
    let corners = match (a == b, b == c, c == d, d == a, a == c || b == d) {
        (false, false, true, false, false) | (false, false, false, true, false) => Some([0, 1, 2]),
        (false, true, false, false, false) => Some([0, 1, 3]),
        (true, false, false, false, false) => Some([0, 2, 3]),
        _ => None,
    };
    match corners {
        Some([a, b, c]) => Collapsed { shape: Shape::Triangle, corners: [a, b, c, 0, 0, 0, 0, 0] },
        None => Collapsed { shape: Shape::Quadrilateral, corners: IN_ORDER },
    }
}

/// The types that records of one name turn out to be: `SOLID185`, `SOLID185 (wedge)` and so on.
#[derive(Debug)]
pub struct Variants {
    whole: Arc<ElementType>,
    collapsed: Vec<Arc<ElementType>>,
}

impl Variants {
    /// Those of a brick, its corners first in the record.
    pub fn brick(name: &str, order: u8, nodes: usize) -> Self {
        Self::new(name, order, nodes, Shape::Hexahedron, &[Shape::Wedge, Shape::Pyramid, Shape::Tetrahedron])
    }

    /// Those of a quadrilateral, its corners first in the record.
    pub fn quadrilateral(name: &str, order: u8, nodes: usize) -> Self {
        Self::new(name, order, nodes, Shape::Quadrilateral, &[Shape::Triangle])
    }

    fn new(name: &str, order: u8, nodes: usize, whole: Shape, collapsed: &[Shape]) -> Self {
        let kind = |name: String, shape: Shape| {
            let class = Class::Measured { shape, order, corners: &IN_ORDER[..shape.corners()] };
            Arc::new(ElementType { name: Cow::Owned(name), nodes, class })
        };
        Self {
            whole: kind(name.to_owned(), whole),
            collapsed: collapsed.iter().map(|shape| kind(format!("{name} ({shape})"), *shape)).collect(),
        }
    }

    /// Hands on an element as what it is. Nodes after the corners may be 0, which stands for none.
    #[inline]
    pub fn put(&self, label: u64, ids: &[u64], out: &mut ElementSink<'_>) -> Result<()> {
        let (collapsed, corners) = if let (4, Some(corners)) = (self.corners(), ids.first_chunk::<4>()) {
            (quadrilateral(corners), 4)
        } else if let (8, Some(corners)) = (self.corners(), ids.first_chunk::<8>()) {
            (brick(corners), 8)
        } else {
            return Err(Error::malformed(
                format!("{} nodes or more", self.corners()),
                format!("{}", ids.len()),
            ));
        };
        let is_whole = collapsed.corners().len() == corners;
        if is_whole && ids.len() == corners {
            return out.element(label, &self.whole, ids);
        }
        let mut all: Vec<u64> = collapsed.corners().iter().map(|k| ids[*k as usize]).collect();
        all.extend(ids[corners..].iter().filter(|id| **id != 0));
        let kind = self.collapsed.iter().find(|kind| kind.shape() == Some(collapsed.shape));
        out.element(label, kind.unwrap_or(&self.whole), &all)
    }

    fn corners(&self) -> usize {
        self.whole.shape().map_or(0, Shape::corners)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: [[f64; 3]; 8] = [
        [0., 0., 0.],
        [1., 0., 0.],
        [1., 1., 0.],
        [0., 1., 0.],
        [0., 0., 1.],
        [1., 0., 1.],
        [1., 1., 1.],
        [0., 1., 1.],
    ];

    fn volume(p: [[f64; 3]; 4]) -> f64 {
        let [a, b, c] = [1, 2, 3].map(|k| [0, 1, 2].map(|i| p[k][i] - p[0][i]));
        a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    }

    #[test]
    fn documented_patterns_are_what_they_are() {
        let rows: [([u64; 8], Shape, &[u8]); 9] = [
            ([1, 2, 3, 4, 5, 6, 7, 8], Shape::Hexahedron, &[0, 1, 2, 3, 4, 5, 6, 7]),
            ([1, 2, 3, 3, 5, 6, 7, 7], Shape::Wedge, &[0, 1, 2, 4, 5, 6]),
            ([1, 2, 3, 4, 5, 5, 6, 6], Shape::Wedge, &[0, 4, 1, 3, 6, 2]),
            ([1, 2, 3, 4, 5, 5, 5, 5], Shape::Pyramid, &[0, 1, 2, 3, 4]),
            ([1, 2, 3, 3, 5, 5, 5, 5], Shape::Tetrahedron, &[0, 1, 2, 4]),
            ([1, 2, 3, 4, 4, 4, 4, 4], Shape::Tetrahedron, &[0, 1, 2, 3]),
            // One edge, a body diagonal, all of it: nothing that is documented.
            ([1, 2, 3, 3, 5, 6, 7, 8], Shape::Hexahedron, &[0, 1, 2, 3, 4, 5, 6, 7]),
            ([1, 2, 3, 4, 5, 6, 1, 8], Shape::Hexahedron, &[0, 1, 2, 3, 4, 5, 6, 7]),
            ([9; 8], Shape::Hexahedron, &[0, 1, 2, 3, 4, 5, 6, 7]),
        ];
        for (ids, shape, corners) in rows {
            let found = brick(&ids);
            assert_eq!((found.shape, found.corners()), (shape, corners), "{ids:?}");
        }
        let turned = brick(&[1, 2, 2, 4, 5, 6, 6, 8]);
        assert_eq!(turned.shape, Shape::Wedge, "as HyperMesh writes it");
    }

    #[test]
    fn every_collapse_of_a_sound_brick_is_a_sound_shape() {
        assert_eq!(PATTERNS.len(), 12 + 6 + 24 + 24, "wedges, pyramids, tetrahedra of two kinds");
        for (key, collapsed) in PATTERNS.iter() {
            let first = |k: usize| (key >> (3 * (7 - k)) & 7) as usize;
            let ids: [u64; 8] = std::array::from_fn(|k| first(k) as u64 + 1);
            assert_eq!(brick(&ids), *collapsed);
            let corners: Vec<_> = collapsed.corners().iter().map(|k| *k as usize).collect();
            assert!(corners.iter().all(|k| first(*k) == *k), "each node once");
            // Merged corners stand in the middle of those that were merged, as they would after a collapse.
            let place = |k: usize| {
                let merged: Vec<_> = (0..8).filter(|j| first(*j) == first(k)).collect();
                let n = merged.len() as f64;
                [0, 1, 2].map(|i| merged.iter().map(|j| UNIT[*j][i]).sum::<f64>() / n)
            };
            let p: Vec<_> = corners.iter().map(|k| place(*k)).collect();
            match collapsed.shape {
                Shape::Tetrahedron if corners.len() == 4 => {
                    assert!(volume([p[0], p[1], p[2], p[3]]) > 0.1, "{key:o}");
                }
                Shape::Pyramid => {
                    assert!(volume([p[0], p[1], p[2], p[4]]) > 0.1, "{key:o}");
                    assert!(volume([p[0], p[2], p[3], p[4]]) > 0.1, "{key:o}");
                }
                _ => {
                    assert!(volume([p[0], p[1], p[2], p[3]]) > 0.1, "{key:o}");
                    assert!(volume([p[0], p[1], p[2], p[4]]) > 0.1, "{key:o}");
                    assert!(volume([p[0], p[1], p[2], p[5]]) > 0.1, "{key:o}");
                }
            }
        }
    }

    #[test]
    fn a_quadrilateral_with_a_node_twice_is_a_triangle() {
        for (ids, corners) in [
            ([1, 2, 3, 4], &[0, 1, 2, 3][..]),
            ([1, 2, 3, 3], &[0, 1, 2]),
            ([1, 2, 3, 1], &[0, 1, 2]),
            ([1, 2, 2, 4], &[0, 1, 3]),
            ([1, 1, 3, 4], &[0, 2, 3]),
            ([1, 2, 1, 4], &[0, 1, 2, 3]),
            ([1, 1, 3, 3], &[0, 1, 2, 3]),
            ([1, 1, 1, 4], &[0, 1, 2, 3]),
        ] {
            assert_eq!(quadrilateral(&ids).corners(), corners, "{ids:?}");
        }
    }
}
