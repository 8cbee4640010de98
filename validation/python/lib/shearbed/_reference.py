"""Exact values without a simulation."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._running import columns, keywords, number


def reference(
    aspect_ratio: float,
    *,
    times: ArrayLike | tuple[float, float, int] | None = None,
    start: str | ArrayLike = "isotropic",
    unit: str | None = None,
    shear_rate_per_s: float | None = None,
    gradient_per_s: ArrayLike | None = None,
    aspect_ratio_sd_percent: float = 0.0,
    c_i: float | None = None,
    d_r_per_s: float | None = None,
    steps: Sequence[tuple[float, ArrayLike]] | None = None,
    oscillation_period_s: float | None = None,
    steady: bool = False,
    fourth: bool = False,
    optics: bool = False,
) -> dict[str, NDArray[np.float64]]:
    """Correctly rounded values of a free rod, or of means over isotropic ones: the columns of ``shearbed reference``.

    ``times`` are a list or an array, or, as a tuple, ``(first, last, count)`` for evenly spaced ones, in ``unit``:
    ``"period"``, ``"strain"`` or ``"s"``; without it periods, and strain for ``aspect_ratio=inf``. Without
    ``shear_rate_per_s`` the shear rate is 1/s. ``start`` is
    ``"isotropic"``, ``"planar"``, one rod's angles (phi, theta) in degrees, or with diffusion (a11, a22, a33, a12, a13,
    a23) of a density of Bingham, or directions (N × 3). A value without a meaning, as t/T in a
    flow without a period, is NaN.

    ``c_i`` are rods with rotary diffusion D_r = c_i times the rate of strain (Folgar & Tucker), ``d_r_per_s`` those with
    that D_r, from the exact distribution; ``steady=True`` adds its steady state as a last row at the time inf.
    ``fourth=True`` gives a_ijkl, ``optics=True`` adds the order parameter and the extinction angle. ``steps`` are flows
    one after another, each (duration in s, shear rate or 3 × 3 gradient in 1/s), and ``oscillation_period_s`` is T of a
    flow times cos 2πt/T; times are then in s.
    """
    words = ["reference", "--aspect-ratio", number("aspect_ratio", aspect_ratio)]
    order: NDArray[np.intp] | None = None
    if isinstance(times, tuple) and len(times) == 3:
        first, last, count = times
        if int(count) != count or count < 2:
            raise ValueError(f"times = {times}: a tuple is (first, last, count), with a count of at least 2; a list has the times themselves")
        words += ["--times", f"{float(first)!r}:{float(last)!r}:{int(count)}"]
    elif times is not None:
        every, order = np.unique(np.asarray(times, dtype=float).ravel(), return_inverse=True)
        words += ["--times", ",".join(repr(float(time)) for time in every)]
    if unit is not None:
        words += ["--unit", unit]
    directions = None if isinstance(start, str) else np.asarray(start, dtype=float)
    if isinstance(start, str):
        words += ["--start", start]
    elif directions is not None and directions.ndim == 1:
        words += ["--start", ",".join(repr(float(angle)) for angle in directions)]
    if oscillation_period_s is not None:
        words += ["--oscillation-period-s", number("oscillation_period_s", oscillation_period_s)]
    if shear_rate_per_s is not None:
        words += ["--shear-rate-per-s", number("shear_rate_per_s", shear_rate_per_s)]
    if gradient_per_s is not None:
        entries = np.asarray(gradient_per_s, dtype=float)
        if entries.shape != (3, 3):
            raise ValueError(f"gradient_per_s: an array of {entries.shape}: (3, 3), row i and column j for ∂u_i/∂x_j, is allowed")
        words += ["--gradient-per-s", ",".join(repr(float(entry)) for entry in entries.ravel())]
    if aspect_ratio_sd_percent:
        words += ["--aspect-ratio-sd-percent", number("aspect_ratio_sd_percent", aspect_ratio_sd_percent)]
    if c_i is not None:
        words += ["--c-i", number("c_i", c_i)]
    if d_r_per_s is not None:
        words += ["--d-r-per-s", number("d_r_per_s", d_r_per_s)]
    words += [flag for flag, asked in (("--steady", steady), ("--fourth", fourth), ("--optics", optics)) if asked]
    with tempfile.TemporaryDirectory(prefix="shearbed-") as folder:
        if steps is not None:
            path = Path(folder, "steps.csv")
            path.write_text(_flows(steps))
            words += ["--steps", str(path)]
        if directions is not None and directions.ndim != 1:
            path = Path(folder, "start.csv")
            rows = [",".join(repr(float(value)) for value in row) for row in directions.reshape(-1, 3)]
            path.write_text("\n".join(["p1,p2,p3", *rows, ""]))
            words += ["--start", str(path)]
        call([*words, "--out", str(Path(folder, "reference.csv"))], folder=folder)
        found = columns(Path(folder, "reference.csv"))
    if order is None:
        return found
    # The last row of a steady state belongs to no time that was asked for.
    return {name: np.concatenate([values[order], values[int(order.max(initial=-1)) + 1 :]]) for name, values in found.items()}


def call(words: Sequence[str], *, folder: str = "", allowed: Sequence[int] = (0,)) -> int:
    """Runs a command in this process; raises its message as ``ValueError`` unless its exit code is allowed. Files in
    ``folder`` are named without it."""
    code, message = _core.call(list(words))
    if code not in allowed:
        said = message.strip().removeprefix("error: ")
        said = said.replace(os.path.join(folder, ""), "") if folder else said
        raise (RuntimeError if code == 101 else ValueError)(keywords(said))
    return code


def _flows(steps: Sequence[tuple[float, ArrayLike]]) -> str:
    """The CSV of flows that ``shearbed reference --steps`` reads."""
    lines = ["duration_s," + ",".join(f"l{i}{j}" for i in (1, 2, 3) for j in (1, 2, 3))]
    for duration_s, flow in steps:
        gradient = np.asarray(flow, dtype=float)
        if gradient.ndim == 0:
            gradient = np.array([[0, 0, 0], [gradient, 0, 0], [0, 0, 0]], dtype=float)
        lines.append(",".join(repr(float(value)) for value in (duration_s, *gradient.reshape(9))))
    return "\n".join(lines) + "\n"
