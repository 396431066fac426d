//! Structured topologies: only the numbers of nodes along each axis are given, the slowest first.

use std::sync::{Arc, LazyLock};

use super::heavy::{Files, Found};
use super::light::{Geometry, Topology};
use super::refused;
use crate::error::{Error, Result};
use crate::formats::Outline;
use crate::formats::array::Stores;
use crate::formats::array::nodes::Coordinates;
use crate::formats::array::regions::InRegions;
use crate::formats::array::structured::{self, Cells, Kinds, Places, Vertices};
use crate::formats::array::table::Table;
use crate::input::{Input, Spot};
use crate::mesh::{ElementType, Shape};

static KINDS: LazyLock<Kinds> = LazyLock::new(|| Kinds {
    line: Arc::new(ElementType::counted("Polyline", "line", 2)),
    quadrilateral: Arc::new(ElementType::measured("Quadrilateral", Shape::Quadrilateral, 1, 4)),
    hexahedron: Arc::new(ElementType::measured("Hexahedron", Shape::Hexahedron, 1, 8)),
});

/// A grid whose elements follow from the number of its nodes.
pub(super) struct Lattice {
    at: u64,
    /// Nodes along each axis, x first.
    axes: Vec<u64>,
    nodes: Nodes,
    items: Vec<Found>,
}

/// What the items of a geometry are.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Nodes {
    /// All coordinates of a node one after another.
    Listed,
    /// An array for each coordinate.
    ByAxis,
    /// Places of planes along each axis.
    Planes,
    /// An origin and the steps along the axes, of the slowest axis first, as ParaView reads them.
    Steps,
}

/// Number of axes of a structured topology of that kind.
pub(super) fn axes_of(kind: &str) -> Option<usize> {
    let mesh = kind.strip_suffix("mesh")?;
    let (axes, rest) = (mesh.get(..2)?, mesh.get(2..)?);
    let axes = ["2d", "3d"].iter().position(|known| *known == axes)? + 2;
    ["s", "rect", "corect"].contains(&rest).then_some(axes)
}

impl Lattice {
    /// Finds the numbers of a grid of so many axes.
    pub(super) fn find(
        input: &Input,
        (geometry, topology): (&Geometry, &Topology),
        axes: usize,
        files: &mut Files<'_>,
    ) -> Result<Self> {
        let wrong = |at: u64, expected: String, found: String| {
            Err(input.source.place(Error::malformed(expected, found), Spot::Text(at)))
        };
        let counts: Vec<u64> = topology.dimensions.iter().rev().copied().collect();
        if counts.len() != axes {
            return wrong(
                topology.at,
                format!("{axes} numbers of nodes in the attribute Dimensions"),
                counts.len().to_string(),
            );
        }
        let (nodes, items) = match (geometry.kind.as_str(), axes) {
            ("xyz", 3) | ("xy", 2) => (Nodes::Listed, 1),
            ("x_y_z", 3) | ("x_y", 2) => (Nodes::ByAxis, axes),
            ("vxvyvz", 3) | ("vxvy", 2) => (Nodes::Planes, axes),
            ("origin_dxdydz", 3) | ("origin_dxdy", 2) => (Nodes::Steps, 2),
            (other, _) => {
                let what = format!(
                    "XDMF geometry of the type {other} with a topology {} is not read",
                    topology.kind
                );
                return Err(refused(input, geometry.at, what));
            }
        };
        if geometry.items.len() != items {
            return wrong(
                geometry.at,
                format!("{items} DataItem in the geometry"),
                geometry.items.len().to_string(),
            );
        }
        let all = structured::vertices(&counts);
        let mut found = Vec::new();
        for (k, item) in geometry.items.iter().enumerate() {
            let expected = match nodes {
                Nodes::Listed => all.saturating_mul(axes as u64),
                Nodes::ByAxis => all,
                Nodes::Planes => counts[k],
                Nodes::Steps => axes as u64,
            };
            if item.count != expected {
                return wrong(
                    item.at,
                    format!("{expected} numbers, as the topology says"),
                    item.count.to_string(),
                );
            }
            found.push(files.find(item, true)?);
        }
        Ok(Self { at: topology.at, axes: counts, nodes, items: found })
    }

    /// Number of nodes, and of elements.
    pub(super) fn counts(&self) -> (u64, u64) {
        (structured::vertices(&self.axes), structured::cells(&self.axes))
    }

    /// Hands out nodes and elements, which have these numbers.
    pub(super) fn outline(
        self,
        input: &Input,
        stores: &Stores,
        first: (u64, u64),
        out: &mut dyn Outline,
    ) -> Result<()> {
        let mut arrays = self.items.iter().map(|found| found.array(stores)).collect::<Result<Vec<_>>>()?;
        let file = Arc::clone(&stores.file);
        let counts = [0, 1, 2].map(|axis| self.axes.get(axis).copied().unwrap_or(1));
        let table = match self.nodes {
            Nodes::Listed => Some(Table::Rows(arrays.remove(0), self.axes.len())),
            Nodes::ByAxis => Some(Table::Columns(std::mem::take(&mut arrays))),
            Nodes::Planes | Nodes::Steps => None,
        };
        match table {
            Some(table) => {
                let file = Arc::clone(&file);
                Coordinates { file, table, first: first.0 }.outline(out)?;
            }
            None => {
                let places = if self.nodes == Nodes::Planes {
                    arrays.resize_with(3, || stores.nothing());
                    Places::Axes(<[_; 3]>::try_from(arrays).expect("there are three now"))
                } else {
                    let (mut origin, mut spacing) = (Vec::new(), Vec::new());
                    arrays[0].reals(0..3, &mut origin);
                    arrays[1].reals(0..3, &mut spacing);
                    steps(&origin, &spacing)
                };
                let (file, spot) = (Arc::clone(&file), Spot::Text(self.at));
                Vertices { file, counts, places, first: Some(first.0), spot }.outline(input, out)?;
            }
        }
        Cells { file, axes: self.axes, first, regions: InRegions::Unknown, ghosts: None }.outline(&KINDS, out)
    }
}

/// Nodes at equal steps along x, y, z; the numbers of the slowest axis stand first.
fn steps(origin: &[f64], spacing: &[f64]) -> Places {
    let of = |numbers: &[f64], axis: usize| numbers.iter().rev().nth(axis).copied().unwrap_or(0.0);
    let step = |axis: usize| [0, 1, 2].map(|k| if k == axis { of(spacing, axis) } else { 0.0 });
    Places::Steps { origin: [0, 1, 2].map(|axis| of(origin, axis)), steps: [step(0), step(1), step(2)] }
}
