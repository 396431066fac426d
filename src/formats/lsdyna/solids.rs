//! Elements by the nodes that their cards name.

use std::sync::{Arc, LazyLock};

use super::cards::Cards;
use crate::error::{Error, Result};
use crate::formats::ElementSink;
use crate::formats::degenerate::Variants;
use crate::mesh::{ElementType, Shape};

struct Types {
    brick: Variants,
    brick20: Variants,
    thick: Variants,
    shell: Variants,
    shell8: Variants,
    tetrahedron: Arc<ElementType>,
    tetrahedron10: Arc<ElementType>,
    wedge: Arc<ElementType>,
}

static TYPES: LazyLock<Types> = LazyLock::new(|| Types {
    brick: Variants::brick("ELEMENT_SOLID", 1, 8),
    brick20: Variants::brick("ELEMENT_SOLID_H20", 2, 20),
    thick: Variants::brick("ELEMENT_TSHELL", 1, 8),
    shell: Variants::quadrilateral("ELEMENT_SHELL", 1, 4),
    shell8: Variants::quadrilateral("ELEMENT_SHELL of 8 nodes", 2, 8),
    tetrahedron: Arc::new(ElementType::measured("ELEMENT_SOLID (tetrahedron)", Shape::Tetrahedron, 1, 4)),
    tetrahedron10: Arc::new(ElementType::measured("ELEMENT_SOLID of 10 nodes", Shape::Tetrahedron, 2, 10)),
    wedge: Arc::new(ElementType::measured("ELEMENT_SOLID (wedge)", Shape::Wedge, 1, 6)),
});

/// Hands on the element with these nodes; those at the end that are 0 stand for none.
#[inline]
pub(super) fn put(
    cards: &Cards,
    label: u64,
    ids: &mut Vec<u64>,
    by_gmsh: bool,
    out: &mut ElementSink<'_>,
) -> Result<()> {
    let nodes = ids.iter().rposition(|id| *id != 0).map_or(0, |last| last + 1);
    ids.truncate(nodes);
    let types = &*TYPES;
    match (cards, nodes) {
        (Cards::Shell { .. }, 3 | 4) => {
            // A triangle names its third node twice, or leaves the fourth out.
            if nodes == 3 {
                ids.push(ids[2]);
            }
            types.shell.put(label, ids, out)
        }
        (Cards::Shell { .. }, 5..=8) => {
            if ids[3] == 0 {
                ids[3] = ids[2];
            }
            types.shell8.put(label, ids, out)
        }
        (Cards::Shell { .. }, _) => Err(wrong(label, "3, 4 or up to 8", nodes)),
        (Cards::ThickShell { .. }, 8) => types.thick.put(label, ids, out),
        (Cards::ThickShell { .. }, _) => Err(wrong(label, "8", nodes)),
        (_, 8) => match gmsh_wedge(ids).filter(|_| by_gmsh) {
            Some(wedge) => out.element(label, &types.wedge, &wedge),
            None => types.brick.put(label, ids, out),
        },
        (_, 4) => out.element(label, &types.tetrahedron, ids),
        (_, 10) => out.element(label, &types.tetrahedron10, ids),
        (_, 20) => types.brick20.put(label, ids, out),
        (_, _) => Err(wrong(label, "4, 8, 10 or 20", nodes)),
    }
}

/// Gmsh writes its wedges as N1 N2 N3 N4 N5 N5 N6 N6 too, but with N1 N2 N3 for one triangle and N4 N5 N6 for the other,
/// where LS-DYNA takes N1 N2 N3 N4 for a quadrilateral.
#[inline]
fn gmsh_wedge(ids: &[u64]) -> Option<[u64; 6]> {
    let six = [ids[0], ids[1], ids[2], ids[3], ids[4], ids[6]];
    let distinct = (1..6).all(|k| !six[..k].contains(&six[k]));
    (ids[4] == ids[5] && ids[6] == ids[7] && distinct).then_some(six)
}

#[cold]
fn wrong(label: u64, expected: &str, found: usize) -> Error {
    Error::malformed(format!("{expected} nodes of element {label}"), found.to_string())
}
