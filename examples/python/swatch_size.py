# %% [markdown]
# # How large will it be?
#
# Three swatches of 60 wales by 60 courses, knitted by others on a 15-gauge machine of 2/30 acrylic with one stitch cam for all
# (KnitDB, Carnegie Mellon Textiles Lab), predicted from the structure, the machine and the yarn. What the machine draws and
# what the yarn is was set from the stockinette and rib swatches; garter is a prediction (docs/swatches.md).

# %%
import argparse
from pathlib import Path

import loopwright

parser = argparse.ArgumentParser()
parser.add_argument("--wales", type=int, default=60)
parser.add_argument("--courses", type=int, default=60)
parser.add_argument("--spread", action="store_true", help="also with friction and loop length at their bounds")
arguments, _ = parser.parse_known_args()

structures = (Path(__file__).parents[1] if "__file__" in globals() else Path("examples")) / "structures"
GAUGE, TAKE_DOWN_N = 15, 0.02  # needles per inch; pull on a wale while it is on the needles
HAND_PULL_N_M = 10  # cloth is pulled straight before it is laid
MACHINE = dict(gauge_npi=GAUGE, loop_length_mm=6.53, bed_change_mm=1.39, set=0.5)
YARN = ("diameter=0.8mm core-diameter=0.31mm shell-stiffness=0.001016N/mm3 shell-exponent=2.4 linear-density=73tex "
        "bend-stiffness=12.7mNmm2 friction=0.25")
MEASURED = {"plain": (99, 84), "rib": (71, 103), "garter": (111, 64)}  # mm
FLAT_GAP_MM = {"plain": 1.0, "rib": 1.7, "garter": 1.7}  # one layer of stitches, or two faces


# %%
def predicted(structure: str, friction: float | None = None, **machine: float) -> tuple[float, float]:
    """Width and height in mm: a cell goes through what the swatch went through, on the needles under take-down, then let
    go, pulled straight and laid flat; then it is counted up."""
    program = loopwright.read(structures / f"{structure}.verm", yarn=YARN, **{**MACHINE, **machine})
    first = program.build(periodic=True, friction=friction)
    wales = first.measure()["wales"]
    cell = loopwright.relax_as_knitted(first, machine_width_mm=wales * 25.4 / GAUGE, take_down_N=wales * TAKE_DOWN_N,
                                       flat_gap_mm=FLAT_GAP_MM[structure], hand_pull_N_m=HAND_PULL_N_M,
                                       tolerance=1e-3)
    if not cell.whole:
        raise RuntimeError(f"{structure}: interlacings {cell.interlacings_kept}")
    sizes = cell.measure()
    return arguments.wales * sizes["wale_spacing_mm"], arguments.courses * sizes["course_spacing_mm"]


# %%
for structure, (width, height) in MEASURED.items():
    w, h = predicted(structure)
    line = f"{structure:7} {w:6.1f} x {h:5.1f} mm"
    if (arguments.wales, arguments.courses) == (60, 60):
        line += f", measured {width} x {height}: {100 * (w / width - 1):+.1f} %, {100 * (h / height - 1):+.1f} %"
    print(line)

# %%
# How sure that is: what is not known well, at its bounds.
if arguments.spread:
    for structure in MEASURED:
        for what, data in {"friction 0.15": dict(friction=0.15), "friction 0.40": dict(friction=0.40),
                           "loops 2 % shorter": dict(loop_length_mm=0.98 * MACHINE["loop_length_mm"]),
                           "loops 2 % longer": dict(loop_length_mm=1.02 * MACHINE["loop_length_mm"])}.items():
            print("{:7} {:18} {:6.1f} x {:5.1f} mm".format(structure, what, *predicted(structure, **data)))
