"""python netgen_mesh.py PROBLEM SIZE OUTPUT: meshes a model problem with Netgen."""

import sys

from netgen.csg import CSGeometry, Cylinder, Plane, Pnt, Sphere, Vec
from netgen.geom2d import SplineGeometry

from problems import GROWTH, HEIGHT, LENGTH, RADIUS, Pit


def between(low, high):
    return Plane(Pnt(0, 0, low), Vec(0, 0, -1)) * Plane(Pnt(0, 0, high), Vec(0, 0, 1))


def main():
    problem, size, output = sys.argv[1], float(sys.argv[2]), sys.argv[3]
    if problem == "disc":
        geometry = SplineGeometry()
        geometry.AddCircle((0, 0), RADIUS)
        mesh = geometry.GenerateMesh(maxh=size, quad_dominated=False)
    elif problem == "disc-quads":
        geometry = SplineGeometry()
        geometry.AddCircle((0, 0), RADIUS)
        mesh = geometry.GenerateMesh(maxh=size, quad_dominated=True)
    elif problem == "cylinder":
        geometry = CSGeometry()
        geometry.Add(Cylinder(Pnt(0, 0, 0), Pnt(0, 0, HEIGHT), RADIUS) * between(0, HEIGHT))
        mesh = geometry.GenerateMesh(maxh=size)
    else:
        pit = Pit(problem)
        x, y, z = pit.centre
        body = Cylinder(Pnt(0, 0, 0), Pnt(0, 0, LENGTH), pit.radius) * between(0, LENGTH)
        hole = Sphere(Pnt(x, y, z), pit.mouth)
        if pit.depth > pit.mouth:
            wall = Cylinder(Pnt(x, y, z), Pnt(x + 1, y, z), pit.mouth)
            ends = Plane(Pnt(x, y, z), Vec(-1, 0, 0)) * Plane(Pnt(x + pit.depth, y, z), Vec(1, 0, 0))
            hole = hole + wall * ends
        geometry = CSGeometry()
        geometry.Add((body - hole.maxh(size)).maxh(pit.coarsest))
        mesh = geometry.GenerateMesh(maxh=pit.coarsest, grading=GROWTH)
    mesh.Save(output)


if __name__ == "__main__":
    main()
