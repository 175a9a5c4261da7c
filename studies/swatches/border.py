#!/usr/bin/env python3
"""What the moss border does to a swatch's pattern: both as sheets that are sewn together.

Usage: border.py STUDY_SWATCHES FOLDER NAME...     (Debian: python3-numpy, python3-scipy)

Every loop is a square of the sheet. What it does under load is that of its part's periodic cell (study_swatches response), on the way
back from the pull by hand: strains along the courses and along the wales are sums of what load along the courses and load along the
wales do, each read off a broken line; shear is linear. Squares may turn. The sheet is free. Printed: the cell's own size, that of the
pattern in the sheet as a mean over its lines, in its middle line and at its edges, and the mean tensions of the pattern.
"""
import csv
import io
import subprocess
import sys

import numpy as np
import scipy.sparse
import scipy.sparse.linalg

WALES, COURSES, SIDE, END, PATTERN = 84, 90, 12, 15, 60
LEVELS = np.array([-3.0, -1, 0, 1, 3])  # N/m


class Law:
    """Strains of a cell by tensions (N/m, per length at rest), and back."""

    def __init__(self, table):
        sizes = {}
        for row in csv.DictReader(io.StringIO(table)):
            load = tuple(float(row[key]) for key in ("course_N_m", "wale_N_m", "shear_N_m"))
            if row["converged"] != "1":
                raise SystemExit(f"the cell did not come to rest under {load} N/m")
            shear = float(row["shear"])
            sizes[load] = float(row["width_mm"]), float(row["height_mm"]) * np.hypot(1, shear), np.arctan(shear)
        (pulled_width, pulled_height, _), (self.width, self.height, _) = list(sizes.values())[:2]
        self.unsolved = False  # in some step no tensions were found for some strains
        self.tension = LEVELS * pulled_height / self.height, LEVELS * pulled_width / self.width

        def strains(measure, rest, direction, own):
            values = np.array([sizes[(s, 0, 0) if direction == 0 else (0, s, 0)][measure] for s in LEVELS]) / rest - 1
            if own:  # a pull always lengthens
                steps = np.cumsum(np.maximum(np.diff(values), 1e-5))
                values = np.concatenate([[0], steps]) - steps[1]
            return values

        self.strain = [[strains(m, rest, k, m == k) for k in (0, 1)] for m, rest in ((0, self.width), (1, self.height))]
        turn = (sizes[0, 0, 1][2] - sizes[0, 0, -1][2]) / 2
        self.shear_stiffness = pulled_width / self.width / max(abs(turn), 1e-5)

    def line(self, m, k, tension):
        """Strain m by tension k, and its slope; goes on straight beyond the last point."""
        x, y = self.tension[k], self.strain[m][k]
        at = np.clip(np.searchsorted(x, tension) - 1, 0, len(x) - 2)
        slope = (y[at + 1] - y[at]) / (x[at + 1] - x[at])
        return y[at] + slope * (tension - x[at]), slope

    def tensions(self, strain):
        """Tensions [2, n] of strains [2, n], and their derivatives [n, 2, 2]: Newton on the broken lines."""
        tension = np.zeros_like(strain)
        for step in range(60):
            (a, da), (b, db) = self.line(0, 0, tension[0]), self.line(0, 1, tension[1])
            (c, dc), (d, dd) = self.line(1, 0, tension[0]), self.line(1, 1, tension[1])
            off = np.array([strain[0] - a - b, strain[1] - c - d])
            straight = da * dd - db * dc < 0.3 * da * dd
            db, dc = np.where(straight, 0, db), np.where(straight, 0, dc)
            det = da * dd - db * dc
            tension = tension + (1 if step < 16 else 0.5) * np.array([dd * off[0] - db * off[1],
                                                                        da * off[1] - dc * off[0]]) / det
            if np.abs(off).max() < 1e-10:
                break
        else:
            self.unsolved = True
        slopes = np.array([[dd, -db], [-dc, da]]) / det
        return tension, np.moveaxis(slopes, 2, 0)


class Sheet:
    def __init__(self, pattern, border):
        row, column = np.meshgrid(np.arange(COURSES), np.arange(WALES), indexing="ij")

        def corner(up, right):
            return (row + up) * (WALES + 1) + column + right

        self.corners = np.stack([corner(0, 0), corner(0, 1), corner(1, 1), corner(1, 0)], -1).reshape(-1, 4)
        inside = np.zeros((COURSES, WALES), bool)
        inside[END:END + PATTERN, SIDE:SIDE + PATTERN] = True
        self.parts = [(inside.ravel(), pattern), (~inside.ravel(), border)]
        self.rest = np.zeros((2, len(self.corners)))
        for part, law in self.parts:
            self.rest[:, part] = np.array([[law.width], [law.height]]) / PATTERN
        width, height = (np.where((np.arange(count) >= edge) & (np.arange(count) < edge + PATTERN), own, other) / PATTERN
                         for count, edge, own, other in ((WALES, SIDE, pattern.width, border.width),
                                                         (COURSES, END, pattern.height, border.height)))
        x, y = (np.concatenate([[0], np.cumsum(steps)]) for steps in (width, height))
        self.points = np.stack([np.tile(x, COURSES + 1), np.repeat(y, WALES + 1)], -1)
        dofs = np.stack([2 * self.corners, 2 * self.corners + 1], -1).reshape(-1, 8)
        self.dofs, self.rows, self.columns = dofs, np.repeat(dofs, 8, axis=1).ravel(), np.tile(dofs, (1, 8)).ravel()
        self.free = np.setdiff1d(np.arange(self.points.size), [0, 1, 2 * WALES + 1])  # held against moving and turning

    def evaluate(self, points):
        """Forces, stiffness and mean tensions of the pattern: four Gauss points a square."""
        at = points[self.corners]
        force, stiffness, means = np.zeros(points.size), 0, []
        for a in (-(3**-0.5), 3**-0.5):
            for b in (-(3**-0.5), 3**-0.5):
                along = [np.array([b - 1, 1 - b, 1 + b, -1 - b]) / 2, np.array([a - 1, -1 - a, 1 + a, 1 - a]) / 2]
                sides = [np.einsum("k,nkd->nd", n, at) for n in along]
                lengths = [np.linalg.norm(s, axis=1) for s in sides]
                unit = [s / l[:, None] for s, l in zip(sides, lengths)]
                shear = (unit[0] * unit[1]).sum(1)
                strain = np.array(lengths) / self.rest - 1
                tension, slope = np.zeros_like(strain), np.zeros((len(shear), 2, 2))
                shear_stiffness = np.zeros(len(shear))
                for part, law in self.parts:
                    tension[:, part], slope[part] = law.tensions(strain[:, part])
                    shear_stiffness[part] = law.shear_stiffness
                means.append(tension[:, self.parts[0][0]].mean(1))
                area = self.rest[0] * self.rest[1] / 4
                by = [(along[k][None, :, None] * unit[k][:, None, :] / self.rest[k][:, None, None]).reshape(-1, 8) for k in (0, 1)]
                turned = [(unit[1 - k] - shear[:, None] * unit[k]) / lengths[k][:, None] for k in (0, 1)]
                by.append(sum(along[k][None, :, None] * turned[k][:, None, :] for k in (0, 1)).reshape(-1, 8))
                forces = area[:, None] * (tension[0][:, None] * by[0] + tension[1][:, None] * by[1]
                                          + (shear_stiffness * shear)[:, None] * by[2])
                np.add.at(force, self.dofs.ravel(), forces.ravel())
                block = shear_stiffness[:, None, None] * by[2][:, :, None] * by[2][:, None, :]
                for i in (0, 1):
                    for j in (0, 1):
                        block = block + slope[:, i, j, None, None] * by[i][:, :, None] * by[j][:, None, :]
                    # what turns a square that is under tension
                    turn = (np.eye(2) - unit[i][:, :, None] * unit[i][:, None, :]) * (
                        np.maximum(tension[i], 0) / self.rest[i] / lengths[i])[:, None, None]
                    block = block + np.einsum("k,l,nde->nkdle", along[i], along[i], turn).reshape(-1, 8, 8)
                stiffness = stiffness + area[:, None, None] * block
        return force, stiffness, np.mean(means, 0)

    def relax(self):
        for _ in range(60):
            for _, law in self.parts:
                law.unsolved = False
            force, stiffness, means = self.evaluate(self.points)
            largest = np.abs(force[self.free]).max()
            if largest < 1e-6:
                break
            matrix = scipy.sparse.csc_matrix((stiffness.ravel(), (self.rows, self.columns)), shape=(force.size,) * 2)
            step = np.zeros(force.size)
            step[self.free] = scipy.sparse.linalg.spsolve(matrix[self.free][:, self.free], -force[self.free])
            share, size = 1.0, np.linalg.norm(force[self.free])
            while share > 0.05 and np.linalg.norm(
                    self.evaluate(self.points + share * step.reshape(-1, 2))[0][self.free]) > size * (1 - 0.1 * share):
                share /= 2
            self.points = self.points + share * step.reshape(-1, 2)
        return largest, means

    def sizes(self):
        grid = self.points.reshape(COURSES + 1, WALES + 1, 2)
        widths = np.linalg.norm(grid[END:END + PATTERN + 1, SIDE + PATTERN] - grid[END:END + PATTERN + 1, SIDE], axis=1)
        heights = np.linalg.norm(grid[END + PATTERN, SIDE:SIDE + PATTERN + 1] - grid[END, SIDE:SIDE + PATTERN + 1], axis=1)
        return [(lines.mean(), lines[PATTERN // 2], (lines[0] + lines[-1]) / 2) for lines in (widths, heights)]


def main(program, folder, *names):
    def law(name, part):
        return Law(subprocess.run([program, "response", folder, name, part], check=True, capture_output=True,
                                  text=True).stdout)

    border = law(names[0], "border")
    print(f"border's own size for 60 x 60: {border.width:.1f} x {border.height:.1f} mm")
    print("swatch                      cell alone       mean in sheet    middle           edges            tensions N/m   force left, mN")
    for name in names:
        pattern = law(name, "pattern")
        sheet = Sheet(pattern, border)
        left, means = sheet.relax()
        if left > 1e-4 or pattern.unsolved or border.unsolved:
            print(f"{name:<26}the sheet did not come to rest ({left:.0e} mN are left)", flush=True)
            continue
        (width, height) = sheet.sizes()
        columns = "".join(f"{w:6.1f} x {h:<6.1f}  " for w, h in zip(width, height))
        print(f"{name:<26}{pattern.width:6.1f} x {pattern.height:<6.1f}  {columns}{means[0]:5.2f}, {means[1]:5.2f}   {left:.0e}",
              flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
