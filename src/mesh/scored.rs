//! A scored element, and who wants to see each of them.

use super::{Nodes, Shape};
use crate::error::Result;

/// One element with all that was measured of it.
#[derive(Debug, Clone, Copy)]
pub struct ScoredElement<'a> {
    /// Its own number in the file.
    pub label: u64,
    /// Its shape.
    pub shape: Shape,
    /// The name of its region, where its format has regions.
    pub region: Option<&'a str>,
    /// Its corners as rows of the node table, in our order.
    pub corners: &'a [u32],
    /// Mean of its corners.
    pub centroid: [f64; 3],
    /// Signed volume of a solid, area of a surface.
    pub extent: f64,
    /// RMS edge length.
    pub size: f64,
    /// Scores by measure, in the order of the table of measures; NaN for those that its shape has not. Of a measure of
    /// faces it is the worst of the element's faces.
    pub scores: &'a [f64],
}

/// Takes every measured element, in the order of the file.
pub trait ElementWriter: Send {
    /// Takes the next element.
    fn write(&mut self, element: &ScoredElement<'_>) -> Result<()>;

    /// There are no more; the nodes are those that the corners name.
    fn finish(&mut self, nodes: &Nodes) -> Result<()>;
}
