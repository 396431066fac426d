//! What all targets do: score the bytes as a mesh of one format of a family.

use meshgauge::{Options, score_reader};

/// Scores all but the first byte as the format of `family` that the first byte chooses.
pub fn score_one_of(family: &[&str], data: &[u8]) {
    let Some((choice, mesh)) = data.split_first() else { return };
    let format = family[usize::from(*choice) % family.len()];
    let mut options = Options { threads: 1, run_info: false, memory: 16 << 20, ..Options::default() };
    options.format = Some(format.to_owned());
    options.limits.unpacked_bytes = 64 << 20;
    options.scratch_bytes = 256 << 20;
    // An error is as good as a summary; what must not be is a panic, a hang, or memory without end.
    let _ = score_reader("fuzzed", mesh, &options);
}

/// Solver decks: cards and keywords.
pub const DECKS: &[&str] = &["abaqus", "nastran", "lsdyna", "ansys", "unv", "femgv", "frd"];
/// Tables with counts, as mesh generators write them.
pub const TABLES: &[&str] = &["gmsh", "comsol", "medit", "su2", "netgen", "ugrid", "nag"];
/// Surfaces and VTK's files.
pub const SURFACES: &[&str] = &["vtk", "vtu", "off", "ply", "stl", "obj"];
/// Containers of named arrays.
pub const CONTAINERS: &[&str] = &["matlab", "exodus", "med", "cgns", "vtkhdf", "xdmf"];
