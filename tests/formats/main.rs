//! Every format against real meshes: what others count in them, that the content alone decides which format it is, and
//! that one mesh gives one result whatever it is written in.

#![expect(clippy::disallowed_methods, reason = "small meshes of known size are read whole, to be rewritten")]

mod corpus;
// The page has all formats, so it is held where all are built in.
#[cfg(feature = "hdf5")]
mod document;
mod mixed;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use meshgauge::formats::{FORMATS, HEAD_BYTES};
use meshgauge::mesh::Shape::{self, Hexahedron, Pyramid, Quadrilateral, Tetrahedron, Triangle, Wedge};
use meshgauge::{Options, Summary, score};

type Shapes = &'static [(Shape, u64)];

const PIT: Shapes = &[(Triangle, 382)];
const MIXED: Shapes = &[(Triangle, 28), (Quadrilateral, 36), (Wedge, 28), (Hexahedron, 8)];
/// The faces of that mesh alone.
const FACES: Shapes = &[(Triangle, 28), (Quadrilateral, 36)];
/// Its cells alone.
const SOLIDS: Shapes = &[(Wedge, 28), (Hexahedron, 8)];
/// Bricks joined to tetrahedra by pyramids.
const PYRAMIDS: Shapes = &[(Tetrahedron, 206), (Pyramid, 9), (Hexahedron, 27)];
/// The surface of a block with a pit.
const BLOCK: Shapes = &[(Triangle, 258)];
/// Two of each.
const LINEAR: Shapes =
    &[(Triangle, 2), (Quadrilateral, 2), (Tetrahedron, 2), (Pyramid, 2), (Wedge, 2), (Hexahedron, 2)];
const LINEAR_TWICE: Shapes =
    &[(Triangle, 4), (Quadrilateral, 4), (Tetrahedron, 4), (Pyramid, 4), (Wedge, 4), (Hexahedron, 4)];
const NO_QUADRILATERALS: Shapes =
    &[(Triangle, 2), (Tetrahedron, 2), (Pyramid, 2), (Wedge, 2), (Hexahedron, 2)];
/// Every cell type of VTK.
const ALL: Shapes =
    &[(Triangle, 7), (Quadrilateral, 9), (Tetrahedron, 4), (Pyramid, 3), (Wedge, 6), (Hexahedron, 7)];

/// Bricks and shells of ANSYS, collapsed in every documented way.
const DEGENERATE: Shapes =
    &[(Triangle, 1), (Quadrilateral, 1), (Tetrahedron, 2), (Pyramid, 1), (Wedge, 1), (Hexahedron, 2)];

/// Folders of what other files name.
const PARTS: [&str; 2] = ["blocks", "pieces"];

/// Format, file, nodes, measured elements, elements that no measure is defined for.
const OWN: &[(&str, &str, u64, Shapes, u64)] = &[
    ("abaqus", "gmsh_pit2d_o2.inp", 821, PIT, 56),
    ("comsol", "mixed.mphbin", 54, MIXED, 0),
    ("comsol", "mixed.mphtxt", 54, MIXED, 0),
    ("triangle", "pit2d.1.ele", 220, PIT, 0),
    ("triangle", "square_o2.1.ele", 253, &[(Triangle, 112)], 0),
    ("tetgen", "box.ele", 44, &[(Tetrahedron, 90)], 0),
    ("tetgen", "box_o2.1.ele", 219, &[(Tetrahedron, 90)], 0),
    ("nag", "pit2d.r", 220, PIT, 0),
    ("gmsh", "mixed_hex_prism_41.msh", 54, MIXED, 0),
    ("gmsh", "partition_1_of_2.msh", 77, &[(Triangle, 79), (Tetrahedron, 92)], 22),
    ("gmsh", "partition_2_of_2_bin.msh", 75, &[(Triangle, 77), (Tetrahedron, 92)], 22),
    ("gmsh", "pit2d_22_ascii.msh", 220, PIT, 56),
    ("gmsh", "pit2d_22_bin.msh", 220, PIT, 56),
    ("gmsh", "pit2d_40_ascii.msh", 220, PIT, 56),
    ("gmsh", "pit2d_41_ascii.msh", 220, PIT, 56),
    ("gmsh", "pit2d_41_bin.msh", 220, PIT, 56),
    ("gmsh", "pit2d_41_parametric_bin.msh", 220, PIT, 56),
    ("gmsh", "pit2d_o2_41_ascii.msh", 821, PIT, 56),
    ("medit", "gmsh_box_o2.mesh", 2070, &[(Tetrahedron, 1093)], 0),
    ("medit", "mixed.meshb", 54, MIXED, 0),
    ("netgen", "cube_o2.vol", 122, &[(Triangle, 36), (Tetrahedron, 53)], 48),
    ("netgen", "from_gmsh_mixed.vol", 54, MIXED, 0),
    ("netgen", "square2d_quad.vol", 16, &[(Quadrilateral, 9)], 16),
    ("su2", "gmsh_mixed.su2", 54, MIXED, 0),
    ("ugrid", "mixed.lb8.ugrid", 54, MIXED, 0),
    ("ugrid", "mixed.ugrid", 54, MIXED, 0),
    ("nastran", "gmsh_mixed_free.bdf", 54, MIXED, 0),
    ("nastran", "gmsh_mixed_large.bdf", 54, MIXED, 0),
    ("matlab", "scipy_pit2d_o2_struct.mat", 821, PIT, 0),
    ("matlab", "scipy_pit2d_v4.mat", 220, PIT, 56),
    ("matlab", "v73_pit2d_struct.mat", 220, PIT, 0),
    ("matlab", "scipy_pit2d_pet_compressed.mat", 220, PIT, 56),
    ("obj", "gmsh_pit_block.obj", 131, BLOCK, 0),
    ("obj", "meshio_mixed.obj", 54, FACES, 0),
    ("off", "gmsh_pit_block.off", 131, BLOCK, 0),
    ("ply", "meshio_mixed_ascii.ply", 54, FACES, 0),
    ("ply", "meshio_mixed_little.ply", 54, FACES, 0),
    ("ply", "vtk_mixed_big.ply", 54, FACES, 0),
    ("stl", "gmsh_pit_block.stl", 131, BLOCK, 0),
    ("stl", "gmsh_pit_block_binary.stl", 131, BLOCK, 0),
    ("vtk", "all_42_ascii.vtk", 452, ALL, 14),
    ("vtk", "all_51_binary.vtk", 452, ALL, 14),
    ("vtk", "gmsh_mixed_wedge.vtk", 54, MIXED, 0),
    ("vtk", "linear_42_binary.vtk", 55, LINEAR, 0),
    ("vtk", "linear_51_ascii.vtk", 55, LINEAR, 0),
    ("vtu", "all_raw_lz4.vtu", 452, ALL, 14),
    ("vtu", "linear_ascii.vtu", 55, LINEAR, 0),
    ("vtu", "linear_base64_zlib.vtu", 55, LINEAR, 0),
    ("vtu", "linear_inline_lzma.vtu", 55, LINEAR, 0),
    ("vtu", "linear_inline_none.vtu", 55, LINEAR, 0),
    ("vtu", "linear_raw_none.vtu", 55, LINEAR, 0),
    ("vtu", "blocks.vtm", 55, &[(Triangle, 1), (Quadrilateral, 1), (Hexahedron, 6)], 6),
    ("vtu", "hidden.vts", 36, &[(Hexahedron, 9)], 0),
    ("vtu", "pieces.pvtu", 51, &[(Hexahedron, 10)], 0),
    ("vtu", "planes.vtr", 24, &[(Hexahedron, 6)], 0),
    ("vtu", "surface.vtp", 25, &[(Triangle, 1), (Quadrilateral, 1)], 6),
    ("vtu", "turned.vti", 36, &[(Hexahedron, 12)], 0),
    ("femgv", "two_shapes.neu", 7, &[(Quadrilateral, 1), (Tetrahedron, 1)], 2),
    ("frd", "two_shapes.frd", 9, &[(Tetrahedron, 1), (Hexahedron, 1)], 1),
    ("unv", "gmsh_mixed.unv", 54, MIXED, 0),
    ("unv", "gmsh_pit2d_o2.unv", 821, PIT, 56),
    ("ansys", "degenerate.cdb", 10, DEGENERATE, 2),
    ("lsdyna", "gmsh_mixed.key", 54, MIXED, 0),
    ("openfoam", "axis_ascii", 54, &[(Wedge, 5), (Hexahedron, 15)], 0),
    ("openfoam", "mixed_ascii", 54, SOLIDS, 0),
    ("openfoam", "polyhedra_binary", 882, &[(Hexahedron, 184)], 110),
    ("openfoam", "pyramids_binary", 134, PYRAMIDS, 0),
    ("openfoam", "pyramids_gz", 134, PYRAMIDS, 0),
    ("exodus", "mixed_cdf1.e", 54, MIXED, 0),
    ("exodus", "mixed_cdf2_map.e", 54, MIXED, 0),
    ("exodus", "mixed_cdf5_results.e", 54, MIXED, 0),
    ("exodus", "meshio_mixed.e", 54, MIXED, 0),
    ("exodus", "mixed_hdf5_earliest.e", 54, MIXED, 0),
    ("exodus", "mixed_hdf5_latest.e", 54, MIXED, 0),
    ("exodus", "mixed_netcdf4.e", 54, MIXED, 0),
    ("exodus", "mixed_netcdf4_packed.e", 54, MIXED, 0),
    ("med", "gmsh_mixed.med", 54, MIXED, 0),
    ("med", "gmsh_pit2d.med", 220, PIT, 56),
    ("med", "meshio_mixed.med", 54, MIXED, 0),
    ("cgns", "gmsh_mixed.cgns", 54, MIXED, 0),
    ("cgns", "gmsh_pit2d.cgns", 220, PIT, 56),
    ("cgns", "mixed_sections.cgns", 54, MIXED, 0),
    ("cgns", "two_zones_ngon.cgns", 24, &[(Hexahedron, 4)], 11),
    ("vtkhdf", "vtk_all.vtkhdf", 452, ALL, 14),
    ("vtkhdf", "vtk_collection.vtkhdf", 110, LINEAR_TWICE, 0),
    ("vtkhdf", "vtk_linear.vtkhdf", 55, LINEAR, 0),
    ("vtkhdf", "vtk_surface.vtkhdf", 55, &[(Triangle, 22), (Quadrilateral, 22)], 0),
    ("xdmf", "meshio_mixed_hdf.xdmf", 54, MIXED, 0),
    ("xdmf", "meshio_mixed_xml.xdmf", 54, MIXED, 0),
    ("xdmf", "vtk_solids.xmf", 47, NO_QUADRILATERALS, 0),
];

fn folder(format: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes").join(format)
}

fn options() -> Options {
    Options { threads: 2, run_info: false, ..Options::default() }
}

#[track_caller]
fn summary(path: &Path) -> Summary {
    score(path, &options()).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn every_format_has_real_meshes_with_known_counts() {
    for format in FORMATS {
        let entries =
            fs::read_dir(folder(format.name())).unwrap_or_else(|e| panic!("{}: {e}", format.name()));
        let names = entries.map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned());
        let meshes: BTreeSet<_> = names
            .filter(|name| ![".jsonl", ".node", ".h5"].iter().any(|ending| name.ends_with(ending)))
            .filter(|name| !PARTS.contains(&name.as_str()))
            .collect();
        let rows = OWN.iter().filter(|row| row.0 == format.name());
        assert_eq!(meshes, rows.map(|row| row.1.to_owned()).collect(), "{}", format.name());
        assert!(!meshes.is_empty(), "{}", format.name());
    }
    for (format, name, nodes, measured, others) in OWN {
        let found = summary(&folder(format).join(name));
        assert_eq!((found.mesh.format.as_str(), found.nodes.count), (*format, *nodes), "{name}");
        let shapes: Vec<_> = found.shapes.iter().map(|(shape, found)| (*shape, found.count)).collect();
        assert_eq!(shapes, *measured, "{name}");
        assert_eq!(found.elements.not_measured.values().sum::<u64>(), *others, "{name}");
        let total = measured.iter().map(|row| row.1).sum::<u64>() + others;
        assert_eq!(found.elements.count, total, "{name}");
        assert_eq!(found.elements.by_type.values().sum::<u64>(), total, "{name}");
    }
}

#[test]
fn the_content_decides_whatever_the_name_says() {
    let elsewhere = tempfile::tempdir().expect("a temporary folder");
    for (format, name, nodes, ..) in OWN.iter().filter(|row| !folder(row.0).join(row.1).is_dir()) {
        let bytes = fs::read(folder(format).join(name)).expect("readable");
        // The nodes of these stand in a file of the same name.
        let has_companion = matches!(*format, "triangle" | "tetgen")
            || [".pvtu", ".vtm", "hdf.xdmf"].iter().any(|ending| name.ends_with(ending));
        let wrong_names: &[&str] = if has_companion { &[] } else { &["x.inp", "x.txt", "x.msh.gz", "x"] };
        for wrong in wrong_names {
            let path = elsewhere.path().join(wrong);
            fs::write(&path, &bytes).expect("written");
            let found = summary(&path);
            assert_eq!(
                (found.mesh.format.as_str(), found.nodes.count),
                (*format, *nodes),
                "{name} as {wrong}"
            );
        }
        let head = &bytes[..bytes.len().min(HEAD_BYTES)];
        let takers: Vec<_> = FORMATS.iter().filter(|f| f.detect(head)).map(|f| f.name()).collect();
        assert_eq!(takers, [*format], "{name}");
    }
}
