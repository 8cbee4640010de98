"""Rigid slender rods in a sheared liquid, after Lee & Springer (1982): the program shearbed for Python.

Axes: 1 = gradient, 2 = flow, 3 = vorticity; u_2 = G x_1. A rod has no head: p and -p are the same.
"""

from __future__ import annotations

from ._core import SceneError, __version__
from ._fitting import Estimate, Fit, fit
from ._grading import Problem, Report, grade, problems
from ._loading import load
from ._reference import reference
from ._results import Results
from ._scene import Scene, scenes
from ._running import converge, run, sweep

__all__ = [
    "Estimate",
    "Fit",
    "Problem",
    "Report",
    "Results",
    "Scene",
    "SceneError",
    "__version__",
    "converge",
    "fit",
    "grade",
    "load",
    "problems",
    "reference",
    "run",
    "scenes",
    "sweep",
]
