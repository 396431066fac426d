"""Scores every mesh of the gallery with meshgauge and holds the summaries against the reference.

    python check.py [--only TEXT] [--keep DIR] [MESHGAUGE]

MESHGAUGE (or the variable of that name) is the program; only files with TEXT in their names are scored. Counts, element
numbers and bins must be exact, the rest to 1e-9. What the last bits decide may fall either way and is counted: a value
within 1e-12 of a bin's edge, minima or an order of measures that differ by less than that.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

import numpy as np

import gallery
import reference
from reference import CORNERS, SOLIDS, correlation

TOLERANCE = 1e-9
LAST_BITS = 1e-12
BINS = 100
# Cells of the quantiles' histogram are 1/1024 wide; a quantile may also be a neighbour in rank.
QUANTILE = 2.0 / 1024
# The mesh by which the check itself is checked: all shapes, and no ties that would let a wrong figure pass.
SEEN = "vtk-flawed.vtu"
VTK_FORMATS = ("vtk", "vtu", "vtkhdf")
ORDERING = ("M32", "M34", "M31", "M33")


class Comparison:
    """Differences found in one summary."""

    def __init__(self):
        self.wrong = []
        self.ties = 0

    def equal(self, what, got, expected):
        if got != expected:
            self.wrong.append(f"{what}: {got} instead of {expected}")

    def close(self, what, got, expected, scale=1.0, tolerance=TOLERANCE):
        if got is None or not abs(got - expected) <= tolerance * scale:
            self.wrong.append(f"{what}: {got!r} instead of {expected!r}")

    def between(self, what, got, low, high):
        """A count that ties may move; says how far they could."""
        self.ties += int(high - low)
        if not low <= got <= high:
            self.wrong.append(f"{what}: {got} is not in {low}..{high}")


def compare(summary, mesh):
    found = Comparison()
    compare_nodes(found, summary, mesh)
    compare_elements(found, summary, mesh)
    found.equal("shapes", list(summary["shapes"]), list(mesh.shapes))
    for name, shape in mesh.shapes.items():
        if name in summary["shapes"]:
            compare_shape(found, name, summary["shapes"][name], shape)
    compare_whole(found, summary, mesh)
    return found


def compare_nodes(found, summary, mesh):
    nodes, unused = summary["nodes"], mesh.unused
    found.equal("nodes", nodes["count"], len(mesh.points))
    found.equal("unused nodes", nodes["unused"], unused)
    found.equal("check of unused nodes", summary["checks"]["unused_nodes"], unused)
    for side, extreme in (("min", mesh.points.min(axis=0)), ("max", mesh.points.max(axis=0))):
        for axis in range(3):
            size = max(1.0, abs(extreme[axis]))
            found.close(f"bounds {side} {'xyz'[axis]}", nodes["bounds"][side][axis], extreme[axis], size, 1e-15)


def compare_elements(found, summary, mesh):
    elements = summary["elements"]
    found.equal("elements", elements["count"], mesh.element_count)
    found.equal("elements by type", sum(elements["by_type"].values()), mesh.element_count)
    counted = sum(len(b.nodes) for b in mesh.blocks if b.shape is None)
    found.equal("not measured", sum(elements["not_measured"].values()), counted)
    repeats = sum(int((np.diff(np.sort(b.corners, axis=1), axis=1) == 0).any(axis=1).sum())
                  for b in mesh.blocks if b.shape)
    found.equal("repeated nodes", summary["checks"]["repeated_nodes"], repeats)
    found.equal("missing nodes", summary["checks"]["missing_nodes"], 0)
    # Those are of meshes that are cut up for several processors; none of these is.
    found.equal("ghost elements", summary["checks"]["ghost_elements"], 0)


def compare_shape(found, name, got, shape):
    found.equal(f"{name} count", got["count"], shape.count)
    found.equal(f"{name} order", got["order"], shape.order)
    found.equal(f"{name} degenerate", got["degenerate"], shape.degenerate)
    found.close(f"{name} extent", got["volume" if name in SOLIDS else "area"], shape.extent, shape.extent)
    found.equal(f"{name} measures", list(got["measures"]), list(shape.measures))
    for code, values in shape.measures.items():
        if code in got["measures"]:
            compare_measure(found, f"{name} {code}", got["measures"][code], values)
    for pair, r in got["correlation"].items():
        compare_correlation(found, f"{name} {pair}", r, *(shape.measures[code].value for code in pair.split()))
    if name == "tetrahedron":
        compare_ordering(found, got["ordering"], shape)


def compare_measure(found, what, got, values):
    value = values.value
    found.equal(f"{what} on", got["on"], values.on)
    found.equal(f"{what} count", got["count"], len(value))
    for statistic, expected in (("max", value.max()), ("min", value.min()), ("mean", value.mean()),
                                ("sd", value.std())):
        found.close(f"{what} {statistic}", got[statistic], float(expected))
    compare_min_element(found, what, got["min_element"], values)
    compare_bins(found, what, got["histogram"], value)
    compare_quantiles(found, what, got["quantiles"], value)


def compare_min_element(found, what, got, values):
    """Of equal minima the first in the file, and where rounding may order them any of them."""
    least = values.label[values.value <= values.value.min() + LAST_BITS]
    found.ties += len(set(least.tolist())) > 1
    if got not in least and np.ptp(least) == 0:
        found.equal(f"{what} min_element", got, int(least[0]))
    elif got not in least:
        found.wrong.append(f"{what} min_element: {got} is not one of {sorted(set(least.tolist()))[:5]}")
    elif values.value.min() == 0 and (values.value[values.label == got] == 0).any():
        found.equal(f"{what} first element that scores 0", got, int(values.label[np.argmin(values.value)]))


def compare_bins(found, what, got, value):
    """Held against running totals, so that a value near an edge is let through at this edge alone."""
    found.equal(f"{what} bins", len(got), BINS)
    total = np.cumsum(got)
    found.equal(f"{what} bins' total", int(total[-1]), len(value))
    edges = np.arange(1, BINS) / BINS
    below = np.sort(value)
    low = np.searchsorted(below, edges - LAST_BITS)
    high = np.searchsorted(below, edges + LAST_BITS)
    for k, edge in enumerate(edges):
        found.between(f"{what} values under {edge}", int(total[k]), int(low[k]), int(high[k]))


def compare_quantiles(found, what, got, value):
    ordered = np.sort(np.asarray(value, float))
    for key, quantile in got.items():
        rank = float(key) * len(ordered)
        low = ordered[max(0, int(np.floor(rank)) - 1)]
        high = ordered[min(len(ordered) - 1, int(np.ceil(rank)))]
        if not low * (1 - QUANTILE) - 1e-8 <= quantile <= high * (1 + QUANTILE) + 1e-8:
            found.wrong.append(f"{what} quantile {key}: {quantile} is not in {low}..{high}")


def compare_correlation(found, what, got, x, y):
    spread = float(min(x.std(), y.std()))
    if spread > 1e-6:  # else it is of rounding errors
        found.close(f"{what} correlation", got, correlation(x, y), tolerance=max(TOLERANCE, LAST_BITS / spread))


def compare_ordering(found, got, shape):
    columns = [shape.measures[code].value for code in ORDERING]
    sure = np.all([a >= b + LAST_BITS for a, b in zip(columns, columns[1:])], axis=0).sum()
    perhaps = np.all([a >= b - LAST_BITS for a, b in zip(columns, columns[1:])], axis=0).sum()
    share = got.get(">=".join(ORDERING), -1)
    found.equal("ordering", len(got), 1)
    ordered = round(share * shape.count)
    found.between("ordering", ordered, int(sure), int(perhaps))
    found.close("ordering's share", share, ordered / shape.count)


def compare_whole(found, summary, mesh):
    own = {name: s for name, s in mesh.shapes.items() if (name in SOLIDS) == (mesh.dimension == 3)}
    extent = sum(s.extent for s in own.values())
    used, unused = ("volume", "area") if mesh.dimension == 3 else ("area", "volume")
    found.close(f"total {used}", summary["totals"][used], extent, extent)
    found.equal(f"total {unused}", summary["totals"][unused], None)
    edges = np.concatenate([s.edges.ravel() for s in own.values()])
    sizes = np.concatenate([s.sizes for s in own.values()])
    edge_length, element_size = summary["sizes"]["edge_length"], summary["sizes"]["element_size"]
    largest = float(edges.max())
    found.close("shortest edge", edge_length["min"], float(edges.min()), largest)
    found.close("longest edge", edge_length["max"], largest, largest)
    for statistic, expected in (("min", sizes.min()), ("max", sizes.max()), ("mean", sizes.mean())):
        found.close(f"element size {statistic}", element_size[statistic], float(expected), largest)
    compare_quantiles(found, "element size", element_size["quantiles"], sizes)
    compare_checks(found, summary, mesh)


def compare_checks(found, summary, mesh):
    # Writers of VTK files do not agree which way round a wedge is.
    alone = ("wedge",) if summary["mesh"]["format"] in (*VTK_FORMATS, "xdmf") else ()
    inverted, turned = mesh.orientation(alone)
    found.equal("inverted", {name: s["inverted"] for name, s in summary["shapes"].items()}, inverted)
    checks = summary["checks"]
    found.equal("check of inverted", checks["inverted"], sum(inverted.values()))
    found.equal("check of reversed", checks["reversed"], turned)
    found.equal("check of degenerate", checks["degenerate"], sum(s.degenerate for s in mesh.shapes.values()))
    flawed = checks["concave_faces"] + checks["crossed_faces"]
    found.equal("concave and crossed faces", flawed, sum(s.reentrant for s in mesh.shapes.values()))


def score(program, path, threads):
    """Runs the program; it may say that the mesh fails (status 1) but must have scored it."""
    command = [program, "score", "--format", "json", "--no-progress", "--threads", str(threads), str(path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    if done.returncode not in (0, 1):
        raise RuntimeError(f"exit status {done.returncode}: {done.stderr.strip()[-500:]}")
    return json.loads(done.stdout)


def check_case(program, case, threads):
    try:
        return compare(score(program, case.path, threads), case.mesh)
    except (RuntimeError, KeyError, TypeError, ValueError, subprocess.TimeoutExpired) as error:
        failed = Comparison()
        failed.wrong.append(f"{type(error).__name__}: {error}")
        return failed


def figures(value, path=()):
    """Every number of a summary, as a path to it; of a histogram one bin."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from figures(inner, (*path, key))
    elif isinstance(value, list):
        places = range(len(value)) if len(value) < BINS else [BINS // 2]
        for place in places:
            yield from figures(value[place], (*path, place))
    elif value is not None and not isinstance(value, str):
        yield path


def unseen(summary, mesh):
    """Numbers that could be wrong without the comparison's seeing it: each is changed in turn."""
    held = {key: summary[key] for key in ("mesh", "nodes", "elements", "shapes", "totals", "sizes", "checks")}
    del held["mesh"]["bytes"]
    for path in figures(held):
        place = held
        for key in path[:-1]:
            place = place[key]
        right = place[path[-1]]
        # A quantile may lie anywhere between two elements; it must still lie there.
        place[path[-1]] = right + (1 if isinstance(right, int) else 2.0 if "quantiles" in path else 1e-6)
        if not compare(held, mesh).wrong:
            yield path
        place[path[-1]] = right


def check_reference(path):
    """The reference itself must hold before anything is held against it."""
    worst = max(row[0] for row in reference.golden(path).values())
    print(f"reference: worst difference from 25 digits is {worst:.1e}", flush=True)
    return worst <= 1e-11


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program", nargs="?", default=os.environ.get("MESHGAUGE", "meshgauge"))
    parser.add_argument("--only", default="", help="score only files with this in their names")
    parser.add_argument("--keep", type=Path, help="write the meshes here and leave them")
    arguments = parser.parse_args()
    golden = Path(__file__).parent.parent / "golden" / "golden.jsonl"
    if not check_reference(golden):
        return 1
    tally, ties, blind = Counter(), 0, []
    with tempfile.TemporaryDirectory(prefix="meshgauge-peers-") as temporary:
        folder = arguments.keep or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        for number, case in enumerate(gallery.cases(folder)):
            if arguments.only in case.path.name:
                found = check_case(arguments.program, case, 1 + number % 2)
                tally[not found.wrong] += 1
                ties += found.ties
                report(case, found)
                if case.path.name == SEEN and not found.wrong:
                    blind = list(unseen(score(arguments.program, case.path, 1), case.mesh))
            if not arguments.keep:
                case.path.unlink()
    print(f"{ties} values, minima and orders were ties within {LAST_BITS}")
    for path in blind:
        print("FAILED the check itself: a wrong figure went unseen:", *path)
    print(f"{tally[True]} passed, {tally[False]} failed")
    return 0 if tally[True] and not tally[False] and not blind else 1


def report(case, found):
    word = "FAILED" if found.wrong else "ok"
    print(f"{word:6} {case.path.name}: {case.mesh.element_count} elements, {found.ties} ties", flush=True)
    for line in found.wrong[:12]:
        print(f"         {line}")
    if len(found.wrong) > 12:
        print(f"         and {len(found.wrong) - 12} more")


if __name__ == "__main__":
    with np.errstate(all="ignore"):
        sys.exit(main())
