"""The twelve measures and their statistics, straight from the definitions, in NumPy.

Written apart from the program so that the two can be held against each other. Extended precision (`numpy.longdouble`,
64 bits of mantissa on x86) stands in where a plain transcription in doubles loses digits; nothing here is fast.

    python reference.py golden.jsonl      holds the measures against values of 25 digits and prints the worst difference
"""
import itertools
import json
import sys
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

REAL = np.longdouble
SQRT3 = np.sqrt(REAL(3))

CORNERS = {"triangle": 3, "quadrilateral": 4, "tetrahedron": 4, "pyramid": 5, "wedge": 6, "hexahedron": 8}
SOLIDS = ("tetrahedron", "pyramid", "wedge", "hexahedron")
TRIANGLES = {
    "triangle": [(0, 1, 2)],
    "pyramid": [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
    "wedge": [(0, 1, 2), (3, 4, 5)],
}
QUADRILATERALS = {
    "quadrilateral": [(0, 1, 2, 3)],
    "pyramid": [(0, 1, 2, 3)],
    "wedge": [(0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)],
    "hexahedron": [(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)],
}
EDGES = {
    "triangle": [(0, 1), (1, 2), (2, 0)],
    "quadrilateral": [(0, 1), (1, 2), (2, 3), (3, 0)],
    "tetrahedron": list(itertools.combinations(range(4), 2)),
    "pyramid": [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)],
    "wedge": [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)],
    "hexahedron": [(a, b) for a, b in itertools.combinations(range(8), 2)
                   if (a % 4 - b % 4) % 4 in (1, 3) and a // 4 == b // 4 or b - a == 4],
}
FACE_NAMES = {3: "triangular faces", 4: "quadrilateral faces"}


# --- vectors: arrays of shape (n, 3) ---------------------------------------------------------------------------------

def dot(a, b):
    return (a * b).sum(axis=-1)


def norm(a):
    return np.sqrt(dot(a, a))


def cross(a, b):
    return np.stack([a[..., 1] * b[..., 2] - a[..., 2] * b[..., 1],
                     a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2],
                     a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]], axis=-1)


def where_sound(sound, value):
    """The value, and 0 for what is degenerate."""
    return np.where(sound, value, 0)


def smallest_ball(points, supports):
    """Radius of the smallest ball that holds all the points: brute force over the subsets that can support it.

    A ball through two points has its centre halfway, one through three or four at their circumcentre. `points` is a
    list of arrays (n, 3).
    """
    best = np.full(len(points[0]), np.inf, REAL)
    for size in supports:
        for group in itertools.combinations(range(len(points)), size):
            a, *others = (points[i] for i in group)
            centre = a + circumcentre(*(p - a for p in others))
            radius = norm(points[group[0]] - centre)
            reach = np.max([norm(p - centre) for p in points], axis=0)
            holds = reach <= radius * (1 + REAL(1e-13))  # false where the centre is not a number
            best = np.where(holds, np.minimum(best, radius), best)
    return best


def circumcentre(u, v=None, w=None):
    """Relative to the origin: the point of the span of u, v, w as far from 0 as from each of them."""
    if v is None:
        return u / 2
    if w is None:
        n = cross(u, v)
        return (dot(v, v)[:, None] * cross(n, u) + dot(u, u)[:, None] * cross(v, n)) / (2 * dot(n, n))[:, None]
    numerator = (dot(u, u)[:, None] * cross(v, w) + dot(v, v)[:, None] * cross(w, u) + dot(w, w)[:, None] * cross(u, v))
    return numerator / (2 * dot(u, cross(v, w)))[:, None]


# --- the measures ----------------------------------------------------------------------------------------------------

def triangle(a, b, c):
    """M11 to M15."""
    squares = np.stack([dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)])
    lengths = np.sqrt(squares)
    shortest, middle, longest = np.sort(lengths, axis=0)
    area = norm(cross(b - a, c - a)) / 2
    r = area / (lengths.sum(axis=0) / 2)
    l2 = squares.sum(axis=0) / 3
    # 9 l^4 - 48 A^2, without the cancellation
    spread = 2 * sum((squares[i] - squares[j]) ** 2 for i, j in ((0, 1), (1, 2), (2, 0)))
    sound = (area > 1e-15 * longest ** 2) & (shortest > 0)
    scores = {
        "M11": 2 * r / smallest_ball([a, b, c], (2, 3)),
        "M12": 3 * SQRT3 * r ** 2 / area,
        "M13": 4 * SQRT3 * area / (3 * l2),
        "M14": 4 * (SQRT3 + 2) ** (REAL(2) / 3) * area
        / (REAL(3) ** (REAL(5) / 6) * (longest * middle * (shortest + 4 * r)) ** (REAL(2) / 3)),
        "M15": 4 * SQRT3 * area / (3 * l2 + np.sqrt(spread)),
    }
    return {code: where_sound(sound, value) for code, value in scores.items()}


def interior_angles(corners):
    """Angles of shape (4, n), in radians; a re-entrant one, seen against the mean normal, is over pi."""
    normal = cross(corners[2] - corners[0], corners[3] - corners[1])
    angles = []
    for i in range(4):
        back, ahead = corners[i - 1] - corners[i], corners[(i + 1) % 4] - corners[i]
        own = cross(ahead, back)
        angle = np.arctan2(norm(own), dot(back, ahead))
        turned = dot(own, normal) < -1e-15 * norm(back) * norm(ahead) * norm(normal)
        angles.append(np.where(turned, 2 * REAL(np.pi) - angle, angle))
    return np.stack(angles)


def reentrant(a, b, c, d):
    """Whether a corner is over 180 degrees; of a bow-tie, whose sides cross, the corners of the smaller half are."""
    return (interior_angles([a, b, c, d]) > np.pi).any(axis=0)


def quadrilateral(a, b, c, d):
    """M21 to M23."""
    corners = [a, b, c, d]
    sides = np.stack([norm(corners[(i + 1) % 4] - corners[i]) for i in range(4)])
    diagonals = [c - a, d - b]
    normal = cross(*diagonals)
    flat = norm(normal) <= 1e-15 * norm(diagonals[0]) * norm(diagonals[1])
    unit = normal / np.where(flat, 1, norm(normal))[:, None]
    centre = (a + b + c + d) / 4
    height = np.mean([abs(dot(p - centre, unit)) for p in corners], axis=0)
    mean_diagonal = (norm(diagonals[0]) + norm(diagonals[1])) / 2
    angles = interior_angles(corners)
    sound = sides.min(axis=0) > 0
    return {
        "M21": where_sound(~flat, np.maximum(0, 1 - height / mean_diagonal)),
        "M22": where_sound(sound, sides.min(axis=0) / sides.max(axis=0)),
        "M23": where_sound(sound, angles.min(axis=0) / angles.max(axis=0)),
    }


def gradient_raw(corners):
    """M32 without the factor that makes it 1 for the regular tetrahedron."""
    volume = abs(signed_volume("tetrahedron", corners))
    areas = face_areas(corners)
    length = {}
    for i, j in itertools.combinations(range(4), 2):
        length[i, j] = length[j, i] = norm(corners[i] - corners[j])
    pairs = sum(areas[i] * areas[j] * length[i, j] ** 2 for i, j in itertools.combinations(range(4), 2))
    reach = np.max([sum(areas[j] * length[i, j] for j in range(4) if j != i) for i in range(4)], axis=0)
    return volume * (sum(areas) / (pairs + 6 * volume * reach)) ** (REAL(3) / 4)


def face_vectors(corners):
    """Area vectors of the faces opposite each corner, all outward (or all inward)."""
    a, b, c, d = corners
    return [cross(c - b, d - b) / 2, cross(d - a, c - a) / 2, cross(b - a, d - a) / 2, cross(c - a, b - a) / 2]


def face_areas(corners):
    return [norm(v) for v in face_vectors(corners)]


def tetrahedron(a, b, c, d):
    """M31 to M34."""
    corners = [a, b, c, d]
    volume = abs(signed_volume("tetrahedron", corners))
    squares = [dot(p - q, p - q) for p, q in itertools.combinations(corners, 2)]
    total = sum(squares)
    areas = face_areas(corners)
    # The roots of the report's eq. (14), times V, are the eigenvalues of this matrix.
    matrix = sum(v[:, :, None] * v[:, None, :] for v in face_vectors(corners)) / 9
    scale = np.trace(matrix, axis1=1, axis2=2)
    scale = np.where(scale > 0, scale, 1)
    mu = np.linalg.eigvalsh((matrix / scale[:, None, None]).astype(float))[:, 2].astype(REAL) * scale
    regular = [np.array([p], REAL) for p in ((1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1))]
    sound = volume > 1e-16 * np.max(squares, axis=0) ** REAL(1.5)
    scores = {
        "M31": 72 * SQRT3 * volume / total ** REAL(1.5),
        "M32": gradient_raw(corners) / gradient_raw(regular),
        "M33": volume / (SQRT3 * mu ** REAL(0.75)),
        "M34": 3 * (3 * volume / sum(areas)) / smallest_ball(corners, (2, 3, 4)),
    }
    return {code: where_sound(sound, value) for code, value in scores.items()}


# --- areas and volumes -----------------------------------------------------------------------------------------------

def signed_volume(shape, corners):
    """Exact volume of the (tri)linear element, by Gauss points of two a direction."""
    if shape == "tetrahedron":
        a, b, c, d = corners
        return dot(b - a, cross(c - a, d - a)) / 6
    if shape == "pyramid":
        return hexahedron_volume([*corners[:4], *[corners[4]] * 4])
    if shape == "wedge":
        a, b, c, d, e, f = corners
        return hexahedron_volume([a, b, c, c, d, e, f, f])
    return hexahedron_volume(corners)


def hexahedron_volume(corners):
    signs = np.array([(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1),
                      (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)], REAL)
    x = np.stack([p - corners[0] for p in corners], axis=1)
    volume = 0
    for point in itertools.product((-1, 1), repeat=3):
        xi = np.array(point, REAL) / SQRT3
        factors = (1 + signs * xi) / 2
        columns = []
        for k in range(3):
            slope = signs[:, k] / 2 * np.prod(np.delete(factors, k, axis=1), axis=1)
            columns.append((x * slope[None, :, None]).sum(axis=1))
        volume = volume + dot(columns[0], cross(columns[1], columns[2]))
    return volume


def area_vector(shape, corners):
    if shape == "triangle":
        a, b, c = corners
        return cross(b - a, c - a) / 2
    a, b, c, d = corners
    return cross(c - a, d - b) / 2


# --- a mesh and its statistics ---------------------------------------------------------------------------------------

@dataclass
class Block:
    """Elements of one type, in file order. `shape` is None for what is only counted."""
    shape: str | None
    order: int
    nodes: np.ndarray  # rows of the points: (n, nodes an element)
    corners: np.ndarray | None  # (n, corners)
    labels: np.ndarray  # the elements' own numbers


@dataclass
class Values:
    """All values of one measure on one shape, with the number of the element that each belongs to."""
    on: str
    value: np.ndarray
    label: np.ndarray


@dataclass
class Shape:
    """What is known of the elements of one shape."""
    count: int
    order: dict
    extent: float
    positive: int
    negative: int
    degenerate: int
    reentrant: int
    sizes: np.ndarray
    edges: np.ndarray
    measures: dict = field(default_factory=dict)


@dataclass
class Mesh:
    """Points and blocks as a peer holds them in memory."""
    points: np.ndarray
    blocks: list

    def relabelled(self, start):
        """The same mesh with elements numbered one after another, as formats without numbers have them."""
        blocks = []
        for b in self.blocks:
            blocks.append(Block(b.shape, b.order, b.nodes, b.corners, np.arange(start, start + len(b.nodes))))
            start += len(b.nodes)
        return Mesh(self.points, blocks)

    @property
    def element_count(self):
        return sum(len(b.nodes) for b in self.blocks)

    @property
    def unused(self):
        used = np.zeros(len(self.points), bool)
        for b in self.blocks:
            used[b.nodes] = True
        return int((~used).sum())

    @property
    def dimension(self):
        return max((3 if s in SOLIDS else 2 for s in self.shapes), default=0)

    @cached_property
    def shapes(self):
        found = {b.shape: None for b in self.blocks if b.shape and len(b.nodes)}
        return {shape: self.of_shape(shape) for shape in CORNERS if shape in found}

    def orientation(self, alone=()):
        """Inverted elements by shape, and how many are stored the other way round as a whole.

        Of either dimension the majority says which way is right; shapes in `alone` decide for themselves.
        """
        inverted, turned = {}, 0
        for name, shape in self.shapes.items():
            voters = [s for other, s in self.shapes.items() if other == name or not {name, other} & set(alone)
                      and (other in SOLIDS) == (name in SOLIDS)]
            reversed_ = sum(s.negative for s in voters) > sum(s.positive for s in voters)
            inverted[name] = shape.positive if reversed_ else shape.negative
            turned += shape.negative if reversed_ else 0
        return inverted, turned

    def of_shape(self, shape):
        blocks = [b for b in self.blocks if b.shape == shape and len(b.nodes)]
        rows = np.concatenate([b.corners for b in blocks])
        labels = np.concatenate([b.labels for b in blocks])
        points = np.asarray(self.points, float).astype(REAL)
        corners = [points[rows[:, i]] for i in range(CORNERS[shape])]
        edges = np.stack([norm(corners[i] - corners[j]) for i, j in EDGES[shape]])
        longest = edges.max(axis=0)
        if shape in SOLIDS:
            signed = signed_volume(shape, corners)
            none = abs(signed) <= 1e-15 * longest ** 3
        else:
            vector = area_vector(shape, corners)
            none = norm(vector) <= 1e-15 * longest ** 2
            planar = np.ptp(self.points[:, 2]) == 0
            signed = norm(vector) * (np.sign(vector[:, 2]) if planar else 1)
        degenerate = none | (edges.min(axis=0) == 0)
        positive, negative = int((~degenerate & (signed > 0)).sum()), int((~degenerate & (signed < 0)).sum())
        order = {}
        for b in blocks:
            order[str(b.order)] = order.get(str(b.order), 0) + len(b.nodes)
        found = Shape(
            count=len(rows), order=order, extent=float(abs(signed).sum()), positive=positive, negative=negative,
            degenerate=int(degenerate.sum()),
            reentrant=sum(int(reentrant(*(corners[c] for c in face)).sum()) for face in QUADRILATERALS.get(shape, [])),
            sizes=np.sqrt((edges ** 2).mean(axis=0)), edges=edges)
        if shape == "tetrahedron":
            add(found, "element", tetrahedron(*corners), labels)
        for faces, measure in ((TRIANGLES, triangle), (QUADRILATERALS, quadrilateral)):
            own = faces.get(shape, [])
            if own:
                scored = [measure(*(corners[c] for c in face)) for face in own]
                values = {code: np.concatenate([s[code] for s in scored]) for code in scored[0]}
                on = "element" if len(own[0]) == CORNERS[shape] else FACE_NAMES[len(own[0])]
                add(found, on, values, np.tile(labels, len(own)))
        return found


def add(found, on, scores, labels):
    for code, value in scores.items():
        found.measures[code] = Values(on, np.clip(value, 0, 1), labels)


def correlation(x, y):
    """Pearson's correlation."""
    x, y = x - x.mean(), y - y.mean()
    return float((x * y).sum() / np.sqrt((x * x).sum() * (y * y).sum()))


# --- the reference's own check ---------------------------------------------------------------------------------------

def golden(path):
    """Worst difference from values computed with 60 digits, relative to the larger of the value and 1e-3."""
    worst = {}
    functions = {"triangle": triangle, "quad": quadrilateral, "tetrahedron": tetrahedron}
    for line in open(path, encoding="utf-8"):
        row = json.loads(line)
        corners = [np.array([p], float).astype(REAL) for p in row["points"]]
        with np.errstate(all="ignore"):
            scores = functions[row["shape"]](*corners)
        for code, value in scores.items():
            true = REAL(row[code])
            off = float(abs(value[0] - true) / max(true, REAL(1e-3)))
            if off >= worst.get(code, (0,))[0]:
                worst[code] = (off, row["kind"], float(value[0]), float(true))
    return worst


if __name__ == "__main__":
    found = golden(sys.argv[1])
    for code, row in sorted(found.items()):
        print(code, *row)
    sys.exit(any(not row[0] <= 1e-11 for row in found.values()))
