#!/usr/bin/env python3
"""Exported VTK XML, OBJ, PLY and glTF files, read by VTK.

Usage: check_with_vtk.py COMMAND   exit status 77 where Python has no VTK
"""
import math
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import exported as e

try:
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
except ImportError:
    print("skipped: Python's VTK (Debian package python3-vtk9) is not installed")
    sys.exit(e.SKIPPED)


def faults_said(reader):
    """Errors and warnings of a reader, which VTK prints and does not return."""
    said = []
    for event in ("ErrorEvent", "WarningEvent"):
        reader.AddObserver(event, lambda *_: said.append(event))
    return said


def read(reader, path):
    said = faults_said(reader)
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput(), said


def volume(mesh):
    clean = vtk.vtkCleanPolyData()  # vertices with two normals become one again
    clean.SetInputData(mesh)
    clean.Update()
    edges = vtk.vtkFeatureEdges()
    edges.SetInputConnection(clean.GetOutputPort())
    edges.FeatureEdgesOff()
    edges.ManifoldEdgesOff()
    edges.Update()
    properties = vtk.vtkMassProperties()
    properties.SetInputConnection(clean.GetOutputPort())
    properties.Update()
    return properties.GetVolume(), edges.GetOutput().GetNumberOfCells()


def point_data(mesh):
    data = mesh.GetPointData()
    return {data.GetArrayName(k): vtk_to_numpy(data.GetArray(k)) for k in range(data.GetNumberOfArrays())}


def line_lengths(mesh):
    points, lengths = vtk_to_numpy(mesh.GetPoints().GetData()), []
    for k in range(mesh.GetNumberOfCells()):
        ids = mesh.GetCell(k).GetPointIds()
        places = points[[ids.GetId(i) for i in range(ids.GetNumberOfIds())]]
        lengths.append(float((((places[1:] - places[:-1]) ** 2).sum(axis=1) ** 0.5).sum()))
    return lengths


def blocks(tree):
    iterator, found = tree.NewIterator(), []
    while not iterator.IsDoneWithTraversal():
        found.append(iterator.GetCurrentDataObject())
        iterator.GoToNextItem()
    return found


def check_helix(command, folder, check):
    e.write_helix(Path(folder) / "helix.obj")
    yarn = ("--yarn", f"diameter={e.HELIX_DIAMETER}mm")
    for name in ("h.vtp", "h.tubes.obj", "h.ply", "h.glb", "h.gltf"):
        e.run(command, "export", "helix.obj", *yarn, "--sides", "24", "--per-segment", "8", "-o", name, folder=folder)
    cylinder = math.pi / 4 * e.HELIX_DIAMETER ** 2 * e.HELIX_LENGTH  # Pappus: the centroid runs the helix

    mesh, said = read(vtk.vtkXMLPolyDataReader(), Path(folder) / "h.vtp")
    check.holds(not said, "h.vtp is read without a word")
    check.near(line_lengths(mesh)[0], e.HELIX_LENGTH, 1e-3, "h.vtp: length of the helix")
    data = point_data(mesh)
    check.near(data["arc_mm"][-1], e.HELIX_LENGTH, 1e-3, "h.vtp: arc at its end")
    middle = data["curvature_per_mm"][len(data["curvature_per_mm"]) // 2]
    check.near(middle, e.HELIX_CURVATURE, 1e-2, "h.vtp: curvature in its middle")
    check.holds("loop" not in data, "h.vtp: no loops are made up")

    for name, reader in (("h.tubes.obj", vtk.vtkOBJReader()), ("h.ply", vtk.vtkPLYReader())):
        mesh, said = read(reader, Path(folder) / name)
        found, open_edges = volume(mesh)
        check.holds(not said, name + " is read without a word")
        check.near(found, cylinder, 5e-3, name + ": volume of the yarn")
        check.holds(open_edges == 0, name + ": closed")
        check.holds("Normals" in point_data(mesh), name + ": has normals")
    for name in ("h.glb", "h.gltf"):
        tree, said = read(vtk.vtkGLTFReader(), Path(folder) / name)
        found = [volume(block) for block in blocks(tree)]
        check.holds(not said and len(found) == 1, name + " is read without a word, as one yarn")
        check.near(found[0][0] * 1e9, cylinder, 5e-3, name + ": volume of the yarn, in cubic metres")
        check.holds(found[0][1] == 0, name + ": closed")
        along = point_data(blocks(tree)[0])["TEXCOORD_0"][:, 1].max()
        turns = e.HELIX_LENGTH / (math.pi * e.HELIX_DIAMETER)
        check.near(along, turns, 2e-3, name + ": texture along the yarn, in its circumferences")


def check_cloth(command, folder, check):
    e.run(command, "relax", e.ROOT / "examples/structures/rib.verm", "--periodic", "-o", "rib.h5", folder=folder)
    numbers = e.measured(command, "rib.h5", folder)
    yarn_mm = numbers["loop_length_mm"] * numbers["loops"]
    for name in ("rib.vtp", "rib.glb", "rib.ply"):
        e.run(command, "export", "rib.h5", "--per-segment", "16", "-o", name, folder=folder)
    mesh, said = read(vtk.vtkXMLPolyDataReader(), Path(folder) / "rib.vtp")
    check.holds(not said, "rib.vtp is read without a word")
    check.near(sum(line_lengths(mesh)), yarn_mm, 1e-3, "rib.vtp: yarn in the cell")
    data = point_data(mesh)
    check.holds(set(data["loop"]) == set(range(numbers["loops"])), "rib.vtp: every loop, and no place without one")
    check.holds(set(data["side"]) == {-1, 1}, "rib.vtp: face and back stitches")
    check.holds(len(set(data["needle"])) == numbers["wales"], "rib.vtp: as many needles as wales")
    check.holds(len(set(data["course"])) == numbers["courses"], "rib.vtp: as many courses as were counted")
    check.holds("tension_cN" in data and "contact_cN_per_mm" in data, "rib.vtp: forces in their units")
    check.holds(data["contact_cN_per_mm"].max() > 0, "rib.vtp: yarns press")
    # cells are repeated as instances of one mesh
    e.run(command, "export", "rib.h5", "--repeats", "3x2", "-o", "six.glb", folder=folder)
    tree, said = read(vtk.vtkGLTFReader(), Path(folder) / "six.glb")
    one, _ = read(vtk.vtkGLTFReader(), Path(folder) / "rib.glb")
    check.holds(len(blocks(tree)) == 6 * len(blocks(one)), "six.glb: six cells")
    wide = [max(block.GetBounds()[1] for block in blocks(each)) for each in (tree, one)]
    check.near((wide[0] - wide[1]) * 1e3, 2 * numbers["width_mm"], 5e-3, "six.glb: two cells wider")


def main():
    check = e.Checks()
    with tempfile.TemporaryDirectory() as folder:
        check_helix(Path(sys.argv[1]).resolve(), folder, check)
        check_cloth(Path(sys.argv[1]).resolve(), folder, check)
    check.exit()


main()
