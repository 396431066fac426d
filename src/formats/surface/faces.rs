//! The types of faces: by their number of corners.

use std::sync::{Arc, LazyLock};

use crate::error::{Error, Result};
use crate::input::{Source, Spot};
use crate::mesh::{ElementType, Shape};

static FACES: LazyLock<[Arc<ElementType>; 5]> = LazyLock::new(|| {
    [
        ElementType::counted("point", "point", 1),
        ElementType::counted("line", "line", 2),
        ElementType::measured("triangle", Shape::Triangle, 1, 3),
        ElementType::measured("quadrilateral", Shape::Quadrilateral, 1, 4),
        ElementType::counted("polygon", "polygon", 0),
    ]
    .map(Arc::new)
});

/// The type of a face with so many corners.
#[inline]
pub(super) fn of_corners(corners: u64) -> Result<&'static Arc<ElementType>> {
    match corners {
        0 => Err(Error::malformed("a face of one corner or more", "0 corners")),
        1..=4 => Ok(&FACES[corners as usize - 1]),
        _ => Ok(&FACES[4]),
    }
}

/// A line, of however many points.
pub(super) fn line() -> &'static Arc<ElementType> {
    &FACES[1]
}

/// A point.
pub(super) fn point() -> &'static Arc<ElementType> {
    &FACES[0]
}

/// A triangle.
pub(super) fn triangle() -> &'static Arc<ElementType> {
    &FACES[2]
}

/// The error of a file that defines points and no faces, up to byte `at`.
pub(super) fn none(source: &Source, at: u64) -> Error {
    source.place(Error::malformed("one face or more", "points alone"), Spot::Text(at))
}
