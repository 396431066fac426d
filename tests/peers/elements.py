"""Reads files of single elements back with VTK, pyarrow and DuckDB, and holds them against each other.

    python elements.py MESHGAUGE MESH...

The CSV file is the yardstick: its numbers are those of the program, in full. Of tetrahedra M31 and the volume are also
computed from the points and corners of the VTU file, so that a corner in the wrong place is seen.
"""
import csv
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import duckdb
import numpy as np
import pyarrow.parquet as pq
import vtk
from vtk.util.numpy_support import vtk_to_numpy

KINDS = {"triangle": 5, "quadrilateral": 9, "tetrahedron": 10, "hexahedron": 12, "wedge": 13, "pyramid": 14}
TEXTS = ("shape", "region")


def write(program, mesh, path, *options):
    command = [program, "score", mesh, "--quiet", "--per-element", path, *options]
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    assert done.returncode in (0, 1), done.stderr


def columns_of_csv(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
        names = csv.DictReader(open(path)).fieldnames
    columns = {}
    for name in names:
        values = [row[name] for row in rows]
        if name in TEXTS:
            columns[name] = values
        elif name == "element":
            columns[name] = [int(value) for value in values]
        else:
            columns[name] = [float(value) if value else None for value in values]
    return columns


def check_parquet(path, expected):
    table = pq.read_table(path)
    assert table.column_names == list(expected), table.column_names
    for name, values in expected.items():
        found = table.column(name).to_pylist()
        if name == "region":
            found = [value or "" for value in found]
        assert found == values, name
    counted = duckdb.connect().execute(f"select count(*), count(M31), min(M31) from '{path}'").fetchone()
    m31 = [value for value in expected["M31"] if value is not None]
    assert counted == (len(expected["element"]), len(m31), min(m31, default=None)), counted


def check_vtu(path, expected):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    assert reader.GetErrorCode() == 0
    grid = reader.GetOutput()
    cells = grid.GetNumberOfCells()
    assert cells == len(expected["element"]), cells
    if cells == 0:
        return
    data = grid.GetCellData()
    assert vtk_to_numpy(data.GetArray("element")).tolist() == expected["element"]
    kinds = [grid.GetCellType(cell) for cell in range(cells)]
    assert kinds == [KINDS[shape] for shape in expected["shape"]]
    for name in [name for name in expected if name.startswith("M")] + ["size"]:
        found = vtk_to_numpy(data.GetArray(name))
        wanted = np.array([math.nan if value is None else value for value in expected[name]])
        assert np.array_equal(found, wanted, equal_nan=True), name
    names = grid.GetFieldData().GetAbstractArray("region names")
    if names is None:
        assert not any(expected["region"])
    else:
        names = [""] + [names.GetValue(k) for k in range(names.GetNumberOfValues())]
        found = [names[number] for number in vtk_to_numpy(data.GetArray("region"))]
        assert found == expected["region"]
    check_corners(grid, expected)


def check_corners(grid, expected):
    points = vtk_to_numpy(grid.GetPoints().GetData())
    connectivity = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    offsets = vtk_to_numpy(grid.GetCells().GetOffsetsArray())
    assert len(np.unique(connectivity)) == len(points), "a point is not used"
    for cell, shape in enumerate(expected["shape"]):
        corners = points[connectivity[offsets[cell]:offsets[cell + 1]]]
        wanted = [expected[axis][cell] for axis in "xyz"]
        assert np.allclose(corners.mean(axis=0), wanted, rtol=1e-12, atol=1e-12 * np.abs(points).max())
        if shape != "tetrahedron":
            continue
        edges = corners[1:] - corners[0]
        volume = np.linalg.det(edges) / 6
        squares = sum(np.sum((corners[i] - corners[j]) ** 2) for i in range(4) for j in range(i))
        m31 = 72 * math.sqrt(3) * abs(volume) / squares**1.5
        assert math.isclose(volume, expected["volume"][cell], rel_tol=1e-9, abs_tol=1e-15), cell
        assert math.isclose(m31, expected["M31"][cell], rel_tol=1e-9, abs_tol=1e-12), cell


def main():
    program, *meshes = sys.argv[1:]
    for mesh in meshes:
        with tempfile.TemporaryDirectory() as folder:
            for options in ([], ["--below", "0.5"], ["--below", "1e-9"]):
                paths = [Path(folder) / f"elements.{kind}" for kind in ("csv", "parquet", "vtu")]
                for path in paths:
                    write(program, mesh, path, *options)
                expected = columns_of_csv(paths[0])
                if options == ["--below", "0.5"]:
                    measures = [name for name in expected if name.startswith("M")]
                    least = [min(expected[m][k] for m in measures if expected[m][k] is not None)
                             for k in range(len(expected["element"]))]
                    assert all(value < 0.5 for value in least)
                check_parquet(paths[1], expected)
                check_vtu(paths[2], expected)
                print("ok", mesh, *options, len(expected["element"]), "elements")


if __name__ == "__main__":
    main()
