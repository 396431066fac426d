#!/usr/bin/env python3
"""Makes the meshes of examples/drop with Gmsh and VTK.

    python3 -m venv venv && venv/bin/pip install gmsh vtk numpy zstandard
    venv/bin/python examples/make_drop.py

The committed files were made with Gmsh 4.15.2 and VTK 9.7.2; another version makes slightly different meshes.
Lengths are in millimetres.
"""

import os
from math import sqrt
from pathlib import Path

import gmsh
import numpy as np
import zstandard
from vtk import VTK_HEXAHEDRON, vtkCellArray, vtkPoints, vtkUnstructuredGrid, vtkXMLUnstructuredGridWriter
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray

DROP = Path(__file__).resolve().parent / "drop"


def pit_specimen(path, diameter, length, pit_radius, finest, coarsest):
    """A cylindrical specimen with a hemispherical pit half-way along: tetrahedra that are finest at the pit."""
    gmsh.model.add("pit-specimen")
    occ = gmsh.model.occ
    centre = diameter / 2, 0, length / 2
    cylinder = occ.addCylinder(0, 0, 0, 0, 0, length, diameter / 2)
    occ.cut([(3, cylinder)], [(3, occ.addSphere(*centre, pit_radius))])
    occ.synchronize()
    # A physical group keeps the surface elements, which are no part of the model, out of the file.
    gmsh.model.addPhysicalGroup(3, [tag for _, tag in gmsh.model.getEntities(3)], name="specimen")

    pit = gmsh.model.occ.getEntitiesInBoundingBox(
        *(c - 1.1 * pit_radius for c in centre), *(c + 1.1 * pit_radius for c in centre), 2
    )
    field = gmsh.model.mesh.field
    distance = field.add("Distance")
    field.setNumbers(distance, "SurfacesList", [tag for _, tag in pit])
    field.setNumber(distance, "Sampling", 40)
    size = field.add("Threshold")
    field.setNumber(size, "InField", distance)
    field.setNumber(size, "SizeMin", finest)
    field.setNumber(size, "SizeMax", coarsest)
    field.setNumber(size, "DistMin", 0)
    field.setNumber(size, "DistMax", diameter)
    field.setAsBackgroundMesh(size)
    for option in ("ExtendFromBoundary", "FromPoints", "FromCurvature"):
        gmsh.option.setNumber(f"Mesh.MeshSize{option}", 0)

    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.optimize("Netgen")
    gmsh.write(str(path))
    tetrahedra = gmsh.model.mesh.getElementsByType(4)[0]
    print(f"{path.name}: {len(tetrahedra)} tetrahedra")
    gmsh.model.remove()


def cylinder_hex(path, radius, height, divisions, rings, layers):
    """A cylinder of hexahedra: a square core, four mapped blocks round it, extruded."""
    gmsh.model.add("cylinder-hex")
    geo = gmsh.model.geo
    directions = [(1, 1), (-1, 1), (-1, -1), (1, -1)]
    centre = geo.addPoint(0, 0, 0)
    core = [geo.addPoint(0.4 * radius * x, 0.4 * radius * y, 0) for x, y in directions]
    rim = [geo.addPoint(radius * x / sqrt(2), radius * y / sqrt(2), 0) for x, y in directions]
    sides, spokes, arcs = [], [], []
    for k in range(4):
        sides.append(geo.addLine(core[k], core[(k + 1) % 4]))
        spokes.append(geo.addLine(core[k], rim[k]))
        arcs.append(geo.addCircleArc(rim[k], centre, rim[(k + 1) % 4]))
    loops = [sides] + [[spokes[k], arcs[k], -spokes[(k + 1) % 4], -sides[k]] for k in range(4)]
    surfaces = [geo.addPlaneSurface([geo.addCurveLoop(loop)]) for loop in loops]
    for curve in sides + arcs:
        geo.mesh.setTransfiniteCurve(curve, divisions + 1)
    for curve in spokes:
        geo.mesh.setTransfiniteCurve(curve, rings + 1)
    for surface in surfaces:
        geo.mesh.setTransfiniteSurface(surface)
        geo.mesh.setRecombine(2, surface)
    geo.extrude([(2, s) for s in surfaces], 0, 0, height, numElements=[layers], recombine=True)
    geo.synchronize()
    gmsh.model.mesh.generate(3)

    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    _, corners = gmsh.model.mesh.getElementsByType(5)
    position = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    position[tags] = np.arange(len(tags))
    gmsh.model.remove()

    grid = vtkUnstructuredGrid()
    points = vtkPoints()
    points.SetData(numpy_to_vtk(coordinates.reshape(-1, 3), deep=True))
    grid.SetPoints(points)
    cells = vtkCellArray()
    count = len(corners) // 8
    offsets = numpy_to_vtkIdTypeArray(np.arange(0, 8 * count + 1, 8), deep=True)
    cells.SetData(offsets, numpy_to_vtkIdTypeArray(position[corners], deep=True))
    grid.SetCells(VTK_HEXAHEDRON, cells)
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(grid)
    writer.Write()
    print(f"{path.name}: {count} hexahedra")


def main():
    DROP.mkdir(exist_ok=True)
    # Gmsh writes the path that it is given into the file.
    os.chdir(DROP)
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)

    pit_specimen(Path("pit-specimen.inp"), 6.4, 25.4, 0.5, finest=0.1, coarsest=0.95)

    gmsh.option.setNumber("Mesh.Binary", 1)
    fine = Path("pit-specimen-fine.msh")
    pit_specimen(fine, 6.4, 25.4, 0.1, finest=0.01, coarsest=0.75)
    fine.with_suffix(".msh.zst").write_bytes(zstandard.ZstdCompressor(level=19).compress(fine.read_bytes()))
    fine.unlink()

    cylinder_hex(Path("cylinder-hex.vtu"), 25, 5, divisions=12, rings=10, layers=4)
    gmsh.finalize()


if __name__ == "__main__":
    main()
