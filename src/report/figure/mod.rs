//! The report's figures as SVG: bars of minima and means, frequency distributions, sizes.
//!
//! A chart is a function from numbers to a [`Scene`] of a few kinds of marks; one template turns scenes into SVG, and
//! escapes every text. Colours are classes: a page gives them its own, in light and dark, and a figure that stands alone
//! brings a style sheet along.

mod bars;
mod distribution;
#[cfg(feature = "png")]
mod png;
mod scale;
mod scene;
mod sizes;

use crate::summary::{MeasureSummary, Sizes};

pub use bars::{Bars, bars};
pub use distribution::{Distribution, distribution};
#[cfg(feature = "png")]
pub use png::Painter;
pub use scene::{Legend, Scene};
pub use sizes::sizes;

/// A mesh as figures know it.
#[derive(Debug, Clone)]
pub struct Series {
    /// Its name, harmless, for people.
    pub name: String,
    /// Its place among the meshes of the report.
    pub index: usize,
    /// The class that gives it its colour: `s0` to `s7`, `rest` where there are more meshes than colours,
    /// `published` for a row of the report of 2007.
    pub class: String,
}

/// One measure on one mesh.
#[derive(Debug, Clone)]
pub struct Value<'a> {
    /// The mesh.
    pub series: &'a Series,
    /// The smallest value.
    pub min: f64,
    /// The mean.
    pub mean: f64,
    /// Whole statistics, where there are more than a published row has.
    pub found: Option<&'a MeasureSummary>,
}

/// One measure on several meshes.
#[derive(Debug, Clone)]
pub struct Panel<'a> {
    /// The measure's code, harmless.
    pub code: String,
    /// Values that somebody has given a meaning, from the lowest.
    pub limits: Vec<f64>,
    /// A value a mesh.
    pub values: Vec<Value<'a>>,
}

/// The sizes of one mesh.
#[derive(Debug, Clone)]
pub struct Sized<'a> {
    /// The mesh.
    pub series: &'a Series,
    /// Its sizes.
    pub sizes: &'a Sizes,
}

/// Under this the report calls a value 'bad enough to warrant further investigation'.
pub const INVESTIGATE: f64 = 0.1;
