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
    told = _bar() if progress is True else progress or None
    return Results(_core.run(scene._name, scene._text, replicas, seed, threads, told))


def _bar() -> Callable[[int, int], object] | None:
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return None
    bar = tqdm(unit="replica")

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
    replicas: int | None = None,
    seed: int | None = None,
) -> dict[str, NDArray[Any]]:
    """Runs a scene at every combination of its keys' values, as ``shearbed sweep`` does.

    ``sweep(scene, {"interaction.alpha": [0.25, 0.5, 1]})`` gives the columns of ``sweep.csv``, one row a point: the swept
    keys, then time, means and standard errors at the last output. All points have the same seed.
    """
    scene = scene_of(scene)
    with tempfile.TemporaryDirectory(prefix="shearbed-") as folder:
        file = scene._written(Path(folder))
        words = ["sweep", str(file), "--out", str(Path(folder, "out")), "--quiet"]
        for key, values in over.items():
            words += ["--over", f"{key}=" + ",".join(_value(value) for value in values)]
        for flag, value in (("--replicas", replicas), ("--seed", seed)):
            if value is not None:
                words += [flag, str(value)]
        program(words)
        with open(Path(folder, "out", "sweep.csv"), encoding="utf-8", newline="") as text:
            header, *rows = list(csv.reader(text))
    return {name: column([row[k] for row in rows]) for k, name in enumerate(header)}


def column(fields: list[str]) -> NDArray[Any]:
    """Numbers where all fields are, else texts."""
    try:
        return np.array([float(field) for field in fields])
    except ValueError:
        return np.array(fields)


def program(words: Sequence[str], cwd: Path | None = None) -> str:
    """Runs a command in a process of its own, which Ctrl-C ends too, and gives what it prints; raises its message, as
    ``ValueError`` for what is not allowed and ``RuntimeError`` for what went wrong."""
    started = [sys.executable, "-m", "shearbed", *words]
    pipe = subprocess.PIPE
    running = subprocess.Popen(started, cwd=cwd, stdout=pipe, stderr=pipe, text=True, encoding="utf-8")
    try:
        said, complained = running.communicate()
    except BaseException:
        # Nothing of it stays, not even its entry in the table of processes.
        running.kill()
        running.communicate()
        raise
    if running.returncode:
        message = complained.strip().removeprefix("error: ") or f"the program ended with {running.returncode}"
        raise (ValueError if running.returncode == 2 else RuntimeError)(message)
    return said
