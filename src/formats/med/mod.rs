//! MED, the format of Salome and Code_Aster: an HDF5 file with a group for each mesh.
//!
//! `ENS_MAA/MESH/NOE/COO` holds the coordinates and `ENS_MAA/MESH/MAI/TYPE/NOD` the nodes of each type's elements, component
//! by component: all first nodes, then all second ones. Since version 3 a time step stands between the mesh and these.
//! MED lists the nodes of solids the other way round than most formats do, and not all writers follow: corners are kept
//! as they stand.

mod families;
#[cfg(test)]
mod tests;
mod types;

use std::collections::HashMap;
use std::sync::Arc;

use crate::error::{Error, Result};
use crate::formats::array::elements::{Elements, Labels, NodeRange, UsedNodes};
use crate::formats::array::nodes::Coordinates;
use crate::formats::array::regions::{InRegions, Keys};
use crate::formats::array::table::Table;
use crate::formats::array::{Stored, Stores, Unpacked};
use crate::formats::hdf5::{self, Dataset, Group, Hdf5};
use crate::formats::{Format, HEAD_BYTES, Outline};
use crate::input::Input;
use crate::mesh::ElementType;

/// The group of all meshes.
const MESHES: &str = "ENS_MAA";
/// The group of the version.
const VERSION: &str = "INFOS_GENERALES";

/// The format's row in the table of formats.
pub(super) struct Med;

impl Format for Med {
    fn name(&self) -> &'static str {
        "med"
    }

    fn title(&self) -> &'static str {
        "MED of Salome and Code_Aster, versions 2, 3 and 4"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["med", "mmed", "rmed"]
    }

    fn looks_for(&self) -> &'static str {
        "an HDF5 file with the group ENS_MAA"
    }

    fn detect(&self, head: &[u8]) -> bool {
        hdf5::detect(head) && memchr::memmem::find(head, MESHES.as_bytes()).is_some()
    }

    fn knows(&self, input: &Input) -> bool {
        let head = input.source.peek(0..HEAD_BYTES as u64);
        let has_meshes = |file: Hdf5| Ok(file.root()?.group(MESHES)?.is_some());
        self.detect(head) || hdf5::detect(head) && Hdf5::open(input).and_then(has_meshes).unwrap_or(false)
    }

    fn regions(&self) -> Option<&'static str> {
        Some("groups, or families without groups")
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        let file = Hdf5::open(input)?;
        let root = file.root()?;
        check_version(&root)?;
        let Some(all) = root.group(MESHES)? else {
            return Err(root.malformed(format!("the group {MESHES}"), "none of that name"));
        };
        let mut unpacked = Unpacked::new(input);
        let groups = all.groups()?;
        let mut meshes = Vec::new();
        for mesh in &groups {
            let families = Arc::new(families::names(&root, mesh.name())?);
            meshes.push(Mesh { families, ..Mesh::find(input, mesh, &mut unpacked)? });
        }
        if meshes.is_empty() {
            return Err(all.malformed("a mesh", "none"));
        }
        let stores = unpacked.finish()?;
        let (mut first_node, mut first_element, several) = (1, 1, meshes.len() > 1);
        for mesh in meshes {
            let (nodes, elements) = (mesh.nodes, mesh.element_count());
            mesh.outline(&stores, first_node, first_element, several, out)?;
            first_node += nodes;
            first_element += elements;
        }
        Ok(())
    }
}

fn check_version(root: &Group<'_>) -> Result<()> {
    let Some(version) = root.group(VERSION)? else { return Ok(()) };
    match version.integer("MAJ")? {
        Some(2..=4) | None => Ok(()),
        Some(other) => {
            let error = Error::unsupported(format!("MED of version {other} is not read (2, 3 and 4 are)"));
            Err(root.source().place(error, version.spot()))
        }
    }
}

/// A mesh of the file.
struct Mesh {
    nodes: u64,
    axes: usize,
    coordinates: Stored,
    blocks: Vec<Block>,
    /// What the user calls the families of elements.
    families: Arc<HashMap<u64, String>>,
}

/// Elements of one type.
struct Block {
    kind: Arc<ElementType>,
    count: u64,
    nodes: Stored,
    labels: Option<Stored>,
    families: Option<Stored>,
}

impl Mesh {
    fn find(input: &Input, mesh: &Group<'_>, unpacked: &mut Unpacked<'_>) -> Result<Self> {
        if mesh.integer("TYP")?.is_some_and(|kind| kind != 0) {
            return Err(refused(mesh, "a structured mesh"));
        }
        let step = step(mesh)?;
        let Some(nodes) = step.group("NOE")? else {
            return Err(step.malformed("the group NOE of nodes", "none of that name"));
        };
        let coordinates = nodes.needed("COO")?;
        let is_cartesian = |value: Option<i64>| value.unwrap_or(0) == 0;
        if !(is_cartesian(mesh.integer("REP")?) && is_cartesian(coordinates.integer("REP"))) {
            return Err(refused(mesh, "a mesh in cylindrical or spherical coordinates"));
        }
        let (count, axes) = shape(&coordinates)?;
        if axes > 3 {
            return Err(coordinates.malformed("1 to 3 coordinates for each node", format!("{axes}")));
        }
        let mut blocks = Vec::new();
        for group in step.group("MAI")?.map_or(Ok(Vec::new()), |group| group.groups())? {
            blocks.extend(Block::find(input, &group, unpacked)?);
        }
        let coordinates = coordinates.store(input, unpacked)?;
        Ok(Self { nodes: count, axes, coordinates, blocks, families: Arc::default() })
    }

    fn element_count(&self) -> u64 {
        self.blocks.iter().map(|block| block.count).sum()
    }

    fn outline(
        self,
        stores: &Stores,
        first_node: u64,
        first_element: u64,
        several: bool,
        out: &mut dyn Outline,
    ) -> Result<()> {
        let file = Arc::clone(&stores.file);
        let table = Table::striped(&stores.array(self.coordinates, "COO")?, self.axes);
        Coordinates { file: Arc::clone(&file), table, first: first_node }.outline(out)?;
        let within = several.then_some((1, self.nodes));
        let range = NodeRange { offset: first_node - 1, within };
        let mut first = first_element;
        for Block { kind, count, nodes, labels, families } in self.blocks {
            let (nodes, file) = (stores.array(nodes, "NOD")?, Arc::clone(&file));
            if kind.nodes == 0 {
                out.count(&kind, count)?;
                UsedNodes { file, nodes, range }.outline(out)?;
            } else {
                let labels = match labels {
                    Some(stored) => Labels::Listed(stores.array(stored, "NUM")?),
                    None => Labels::From(first),
                };
                let nodes = Table::striped(&nodes, kind.nodes);
                let regions = match families {
                    None => InRegions::Unknown,
                    Some(stored) => {
                        let (keys, names) = (stores.array(stored, "FAM")?, Arc::clone(&self.families));
                        InRegions::Keyed(Keys { keys, names })
                    }
                };
                Elements { file, kind, nodes, labels, range, regions }.outline(out)?;
            }
            first += count;
        }
        Ok(())
    }
}

fn refused(mesh: &Group<'_>, what: &str) -> Error {
    let error = Error::unsupported(format!("{what} ({}) is not read", mesh.name()));
    mesh.source().place(error, mesh.spot())
}

/// The group that holds nodes and elements: the mesh itself before version 3, its first time step since.
fn step<'f>(mesh: &Group<'f>) -> Result<Group<'f>> {
    if mesh.group("NOE")?.is_some() {
        return Ok(mesh.clone());
    }
    let mut steps = mesh.groups()?;
    steps.sort_by(|a, b| a.name().cmp(b.name()));
    for step in steps {
        if step.group("NOE")?.is_some() {
            return Ok(step);
        }
    }
    Err(mesh.malformed("the group NOE of nodes", "none of that name"))
}

/// Number of records, and of numbers in each. The first component of all records stands first.
fn shape(dataset: &Dataset<'_>) -> Result<(u64, usize)> {
    let (len, count) = (dataset.len(), dataset.integer("NBR").map_or(0, i64::cast_unsigned));
    if count == 0 && len == 0 {
        return Ok((0, 1));
    }
    if count == 0 || !len.is_multiple_of(count) || len < count || len / count > 64 {
        let expected = format!("{} of NBR records of equal width", dataset.name());
        return Err(dataset.malformed(expected, format!("{len} numbers, NBR {count}")));
    }
    Ok((count, (len / count) as usize))
}

impl Block {
    fn find(input: &Input, group: &Group<'_>, unpacked: &mut Unpacked<'_>) -> Result<Option<Self>> {
        let nodes = group.needed("NOD")?;
        let Some(kind) = types::find(group.name()) else {
            return Self::lists(input, group, &nodes, unpacked);
        };
        let (count, width) = shape(&nodes)?;
        if count == 0 {
            return Ok(None);
        }
        if width != kind.nodes {
            let expected = format!("{} nodes for an element of the type {}", kind.nodes, kind.name);
            return Err(nodes.malformed(expected, format!("{width}")));
        }
        let labels = match group.dataset("NUM")? {
            Some(labels) if labels.len() == count => Some(labels.store(input, unpacked)?),
            _ => None,
        };
        let families = match group.dataset("FAM")? {
            Some(families) if families.len() == count => Some(families.store(input, unpacked)?),
            _ => None,
        };
        let (kind, nodes) = (Arc::clone(kind), nodes.store(input, unpacked)?);
        Ok(Some(Self { kind, count, nodes, labels, families }))
    }

    /// Polygons and polyhedra, whose lists have any length, and types that are not known.
    fn lists(
        input: &Input,
        group: &Group<'_>,
        nodes: &Dataset<'_>,
        unpacked: &mut Unpacked<'_>,
    ) -> Result<Option<Self>> {
        // An index has one entry more than there are elements; of polyhedra the one of faces has more still.
        let mut count: Option<u64> = None;
        for index in ["INN", "IFN"] {
            if let Some(index) = group.dataset(index)? {
                let found = index.len().saturating_sub(1);
                count = Some(count.map_or(found, |count| count.min(found)));
            }
        }
        let count = match count {
            Some(count) => count,
            None => shape(nodes)?.0,
        };
        let kind = Arc::new(types::of_lists(group.name()));
        let nodes = nodes.store(input, unpacked)?;
        Ok(Some(Self { kind, count, nodes, labels: None, families: None }))
    }
}
