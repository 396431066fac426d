//! Cell data that say something of the mesh: which cells are another piece's or hidden, and which region each is in.

/// Marks of `vtkGhostType`: a copy of another piece's cell, a cell that finer ones replace, a hidden cell.
const HIDDEN: u64 = 1 | 8 | 32;

/// Names of cell data that say which region a cell is in, as writers call them, in small letters; better known ones first.
static REGIONS: &[&str] = &[
    "gmsh:physical",
    "medit:ref",
    "materialids",
    "materialid",
    "material_ids",
    "material_id",
    "material",
    "mat",
    "elementblockids",
    "blockid",
    "block_id",
    "objectid",
    "regionid",
    "region_id",
    "region",
    "regions",
    "domain",
    "domainid",
    "subdomain",
    "subdomain_id",
    "partid",
    "part_id",
    "groupids",
    "cell_tags",
    "attribute",
    "cellentityids",
];

/// The bits of the array of that name that say that a cell is left out.
pub(super) fn hidden(name: &str) -> Option<u64> {
    match name {
        "vtkGhostType" => Some(HIDDEN),
        // Before VTK 7: how many layers beyond its own cells a piece has it.
        "vtkGhostLevels" => Some(u64::MAX),
        _ => None,
    }
}

/// How well the array of that name is known to say which region a cell is in: the lower, the better.
pub(super) fn region(name: &str) -> Option<usize> {
    let name = name.to_ascii_lowercase();
    REGIONS.iter().position(|known| *known == name)
}
