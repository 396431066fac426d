"""Writes one mesh of every VTK cell type in every encoding that VTK's and meshio's own writers know.

    python3 tests/peers/vtk_family.py FOLDER          all of them (hundreds)
    python3 tests/peers/vtk_family.py FOLDER small    the few small ones of tests/meshes/vtk and vtu

The folder then has the files and `expected.jsonl`: for each file the number of points, of measured cells by shape, of
counted cells, and a checksum of the corners. Coordinates are multiples of 1/8, so that no encoding rounds them.
Needs vtk, meshio and numpy.
"""
import json
import random
import sys
from pathlib import Path

import meshio
import numpy as np
import vtk

OUT = Path(sys.argv[1])
OUT.mkdir(parents=True, exist_ok=True)
random.seed(20070301)

# Code: shape, places of the corners.
RING = list(range(8))
TENSOR = [0, 1, 3, 2, 4, 5, 7, 6]
CORNERS = dict(triangle=3, quadrilateral=4, tetrahedron=4, pyramid=5, wedge=6, hexahedron=8)
SHAPES = {
    "triangle": [5, 22, 34, 69, 76], "quadrilateral": [8, 9, 23, 28, 30, 70, 77], "tetrahedron": [10, 24, 71, 78],
    "pyramid": [14, 27, 37], "wedge": [13, 26, 31, 32, 73, 80], "hexahedron": [11, 12, 25, 29, 33, 72, 79],
}
SHAPE = {code: shape for shape, codes in SHAPES.items() for code in codes}
ORDERED = {69: 10, 70: 16, 71: 20, 72: 64, 73: 40, 76: 6, 77: 9, 78: 10, 79: 27, 80: 18}
LOOSE = {1: 1, 2: 3, 3: 2, 4: 4, 6: 5, 7: 5, 15: 10, 16: 12, 21: 3, 35: 4, 36: 10, 41: 6, 68: 4}
POLYGONS = [(7, 3, "triangle"), (7, 4, "quadrilateral"), (36, 6, "triangle"), (36, 8, "quadrilateral")]


def points_of(code, count, place):
    """Points of one cell; where they stand does not matter to a reader, only which is which."""
    cell = vtk.vtkGenericCell.InstantiateCell(code)
    known = None
    if code not in ORDERED and cell is not None and cell.GetNumberOfPoints() == count and cell.GetParametricCoords():
        flat = cell.GetParametricCoords()
        known = [flat[3 * k : 3 * k + 3] for k in range(count)] if isinstance(flat, (tuple, list)) else None
    for k in range(count):
        base = known[k] if known else (random.randint(0, 8) / 8 for _ in range(3))
        yield [round((b * 4 + random.randint(0, 2) / 8 + p) * 8) / 8 for b, p in zip(base, place)]


def make(codes, repeats):
    points, cells = [], []
    for repeat in range(repeats):
        for row, (code, count, shape) in enumerate(codes):
            new = list(points_of(code, count, (5 * row, 5 * repeat, 0)))
            # Share some points between cells, so that the lists are not just 0, 1, 2 ...
            ids = []
            for point in new:
                if points and random.random() < 0.2 and len(points) > 40:
                    other = random.randrange(len(points))
                    if other not in ids:
                        ids.append(other)
                        continue
                ids.append(len(points))
                points.append(point)
            cells.append((code, shape, ids))
    random.shuffle(cells)
    return points, cells


def size(code):
    if code in ORDERED:
        return ORDERED[code]
    if code in LOOSE:
        return LOOSE[code]
    return vtk.vtkGenericCell.InstantiateCell(code).GetNumberOfPoints()


LINEAR = [(code, size(code), SHAPE[code]) for code in (5, 9, 10, 14, 13, 12)]
ALL = [(code, size(code), SHAPE[code]) for code in sorted(SHAPE)] + POLYGONS
ALL += [(code, count, None) for code, count in LOOSE.items()]


def corners(code, shape, ids):
    order = TENSOR if code in (8, 11) else RING
    return [ids[order[k]] for k in range(CORNERS[shape])]


def expected(points, cells):
    shapes, checksum, counted = {}, 0.0, 0
    for label, (code, shape, ids) in enumerate(cells):
        if shape is None:
            counted += 1
            continue
        shapes[shape] = shapes.get(shape, 0) + 1
        for k, node in enumerate(corners(code, shape, ids)):
            x, y, z = points[node]
            checksum += (label % 7 + 1) * (k + 1) * (x + 2 * y + 3 * z)
    return dict(nodes=len(points), shapes=shapes, counted=counted, checksum=checksum)


def grid_of(points, cells, precision=vtk.VTK_DOUBLE, polyhedron=False):
    grid, holder = vtk.vtkUnstructuredGrid(), vtk.vtkPoints()
    holder.SetDataType(precision)
    for point in points:
        holder.InsertNextPoint(point)
    grid.SetPoints(holder)
    for code, _, ids in cells:
        if code == 42:
            faces = [[ids[0], ids[1], ids[2]], [ids[0], ids[1], ids[3]], [ids[1], ids[2], ids[3]], [ids[2], ids[0], ids[3]]]
            stream = vtk.vtkIdList()
            stream.InsertNextId(4)
            for face in faces:
                stream.InsertNextId(3)
                [stream.InsertNextId(i) for i in face]
            grid.InsertNextCell(42, stream)
        else:
            grid.InsertNextCell(code, len(ids), ids)
    value = vtk.vtkDoubleArray()
    value.SetName("weight <&>")
    [value.InsertNextValue(k / 8) for k in range(len(points))]
    grid.GetPointData().AddArray(value)
    note = vtk.vtkStringArray()
    note.SetName("note")
    [note.InsertNextValue(text) for text in ("a b", "", "c" * 100)]
    grid.GetFieldData().AddArray(note)
    time = vtk.vtkDoubleArray()
    time.SetName("TimeValue")
    time.InsertNextValue(0.5)
    grid.GetFieldData().AddArray(time)
    holder.GetData().GetRange(2)
    return grid


manifest = open(OUT / "expected.jsonl", "w")


def note(name, facts):
    manifest.write(json.dumps(dict(file=name, **facts)) + "\n")


def write_legacy(grid, name, facts, version, binary, kind=vtk.vtkUnstructuredGridWriter):
    writer = kind()
    writer.SetInputData(grid)
    writer.SetFileName(str(OUT / name))
    writer.SetFileVersion(version)
    writer.SetFileTypeToBinary() if binary else writer.SetFileTypeToASCII()
    assert writer.Write() == 1, name
    note(name, facts)


def write_vtu(grid, name, facts, mode, compressor, wide, big, base64=True, block=None, pieces=1):
    writer = vtk.vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetFileName(str(OUT / name))
    dict(ascii=writer.SetDataModeToAscii, binary=writer.SetDataModeToBinary, appended=writer.SetDataModeToAppended)[mode]()
    dict(none=writer.SetCompressorTypeToNone, zlib=writer.SetCompressorTypeToZLib, lz4=writer.SetCompressorTypeToLZ4,
         lzma=writer.SetCompressorTypeToLZMA)[compressor]()
    writer.SetHeaderTypeToUInt64() if wide else writer.SetHeaderTypeToUInt32()
    writer.SetByteOrderToBigEndian() if big else writer.SetByteOrderToLittleEndian()
    writer.SetEncodeAppendedData(base64)
    if block:
        writer.SetBlockSize(block)
    if pieces > 1:
        writer.SetNumberOfPieces(pieces)
    assert writer.Write() == 1, name
    note(name, facts)


def finish():
    manifest.close()
    print(sum(1 for _ in open(OUT / "expected.jsonl")), "files")
    sys.exit()


if "small" in sys.argv[2:]:
    points, cells = make(ALL + [(42, 4, None)], 1)
    here, grid = expected(points, cells), grid_of(points, cells)
    write_legacy(grid, "all_42_ascii.vtk", here, 42, False)
    write_legacy(grid, "all_51_binary.vtk", here, 51, True)
    write_vtu(grid, "all_raw_lz4.vtu", here, "appended", "lz4", True, False, False)
    points, cells = make(LINEAR, 2)
    here, grid = expected(points, cells), grid_of(points, cells, vtk.VTK_FLOAT)
    write_legacy(grid, "linear_42_binary.vtk", here, 42, True)
    write_legacy(grid, "linear_51_ascii.vtk", here, 51, False)
    write_vtu(grid, "linear_ascii.vtu", here, "ascii", "none", False, False)
    write_vtu(grid, "linear_inline_none.vtu", here, "binary", "none", False, True)
    write_vtu(grid, "linear_inline_lzma.vtu", here, "binary", "lzma", True, False, block=256)
    write_vtu(grid, "linear_base64_zlib.vtu", here, "appended", "zlib", False, True, True, block=256)
    write_vtu(grid, "linear_raw_none.vtu", here, "appended", "none", True, False, False)
    finish()

everything = make(ALL + [(42, 4, None)], 3)
facts = expected(*everything)
linear = make(LINEAR, 9)
linear_facts = expected(*linear)
for label, (points, cells), here in (("all", everything, facts), ("linear", linear, linear_facts)):
    for precision, real in ((vtk.VTK_DOUBLE, "f64"), (vtk.VTK_FLOAT, "f32")):
        grid = grid_of(points, cells, precision)
        for version in (42, 51):
            for binary in (False, True):
                kind = "binary" if binary else "ascii"
                write_legacy(grid, f"{label}_{real}_{version}_{kind}.vtk", here, version, binary)
        for wide in (False, True):
            for big in (False, True):
                tail = f"{label}_{real}_{'u64' if wide else 'u32'}_{'big' if big else 'little'}"
                write_vtu(grid, f"{tail}_ascii.vtu", here, "ascii", "none", wide, big)
                for compressor in ("none", "zlib", "lz4", "lzma"):
                    for block in (None, 256) if compressor != "none" else (None,):
                        name = f"{tail}_{compressor}_{block or 'whole'}"
                        write_vtu(grid, f"{name}_inline.vtu", here, "binary", compressor, wide, big, block=block)
                        for base64 in (False, True):
                            text = "base64" if base64 else "raw"
                            write_vtu(grid, f"{name}_{text}.vtu", here, "appended", compressor, wide, big, base64, block)

# Several pieces: VTK writes a grid that cannot be split once for each.
grid = grid_of(*linear)
points, cells = linear
thrice = [(code, shape, [k + piece * len(points) for k in ids]) for piece in range(3) for code, shape, ids in cells]
for mode, base64 in (("ascii", True), ("binary", True), ("appended", True), ("appended", False)):
    name = f"pieces_{mode}_{'base64' if base64 else 'raw'}.vtu"
    write_vtu(grid, name, expected(points * 3, thrice), mode, "zlib", True, False, base64, pieces=3)

# Polygonal data.
poly, holder = vtk.vtkPolyData(), vtk.vtkPoints()
points, cells = make([(1, 1, None), (3, 2, None), (7, 3, "triangle"), (7, 4, "quadrilateral"), (7, 6, None), (6, 5, None)], 4)
cells.sort(key=lambda cell: {1: 0, 3: 1, 7: 2, 6: 3}[cell[0]])
[holder.InsertNextPoint(point) for point in points]
poly.SetPoints(holder)
arrays = {code: vtk.vtkCellArray() for code in (1, 3, 7, 6)}
for code, _, ids in cells:
    arrays[code].InsertNextCell(len(ids), ids)
poly.SetVerts(arrays[1]), poly.SetLines(arrays[3]), poly.SetPolys(arrays[7]), poly.SetStrips(arrays[6])
for version in (42, 51):
    for binary in (False, True):
        name = f"polydata_{version}_{'binary' if binary else 'ascii'}.vtk"
        write_legacy(poly, name, expected(points, cells), version, binary, vtk.vtkPolyDataWriter)

# meshio turns wedges round for VTK, and groups cells by type.
names = {5: "triangle", 9: "quad", 10: "tetra", 14: "pyramid", 13: "wedge", 12: "hexahedron"}
points, cells = linear
cells = sorted(cells, key=lambda cell: cell[0])
blocks = [(names[code], np.array([ids for c, _, ids in cells if c == code])) for code in sorted(names)]
mesh = meshio.Mesh(np.array(points), blocks)
turned = [(c, s, [i[k] for k in (0, 2, 1, 3, 5, 4)] if c == 13 else i) for c, s, i in cells]
plain, flipped = expected(points, cells), expected(points, turned)
for name, kind, options in (
    ("meshio_42_ascii.vtk", "vtk42", dict(binary=False)), ("meshio_42_binary.vtk", "vtk42", dict(binary=True)),
    ("meshio_51_ascii.vtk", "vtk51", dict(binary=False)), ("meshio_51_binary.vtk", "vtk51", dict(binary=True)),
    ("meshio_ascii.vtu", "vtu", dict(binary=False)), ("meshio_zlib.vtu", "vtu", dict(binary=True, compression="zlib")),
    ("meshio_lzma.vtu", "vtu", dict(binary=True, compression="lzma")), ("meshio_none.vtu", "vtu", dict(binary=True, compression=None)),
):
    meshio.write(OUT / name, mesh, file_format=kind, **options)
    note(name, dict(plain, checksum_of_turned_wedges=flipped["checksum"]))
finish()
