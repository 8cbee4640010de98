"""Answers of a function to problems without time: ``pdot-*``, ``closure-*``, ``dadt-*``."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))


def answers(function: Callable[..., Any], formula: Mapping[str, Any], inputs: Mapping[str, Array], columns: tuple[str, ...], tolerance: float) -> tuple[list[list[float]], str | None]:
    """The rows of the answer, below ``columns``, of which the first is the number of the row, and what is uneven in it: the columns have
    each entry of a symmetric tensor once, so its equals must agree with it within the tolerance.

    ``pdot``: ``function(gradient_per_s, aspect_ratio, p)`` returns dp/dt, with p as (1, 3) or (3,). ``closure``: ``function(a)``
    returns a_ijkl as (3, 3, 3, 3). ``dadt``: ``function(gradient_per_s, aspect_ratio, a)`` or ``function(gradient_per_s,
    aspect_ratio, a, model)`` returns da/dt as (3, 3); ``model`` is that of ``formula``, with its parameters.
    """
    of, rows, uneven = formula["of"], [], None
    shape = {"pdot": (3,), "closure": (3, 3, 3, 3), "dadt": (3, 3)}[of]
    for row in range(len(inputs["row"])):
        at = {name: float(values[row]) for name, values in inputs.items()}
        found = np.asarray(function(*_given(of, function, formula, at)), dtype=float)
        if of == "pdot" and found.shape == (1, 3):
            found = found[0]
        if found.shape != shape:
            raise TypeError(f"row {row}: {shape} is asked for, not {found.shape}")
        uneven = uneven or _uneven(row, "da" if of == "dadt" else "a", found, tolerance)
        rows.append([float(row), *(float(found[_place(name)]) for name in columns[1:])])
    return rows, uneven


def _uneven(row: int, name: str, found: Array, tolerance: float) -> str | None:
    """Two entries that must be equal and are not: of a tensor a_ij, or of a_ijkl by i and j, k and l, or both pairs."""
    for axes in {2: ((1, 0),), 4: ((1, 0, 2, 3), (0, 1, 3, 2), (2, 3, 0, 1))}.get(found.ndim, ()):
        apart = np.abs(found - found.transpose(axes))
        if apart.max() > tolerance:
            at = np.unravel_index(int(apart.argmax()), found.shape)
            one, other = (f"{name}{''.join(str(i + 1) for i in place)} = {found[place]:g}" for place in (at, tuple(at[k] for k in axes)))
            return f"row {row}: {one} but {other}"
    return None


def _given(of: str, function: Callable[..., Any], formula: Mapping[str, Any], at: Mapping[str, float]) -> tuple[Any, ...]:
    if of == "closure":
        return (_tensor(at),)
    flow = (np.array([[at[f"l{i}{j}_per_s"] for j in (1, 2, 3)] for i in (1, 2, 3)]), at["aspect_ratio"])
    if of == "pdot":
        return (*flow, np.array([[at["p1"], at["p2"], at["p3"]]]))
    needed = [one for one in inspect.signature(function).parameters.values() if one.default is one.empty]
    return (*flow, _tensor(at)) + ((formula["model"],) if len(needed) > 3 else ())


def _tensor(at: Mapping[str, float]) -> Array:
    a = np.empty((3, 3))
    for i, j in _PAIRS:
        a[i, j] = a[j, i] = at[f"a{i + 1}{j + 1}"]
    return a


def _place(name: str) -> tuple[int, ...]:
    """The indices in a column's name: ``pdot1_per_s``, ``a1122``, ``dadt12_per_s``."""
    return tuple(int(digit) - 1 for digit in name if digit.isdigit())
