"""What the checks of exported files share: running the command, and the numbers that files must agree with.

The expected numbers come from closed forms where a file holds a closed form's curve (a helix written here as OBJ
lines), and else from `measure`, which shares no code with the writers of files.
"""
import json
import math
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SKIPPED = 77

# A helix of 5 turns: radius 4 mm, rise 3 mm a turn, yarn 1 mm thick.
HELIX_TURNS, HELIX_RADIUS, HELIX_RISE, HELIX_DIAMETER = 5, 4.0, 3.0, 1.0
HELIX_LENGTH = HELIX_TURNS * math.hypot(2 * math.pi * HELIX_RADIUS, HELIX_RISE)
HELIX_CURVATURE = HELIX_RADIUS / (HELIX_RADIUS ** 2 + (HELIX_RISE / (2 * math.pi)) ** 2)


def run(command, *arguments, folder):
    done = subprocess.run([command, *map(str, arguments)], cwd=folder, text=True, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, arguments))}: exit status {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def helix_point(angle):
    return (HELIX_RADIUS * math.cos(angle), HELIX_RISE * angle / (2 * math.pi), HELIX_RADIUS * math.sin(angle))


def write_helix(path):
    steps = 60 * HELIX_TURNS
    with open(path, "w") as out:
        for k in range(steps + 1):
            out.write("v %.12g %.12g %.12g\n" % helix_point(2 * math.pi * HELIX_TURNS * k / steps))
        out.write("l " + " ".join(str(k + 1) for k in range(steps + 1)) + "\n")


def measured(command, state, folder):
    run(command, "measure", state, "--json", "measured.json", folder=folder)
    return json.loads((Path(folder) / "measured.json").read_text())


class Checks:
    """Counts what does not hold and says it."""

    def __init__(self):
        self.failed = 0
        self.done = 0

    def near(self, value, expected, share, what):
        self.holds(abs(value - expected) <= share * abs(expected), f"{what}: {value:.9g}, expected {expected:.9g}")

    def holds(self, condition, what):
        self.done += 1
        print(("ok: " if condition else "FAILED: ") + what)
        self.failed += not condition

    def exit(self):
        print(f"{self.done - self.failed} of {self.done} checks hold")
        sys.exit(1 if self.failed else 0)
