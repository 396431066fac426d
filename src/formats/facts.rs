//! What a user should know of each format beyond its name: which oddities of real files are handled, what is refused by
//! name, and whose files prove it. `meshgauge formats` and docs/FORMATS.md say the same, from here.

/// The facts of one format.
#[derive(Debug)]
pub struct Facts {
    /// The format's name.
    pub format: &'static str,
    /// Oddities of real files that are handled.
    pub quirks: &'static [&'static str],
    /// What is refused by name.
    pub refused: &'static [&'static str],
    /// Programs and collections whose files were read, with their counts checked.
    pub proof: &'static [&'static str],
}

/// The facts of the format with that name.
pub fn facts(format: &str) -> Option<&'static Facts> {
    FACTS.iter().find(|facts| facts.format == format)
}

static FACTS: &[Facts] = &[
    Facts {
        format: "gmsh",
        quirks: &[
            "node numbers that are sparse or out of order, nodes that no element uses",
            "parametric nodes, sections of other programs, binary files without the line's end after the byte order mark",
            "binary version 2 with one element a block",
            "files of one partition: elements of its neighbours (ghost entities) are left out and counted",
            "elements of up to order 10, by their corners",
        ],
        refused: &[
            "binary MSH 4.0 (Gmsh itself writes none)",
            "element types without a shape are counted by name",
        ],
        proof: &["Gmsh 4.15 in every encoding", "deal.II", "Gmsh's tutorials"],
    },
    Facts {
        format: "abaqus",
        quirks: &[
            "parts with any number of instances, moved and turned; nodes and elements inside an instance; decks with parts and no instance",
            "*SYSTEM, and *NODE in cylindrical and spherical coordinates",
            "*NGEN (lines, arcs), *NFILL, *NCOPY (shift, reflect), *ELGEN and *ELCOPY, with the node and element sets that they name",
            "regions by ELSET= of elements, else by the set of their section, else by the first *ELSET that lists them",
            "*PARAMETER: numbers, arithmetic and functions, put in where their names stand",
            "records over several lines with or without a comma at the end, blanks anywhere, D exponents, comments within data",
            "types by their grammar (C3D8RH, CPE4T, ...), CalculiX's own types, user elements counted by name",
        ],
        refused: &[
            "*NGEN with LINE=P or SYSTEM, *NFILL with BIAS, SINGULAR or TWO STEP, *NCOPY with POLE or MULTIPLE, *ELCOPY with REFLECT",
            "*NMAP, *IMPORT, *PARAMETER SHAPE VARIATION, instances of other analyses",
            "a *PARAMETER that is no plain arithmetic, where it is used",
            "abbreviated keywords that make the mesh, text in UTF-16",
        ],
        proof: &["Abaqus/CAE", "CalculiX test suite", "Cubit", "Gmsh", "pyNastran's models"],
    },
    Facts {
        format: "vtk",
        quirks: &[
            "wedges in the order before and after VTK 9.7: judged by their own majority",
            "offsets of 5.1 and counts before it, METADATA, vtkidtype and vtktypeint64, triangle strips, voxels and pixels",
            "structured, rectilinear and uniform grids: their hexahedra and quadrilaterals; hidden and ghost cells are left out and counted",
        ],
        refused: &["fields without a mesh"],
        proof: &["VTK 9.7", "Gmsh", "MFEM", "meshio", "PyVista's examples", "the crate vtkio"],
    },
    Facts {
        format: "vtu",
        quirks: &[
            "unstructured, polygonal, structured, rectilinear and image data; files that name their pieces or blocks (.pvtu, .vtm, .pvd ...) are one mesh, of several time steps the first",
            "hidden cells, and ghosts of other pieces, are left out and counted",
            "several pieces in a file; header types of 32 and 64 bits; base64 with its header apart; blocks of any size",
            "wedges in the order before and after VTK 9.7: judged by their own majority",
        ],
        refused: &[
            "tables, hyper-tree grids and grids of adaptive refinement, by their type; files outside the mesh's own folder",
        ],
        proof: &["VTK 9.7", "ParaView by MFEM", "meshio", "the crate vtkio"],
    },
    Facts {
        format: "comsol",
        quirks: &[
            "tensor order of quadrilaterals, hexahedra and pyramids; strings with blanks and `#`; selections and several meshes in a file",
            "parameters and up/down blocks of the files of 2008",
        ],
        refused: &["class versions other than 1, 2, 4 and 8"],
        proof: &["COMSOL of 2008 and of today, by deal.II and Elmer"],
    },
    Facts {
        format: "triangle",
        quirks: &["numbers from 0 or 1, attributes, comments; the order of mid-side nodes"],
        refused: &["an .ele file without its .node file"],
        proof: &["Triangle's own examples"],
    },
    Facts {
        format: "tetgen",
        quirks: &["numbers from 0 or 1, attributes, comments; the order of mid-side nodes"],
        refused: &["an .ele file without its .node file"],
        proof: &["TetGen", "pyNastran's models"],
    },
    Facts {
        format: "nag",
        quirks: &["any heading before the mesh; lists that wrap; D exponents"],
        refused: &["numbers after the mesh that are no boundary edges"],
        proof: &["written after the data files of NAG's examples: none is public"],
    },
    Facts {
        format: "medit",
        quirks: &[
            "elements of kinds that are not known are counted by their keyword",
            "keywords in any order and of any kind; a file without End, if no table is cut",
            "second order under the names of the first, as Gmsh writes it",
        ],
        refused: &["orders of nodes by an Ordering keyword", "versions over 4"],
        proof: &["Gmsh", "refine (NASA)", "meshio's tests"],
    },
    Facts {
        format: "su2",
        quirks: &[
            "elements before points, several zones, trailing numbers of rows, periodic and send/receive markers",
        ],
        refused: &[],
        proof: &["SU2's NACA 0012", "Gmsh", "meshio's tests"],
    },
    Facts {
        format: "netgen",
        quirks: &[
            "cells stored the other way round; rows of several orders in one table; face descriptors; what stands after endmesh",
        ],
        refused: &[],
        proof: &["Netgen 6.2", "Gmsh", "meshio"],
    },
    Facts {
        format: "ugrid",
        quirks: &[
            "the variant is told by the size that the counts ask for, not by the name; Fortran records",
        ],
        refused: &[],
        proof: &["pyNastran's models", "meshio's tests"],
    },
    Facts {
        format: "nastran",
        quirks: &[
            "small, large and free field side by side; continuations by name, sign, comma or blank; tabs; 1.5-3",
            "elements before grids; chained CORD1x and CORD2x systems; GRDSET; replication; blank mid-side nodes; no BEGIN BULK, no ENDDATA",
        ],
        refused: &[
            "includes that lead out of the folder or through variables; superelement sections; continuations out of order",
        ],
        proof: &["MSC and NX decks of pyNastran's models", "Autodesk", "Gmsh", "meshio's tests"],
    },
    Facts {
        format: "matlab",
        quirks: &[
            "numbers stored in smaller types than their class; rows or columns; structures and cells; which arrays are meant by name, then by shape",
        ],
        refused: &["objects (FEMesh), and files where the choice is not plain: the arrays are listed"],
        proof: &["pdetool", "SciPy"],
    },
    Facts {
        format: "off",
        quirks: &["the keyword may be missing; counts on its line; CR LF; colours after a face"],
        refused: &["4OFF, nOFF and binary OFF"],
        proof: &["Elmer's samples", "Gmsh"],
    },
    Facts {
        format: "ply",
        quirks: &["elements and properties in any order and of any type"],
        refused: &["triangle strips"],
        proof: &["Stanford's bunny, by meshio", "VTK", "Elmer's samples"],
    },
    Facts {
        format: "stl",
        quirks: &["equal corners become one node; binary files that begin with `solid`; several solids"],
        refused: &[],
        proof: &["Gmsh"],
    },
    Facts {
        format: "obj",
        quirks: &["negative numbers, continuations, colours after a vertex; polygons are counted"],
        refused: &[],
        proof: &["pyNastran's models", "meshio's tests"],
    },
    Facts {
        format: "frd",
        quirks: &["numbers that touch; sparse numbers; results after the mesh are not looked at"],
        refused: &["binary results"],
        proof: &["CalculiX reference results"],
    },
    Facts {
        format: "femgv",
        quirks: &[
            "numbers of 5 and 10 digits that touch; types by CalculiX's numbers, held against the count of nodes",
        ],
        refused: &[],
        proof: &["written after the FORTRAN formats of the FEMGV manual: no file is public"],
    },
    Facts {
        format: "unv",
        quirks: &[
            "columns that touch, D exponents, the extra record of beams, text between datasets, units that are not applied",
        ],
        refused: &["binary datasets (58b)"],
        proof: &["SALOME", "deal.II", "Gmsh"],
    },
    Facts {
        format: "ansys",
        quirks: &[
            "column widths by the FORTRAN format of the block; trailing zeros left out; degenerate bricks and shells",
            "SOLID187 with four nodes; contact, line and mass elements counted by name",
        ],
        refused: &["compact EBLOCKs"],
        proof: &["mapdl-archive's examples"],
    },
    Facts {
        format: "lsdyna",
        quirks: &[
            "fixed columns that touch, LONG=S, commas, options with cards of their own; degenerate bricks; no *KEYWORD",
        ],
        refused: &["includes that move their nodes, and keywords that make nodes or elements"],
        proof: &["PyDyna's tests", "Gmsh"],
    },
    Facts {
        format: "openfoam",
        quirks: &[
            "a case, its polyMesh folder, a region's folder, any of the four files or a .foam file names the mesh",
            "old faces one by one and new compact ones; no arch; neighbours of -1; uniform lists; files packed one by one",
            "cells as checkMesh classes them: hexahedra, prisms, pyramids, tetrahedra; wedges, tetWedges and polyhedra are counted",
        ],
        refused: &["decomposed cases (reconstruct them, or score a processor's folder)"],
        proof: &["OpenFOAM 1912: blockMesh, gmshToFoam, polyDualMesh and its tutorials", "CalculiX GraphiX"],
    },
    Facts {
        format: "exodus",
        quirks: &[
            "element types in free words and any case; coordinates in one array or three; results after the mesh",
        ],
        refused: &[],
        proof: &["Cubit by MFEM", "deal.II", "meshio"],
    },
    Facts {
        format: "med",
        quirks: &[
            "cells stored the other way round, or not; arrays component by component; files before version 3, without time steps",
        ],
        refused: &["structured meshes, versions other than 2, 3 and 4"],
        proof: &["Gmsh, old and new", "meshio's tests"],
    },
    Facts {
        format: "cgns",
        quirks: &["several zones and sections, mixed sections with and without offsets; structured zones"],
        refused: &["files of the ADF kind: convert them by adf2hdf"],
        proof: &["Gmsh"],
    },
    Facts {
        format: "vtkhdf",
        quirks: &["partitions, each with numbers of its own; collections; the first of several time steps"],
        refused: &["image and hierarchical data, by their type"],
        proof: &["VTK 9.7"],
    },
    Facts {
        format: "xdmf",
        quirks: &[
            "numbers in the file, in HDF5 or in binary files beside it; mixed topologies; the first of several time steps",
            "structured, rectilinear and uniform grids; time steps that fetch their mesh by XInclude",
        ],
        refused: &["functions, references, hyperslabs and parts of datasets"],
        proof: &["meshio"],
    },
];
