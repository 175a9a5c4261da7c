"""What is raised, warned of and reported; the compiled half takes it from here."""
from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from ._loopwright import Diagnostic


class Error(Exception):
    """A call that cannot be served, with the text that the command would print.

    diagnostics: for a wrong programme, each thing that was said of it, with its place; else ().
    """

    diagnostics: tuple[Diagnostic, ...]

    def __init__(self, message: str, diagnostics: tuple[Diagnostic, ...] = ()) -> None:
        super().__init__(message)
        self.diagnostics = tuple(diagnostics)

    def __reduce__(self) -> tuple[type[Error], tuple[str, tuple[Diagnostic, ...]]]:
        return type(self), (str(self), self.diagnostics)


class BrokenWarning(UserWarning):
    """The result is not what the machine knitted: an interlacing is lost, or yarn went through yarn."""


class NotAtRestWarning(UserWarning):
    """Equilibrium was not reached; the result is as near as the run came."""


class Progress(NamedTuple):
    """How far long work is."""

    phase: str  # 'relaxed repeat', 'grow-in', 'relax', 'stretch', 'relaxing', 'pulling', 'straining'
    share: float  # of the work that is done, 0 to 1
    step: int  # Newton steps so far
    residual: float  # largest force on a control point, B/d^2
