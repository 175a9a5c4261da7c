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
    check.exit()


main()
