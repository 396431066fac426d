"""python gmsh_mesh.py PROBLEM METHOD SIZE OUTPUT: meshes a model problem with Gmsh."""

import math
import sys

import gmsh

from problems import HEIGHT, LENGTH, RADIUS, Pit

# Half the height of a mixed specimen's slab of tetrahedra.
SLAB = 5.0

# Numbers of the algorithms, as in Gmsh's manual.
SURFACE = {"meshadapt": 1, "delaunay": 5, "frontal": 6, "bamg": 7, "quads": 8, "parallelograms": 9, "quasistructured": 11}
VOLUME = {"delaunay3d": 1,  "initial3d": 3, "frontal3d": 4, "mmg3d": 7, "hxt": 10}


def mapped_circle(z, divisions):
    """The disc as one patch of four arcs, mapped (transfinite): the way of the report's FG2."""
    centre = gmsh.model.geo.addPoint(0, 0, z)
    corners = [
        gmsh.model.geo.addPoint(RADIUS * math.cos(a), RADIUS * math.sin(a), z)
        for a in (-0.75 * math.pi, -0.25 * math.pi, 0.25 * math.pi, 0.75 * math.pi)
    ]
    arcs = [gmsh.model.geo.addCircleArc(corners[k], centre, corners[(k + 1) % 4]) for k in range(4)]
    face = gmsh.model.geo.addPlaneSurface([gmsh.model.geo.addCurveLoop(arcs)])
    for arc in arcs:
        gmsh.model.geo.mesh.setTransfiniteCurve(arc, divisions + 1)
    gmsh.model.geo.mesh.setTransfiniteSurface(face, "Left", corners)
    return face


def disc(method, size):
    if method.startswith("mapped"):
        face = mapped_circle(0, round(0.5 * math.pi * RADIUS / size))
        gmsh.model.geo.synchronize()
        if method == "mapped-quads":
            gmsh.model.mesh.setRecombine(2, face)
    else:
        gmsh.model.occ.addDisk(0, 0, 0, RADIUS, RADIUS)
        gmsh.model.occ.synchronize()
        gmsh.option.setNumber("Mesh.Algorithm", SURFACE[method])
        if method in ("quads", "quasistructured"):
            gmsh.option.setNumber("Mesh.RecombineAll", 1)
            # Blossom, all quadrilaterals.
            gmsh.option.setNumber("Mesh.RecombinationAlgorithm", 3 if method == "quads" else 1)


def cylinder(method, size):
    layers = [max(1, round(HEIGHT / size))]
    if method == "mapped-hexahedra":
        face = mapped_circle(0, round(0.5 * math.pi * RADIUS / size))
        gmsh.model.geo.mesh.setRecombine(2, face)
        gmsh.model.geo.extrude([(2, face)], 0, 0, HEIGHT, layers, recombine=True)
        gmsh.model.geo.synchronize()
    elif method.startswith("swept"):
        face = gmsh.model.occ.addDisk(0, 0, 0, RADIUS, RADIUS)
        gmsh.model.occ.extrude([(2, face)], 0, 0, HEIGHT, layers, recombine=True)
        gmsh.model.occ.synchronize()
        gmsh.option.setNumber("Mesh.Algorithm", SURFACE["quads" if method == "swept-hexahedra" else "frontal"])
        if method == "swept-hexahedra":
            gmsh.model.mesh.setRecombine(2, face)
            gmsh.option.setNumber("Mesh.RecombinationAlgorithm", 3)
    else:
        gmsh.model.occ.addCylinder(0, 0, 0, 0, 0, HEIGHT, RADIUS)
        gmsh.model.occ.synchronize()
        if method == "subdivided-hexahedra":
            # Each tetrahedron becomes four hexahedra: what section 4.4 of the report warns of.
            gmsh.option.setNumber("Mesh.SubdivisionAlgorithm", 2)
        else:
            gmsh.option.setNumber("Mesh.Algorithm3D", VOLUME[method])


def specimen(pit, method, size):
    # A mixed mesh has tetrahedra in the slab round the pit, and the slab's ends are swept to those of the specimen.
    low, high = (LENGTH / 2 - SLAB, LENGTH / 2 + SLAB) if method == "mixed" else (0, LENGTH)
    body = gmsh.model.occ.addCylinder(0, 0, low, 0, 0, high - low, pit.radius)
    hole = gmsh.model.occ.addSphere(*pit.centre, pit.mouth)
    if pit.depth > pit.mouth:
        shaft = gmsh.model.occ.addCylinder(*pit.centre, pit.depth, 0, 0, pit.mouth)
        gmsh.model.occ.cut([(3, body)], [(3, hole), (3, shaft)])
    else:
        gmsh.model.occ.cut([(3, body)], [(3, hole)])
    if method == "mixed":
        sweep_ends(pit, low, high)
    gmsh.model.occ.synchronize()
    field = gmsh.model.mesh.field.add("MathEval")
    gmsh.model.mesh.field.setString(field, "F", pit.field(size))
    gmsh.model.mesh.field.setAsBackgroundMesh(field)
    for option in ("ExtendFromBoundary", "FromPoints", "FromCurvature"):
        gmsh.option.setNumber(f"Mesh.MeshSize{option}", 0)
    if method == "mixed":
        # Simple recombination: what finds no partner stays a triangle, and becomes a wedge.
        gmsh.option.setNumber("Mesh.RecombinationAlgorithm", 0)
    else:
        gmsh.option.setNumber("Mesh.Algorithm3D", VOLUME[method])


def sweep_ends(pit, low, high):
    """From the slab between two heights to the specimen's ends: hexahedra, wedges where a triangle was left over."""
    gmsh.model.occ.synchronize()
    for z, way in [(low, -low), (high, LENGTH - high)]:
        [face] = gmsh.model.getEntitiesInBoundingBox(-1e3, -1e3, z - 1e-6, 1e3, 1e3, z + 1e-6, 2)
        gmsh.model.occ.extrude([face], 0, 0, way, [math.ceil(abs(way) / pit.coarsest)], recombine=True)
        gmsh.model.occ.synchronize()
        gmsh.model.mesh.setRecombine(*face)


def build(problem, method, size):
    """The geometry and the settings of a problem in Gmsh; gives its dimension."""
    gmsh.option.setNumber("General.Terminal", 1)
    gmsh.option.setNumber("General.NumThreads", 1)
    if problem.startswith("pit:"):
        specimen(Pit(problem), method, size)
        return 3
    gmsh.option.setNumber("Mesh.MeshSizeMin", size)
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    {"disc": disc, "cylinder": cylinder}[problem](method, size)
    return 2 if problem == "disc" else 3


def surface(problem, size):
    """Gmsh's surface mesh of a solid, for generators that fill a surface: points, and rows of three numbers from 0."""
    import numpy

    gmsh.initialize(["gmsh", "-v", "1"])
    try:
        build(problem, "delaunay3d", size)
        gmsh.model.mesh.generate(2)
        tags, points, _ = gmsh.model.mesh.getNodes()
        _, _, (triangles,) = gmsh.model.mesh.getElements(2)
    finally:
        gmsh.finalize()
    place = {tag: row for row, tag in enumerate(tags)}
    rows = numpy.array([place[tag] for tag in triangles]).reshape(-1, 3)
    return points.reshape(-1, 3), rows


def main():
    problem, method, size, output = sys.argv[1:]
    gmsh.initialize(["gmsh", "-v", "2"])
    try:
        dimension = build(problem, method, float(size))
        gmsh.model.mesh.generate(dimension)
        # Elements of the domain alone: no boundary.
        gmsh.model.addPhysicalGroup(dimension, [tag for _, tag in gmsh.model.getEntities(dimension)])
        gmsh.write(output)
    finally:
        gmsh.finalize()


if __name__ == "__main__":
    main()
