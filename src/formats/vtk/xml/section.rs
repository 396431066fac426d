//! What the arrays of a file are for.

use super::super::role::Role;
use crate::formats::vtk::marks;

/// The kinds of data that a file may hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Unstructured,
    Polygonal,
    Structured,
    Rectilinear,
    Uniform,
    /// Names of other files.
    References,
}

impl Kind {
    /// The kind that the attribute `type` names.
    pub(super) fn find(name: &str) -> Option<Self> {
        Some(match name {
            "UnstructuredGrid" => Self::Unstructured,
            "PolyData" => Self::Polygonal,
            "StructuredGrid" => Self::Structured,
            "RectilinearGrid" => Self::Rectilinear,
            "ImageData" => Self::Uniform,
            "PUnstructuredGrid"
            | "PPolyData"
            | "PStructuredGrid"
            | "PRectilinearGrid"
            | "PImageData"
            | "vtkMultiBlockDataSet"
            | "vtkPartitionedDataSet"
            | "vtkPartitionedDataSetCollection"
            | "Collection" => Self::References,
            _ => return None,
        })
    }

    /// Lists of cells, in VTK's order, and the type of their cells where all have one.
    pub(super) fn lists(self) -> &'static [List] {
        match self {
            Self::Unstructured => &UNSTRUCTURED,
            Self::Polygonal => &POLYGONAL,
            _ => &[],
        }
    }
}

/// A list of cells.
#[derive(Debug)]
pub(super) struct List {
    /// The element that holds its arrays.
    pub(super) name: &'static str,
    /// The attribute that counts its cells.
    pub(super) count: &'static str,
    /// The type of all of its cells; where there is none an array has them.
    pub(super) code: Option<u64>,
}

static UNSTRUCTURED: [List; 1] = [List { name: "Cells", count: "NumberOfCells", code: None }];
static POLYGONAL: [List; 4] = [
    List { name: "Verts", count: "NumberOfVerts", code: Some(2) },
    List { name: "Lines", count: "NumberOfLines", code: Some(4) },
    List { name: "Polys", count: "NumberOfPolys", code: Some(7) },
    List { name: "Strips", count: "NumberOfStrips", code: Some(6) },
];

/// The part of a piece that a tag is in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Section {
    Points,
    /// The planes of a rectilinear grid.
    Coordinates,
    /// One of the lists of cells.
    List(usize),
    CellData,
}

impl Section {
    /// The section that a tag begins.
    pub(super) fn find(kind: Kind, name: &str) -> Option<Self> {
        match name {
            "Points" => Some(Self::Points),
            "Coordinates" => Some(Self::Coordinates),
            "CellData" => Some(Self::CellData),
            _ => kind.lists().iter().position(|list| list.name == name).map(Self::List),
        }
    }

    /// What an array of the section is for, if it matters: `so_far` arrays of the section do already.
    pub(super) fn slot(self, name: &str, so_far: usize) -> Option<Slot> {
        match self {
            Self::Points => Some(Slot::Points),
            Self::Coordinates => Some(Slot::Planes(so_far)),
            Self::List(list) => match name {
                "connectivity" => Some(Slot::Connectivity(list)),
                "offsets" => Some(Slot::Offsets(list)),
                "types" => Some(Slot::Types),
                _ => None,
            },
            Self::CellData => match (marks::hidden(name), marks::region(name)) {
                (Some(mask), _) => Some(Slot::Ghosts(mask)),
                (None, Some(rank)) => Some(Slot::Regions(rank)),
                (None, None) => None,
            },
        }
    }
}

/// What an array is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Slot {
    Points,
    /// Places of planes along an axis.
    Planes(usize),
    Connectivity(usize),
    Offsets(usize),
    Types,
    /// Marks of cells, and the bits that say that a cell is left out.
    Ghosts(u64),
    /// Keys of regions; the lower the number the better it is known what they are.
    Regions(usize),
}

impl Slot {
    /// The role that its numbers play.
    pub(super) fn role(self) -> Role {
        match self {
            Slot::Points | Slot::Planes(_) => Role::Coordinate,
            Slot::Connectivity(_) => Role::Point,
            Slot::Offsets(_) => Role::Offset,
            Slot::Types => Role::Code,
            Slot::Ghosts(_) | Slot::Regions(_) => Role::Mark,
        }
    }
}
