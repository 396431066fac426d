//! The twelve measures of the NPL report: coordinates in, scores in \[0, 1\] out. No file and no thread is known here.
//!
//! A measure is a row of a table and a plain `f64` function of the element's shared facts: its edges, face areas and
//! volume. The [`batch`] runs the very same functions over 64 elements side by side, compiled for several
//! vector widths, and gives the same bits as one element at a time does on any machine. The price is a discipline
//! for everything in this folder that is called per element: no branches with effects, no early return, no closures
//! (values would spill), no `mul_add`, and none of `powf`, `cbrt`, `acos` and `hypot`, whose calls stop a loop from
//! becoming vector code. Choosing between two finished values is fine.
//!
//! Elements are measured relative to one corner, in units of a power of two near their longest edge, so neither where
//! a mesh stands nor how large it is matters. A degenerate element (its area or volume is within the rounding error
//! of its computation) scores 0, never NaN.
//!
//! ```
//! use meshgauge::measures::{Family, triangle};
//!
//! let right_angled = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
//! for (measure, score) in Family::Triangle.measures().iter().zip(triangle::score(&right_angled)) {
//!     println!("{} = {}: {score:.3}", measure.code, measure.definition);
//! }
//! ```

use std::fmt;

use crate::mesh::Shape;

/// Makes a family's table and its scoring function from one list, so that neither can drift from the other.
macro_rules! measures {
    ($family:expr, of $corners:literal corners: $($function:ident {
        code: $code:literal,
        title: $title:literal,
        definition: $definition:literal,
        watches: $watches:literal,
        source: $source:literal,
        thresholds: $thresholds:expr,
    })+) => {
        /// The rows of this family, in code order.
        pub static MEASURES: [super::Measure; COUNT] = [$(super::Measure {
            code: $code,
            family: $family,
            title: $title,
            definition: $definition,
            watches: $watches,
            source: $source,
            thresholds: $thresholds,
        }),+];

        /// Number of measures of this family.
        pub const COUNT: usize = [$($code),+].len();

        /// All scores of one element, in code order.
        #[inline(always)]
        pub(super) fn all(points: &[[f64; 3]; $corners]) -> [f64; COUNT] {
            let facts = Facts::of(points);
            [$(super::elementary::score($function(&facts))),+]
        }

        /// The scores of one element or face, given by its corners, in code order.
        pub fn score(points: &[[f64; 3]; $corners]) -> [f64; COUNT] {
            all(points)
        }
    };
}

pub mod batch;
mod elementary;
pub mod geometry;
pub mod quadrilateral;
pub mod tetrahedron;
pub mod triangle;
mod vector;

pub use batch::{
    Corner, Geometry, LANES, Lanes, QuadrilateralFlaws, geometry, quadrilateral_flaws, quadrilaterals,
    tetrahedra, triangles,
};

/// One measure. Every measure ranges over [`Measure::RANGE`], and [`Measure::BEST`] is best.
#[derive(Debug)]
pub struct Measure {
    /// The report's name: `M31`.
    pub code: &'static str,
    /// What it is defined for.
    pub family: Family,
    /// A short name.
    pub title: &'static str,
    /// The formula.
    pub definition: &'static str,
    /// What a low score warns of.
    pub watches: &'static str,
    /// Where it comes from.
    pub source: &'static str,
    /// Values that somebody has given a meaning.
    pub thresholds: &'static [Threshold],
}

impl Measure {
    /// The lowest and the highest score.
    pub const RANGE: [f64; 2] = [0.0, 1.0];
    /// The score of a perfect element.
    pub const BEST: f64 = 1.0;

    /// The measure's place among those of its family.
    pub fn index(&self) -> usize {
        self.family.measures().iter().take_while(|row| row.code != self.code).count()
    }
}

/// A value of a measure that somebody has given a meaning.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Threshold {
    /// The value.
    pub value: f64,
    /// What holds on which side of it.
    pub meaning: &'static str,
    /// Who says so.
    pub source: &'static str,
}

const COMSOL_TRIANGLE: Threshold = Threshold {
    value: 0.3,
    meaning: "above: does not affect the accuracy of a solution",
    source: "Comsol Multiphysics manual",
};

const COMSOL_TETRAHEDRON: Threshold =
    Threshold { value: 0.1, meaning: "above: acceptable", source: "Comsol Multiphysics manual" };

const ASPECT_WARNING: Threshold =
    Threshold { value: 0.2, meaning: "below: packages warn", source: "NPL report, section 5.3" };

const ASPECT_FAILURE: Threshold =
    Threshold { value: 0.07, meaning: "below: packages report an error", source: "NPL report, section 5.3" };

/// What a measure is defined for: an element, or a face of one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Family {
    /// M11 to M15.
    Triangle,
    /// M21 to M23.
    Quadrilateral,
    /// M31 to M34.
    Tetrahedron,
}

/// The most measures that a family has.
pub const MOST_MEASURES: usize = 5;

impl Family {
    /// Every family, in the order of its codes.
    pub const ALL: [Family; 3] = [Family::Triangle, Family::Quadrilateral, Family::Tetrahedron];

    /// The family's measures, in code order.
    pub fn measures(self) -> &'static [Measure] {
        match self {
            Family::Triangle => &triangle::MEASURES,
            Family::Quadrilateral => &quadrilateral::MEASURES,
            Family::Tetrahedron => &tetrahedron::MEASURES,
        }
    }

    /// The family's name: that of the shape it is defined for.
    pub const fn name(self) -> &'static str {
        match self {
            Family::Triangle => Shape::Triangle.name(),
            Family::Quadrilateral => Shape::Quadrilateral.name(),
            Family::Tetrahedron => Shape::Tetrahedron.name(),
        }
    }
}

impl fmt::Display for Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// All twelve measures, in code order.
pub fn measures() -> impl Iterator<Item = &'static Measure> {
    Family::ALL.into_iter().flat_map(Family::measures)
}

/// The measure of this code.
pub fn find(code: &str) -> Option<&'static Measure> {
    measures().find(|measure| measure.code == code)
}

/// What is measured on the elements of a shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Subject {
    /// Which measures.
    pub family: Family,
    /// On what: `element`, `triangular faces` or `quadrilateral faces`.
    pub on: &'static str,
}

/// What is measured on the elements of a shape: solids other than tetrahedra are measured face by face.
pub fn subjects(shape: Shape) -> &'static [Subject] {
    const fn subject(family: Family, on: &'static str) -> Subject {
        Subject { family, on }
    }
    const TRIANGLE: [Subject; 1] = [subject(Family::Triangle, "element")];
    const QUADRILATERAL: [Subject; 1] = [subject(Family::Quadrilateral, "element")];
    const TETRAHEDRON: [Subject; 1] = [subject(Family::Tetrahedron, "element")];
    const FACES: [Subject; 2] = [
        subject(Family::Triangle, "triangular faces"),
        subject(Family::Quadrilateral, "quadrilateral faces"),
    ];
    match shape {
        Shape::Triangle => &TRIANGLE,
        Shape::Quadrilateral => &QUADRILATERAL,
        Shape::Tetrahedron => &TETRAHEDRON,
        Shape::Pyramid | Shape::Wedge => &FACES,
        Shape::Hexahedron => FACES.split_at(1).1,
    }
}
