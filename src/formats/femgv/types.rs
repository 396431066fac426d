//! Element types by number. The names are FEMGEN's and CGX's; the numbers are CGX's, which descends from FEMVIEW. The
//! number of nodes of each record is held against the type.

use std::borrow::Cow;
use std::sync::{Arc, LazyLock};

use crate::error::{Error, Result};
use crate::mesh::{Class, ElementType, Shape};

/// The largest number of a type; those that are not known are counted by number.
const LARGEST: u64 = 999;

/// From number 1 on.
static KNOWN: [ElementType; 12] = [
    ElementType::measured("he8", Shape::Hexahedron, 1, 8),
    ElementType::measured("pe6", Shape::Wedge, 1, 6),
    ElementType::measured("te4", Shape::Tetrahedron, 1, 4),
    ElementType::measured("he20", Shape::Hexahedron, 2, 20),
    ElementType::measured("pe15", Shape::Wedge, 2, 15),
    ElementType::measured("te10", Shape::Tetrahedron, 2, 10),
    ElementType::measured("tr3", Shape::Triangle, 1, 3),
    ElementType::measured("tr6", Shape::Triangle, 2, 6),
    ElementType::measured("qu4", Shape::Quadrilateral, 1, 4),
    ElementType::measured("qu8", Shape::Quadrilateral, 2, 8),
    ElementType::counted("be2", "line", 2),
    ElementType::counted("be3", "line", 3),
];

static BY_NUMBER: LazyLock<Vec<Arc<ElementType>>> = LazyLock::new(|| {
    let unknown = |number: u64| {
        let name = format!("type {number}");
        let class = Class::Counted(Cow::Owned(name.clone()));
        ElementType { name: Cow::Owned(name), nodes: 0, class }
    };
    let unknown = (KNOWN.len() as u64 + 1..=LARGEST).map(unknown);
    KNOWN.iter().cloned().chain(unknown).map(Arc::new).collect()
});

/// The type with this number.
#[inline]
pub(super) fn find(number: u64) -> Result<&'static Arc<ElementType>> {
    let place = number.checked_sub(1).and_then(|k| BY_NUMBER.get(k as usize));
    place.ok_or_else(|| Error::malformed(format!("an element type from 1 to {LARGEST}"), number.to_string()))
}
