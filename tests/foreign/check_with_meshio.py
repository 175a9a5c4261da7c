#!/usr/bin/env python3
"""Exported PLY and Abaqus files, read by meshio.

Usage: check_with_meshio.py COMMAND   exit status 77 where Python has no meshio
"""
import math
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import exported as e

try:
    import meshio
    import numpy as np
except ImportError:
    print("skipped: meshio (Debian package python3-meshio) is not installed")
    sys.exit(e.SKIPPED)


def volume(points, triangles):
    """Of a closed mesh, by the divergence theorem; and whether every edge is met once from either side."""
    a, b, c = (points[triangles[:, k]].astype(float) for k in range(3))
    places, same = np.unique(np.round(points.astype(float), 6), axis=0, return_inverse=True)
    corners = same[triangles]
    edges = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]) @ [len(places), 1]
    back = np.concatenate([corners[:, [1, 0]], corners[:, [2, 1]], corners[:, [0, 2]]]) @ [len(places), 1]
    closed = np.array_equal(np.sort(edges), np.sort(back)) and len(np.unique(edges)) == len(edges)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6), closed


def length(mesh):
    return sum(float(np.linalg.norm(np.diff(mesh.points[block.data], axis=1), axis=2).sum()) for block in mesh.cells)


def check_helix(command, folder, check):
    e.write_helix(folder / "helix.obj")
    yarn = ("--yarn", f"diameter={e.HELIX_DIAMETER}mm bend-stiffness=10mNmm2")
    e.run(command, "export", "helix.obj", *yarn, "--sides", "24", "--per-segment", "8", "-o", "h.ply", folder=folder)
    mesh = meshio.read(folder / "h.ply")
    found, closed = volume(mesh.points, mesh.cells_dict["triangle"])
    check.near(found, math.pi / 4 * e.HELIX_DIAMETER ** 2 * e.HELIX_LENGTH, 5e-3, "h.ply: volume of the yarn")
    check.holds(closed, "h.ply: closed")
    normals = np.stack([mesh.point_data[axis] for axis in ("nx", "ny", "nz")], axis=1)
    check.holds(np.abs(np.linalg.norm(normals, axis=1) - 1).max() < 1e-5, "h.ply: unit normals")
    for extra, cell in (((), "line"), (("--quadratic",), "line3")):
        e.run(command, "export", "helix.obj", *yarn, *extra, "-o", "h.inp", folder=folder)
        mesh = meshio.read(folder / "h.inp")
        check.holds({block.type for block in mesh.cells} == {cell}, f"h.inp: elements are {cell}")
        check.near(length(mesh), e.HELIX_LENGTH, 2e-3, f"h.inp, {cell}: length of the helix")
        ends = mesh.points[mesh.point_sets["YARN_ENDS"]]
        turns = math.dist(ends[0], ends[1])
        check.near(turns, e.HELIX_TURNS * e.HELIX_RISE, 1e-6, f"h.inp, {cell}: distance of its ends")


def check_cell(command, folder, check):
    e.run(command, "relax", e.ROOT / "examples/structures/rib.verm", "--periodic", "-o", "rib.h5", folder=folder)
    numbers = e.measured(command, "rib.h5", folder)
    yarn_mm = numbers["loop_length_mm"] * numbers["loops"]
    e.run(command, "export", "rib.h5", "--per-segment", "16", "-o", "rib.inp", folder=folder)
    mesh = meshio.read(folder / "rib.inp")
    check.near(length(mesh), yarn_mm, 1e-3, "rib.inp: yarn in the cell")
    for one, other, control, name in (("EDGE_LEFT", "EDGE_RIGHT", "CELL_X", "left and right"),
                                      ("EDGE_BOTTOM", "EDGE_TOP", "CELL_Y", "bottom and top")):
        if one not in mesh.point_sets:
            continue
        apart = mesh.points[mesh.point_sets[other]] - mesh.points[mesh.point_sets[one]]
        vector = mesh.points[mesh.point_sets[control]]
        check.holds(np.abs(apart - vector).max() < 1e-9, f"rib.inp: {name} lie one lattice vector apart")
    check.near(mesh.points[mesh.point_sets["CELL_X"]][0, 0], numbers["width_mm"], 1e-9, "rib.inp: width of the cell")
    check.near(mesh.points[mesh.point_sets["CELL_Y"]][0, 1], numbers["height_mm"], 1e-9, "rib.inp: its height")
    check.holds(len(mesh.cell_sets["YARN_0"]) > 0, "rib.inp: a set for the yarn")

    e.run(command, "export", "rib.h5", "-o", "rib.ply", folder=folder)
    mesh = meshio.read(folder / "rib.ply")
    check.holds(set(mesh.point_data["loop"]) == set(range(numbers["loops"])), "rib.ply: every loop")
    check.holds(set(mesh.point_data["line"]) == {10}, "rib.ply: the line of the notation")


def main():
    check = e.Checks()
    with tempfile.TemporaryDirectory() as folder:
        check_helix(Path(sys.argv[1]).resolve(), Path(folder), check)
        check_cell(Path(sys.argv[1]).resolve(), Path(folder), check)
    check.exit()


main()
