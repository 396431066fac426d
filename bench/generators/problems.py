"""The model problems of the report, for the scripts beside this file.

A problem is named as in npl-2007.toml: `disc` (R = 25), `cylinder` (R = 25, H = 5) or `pit:DIAMETER:DEPTH:WIDTH`, a
specimen 25.4 long with one pit half-way along its side (section 6; all in mm). Sizes are element sizes; those of a
specimen hold at the pit and grow with the distance from it.
"""

import math

RADIUS, HEIGHT = 25.0, 5.0
LENGTH = 25.4
GROWTH = 0.25


class Pit:
    def __init__(self, text):
        _, diameter, depth, width = text.split(":")
        self.radius = float(diameter) / 2
        # As coarse as a polygon may be that lacks under half a per cent of its circle.
        self.coarsest = self.radius / 6
        self.depth = float(depth)
        self.mouth = float(width) / 2
        # The hemisphere's centre; a shaft leads from it to the surface where the pit is deeper than its half width.
        self.centre = (self.radius - (self.depth - self.mouth), 0.0, LENGTH / 2)

    def size(self, size, x, y, z):
        """Element size at a point, where it is `size` at the pit."""
        away = math.dist((x, y, z), self.centre) - self.mouth
        return min(size + GROWTH * max(away, 0.0), self.coarsest)

    def field(self, size):
        """The same as a formula of Gmsh."""
        cx, cy, cz = self.centre
        away = f"(Sqrt((x-{cx})^2+(y-{cy})^2+(z-{cz})^2)-{self.mouth})"
        grown = f"{size}+{GROWTH}*0.5*({away}+Fabs({away}))"
        cap = self.coarsest
        return f"0.5*({grown}+{cap}-Fabs({grown}-{cap}))"


def circle(size):
    """Points at equal angles on the disc's circle, about `size` apart."""
    count = max(12, round(2 * math.pi * RADIUS / size))
    return [(RADIUS * math.cos(2 * math.pi * k / count), RADIUS * math.sin(2 * math.pi * k / count)) for k in range(count)]


def write_medit(path, points, shapes):
    """A MEDIT text file; `shapes` are pairs of a keyword ("Triangles") and rows of node numbers from 0."""
    dimension = len(points[0])
    with open(path, "w") as out:
        print(f"MeshVersionFormatted 2\nDimension {dimension}\nVertices\n{len(points)}", file=out)
        for point in points:
            print(*(repr(float(x)) for x in point), 0, file=out)
        for keyword, rows in shapes:
            print(f"{keyword}\n{len(rows)}", file=out)
            for row in rows:
                print(*(int(node) + 1 for node in row), 1, file=out)
        print("End", file=out)
