#!/usr/bin/env python3
"""The comparison finds faults: with one rule of the checker broken at a time, the two must differ.

    test_compare.py COMMAND
"""

import pathlib
import random
import sys
import tempfile
from unittest import mock

from compare import Comparison
from knitout_check import Machine
from random_programme import programme


def keeps_order(machine, source, target, carriers):
    """A transfer that does not reverse the stack."""
    REAL["pass_over"](machine, source, target, carriers)
    moved = [loop for loop in machine.stacks.get(target, []) if machine.loops[loop][2].endswith(f"@{machine.line}")]
    if moved:
        machine.stacks[target][-len(moved) :] = moved[::-1]


def leaves_carriers(machine, source, target, carriers):
    """A transfer that does not take carriers along."""
    REAL["pass_over"](machine, source, target, set(machine.active))


def wrong_racking(machine, source, target):
    """Racking with the sign turned round."""
    machine.racking = -machine.racking
    try:
        REAL["require_facing"](machine, source, target)
    finally:
        machine.racking = -machine.racking


def wrong_side(machine, carriers, needle, side):
    REAL["set_positions"](machine, carriers, needle, "-" if side == "+" else "+")


def one_loop(machine, needle, carriers, parents):
    """One loop for a stitch of several yarns."""
    REAL["make_loops"](machine, needle, carriers[:1], parents)


BROKEN = {
    "pass_over": (keeps_order, leaves_carriers),
    "require_facing": (wrong_racking,),
    "set_positions": (wrong_side,),
    "make_loops": (one_loop,),
}
REAL = {name: getattr(Machine, name) for name in BROKEN}


def main():
    draw = random.Random(5)
    programmes = [programme(draw, 60) for _ in range(40)]
    unnoticed = []
    with tempfile.TemporaryDirectory() as folder:
        comparison = Comparison(sys.argv[1], pathlib.Path(folder))
        comparison.fail = lambda text: None  # differences are what is wanted here
        files = [comparison.write(f"random_{i}", lines) for i, lines in enumerate(programmes)]
        for name, faults in BROKEN.items():
            for fault in faults:
                comparison.failed = False
                with mock.patch.object(Machine, name, fault):
                    comparison.compare(fault.__name__, files)
                if not comparison.failed:
                    unnoticed.append(fault.__name__)
    for fault in unnoticed:
        print(f"not noticed: {fault}")
    return 1 if unnoticed else 0


if __name__ == "__main__":
    sys.exit(main())
