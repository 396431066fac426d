//! What scoring whole collections of files told (`tests/sweep`); docs/FORMATS.md says the same, from here.

/// Collections of files that a whole sweep scored: what they are, files, scored, and why the others were not.
pub static SWEEPS: &[(&str, u32, u32, &str)] = &[
    (
        "CalculiX 2.11 test suite, decks (Debian calculix-ccx-test)",
        355,
        350,
        "3 decks whose bricks list ten nodes, of which the solver drops two; 1 restart without a mesh; 1 that begins with a stray `>`",
    ),
    ("its reference results, `.frd`", 52, 52, ""),
    (
        "examples of CalculiX GraphiX (Debian calculix-cgx-examples)",
        28,
        3,
        "16 scripts of cgx; 9 decks that include what those scripts make",
    ),
    ("meshes of meshio's tests (PyPI meshio 5.3.5, source)", 45, 40, "3 Tecplot files; 2 grids of FLAC3D"),
    ("examples of PyVista", 8, 8, ""),
    ("examples of mapdl-archive", 4, 4, ""),
    ("Triangle's examples (PyPI triangle)", 40, 20, "20 `.poly` boundaries, yet to be meshed"),
    ("Gmsh's tutorials (Debian gmsh-doc), but for geometry", 9, 9, ""),
    ("polyMesh folders of OpenFOAM 1912's tutorials (Debian openfoam-examples)", 6, 6, ""),
    (
        "15 of those tutorials, spread over all, by blockMesh: classes of cells and volumes are those of checkMesh",
        15,
        15,
        "",
    ),
];
