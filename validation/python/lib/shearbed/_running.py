"""Running scenes."""

from __future__ import annotations

import csv
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._results import Results
from ._scene import Scene, _value, scene_of


def run(
    scene: Scene | Mapping[str, Any] | str | os.PathLike[str],
    *,
    replicas: int | None = None,
    seed: int | None = None,
    threads: int | None = None,
    progress: Callable[[int, int], object] | bool = False,
) -> Results:
    """Runs a scene: the same bits as the program, on any number of threads.

    ``replicas`` and ``seed`` stand in place of the scene's own. ``progress(done, of)`` is called about twenty times a second;
    ``progress=True`` draws a bar with tqdm where it is installed. Other Python threads go on meanwhile, and Ctrl-C stops it.

    Raises :class:`SceneError` for a scene that cannot be run, ``RuntimeError`` for a run that cannot go on.
    """
    scene = scene_of(scene)
    told = _bar("replica") if progress is True else progress or None
    return Results(_core.run(scene._name, scene._text, replicas, seed, threads, told))


def _bar(unit: str) -> Callable[[int, int], object] | None:
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return None
    bar = tqdm(unit=unit)

    def told(done: int, of: int) -> None:
        bar.total = of
        bar.update(done - bar.n)
        if done == of:
            bar.close()

    return told


def sweep(
    scene: Scene | Mapping[str, Any] | str | os.PathLike[str],
    over: Mapping[str, Sequence[Any]],
    *,
    times: str = "last",
    replicas: int | None = None,
    seed: int | None = None,
    set: Mapping[str, Any] | None = None,
    threads: int | None = None,
    progress: Callable[[int, int], object] | bool = False,
) -> dict[str, NDArray[Any]]:
    """Runs a scene at every combination of its keys' values, as ``shearbed sweep`` does.

    ``sweep(scene, {"interaction.alpha": [0.25, 0.5, 1]})`` gives the columns of ``sweep.csv``, one row a point: the swept
    keys, then time, means and standard errors at the last output; with ``times="all"`` one row for each output of each
    point. All points have the same seed. ``set={"particles.count": 50}`` gives keys of the scene another value.
    ``progress(done, of)`` counts points; ``progress=True`` draws a bar with tqdm where it is installed.
    """
    if times not in ("last", "all"):
        raise ValueError(f"times = {times!r}: 'last' and 'all' are allowed")
    scene = scene_of(scene)
    with tempfile.TemporaryDirectory(prefix="shearbed-") as made:
        folder = Path(made)
        words = ["sweep", scene._written(folder).name, "--out", "out", "--quiet"]
        for key, values in over.items():
            words += ["--over", f"{key}=" + ",".join(_value(value) for value in values)]
        words += options(replicas=replicas, seed=seed, threads=threads, set=set)
        points = int(np.prod([len(values) for values in over.values()]))
        told = _bar("point") if progress is True else progress or None

        def watch() -> None:
            if told:
                told(len(list(folder.glob("out/points/*/shearbed.json"))), points)

        program(words, folder, watch if told else None)
        swept = columns(folder / "out" / "sweep.csv")
        if times == "last":
            return swept
        of_points = [_tables(point) for point in sorted((folder / "out" / "points").iterdir())]
    rows = [len(next(iter(table.values()))) for table in of_points]
    keys = {name: np.repeat(values, rows) for name, values in swept.items() if name in over}
    return keys | {name: np.concatenate([table[name] for table in of_points]) for name in of_points[0]}


def _tables(point: Path) -> dict[str, NDArray[Any]]:
    """The columns of a point's tables, side by side, in the order of the columns of ``sweep.csv``."""
    tables: dict[str, NDArray[Any]] = {}
    for file in sorted(point.glob("*.csv")):
        tables |= columns(file)
    return tables


def options(*, set: Mapping[str, Any] | None = None, **numbers: int | None) -> list[str]:
    """Words of the command line for what is given."""
    words = [word for key, value in (set or {}).items() for word in ("--set", f"{key}={_value(value)}")]
    for flag, value in numbers.items():
        if value is not None:
            words += [f"--{flag}", str(value)]
    return words


def columns(file: Path) -> dict[str, NDArray[Any]]:
    """The columns of a CSV file."""
    with open(file, encoding="utf-8", newline="") as text:
        header, *rows = list(csv.reader(text))
    return {name: column([row[k] for row in rows]) for k, name in enumerate(header)}


def column(fields: list[str]) -> NDArray[Any]:
    """Numbers where all fields are, else texts."""
    try:
        return np.array([float(field) for field in fields])
    except ValueError:
        return np.array(fields)


def program(words: Sequence[str], folder: Path, watch: Callable[[], object] | None = None) -> str:
    """Runs a command in a process of its own in ``folder``, which Ctrl-C ends too, and gives what it prints; raises its
    message, as ``ValueError`` for what is not allowed and ``RuntimeError`` for what went wrong. ``watch`` is called about
    ten times a second and at the end."""
    started = [sys.executable, "-m", "shearbed", *words]
    pipe = subprocess.PIPE
    running = subprocess.Popen(started, cwd=folder, stdout=pipe, stderr=pipe, text=True, encoding="utf-8")
    try:
        while True:
            try:
                said, complained = running.communicate(timeout=None if watch is None else 0.1)
                break
            except subprocess.TimeoutExpired:
                if watch is not None:
                    watch()
        if watch is not None and not running.returncode:
            watch()
    except BaseException:
        # Nothing of it stays, not even its entry in the table of processes.
        running.kill()
        running.communicate()
        raise
    if running.returncode:
        message = complained.strip().removeprefix("error: ") or f"the program ended with {running.returncode}"
        raise (ValueError if running.returncode == 2 else RuntimeError)(message)
    return said
