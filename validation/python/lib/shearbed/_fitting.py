"""From measured points to a model's parameters."""

from __future__ import annotations

import html
import json
import os
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._results import typeset
from ._running import bar_of, columns as columns_of, complained, dictionary, keywords, number, options, program, workplace
from ._scene import Scene, dotted, scene_of, write_columns

Array = NDArray[np.float64]
SceneLike = Scene | Mapping[str, Any] | str | os.PathLike[str]
Points = Mapping[str, ArrayLike] | NDArray[Any] | str | os.PathLike[str]


@dataclass(frozen=True)
class Estimate:
    """A parameter as the points have it, in the unit of its key."""

    estimate: float
    low_68: float
    high_68: float
    low_95: float
    high_95: float
    standard_uncertainty: float
    range: tuple[float, float]
    """Where it was sought."""
    ends_at_edge: tuple[bool, bool]
    """Whether the 95 % interval ends at an edge of the range, below and above: the points do not say where it does."""


class Fit:
    """What a fit found: ``fit.json``, ``residuals.csv``, ``profiles.csv`` and ``samples.csv`` of ``shearbed fit``."""

    def __init__(self, folder: Path, words: str | None = None) -> None:
        self.record: dict[str, Any] = json.loads((folder / "fit.json").read_text(encoding="utf-8"))
        """All of ``fit.json``."""
        self.parameters: dict[str, Estimate] = {
            key: Estimate(**{**found, "range": tuple(found["range"]), "ends_at_edge": tuple(found["ends_at_edge"])})
            for key, found in self.record["parameters"].items()
        }
        self.chi2: float = self.record["chi2"]
        self.degrees_of_freedom: int = self.record["degrees_of_freedom"]
        self.p_value: float = self.record["p_value"]
        """The probability of a larger chi2 if the model were right."""
        self.order: list[str] = self.record["order"]
        """The parameters in the order of ``covariance`` and ``correlation``."""
        self.covariance: Array = np.array(self.record["covariance"], dtype=float)
        self.correlation: Array = np.array(self.record["correlation"], dtype=float)
        self.residuals: dict[str, NDArray[Any]] = columns_of(folder / "residuals.csv")
        """Each point beside the best model: set, time_unit, time, column, measured, simulated, residual, u."""
        profiles = columns_of(folder / "profiles.csv") if self.order else {}
        self.profiles: dict[str, tuple[Array, Array]] = {
            key: (profiles["value"][rows], profiles["rise_of_chi2"][rows])
            for key in self.order
            for rows in [profiles["parameter"] == key]
        }
        """Of each parameter: its values, and chi2 above its least there."""
        self.samples: dict[str, Array] = columns_of(folder / "samples.csv") if self.order else {}
        """Samples of the parameters, for corner plots."""
        self.extremes: list[dict[str, Array]] = _of_sets(folder, "extremes")
        """Of each set of points, the best model's maxima, minima and amplitudes, as ``Results.extremes``."""
        self.derived: list[dict[str, Array]] = _of_sets(folder, "derived")
        """Of each set of points, the best model's damping rates and steady values; errors are those of its replicas."""
        pictures = json.loads((folder / "figures.json").read_text(encoding="utf-8"))
        self._curves: list[dict[str, Any]] = [
            curve | {"measured": points, "y_name": picture["y_name"]}
            for name, picture in pictures
            if name.startswith("points")
            for curve, points in zip(picture["curves"], picture["points"])
        ]
        self.tests: list[dict[str, Any]] = self.record.get("tests", [])
        """What was asked by ``test=``: hypothesis, rise_of_chi2, p_value (at most that where beyond_the_box, and not below 1e-6), and of two keys their difference."""
        self.warnings: list[str] = [keywords(warning) for warning in self.record["warnings"]]
        """What to know before trusting it."""
        self.design: dict[str, NDArray[Any]] | None = columns_of(folder / "design.csv") if (folder / "design.csv").exists() else None
        """With ``design=True``: further points, and the uncertainties that each would leave."""
        self._words = repr(self) if words is None else words

    def __getitem__(self, key: str) -> Estimate:
        if dotted(key) not in self.parameters:
            raise KeyError(f"{key}: fitted are {', '.join(self.parameters) or 'no keys'}")
        return self.parameters[dotted(key)]

    def __str__(self) -> str:
        return self._words

    def __repr__(self) -> str:
        found = [f"{key} = {at.estimate:.4g} ± {at.standard_uncertainty:.2g}" for key, at in self.parameters.items()]
        return f"<Fit {', '.join([*found, f'χ² = {self.chi2:.4g}, {self.degrees_of_freedom} degrees of freedom'])}>"

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(str(self))}</pre>"

    def plot(self, ax: Any = None) -> Any:
        """Draws points with their uncertainties, the best model with its 95 % band, and on axes below their
        residuals. Returns the axes of the points; on given axes no residuals are drawn."""
        import matplotlib.pyplot as plt

        below = None
        if ax is None:
            _, (ax, below) = plt.subplots(2, 1, sharex=True, height_ratios=(3, 1), layout="constrained")
        found = self.residuals
        groups = sorted(set(zip(found["set"], found["column"])))
        for k, (set_, column) in enumerate(groups):
            curve = self._curves[k]
            symbol, fitted, _ = typeset(curve["label"]).partition(", best fit")
            rows = (found["set"] == set_) & (found["column"] == column)
            time, u = found["time"][rows], found["u"][rows]
            measured = curve["measured"]
            drawn = ax.errorbar(measured["x"], measured["y"], measured["y_error"], fmt="o", markersize=4, clip_on=False, label=typeset(measured["label"]))
            colour = drawn[0].get_color()
            if below is not None:
                below.errorbar(time, found["residual"][rows], u, fmt="o", markersize=4, clip_on=False, color=colour)
            x, y, half = (np.array(curve[name], dtype=float) for name in ("x", "y", "half_band"))
            ax.plot(x, y, color=colour, label=f"{symbol}{fitted or ', model'}")
            for axes, middle in ((ax, y), (below, 0 * y)):
                if axes is not None:
                    axes.fill_between(x, middle - half, middle + half, color=colour, alpha=0.2, linewidth=0, label=f"{symbol}, 95 %")
        ax.set_ylabel(", ".join(dict.fromkeys(typeset(curve["y_name"]) for curve in self._curves)))
        lowest = ax if below is None else below
        times = {"t_over_T": "t/T", "t_s": "t (s)", "strain": "strain Gt"}
        lowest.set_xlabel(", ".join(times[unit] for unit in sorted(set(found["time_unit"]))))
        if below is not None:
            below.axhline(0, color="0.5", linewidth=1)
            below.set_ylabel("residual")
        ax.legend()
        return ax


def _of_sets(folder: Path, stem: str) -> list[dict[str, Array]]:
    """The tables of that stem, one for each set of points."""
    found = sorted(folder.glob(f"{stem}_*.csv"), key=lambda path: int(path.stem.rsplit("_", 1)[1]))
    return [columns_of(path) for path in found or [folder / f"{stem}.csv"]]


def fit(
    scene: SceneLike,
    data: Points,
    over: Mapping[str, tuple[float, float]] | None = None,
    *,
    also: Sequence[tuple[SceneLike, Points]] = (),
    replicas: int | None = None,
    seed: int | None = None,
    rods: int | None = None,
    u: float | None = None,
    u_contains: str | None = None,
    columns: Sequence[str] | str | None = None,
    set: Mapping[str, Any] | None = None,
    design: bool = False,
    test: Sequence[str] = (),
    threads: int | None = None,
    checkpoint: str | os.PathLike[str] | None = None,
    out: str | os.PathLike[str] | None = None,
    progress: Callable[[int, int], object] | bool = False,
    yes: bool = False,
) -> Fit:
    """Fits keys of a scene to measured points, as ``shearbed fit`` does, with the same result.

    ``data`` is a CSV file or its columns: a time (``t_over_T``, ``t_s`` or ``strain``), and channels each with one standard
    deviation, as ``x1`` and ``x1_u``, or ``u`` for all points; ``u_contains`` is ``"reading"`` or ``"rods"``; NaN was not measured. Columns may be a dict, in which one number
    stands for every row,
    a DataFrame, or an array with named fields. ``columns=["t_s", "x1", "-"]`` names the columns of files that have other
    names, or none, and of an array with a row for each time. Without ``over`` nothing is fitted: how well the scene as it
    is describes the points. ``over={"interaction.alpha": (0.05, 5)}`` are up to three keys
    with the range to look in. ``also`` are other scenes with points of their own, fitted with the same parameters.
    A key may have a value of its own for each scene: ``over={"1:interaction.alpha": ..., "2:interaction.alpha": ...}``.
    ``set={"particles.count": 50}`` gives a key of every scene another value. ``replicas`` is the most at each value,
    ``rods`` how many each point is a mean over. ``design=True`` lists further points, with what each would leave of the
    uncertainties, in ``design``. ``test=["interaction.alpha=1"]`` tests values of fitted keys, and
    ``test=["1:interaction.alpha=2:interaction.alpha"]`` whether two scenes have the same: see ``tests``. ``checkpoint``
    is a file that keeps the runs: the same call goes on with them. ``out`` is a folder for all that the program writes, which
    :func:`load` reads: tables, pictures, ``fit.json``. ``progress(done, of)`` counts the runs, of those
    that are known to be needed by then; ``progress=True`` draws a bar, with tqdm where it is installed. Work of over a day
    begins with ``yes=True`` alone.

    The work is done in a process of its own: other Python threads go on meanwhile, and Ctrl-C ends it. Raises ``ValueError``
    with the program's words for what is not allowed, ``RuntimeError`` for a fit that cannot go on.
    """
    with workplace(out) as (folder, kept):
        words = ["fit", "scene.toml", "--out", str(kept)] + ["--yes"] * yes
        for k, (of, points) in enumerate([(scene, data), *also]):
            name = "scene.toml" if k == 0 else f"scene-{k + 1}.toml"
            scene_of(of)._written(folder, name)
            if isinstance(points, np.ndarray) and points.dtype.names is None and columns is None:
                raise ValueError('data: an array whose columns have no names needs them: columns=["t_s", "x1", "x1_u"]')
            file = _file(points, folder / f"points-{k + 1}.csv")
            words += ["--data", file if k == 0 else f"{name}={file}"]
        for key, ends in dictionary("over", over or {}, '{"interaction.alpha": (0.05, 5)}').items():
            if not isinstance(ends, Sequence) or len(ends) != 2:
                raise ValueError(f"over: {key} = {ends!r}: a range (from, to) is allowed")
            low, high = (number(f"over: {key}", end) for end in ends)
            words += ["--over", f"{key}={low}:{high}"]
        words += options(replicas=replicas, seed=seed, rods=rods, threads=threads, set=set)
        words += [] if u_contains is None else ["--u-contains", u_contains]
        words += [] if u is None else ["--u", number("u", u)]
        words += [] if columns is None else ["--columns", columns if isinstance(columns, str) else ",".join(columns)]
        words += ["--design"] if design else []
        words += [word for held in ([test] if isinstance(test, str) else test) for word in ("--test", held)]
        words += [] if checkpoint is None else ["--checkpoint", os.path.abspath(checkpoint)]
        show = bar_of("run") if progress is True else progress or None
        words += ["--log-every", "0.1"] if show else []

        def watch() -> None:
            found = [re.fullmatch(r"progress: .*: (\d+) of (\d+) runs", line) for line in complained(folder)]
            counts = [(int(match[1]), int(match[2])) for match in found if match]
            if show and counts:
                show(*counts[-1])

        try:
            said = program(words, folder, watch if show else None)
        except (ValueError, RuntimeError) as error:
            # The caller has columns, not these files.
            named = lambda file: "data" if file[1] == "1" else f"data of also[{int(file[1]) - 2}]"
            raise type(error)(re.sub(r"(?<![\w/.-])points-(\d+)\.csv", named, str(error))) from None
        if said.startswith("goes on from"):
            said = said.split("\n", 1)[1]
        # The last line names a folder that may be no more.
        return Fit(kept, said.rsplit(f"\nin {kept}", 1)[0])


def _file(points: Points, place: Path) -> str:
    """The name of a CSV file of points, which is written if they are columns."""
    if isinstance(points, np.ndarray):
        names = points.dtype.names
        if names is None:
            # Rows as in a file without a header, which ``columns`` names.
            np.savetxt(place, points, delimiter=",")
            return place.name
        points = {name: points[name] for name in names}
    if isinstance(points, (str, os.PathLike)):
        return os.path.abspath(points)
    write_columns(points, place, "data")
    return place.name
