//! What the arrays of a VTK file are for.

use crate::formats::array::Number;

/// What an array is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// x, y, z of the points.
    Coordinate,
    /// Points of the cells, perhaps with the length of each list before it.
    Point,
    /// Where the cells' lists of points end.
    Offset,
    /// Types of the cells.
    Code,
    /// Marks of the cells: what region each is in, whether it is left out.
    Mark,
}

impl Role {
    /// The array's name in errors, and in VTU files.
    pub fn name(self) -> &'static str {
        match self {
            Role::Coordinate => "points",
            Role::Point => "connectivity",
            Role::Offset => "offsets",
            Role::Code => "types",
            Role::Mark => "cell data",
        }
    }

    /// Whether an array of such numbers can serve.
    pub fn allows(self, number: Number) -> bool {
        matches!(self, Role::Coordinate | Role::Mark) || !matches!(number, Number::F32 | Number::F64)
    }

    /// How text is unpacked. More points than an unsigned number of 32 bits can count are not read in any way.
    pub fn unpacked(self, declared: Number) -> Number {
        match self {
            Role::Coordinate if declared == Number::F32 => Number::F32,
            Role::Coordinate | Role::Mark => Number::F64,
            Role::Point => Number::U32,
            Role::Offset => Number::U64,
            Role::Code => Number::U8,
        }
    }
}
