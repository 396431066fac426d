"""Meshes that Gmsh makes, and meshes made by hand to be bad, as arrays in memory."""
import contextlib
import itertools

import gmsh
import numpy as np
from meshio.gmsh.common import _gmsh_to_meshio_order

from reference import Block, CORNERS, Mesh

SHAPE_OF_GMSH = {"Triangle": "triangle", "Quadrilateral": "quadrilateral", "Tetrahedron": "tetrahedron",
                 "Hexahedron": "hexahedron", "Prism": "wedge", "Pyramid": "pyramid"}
# By shape and number of nodes, the name that meshio gives the cell.
CELL = {("triangle", 3): "triangle", ("triangle", 6): "triangle6", ("quadrilateral", 4): "quad",
        ("quadrilateral", 8): "quad8", ("quadrilateral", 9): "quad9", ("tetrahedron", 4): "tetra",
        ("tetrahedron", 10): "tetra10", ("hexahedron", 8): "hexahedron", ("hexahedron", 20): "hexahedron20",
        ("hexahedron", 27): "hexahedron27", ("wedge", 6): "wedge", ("wedge", 15): "wedge15",
        ("wedge", 18): "wedge18", ("pyramid", 14): "pyramid14",
        ("pyramid", 5): "pyramid", ("pyramid", 13): "pyramid13", (None, 1): "vertex", (None, 2): "line",
        (None, 3): "line3"}


@contextlib.contextmanager
def session():
    """Gmsh, quiet and on one thread, so that each run makes the same meshes."""
    gmsh.initialize(["-nopopup"], readConfigFiles=False, interruptible=False)
    gmsh.option.setNumber("General.Verbosity", 1)
    gmsh.option.setNumber("General.NumThreads", 1)
    try:
        yield
    finally:
        gmsh.finalize()


def capture(keep=lambda dimension, entity: True):
    """The current model's mesh as it stands in Gmsh's memory, the elements of the entities that `keep` wants."""
    tags, points, _ = gmsh.model.mesh.getNodes()
    row = dict(zip(tags.tolist(), range(len(tags))))
    blocks = []
    for dimension, entity in gmsh.model.getEntities():
        if not keep(dimension, entity) or gmsh.model.getType(dimension, entity).startswith("Ghost"):
            continue  # a ghost is an element of another part, once more
        for kind, labels, nodes in zip(*gmsh.model.mesh.getElements(dimension, entity)):
            name, _, order, size, _, primary = gmsh.model.mesh.getElementProperties(kind)
            shape = SHAPE_OF_GMSH.get(name.split()[0])
            rows = np.array([row[n] for n in nodes.tolist()]).reshape(-1, size)
            blocks.append(Block(shape, order, rows, rows[:, :primary] if shape else None, labels.astype(np.int64)))
    return Mesh(points.reshape(-1, 3), blocks)


# --- geometries ------------------------------------------------------------------------------------------------------

def pit_plate(size=0.09, recombine=False):
    """A plate with an elliptic pit in its edge."""
    gmsh.model.add("pit plate")
    plate = gmsh.model.occ.addRectangle(0, 0, 0, 3, 1)
    pit = gmsh.model.occ.addDisk(1.3, 1, 0, 0.35, 0.21)
    gmsh.model.occ.cut([(2, plate)], [(2, pit)])
    gmsh.model.occ.synchronize()
    mesh_sizes(size)
    if recombine:
        gmsh.option.setNumber("Mesh.RecombineAll", 1)
        gmsh.option.setNumber("Mesh.RecombinationAlgorithm", 0)  # leaves some triangles
    gmsh.model.mesh.generate(2)
    gmsh.option.setNumber("Mesh.RecombineAll", 0)


def specimen(size=0.28):
    """A cylinder with a hemispherical pit in its flank."""
    gmsh.model.add("specimen")
    cylinder = gmsh.model.occ.addCylinder(0, 0, 0, 0, 0, 2, 0.7)
    ball = gmsh.model.occ.addSphere(0.7, 0, 1, 0.25)
    gmsh.model.occ.cut([(3, cylinder)], [(3, ball)])
    gmsh.model.occ.synchronize()
    mesh_sizes(size)
    gmsh.model.mesh.generate(3)


def extruded_plate(size=0.13, twist=0.9):
    """A plate with a pit, recombined to quadrilaterals and triangles, swept on a helix: hexahedra and wedges."""
    gmsh.model.add("extruded plate")
    plate = gmsh.model.occ.addRectangle(0, 0, 0, 2, 1)
    pit = gmsh.model.occ.addDisk(1.1, 1, 0, 0.3, 0.2)
    (_, face), = gmsh.model.occ.cut([(2, plate)], [(2, pit)])[0]
    gmsh.model.occ.synchronize()
    gmsh.option.setNumber("Mesh.RecombinationAlgorithm", 0)
    gmsh.model.mesh.setRecombine(2, face)
    gmsh.model.occ.revolve([(2, face)], 0, -2, 0, 1, 0, 0, twist, numElements=[5], recombine=True)
    gmsh.model.occ.synchronize()
    mesh_sizes(size)
    gmsh.model.mesh.generate(3)


def transition(size=0.3):
    """A box of hexahedra under a box of tetrahedra: Gmsh puts pyramids between."""
    gmsh.model.add("transition")
    below = gmsh.model.occ.addBox(0, 0, 0, 1, 1, 0.634)
    above = gmsh.model.occ.addBox(0, 0, 0.634, 1, 1, 0.8)
    gmsh.model.occ.fragment([(3, below)], [(3, above)])
    gmsh.model.occ.synchronize()
    mesh_sizes(size)
    for _, curve in gmsh.model.getBoundary([(3, below)], recursive=False, combined=False):
        for _, edge in gmsh.model.getBoundary([(2, abs(curve))], oriented=False):
            gmsh.model.mesh.setTransfiniteCurve(edge, 7)
        gmsh.model.mesh.setTransfiniteSurface(abs(curve))
        gmsh.model.mesh.setRecombine(2, abs(curve))
    gmsh.model.mesh.setTransfiniteVolume(below)
    gmsh.model.mesh.generate(3)


def shell(size=0.22):
    """A torus and a sphere as curved surfaces of quadrilaterals and triangles, none of them flat."""
    gmsh.model.add("shell")
    gmsh.model.occ.addTorus(0, 0, 0, 1, 0.35)
    gmsh.model.occ.addSphere(3, 0, 0, 0.8)
    gmsh.model.occ.synchronize()
    mesh_sizes(size)
    gmsh.option.setNumber("Mesh.RecombineAll", 1)
    gmsh.option.setNumber("Mesh.RecombinationAlgorithm", 0)
    gmsh.model.mesh.generate(2)
    gmsh.option.setNumber("Mesh.RecombineAll", 0)


def mesh_sizes(size):
    gmsh.option.setNumber("Mesh.MeshSizeMin", size)
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)


def scatter_numbers(seed):
    """Gives nodes and elements numbers without order and with gaps."""
    rng = np.random.default_rng(seed)
    nodes, _, _ = gmsh.model.mesh.getNodes()
    nodes = np.unique(nodes)
    gmsh.model.mesh.renumberNodes(nodes, 7 + 13 * rng.permutation(len(nodes)))
    _, groups, _ = gmsh.model.mesh.getElements()
    labels = np.concatenate(groups)
    gmsh.model.mesh.renumberElements(labels, 5 + 11 * rng.permutation(len(labels)))


# --- by hand ---------------------------------------------------------------------------------------------------------

def block(shape, nodes, order=1):
    nodes = np.asarray(nodes)
    corners = nodes[:, :CORNERS[shape]] if shape else None
    return Block(shape, order, nodes, corners, np.arange(len(nodes)))


def grid(n, tensor=False):
    """Points of an n x n x n grid and its hexahedra, round each ring or, as voxels are, x fastest."""
    points = np.array(list(itertools.product(range(n + 1), repeat=3)), float)[:, ::-1] / n
    cells = []
    for k, j, i in itertools.product(range(n), repeat=3):
        at = [i + x + (n + 1) * (j + y + (n + 1) * (k + z)) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
        cells.append(at if tensor else [at[c] for c in (0, 1, 3, 2, 4, 5, 7, 6)])
    return points, np.array(cells)


def flawed(seed=3):
    """Everything that a generator should not make: inverted, re-entrant, warped, collapsed and sliver elements of all
    shapes, a point that nothing uses, far from the origin and tiny."""
    rng = np.random.default_rng(seed)
    points, cells = grid(7)
    points = points + rng.normal(0, 0.045, points.shape)
    points = np.concatenate([points, rng.random((400, 3)), [[0.5, 0.5, 0.5]]]) * 1e-3 + [5.0, -3.0, 0.25]
    cloud = 8 ** 3 + rng.permuted(np.tile(np.arange(400), (400, 1)), axis=1)
    cells = cells.copy()
    cells[5::41, 4] = cells[5::41, 5]  # an edge of no length
    turned = cells[::17]
    cells[::17] = turned[:, [4, 5, 6, 7, 0, 1, 2, 3]]  # inside out
    collapsed = cloud[300:330, :4].copy()
    collapsed[:, 3] = collapsed[:, 0]
    return Mesh(points, [
        block("hexahedron", cells[:180]),
        block("tetrahedron", np.concatenate([cloud[:300, :4], collapsed])),
        block("hexahedron", cells[180:]),
        block("wedge", np.concatenate([cells[40:80][:, [0, 1, 3, 4, 5, 7]], cloud[330:350, :6]])),
        block("quadrilateral", np.concatenate([cells[:60, :4], cloud[350:375, :4]])),
        block("triangle", cloud[375:400, :3]),
    ])


# --- other forms of a mesh -------------------------------------------------------------------------------------------

def cell_name(b):
    return CELL[b.shape, b.nodes.shape[1]]


def vtk_ordered(mesh):
    """Nodes of Gmsh's records in the order of VTK and meshio; corners are the same."""
    blocks = [Block(b.shape, b.order, _gmsh_to_meshio_order(cell_name(b), b.nodes), b.corners, b.labels)
              for b in mesh.blocks]
    return Mesh(mesh.points, blocks)


def only(mesh, wanted):
    """The blocks that `wanted` says yes to, with all points."""
    return Mesh(mesh.points, [b for b in mesh.blocks if wanted(b)])


def in_digits(mesh, digits):
    """Coordinates rounded to some significant digits, for writers that write no more."""
    rounded = np.array([float(f"%.{digits}g" % x) for x in mesh.points.ravel()]).reshape(-1, 3)
    return Mesh(rounded, mesh.blocks)


def in_single(mesh):
    """Coordinates that single precision holds."""
    return Mesh(mesh.points.astype(np.float32).astype(float), mesh.blocks)
