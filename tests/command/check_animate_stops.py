#!/usr/bin/env python3
"""Sliding bindings under a long pull: the motion stops before an interlacing is lost, says where and why, and what
was reached is whole. `check_animate_stops.py LOOPWRIGHT EXAMPLES`."""
import pathlib
import re
import subprocess
import sys
import tempfile

command, examples = sys.argv[1:3]


def pulled(folder, structure, stretch):
    return subprocess.run(
        [command, "animate", f"{examples}/structures/{structure}.verm", "--model", "yarn", "--binding", "sliding", "--size",
         "4x4", "--stretch", stretch, "--frames", "7", "--seconds", "0.003", "--no-pictures", "--threads", "1", "-o",
         str(folder)], capture_output=True, text=True, timeout=100)


with tempfile.TemporaryDirectory() as place:
    folder = pathlib.Path(place) / "long"
    run = pulled(folder, "birdseye_jacquard", "0.3")
    assert run.returncode == 1, run
    said = re.search(r"stopped at (\S+) s of 0.003 s, pulled by (\S+) %: in the next step the loop of line 14, column 6 "
                     r"would slip out of the loop that it is drawn through", run.stderr)
    assert said and 0 < float(said[1]) < 0.003 and 0 < float(said[2]) < 30, run.stderr
    assert "--binding contact" in run.stderr, run.stderr
    assert "interlacings 24 of 24" in run.stdout, run.stdout
    frames = int(re.search(r"(\d+) frames", run.stdout)[1])
    assert len(list(folder.glob("*.vtp"))) == frames, list(folder.iterdir())

    # Stops between neighbouring bindings hold plain, rib and cross tuck all the way.
    for structure, all_of_it in [("plain", "12 of 12"), ("rib", "12 of 12"), ("cross_tuck", "10 of 10"), ("half_cardigan", "20 of 20")]:
        run = pulled(pathlib.Path(place) / structure, structure, "0.3")
        assert run.returncode == 0 and not run.stderr, run
        assert "7 frames" in run.stdout and f"interlacings {all_of_it}" in run.stdout, run.stdout
