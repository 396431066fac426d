//! VTKHDF: unstructured grids and polygonal data in HDF5 files, one grid or a collection of them.
//!
//! The partitions of a grid stand one after another in the same arrays, and the numbers of points start anew in each; of
//! the offsets each partition has one more than it has cells. Of several time steps the first is read.

use crate::error::{Error, Result};
use crate::formats::array::{Array, Stored, Stores, Unpacked};
use crate::formats::hdf5::{self, Group, Hdf5};
use crate::formats::{Format, HEAD_BYTES, Outline};
use crate::input::Input;
use crate::mesh::Shape;

use super::layout::Cells;
use super::lists::{Lists, Types};
use super::points::Points;
use crate::formats::array::regions::InRegions;

/// The group of all data.
const ROOT: &str = "VTKHDF";
/// Most partitions of a grid, over all its time steps.
const MOST_PARTITIONS: u64 = 1 << 22;
/// Most grids of a collection.
const MOST_GRIDS: usize = 100_000;
/// Groups of cells of polygonal data, in the order in which VTK counts them, and their type.
const POLYGONAL: [(&str, u64); 4] = [("Vertices", 2), ("Lines", 4), ("Polygons", 7), ("Strips", 6)];

/// VTK's grids in HDF5 files.
#[derive(Debug)]
pub struct VtkHdf;

impl Format for VtkHdf {
    fn name(&self) -> &'static str {
        "vtkhdf"
    }

    fn title(&self) -> &'static str {
        "VTKHDF: unstructured grids and polygonal data, alone or in collections, with partitions"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["vtkhdf", "hdf"]
    }

    fn looks_for(&self) -> &'static str {
        "an HDF5 file with the group VTKHDF"
    }

    fn own_orientation(&self) -> &'static [Shape] {
        super::cells::OWN_ORIENTATION
    }

    fn detect(&self, head: &[u8]) -> bool {
        hdf5::detect(head) && memchr::memmem::find(head, ROOT.as_bytes()).is_some()
    }

    fn knows(&self, input: &Input) -> bool {
        let head = input.source.peek(0..HEAD_BYTES as u64);
        let has_root = |file: Hdf5| Ok(file.root()?.group(ROOT)?.is_some());
        self.detect(head) || hdf5::detect(head) && Hdf5::open(input).and_then(has_root).unwrap_or(false)
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        let file = Hdf5::open(input)?;
        let root = file.root()?;
        let Some(root) = root.group(ROOT)? else {
            return Err(root.malformed("the group VTKHDF", "none of that name"));
        };
        let (mut unpacked, mut grids) = (Unpacked::new(input), Vec::new());
        find(input, &root, 0, &mut unpacked, &mut grids)?;
        if grids.is_empty() {
            return Err(root.malformed("an unstructured grid or polygonal data", "none"));
        }
        let stores = unpacked.finish()?;
        let several = grids.len() > 1 || grids.iter().any(|grid| grid.points.len() > 1);
        let mut first = First { point: 0, cell: 0, several };
        grids.into_iter().try_for_each(|grid| grid.outline(&stores, &mut first, out))
    }
}

/// A grid, whose arrays hold all partitions.
struct Grid {
    /// Number of points of each partition.
    points: Vec<u64>,
    coordinates: Stored,
    cells: Vec<CellGroup>,
}

/// Cells of a grid: all of them, or of polygonal data those of one kind.
struct CellGroup {
    /// Numbers of cells, and of entries of the connectivity, of each partition.
    counts: Vec<(u64, u64)>,
    connectivity: Stored,
    offsets: Stored,
    types: Kind,
}

enum Kind {
    Each(Stored),
    All(u64),
}

/// Finds the grids of a group, which is one or a collection.
fn find(
    input: &Input,
    group: &Group<'_>,
    depth: usize,
    unpacked: &mut Unpacked<'_>,
    grids: &mut Vec<Grid>,
) -> Result<()> {
    match group.text("Type")?.as_deref() {
        Some("UnstructuredGrid") => grids.push(Grid::unstructured(input, group, unpacked)?),
        Some("PolyData") => grids.push(Grid::polygonal(input, group, unpacked)?),
        Some("PartitionedDataSetCollection" | "MultiBlockDataSet") if depth == 0 => {
            for block in group.groups()? {
                // The assembly says how the blocks are arranged.
                if block.has("Type")? {
                    find(input, &block, depth + 1, unpacked, grids)?;
                }
                if grids.len() > MOST_GRIDS {
                    return Err(group
                        .source()
                        .place(Error::limit("number of grids", MOST_GRIDS), group.spot()));
                }
            }
        }
        Some(other) => {
            let what = format!("VTKHDF of the type {other} is not read: UnstructuredGrid and PolyData are");
            return Err(group.source().place(Error::unsupported(what), group.spot()));
        }
        None => return Err(group.malformed("the attribute Type", "none of that name")),
    }
    Ok(())
}

/// The counts of the partitions of the first time step.
fn counts(group: &Group<'_>, name: &str, partitions: Option<u64>) -> Result<Vec<u64>> {
    let dataset = group.needed(name)?;
    let mut counts = dataset.integers(MOST_PARTITIONS)?;
    if let Some(partitions) = partitions {
        counts.truncate(usize::try_from(partitions).unwrap_or(usize::MAX));
    }
    if counts.iter().any(|count| *count < 0) {
        return Err(dataset.malformed("counts, 0 or more", "a negative number"));
    }
    Ok(counts.into_iter().map(i64::cast_unsigned).collect())
}

/// Number of partitions of the first time step, where there are several steps.
fn first_step(group: &Group<'_>) -> Result<Option<u64>> {
    let Some(steps) = group.group("Steps")? else { return Ok(None) };
    let Some(parts) = steps.dataset("NumberOfParts")? else { return Ok(Some(1)) };
    Ok(parts.integers(MOST_PARTITIONS)?.first().map(|count| (*count).max(0).cast_unsigned()))
}

impl Grid {
    fn unstructured(input: &Input, group: &Group<'_>, unpacked: &mut Unpacked<'_>) -> Result<Self> {
        let partitions = first_step(group)?;
        let points = counts(group, "NumberOfPoints", partitions)?;
        let types = Kind::Each(group.needed("Types")?.store(input, unpacked)?);
        let cells = vec![CellGroup::find(input, group, partitions, types, unpacked)?];
        Ok(Self { points, coordinates: coordinates(input, group, unpacked)?, cells })
    }

    fn polygonal(input: &Input, group: &Group<'_>, unpacked: &mut Unpacked<'_>) -> Result<Self> {
        let partitions = first_step(group)?;
        let points = counts(group, "NumberOfPoints", partitions)?;
        let mut cells = Vec::new();
        for (name, code) in POLYGONAL {
            if let Some(kind) = group.group(name)? {
                cells.push(CellGroup::find(input, &kind, partitions, Kind::All(code), unpacked)?);
            }
        }
        Ok(Self { points, coordinates: coordinates(input, group, unpacked)?, cells })
    }

    fn outline(self, stores: &Stores, first: &mut First, out: &mut dyn Outline) -> Result<()> {
        let coordinates = stores.array(self.coordinates, "Points")?;
        let mut cells = self.cells.into_iter().map(|cells| cells.open(stores)).collect::<Result<Vec<_>>>()?;
        let mut done = 0;
        for (partition, points) in self.points.into_iter().enumerate() {
            let part = part(stores, &coordinates, 3 * done, points.saturating_mul(3), "Points")?;
            Points { file: stores.file.clone(), coordinates: part }.outline(out)?;
            for group in &mut cells {
                group.outline(partition, points, stores, first, out)?;
            }
            first.point += points;
            done += points;
        }
        Ok(())
    }
}

/// Numbers of the next point and cell within the file.
struct First {
    point: u64,
    cell: u64,
    /// Whether there are several partitions or grids.
    several: bool,
}

fn coordinates(input: &Input, group: &Group<'_>, unpacked: &mut Unpacked<'_>) -> Result<Stored> {
    let points = group.needed("Points")?;
    match points.shape() {
        [_, 3] => points.store(input, unpacked),
        other => Err(points.malformed("Points of the shape n x 3", format!("{other:?}"))),
    }
}

/// The `count` numbers from `start` on, which must be there.
fn part(stores: &Stores, array: &Array, start: u64, count: u64, name: &str) -> Result<Array> {
    let part = array.part(start..start.saturating_add(count));
    if part.len() == count {
        return Ok(part);
    }
    let error =
        Error::malformed(format!("{count} numbers from number {start} on ({name})"), part.len().to_string());
    Err(stores.file.place(error, array.spot(0)))
}

impl CellGroup {
    fn find(
        input: &Input,
        group: &Group<'_>,
        partitions: Option<u64>,
        types: Kind,
        unpacked: &mut Unpacked<'_>,
    ) -> Result<Self> {
        let cells = counts(group, "NumberOfCells", partitions)?;
        let entries = counts(group, "NumberOfConnectivityIds", partitions)?;
        if cells.len() != entries.len() {
            let expected = "as many numbers in NumberOfConnectivityIds as in NumberOfCells";
            return Err(group.malformed(expected, format!("{} and {}", entries.len(), cells.len())));
        }
        let mut array = |name: &str| group.needed(name)?.store(input, unpacked);
        let (connectivity, offsets) = (array("Connectivity")?, array("Offsets")?);
        Ok(Self { counts: cells.into_iter().zip(entries).collect(), connectivity, offsets, types })
    }

    fn open(self, stores: &Stores) -> Result<OpenCells> {
        let types = match self.types {
            Kind::Each(stored) => Types::Each(stores.array(stored, "Types")?),
            Kind::All(code) => Types::All(code),
        };
        let (connectivity, offsets) =
            (stores.array(self.connectivity, "Connectivity")?, stores.array(self.offsets, "Offsets")?);
        Ok(OpenCells { counts: self.counts, connectivity, offsets, types, at: (0, 0) })
    }
}

/// Cells of a grid whose arrays can be read.
struct OpenCells {
    counts: Vec<(u64, u64)>,
    connectivity: Array,
    offsets: Array,
    types: Types,
    /// Cells, and entries of the connectivity, of the partitions before.
    at: (u64, u64),
}

impl OpenCells {
    fn outline(
        &mut self,
        partition: usize,
        points: u64,
        stores: &Stores,
        first: &mut First,
        out: &mut dyn Outline,
    ) -> Result<()> {
        let Some(&(count, entries)) = self.counts.get(partition) else { return Ok(()) };
        let (cells, ids) = self.at;
        self.at = (cells.saturating_add(count), ids.saturating_add(entries));
        if count == 0 {
            return Ok(());
        }
        let connectivity = part(stores, &self.connectivity, ids, entries, "Connectivity")?;
        let offsets = part(stores, &self.offsets, cells + partition as u64, count + 1, "Offsets")?;
        let types = match &self.types {
            Types::Each(types) => Types::Each(part(stores, types, cells, count, "Types")?),
            Types::All(code) => Types::All(*code),
        };
        let (first_cell, first_point) = (first.cell, first.point);
        first.cell += count;
        let lists = Lists::Ends(offsets.without_first());
        let (file, points) = (stores.file.clone(), first.several.then_some(points));
        let (regions, ghosts) = (InRegions::Unknown, None);
        let cells = Cells {
            file,
            connectivity,
            lists,
            types,
            count,
            first_cell,
            first_point,
            points,
            regions,
            ghosts,
        };
        cells.outline(out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::testing::{self, Row, check, own, read_file};
    use crate::mesh::Shape::*;

    const LINEAR: &[(Shape, usize)] =
        &[(Triangle, 2), (Quadrilateral, 2), (Tetrahedron, 2), (Pyramid, 2), (Wedge, 2), (Hexahedron, 2)];
    const TWICE: &[(Shape, usize)] =
        &[(Triangle, 4), (Quadrilateral, 4), (Tetrahedron, 4), (Pyramid, 4), (Wedge, 4), (Hexahedron, 4)];
    const ALL: &[(Shape, usize)] =
        &[(Triangle, 7), (Quadrilateral, 9), (Tetrahedron, 4), (Pyramid, 3), (Wedge, 6), (Hexahedron, 7)];
    const OTHERS: &[(&str, u64)] =
        &[("point", 2), ("line", 5), ("triangle strip", 1), ("polygon", 2), ("polyhedron", 4)];

    #[rustfmt::skip]
    const OWN: &[Row] = &[
        ("vtk_all.vtkhdf", 452, ALL, OTHERS),
        ("vtk_collection.vtkhdf", 110, TWICE, &[]),
        ("vtk_linear.vtkhdf", 55, LINEAR, &[]),
        ("vtk_surface.vtkhdf", 55, &[(Triangle, 22), (Quadrilateral, 22)], &[]),
    ];

    #[test]
    fn own_files_hold_what_vtk_counts() {
        OWN.iter().for_each(|row| drop(check(&VtkHdf, &own("vtkhdf"), row)));
        for (ours, theirs) in
            [("vtk_all.vtkhdf", "all_51_binary.vtk"), ("vtk_linear.vtkhdf", "linear_51_ascii.vtk")]
        {
            let legacy = read_file(&super::super::Legacy, &own("vtk").join(theirs));
            testing::same_elements(&read_file(&VtkHdf, &own("vtkhdf").join(ours)), &legacy, 1e-6);
        }
    }

    #[test]
    fn a_cut_file_is_an_error_and_a_flipped_bit_no_panic() {
        OWN.iter().for_each(|row| testing::damage(&VtkHdf, &own("vtkhdf").join(row.0), <[u8]>::len));
    }
}
