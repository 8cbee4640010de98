"""Motion from a right-hand side, to round-off: Gragg's modified midpoint rule, extrapolated (Bulirsch & Stoer 1966)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_SUBSTEPS = (2, 4, 6, 8, 10, 12, 14, 16)
_TOLERANCE = 1e-14
# Ten thousand periods take some 300 000.
_MOST_STEPS = 1_000_000
# p is of length 1.
_LARGEST = 1e6


class Lost(ArithmeticError):
    """A right-hand side that cannot be followed."""


def motion(rate: Callable[[Array], Array], start: Array, times: Array) -> list[Array]:
    """p at each of the times, which rise from 0; the error of a step is held near the round-off of double precision.

    Raises :class:`Lost` where a step cannot be made short enough, there are too many, or p grows without bound.
    """
    p, now, found, taken = start, 0.0, [], 0
    step = 0.1 / max(float(np.abs(rate(start)).max()), 1e-3)
    for time in map(float, times):
        while now < time:
            own = min(step, time - now)
            extrapolated, columns = _extrapolated(rate, p, own)
            taken += 1
            if taken > _MOST_STEPS or now + own == now or float(np.abs(p).max()) > _LARGEST:
                raise Lost(f"at t = {now} s of {time} s the right-hand side cannot be followed")
            if extrapolated is None:
                step = own / 2
                continue
            p, now = extrapolated, time if own == time - now else now + own
            if columns <= 6:
                step = max(step, 1.5 * own)
            elif columns == len(_SUBSTEPS):
                step = 0.8 * own
        found.append(p)
    return found


def _extrapolated(rate: Callable[[Array], Array], p: Array, step: float) -> tuple[Array | None, int]:
    """p one step later and how many columns it took; None where extrapolation does not settle."""
    row: list[Array] = []
    for count, substeps in enumerate(_SUBSTEPS, start=1):
        new = [_midpoint(rate, p, step, substeps)]
        for k, older in enumerate(row):
            ratio = (substeps / _SUBSTEPS[count - 2 - k]) ** 2
            new.append(new[k] + (new[k] - older) / (ratio - 1))
        if not np.isfinite(new[-1]).all():
            return None, count
        if row and float(np.abs(new[-1] - row[-1]).max()) <= _TOLERANCE * max(1.0, float(np.abs(p).max())):
            return new[-1], count
        row = new
    return None, len(_SUBSTEPS)


def _midpoint(rate: Callable[[Array], Array], p: Array, step: float, substeps: int) -> Array:
    """The modified midpoint rule: its error has even powers of the substep only."""
    short = step / substeps
    before, now = p, p + short * rate(p)
    for _ in range(substeps - 1):
        before, now = now, before + 2 * short * rate(now)
    return 0.5 * (before + now + short * rate(now))
