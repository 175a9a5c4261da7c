# %% [markdown]
# # A figure for a paper
#
# Three structures at rest: a picture with a scale bar above, the centrelines of one cell coloured by the pull in the yarn below, in
# the same scale. A vector file with the pictures inside.

# %%
import argparse
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection

import loopwright

parser = argparse.ArgumentParser()
parser.add_argument("--structures", nargs="+", default=["plain", "rib", "full_cardigan"])
parser.add_argument("--pixels", type=int, default=400, help="of a picture's longer side")
parser.add_argument("--dpi", type=int, default=300, help="of a .png")
parser.add_argument("--out", default="figure.pdf", help=".pdf, .svg or .png")
arguments, _ = parser.parse_known_args()

folder = (Path(__file__).parents[1] if "__file__" in globals() else Path("examples")) / "structures"
WIDE, HIGH = 8.0, 6.0  # what a panel shows, mm
PANEL = 2.1  # width of a panel on paper, inches

# %%
cloths = {name: loopwright.relax(folder / f"{name}.verm", periodic=True) for name in arguments.structures}
for name, cloth in cloths.items():
    assert cloth.converged and cloth.whole, name


# %%
def panel_picture(cloth: loopwright.Cloth) -> np.ndarray:
    """WIDE x HIGH mm from the middle of as many cells as that needs."""
    (across, _, _), (_, along, _) = cloth.lattice_mm
    scale = arguments.pixels / WIDE
    return cloth.render(size=(arguments.pixels, round(HIGH * scale)), pixels_per_mm=scale, table=False,
                        repeats=(int(np.ceil(WIDE / across)) + 2, int(np.ceil(HIGH / along)) + 2),
                        background=(255, 255, 255))


def runs_of(cloth: loopwright.Cloth) -> tuple[list[np.ndarray], np.ndarray]:
    """Short runs of the centrelines in WIDE x HIGH mm, those in front last, and the mean tension in each, cN."""
    points_in_a_run = 6
    runs, depth, pull = [], [], []
    a1, a2 = cloth.lattice_mm
    for points in cloth.points(per_segment=points_in_a_run):
        line, tension = points.place_mm, points.tension
        first = np.floor(-line[:, 0].max() / a1[0]), np.floor(-line[:, 1].max() / a2[1])
        last = np.ceil((WIDE - line[:, 0].min()) / a1[0]), np.ceil((HIGH - line[:, 1].min()) / a2[1])
        for m in np.arange(first[0], last[0] + 1):
            for n in np.arange(first[1], last[1] + 1):
                for k in range(0, len(line) - 1, points_in_a_run):
                    # one point more at either end, so that runs join
                    run = line[max(0, k - 1):k + points_in_a_run + 2] + m * a1 + n * a2
                    runs.append(run[:, :2])
                    depth.append(run[:, 2].mean())
                    pull.append(tension[k:k + points_in_a_run + 1].mean())
    back_first = np.argsort(depth)
    return [runs[k] for k in back_first], np.array(pull)[back_first]


# %%
lines = {name: runs_of(cloth) for name, cloth in cloths.items()}
most = max(pull.max() for _, pull in lines.values())
plt.rcParams.update({"font.size": 8, "font.family": "serif", "svg.fonttype": "none"})
figure, axes = plt.subplots(2, len(cloths), figsize=((PANEL + 0.1) * len(cloths) + 0.5, 2 * PANEL * HIGH / WIDE + 0.4), layout="constrained", squeeze=False)
for column, (name, cloth) in enumerate(cloths.items()):
    above, below = axes[:, column]
    above.imshow(panel_picture(cloth), extent=(0, WIDE, 0, HIGH), interpolation="antialiased")
    above.set_title(f"({'abcdefgh'[column]}) {cloth.name}")
    runs, pull = lines[name]
    # a dark edge under each run, a little shorter, so that what is nearer is seen to cross
    width = cloth.diameter_mm / WIDE * PANEL * 72  # points
    colours = np.stack([np.tile([0.15, 0.15, 0.15, 1.0], (len(pull), 1)), plt.cm.viridis(pull / most)], axis=1)
    drawn = LineCollection([line for run in runs for line in (run[1:-1], run)], colors=colours.reshape(-1, 4),
                           linewidths=np.tile([width, 0.75 * width], len(runs)), capstyle="butt", joinstyle="round")
    below.add_collection(drawn)
    for axis in (above, below):
        axis.set(xlim=(0, WIDE), ylim=(0, HIGH), aspect="equal", xticks=[], yticks=[])
    above.plot([0.4, 2.4], [0.4, 0.4], color="black", linewidth=2.5, solid_capstyle="butt")
    above.text(1.4, 0.55, "2 mm", ha="center", va="bottom", bbox=dict(facecolor="white", edgecolor="none", alpha=0.8, pad=1))
bar = figure.colorbar(plt.cm.ScalarMappable(plt.Normalize(0, most), plt.cm.viridis), ax=axes[1], shrink=0.9)
bar.set_label("yarn tension, cN")
figure.savefig(arguments.out, dpi=arguments.dpi)
print(", ".join("{}: interlacings {} of {}".format(name, *cloth.interlacings_kept) for name, cloth in cloths.items()))
