#!/usr/bin/env python3
"""Writes meshes in every encoding of Gmsh's MSH, and what stands in them as Gmsh's and meshio's own interfaces tell it.

    python gmsh_encodings.py FOLDER

FOLDER/expected.jsonl has a line a file: name, number of nodes, number of elements of each measured shape, and two sums
over their corners (corner k of an element adds (k + 1) * (x + 2 y + 3 z), and the square of that). The test
`every_encoding_that_peers_write_is_read_as_they_see_it` runs this with the Python that MESHGAUGE_PYTHON names.
"""

import json
import pathlib
import struct
import sys

import gmsh
import meshio
import numpy as np

CORNERS = {"Triangle": 3, "Quadrilateral": 4, "Tetrahedron": 4, "Pyramid": 5, "Prism": 6, "Hexahedron": 8}
SHAPES = {name: name.lower().replace("prism", "wedge") for name in CORNERS}


def facts():
    """What the current model holds."""
    tags, xyz, _ = gmsh.model.mesh.getNodes()
    point = dict(zip(tags.tolist(), xyz.reshape(-1, 3)))
    shapes, total, squares, used = {}, 0.0, 0.0, set()
    for kind, labels, nodes in zip(*gmsh.model.mesh.getElements()):
        name, _, _, width, _, _ = gmsh.model.mesh.getElementProperties(kind)
        used.update(nodes.tolist())
        family = name.split()[0]
        if family not in CORNERS:
            continue
        shapes[SHAPES[family]] = shapes.get(SHAPES[family], 0) + len(labels)
        rows = nodes.reshape(-1, width)[:, : CORNERS[family]]
        for k in range(CORNERS[family]):
            p = np.array([point[n] for n in rows[:, k]])
            s = (k + 1) * (p @ [1.0, 2.0, 3.0])
            total += s.sum()
            squares += (s * s).sum()
    return {"nodes": len(point), "used": len(used), "shapes": shapes, "sum": float(total), "squares": float(squares)}


def box(order, dim=3):
    gmsh.clear()
    gmsh.model.add("box")
    gmsh.model.occ.addBox(0.1, -0.2, 0.3, 1, 1.1, 0.9)
    gmsh.model.occ.synchronize()
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.25)
    gmsh.model.mesh.generate(dim)
    gmsh.model.mesh.setOrder(order)


def layers():
    """Hexahedra and wedges by extrusion."""
    gmsh.clear()
    gmsh.model.add("layers")
    square = gmsh.model.occ.addRectangle(0, 0, 0, 1, 1)
    disc = gmsh.model.occ.addDisk(3, 0.5, 0, 0.5, 0.4)
    gmsh.model.occ.extrude([(2, square)], 0, 0, 1, [5], recombine=True)
    gmsh.model.occ.extrude([(2, disc)], 0, 0, 1, [4], recombine=True)
    gmsh.model.occ.synchronize()
    gmsh.model.mesh.setTransfiniteSurface(square)
    gmsh.model.mesh.setRecombine(2, square)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.3)
    gmsh.model.mesh.generate(3)


def sparse():
    """All solids, with pyramids; tags sparse and in no order, some of them beyond 32 bits."""
    gmsh.clear()
    gmsh.model.add("sparse")
    gmsh.model.addDiscreteEntity(3, 7)
    xyz = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1),
           (0.5, 0.5, 2), (2, 0, 0), (2, 0, 1), (0.5, 3, 1.5), (-5, -5, -5)]
    tags = [900, 17, 3_000_000, 5, 4, 123_456_789, 70, 71, 2, 1000, 999, 40, 77]
    gmsh.model.mesh.addNodes(3, 7, tags, [c + 0.01 * i for i, p in enumerate(xyz) for c in p])
    n = lambda *k: [tags[i] for i in k]
    gmsh.model.mesh.addElements(3, 7, [5, 7, 6, 4], [[1234], [99], [5], [800, 12]],
                                [n(0, 1, 2, 3, 4, 5, 6, 7), n(4, 5, 6, 7, 8), n(1, 9, 2, 5, 10, 6),
                                 n(6, 7, 8, 11) + n(7, 6, 3, 11)])


def big_tags():
    gmsh.clear()
    gmsh.model.add("big")
    gmsh.model.addDiscreteEntity(3, 1)
    tags = [10_000_000_000, 9_000_000_000_001, 1, 5]
    gmsh.model.mesh.addNodes(3, 1, tags, [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1])
    gmsh.model.mesh.addElements(3, 1, [4], [[2_000_000_000]], [tags])


def rows_2():
    """MSH 2.2 text that keeps the model's tags."""
    tags, xyz, _ = gmsh.model.mesh.getNodes()
    points = "".join(f"{t} {p[0]!r} {p[1]!r} {p[2]!r}\n" for t, p in zip(tags.tolist(), xyz.reshape(-1, 3).tolist()))
    rows = []
    for kind, labels, nodes in zip(*gmsh.model.mesh.getElements()):
        width = gmsh.model.mesh.getElementProperties(kind)[3]
        for label, ids in zip(labels, nodes.reshape(-1, width)):
            rows.append(f"{label} {kind} 4 -7 1 2 -3 {' '.join(map(str, ids))}\n")
    return (f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{len(tags)}\n{points}$EndNodes\n"
            f"$Elements\n{len(rows)}\n{''.join(rows)}$EndElements\n").encode()


def section(data, name):
    """Where the contents of a section start and end."""
    start = data.index(b"$" + name + b"\n") + len(name) + 2
    return start, data.index(b"$End" + name, start)


def counts(data, at, size):
    return struct.unpack_from(f"<{4}{size}", data, at)


def rewrite(data, end, size):
    """Binary MSH 4.1 of this machine in another byte order and size_t; sections other than nodes and elements go."""
    out = bytearray(f"$MeshFormat\n4.1 1 {struct.calcsize('<' + size)}\n".encode() + struct.pack(end + "i", 1))
    out += b"\n$EndMeshFormat\n"
    for name in (b"Nodes", b"Elements"):
        at, _ = section(data, name)
        blocks, *_ = head = counts(data, at, "Q")
        at += 32
        out += b"$" + name + b"\n" + struct.pack(f"{end}4{size}", *head)
        for _ in range(blocks):
            dim, tag, third, n = struct.unpack_from("<iiiQ", data, at)
            at += 20
            out += struct.pack(end + "iii" + size, dim, tag, third, n)
            if name == b"Nodes":
                width = 3 + (dim if third else 0)
                out += np.frombuffer(data, "<u8", n, at).astype(f"{end}u{struct.calcsize('<' + size)}").tobytes()
                out += np.frombuffer(data, "<f8", n * width, at + 8 * n).astype(end + "f8").tobytes()
                at += 8 * n * (1 + width)
            else:
                width = 1 + gmsh.model.mesh.getElementProperties(third)[3]
                words = np.frombuffer(data, "<u8", n * width, at)
                out += words.astype(f"{end}u{struct.calcsize('<' + size)}").tobytes()
                at += 8 * n * width
        out += b"\n$End" + name + b"\n"
    return bytes(out)


def rewrite_2(data, end, one_by_one):
    """Binary MSH 2.2 in another byte order, or with a block for each element."""
    out = bytearray(b"$MeshFormat\n2.2 1 8\n" + struct.pack(end + "i", 1) + b"\n$EndMeshFormat\n$Nodes\n")
    at, _ = section(data, b"Nodes")
    line = data.index(b"\n", at) + 1
    n = int(data[at:line])
    nodes = np.frombuffer(data, np.dtype([("n", "<i4"), ("p", "<f8", 3)]), n, line)
    out += data[at:line] + nodes.astype(np.dtype([("n", end + "i4"), ("p", end + "f8", 3)])).tobytes()
    out += b"\n$EndNodes\n$Elements\n"
    at, _ = section(data, b"Elements")
    line = data.index(b"\n", at) + 1
    total = int(data[at:line])
    out += data[at:line]
    at = line
    while total:
        kind, n, tags = struct.unpack_from("<iii", data, at)
        width = 1 + tags + gmsh.model.mesh.getElementProperties(kind)[3]
        rows = np.frombuffer(data, "<i4", n * width, at + 12).reshape(n, width)
        at += 12 + 4 * n * width
        total -= n
        step = 1 if one_by_one else n
        for k in range(0, n, step):
            out += struct.pack(end + "iii", kind, step, tags) + rows[k : k + step].astype(end + "i4").tobytes()
    out += b"\n$EndElements\n"
    return bytes(out)


def main(folder):
    folder.mkdir(parents=True, exist_ok=True)
    expected = []

    def note(name, what):
        # Gmsh writes no unused nodes, and its own numbers, to MSH 2.
        left_out = "2.2" in name and "rows" not in name
        expected.append({"file": name, **what, "nodes": what["used" if left_out else "nodes"]})

    def write(name, version, binary, what, parametric=0):
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.option.setNumber("Mesh.Binary", binary)
        gmsh.option.setNumber("Mesh.SaveParametric", parametric)
        gmsh.write(str(folder / name))
        note(name, what)
        return (folder / name).read_bytes()

    def save(name, data, what):
        (folder / name).write_bytes(data)
        note(name, what)

    models = [("tets", lambda: box(1)), ("order2", lambda: box(2)), ("order3", lambda: box(3)),
              ("order4_surface", lambda: box(4, 2)), ("layers", layers), ("sparse", sparse)]
    for model, make in models:
        make()
        what = facts()
        save(f"{model}_2.2_rows.msh", rows_2(), what)
        for version in (2.2, 4.0, 4.1):
            text = write(f"{model}_{version}_text.msh", version, 0, what)
            save(f"{model}_{version}_crlf.msh", text.replace(b"\n", b"\r\n"), what)
            if model != "sparse":
                write(f"{model}_{version}_parametric_text.msh", version, 0, what, 1)
        for parametric in (0, 1) if model != "sparse" else (0,):
            mark = "parametric_" if parametric else ""
            data = write(f"{model}_4.1_{mark}binary.msh", 4.1, 1, what, parametric)
            for end, order in (("<", "little"), (">", "big")):
                for size in "QI":
                    name = f"{model}_4.1_{mark}{order}_{struct.calcsize('<' + size)}.msh"
                    save(name, rewrite(data, end, size), what)
            data = write(f"{model}_2.2_{mark}binary.msh", 2.2, 1, what, parametric)
            if not parametric:
                for end, order in (("<", "little"), (">", "big")):
                    save(f"{model}_2.2_{order}_one_by_one.msh", rewrite_2(data, end, True), what)
                    save(f"{model}_2.2_{order}.msh", rewrite_2(data, end, False), what)
        for kind, binary in (("gmsh22", 0), ("gmsh22", 1), ("gmsh", 0), ("gmsh", 1)):
            try:
                mesh = meshio.read(folder / f"{model}_4.1_text.msh")
                mesh = meshio.Mesh(mesh.points, mesh.cells)
                name = f"{model}_meshio_{kind}_{'binary' if binary else 'text'}.msh"
                meshio.write(folder / name, mesh, file_format=kind, binary=bool(binary))
                note(name, what)
            except Exception as error:  # its 4.1 writer wants one type of element and knows no order 3
                print(f"meshio leaves out {model} as {kind}: {error}", file=sys.stderr)

    big_tags()
    what = facts()
    write("big_tags_text.msh", 4.1, 0, what)
    data = write("big_tags_binary.msh", 4.1, 1, what)
    save("big_tags_big_endian.msh", rewrite(data, ">", "Q"), what)

    for ghosts in (0, 1):
        box(1, 2)
        what = facts()
        gmsh.option.setNumber("Mesh.PartitionCreateGhostCells", ghosts)
        gmsh.model.mesh.partition(4)
        for version, binary in ((2.2, 0), (2.2, 1), (4.0, 0), (4.1, 0), (4.1, 1)):
            write(f"partitions_{ghosts}_{version}_{binary}.msh", version, binary, what)

    with open(folder / "expected.jsonl", "w") as file:
        file.writelines(json.dumps(row) + "\n" for row in expected)
    print(len(expected), "files")


if __name__ == "__main__":
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    main(pathlib.Path(sys.argv[1]))
