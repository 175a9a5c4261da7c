# %% [markdown]
# # A stress-strain curve
#
# Plain of soft acrylic, a periodic cell, is pulled along its courses and along its wales, loaded and unloaded. Beside it
# the forces that Singal and others (Nature Communications 15, 2622, 2024) got for the same yarn and loop length.

# %%
import argparse
from pathlib import Path

import matplotlib.pyplot as plt

import loopwright

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--course", type=float, default=0.3, help="largest strain along the courses")
parser.add_argument("--wale", type=float, default=0.2, help="largest strain along the wales")
parser.add_argument("--out", default="stress_strain.svg", help="the plot")
arguments, _ = parser.parse_known_args()  # a notebook has arguments of its own

jersey = Path(__file__).parents[1] / "acrylic_jersey.verm" if "__file__" in globals() else "examples/acrylic_jersey.verm"

# %%
# At rest once; both tests begin there.
cloth = loopwright.relax(jersey, periodic=True)
sizes = cloth.measure()
print(f"{cloth}: {sizes['wale_spacing_mm']:.2f} mm a wale, {sizes['course_spacing_mm']:.2f} mm a course, "
      "interlacings {} of {}".format(*cloth.interlacings_kept))

# %%
tests = {"course": loopwright.stretch(cloth, direction="course", to=[arguments.course, 0]),
         "wale": loopwright.stretch(cloth, direction="wale", to=[arguments.wale, 0])}
published = {"course": ([0.12, 0.22, 0.31, 0.41], [20, 33, 46, 62]),
             "wale": ([0.038, 0.080, 0.123, 0.165, 0.208, 0.250], [15, 28, 43, 63, 98, 160])}

# %%
figure, axes = plt.subplots(1, 2, figsize=(9, 3.6), layout="constrained")
for axis, (way, test) in zip(axes, tests.items()):
    strain, force = test[f"{way}_strain"], test[f"{way}_force_N_m"]
    axis.plot(strain, force, label="Loopwright, friction 0.25")
    shown = [(e, f) for e, f in zip(*published[way]) if e <= 1.1 * strain.max()]
    axis.plot(*zip(*shown), "o", mfc="none", label="Singal and others, simulated")
    axis.set(xlabel=f"strain along the {way}s", ylabel="force per length, N/m")
    axis.set_title("interlacings {} of {}".format(*test.interlacings_kept), fontsize="small")
    axis.axhline(0, color="0.8", linewidth=0.8, zorder=0)
    axis.legend(frameon=False, fontsize="small")
figure.savefig(arguments.out)

# %%
# Friction takes the work between the two branches.
for way, test in tests.items():
    strain, force = test[f"{way}_strain"], test[f"{way}_force_N_m"]
    steps = (strain[1:] - strain[:-1]) * (force[1:] + force[:-1]) / 2
    print(f"{way}: {steps[steps > 0].sum():.3g} J/m2 put in, {steps.sum():.3g} J/m2 kept by friction")
