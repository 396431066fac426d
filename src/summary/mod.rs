//! The summary of one mesh: the schema `meshgauge.summary/1`, its verdict, and nothing that computes.
//!
//! Keys come in the order of the fields. Maps are sorted by key, shapes in the order of [`Shape::ALL`]. Numbers are
//! written in the shortest form that reads back to the same double. The same input gives the same bytes whatever the
//! threads and the memory budget; `run` alone differs.

mod checks;
mod reading;
mod region;
mod rule;
mod verdict;

use std::borrow::Cow;
use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::mesh::{Shape, System};

pub use checks::Checks;
pub use region::{Region, RegionMeasure, RegionShape, Regions, WorstElement};
pub use rule::{GOOD, INVESTIGATE, PRESETS, Preset, Rule, STATISTICS, Statistic, Subject, preset};
pub use verdict::{Expectation, Judgement, rules};

/// The schema's name and version.
pub const SCHEMA: &str = "meshgauge.summary/1";

/// What was found in one mesh.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// [`SCHEMA`].
    pub schema: Cow<'static, str>,
    /// The file.
    pub mesh: MeshFile,
    /// Its nodes.
    pub nodes: Nodes,
    /// Its elements, measured or not.
    pub elements: Elements,
    /// The coordinates that measures looked at, where they are not the file's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame: Option<Frame>,
    /// What was measured, by shape; a shape that the mesh lacks has no key.
    pub shapes: BTreeMap<Shape, ShapeSummary>,
    /// Sums over the elements of the mesh's own dimension.
    pub totals: Totals,
    /// Sizes of the elements of the mesh's own dimension.
    pub sizes: Sizes,
    /// Number of findings of each check.
    pub checks: Checks,
    /// What the user said the mesh should measure, and how it does.
    pub expected: Option<Expected>,
    /// Fit to be solved?
    pub verdict: Verdict,
    /// How the run went; left out where only the mesh matters.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub run: Option<Run>,
    /// Statistics by region, where they were asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub regions: Option<Regions>,
}

/// The file that was scored.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeshFile {
    /// The file's name without its compression and mesh extensions.
    pub name: String,
    /// The path as it was given.
    pub path: String,
    /// The format's name.
    pub format: String,
    /// What the file is packed with, if it is.
    pub compression: Option<String>,
    /// Number of bytes on disk.
    pub bytes: u64,
    /// XXH3 (64 bits, hexadecimal) of the bytes on disk.
    pub xxh3: String,
}

/// Nodes of the mesh.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Nodes {
    /// Number of nodes, each number counted once.
    pub count: u64,
    /// Number of nodes that no element names.
    pub unused: u64,
    /// Smallest box that holds all nodes; `null` without nodes.
    pub bounds: Option<Bounds>,
}

/// A box along the axes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Bounds {
    /// Smallest x, y, z.
    pub min: [f64; 3],
    /// Largest x, y, z.
    pub max: [f64; 3],
}

/// The coordinates that measures looked at. All but measures and flaws of faces is in the file's own.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    /// The system: `cartesian`, `cylindrical:z`, `cylindrical:x@0,10,0`.
    pub system: System,
    /// What each of its coordinates is multiplied by.
    pub stretch: [f64; 3],
    /// Number of elements that enclose the axis, which have no image in cylindrical coordinates.
    pub enclosing_axis: u64,
}

/// Elements of the mesh.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Elements {
    /// Number of elements of every kind, measured or not.
    pub count: u64,
    /// Number of elements by the format's own name of their type.
    pub by_type: BTreeMap<String, u64>,
    /// Number of elements that no measure is defined for, by what they are.
    pub not_measured: BTreeMap<String, u64>,
}

/// What was found in the elements of one shape.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShapeSummary {
    /// Number of elements that were measured.
    pub count: u64,
    /// Number of elements by polynomial order; all are measured by their corners.
    pub order: BTreeMap<String, u64>,
    /// Sum of the areas, for surface shapes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub area: Option<f64>,
    /// Sum of the volumes (as magnitudes), for solids.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub volume: Option<f64>,
    /// Number of elements that are oriented against the majority of their shape.
    pub inverted: u64,
    /// Number of elements without area or volume, or with an edge without length.
    pub degenerate: u64,
    /// Statistics by measure.
    pub measures: BTreeMap<String, MeasureSummary>,
    /// Pearson's correlation between two measures, key `M31 M32`; `null` where one does not vary.
    pub correlation: BTreeMap<String, Option<f64>>,
    /// Share of elements whose measures stand in the order of the key; tetrahedra only.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub ordering: BTreeMap<String, f64>,
}

/// Statistics of one measure on one shape.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeasureSummary {
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
    /// Quantiles by probability.
    pub quantiles: BTreeMap<String, f64>,
    /// Bin k of 100 counts the values with `0.01 k <= M < 0.01 (k + 1)`; 1 is in the last.
    pub histogram: Vec<u64>,
    /// Number of values under a threshold, by threshold: those that a rule of the verdict asks for.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub below: BTreeMap<String, u64>,
    /// The worst elements, the worst first, where they were asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub worst: Vec<WorstElement>,
}

/// Sums over the elements of the mesh's own dimension: solids if there are any, else surfaces.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Totals {
    /// Area of a surface mesh, else `null`.
    pub area: Option<f64>,
    /// Volume of a solid mesh, else `null`.
    pub volume: Option<f64>,
}

/// Sizes of the elements of the mesh's own dimension.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Sizes {
    /// Lengths of edges between corners; `null` without elements.
    pub edge_length: Option<Range>,
    /// RMS edge length of each element; `null` without elements.
    pub element_size: Option<SizeSummary>,
}

/// Smallest and largest.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Range {
    /// Smallest.
    pub min: f64,
    /// Largest.
    pub max: f64,
}

/// Distribution of sizes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SizeSummary {
    /// Smallest.
    pub min: f64,
    /// Largest.
    pub max: f64,
    /// Mean.
    pub mean: f64,
    /// Quantiles by probability.
    pub quantiles: BTreeMap<String, f64>,
}

/// What the user said the mesh should measure.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Expected {
    /// The true volume.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub volume: Option<f64>,
    /// The true area.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub area: Option<f64>,
    /// (measured - true) / true.
    pub relative_error: f64,
    /// Whether the error is within the tolerance.
    pub within: bool,
}

/// Fit to be solved?
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    /// The worst of the reasons.
    pub status: Status,
    /// Why it is not a pass.
    pub reasons: Vec<Reason>,
}

/// How bad it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// Fit.
    Pass,
    /// Worth a look.
    Warn,
    /// Not fit.
    Fail,
}

/// Why a mesh is not a pass.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Reason {
    /// The rule's name: `npl`, `fail under`, `inverted elements`, ...
    pub rule: Cow<'static, str>,
    /// The measure or the check, where the rule is about one.
    pub measure: Option<String>,
    /// The shape, where the rule is about one.
    pub shape: Option<Shape>,
    /// What was found.
    pub value: f64,
    /// What the rule allows.
    pub limit: f64,
    /// The element to look at first, where there is one.
    pub element: Option<u64>,
    /// What of the measure was held against the limit, where it is not the minimum: `mean`, `quantile 0.05`,
    /// `share below`, `count below`, ...
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub statistic: Option<Cow<'static, str>>,
    /// What the values are under that `share below` and `count below` count.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub threshold: Option<f64>,
    /// How bad it is, where the rule's name alone does not tell.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub status: Option<Status>,
}

/// How the run went.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// Version of meshgauge.
    pub meshgauge: Cow<'static, str>,
    /// Name of the machine.
    pub host: String,
    /// When it began, RFC 3339 in UTC.
    pub started: String,
    /// How long it took.
    pub seconds: f64,
    /// Number of worker threads.
    pub threads: usize,
    /// Peak resident memory of the process.
    pub peak_rss_bytes: u64,
    /// Measured elements a second.
    pub elements_per_second: f64,
}

impl Status {
    /// The status as it stands in a summary.
    pub const fn name(self) -> &'static str {
        match self {
            Status::Pass => "pass",
            Status::Warn => "warn",
            Status::Fail => "fail",
        }
    }
}

impl Reason {
    /// How bad it is.
    pub fn status(&self) -> Status {
        self.status.unwrap_or(match &*self.rule {
            rules::NPL | rules::NOTHING_MEASURED => Status::Warn,
            _ => Status::Fail,
        })
    }

    /// A reason that names its rule and nothing else yet.
    fn of(rule: impl Into<Cow<'static, str>>) -> Self {
        Self {
            rule: rule.into(),
            measure: None,
            shape: None,
            value: 0.0,
            limit: 0.0,
            element: None,
            statistic: None,
            threshold: None,
            status: None,
        }
    }
}

impl Summary {
    /// The summary as indented JSON with a newline at the end.
    pub fn to_json(&self) -> String {
        let mut text =
            serde_json::to_string_pretty(self).expect("a summary has string keys and finite numbers");
        text.push('\n');
        text
    }

    /// Dimension of the mesh: the largest of its shapes; shapes of lower dimension are boundaries, outside the totals
    /// and the verdict.
    pub fn dimension(&self) -> usize {
        self.shapes.keys().map(|shape| shape.dimension()).max().unwrap_or(0)
    }

    /// The shapes of the mesh's own dimension.
    pub fn main_shapes(&self) -> impl Iterator<Item = (Shape, &ShapeSummary)> {
        let dimension = self.dimension();
        self.shapes
            .iter()
            .map(|(shape, s)| (*shape, s))
            .filter(move |(shape, _)| shape.dimension() == dimension)
    }
}
