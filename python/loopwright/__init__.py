"""From a knitting notation to relaxed cloth, yarn by yarn.

    import loopwright

    cloth = loopwright.relax("examples/structures/rib.verm", periodic=True)
    cloth.measure()["width_mm"], cloth.interlacings_kept
    cloth.export("rib.glb", repeats=(4, 6))

The functions here take a file's name (a fabric file, knitout, a saved state or curves), a Program or a Cloth, and do
what the subcommand of the same name does, with the same code. Whatever is wrong is raised as loopwright.Error with the
text that the command prints. docs/python.md shows all of it.
"""
from __future__ import annotations

import copyreg as _copyreg
import os as _os
import sys as _sys
import tempfile as _tempfile
from pathlib import Path as _Path
from typing import TYPE_CHECKING, Any, Callable, Iterable, Optional, Sequence, TextIO, Union

from ._errors import BrokenWarning, Error, NotAtRestWarning, Progress
from . import _loopwright
from ._loopwright import (
    Cloth,
    Diagnostic,
    Findings,
    Program,
    StretchTest,
    Yarn,
    YarnForces,
    YarnPoints,
    __version__,
    formats,
    set_threads,
    threads,
    write_png,
)

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from ._loopwright import Homogenised, Measurements, Sensitivity, Window

__all__ = [
    "BrokenWarning", "Cloth", "Diagnostic", "Error", "Findings", "NotAtRestWarning", "Program", "Progress", "Source",
    "StretchTest", "Yarn", "YarnForces", "YarnPoints", "__version__", "build", "check", "check_text", "export",
    "formats", "homogenise", "load", "measure", "progress_bar", "read", "read_curves", "read_text", "relax",
    "relax_as_knitted", "render", "save", "sensitivity", "set_threads", "stretch", "threads", "write_png",
]

PathLike = Union[str, "_os.PathLike[str]"]
Source = Union[PathLike, Program, Cloth]
OnProgress = Callable[[Progress], Optional[bool]]


def read(file: PathLike, *, yarn: str | None = None, gauge_npi: float | None = None,
         loop_length_mm: float | None = None, tuck_length_mm: float | None = None, bed_gap_mm: float | None = None,
         bed_change_mm: float | None = None, float_slack: float | None = None, set: float | None = None) -> Program:
    """Reads and knits a fabric file or a knitout file.

    The other arguments are the headers of a fabric file, stated here instead of there: yarn for every carrier
    ("wool 2/28 Nm" or "diameter=0.5mm ..."), gauge in needles per inch, lengths in mm, slack and set as shares.
    Raises Error with all diagnostics if the programme is wrong; `check` says more and raises nothing.
    """
    return _loopwright.read(_Path(file), yarn=yarn, gauge_npi=gauge_npi, loop_length_mm=loop_length_mm,
                            tuck_length_mm=tuck_length_mm, bed_gap_mm=bed_gap_mm, bed_change_mm=bed_change_mm,
                            float_slack=float_slack, set=set)


def read_text(text: str, suffix: str = ".verm", name: str = "text", **stated: Any) -> Program:
    """`read` for a notation in memory. suffix (".verm", ".k") counts where the first line does not say what it is;
    messages call it by its name; `stated` as in `read`."""
    return _loopwright.read_text(text, suffix, name, **stated)


def check(file: PathLike | Program, machine: str | None = None) -> Findings:
    """All that is wrong, doubtful or worth a second look in a programme; machine: 'shima' or 'kniterate' asks the
    rules of that make as well. Raises nothing for a wrong programme: the Findings are false then."""
    if isinstance(file, Program):
        return file.check(machine)
    return _loopwright.check_file(_Path(file), machine)


def check_text(text: str, suffix: str = ".verm", name: str = "text", machine: str | None = None) -> Findings:
    """`check` for a notation in memory."""
    return _loopwright.check_text(text, suffix, name, machine)


def load(file: PathLike) -> Cloth:
    """Reads a saved state, to the bit."""
    return _loopwright.load(_Path(file))


def read_curves(file: PathLike, *, yarn: str = "", unit_mm: float | None = None,
                friction: float | None = None) -> Cloth:
    """Reads curves of another program (.bcc, .yarns, .obj) as yarns. yarn: their data, "diameter=0.5mm ..."; unit_mm:
    length of the file's unit."""
    return _loopwright.read_curves(_Path(file), yarn=yarn, unit_mm=unit_mm, friction=friction)


class _Stoppable:
    """A callback over several pieces of work: once it has said stop, it is not asked again."""

    def __init__(self, callback: OnProgress) -> None:
        self.callback, self.going = callback, True

    def __call__(self, progress: Progress) -> bool:
        self.going = self.going and self.callback(progress) is not False
        return self.going


def _cloth_of(source: Source, piece: dict[str, Any]) -> Cloth:
    """A cloth as it is, a state or curves as they are read, a programme's first geometry."""
    piece = {key: value for key, value in piece.items() if value is not None}
    if isinstance(source, Cloth) or (not isinstance(source, Program) and _loopwright.kind_of(_Path(source)) != "notation"):
        asked = [key for key in ("periodic", "window") if piece.get(key)]
        if piece.get("layout", "flat") != "flat":
            asked.append("layout")
        if asked:
            raise Error(f"{', '.join(asked)}: a cell or window is taken of a notation, and this is a piece already")
        if isinstance(source, Cloth):
            return source
        return load(source) if _loopwright.kind_of(_Path(source)) == "state" else read_curves(source)
    program = source if isinstance(source, Program) else read(source)
    return program.build(**piece)


def build(source: Source, *, periodic: bool = False, window: Window | None = None, layout: str = "flat",
          segments_per_loop: float = 12, friction: float | None = None) -> Cloth:
    """The first geometry, before mechanics.

    periodic: one repeat of the structure as a cell; window: so many wales and courses from the middle, (16, 16),
    (None, 16) or "16x16"; layout: 'loop' puts a whole piece where the loop-scale model is at rest.
    """
    return _cloth_of(source, dict(periodic=periodic, window=window, layout=layout, friction=friction,
                                  segments_per_loop=segments_per_loop))


def relax(source: Source, *, periodic: bool = False, window: Window | None = None, friction: float | None = None,
          let_go: bool = False, most_iterations: int | None = None, tolerance: float | None = None,
          from_template: bool = False, progress: OnProgress | None = None) -> Cloth:
    """Brings cloth to equilibrium.

    periodic, window: the part of a programme, as in `build`; neither: what the file's edges say. friction: of yarn on
    yarn, 0 to 5; None: the yarn's own, else 0.25. let_go: take the plates of a finite piece away in the end, so that
    it curls. from_template: start a held piece from the first geometry, not from its relaxed repeat.

    progress: called with a Progress after every step; returning False stops, and what was reached is returned. Ctrl-C
    stops after the current step and raises KeyboardInterrupt. Other threads of Python run meanwhile. The result is
    the same to the last bit for any number of threads. BrokenWarning and NotAtRestWarning say what `whole` and
    `converged` of the result say as well.
    """
    progress = progress and _Stoppable(progress)
    cloth = _cloth_of(source, dict(periodic=periodic, window=window, friction=friction, progress=progress,
                                   start_from_cell=not from_template))
    return cloth.relax(friction=friction, let_go=let_go, most_iterations=most_iterations, tolerance=tolerance,
                       progress=progress)


def relax_as_knitted(first: Cloth, *, machine_width_mm: float, take_down_N: float = 0.0, flat_gap_mm: float = 0.0,
                     hand_pull_N_m: float = 0.0, tolerance: float | None = None,
                     progress: OnProgress | None = None) -> Cloth:
    """Brings a first geometry to rest by the way that cloth goes: with friction its size depends on it.

    At rest on the needles first, machine_width_mm wide under a pull of take_down_N along its wales; then let go, friction
    keeping its history. flat_gap_mm: kept flat all the while, the outermost centrelines so far apart; 0: not at all.
    hand_pull_N_m: then pulled straight both ways at once, and let go again. Set yarn (`read(..., set=0.5)`) is set on the
    needles.
    """
    return first.relax_as_knitted(machine_width_mm=machine_width_mm, take_down_N=take_down_N, flat_gap_mm=flat_gap_mm,
                                  hand_pull_N_m=hand_pull_N_m, tolerance=tolerance, progress=progress)


def stretch(source: Source, *, direction: str = "course", to: Sequence[float] = (0.3,),
            load: Sequence[float] | None = None, step: float = 0.02, load_step: float | None = None,
            held_across: bool = False, periodic: bool = False, window: Window | None = None,
            friction: float | None = None, segments_per_loop: float = 24,
            progress: OnProgress | None = None) -> StretchTest:
    """Pulls cloth and reads off the forces of its frame. Cloth that is not at rest is brought there first.

    direction: 'course', 'wale', 'both' or 'shear'; to: strains to go to, in order, (0.3, 0) loads and unloads; load:
    forces instead, N/m; step, load_step: the largest steps; held_across: the other size stays as it is;
    segments_per_loop: of a programme's cloth (forces need more of them than sizes do, for which `build` takes 12).
    """
    progress = progress and _Stoppable(progress)
    cloth = _cloth_of(source, dict(periodic=periodic, window=window, friction=friction, progress=progress,
                                   segments_per_loop=segments_per_loop, start_from_cell=True))
    return cloth.stretch(direction=direction, to=list(to), load=None if load is None else list(load), step=step,
                         load_step=load_step, held_across=held_across, progress=progress)


def _elastic_cell_of(source: Source, segments_per_loop: float) -> Cloth:
    """A cell with segments enough for second derivatives; a state is taken as it is."""
    if isinstance(source, Cloth) or (not isinstance(source, Program) and _loopwright.kind_of(_Path(source)) == "state"):
        return _cloth_of(source, {})
    return _cloth_of(source, dict(periodic=True, friction=0.0, segments_per_loop=segments_per_loop))


def homogenise(source: Source, *, course: Iterable[float] = (-0.05, 0.05, 0.1, 0.15, 0.2),
               wale: Iterable[float] = (-0.1, -0.05, 0.05, 0.1), shear: Iterable[float] = (-0.1, 0.1),
               course_pull: float = 0.3, wale_pull: float = 0.15, step: float = 0.02, grid: bool = True,
               segments_per_loop: float = 24, progress: OnProgress | None = None) -> Homogenised:
    """A cell as a membrane, without friction: stiffness, Poisson's ratios, laws of pulls and forces over a grid of
    strains, by the keys of docs/homogenise.md and, under 'grid', the columns of docs/stretch.md. grid=False leaves
    the grid and its law out."""
    cloth = _elastic_cell_of(source, segments_per_loop)
    return cloth.homogenise(course=list(course), wale=list(wale), shear=list(shear), course_pull=course_pull,
                            wale_pull=wale_pull, step=step, grid=grid, progress=progress)


def sensitivity(source: Source, *, deviations: dict[str, float] | None = None, segments_per_loop: float = 24,
                progress: OnProgress | None = None) -> Sensitivity:
    """How a cell's size and stiffness depend on the data of its yarn, by the keys of docs/homogenise.md: per cent of change
    by one per cent more of a quantity. deviations: standard deviations of quantities in per cent, {"loop-length": 2};
    then the sizes' are given as well."""
    return _elastic_cell_of(source, segments_per_loop).sensitivity(deviations=deviations or {}, progress=progress)


def measure(source: Source, **piece: Any) -> Measurements:
    """Sizes, densities, loop length, mass and the interlacing check by the keys of docs/command.md; of a programme,
    those of its first geometry."""
    return _cloth_of(source, piece).measure()


def export(source: Source, file: PathLike, *, format: str | None = None, per_segment: int = 4, sides: int = 8,
           repeats: tuple[int, int] = (1, 1), quadratic_beams: bool = False, **piece: Any) -> None:
    """Writes cloth for another program: the suffix says the format, or `format`, one of formats()."""
    _cloth_of(source, piece).export(_Path(file), format=format, per_segment=per_segment, sides=sides, repeats=repeats,
                                    quadratic_beams=quadratic_beams)


def render(source: Source, *, periodic: bool = False, window: Window | None = None,
           **options: Any) -> npt.NDArray[np.uint8]:
    """A picture, (height, width, 4) uint8, red, green, blue, alpha; the options are those of Cloth.render: view, size
    in pixels, repeats, transparent ..."""
    return _cloth_of(source, dict(periodic=periodic, window=window)).render(**options)


def save(source: Source, file: PathLike) -> None:
    """Writes a saved state, which `load` and the command read back to the bit."""
    _cloth_of(source, {}).save(_Path(file))


def progress_bar(stream: TextIO | None = None, width: int = 30) -> OnProgress:
    """A callback for `progress` that draws a bar in one line of a terminal or a notebook."""
    out = stream or _sys.stderr

    def show(progress: Progress) -> None:
        bar = "#" * int(width * progress.share)
        out.write(f"\r{progress.phase:>14} [{bar:<{width}}] {100 * progress.share:3.0f} %, step {progress.step}")
        out.flush()

    return show


def _cloth_of_bytes(data: bytes) -> Cloth:
    with _tempfile.TemporaryDirectory() as folder:
        file = _Path(folder) / "cloth.h5"
        file.write_bytes(data)
        return load(file)


def _pickled(cloth: Cloth) -> tuple[Callable[[bytes], Cloth], tuple[bytes]]:
    """As a saved state: what a state holds, the history of friction included, is kept to the bit."""
    with _tempfile.TemporaryDirectory() as folder:
        file = _Path(folder) / "cloth.h5"
        cloth.save(file)
        return _cloth_of_bytes, (file.read_bytes(),)


_copyreg.pickle(Cloth, _pickled)
