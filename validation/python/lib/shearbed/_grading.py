"""Grading a Python function by the problems and the code that grade every other program."""

from __future__ import annotations

import csv
import fnmatch
import inspect
import json
import os
import tempfile
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any
from unittest import SkipTest

import numpy as np
from numpy.typing import NDArray

from ._extrapolation import Lost, motion
from ._formulas import answers
from ._reference import call
from ._running import columns

Array = NDArray[np.float64]

Solver = Callable[[Array, float, Array, Array, int], Array]
Step = Callable[[Array, float, Array, float], Array]
Rhs = Callable[[Array, float, Array], Array]
Closure = Callable[[Array], Array]
Dadt = Callable[[Array, float, Array, dict[str, Any]], Array]

_KINDS = {3: "rhs", 4: "step", 5: "solver"}

# What is not asked unless by name: it tells how errors of a method gather, and takes minutes in Python.
OF_METHODS = ("ten-thousand-periods",)

# Doublings of the number of steps at most, from steps of about one unit of strain.
_DOUBLINGS = 24


@dataclass(frozen=True, eq=False, repr=False)
class Problem:
    """A reference problem with its certified answer."""

    name: str
    title: str
    kind: str
    gradient_per_s: Array
    aspect_ratio: float
    times_s: Array
    start: Array
    """p of each rod at t = 0 as (rods, 3); no rows where none are given."""
    certified: dict[str, Array]
    """The columns of the certified answer, rounded to double."""
    tolerance: float
    because: str
    equations: tuple[str, ...]
    columns: tuple[str, ...] = ()
    """The columns of an answer."""
    formula: dict[str, Any] | None = None
    """What a problem of kind ``formula`` asks for: ``of`` (``pdot``, ``closure`` or ``dadt``), ``closure``, ``model``."""
    inputs: dict[str, Array] | None = None
    """The columns of ``inputs.csv``, a row each, of formulas and contacts."""
    rotation_rad_per_s: tuple[float, ...] | None = None
    """ω of a flow that turns: L(t) = Q L Qᵀ + S with S p = ω × p and Q = exp(St). A function is not asked about these."""

    def __str__(self) -> str:
        return self.name

    def __repr__(self) -> str:
        return f"<Problem {self.name!r}: {self.title}>"

    def check(self, function: Callable[..., Any], **options: Any) -> None:
        """Grades the function on this problem; ``options`` are those of :func:`grade`.

        Raises ``AssertionError`` with the grader's words unless the verdict is PASS, and ``unittest.SkipTest``, a skipped test in pytest
        too, where the function raises ``NotImplementedError``.
        """
        report = grade(function, names=[self.name], **options)
        judged = report[self.name]
        if judged["verdict"] == "REFUSED":
            raise SkipTest(f"{self.name}: {judged['raised']}")
        if judged["verdict"] != "PASS":
            why = [judged["diagnosis"], judged.get("note"), judged["raised"]]
            raise AssertionError("\n".join([str(report), *(str(reason) for reason in why if reason), self.because]))


@cache
def problems() -> tuple[Problem, ...]:
    """The reference problems, in the order of ``shearbed problems``."""
    folders = (path for path in Path(_exported().name).iterdir() if path.is_dir())
    return tuple(_problem(folder) for folder in sorted(folders))


@cache
def _exported() -> tempfile.TemporaryDirectory[str]:
    """The problems as files, made once; they go when Python ends."""
    folder = tempfile.TemporaryDirectory(prefix="shearbed-")
    call(["problems", "export", folder.name, "--quiet"])
    return folder


def _problem(folder: Path) -> Problem:
    record = json.loads((folder / "problem.json").read_text(encoding="utf-8"))
    start, inputs = folder / "start.csv", folder / "inputs.csv"
    rods = np.stack([columns(start)[name] for name in ("p1", "p2", "p3")], axis=1) if start.exists() else np.empty((0, 3))
    return Problem(
        name=record["name"],
        title=record["title"],
        kind=record["kind"],
        gradient_per_s=np.array(record["gradient_per_s"]),
        aspect_ratio=record["aspect_ratio"],
        times_s=np.array(record["times_s"]),
        start=rods,
        certified=columns(folder / "certified.csv"),
        tolerance=record["tolerance"],
        because=record["because"],
        equations=tuple(record["equations"]),
        columns=tuple(record["columns"]),
        formula=record.get("formula"),
        inputs=columns(inputs) if inputs.exists() else None,
        rotation_rad_per_s=tuple(record["rotation_rad_per_s"]) if "rotation_rad_per_s" in record else None,
    )


class Report:
    """What was found: a verdict for each problem. True where a problem passes, and none fails or was not reached."""

    def __init__(self, record: dict[str, Any], runs: Sequence[tuple[str, int, float, float]] = ()) -> None:
        self.problems: list[dict[str, Any]] = record["problems"]
        """name, verdict, reference, error, tolerance, observed_order, diagnosis, raised, ... of each problem."""
        self._runs = runs

    def work_precision(self) -> dict[str, Any]:
        """Error against work of a step or a solver: arrays with an entry for each problem and number of steps, as the columns of the
        command's ``runs.csv``; ``pandas.DataFrame`` takes them.

        ``problem``, ``steps``, ``evaluations``, ``error`` (in the problem's metric, the largest over all times) and ``seconds`` (of
        one answer to all times, by the clock). ``evaluations`` is by how much ``function.evaluations`` grew, and NaN where the
        function has no such counter. Raises ``ValueError`` for a right-hand side or a formula, which takes no steps.
        """
        if not self._runs:
            raise ValueError("work_precision: no answer has a number of steps; a step or a solver has")
        errors = {(judged["name"], steps): error for judged in self.problems for steps, error in judged["errors"]}
        name, steps, evaluations, seconds = zip(*self._runs)
        error = [errors.get((of, count)) for of, count in zip(name, steps)]
        return {
            "problem": np.array(name),
            "steps": np.array(steps),
            "evaluations": np.array(evaluations),
            "error": np.array([np.nan if one is None else one for one in error]),
            "seconds": np.array(seconds),
        }

    def __bool__(self) -> bool:
        verdicts = [problem["verdict"] for problem in self.problems]
        return "PASS" in verdicts and set(verdicts) <= {"PASS", "REFUSED", "MISSING"}

    def __getitem__(self, name: str) -> dict[str, Any]:
        for problem in self.problems:
            if problem["name"] == name:
                return problem
        raise KeyError(name)

    def __repr__(self) -> str:
        verdicts = [problem["verdict"] for problem in self.problems]
        return f"<Report: {', '.join(f'{verdicts.count(verdict)} {verdict}' for verdict in dict.fromkeys(verdicts))}>"

    def __str__(self) -> str:
        lines = [f"{'problem':<22} {'verdict':<11} {'error':>9} {'tolerance':>9} {'order':>6}  diagnosis"]
        for problem in self.problems:
            error, order = problem["error"], problem["observed_order"]
            foreign = "" if problem["reference"] == "built-in" else "FOREIGN "
            lines.append(
                f"{problem['name']:<22} {problem['verdict']:<11} {_short(error):>9} {problem['tolerance']:>9.1e} "
                f"{'–' if order is None else f'{order:.2f}':>6}  {foreign}{problem['diagnosis'] or problem['raised'] or _note(problem)}".rstrip()
            )
        return "\n".join(lines)

    def plot(self, ax: Any = None) -> Any:
        """Draws each problem's error over its tolerance, and returns the axes."""
        import matplotlib.pyplot as plt

        judged = [problem for problem in self.problems if problem["error"] is not None]
        if ax is None:
            _, ax = plt.subplots(figsize=(7, 0.3 * len(judged) + 1.2), layout="constrained")
        shares = [problem["error"] / problem["tolerance"] for problem in judged]
        least = min([share for share in shares if share > 0] + [1e-6]) / 10
        passed = [problem["verdict"] == "PASS" for problem in judged]
        # A share of 0 has no bar on a scale of powers.
        ax.barh(range(len(judged)), [max(share - least, 0.0) for share in shares], color=["#0072b2" if good else "#d55e00" for good in passed], left=least)
        for row, share in enumerate(shares):
            if share == 0:
                ax.text(least, row, " 0", va="center")
        ax.set_yticks(range(len(judged)), [problem["name"] for problem in judged])
        ax.set_xscale("log")
        ax.invert_yaxis()
        ax.axvline(1.0, color="black", linewidth=1)
        ax.set_xlabel("error / tolerance")
        return ax


def _note(problem: dict[str, Any]) -> str:
    """Why a problem failed whose error has no size."""
    return str(problem.get("note") or "") if problem["verdict"] == "FAIL" and problem["error"] is None else ""


def _short(number: float | None) -> str:
    return "–" if number is None else f"{number:.1e}"


def grade(
    function: Rhs | Step | Solver | Closure | Dadt,
    *,
    kind: str | None = None,
    order: float | None = None,
    steps: Sequence[int] | None = None,
    names: Sequence[str] | None = None,
    tolerance: float | None = None,
    timeout_s: float = 30.0,
) -> Report:
    """Grades a Python function on the problems of free rods, or on formulas, as ``shearbed grade`` grades files.

    What the function is, is seen from the number of its parameters, or said by ``kind``:

    - ``"rhs"``: ``function(gradient_per_s, aspect_ratio, p)`` returns dp/dt in 1/s. It is integrated here, to round-off:
      the error is that of the right-hand side.
    - ``"step"``: ``function(gradient_per_s, aspect_ratio, p, dt_s)`` returns p one step later.
    - ``"solver"``: ``function(gradient_per_s, aspect_ratio, start, times_s, steps)`` returns p at the times as
      (times, rods, 3), with at least ``steps`` steps to the last time.

    ``names`` are names of problems, or patterns with ``*``: ``["mid-flip-*"]``. Without them all problems of free rods are asked. A
    function for formulas needs ``names`` of formulas, such as ``["pdot-*"]``, ``["closure-ibof"]`` or ``["dadt-*"]``, and is one of

    - ``function(gradient_per_s, aspect_ratio, p)``, which returns dp/dt;
    - ``function(a)``, which returns a_ijkl as (3, 3, 3, 3);
    - ``function(gradient_per_s, aspect_ratio, a)``, or with ``model`` as a fourth, which returns da/dt as (3, 3).

    Entries of a tensor that must be equal and are not FAIL.

    All rods come and go at once: ``start``, ``p`` and dp/dt are (rods, 3). A step or a solver is asked with twice the steps
    each time, until two answers in a row are within the tolerance (and with ``order`` until round-off), or nothing changes any
    more, as the program is that ``shearbed grade`` runs. Where ``timeout_s`` seconds a problem are not enough for that, the
    verdict is NOT REACHED: neither passed nor failed. With ``steps`` these numbers of steps are asked instead, and the last is
    judged. With ``order`` the observed order is judged too: one that is lower by whole orders fails. ``tolerance`` is the
    largest error that passes where a problem's own is smaller. ``ten-thousand-periods`` is left out unless ``names`` has it or
    ``steps`` are given. A function that raises an ``ArithmeticError``, ``ValueError`` or ``RuntimeError`` has no answer from there
    on, and the report says what it raised. By ``NotImplementedError`` it says that a problem is none of its own: REFUSED, no failure.
    """
    known = {problem.name: problem for problem in problems() if problem.kind in ("rods", "formula") and not problem.rotation_rad_per_s}
    asked: set[str] = set()
    for pattern in [names] if isinstance(names, str) else names or ():
        matching = fnmatch.filter(known, pattern)
        if not matching:
            raise ValueError(f"{pattern}: no problem about rods or formulas has this name; there are {', '.join(known)}")
        asked.update(matching)
    of_rods = [name for name, problem in known.items() if problem.kind == "rods"]
    asked = asked or {name for name in of_rods if steps is not None or name not in OF_METHODS}
    wanted = [problem for name, problem in known.items() if name in asked]
    kind = "formula" if wanted[0].formula else kind or _kind_of(function)
    if any((problem.formula is None) != (kind != "formula") for problem in wanted):
        raise ValueError("names: problems about rods and formulas take functions of their own; names=['pdot-*'] asks for a formula")
    if kind not in (*_KINDS.values(), "formula"):
        raise ValueError(f"kind = {kind!r}: 'rhs', 'step' and 'solver' are allowed")
    if kind in ("rhs", "formula"):
        for name, given in (("order", order), ("steps", steps)):
            if given is not None:
                what = "right-hand side" if kind == "rhs" else "formula"
                raise ValueError(f"{name} = {given!r}: a {what} has none; a step or a solver has")
    if wrong := [number for number in steps or () if int(number) != number or number < 1]:
        raise ValueError(f"steps: {wrong[0]!r}: whole numbers from 1 are allowed")
    raised: dict[str, str] = {}
    refused: set[str] = set()
    uneven: dict[str, str] = {}
    runs: list[tuple[str, int, float, float]] = []
    late: dict[str, int] = {}
    with tempfile.TemporaryDirectory(prefix="shearbed-") as folder:
        mine, out = Path(folder, "mine"), Path(folder, "out")
        for problem in wanted:
            errors: list[float] = []
            begun = time.monotonic()
            for count in (None,) if kind in ("rhs", "formula") else steps or _ladder(problem):
                asked_at = time.monotonic()
                try:
                    if problem.formula:
                        allowed = max(problem.tolerance, tolerance or 0.0)
                        rows, why = answers(function, problem.formula, problem.inputs or {}, problem.columns, allowed)
                        uneven |= {problem.name: why} if why else {}
                        _write_rows(mine / problem.name / "answer.csv", problem.columns, rows)
                        continue
                    counted = getattr(function, "evaluations", np.nan)
                    found = _answer(function, kind, problem, count)
                    if count is not None:
                        counted = getattr(function, "evaluations", np.nan) - counted
                        runs.append((problem.name, count, float(counted), time.monotonic() - asked_at))
                except Lost as error:
                    raised[problem.name] = str(error)
                    found = np.full((len(problem.times_s), len(problem.start), 3), np.nan)
                except (ArithmeticError, RuntimeError, ValueError) as error:
                    raised[problem.name] = f"{type(error).__name__}: {error}"
                    if isinstance(error, NotImplementedError):
                        refused.add(problem.name)
                    break
                answer = "answer.csv" if count is None else f"steps-{count}.csv"
                _write(mine / problem.name / answer, problem, _shaped(found, problem))
                if count is None or steps:
                    continue
                errors.append(_error(_shaped(found, problem), problem))
                if _done(errors, max(problem.tolerance, tolerance or 0.0), problem.tolerance if order else None):
                    break
                now = time.monotonic()
                # The next takes twice as long.
                if now - begun + 2 * (now - asked_at) > timeout_s:
                    late[problem.name] = count
                    break
        mine.mkdir(exist_ok=True)
        words = ["grade", _exported().name, str(mine), "--out", str(out), "--quiet"]
        for problem in wanted:
            words += ["--problem", problem.name]
        if order is not None:
            words += ["--order", repr(float(order))]
        if tolerance is not None:
            words += ["--tolerance", repr(float(tolerance))]
        call(words, folder=folder, allowed=(0, 1))
        text = (out / "grade.json").read_text(encoding="utf-8")
    # Nobody can open these folders any more: files are named by problem.
    for gone in (str(mine), _exported().name):
        text = text.replace(json.dumps(gone + os.sep)[1:-1], "")
    record = json.loads(text)
    for judged in record["problems"]:
        judged["raised"] = raised.get(judged["name"])
        if judged["verdict"] == "MISSING" and judged["raised"]:
            judged["note"] = None
            if judged["name"] in refused:
                judged["verdict"] = "REFUSED"
        if judged["name"] in uneven:
            judged["verdict"], judged["diagnosis"] = "FAIL", uneven[judged["name"]]
        # An order that is too low is so whatever the time.
        if judged["name"] in late and judged["verdict"] == "FAIL" and judged["order_found"] != "lower":
            judged["verdict"] = "NOT REACHED"
            judged["note"] = f"time ran out (timeout_s = {timeout_s:g}) after {late[judged['name']]} steps; {judged['note']}"
    return Report(record, runs)


def _ladder(problem: Problem) -> list[int]:
    """Numbers of steps, each twice the one before, from one step a unit of strain."""
    strain = float(np.abs(problem.gradient_per_s).max() * problem.times_s[-1])
    coarsest = max(8, 1 << int(np.ceil(np.log2(max(strain, 1.0)))))
    return [coarsest << doubling for doubling in range(_DOUBLINGS)]


def _error(found: Array, problem: Problem) -> float:
    """The largest angle to the certified directions in rad, head or tail alike, not less than ||p| - 1|; when to stop, no verdict."""
    p = found.reshape(-1, 3)
    q = np.stack([problem.certified[name] for name in ("p1", "p2", "p3")], axis=1)
    with np.errstate(all="ignore"):
        angle = np.arctan2(np.linalg.norm(np.cross(p, q), axis=1), np.abs((p * q).sum(axis=1)))
        error = float(np.maximum(angle, np.abs(np.linalg.norm(p, axis=1) - 1)).max())
    return error if np.isfinite(error) else np.inf


def _done(errors: list[float], tolerance: float, own: float | None) -> bool:
    """Whether finer steps would tell nothing more; ``own`` is the problem's own tolerance where an order is claimed."""
    if len(errors) > 1 and max(errors[-2:]) <= tolerance:
        # Down to round-off where an order is to be seen.
        return own is None or errors[-1] <= 0.01 * own or (errors[-2] <= own and errors[-1] > 0.7 * errors[-2])
    last = errors[-4:]
    if len(errors) > 10 and not np.isfinite(last).any():
        return True
    return len(errors) > 8 and bool(np.isfinite(last).all()) and max(last) - min(last) <= 0.01 * last[-1]


def _kind_of(function: Callable[..., Any]) -> str:
    """What a function is, by what it must be given."""
    needed = [
        parameter
        for parameter in inspect.signature(function).parameters.values()
        if parameter.default is parameter.empty and parameter.kind is not parameter.KEYWORD_ONLY
    ]
    if any(parameter.kind is parameter.VAR_POSITIONAL for parameter in needed) or len(needed) not in _KINDS:
        raise ValueError(
            f"kind: a function of {', '.join(map(str, needed)) or 'nothing'} does not tell what it is; "
            "kind='rhs', 'step' or 'solver' says it, and names=['closure-*'], ['dadt-*'] or ['pdot-*'] asks for a formula"
        )
    return _KINDS[len(needed)]


def _answer(function: Any, kind: str, problem: Problem, count: int | None) -> Any:
    given = (problem.gradient_per_s.copy(), problem.aspect_ratio)
    if kind == "rhs":
        return motion(lambda p: _like(function(*given, p.copy()), p, problem), problem.start, problem.times_s)
    if kind == "solver":
        return function(*given, problem.start.copy(), problem.times_s.copy(), count)
    return _stepped(function, given, problem, count or 1)


def _like(found: Any, p: Array, problem: Problem) -> Array:
    rates: Array = np.asarray(found, dtype=float)
    if rates.shape != p.shape:
        raise TypeError(f"{problem.name}: (rods, 3) = {p.shape} is asked for, not {rates.shape}")
    return rates


def _shaped(found: Any, problem: Problem) -> Array:
    answer: Array = np.asarray(found, dtype=float)
    wanted = (len(problem.times_s), len(problem.start), 3)
    if answer.shape != wanted:
        raise TypeError(f"{problem.name}: p as (times, rods, 3) = {wanted} is asked for, not {answer.shape}")
    return answer


def _stepped(function: Any, given: tuple[Array, float], problem: Problem, count: int) -> list[Array]:
    """Equal steps to each time, about so many to the last."""
    p, now, found = problem.start.copy(), 0.0, []
    end = float(problem.times_s[-1])
    for time in map(float, problem.times_s):
        own = max(1, round(count * (time - now) / end)) if time > now else 0
        for _ in range(own):
            p = _like(function(*given, p.copy(), (time - now) / own), p, problem)
        now = time
        found.append(p)
    return found


def _write(file: Path, problem: Problem, answer: Array) -> None:
    rows = ([float(time), rod, *map(float, p)] for time, rods in zip(problem.times_s, answer) for rod, p in enumerate(rods))
    _write_rows(file, ("time_s", "rod", "p1", "p2", "p3"), rows)


def _write_rows(file: Path, header: Sequence[str], rows: Iterable[Sequence[float]]) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    with open(file, "w", encoding="utf-8", newline="") as text:
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(header)
        writer.writerows([repr(value) for value in row] for row in rows)
