"""Running scenes."""

from __future__ import annotations

import csv
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._results import Results
from ._scene import Scene, _toml, _value, dotted, scene_of

OF_RODS = "rods*.[pv][vt][dp]"
"""ParaView's files of rods."""

DERIVED = ("extremes", "derived")
"""The tables of what is derived from a run's means."""


def run(
    scene: Scene | Mapping[str, Any] | str | os.PathLike[str],
    *,
    set: Mapping[str, Any] | None = None,
    replicas: int | None = None,
    seed: int | None = None,
    threads: int | None = None,
    progress: Callable[[int, int], object] | bool = False,
    until_se: Mapping[str, float] | None = None,
    time_limit_s: float | None = None,
    checkpoint: str | os.PathLike[str] | None = None,
    vtk: str | os.PathLike[str] | None = None,
    out: str | os.PathLike[str] | None = None,
    yes: bool = False,
) -> Results:
    """Runs a scene: the same bits as the program, on any number of threads.

    ``set={"alpha": 0.3}`` gives keys of the scene another value, as :meth:`Scene.replace`; ``replicas`` and ``seed`` stand in
    place of the scene's own. ``progress(done, of)`` is called about twenty times a second; ``progress=True`` draws a bar with
    tqdm where it is installed. Other Python threads go on meanwhile, and Ctrl-C stops it.

    ``until_se={"x1": 0.001}`` adds replicas until the standard error of each of these channels is at most that; with
    ``time_limit_s`` none begins after that time, and a Python warning says what was reached. ``checkpoint`` is a file that keeps
    the run, and from which the same call goes on. ``vtk`` is a folder for ParaView's files of the rods at the times of
    ``rods_at``. ``out`` is a folder for all that the program writes, which :func:`load` reads: tables, pictures, ``run.json``. All
    four work in a process of its own, without ``progress``. Work of over a day begins with ``yes=True`` alone.

    What the reader of the results should know, ``scene.warnings``, comes as Python warnings too.

    Raises :class:`SceneError` for a scene that cannot be run, ``RuntimeError`` for a run that cannot go on.
    """
    scene = scene_of(scene).replace(**set) if set else scene_of(scene)
    if threads is not None and threads < 1:
        raise ValueError(f"threads = {threads}: a whole number from 1 to 1024 is allowed")
    if until_se or any(given is not None for given in (checkpoint, vtk, out)):
        if progress:
            raise TypeError("progress: runs with until_se, checkpoint, vtk or out do not tell how far they are")
        asked = dictionary("until_se", until_se or {}, '{"x1": 0.001}').items()
        words = [word for channel, se in asked for word in ("--until-se", f"{channel}={number(f'until_se: {channel}', se)}")]
        words += [] if time_limit_s is None else ["--time-limit", f"{time_limit_s}s"]
        words += [] if checkpoint is None else ["--checkpoint", os.path.abspath(checkpoint)]
        words += [] if vtk is None else ["--vtk"]
        words += ["--yes"] if yes else []
        return _apart(scene, words + options(replicas=replicas, seed=seed, threads=threads), vtk, out)
    if time_limit_s is not None:
        raise TypeError("time_limit_s: it goes with until_se")
    show = bar_of("replica") if progress is True else progress or None
    found = _core.run(scene._name, scene._text, replicas, seed, threads, show, yes)
    for warning in scene.warnings:
        warnings.warn(warning, stacklevel=2)
    return Results(found | {name: table(found[name].splitlines()) for name in DERIVED})


@contextmanager
def workplace(out: str | os.PathLike[str] | None) -> Iterator[tuple[Path, Path]]:
    """A folder to work in, which goes, and one for results: ``out``, which stays, or one within the first."""
    if out is not None and not os.fspath(out):
        raise ValueError('out = "": the name of a folder is allowed')
    with tempfile.TemporaryDirectory(prefix="shearbed-") as made:
        yield Path(made), Path(made) / "out" if out is None else Path(os.getcwd()) / out


def _record(folder: Path) -> bytes | None:
    file = folder / "run.json"
    return file.read_bytes() if file.exists() else None


def _apart(
    scene: Scene,
    words: Sequence[str],
    vtk: str | os.PathLike[str] | None,
    out: str | os.PathLike[str] | None,
) -> Results:
    """Runs a scene in a process of its own."""
    there = next(Path(vtk).glob(OF_RODS), None) if vtk is not None else None
    if there is not None:
        raise FileExistsError(f"vtk: {there} is there already; a folder without files of rods is allowed")
    with workplace(out) as (folder, kept):
        earlier = _record(kept)
        try:
            program(["run", scene._written(folder).name, "--out", str(kept), *words], folder)
        except RuntimeError as error:
            # Less than was asked for, if there are new results.
            if _record(kept) == earlier:
                raise
            warnings.warn(str(error), stacklevel=3)
        if vtk is not None:
            os.makedirs(vtk, exist_ok=True)
            for file in kept.glob(OF_RODS):
                shutil.copyfile(file, Path(vtk) / file.name)
        return results(kept)


def results(folder: Path) -> Results:
    """The results in a folder of ``shearbed run``."""
    record = json.loads((folder / "run.json").read_text(encoding="utf-8"))
    known = {name: (label, symbols) for name, label, symbols in _core.observables()}
    found: dict[str, Any] = {"channels": {}, "observables": {}, "labels": {}, "symbols": {}, "rods": None}
    for name, (label, symbols) in known.items():
        if not (folder / f"{name}.csv").exists():
            continue
        table = columns(folder / f"{name}.csv")
        times, means = list(table)[:3], [column for column in table if f"{column}_se" in table]
        found["channels"] |= {column: (table[column], table[f"{column}_se"]) for column in means}
        found["observables"][name] = means
        found["labels"][name] = label
        found["symbols"] |= dict(symbols)
        found |= {"time_name": times[0], "times": table[times[0]], "time_s": table["time_s"], "strain": table["strain"]}
    files = {name: folder / f"{name}.csv" for name in DERIVED}
    found |= {name: columns(file) if file.exists() else {} for name, file in files.items()}
    if (folder / "rods.csv").exists():
        found["rods"] = columns(folder / "rods.csv")
    ensemble = record["scene"]["ensemble"]
    found |= {"seed": ensemble["seed"], "replicas": ensemble["replicas"], "warnings": record["warnings"]}
    return Results(found | {"scene": _toml(record["scene"])})


def bar_of(unit: str) -> Callable[[int, int], object] | None:
    """A bar of tqdm, which begins again where less is done than before and closes when it is dropped; without tqdm a line
    on standard error."""
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return lambda done, of: print(f"\r{done} of {of} {unit}s", end="\n" if done == of else "", file=sys.stderr, flush=True)
    bar = tqdm(unit=unit)

    def show(done: int, of: int) -> None:
        if done < bar.n:
            bar.reset()
        bar.total = of
        bar.update(done - bar.n)

    return show


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
    xarray: bool = False,
    out: str | os.PathLike[str] | None = None,
    yes: bool = False,
) -> Any:
    """Runs a scene at every combination of its keys' values, as ``shearbed sweep`` does.

    ``sweep(scene, {"interaction.alpha": [0.25, 0.5, 1]})`` gives the columns of ``sweep.csv``, one row a point: the swept
    keys, then time, means and standard errors at the last output, damping rates and steady values; with ``times="all"``
    one row for each output of each point, and with ``times="extremes"`` the columns of ``extremes.csv``: maxima, minima and
    amplitudes of each point. All points have the same seed. ``set={"particles.count": 50}`` gives keys of the scene another value.
    ``progress(done, of)`` counts points; ``progress=True`` draws a bar, with tqdm where it is installed. ``xarray=True`` gives an
    ``xarray.Dataset`` in place of the columns: one dimension for each swept key, and with ``times="all"`` ``output``, with the
    times as its coordinate where all points have the same. ``out`` is a folder for all that the program writes, which :func:`load`
    reads, and from which the same call goes on. Work of over a day begins with ``yes=True`` alone.
    """
    if times not in ("last", "all", "extremes") or (times == "extremes" and xarray):
        raise ValueError(f"times = {times!r}: 'last', 'all', and without xarray 'extremes', are allowed")
    for key, values in dictionary("over", over, '{"interaction.alpha": [0.25, 0.5, 1]}').items():
        if isinstance(values, str) or not isinstance(values, Iterable):
            raise ValueError(f"over: {key} = {values!r}: a list of values is allowed, as [{values!r}]")
    if not over:
        raise ValueError('over: no key has values; {"interaction.alpha": [0.25, 0.5, 1]} is allowed')
    scene = scene_of(scene)
    over = {dotted(key): values for key, values in over.items()}
    with workplace(out) as (folder, kept):
        words = ["sweep", scene._written(folder).name, "--out", str(kept), "--quiet"] + ["--yes"] * yes
        for key, values in over.items():
            words += ["--over", f"{key}=" + ",".join(_value(value) for value in values)]
        words += options(replicas=replicas, seed=seed, threads=threads, set=set)
        points = int(np.prod([len(values) for values in over.values()]))
        show = bar_of("point") if progress is True else progress or None

        def watch() -> None:
            if show:
                show(len(list(kept.glob("points/*/shearbed.json"))), points)

        program(words, folder, watch if show else None)
        swept = columns(kept / "sweep.csv")
        if times == "extremes":
            return columns(kept / "extremes.csv")
        if times == "last":
            return _dataset(swept, over) if xarray else swept
        of_points = [tables(point) for point in sorted((kept / "points").iterdir())]
    rows = [len(next(iter(table.values()))) for table in of_points]
    keys = {name: np.repeat(values, rows) for name, values in swept.items() if name in over}
    found = keys | {name: np.concatenate([table[name] for table in of_points]) for name in of_points[0]}
    return _dataset(found, over) if xarray else found


def converge(
    scene: Scene | Mapping[str, Any] | str | os.PathLike[str],
    *,
    replicas: int | None = None,
    set: Mapping[str, Any] | None = None,
    threads: int | None = None,
    out: str | os.PathLike[str] | None = None,
    yes: bool = False,
) -> dict[str, NDArray[Any]]:
    """How the means depend on the time step: the columns of ``converge.csv``, as ``shearbed converge`` writes them. Of free
    rods a row for each integrator and step; of interacting ones ``x1`` against steps, then against rods.

    ``replicas`` is the number of runs of each row, ``out`` a folder for all that the program writes, which :func:`load` reads. Work
    of over a day begins with ``yes=True`` alone. Raises ``RuntimeError`` if an integrator has another order than theory says.
    """
    with workplace(out) as (folder, kept):
        words = ["converge", scene_of(scene)._written(folder).name, "--out", str(kept)] + ["--yes"] * yes
        program(words + options(replicas=replicas, threads=threads, set=set), folder)
        return columns(kept / "converge.csv")


def _dataset(table: Mapping[str, NDArray[Any]], over: Mapping[str, Sequence[Any]]) -> Any:
    """Columns of a sweep over its keys' values; rows of one point are further outputs."""
    import xarray

    shape = [len(values) for values in over.values()]
    rows = len(next(iter(table.values())))
    outputs = rows // int(np.prod(shape))
    if outputs * int(np.prod(shape)) != rows:
        raise ValueError("xarray: the points of this sweep have different numbers of outputs")
    dims = [*over, "output"] if outputs > 1 else list(over)
    shape += [outputs] if outputs > 1 else []
    variables = {name: (dims, values.reshape(shape)) for name, values in table.items() if name not in over}
    coordinates: dict[str, Any] = {key: list(values) for key, values in over.items()}
    # The first column after the keys is a time.
    times = next(iter(variables.values()))[1].reshape(-1, outputs)
    if outputs > 1 and (times == times[0]).all():
        coordinates["output"] = times[0]
    return xarray.Dataset(variables, coordinates)


def tables(point: Path) -> dict[str, NDArray[Any]]:
    """The columns of a point's tables of means, side by side, in the order of the columns of ``sweep.csv``."""
    tables: dict[str, NDArray[Any]] = {}
    for file in sorted(point.glob("*.csv")):
        if file.stem not in DERIVED:
            tables |= columns(file)
    return tables


def options(*, set: Mapping[str, Any] | None = None, **numbers: int | None) -> list[str]:
    """Words of the command line for what is given."""
    words = [word for key, value in (set or {}).items() for word in ("--set", f"{key}={_value(value)}")]
    for flag, value in numbers.items():
        if value is not None:
            words += [f"--{flag}", str(value)]
    return words


def dictionary(name: str, value: Any, example: str) -> Mapping[str, Any]:
    """The argument ``name`` if it is a dictionary."""
    if not isinstance(value, Mapping):
        raise TypeError(f"{name} = {value!r}: a dictionary is allowed, as {example}")
    return value


def number(name: str, value: Any) -> str:
    """The argument ``name`` as text if it is a number."""
    try:
        return repr(float(value))
    except (TypeError, ValueError):
        raise TypeError(f"{name} = {value!r}: a number is allowed") from None


def columns(file: Path) -> dict[str, NDArray[Any]]:
    """The columns of a CSV file; a blank among numbers is NaN."""
    with open(file, encoding="utf-8", newline="") as lines:
        return table(lines)


def table(lines: Iterable[str]) -> dict[str, NDArray[Any]]:
    """The columns of the lines of a CSV file."""
    header, *rows = list(csv.reader(lines))
    return {name: column([row[k] for row in rows]) for k, name in enumerate(header)}


def column(fields: list[str]) -> NDArray[Any]:
    """Numbers where all fields are, else texts."""
    try:
        return np.array([float(field or "nan") for field in fields])
    except ValueError:
        return np.array(fields)


COMPLAINED = ".complained"
"""The file of what a program writes to standard error."""


def complained(folder: Path) -> list[str]:
    """The lines that the program in ``folder`` has written to standard error so far."""
    return (folder / COMPLAINED).read_text(encoding="utf-8", errors="replace").splitlines()


def program(words: Sequence[str], folder: Path, watch: Callable[[], object] | None = None) -> str:
    """Runs a command in a process of its own in ``folder``, which Ctrl-C ends too, and gives what it prints; raises its
    message, as ``ValueError`` for what is not allowed and ``RuntimeError`` for what went wrong. ``watch`` is called about
    ten times a second and at the end."""
    started = [sys.executable, "-m", "shearbed", *words]
    # A file, which ``watch`` can read meanwhile.
    with open(folder / COMPLAINED, "wb") as errors:
        # It ends with this process, where the system can do that.
        ours = os.environ | {"SHEARBED_PARENT": str(os.getpid())}
        running = subprocess.Popen(
            started, cwd=folder, env=ours, stdout=subprocess.PIPE, stderr=errors, text=True, encoding="utf-8"
        )
    try:
        while True:
            try:
                said, _ = running.communicate(timeout=None if watch is None else 0.1)
                break
            except subprocess.TimeoutExpired:
                if watch is not None:
                    watch()
        if watch is not None and not running.returncode:
            watch()
    except BaseException:
        # It may write a last checkpoint. Nothing of it stays, not even its entry in the table of processes.
        running.terminate()
        try:
            running.communicate(timeout=10)
        except BaseException:
            running.kill()
            running.communicate()
        raise
    if running.returncode:
        lines = [line for line in complained(folder) if not line.startswith("progress: ")]
        first = next((k for k, line in enumerate(lines) if line.startswith("error: ")), 0)
        message = "\n".join(lines[first:]).strip().removeprefix("error: ") or f"the program ended with {running.returncode}"
        raise (ValueError if running.returncode == 2 else RuntimeError)(keywords(message))
    for line in complained(folder):
        if line.startswith("warning: "):
            warnings.warn(keywords(line.removeprefix("warning: ")), stacklevel=3)
    for line in said.splitlines():
        if line.startswith("(replaced earlier results of "):
            warnings.warn(line.strip("()"), stacklevel=3)
    return said


def keywords(message: str) -> str:
    """The program's words with keywords for flags, which are called alike; a name of a file may hold two dashes too."""
    message = re.split(r"\n\n(?:Usage:|For more information, try)", message)[0]
    # There is no keyword to overwrite files.
    message = re.sub(r"--force overwrites it, |,? (?:or start over )?with --force", "", message)
    missing = message.removeprefix("the following required arguments were not provided:\n")
    if missing != message:
        message = "missing: " + ", ".join(line.split(" <")[0].strip() for line in missing.splitlines())
    message = re.sub(r"invalid value '([^']*)' for '--([a-z-]+)[^']*'", r"--\2 = \1", message)
    message = re.sub(r"\n +\[possible values: (.*)\]", r": \1 are allowed", message)
    message = re.sub(r"--u-contains (reading|rods)", r'u_contains="\1"', message)
    message = re.sub(r"--([a-z]+) ([A-Z])\b", r"\1=\2", message)
    return re.sub(r"(?<![\w.-])--([a-z]+(?:-[a-z]+)*)", lambda flag: flag[1].replace("-", "_"), message)
