"""Writes one mesh after another with the writers of Gmsh, VTK and meshio, in every encoding that they have.

Each case is a file and the mesh that stood in the writer's memory.
"""
import bz2
import gzip
import itertools
import lzma
from dataclasses import dataclass, replace
from pathlib import Path

import gmsh
import meshio
import numpy as np
import vtk
import zstandard
from meshio._mesh import topological_dimension
from meshio._vtk_common import meshio_to_vtk_order, meshio_to_vtk_type
from meshio.abaqus._abaqus import meshio_to_abaqus_type
from meshio.exodus._exodus import meshio_to_exodus_type
from meshio.gmsh import meshio_to_gmsh_type
from meshio.med._med import meshio_to_med_type
from meshio.xdmf.common import meshio_to_xdmf_type
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

import models
from models import capture, cell_name, in_digits, in_single, only, session, vtk_ordered
from reference import SOLIDS, Block, Mesh


@dataclass
class Case:
    """A file, and what it holds."""
    path: Path
    mesh: Mesh


# --- Gmsh ------------------------------------------------------------------------------------------------------------

MSH = {"22": (2.2, False), "22-binary": (2.2, True), "40": (4.0, False),
       "41": (4.1, False), "41-binary": (4.1, True)}


def write_msh(path, version, binary):
    gmsh.option.setNumber("Mesh.MshFileVersion", version)
    gmsh.option.setNumber("Mesh.Binary", binary)
    gmsh.write(str(path))
    gmsh.option.setNumber("Mesh.Binary", 0)


def all_msh(folder, name, mesh, versions=MSH):
    for version in versions:
        path = folder / f"gmsh-{name}-{version}.msh"
        write_msh(path, *MSH[version])
        yield Case(path, renumbered(path, mesh) if version.startswith("22") else mesh)


def renumbered(path, mesh):
    """MSH 2.2 numbers the elements anew, and leaves out what lies between the parts of a partition: Gmsh reads it back."""
    model = gmsh.model.getCurrent()
    gmsh.option.setNumber("Mesh.PartitionCreateTopology", 0)
    gmsh.open(str(path))
    gmsh.option.setNumber("Mesh.PartitionCreateTopology", 1)
    found = capture()
    gmsh.model.remove()
    gmsh.model.setCurrent(model)
    assert len(found.points) == len(mesh.points), path
    for name, shape in found.shapes.items():
        if (name in SOLIDS) == (mesh.dimension == 3):
            whole = mesh.shapes[name]
            assert shape.count == whole.count and abs(shape.extent / whole.extent - 1) < 1e-13, path
    return found


def inp(folder, name, mesh):
    """Gmsh's Abaqus deck has 14 digits, no points, and nothing for the complete second-order cells."""
    path = folder / f"gmsh-{name}.inp"
    gmsh.write(str(path))
    yield Case(path, in_digits(only(mesh, lambda b: b.nodes.shape[1] not in (1, 14, 18, 27)), 14))


GMSH_MODELS = {
    "pit": lambda: models.pit_plate(0.05),
    "quads": lambda: models.pit_plate(0.06, recombine=True),
    "specimen": lambda: models.specimen(0.15),
    "extruded": models.extruded_plate,
    "transition": models.transition,
    "shell": models.shell,
}


def from_gmsh(folder, keep):
    """Every model at first and second order; `keep` takes the meshes for the other writers."""
    for name, make in GMSH_MODELS.items():
        with session():
            make()
            mesh = keep[name] = capture()
            yield from all_msh(folder, name, mesh)
            yield from inp(folder, name, mesh)
            gmsh.model.mesh.setOrder(2)
            keep[f"{name}-complete"] = capture()
            yield from all_msh(folder, f"{name}-complete", keep[f"{name}-complete"])
        with session():
            gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 1)
            make()
            gmsh.model.mesh.setOrder(2)
            mesh = keep[f"{name}-2"] = capture()
            yield from all_msh(folder, f"{name}-2", mesh)
            yield from inp(folder, f"{name}-2", mesh)
    yield from gmsh_features(folder, keep)


def gmsh_features(folder, keep):
    with session():
        models.specimen(0.055)
        keep["large"] = capture()
        yield from all_msh(folder, "large", keep["large"], ["22-binary", "41", "41-binary"])
    with session():
        models.specimen(0.2)
        gmsh.model.mesh.setOrder(4)
        yield from all_msh(folder, "order-4", capture())
    with session():
        models.specimen(0.2)
        models.scatter_numbers(5)
        mesh = capture()
        yield from all_msh(folder, "scattered", mesh)
        yield from inp(folder, "scattered", mesh)
        gmsh.option.setNumber("Mesh.SaveParametric", 1)
        yield from all_msh(folder, "parametric", mesh)
    with session():
        models.specimen(0.2)
        (_, volume), = gmsh.model.getEntities(3)
        gmsh.model.addPhysicalGroup(3, [volume], 40, "the \"steel\" part")
        yield from all_msh(folder, "physical", capture(lambda dimension, entity: dimension == 3))
    for make, ghosts in itertools.product(("specimen", "quads"), (0, 1)):
        with session():
            gmsh.option.setNumber("Mesh.PartitionCreateGhostCells", ghosts)
            GMSH_MODELS[make]()
            gmsh.model.mesh.partition(4)
            kind = "ghosts" if ghosts else "parts"
            yield from all_msh(folder, f"{make}-{kind}", capture())


# --- VTK -------------------------------------------------------------------------------------------------------------

VTK_CODE = {"vertex": 1, "line": 3, "line3": 21, "triangle": 5, "triangle6": 22, "quad": 9, "quad8": 23, "quad9": 28,
            "tetra": 10, "tetra10": 24, "hexahedron": 12, "hexahedron20": 25, "hexahedron27": 29, "wedge": 13,
            "wedge15": 26, "pyramid": 14, "pyramid13": 27}


def vtk_points(points, single=False):
    found = vtk.vtkPoints()
    found.SetData(numpy_to_vtk(points.astype(np.float32 if single else np.float64), deep=True))
    return found


def vtk_grid(mesh, single=False, code=lambda b: VTK_CODE[cell_name(b)]):
    """An unstructured grid with arrays on points and cells, as results have."""
    grid = vtk.vtkUnstructuredGrid()
    grid.SetPoints(vtk_points(mesh.points, single))
    sizes = np.concatenate([np.full(len(b.nodes), b.nodes.shape[1]) for b in mesh.blocks])
    offsets = numpy_to_vtkIdTypeArray(np.concatenate([[0], sizes.cumsum()]), deep=True)
    nodes = numpy_to_vtkIdTypeArray(np.concatenate([b.nodes.ravel() for b in mesh.blocks]), deep=True)
    cells = vtk.vtkCellArray()
    cells.SetData(offsets, nodes)
    types = np.concatenate([np.full(len(b.nodes), code(b), np.uint8) for b in mesh.blocks])
    grid.SetCells(numpy_to_vtk(types, deep=True), cells)
    temperature = numpy_to_vtk(mesh.points[:, 0] ** 2, deep=True)
    temperature.SetName("temperature")
    grid.GetPointData().SetScalars(temperature)
    material = numpy_to_vtk(np.arange(len(sizes), dtype=np.int32), deep=True)
    material.SetName("a material")
    grid.GetCellData().AddArray(material)
    stress = numpy_to_vtk(np.ones((len(sizes), 6), np.float32), deep=True)
    stress.SetName("stress")
    grid.GetCellData().AddArray(stress)
    return grid


def write_legacy(path, grid, version, binary):
    writer = vtk.vtkUnstructuredGridWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(grid)
    writer.SetFileVersion(version)
    writer.SetFileType(2 if binary else 1)
    assert writer.Write() == 1, path


def write_vtu(path, grid, mode="raw", compressor="None", header="UInt32", order="LittleEndian", pieces=1, ids="Int64"):
    writer = vtk.vtkXMLUnstructuredGridWriter()
    writer.SetFileName(str(path))
    if pieces > 1:
        split = vtk.vtkExtractUnstructuredGridPiece()
        split.SetInputData(grid)
        split.CreateGhostCellsOff()
        writer.SetInputConnection(split.GetOutputPort())
    else:
        writer.SetInputData(grid)
    {"ascii": writer.SetDataModeToAscii, "inline": writer.SetDataModeToBinary}.get(
        mode, writer.SetDataModeToAppended)()
    writer.SetEncodeAppendedData(mode == "base64")
    getattr(writer, f"SetCompressorTypeTo{compressor}")()
    getattr(writer, f"SetHeaderTypeTo{header}")()
    getattr(writer, f"SetByteOrderTo{order}")()
    getattr(writer, f"SetIdTypeTo{ids}")()
    writer.SetBlockSize(1 << 13)
    writer.SetNumberOfPieces(pieces)
    assert writer.Write() == 1, path


def write_hdf(path, grid, packed):
    writer = vtk.vtkHDFWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(grid)
    writer.SetChunkSize(1000)
    writer.SetCompressionLevel(packed)
    assert writer.Write() == 1, path


def from_vtk(folder, meshes):
    chosen = {name: vtk_ordered(meshes[name]).relabelled(0) for name in
              ("specimen", "specimen-2", "extruded", "extruded-2", "transition", "transition-2", "shell-2", "flawed")}
    points, cells = models.grid(9, tensor=True)
    bent = points + 0.02 * np.sin(5 * points[:, [1, 2, 0]])
    chosen["voxels"] = voxels(bent, cells)
    for name, mesh in chosen.items():
        code = {8: 11, 4: 8} if name == "voxels" else None
        coded = (lambda b: code[b.nodes.shape[1]]) if code else (lambda b: VTK_CODE[cell_name(b)])
        for version, binary in itertools.product((42, 51), (False, True)):
            # The legacy writer puts 11 digits into text.
            held = mesh if binary else in_digits(mesh, 10)
            path = folder / f"vtk-{name}-{version}{'-binary' if binary else ''}.vtk"
            write_legacy(path, vtk_grid(held, code=coded), version, binary)
            yield Case(path, held)
        single = in_single(mesh)
        path = folder / f"vtk-{name}-single.vtk"
        write_legacy(path, vtk_grid(single, single=True, code=coded), 51, True)
        yield Case(path, single)
        for mode in ("ascii", "raw"):
            path = folder / f"vtk-{name}-{mode}-single.vtu"
            write_vtu(path, vtk_grid(single, single=True, code=coded), mode)
            yield Case(path, single)
        path = folder / f"vtk-{name}.vtu"
        write_vtu(path, vtk_grid(mesh, code=coded), compressor="ZLib")
        yield Case(path, mesh)
        for ending, packed in (("", 0), ("-packed", 4)):
            path = folder / f"vtk-{name}{ending}.vtkhdf"
            write_hdf(path, vtk_grid(mesh, code=coded), packed)
            yield Case(path, mesh)
    yield from vtu_encodings(folder, chosen["extruded-2"])
    yield from vtu_pieces(folder, chosen["transition"])


def voxels(points, cells):
    """Voxels and pixels: their corners are not in order round the cell."""
    solid = cells[:, [0, 1, 3, 2, 4, 5, 7, 6]]
    return Mesh(points, [Block("hexahedron", 1, cells, solid, np.arange(len(cells))),
                         Block("quadrilateral", 1, cells[:50, :4], solid[:50, :4], np.arange(50))]).relabelled(0)


def vtu_encodings(folder, mesh):
    grid = vtk_grid(mesh)
    path = folder / "vtk-ascii.vtu"
    write_vtu(path, grid, "ascii")
    yield Case(path, mesh)
    modes, compressors = ("inline", "raw", "base64"), ("None", "ZLib", "LZ4", "LZMA")
    orders = ("LittleEndian", "BigEndian")
    for i, choice in enumerate(itertools.product(modes, compressors, ("UInt32", "UInt64"), orders)):
        path = folder / f"vtk-{'-'.join(choice).lower()}.vtu"
        write_vtu(path, grid, *choice, ids=("Int64", "Int32")[i % 3 == 0])
        yield Case(path, mesh)


def vtu_pieces(folder, mesh):
    """Three pieces in one file; each has points of its own, which VTK's filter makes single."""
    path = folder / "vtk-pieces.vtu"
    write_vtu(path, vtk_grid(mesh), pieces=3)
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    yield Case(path, from_vtk_grid(reader.GetOutput(), in_single(mesh)))


def from_vtk_grid(grid, like):
    """The mesh in VTK's memory; its types and nodes are those of `like`, cell for cell."""
    points = vtk_to_numpy(grid.GetPoints().GetData())
    nodes = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    blocks, at = [], 0
    for b in like.blocks:
        rows = nodes[at:at + b.nodes.size].reshape(b.nodes.shape)
        at += b.nodes.size
        corners = None if b.shape is None else rows[:, :b.corners.shape[1]]
        blocks.append(Block(b.shape, b.order, rows, corners, b.labels))
    assert np.array_equal(points[nodes], like.points[np.concatenate([b.nodes.ravel() for b in like.blocks])])
    return Mesh(points, blocks)


# --- meshio ----------------------------------------------------------------------------------------------------------

def meshio_mesh(mesh, entities=False):
    """With data on points and cells; MSH 4.1 also wants the entity that each belongs to."""
    cells = [(cell_name(b), b.nodes) for b in mesh.blocks]
    points = {"u": mesh.points[:, 1]}
    elements = {"c": [np.arange(len(b.nodes), dtype=float) for b in mesh.blocks]}
    if entities:
        points["gmsh:dim_tags"] = np.tile([3, 1], (len(mesh.points), 1))
        for tag in ("gmsh:geometrical", "gmsh:physical"):
            elements[tag] = [np.full(len(b.nodes), i + 1) for i, b in enumerate(mesh.blocks)]
    return meshio.Mesh(mesh.points, cells, point_data=points, cell_data=elements)


MESHIO = {
    "41.msh": dict(file_format="gmsh", binary=False), "41-binary.msh": dict(file_format="gmsh", binary=True),
    "22.msh": dict(file_format="gmsh22", binary=False), "22-binary.msh": dict(file_format="gmsh22", binary=True),
    "51.vtk": dict(file_format="vtk", binary=False), "51-binary.vtk": dict(file_format="vtk", binary=True),
    "42.vtk": dict(file_format="vtk42", binary=False), "42-binary.vtk": dict(file_format="vtk42", binary=True),
    "ascii.vtu": dict(file_format="vtu", binary=False),
    "none.vtu": dict(file_format="vtu", binary=True, compression=None),
    "zlib.vtu": dict(file_format="vtu", binary=True, compression="zlib"),
    "zlib64.vtu": dict(file_format="vtu", binary=True, compression="zlib", header_type="UInt64"),
    "lzma.vtu": dict(file_format="vtu", binary=True, compression="lzma"),
    ".inp": dict(file_format="abaqus"),
    ".e": dict(file_format="exodus"),
    ".med": dict(file_format="med"),
    "hdf.xdmf": dict(file_format="xdmf", data_format="HDF"),
    "xml.xdmf": dict(file_format="xdmf", data_format="XML"),
    "binary.xdmf": dict(file_format="xdmf", data_format="Binary"),
}
KNOWN = {"msh": meshio_to_gmsh_type, "vtk": meshio_to_vtk_type, "vtu": meshio_to_vtk_type, "inp": meshio_to_abaqus_type,
         "e": meshio_to_exodus_type, "med": meshio_to_med_type, "xdmf": meshio_to_xdmf_type}


def held(mesh, ending):
    """What the file holds: wedges of VTK as they stood before VTK 9.7 turned them, 12 digits in the text of a VTU."""
    if not ending.endswith(("vtk", "vtu")):
        return mesh.relabelled(1)
    blocks = [replace(b, corners=b.corners[:, meshio_to_vtk_order("wedge")]) if cell_name(b) == "wedge" else b
              for b in mesh.blocks]
    turned = Mesh(mesh.points, blocks).relabelled(0)
    return in_digits(turned, 12) if ending == "ascii.vtu" else turned


def by_type(mesh):
    """MED has one section a type, and an HDF5 file lists them by their names."""
    types = sorted({cell_name(b) for b in mesh.blocks}, key=meshio_to_med_type.get)
    alike = [[b for b in mesh.blocks if cell_name(b) == name] for name in types]
    joined = [replace(bs[0], nodes=np.concatenate([b.nodes for b in bs]),
                      corners=None if bs[0].shape is None else np.concatenate([b.corners for b in bs]),
                      labels=np.concatenate([b.labels for b in bs])) for bs in alike]
    return Mesh(mesh.points, joined)


def from_meshio(folder, meshes):
    for name in ("pit", "pit-2", "specimen", "specimen-2", "extruded", "extruded-2", "extruded-complete", "transition",
                 "transition-2", "transition-complete", "shell", "flawed", "large"):
        for ending, options in MESHIO.items():
            if name == "large" and ending not in ("41-binary.msh", "51-binary.vtk", "zlib.vtu", ".inp",
                                                          ".e", "hdf.xdmf"):
                continue
            extension = ending.split(".")[-1]
            written = only(vtk_ordered(meshes[name]), lambda b: cell_name(b) in KNOWN[extension]
                           and cell_name(b) in topological_dimension)
            if extension == "med":
                written = by_type(written)
            path = folder / f"meshio-{name}-{ending}".replace("-.", ".")
            meshio.write(path, meshio_mesh(written, entities=ending.startswith("41")), **options)
            yield Case(path, held(written, ending))


# --- compressed copies -----------------------------------------------------------------------------------------------

def halves(data):
    return data[:len(data) // 2], data[len(data) // 2:]


def two_frames(data):
    return b"".join(zstandard.ZstdCompressor().compress(part) for part in halves(data))


PACKERS = {
    "gz": lambda data: b"".join(gzip.compress(part, mtime=0) for part in halves(data)),
    "zst": two_frames,
    "bz2": lambda data: b"".join(bz2.compress(part) for part in halves(data)),
    "xz": lambda data: b"".join(lzma.compress(part) for part in halves(data)),
}


def packed(case):
    """Copies of two gzip members, two Zstandard frames, two bzip2 streams, two xz streams."""
    data = case.path.read_bytes()
    for ending, pack in PACKERS.items():
        path = case.path.with_name(f"{case.path.name}.{ending}")
        path.write_bytes(pack(data))
        yield Case(path, case.mesh)


PACKED = ("gmsh-specimen-41-binary.msh", "gmsh-large-41.msh", "gmsh-quads.inp", "vtk-extruded-51.vtk",
          "vtk-raw-zlib-uint64-bigendian.vtu", "meshio-large.inp")


def cases(folder):
    """Writes every file and yields its case."""
    meshes = {"flawed": models.flawed()}
    for case in itertools.chain(from_gmsh(folder, meshes), from_vtk(folder, meshes), from_meshio(folder, meshes)):
        copies = list(packed(case)) if case.path.name in PACKED else []
        yield case
        yield from copies
