"""Reference problems for a test suite of your own.

With pytest::

    import pytest
    import shearbed.testing

    @pytest.mark.parametrize("problem", shearbed.testing.problems(), ids=str)
    def test_my_integrator(problem):
        problem.check(my_step, order=4)
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from . import _grading

__all__ = ["Checked", "problems"]


@dataclass(frozen=True)
class Checked:
    """A reference problem that can judge a function."""

    problem: _grading.Problem

    def __str__(self) -> str:
        return self.problem.name

    def check(self, function: Callable[..., Any], **options: Any) -> None:
        """Grades the function on this problem; ``options`` are those of :func:`shearbed.grade`.

        Raises ``AssertionError`` with the grader's words unless the verdict is PASS.
        """
        report = _grading.grade(function, names=[self.problem.name], **options)
        judged = report[self.problem.name]
        if judged["verdict"] != "PASS":
            why = [judged["diagnosis"], judged.get("note"), judged["raised"]]
            raise AssertionError("\n".join([str(report), *(str(reason) for reason in why if reason), self.problem.because]))


def problems(kind: str = "rods") -> list[Checked]:
    """The problems that a function can be graded on, without ``ten-thousand-periods``, which takes minutes in Python."""
    if kind != "rods":
        raise ValueError(f"kind = {kind!r}: 'rods' is allowed; a program's answers to the others are graded by `shearbed grade`")
    of_rods = (problem for problem in _grading.problems() if problem.kind == kind)
    return [Checked(problem) for problem in of_rods if problem.name not in _grading.OF_METHODS]
