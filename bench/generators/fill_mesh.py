"""python fill_mesh.py GENERATOR PROBLEM SIZE OUTPUT: fills a domain from its boundary.

In the plane the boundary is a polygon of equal sides, in space Gmsh's surface mesh of the same size, so that what
differs is what the generator does inside. Those that remesh the boundary (Mmg, fTetWild) are free to.
"""

import os
import subprocess
import sys
import tempfile

import numpy

from problems import HEIGHT, RADIUS, Pit, circle, write_medit


def equilateral(size):
    return size * size * 3**0.5 / 4


def ring(points):
    return [(k, (k + 1) % len(points)) for k in range(len(points))]


def triangle_plane(size):
    import triangle

    points = circle(size)
    plan = {"vertices": points, "segments": ring(points)}
    mesh = triangle.triangulate(plan, f"pq30a{1.5 * equilateral(size):.12f}")
    return mesh["vertices"], [("Triangles", mesh["triangles"])]


def meshpy_plane(size):
    from meshpy import triangle

    info = triangle.MeshInfo()
    points = circle(size)
    info.set_points(points)
    info.set_facets(ring(points))
    mesh = triangle.build(info, max_volume=1.5 * equilateral(size), min_angle=30)
    return numpy.array(mesh.points), [("Triangles", numpy.array(mesh.elements))]


def cgal_plane(size):
    from CGAL.CGAL_Kernel import Point_2
    from CGAL.CGAL_Mesh_2 import (
        Delaunay_mesh_size_criteria_2,
        Mesh_2_Constrained_Delaunay_triangulation_2,
        refine_Delaunay_mesh_2,
    )

    plane = Mesh_2_Constrained_Delaunay_triangulation_2()
    points = [plane.insert(Point_2(x, y)) for x, y in circle(size)]
    for start, end in ring(points):
        plane.insert_constraint(points[start], points[end])
    refine_Delaunay_mesh_2(plane, Delaunay_mesh_size_criteria_2(0.125, 1.3 * size))
    place, found, rows = {}, [], []
    for face in plane.finite_faces():
        if not face.is_in_domain():
            continue
        row = []
        for k in range(3):
            point = face.vertex(k).point()
            key = (point.x(), point.y())
            if key not in place:
                place[key] = len(found)
                found.append(key)
            row.append(place[key])
        rows.append(row)
    return found, [("Triangles", rows)]


def distmesh_plane(size):
    from distmeshpy import distmesh2d

    box = ((-RADIUS, RADIUS), (-RADIUS, RADIUS))
    numpy.random.seed(1)
    points, rows = distmesh2d(
        lambda p: numpy.hypot(p[:, 0], p[:, 1]) - RADIUS, lambda p: numpy.ones(len(p)), size, box
    )
    return points, [("Triangles", getattr(rows, "simplices", rows))]


def mmg_plane(size):
    import mmgpy
    from meshpy import triangle

    points = circle(size)
    info = triangle.MeshInfo()
    info.set_points(points)
    info.set_facets(ring(points))
    start = triangle.build(info, max_volume=4 * equilateral(size))
    mesh = mmgpy.MmgMesh2D(numpy.array(start.points), numpy.array(start.elements, dtype=numpy.int32))
    mesh.remesh(hmax=1.3 * size, hmin=0.5 * size, hausd=0.02 * size, verbose=-1)
    return mesh.get_vertices(), [("Triangles", mesh.get_triangles())]


def boundary(problem, size):
    from gmsh_mesh import surface

    return surface(problem, size)


def largest(problem, size):
    """A volume that no tetrahedron may pass, where the size is the same everywhere."""
    return None if problem.startswith("pit:") else 1.6 * size**3 / 6 / 2**0.5


def tetgen_space(problem, size):
    import tetgen

    points, rows = boundary(problem, size)
    limit = largest(problem, size)
    filler = tetgen.TetGen(points, rows.astype(numpy.int32))
    given = {"fixedvolume": True, "maxvolume": limit} if limit else {}
    # The surface stays as it is (Y), as it must where another mesh is to fit.
    found = filler.tetrahedralize(order=1, mindihedral=10, minratio=1.4, nobisect=True, **given)
    return found[0], [("Tetrahedra", found[1])]


def meshpy_space(problem, size):
    from meshpy import tet

    points, rows = boundary(problem, size)
    info = tet.MeshInfo()
    info.set_points(points.tolist())
    info.set_facets(rows.tolist())
    limit = largest(problem, size)
    mesh = tet.build(info, options=tet.Options("pq1.4/10Q" + (f"a{limit:.12f}" if limit else "")))
    return numpy.array(mesh.points), [("Tetrahedra", numpy.array(mesh.elements))]


def ftetwild_space(problem, size):
    import wildmeshing

    points, rows = boundary(problem, size)
    extent = float(numpy.linalg.norm(points.max(0) - points.min(0)))
    filler = wildmeshing.Tetrahedralizer(stop_quality=10, edge_length_r=size / extent, epsilon=5e-4, max_its=40)
    filler.set_mesh(points, rows)
    filler.tetrahedralize()
    found = filler.get_tet_mesh()
    return found[0], [("Tetrahedra", found[1])]


def cgal_space(problem, size):
    from CGAL.CGAL_Mesh_3 import Mesh_3_Complex_3_in_triangulation_3, Mesh_3_parameters, Polyhedral_mesh_domain_3, make_mesh_3
    from CGAL.CGAL_Polyhedron_3 import Polyhedron_3
    from CGAL.CGAL_Mesh_3 import Default_mesh_criteria

    points, rows = boundary(problem, size)
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "surface.off")
        with open(path, "w") as out:
            print(f"OFF\n{len(points)} {len(rows)} 0", file=out)
            for point in points:
                print(*map(repr, map(float, point)), file=out)
            for row in rows:
                print(3, *row, file=out)
        polyhedron = Polyhedron_3(path)
    domain = Polyhedral_mesh_domain_3(polyhedron)
    criteria = Default_mesh_criteria()
    criteria.facet_angle(25).facet_size(size).facet_distance(0.05 * size)
    criteria.cell_radius_edge_ratio(2).cell_size(size)
    mesh = make_mesh_3(domain, criteria, Mesh_3_parameters())
    path = os.path.join(tempfile.mkdtemp(dir="."), "mesh.mesh")
    mesh.output_to_medit(path)
    return path


def delmesher_space(problem, size):
    import delmesher

    points, rows = boundary(problem, size)
    made = delmesher.tetrahedralize(points, rows.astype(numpy.uint32), sliver_removal=True)
    return made.vertices, [("Tetrahedra", made.tetrahedra)]


def mmg_space(problem, size):
    import mmgpy

    start, [(_, cells)] = tetgen_space(problem, size)
    mesh = mmgpy.MmgMesh3D(numpy.array(start), numpy.array(cells, dtype=numpy.int32))
    if problem.startswith("pit:"):
        pit = Pit(problem)
        mesh.set_field("metric", numpy.array([[1.2 * pit.size(size, *point)] for point in start]))
        mesh.remesh(hausd=0.1 * pit.mouth, hgrad=1.3, verbose=-1)
    else:
        mesh.remesh(hmax=1.3 * size, hmin=0.5 * size, hausd=0.05 * size, verbose=-1)
    return mesh.get_vertices(), [("Tetrahedra", mesh.get_tetrahedra())]


def main():
    generator, problem, size, output = sys.argv[1], sys.argv[2], float(sys.argv[3]), sys.argv[4]
    if problem == "disc":
        made = globals()[f"{generator}_plane"](size)
    else:
        made = globals()[f"{generator}_space"](problem, size)
    if isinstance(made, str):
        os.replace(made, output)
    else:
        points = [row[:2] for row in made[0]] if problem == "disc" else made[0]
        write_medit(output, points, made[1])


if __name__ == "__main__":
    main()
