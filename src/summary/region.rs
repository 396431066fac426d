//! Statistics by region, and single elements that are worth a look: parts of a summary that are there on demand.

use std::borrow::Cow;
use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::mesh::Shape;

/// Statistics by region.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Regions {
    /// What they are, as the format's users call them: `physical groups`, `parts`; `null` where the format has none.
    pub of: Option<Cow<'static, str>>,
    /// The regions that hold measured elements, in order of their names, numbers as numbers; elements in none last.
    pub list: Vec<Region>,
}

/// What was found in one region.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Region {
    /// Its name or number in the file; `null` for elements that are in no region.
    pub name: Option<String>,
    /// By shape.
    pub shapes: BTreeMap<Shape, RegionShape>,
}

/// What was found in the elements of one shape and region.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RegionShape {
    /// Number of elements that were measured.
    pub count: u64,
    /// Sum of the areas, for surface shapes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub area: Option<f64>,
    /// Sum of the volumes (as magnitudes), for solids.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub volume: Option<f64>,
    /// Number of elements that are oriented against the majority of their shape in the whole mesh.
    pub inverted: u64,
    /// Number of elements without area or volume, or with an edge without length.
    pub degenerate: u64,
    /// Statistics by measure.
    pub measures: BTreeMap<String, RegionMeasure>,
}

/// Statistics of one measure on one shape in one region; see [`super::MeasureSummary`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RegionMeasure {
    /// What was measured: `element`, `triangular faces`, `quadrilateral faces`.
    pub on: Cow<'static, str>,
    /// Number of values.
    pub count: u64,
    /// Largest value.
    pub max: f64,
    /// Smallest value.
    pub min: f64,
    /// Number of the element that has the smallest value; of several the first in the file.
    pub min_element: u64,
    /// Mean.
    pub mean: f64,
    /// Standard deviation of the population.
    pub sd: f64,
}

/// One of the worst elements of a measure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WorstElement {
    /// Its own number in the file.
    pub element: u64,
    /// Its value; of a measure of faces that of its worst face.
    pub value: f64,
    /// Mean of its corners.
    pub centroid: [f64; 3],
    /// The numbers of its corner nodes in the file, in our order of corners.
    pub nodes: Vec<u64>,
    /// The region it is in; `null` where its format has none.
    pub region: Option<String>,
}
