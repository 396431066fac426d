"""Writes structured, rectilinear, uniform and polygonal data, pieces with ghost cells, and blocks, by VTK's own writers.

    python3 tests/peers/vtk_grids.py FOLDER          every encoding
    python3 tests/peers/vtk_grids.py FOLDER small    the few small ones of tests/meshes/vtk and vtu

The folder then has the files and `expected.jsonl`, as tests/peers/vtk_family.py has: what the files hold is asked of VTK.
Coordinates are multiples of 1/8. Needs vtk.
"""
import json
import sys
from pathlib import Path

import vtk

OUT = Path(sys.argv[1])
OUT.mkdir(parents=True, exist_ok=True)
SMALL = "small" in sys.argv[2:]

SHAPES = {5: "triangle", 7: None, 8: "quadrilateral", 9: "quadrilateral", 10: "tetrahedron", 11: "hexahedron",
          12: "hexahedron", 13: "wedge", 14: "pyramid"}
CORNERS = dict(triangle=3, quadrilateral=4, tetrahedron=4, pyramid=5, wedge=6, hexahedron=8)
TENSOR = [0, 1, 3, 2, 4, 5, 7, 6]
manifest = open(OUT / "expected.jsonl", "a" if SMALL else "w")


def expected(grids):
    """What VTK finds in the grids, one after another; cells that are marked as another's are left out."""
    nodes, label, counted, shapes, checksum = 0, 0, 0, {}, 0.0
    for grid in grids:
        marks = grid.GetCellData().GetArray("vtkGhostType")
        for k in range(grid.GetNumberOfCells()):
            cell, code = grid.GetCell(k), grid.GetCellType(k)
            count, number = cell.GetNumberOfPoints(), label + k
            shape = SHAPES.get(code)
            if code == 7:
                shape = {3: "triangle", 4: "quadrilateral"}.get(count)
            if marks is not None and int(marks.GetValue(k)) & 41:
                continue
            if shape is None:
                counted += 1
                continue
            shapes[shape] = shapes.get(shape, 0) + 1
            for place in range(CORNERS[shape]):
                at = TENSOR[place] if code in (8, 11) else place
                x, y, z = cell.GetPoints().GetPoint(at)
                checksum += (number % 7 + 1) * (place + 1) * (x + 2 * y + 3 * z)
        nodes += grid.GetNumberOfPoints()
        label += grid.GetNumberOfCells()
    return dict(nodes=nodes, shapes=shapes, counted=counted, checksum=checksum)


def note(name, grids):
    manifest.write(json.dumps(dict(file=name, **expected(grids))) + "\n")


def ids(grid, name="MaterialIds"):
    array = vtk.vtkIntArray()
    array.SetName(name)
    [array.InsertNextValue(k % 3 - 1) for k in range(grid.GetNumberOfCells())]
    grid.GetCellData().AddArray(array)
    return grid


def uniform(dimensions, extent=False):
    grid = vtk.vtkImageData()
    if extent:
        grid.SetExtent(2, 1 + dimensions[0], -1, dimensions[1] - 2, 3, 2 + dimensions[2])
    else:
        grid.SetDimensions(dimensions)
    grid.SetOrigin(1, -2, 0.5)
    grid.SetSpacing(0.5, 0.25, 2)
    return ids(grid)


def turned(dimensions):
    grid = uniform(dimensions, True)
    grid.SetDirectionMatrix([0, -1, 0, 1, 0, 0, 0, 0, 1])
    return grid


def rectilinear(dimensions):
    grid = vtk.vtkRectilinearGrid()
    grid.SetDimensions(dimensions)
    for count, put in zip(dimensions, (grid.SetXCoordinates, grid.SetYCoordinates, grid.SetZCoordinates)):
        planes = vtk.vtkDoubleArray()
        [planes.InsertNextValue((k * k + 3 * k) / 8) for k in range(count)]
        put(planes)
    return ids(grid)


def structured(dimensions):
    grid, points = vtk.vtkStructuredGrid(), vtk.vtkPoints()
    points.SetDataTypeToDouble()
    grid.SetDimensions(dimensions)
    for k in range(dimensions[2]):
        for j in range(dimensions[1]):
            for i in range(dimensions[0]):
                points.InsertNextPoint(i + j / 8, j - k / 4, k + i * j / 8)
    grid.SetPoints(points)
    return ids(grid)


def surface():
    source = vtk.vtkPolyData()
    points = vtk.vtkPoints()
    points.SetDataTypeToDouble()
    [points.InsertNextPoint(k % 5, k // 5 + k / 8, (k * k % 7) / 8) for k in range(25)]
    source.SetPoints(points)
    lists = [[[0], [3]], [[0, 1], [1, 2, 3]], [[0, 1, 6, 5], [1, 2, 7], [2, 3, 8, 7, 12]], [[10, 15, 11, 16]]]
    for rows, put in zip(lists, (source.SetVerts, source.SetLines, source.SetPolys, source.SetStrips)):
        cells = vtk.vtkCellArray()
        [cells.InsertNextCell(len(row), row) for row in rows]
        put(cells)
    return ids(source)


def unstructured(grid):
    append = vtk.vtkAppendFilter()
    append.AddInputData(grid)
    append.Update()
    return append.GetOutput()


def with_ghosts(grid, every):
    marks = vtk.vtkUnsignedCharArray()
    marks.SetName("vtkGhostType")
    [marks.InsertNextValue([1, 32, 8][k % 3] if k % every == 0 else (2 if k % 5 == 0 else 0)) for k in range(grid.GetNumberOfCells())]
    grid.GetCellData().AddArray(marks)
    return grid


def write_xml(grid, name, mode="ascii", compressor="none", base64=True, noted=True, pieces=1):
    writer = {"vts": vtk.vtkXMLStructuredGridWriter, "vtr": vtk.vtkXMLRectilinearGridWriter, "vti": vtk.vtkXMLImageDataWriter,
              "vtp": vtk.vtkXMLPolyDataWriter, "vtu": vtk.vtkXMLUnstructuredGridWriter}[name.rsplit(".")[-1]]()
    (OUT / name).parent.mkdir(exist_ok=True)
    writer.SetInputData(grid)
    writer.SetFileName(str(OUT / name))
    dict(ascii=writer.SetDataModeToAscii, binary=writer.SetDataModeToBinary, appended=writer.SetDataModeToAppended)[mode]()
    dict(none=writer.SetCompressorTypeToNone, zlib=writer.SetCompressorTypeToZLib, lz4=writer.SetCompressorTypeToLZ4)[compressor]()
    writer.SetEncodeAppendedData(base64)
    writer.SetBlockSize(256)
    if pieces > 1:
        writer.SetNumberOfPieces(pieces)
    assert writer.Write() == 1, name
    if noted:
        note(name, [grid])


def write_legacy(grid, name, kind, version, binary):
    writer = kind()
    writer.SetInputData(grid)
    writer.SetFileName(str(OUT / name))
    writer.SetFileVersion(version)
    writer.SetFileTypeToBinary() if binary else writer.SetFileTypeToASCII()
    assert writer.Write() == 1, name
    note(name, [grid])


def parallel(name, kind, pieces, folder):
    """A file that names others, as ParaView's writers lay it out."""
    rows = []
    for k, (piece, extension) in enumerate(pieces):
        inner = f"{folder}/{k}.{extension}"
        write_xml(piece, inner, "appended", "zlib", False, noted=False)
        rows.append(f'<Piece Source="{inner}"/>')
    text = f'<VTKFile type="{kind}" version="1.0"><{kind} GhostLevel="1">' + "".join(rows) + f"</{kind}></VTKFile>\n"
    (OUT / name).write_text('<?xml version="1.0"?>\n' + text)
    note(name, [piece for piece, _ in pieces])


def blocks(name, parts):
    blocks = vtk.vtkMultiBlockDataSet()
    for k, (label, part) in enumerate(parts):
        blocks.SetBlock(k, part)
        blocks.GetMetaData(k).Set(vtk.vtkCompositeDataSet.NAME(), label)
    writer = vtk.vtkXMLMultiBlockDataWriter()
    writer.SetInputData(blocks)
    writer.SetFileName(str(OUT / name))
    assert writer.Write() == 1
    note(name, [part for _, part in parts])


def all_parallel():
    grids = [with_ghosts(unstructured(structured(d)), n) for d, n in (((3, 3, 3), 4), ((3, 2, 4), 3))]
    parallel("pieces.pvtu", "PUnstructuredGrid", [(grid, "vtu") for grid in grids], "pieces")
    blocks("blocks.vtm", [("steel", structured((3, 3, 2))), ("skin", surface()), ("air", uniform((2, 3, 2)))])


if SMALL:
    write_xml(turned((4, 3, 3)), "turned.vti", "appended", "zlib", False)
    write_xml(rectilinear((4, 3, 2)), "planes.vtr", "ascii")
    write_xml(with_ghosts(structured((4, 3, 3)), 4), "hidden.vts", "binary", "lz4")
    write_xml(surface(), "surface.vtp", "appended", "none", False)
    all_parallel()
    manifest.close()
    sys.exit()

SIZES = [(4, 3, 3), (5, 4, 1), (1, 4, 3), (4, 1, 5), (6, 1, 1)]
for size in SIZES:
    label = "x".join(map(str, size))
    for kind, grid in (("vts", structured(size)), ("vtr", rectilinear(size)), ("vti", uniform(size)), ("vti", turned(size))):
        for mode, compressor, base64 in (("ascii", "none", True), ("binary", "zlib", True), ("appended", "lz4", True),
                                         ("appended", "none", False), ("appended", "zlib", False)):
            name = f"{kind}_{label}_{mode}_{compressor}_{base64}_{grid.GetExtent()[0]}.{kind}"
            write_xml(grid, name, mode, compressor, base64)
    for version in (42, 51):
        for binary in (False, True):
            tail = f"{label}_{version}_{'binary' if binary else 'ascii'}.vtk"
            write_legacy(uniform(size), f"uniform_{tail}", vtk.vtkStructuredPointsWriter, version, binary)
            write_legacy(rectilinear(size), f"rectilinear_{tail}", vtk.vtkRectilinearGridWriter, version, binary)
            write_legacy(structured(size), f"structured_{tail}", vtk.vtkStructuredGridWriter, version, binary)
for mode, compressor, base64 in (("ascii", "none", True), ("binary", "zlib", True), ("appended", "none", False)):
    write_xml(surface(), f"surface_{mode}.vtp", mode, compressor, base64)
    write_xml(with_ghosts(structured((4, 3, 3)), 3), f"hidden_{mode}.vts", mode, compressor, base64)
    write_xml(with_ghosts(unstructured(structured((4, 3, 3))), 3), f"hidden_{mode}.vtu", mode, compressor, base64)
for binary in (False, True):
    write_legacy(with_ghosts(structured((4, 3, 3)), 3), f"hidden_{binary}.vtk", vtk.vtkStructuredGridWriter, 51, binary)
all_parallel()
manifest.close()
