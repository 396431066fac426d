"""python rerun.py RESULTS.json NPL_TABLES.csv: the report's tables of 2007 beside those of a run, and its claims by number.

RESULTS.json is what `meshgauge bench-generators npl-2007.toml --format json` prints. The Markdown goes to standard
output; docs/NPL-RERUN.md holds it below its last heading.
"""

import csv
import json
import sys
from collections import defaultdict

TRIANGLE = ["M11", "M12", "M13", "M14", "M15"]
QUADRILATERAL = ["M21", "M22", "M23"]
TETRAHEDRON = ["M31", "M32", "M33", "M34"]

# Number, title, problems (none: the specimens), shapes with what is put behind a mesh's name, measures.
TABLES = [
    ("1", "Triangular meshes of the disc", ["disc"], {"triangle": ""}, TRIANGLE),
    ("2", "Triangular faces of wedges", ["cylinder"], {"wedge": ""}, TRIANGLE),
    ("3", "Quadrilateral meshes of the disc", ["disc"], {"quadrilateral": ""}, QUADRILATERAL),
    ("4", "Quadrilateral faces of hexahedra", ["cylinder"], {"hexahedron": ""}, QUADRILATERAL),
    ("5", "Quadrilateral faces of wedges", ["cylinder"], {"wedge": ""}, QUADRILATERAL),
    ("6", "Tetrahedral meshes of the cylinder", ["cylinder"], {"tetrahedron": ""}, TETRAHEDRON),
    ("8", "Tetrahedra of the specimens", None, {"tetrahedron": ""}, TETRAHEDRON),
    ("9", "Quadrilateral faces of the specimens' hexahedra and wedges", None, {"wedge": " W", "hexahedron": " H"}, QUADRILATERAL),
    ("10", "Triangular faces of the specimens' wedges", None, {"wedge": ""}, TRIANGLE),
]


def row(cells):
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def head(cells):
    return "\n".join([row(cells), "|---|" + "---:|" * (len(cells) - 1)])


def cell(least, mean, deviation, element):
    return f"{float(least):.3f} ({element}) {float(mean):.3f} ± {float(deviation):.3f}"


def runs(rows):
    print("\n### How the generators ran\n")
    print(head(["problem, mesh", "version", "nodes", "elements", "size error", "CPU seconds", "memory", "outcome"]))
    for r in rows:
        found = r["nodes"] is not None
        print(row([
            f"{r['problem']}, {r['generator']}",
            r["version"] or "",
            r["nodes"] or "",
            r["elements"] or "",
            f"{100 * r['relative_error']:.3f} %" if found else "",
            f"{r['cpu_seconds']:.1f}" if r["cpu_seconds"] else "",
            f"{r['peak_rss_bytes'] / 1e6:.0f} MB" if r["peak_rss_bytes"] else "",
            r["outcome"] if found and r["outcome"] == "fine" else (r["reason"] or r["outcome"]).replace("|", "/")[:90],
        ]))


def tables(rows, published):
    for number, title, problems, shapes, measures in TABLES:
        here = [r for r in rows if r["summary"]]
        here = [r for r in here if (r["problem"] in problems if problems else r["problem"].startswith("pit"))]
        print(f"\n### Table {number}: {title}\n\nMinimum (in element) mean ± standard deviation.\n")
        print(head(["mesh"] + measures))
        old = defaultdict(dict)
        for p in published:
            if p["table"] == number:
                old[p["mesh"]][p["measure"]] = cell(p["min"], p["mean"], p["sd"], p["min_element"])
        for mesh, cells in old.items():
            print(row([f"2007: {mesh}"] + [cells.get(m, "") for m in measures]))
        for r, shape in [(r, shape) for r in here for shape in shapes if shape in r["summary"]["shapes"]]:
            found = r["summary"]["shapes"][shape]["measures"]
            name = r["generator"] if problems else f"{r['problem']}, {r['generator']}"
            cells = [cell(found[m]["min"], found[m]["mean"], found[m]["sd"], found[m]["min_element"]) for m in measures]
            print(row([f"**{name}{shapes[shape]}**"] + cells))


def spread(values):
    return f"{min(values):.3f} to {max(values):.3f}" if values else "none"


def of(rows, shape):
    return [(r, r["summary"]["shapes"][shape]) for r in rows if r["summary"] and shape in r["summary"]["shapes"]]


def claims(rows):
    print("\n### The claims, by number\n")
    # Some generators write the boundary of a solid too.
    plane = [r for r in rows if r["problem"] == "disc"]
    triangles = of(plane, "triangle")
    tetrahedra = of(rows, "tetrahedron")
    quadrilaterals = of(plane, "quadrilateral")

    def count(found, what):
        return f"{sum(map(what, found))} of {len(found)}"

    def extreme(which, code, statistic):
        return lambda pair: which(pair[1]["measures"], key=lambda m: pair[1]["measures"][m][statistic]) == code

    print("-", "M15 has the lowest minimum of the five in", count(triangles, extreme(min, "M15", "min")), "meshes of triangles, the lowest mean in", count(triangles, extreme(min, "M15", "mean")))
    print("-", "M33 has the lowest minimum of the four in", count(tetrahedra, extreme(min, "M33", "min")), "meshes of tetrahedra, the lowest mean in", count(tetrahedra, extreme(min, "M33", "mean")))
    print("-", "M14 has the highest minimum of the five in", count(triangles, extreme(max, "M14", "min")), "meshes of triangles, the highest mean in", count(triangles, extreme(max, "M14", "mean")))
    for name, found in [("triangles", triangles), ("tetrahedra", tetrahedra), ("quadrilaterals", quadrilaterals)]:
        same = lambda pair: len({m["min_element"] for m in pair[1]["measures"].values()}) == 1
        print("-", f"one element has the minimum of all measures in {count(found, same)} meshes of {name}")
        pairs = defaultdict(list)
        for _, shape in found:
            for pair, r in shape["correlation"].items():
                if r is not None:
                    pairs[pair].append(r)
        print("-", f"correlation on {name}:", "; ".join(f"{pair} {spread(values)}" for pair, values in pairs.items()))
    ordering = [value for _, shape in tetrahedra for value in shape.get("ordering", {}).values()]
    print("-", "share of tetrahedra with M32 >= M34 >= M31 >= M33:", spread(ordering), f"mean {sum(ordering) / max(1, len(ordering)):.3f}")
    for problem in ("disc", "cylinder", "pit"):
        errors = [(abs(r["relative_error"]), r["generator"]) for r in rows if r["summary"] and r["problem"].startswith(problem)]
        if errors:
            under = sum(error < 0.0005 for error, _ in errors)
            print("-", f"{problem}: {len(errors)} meshes, area or volume off by {100 * min(errors)[0]:.4f} % to {100 * max(errors)[0]:.3f} % ({max(errors)[1]}); {under} within 0.05 %")
    worst = lambda found: [min(m["min"] for m in shape["measures"].values()) for _, shape in found]
    print("-", "worst minimum of any measure, disc: triangles", spread(worst(triangles)), "; quadrilaterals", spread(worst(quadrilaterals)))
    for name, code, found in [("triangles", "M15", triangles), ("tetrahedra", "M33", tetrahedra)]:
        shares = []
        for _, shape in found:
            m = shape["measures"][code]
            near = int(min(99, 100 * (m["min"] + 0.05)))
            shares.append(sum(m["histogram"][: near + 1]) / m["count"])
        print("-", f"share of {name} within 0.05 of the minimum of {code}:", spread(shares))


def main():
    rows = []
    for path in sys.argv[1:-1]:
        with open(path) as file:
            rows += json.load(file)
    with open(sys.argv[-1]) as file:
        published = list(csv.DictReader(file))
    claims(rows)
    runs(rows)
    tables(rows, published)


if __name__ == "__main__":
    main()
