"""Times meshgauge and its peers as whole processes, from a file on disk to statistics, in one interleaved run.

    python bench/run.py [--work DIR] [--program PATH] [--rounds N] [--check]

Makes the meshes with Gmsh once and keeps them in DIR. All contenders run by turns, so that whatever else the machine
does meets all of them, and ratios are taken round by round. Rewrites the table in bench/README.md, writes every sample
to DIR/samples.json and, with Matplotlib, a plot to DIR/wall.svg. With --check it writes nothing, and fails where a ratio
is beyond its bound.

The measuring process imports no package: a child's peak memory is never told as less than its parent's.
"""
import argparse
import importlib.metadata
import importlib.util
import json
import os
import platform
import statistics
import subprocess
import sys
import time
from dataclasses import dataclass, field
from datetime import date
from pathlib import Path

HERE = Path(__file__).resolve().parent
README = HERE / "README.md"
MARKERS = ("<!-- begin table -->", "<!-- end table -->")
# How many times faster than a peer's process meshgauge with one thread must be: far less than it is, as machines differ.
BOUNDS = {("box.msh", "gmsh"): 2.0, ("box.vtu", "vtk"): 1.2, ("box.inp", "meshio"): 6.0}
TITLES = {"box.msh": "MSH 4.1 binary", "box.inp": "Abaqus", "box.vtk": "VTK legacy binary", "box.vtu": "VTU appended raw"}


# --- what peers do, each in a process of its own ---------------------------------------------------------------------

def make_inputs(folder):
    """A box of about 1.1 million tetrahedra by Gmsh; the same mesh in four files."""
    import gmsh
    import numpy as np
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Verbosity", 2)
    gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
    gmsh.model.occ.synchronize()
    for option, value in (("Mesh.MeshSizeMin", 0.0151), ("Mesh.MeshSizeMax", 0.0151), ("Mesh.Algorithm3D", 10),
                          ("General.NumThreads", 2)):
        gmsh.option.setNumber(option, value)
    gmsh.model.mesh.generate(3)
    gmsh.model.addPhysicalGroup(3, [1])
    gmsh.option.setNumber("Mesh.Binary", 1)
    gmsh.write(str(folder / "box.msh"))
    gmsh.write(str(folder / "box.inp"))
    tags, points, _ = gmsh.model.mesh.getNodes()
    rows = np.zeros(int(tags.max()) + 1, np.int64)
    rows[tags] = np.arange(len(tags))
    _, nodes = gmsh.model.mesh.getElementsByType(4)
    write_vtk(folder, points.reshape(-1, 3), rows[nodes].reshape(-1, 4))


def write_vtk(folder, points, cells):
    import numpy as np
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    grid, array, place = vtk.vtkUnstructuredGrid(), vtk.vtkCellArray(), vtk.vtkPoints()
    place.SetData(numpy_to_vtk(points, deep=True))
    grid.SetPoints(place)
    array.SetData(numpy_to_vtkIdTypeArray(4 * np.arange(len(cells) + 1), deep=True),
                  numpy_to_vtkIdTypeArray(cells.ravel(), deep=True))
    grid.SetCells(vtk.VTK_TETRA, array)
    legacy, xml = vtk.vtkUnstructuredGridWriter(), vtk.vtkXMLUnstructuredGridWriter()
    legacy.SetFileTypeToBinary()
    xml.SetDataModeToAppended()
    xml.EncodeAppendedDataOff()
    xml.SetCompressorTypeToNone()
    xml.SetHeaderTypeToUInt64()
    for writer, name in ((legacy, "box.vtk"), (xml, "box.vtu")):
        writer.SetFileName(str(folder / name))
        writer.SetInputData(grid)
        assert writer.Write() == 1


def show(values):
    print(len(values), values.max(), values.min(), values.mean(), values.std())


def with_vtk(path):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkFiltersVerdict import vtkMeshQuality
    from vtkmodules.vtkIOLegacy import vtkUnstructuredGridReader
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
    reader = vtkXMLUnstructuredGridReader() if path.endswith("vtu") else vtkUnstructuredGridReader()
    reader.SetFileName(path)
    quality = vtkMeshQuality()
    quality.SetInputConnection(reader.GetOutputPort())
    quality.SetTetQualityMeasureToRadiusRatio()
    quality.Update()
    show(vtk_to_numpy(quality.GetOutput().GetCellData().GetArray("Quality")))


def with_gmsh(path):
    import gmsh
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Verbosity", 1)
    gmsh.open(path)
    tags, _ = gmsh.model.mesh.getElementsByType(4)
    show(gmsh.model.mesh.getElementQualities(tags, "gamma"))


def with_meshio(path):
    import meshio
    mesh = meshio.read(path)
    print(sum(len(block) for block in mesh.cells))


def with_pyvista(path):
    import pyvista
    show(pyvista.read(path).cell_quality("radius_ratio")["radius_ratio"])


PEERS = {"vtk": with_vtk, "gmsh": with_gmsh, "meshio": with_meshio, "pyvista": with_pyvista}
WORK = {"vtk": "1 measure, 4 statistics", "gmsh": "1 measure, 4 statistics", "meshio": "reads only", "pyvista": "1 measure, 4 statistics"}
READ_BY = {"vtk": ("box.vtk", "box.vtu"), "gmsh": ("box.msh",), "meshio": ("box.msh", "box.inp"), "pyvista": ("box.vtu",)}


# --- measuring -------------------------------------------------------------------------------------------------------

@dataclass
class Contender:
    """A program on a file, and what its runs took."""
    name: str
    work: str
    file: str
    command: list
    wall: list = field(default_factory=list)
    cpu: list = field(default_factory=list)
    peak: int = 0

    def run(self, counts):
        started = time.perf_counter()
        child = subprocess.Popen(self.command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        complaint = child.stderr.read()
        _, status, used = os.wait4(child.pid, 0)
        wall = time.perf_counter() - started
        child.returncode = os.waitstatus_to_exitcode(status)
        if child.returncode not in (0, 1):  # 1: scored, and judged unfit
            raise SystemExit(f"{self.command}: status {child.returncode}: {complaint.decode()[-2000:]}")
        if counts:
            self.wall.append(wall)
            self.cpu.append(used.ru_utime + used.ru_stime)
            self.peak = max(self.peak, used.ru_maxrss * 1024)


def contenders(program, folder):
    found = []
    for file in TITLES:
        path = str(folder / file)
        for threads in (1, 2):
            command = [program, "score", "--format", "json", "--no-progress", "--threads", str(threads), path]
            found.append(Contender(f"meshgauge, {threads} thread{'s' * (threads > 1)}", "4 measures, all statistics", file, command))
        for peer, files in READ_BY.items():
            if file in files and importlib.util.find_spec(peer):
                command = [sys.executable, __file__, "--peer", peer, path]
                found.append(Contender(f"{peer} {importlib.metadata.version(peer)}", WORK[peer], file, command))
    return found


def ratios(run, base):
    """Wall of a contender over that of another, round by round: median, smallest, largest."""
    found = [mine / theirs for mine, theirs in zip(run.wall, base.wall)]
    return statistics.median(found), min(found), max(found)


def check(runs):
    """Fails where meshgauge with one thread is not as many times faster than a peer as it must be."""
    slow = []
    for (file, peer), bound in BOUNDS.items():
        own = [run for run in runs if run.file == file]
        for run in own:
            if run.name.startswith(peer):
                ratio, least, most = ratios(run, own[0])
                print(f"{file}: {run.name} takes {ratio:.1f} times as long ({least:.1f} to {most:.1f}); at least {bound}")
                slow += [run.name] * (ratio < bound)
    if slow:
        raise SystemExit(f"too slow beside {', '.join(slow)}")


def keep_samples(runs, folder):
    rows = [{"file": run.file, "contender": run.name, "wall": run.wall, "cpu": run.cpu, "peak": run.peak} for run in runs]
    (folder / "samples.json").write_text(json.dumps(rows, indent=1), encoding="utf-8")
    for run in runs:
        print(f"{run.file} {run.name}: " + " ".join(f"{wall:.3f}" for wall in run.wall))


def plot(folder):
    """Every sample of wall time, by file and contender."""
    import matplotlib
    matplotlib.use("svg")
    import matplotlib.pyplot as plt
    rows = json.loads((folder / "samples.json").read_text(encoding="utf-8"))
    figure, axes = plt.subplots(figsize=(8, 0.4 * len(rows) + 1), layout="constrained")
    for place, row in enumerate(rows):
        axes.plot(row["wall"], [place] * len(row["wall"]), "|", color="tab:blue" if "meshgauge" in row["contender"] else "tab:gray")
    axes.set_yticks(range(len(rows)), [f"{row['contender']}, {row['file']}" for row in rows], fontsize=8)
    axes.invert_yaxis()
    axes.set_xscale("log")
    axes.set_xlabel("wall of the whole process, s")
    figure.savefig(folder / "wall.svg")


def machine():
    lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    cpu = next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), platform.processor())
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2 ** 30
    return f"{cpu}, {os.cpu_count()} processors, {memory:.0f} GiB, {platform.system()} {platform.release()}"


def table(runs, folder, rounds, program, load):
    version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    lines = [
        f"{date.today()}, {version}, Python {platform.python_version()}; {machine()}.",
        f"{elements(program, folder):,} tetrahedra; {rounds} rounds after one that does not count; files in the page cache.",
        f"Load average before the run {load[0]:.1f}, after it {os.getloadavg()[0]:.1f}"
        + ("; other work shared the machine." if load[0] > 0.5 else "."),
        "",
        "| file | MB | contender | does | wall median, s | wall min, s | CPU median, s | peak, MB | wall ratio (range) | peak ratio |",
        "|---|---:|---|---|---:|---:|---:|---:|---:|---:|",
    ]
    for file, title in TITLES.items():
        own = [run for run in runs if run.file == file]
        base = own[0]
        for run in own:
            size = (folder / file).stat().st_size / 1e6
            wall, cpu = statistics.median(run.wall), statistics.median(run.cpu)
            ratio, least, most = ratios(run, base)
            lines.append(
                f"| {title} | {size:.0f} | {run.name} | {run.work} | {wall:.3f} | {min(run.wall):.3f} | {cpu:.3f} | "
                f"{run.peak / 1e6:.0f} | {ratio:.2f} ({least:.2f}-{most:.2f}) | {run.peak / base.peak:.2f} |")
    return "\n".join(lines)


def elements(program, folder):
    command = [program, "score", "--format", "json", "--no-progress", str(folder / "box.msh")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return json.loads(done.stdout)["elements"]["count"]


def rewrite(text):
    before, rest = README.read_text(encoding="utf-8").split(MARKERS[0])
    _, after = rest.split(MARKERS[1])
    README.write_text(f"{before}{MARKERS[0]}\n{text}\n{MARKERS[1]}{after}", encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--work", type=Path, default=HERE / "work", help="where the meshes are kept")
    parser.add_argument("--program", default=str(HERE.parent / "target" / "release" / "meshgauge"))
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--check", action="store_true", help="only hold three ratios against their bounds")
    parser.add_argument("--plot", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("--peer", nargs=2, help=argparse.SUPPRESS)
    parser.add_argument("--make-inputs", type=Path, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.peer:
        return PEERS[arguments.peer[0]](arguments.peer[1])
    if arguments.make_inputs:
        return make_inputs(arguments.make_inputs)
    if arguments.plot:
        return plot(arguments.plot)
    folder = arguments.work
    folder.mkdir(parents=True, exist_ok=True)
    if not all((folder / file).exists() for file in TITLES):
        subprocess.run([sys.executable, __file__, "--make-inputs", str(folder)], check=True)
    runs, load = contenders(arguments.program, folder), os.getloadavg()
    if arguments.check:
        wanted = [file for file, _ in BOUNDS]
        runs = [run for run in runs if run.file in wanted and "2 threads" not in run.name]
    for number in range(arguments.rounds + 1):
        start = number % len(runs)
        for run in runs[start:] + runs[:start]:
            run.run(counts=number > 0)
        print(f"round {number} of {arguments.rounds}", file=sys.stderr)
    if arguments.check:
        return check(runs)
    keep_samples(runs, folder)
    if importlib.util.find_spec("matplotlib"):
        subprocess.run([sys.executable, __file__, "--plot", str(folder)], check=True)
    text = table(runs, folder, arguments.rounds, arguments.program, load)
    print(text)
    rewrite(text)


if __name__ == "__main__":
    main()
