//! Meshes of other people, which may not be copied: counts of other readers, or a refusal that names its reason.

use std::fs;
use std::path::{Path, PathBuf};

use meshgauge::error::{Error, Kind};
use meshgauge::formats::FORMATS;
use meshgauge::score;

use crate::options;

/// The folder of the corpus, or nothing, said aloud.
pub fn corpus() -> Option<PathBuf> {
    let folder = std::env::var_os("MESHGAUGE_CORPUS").map(PathBuf::from);
    if folder.is_none() {
        eprintln!("skipped: MESHGAUGE_CORPUS names no folder");
    }
    folder
}

/// Where the manifest counts otherwise than a mesh has it: nodes, elements.
const COUNTED_OTHERWISE: &[(&str, u64, u64)] = &[
    // Parts are in the file once, and in the assembly as often as they have instances.
    ("abaqus/cae_multi_instance_rivet.inp", 808, 421),
    ("compressed/rivet_two_members.inp.gz", 808, 421),
    // Its reader leaves out four points.
    ("gmsh/gmsh_hybrid_part.msh", 401, 804),
    // Edge segments, point elements and surface elements count too.
    ("netgen/cube.vol", 26, 137),
    ("netgen/cube_o2.vol", 122, 137),
    ("netgen/cube_o2.vol.gz", 122, 137),
    ("netgen/from_gmsh_mixed.vol", 54, 100),
    ("netgen/square2d_quad.vol", 16, 25),
    // Springs, masses, rigid elements and those for plots are elements too.
    ("nastran/cp_cylindrical_a101x.dat", 59, 45),
    ("nastran/elements_first_cquadr_cqrcc128a.bdf", 54, 10),
    ("nastran/freefield_axisym.bdf", 17, 8),
    ("nastran/hex_penta_ac10901a.bdf", 60, 35),
    ("nastran/mixed_cp_randvar2.bdf", 147, 50),
    ("nastran/mixed_thermal_elements2.bdf", 40, 40),
    // Told in words: 27 nodes, 6 tet10; 74 nodes, 29 triangles of 6.
    ("tetgen/synthetic_cube_o2.ele", 27, 6),
    ("triangle/synthetic_sq_o2.ele", 74, 29),
    // Its edges and vertices are elements too.
    ("comsol/synthetic_busbar.mphbin", 232, 1377),
    // The original's boundary elements are in the packed file too.
    ("compressed/mesh_1.mphtxt.zst", 1204, 6774),
    // Told as points, faces and cells.
    ("openfoam/couette/polyMesh/faces", 410, 160),
    // Gmsh leaves lines and points out of its decks.
    ("lsdyna/gmsh_mixed.key", 54, 100),
    // Nine groups, of which seven are of edges.
    ("matlab/hageman_metal_electrolyte_cells.mat", 6081, 3260),
    // 56 edges come with the triangles.
    ("matlab/synthetic_pit2d_v5_compressed.mat", 220, 438),
    ("matlab/synthetic_pit2d_v4.mat", 220, 438),
    ("matlab/synthetic_pit2d_v73.mat", 220, 438),
    // Its points are elements too.
    ("med/gmsh_level_old.med", 1393, 2788),
];

/// What a mesh of a format that is read is refused for.
const REFUSED: &[(&str, &str)] = &[
    ("lsdyna/pydyna_include_bird_B.k", "included file \"control_cards.k\""),
    // What a deck includes: data lines without a keyword.
    ("abaqus/synthetic_torture/nodes_b.inp", "expected a mesh of a known format"),
    ("nastran/include_mode_solid_shell_bar.bdf", "included file \"geom.inc\""),
    ("cgns/gmsh_tut21.cgns", "ADF container is not read"),
    ("vtu/vtkio_hexahedron_parallel.pvtu", "included file \"hexahedron_parallel_0.vtu\""),
];

/// Known formats among what is no mesh: a file that its writer did not end.
const HALF_WRITTEN: &[&str] = &["decoys/truncated_gmsh_crash_4096B.mesh"];

fn files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for path in fs::read_dir(folder).expect("a folder of the corpus").map(|e| e.expect("an entry").path()) {
        if path.is_dir() { files.extend(self::files(&path)) } else { files.push(path) }
    }
    files.sort();
    files
}

/// Nodes and elements of a row: `220 n; line:56 triangle:382`, `expected 20 n; ...`, `54 n; 100 cells`.
fn counts(cell: &str) -> Option<(u64, u64)> {
    let (nodes, elements) = cell.trim_start_matches("expected ").split_once(" n; ")?;
    let after_colon = |word: &str| word.rsplit_once(':').and_then(|(_, count)| count.parse::<u64>().ok());
    let listed: u64 = elements.split_whitespace().filter_map(after_colon).sum();
    let told = elements.split_whitespace().next().and_then(|word| word.parse().ok());
    Some((nodes.parse().ok()?, told.unwrap_or(listed)))
}

/// Whether a file's folder is that of a format: `unv/`, `femgv_frd/`.
fn is_of_known_format(name: &str) -> bool {
    let folder = name.split(['/', '_']).next();
    FORMATS.iter().any(|format| folder == Some(format.name()))
}

fn is_unknown(error: &Error) -> bool {
    matches!(error.kind(), Kind::UnknownFormat(text) if FORMATS.iter().all(|f| text.contains(f.name())))
}

#[test]
fn meshes_of_known_formats_have_the_counts_of_the_manifest() {
    let Some(corpus) = corpus() else { return };
    let manifest = fs::read_to_string(corpus.join("MANIFEST.md")).expect("the manifest");
    let mut scored = 0;
    let mut wrong = Vec::new();
    for row in manifest.lines().filter(|line| line.starts_with("| ")) {
        let cells: Vec<_> = row.split(" | ").map(str::trim).collect();
        let name = cells[0].trim_start_matches("| ");
        if !(is_of_known_format(name) || name.starts_with("compressed/")) {
            continue;
        }
        match (score(&corpus.join(name), &options()), REFUSED.iter().find(|row| row.0 == name)) {
            (Err(error), Some((_, reason))) => assert!(error.to_string().contains(reason), "{error}"),
            (Err(error), None) => wrong.push(error.to_string()),
            (Ok(_), Some((_, reason))) => panic!("{name}: scored, not refused: {reason}"),
            (Ok(summary), None) => {
                let other = COUNTED_OTHERWISE.iter().find(|row| row.0 == name).map(|row| (row.1, row.2));
                let expected = other.or_else(|| counts(cells[2]));
                let found = (summary.nodes.count, summary.elements.count);
                if Some(found) != expected {
                    wrong.push(format!("{name}: {found:?}, not {expected:?}"));
                }
                scored += 1;
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(scored >= 70, "{scored}");
}

#[test]
fn whatever_else_is_no_mesh_of_a_known_format() {
    let Some(corpus) = corpus() else { return };
    let mut refused = 0;
    for file in files(&corpus) {
        let name = file.strip_prefix(&corpus).expect("it was found there").to_string_lossy().into_owned();
        if is_of_known_format(&name) || name.starts_with("compressed/") {
            continue;
        }
        match score(&file, &options()) {
            Err(error) if is_unknown(&error) => refused += 1,
            Err(error) if HALF_WRITTEN.contains(&name.as_str()) => {
                assert!(matches!(error.kind(), Kind::Malformed { .. }), "{error}");
            }
            Err(error) => panic!("{name}: refused for another reason: {error}"),
            Ok(summary) => panic!("{name}: taken for {}", summary.mesh.format),
        }
    }
    assert!(refused >= 7, "{refused}");
}
