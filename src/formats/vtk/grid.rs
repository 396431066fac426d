//! VTK's structured, rectilinear and uniform grids: points in rows, columns and layers, and the cells between them.

use std::sync::{Arc, LazyLock};

use crate::error::Result;
use crate::formats::Outline;
use crate::formats::array::Array;
use crate::formats::array::regions::InRegions;
use crate::formats::array::structured::{self, Cells, Kinds, Places, Vertices};
use crate::input::{Input, Source, Spot};
use crate::mesh::{ElementType, Shape};

/// What VTK calls the cells of a structured grid.
static STRUCTURED: LazyLock<Kinds> = LazyLock::new(|| kinds("VTK_QUAD", "VTK_HEXAHEDRON"));
/// What it calls those whose edges lie along the axes.
static ALONG_AXES: LazyLock<Kinds> = LazyLock::new(|| kinds("VTK_PIXEL", "VTK_VOXEL"));

fn kinds(quadrilateral: &'static str, hexahedron: &'static str) -> Kinds {
    Kinds {
        line: Arc::new(ElementType::counted("VTK_LINE", "line", 2)),
        quadrilateral: Arc::new(ElementType::measured(quadrilateral, Shape::Quadrilateral, 1, 4)),
        hexahedron: Arc::new(ElementType::measured(hexahedron, Shape::Hexahedron, 1, 8)),
    }
}

/// The axes along which there is more than one point.
fn axes(counts: &[u64; 3]) -> Vec<u64> {
    counts.iter().copied().filter(|count| *count != 1).collect()
}

/// Number of points.
pub(super) fn points(counts: &[u64; 3]) -> u64 {
    structured::vertices(counts)
}

/// Number of cells.
pub(super) fn cells(counts: &[u64; 3]) -> u64 {
    match axes(counts)[..] {
        [] => 0,
        ref axes => structured::cells(axes),
    }
}

/// Where the points of a uniform grid stand whose first point is `from` steps from the origin.
pub(super) fn steps(origin: &[f64; 3], spacing: &[f64; 3], direction: &[f64; 9], from: [i64; 3]) -> Places {
    let steps = [0, 1, 2].map(|axis| [0, 1, 2].map(|row| direction[3 * row + axis] * spacing[axis]));
    let start =
        |row: usize| origin[row] + (0..3).map(|axis| from[axis] as f64 * steps[axis][row]).sum::<f64>();
    Places::Steps { origin: [0, 1, 2].map(start), steps }
}

/// Points that no array lists.
pub(super) struct Lattice {
    /// How many there are along each axis.
    pub(super) counts: [u64; 3],
    pub(super) places: Places,
    /// Where the grid is described.
    pub(super) at: u64,
}

impl Lattice {
    /// Hands out the points, cut into pieces.
    pub(super) fn outline(self, input: &Input, file: &Arc<Source>, out: &mut dyn Outline) -> Result<()> {
        let Self { counts, places, at } = self;
        Vertices { file: Arc::clone(file), counts, places, first: None, spot: Spot::Text(at) }
            .outline(input, out)
    }
}

/// The cells of a grid with so many points along each axis.
pub(super) struct Block {
    pub(super) file: Arc<Source>,
    pub(super) counts: [u64; 3],
    /// The numbers of the first point and cell within the file.
    pub(super) first: (u64, u64),
    pub(super) regions: InRegions,
    pub(super) ghosts: Option<(Array, u64)>,
}

impl Block {
    /// Hands out the cells; those of a structured grid need not lie along the axes.
    pub(super) fn outline(self, is_structured: bool, out: &mut dyn Outline) -> Result<()> {
        let Self { file, counts, first, regions, ghosts } = self;
        let kinds = if is_structured { &STRUCTURED } else { &ALONG_AXES };
        Cells { file, axes: axes(&counts), first, regions, ghosts }.outline(kinds, out)
    }
}
