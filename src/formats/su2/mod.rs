//! SU2 `.su2`: lines `KEYWORD= value`, some of which have rows after them, in any order. Zones follow one another, each with
//! points of its own.
//!
//! The numbers that may end a row are not read, as SU2 does not read them: points count from 0 within their zone, and the
//! number of an element is its position in the file, from 1, over the rows of `NELEM` and `MARKER_ELEMS` in file order.

mod elements;
mod keywords;
#[cfg(test)]
mod tests;

use crate::error::Result;
use crate::formats::{Format, Outline};
use crate::input::Input;
use crate::mesh::Shape;

/// The format's row in the table of formats.
pub(super) struct Su2;

impl Format for Su2 {
    fn name(&self) -> &'static str {
        "su2"
    }

    fn title(&self) -> &'static str {
        "SU2 .su2, text, one zone or several, with the elements of markers"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["su2"]
    }

    fn looks_for(&self) -> &'static str {
        "NDIME= or NZONE= in the first line that is no comment"
    }

    fn detect(&self, head: &[u8]) -> bool {
        keywords::is_su2(head)
    }

    /// Types are those of VTK, whose wedges writers turn either way.
    fn own_orientation(&self) -> &'static [Shape] {
        &[Shape::Wedge]
    }

    fn regions(&self) -> Option<&'static str> {
        Some("markers")
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        keywords::outline(input, out)
    }
}
