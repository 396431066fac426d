"""Holds meshes that OpenFOAM's blockMesh makes of its tutorials against checkMesh: cells by class, and the volume.

    python openfoam.py TUTORIALS [--every N] [--program MESHGAUGE]

Needs blockMesh and checkMesh, with WM_PROJECT_DIR set as Debian's package openfoam leaves it (/usr/share/openfoam). Every other
case is written in binary. The exit status is 1 if any case differs.
"""
import argparse
import json
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CLASSES = {"hexahedra": "hex", "prisms": "prism", "wedges": "wedge", "pyramids": "pyr", "tet wedges": "tetWedge",
           "tetrahedra": "tet", "polyhedra": "polyhedron"}
NOT_MEASURED = ("wedges", "tet wedges", "polyhedra")


def run(case, *command):
    try:
        return subprocess.run(command, cwd=case, capture_output=True, text=True, errors="replace", timeout=120).stdout
    except subprocess.TimeoutExpired:
        return ""


def prepare(source, case, binary):
    """Copies a tutorial, with nothing in its controlDict that needs a solver."""
    shutil.copytree(source, case, ignore_dangling_symlinks=True)
    for packed in case.rglob("*.gz"):
        subprocess.run(["gunzip", "-qf", packed], check=False)
    control = case / "system/controlDict"
    text = control.read_text(errors="replace")
    text = re.sub(r"(?s)functions\s*\{.*", "", text)
    text = re.sub(r"(?m)^\s*#include.*$|^libs.*$", "", text)
    text = re.sub(r"writeFormat\s+\w+;", f"writeFormat {'binary' if binary else 'ascii'};", text)
    control.write_text(re.sub(r"writePrecision\s+\d+;", "writePrecision 12;", text))


def compare(case, program):
    """What differs; None where OpenFOAM itself made no mesh."""
    run(case, "blockMesh")
    told = run(case, "checkMesh", "-noFunctionObjects")
    if "Overall number of cells" not in told:
        return None
    expected = {name: int(re.search(rf"^\s*{name}:\s+(\d+)", told, re.M)[1]) for name in CLASSES}
    scored = run(case, program, "score", "--no-progress", "--no-run-info", "--format", "json", str(case))
    summary = json.loads(scored)
    types = summary["elements"]["by_type"]
    found = {name: types.get(ours, 0) for name, ours in CLASSES.items()}
    wrong = [] if found == expected else [f"{found}, not {expected}"]
    volume = re.search(r"Total volume = ([-+\d.e]+[\de])", told)
    if volume and not any(expected[name] for name in NOT_MEASURED):
        ours, theirs = summary["totals"]["volume"], float(volume[1])
        if abs(ours - theirs) > 1e-4 * abs(theirs):
            wrong.append(f"volume {ours}, not {theirs}")
    return wrong


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("tutorials", type=Path)
    arguments.add_argument("--every", type=int, default=1)
    arguments.add_argument("--program", default=str(ROOT / "target/release/meshgauge"))
    given = arguments.parse_args()
    cases = sorted(path.parents[1] for path in given.tutorials.rglob("system/blockMeshDict*"))
    compared = differing = 0
    for number, source in enumerate(cases[:: given.every]):
        if not (source / "system/controlDict").exists() and not (source / "system/controlDict.gz").exists():
            continue
        with tempfile.TemporaryDirectory() as folder:
            case = Path(folder) / source.name
            prepare(source, case, number % 2)
            wrong = compare(case, given.program)
        if wrong is not None:
            compared += 1
            differing += bool(wrong)
            print(f"{source}: {'; '.join(wrong) or 'the same'}", flush=True)
    print(f"{compared} compared, {differing} differ")
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())
