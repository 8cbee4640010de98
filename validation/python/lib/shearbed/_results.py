"""The results of a run."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import pandas
    import xarray

Array = NDArray[np.float64]

_PAIRS = (("a11", 0, 0), ("a22", 1, 1), ("a33", 2, 2), ("a12", 0, 1), ("a13", 0, 2), ("a23", 1, 2))


def typeset(symbol: str) -> str:
    """A symbol such as ``a_12`` for matplotlib."""
    return re.sub(r"\b(\w)_(\w+)", r"$\1_{\\mathrm{\2}}$", symbol)


class Results:
    """Means over rods and replicas against time.

    ``x1`` is the mean of channel ``x1`` and ``x1_se`` its standard error, one number an output; so for every channel in
    ``channels``. Standard errors are over replicas, over rods where there is one replica.
    """

    def __init__(self, found: dict[str, Any]) -> None:
        self.t: Array = found["times"]
        """The outputs' times: t/T, or strain where the scene's time is a strain (see ``time_name``)."""
        self.time_name: str = found["time_name"]
        self.time_s: Array = found["time_s"]
        self.strain: Array = found["strain"]
        self.observables: dict[str, list[str]] = found["observables"]
        """The channels of each observable."""
        self.labels: dict[str, str] = found["labels"]
        """What each observable is called on an axis, with its unit."""
        self.symbols: dict[str, str] = found["symbols"]
        """The symbol of each channel, with its unit in parentheses."""
        self.seed: int = found["seed"]
        self.replicas: int = found["replicas"]
        self.scene: str = found["scene"]
        """The scene that was run, as TOML."""
        self.warnings: list[str] = found["warnings"]
        self.extremes: dict[str, Array] = found["extremes"]
        """The columns of ``extremes.csv``: maxima, minima and amplitudes of each channel, NaN where undefined."""
        self.derived: dict[str, float] = {name: float(column[0]) for name, column in found["derived"].items()}
        """``x1_damping_rate``, ``x1_steady``, … with ``_se``: the columns of ``derived.csv``, NaN where undefined."""
        self._rods: dict[str, Array] | None = found["rods"]
        self._channels: dict[str, tuple[Array, Array]] = found["channels"]

    @property
    def channels(self) -> list[str]:
        """The names of the channels."""
        return list(self._channels)

    def __getattr__(self, name: str) -> Array:
        channels = self.__dict__.get("_channels", {})
        if name in channels:
            mean: Array = channels[name][0]
            return mean
        if name.endswith("_se") and name[:-3] in channels:
            se: Array = channels[name[:-3]][1]
            return se
        if name in ("a", "a_se"):
            raise AttributeError(f'{name}: the scene has to ask for it: observables = ["orientation_tensor"]')
        if name == "rods":
            raise AttributeError("rods: the scene has to ask for them: rods_at = [0, 0.5, 1]")
        raise AttributeError(f"{name}: this run has the channels {', '.join(channels)}, each also with _se")

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._channels, *(f"{name}_se" for name in self._channels)]

    @property
    def a(self) -> Array:
        """<pp> as (time, 3, 3); needs the observable ``orientation_tensor``."""
        return self._tensor(0)

    @property
    def a_se(self) -> Array:
        """The standard errors of <pp> as (time, 3, 3)."""
        return self._tensor(1)

    def _tensor(self, which: int) -> Array:
        if "a11" not in self._channels:
            raise AttributeError  # __getattr__ says why
        tensor = np.empty((len(self.t), 3, 3))
        for name, i, j in _PAIRS:
            tensor[:, i, j] = tensor[:, j, i] = self._channels[name][which]
        return tensor

    @property
    def rods(self) -> dict[str, Array]:
        """Every rod at the times of ``rods_at``: the columns of ``rods.csv``, a number for each rod of each replica and time.

        ``replica``, ``rod``, ``time_s``, ``strain``, ``aspect_ratio``, ``length_mm``, the place ``x1_mm`` to ``x3_mm`` (NaN for free rods,
        which have none), the direction ``p1`` to ``p3``, and ``collided``, 1 where the rod collided in the step that ended then.
        """
        if self._rods is None:
            raise AttributeError  # __getattr__ says why
        return self._rods

    def to_pandas(self) -> pandas.DataFrame:
        """The columns of the program's CSV files in one table."""
        import pandas

        columns: dict[str, Array] = {self.time_name: self.t, "time_s": self.time_s, "strain": self.strain}
        for name, (mean, se) in self._channels.items():
            columns[name] = mean
            columns[f"{name}_se"] = se
        return pandas.DataFrame(columns)

    def to_xarray(self) -> xarray.Dataset:
        """The channels and their standard errors over the time as an ``xarray.Dataset``; units, seed, number of replicas and
        the scene stand in its attributes."""
        import xarray

        label_of = {name: self.labels[observable] for observable, names in self.observables.items() for name in names}
        variables: dict[str, Any] = {}
        for name, (mean, se) in self._channels.items():
            # A symbol ends with its unit, as in "φ̄ (rad)".
            unit = {"units": found[1] if (found := re.search(r" \((\w+)\)$", self.symbols[name])) else "1"}
            variables[name] = (self.time_name, mean, {"long_name": f"{name}: {label_of[name]}", **unit})
            variables[f"{name}_se"] = (self.time_name, se, {"long_name": f"standard error of {name}", **unit})
        coordinates = {
            "time_s": (self.time_name, self.time_s, {"units": "s"}),
            "strain": (self.time_name, self.strain, {"units": "1"}),
        }
        coordinates[self.time_name] = (self.time_name, self.t, {"units": "1", "long_name": self._time_label})
        attributes = {"seed": self.seed, "replicas": self.replicas, "scene": self.scene}
        return xarray.Dataset(variables, coordinates, attributes)

    @property
    def _time_label(self) -> str:
        return "t/T" if self.time_name == "t_over_T" else self.time_name.replace("_", " ")

    def plot(self, *channels: str, ax: Any = None, label: str | None = None) -> Any:
        """Draws channels (by default those of the first observable) with bands of 95 %, and returns the axes; ``label`` stands
        before their symbols in the legend, as where two runs share axes."""
        import matplotlib.pyplot as plt

        if ax is None:
            _, ax = plt.subplots()
        if len(channels) == 1 and isinstance(channels[0], (list, tuple)):
            channels = tuple(channels[0])
        drawn = list(channels) or next(iter(self.observables.values()))
        for name in drawn:
            if name not in self._channels:
                raise AttributeError(f"{name}: this run has the channels {', '.join(self._channels)}")
            mean, se = self._channels[name]
            (line,) = ax.plot(self.t, mean, label=f"{label + ', ' if label else ''}{typeset(self.symbols[name])}")
            ax.fill_between(self.t, mean - 1.96 * se, mean + 1.96 * se, color=line.get_color(), alpha=0.2, linewidth=0)
        ax.set_xlabel(self._time_label)
        shown = [name for of, name in self.labels.items() if set(drawn) & set(self.observables[of])]
        ax.set_ylabel(shown[0] if len(shown) == 1 else ", ".join(typeset(self.symbols[name]) for name in drawn))
        ax.legend()
        return ax

    def __repr__(self) -> str:
        return f"Results({len(self.t)} outputs of {', '.join(self._channels)})"
