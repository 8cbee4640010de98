"""Exact values without a simulation."""

from __future__ import annotations

import csv
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core


def reference(
    aspect_ratio: float,
    *,
    times: tuple[float, float, int],
    start: str | tuple[float, float] = "isotropic",
    unit: str = "period",
    shear_rate_per_s: float | None = None,
    gradient_per_s: ArrayLike | None = None,
    aspect_ratio_sd_percent: float = 0.0,
) -> dict[str, NDArray[np.float64]]:
    """Correctly rounded values of a free rod, or of means over isotropic ones: the columns of ``shearbed reference``.

    ``times=(first, last, count)`` in ``unit`` (``"period"``, ``"strain"`` or ``"s"``); ``start`` is ``"isotropic"`` or one
    rod's angles (phi, theta) in degrees. A value without a meaning, as t/T in a flow without a period, is NaN.
    """
    first, last, count = times
    words = ["reference", "--aspect-ratio", repr(float(aspect_ratio)), "--unit", unit]
    words += ["--times", f"{float(first)!r}:{float(last)!r}:{int(count)}"]
    words += ["--start", start if isinstance(start, str) else ",".join(repr(float(angle)) for angle in start)]
    if shear_rate_per_s is not None:
        words += ["--shear-rate-per-s", repr(float(shear_rate_per_s))]
    if gradient_per_s is not None:
        entries = np.asarray(gradient_per_s, dtype=float).reshape(9)
        words += ["--gradient-per-s", ",".join(repr(float(entry)) for entry in entries)]
    if aspect_ratio_sd_percent:
        words += ["--aspect-ratio-sd-percent", repr(float(aspect_ratio_sd_percent))]
    with tempfile.TemporaryDirectory(prefix="shearbed-") as folder:
        file = Path(folder, "reference.csv")
        call([*words, "--out", str(file)])
        header, rows = read(file)
    return {name: np.array([row[k] for row in rows]) for k, name in enumerate(header)}


def call(words: Sequence[str], *, allowed: Sequence[int] = (0,)) -> int:
    """Runs a command in this process; raises its message as ``ValueError`` unless its exit code is allowed."""
    code, message = _core.call(list(words))
    if code not in allowed:
        raise (RuntimeError if code == 101 else ValueError)(message.strip().removeprefix("error: "))
    return code


def read(file: Path) -> tuple[list[str], list[list[Any]]]:
    """A CSV file of numbers; a blank field is NaN."""
    with open(file, encoding="utf-8", newline="") as text:
        header, *rows = list(csv.reader(text))
    return header, [[float(field) if field else float("nan") for field in row] for row in rows]
