#!/usr/bin/env python3
"""Exported STEP files, read by OpenCASCADE (read_step).

Usage: check_step.py COMMAND READ_STEP   exit status 77 where READ_STEP was not built
"""
import csv
import math
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import exported as e

STEPS = 20  # of read_step


def read_step(reader, path):
    curves = []
    done = subprocess.run([reader, str(path)], text=True, stdout=subprocess.PIPE, check=True)
    for line in done.stdout.splitlines():
        if line.startswith("curve "):
            numbers = [float(word) for word in line.split()[1:]]
            places = [numbers[k:k + 3] for k in range(3, len(numbers), 3)]
            curves.append((int(numbers[0]), int(numbers[1]), numbers[2], places))
    return curves


def read_solids(reader, path):
    """(sound, volume, surface, volume of its mesh, places on the side) of each."""
    done = subprocess.run([reader, str(path)], text=True, stdout=subprocess.PIPE, check=True)
    solids = []
    for line in done.stdout.splitlines():
        if line.startswith("solid "):
            numbers = [float(word) for word in line.split()[1:]]
            solids.append((numbers[0] == 1, *numbers[1:4], [numbers[k:k + 3] for k in range(4, len(numbers), 3)]))
    return solids


def check_tube(solid, diameter, length, caps, check, name):
    """Pappus: volume and side of a tube are those of the straight one of its length."""
    sound, volume, surface, mesh, _ = solid
    check.holds(sound, name + ": OpenCASCADE finds a sound solid")
    check.near(volume, math.pi / 4 * diameter ** 2 * length, 1e-4, name + ": volume")
    check.near(surface, math.pi * diameter * length + caps * math.pi / 4 * diameter ** 2, 1e-4, name + ": surface")
    check.near(mesh, volume, 0.04, name + ": volume of its mesh")


def check_solids(command, reader, folder, check):
    e.run(command, "export", "helix.obj", "--yarn", "diameter=1mm", "-o", "helix.tubes.step", folder=folder)
    helix, = read_solids(reader, folder / "helix.tubes.step")
    check_tube(helix, e.HELIX_DIAMETER, e.HELIX_LENGTH, 2, check, "helix.tubes.step")
    # every place is half a diameter from the helix: the nearest point of it, by Newton's method on its angle
    off = 0
    for x, y, z in helix[4]:
        angle = 2 * math.pi * y / e.HELIX_RISE
        angle += math.remainder(math.atan2(z, x) - angle, 2 * math.pi)
        rise = e.HELIX_RISE / (2 * math.pi)
        for _ in range(20):
            px, py, pz = e.helix_point(angle)
            slope = ((px - x) * -pz + (py - y) * rise + (pz - z) * px)
            angle -= slope / (e.HELIX_RADIUS ** 2 + rise ** 2 - ((px - x) * px + (pz - z) * pz))
        off = max(off, abs(math.dist(e.helix_point(angle), (x, y, z)) - e.HELIX_DIAMETER / 2))
    check.holds(off < 0.01, f"helix.tubes.step: its side within {off:.2g} mm of half a diameter from the helix")

    steps, radius = 48, 5.0  # a ring
    with open(folder / "ring.obj", "w") as out:
        for k in range(steps):
            angle = 2 * math.pi * k / steps
            out.write(f"v {radius * math.cos(angle):.15g} {radius * math.sin(angle):.15g} 0\n")
        out.write("l " + " ".join(str(k % steps + 1) for k in range(steps + 1)) + "\n")
    e.run(command, "export", "ring.obj", "--yarn", "diameter=1mm", "-o", "ring.tubes.step", folder=folder)
    ring, = read_solids(reader, folder / "ring.tubes.step")
    check_tube(ring, 1.0, 2 * math.pi * radius, 0, check, "ring.tubes.step")

    e.run(command, "relax", e.ROOT / "examples/structures/rib.verm", "--periodic", "-o", "rib_cell.h5", folder=folder)
    numbers = e.measured(command, "rib_cell.h5", folder)
    e.run(command, "export", "rib_cell.h5", "--repeats", "2x2", "-o", "cell.tubes.step", folder=folder)
    cells = read_solids(reader, folder / "cell.tubes.step")
    check.holds(len(cells) == 4, "cell.tubes.step: a solid a cell")
    check_tube(cells[3], 0.37, numbers["loop_length_mm"] * numbers["loops"], 2, check, "cell.tubes.step")


def csv_lines(path):
    """Places of every yarn, in order."""
    lines = {}
    with open(path, newline="") as rows:
        for row in csv.DictReader(rows):
            lines.setdefault(int(row["yarn"]), []).append([float(row[axis]) for axis in ("x_mm", "y_mm", "z_mm")])
    return [lines[yarn] for yarn in sorted(lines)]


def main():
    if len(sys.argv) < 3 or not Path(sys.argv[2]).exists():
        print("skipped: OpenCASCADE (Debian package libocct-data-exchange-dev) is not installed")
        sys.exit(e.SKIPPED)
    command, reader = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    check = e.Checks()
    with tempfile.TemporaryDirectory() as folder:
        e.write_helix(Path(folder) / "helix.obj")
        e.run(command, "export", "helix.obj", "--yarn", "diameter=1mm", "-o", "helix.step", folder=folder)
        degree, _, length, places = read_step(reader, Path(folder) / "helix.step")[0]
        check.holds(degree == 3, "helix.step: a cubic")
        check.near(length, e.HELIX_LENGTH, 1e-4, "helix.step: length of the helix")
        # at 1 % of a diameter, as the import promises
        off = max(math.hypot(math.hypot(x, z) - e.HELIX_RADIUS, 0) for x, y, z in places)
        check.holds(off < 0.01, f"helix.step: within {off:.2g} mm of the helix's cylinder")

        # Rows of a rib, their number of segments a multiple of STEPS or not: places between knots and on them. The
        # same places come from the spline itself, through another file.
        e.run(command, "build", e.ROOT / "examples/structures/rib.verm", "--window", "6x4", "-o", "rib.h5",
              folder=folder)
        e.run(command, "export", "rib.h5", "-o", "rib.step", folder=folder)
        e.run(command, "export", "rib.h5", "--per-segment", str(STEPS), "-o", "rib.csv", folder=folder)
        curves, lines = read_step(reader, Path(folder) / "rib.step"), csv_lines(Path(folder) / "rib.csv")
        check.holds(len(curves) == len(lines), f"rib.step: {len(curves)} curves for {len(lines)} yarns")
        worst = 0
        for (_, poles, _, places), line in zip(curves, lines):
            segments = (len(line) - 1) // STEPS
            check.holds(poles == segments + 3, f"rib.step: {poles} poles for {segments} segments")
            for k, place in enumerate(places):
                worst = max(worst, math.dist(place, line[k * segments]))  # k / STEPS of all segments
        # the table has nine digits
        check.holds(worst < 1e-6, f"rib.step: places within {worst:.2g} mm of the yarns' own")
        check_solids(command, reader, Path(folder), check)
    check.exit()


main()
