# %% [markdown]
# # A sweep over loop length on all cores
#
# Munden (Journal of the Textile Institute 50, T448, 1959) found that loop length alone sets the size of plain: courses and
# wales per length times the loop length, Kc and Kw, are constants of the structure. Here cells of plain are relaxed for a range
# of loop lengths, a process each, and the constants are read off.

# %%
import argparse
import multiprocessing
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import loopwright

parser = argparse.ArgumentParser()
parser.add_argument("--from", dest="shortest", type=float, default=5.6, help="shortest loop, mm")
parser.add_argument("--to", dest="longest", type=float, default=7.6, help="longest loop, mm")
parser.add_argument("--count", type=int, default=6, help="how many")
parser.add_argument("--processes", type=int, default=None, help="default: as many as there are processors")
parser.add_argument("--out", default="loop_length_sweep.svg", help="the plot")
arguments, _ = parser.parse_known_args()

examples = Path(__file__).parents[1] if "__file__" in globals() else Path("examples")
plain = loopwright.read(examples / "structures/plain.verm")


# %%
def relaxed(loop_length_mm: float) -> dict:
    """The measurements of a cell; each process is one of many, so it works with one thread."""
    loopwright.set_threads(1)
    cloth = loopwright.relax(plain.changed(loop_length_mm=loop_length_mm), periodic=True)
    if not (cloth.converged and cloth.whole):
        raise RuntimeError(f"loop length {loop_length_mm} mm: {cloth.message}")
    return cloth.measure()


# %%
lengths = np.linspace(arguments.shortest, arguments.longest, arguments.count)
with multiprocessing.get_context("fork").Pool(arguments.processes) as pool:
    found = pool.map(relaxed, lengths)

# %%
diameter = plain.build(periodic=True).diameter_mm
for length, cloth in zip(lengths, found):
    print(f"loop {length:.2f} mm (l/d {length / diameter:4.1f}): {cloth['width_mm']:.3f} x {cloth['height_mm']:.3f} mm, "
          f"Kc {cloth['Kc']:.2f}, Kw {cloth['Kw']:.2f}, {cloth['areal_density_g_m2']:.0f} g/m2")

figure, axis = plt.subplots(figsize=(5, 3.6), layout="constrained")
for key in ("Kc", "Kw"):
    axis.plot(lengths / diameter, [cloth[key] for cloth in found], "o-", label=key)
axis.set(xlabel="loop length / yarn diameter", ylabel="Munden's constants")
axis.legend(frameon=False)
figure.savefig(arguments.out)
