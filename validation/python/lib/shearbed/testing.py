"""Reference problems for a test suite of your own.

With pytest::

    import pytest
    import shearbed.testing

    @pytest.mark.parametrize("problem", shearbed.testing.problems(), ids=str)
    def test_my_integrator(problem):
        problem.check(my_step, order=4)
"""

from __future__ import annotations

from . import _grading
from ._grading import Problem

__all__ = ["Problem", "problems"]


def problems(kind: str = "rods") -> list[Problem]:
    """The problems that a function can be graded on, each with its ``check``: about ``rods``, without ``ten-thousand-periods``, which
    takes minutes in Python, or of the kind ``formula``."""
    if kind not in ("rods", "formula"):
        raise ValueError(
            f"kind = {kind!r}: 'rods' and 'formula' are allowed; a program's answers to the others are graded by `shearbed grade`"
        )
    return [
        problem
        for problem in _grading.problems()
        if problem.kind == kind and not problem.rotation_rad_per_s and problem.name not in _grading.OF_METHODS
    ]
