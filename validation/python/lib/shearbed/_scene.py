"""A scene from keywords, a dictionary, TOML or a file."""

from __future__ import annotations

import csv
import difflib
import html
import inspect
import json
import os
import shutil
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from . import _core
from ._core import SceneError

# Which table of a scene file holds a key: keywords are given without it.
_TABLE_OF = {name: table for table, name, *_ in _core.keys()}

_KNOWN = {"title", *_TABLE_OF, *_TABLE_OF.values()}


def _unknown_key(key: str) -> str:
    close = difflib.get_close_matches(key, _TABLE_OF)
    return f"{key}: unknown key; {'did you mean ' + close[0] if close else 'allowed are ' + ', '.join(_TABLE_OF)}"


def dotted(key: str) -> str:
    """A key with its table, as ``interaction.alpha``; one that has none stays."""
    return f"{_TABLE_OF[key]}.{key}" if key in _TABLE_OF else key


_BUILT_IN = dict(_core.built_in_scenes())


def scenes() -> list[str]:
    """The names of the built-in scenes, as ``shearbed scenes`` lists them: the parameters of the paper's figures."""
    return list(_BUILT_IN)


def _value(value: Any) -> str:
    """A value as TOML."""
    if hasattr(value, "tolist"):  # NumPy's arrays and numbers
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value)
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(key)} = {_value(item)}" for key, item in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(_value, value)) + "]"
    raise TypeError(f"{value!r}: a number, text, list or dictionary is allowed in a scene")


def _key(key: Any) -> str:
    """A key as TOML, of whatever letters it has."""
    text = str(key)
    plain = text.isascii() and text.replace("_", "").replace("-", "").isalnum()
    return text if plain else json.dumps(text)


def _toml(tables: Mapping[str, Any]) -> str:
    lines = [f"{_key(key)} = {_value(value)}" for key, value in tables.items() if not isinstance(value, Mapping)]
    for key, table in tables.items():
        if isinstance(table, Mapping):
            lines.append(f"[{_key(key)}]")
            lines += [f"{_key(inner)} = {_value(value)}" for inner, value in table.items()]
    return "\n".join(lines) + "\n"


def _gathered(keywords: Mapping[str, Any]) -> dict[str, Any]:
    """Keywords in their tables; tables and unknown keys stay, so that an error names them."""
    tables: dict[str, Any] = {"title": "scene"}
    for key, value in keywords.items():
        table = _TABLE_OF.get(key)
        if table is None:
            tables[key] = dict(value) if isinstance(value, Mapping) else value
        else:
            tables.setdefault(table, {})[key] = value
    return tables


def _keywords() -> str:
    """The keys of a scene for ``help(Scene)``: what each means, its unit, what is allowed, its default."""
    lines: list[str] = []
    last = None
    for table, name, meaning, unit, allowed, absent in _core.keys():
        if table != last:
            lines.append(f"\n    Keys of [{table}]:\n")
            last = table
        of = f", in {unit}" if unit else ""
        lines.append(f"    {name}\n        {meaning}{of}; {allowed} (default: {absent})")
    return "\n".join(lines).replace("(default: required)", "(required)")


class Scene:
    """What is simulated, checked. Keys and units are those of a scene file.

    ``Scene(shear_rate_per_s=0.5, count=100, length_mm=0.72, aspect_ratio=11.6, orientation="isotropic", periods=2)``,
    ``Scene({"flow": {...}, "particles": {...}, ...})``, ``Scene(toml="...")``, ``Scene(file="mine.toml")`` or
    ``Scene(built_in="fig4-n50")`` (:func:`scenes` lists the names).

    Raises :class:`SceneError` where the scene is not allowed: every problem at once, with key, value and what is allowed.
    """

    def __init__(
        self,
        tables: Mapping[str, Any] | None = None,
        /,
        *,
        toml: str | None = None,
        file: str | os.PathLike[str] | None = None,
        built_in: str | None = None,
        **keywords: Any,
    ) -> None:
        keywords = {key: value for key, value in keywords.items() if value is not None}
        given = [way for way in (tables, toml, file, built_in, keywords or None) if way is not None]
        if len(given) != 1:
            raise TypeError("Scene: one of keywords, a dictionary, toml=, file= and built_in= is allowed")
        self._name = "scene"
        self._made: list[Any] = []
        if built_in is not None:
            if built_in not in _BUILT_IN:
                raise ValueError(_unknown(built_in))
            self._name, self._text = f"{built_in}.toml", _BUILT_IN[built_in]
        elif file is not None:
            self._name = os.fspath(file)
            with open(file, encoding="utf-8") as text:
                self._text = text.read()
        elif toml is not None:
            self._text = toml
        else:
            unknown = [key for key, value in keywords.items() if key not in _KNOWN and not isinstance(value, Mapping)]
            if unknown:
                raise SceneError(_unknown_key(unknown[0]))
            gathered = _gathered(keywords if tables is None else tables)
            particles = gathered.get("particles")
            if isinstance(particles, dict) and "rods" in particles:
                particles["rods"] = self._rods_file(particles["rods"])
            self._text = _toml(gathered)
        self._describe()

    def _rods_file(self, rods: Any) -> Any:
        """``{"file": ...}`` as it is; else a file, which lives as long as the scene, of a DataFrame's or a dictionary's
        columns, or of an array with a direction in each row."""
        if isinstance(rods, Mapping) and "file" in rods:
            return rods
        if isinstance(rods, (str, os.PathLike)):
            raise ValueError(f'rods = {rods!r}: {{"file": {os.fspath(rods)!r}}} is allowed, columns, or an array of (rods, 3)')
        if not isinstance(rods, Mapping) and not hasattr(rods, "columns"):
            array = np.asarray(rods)
            names = array.dtype.names
            if names is None and (array.ndim != 2 or array.shape[1] != 3):
                raise ValueError(f"rods: an array of {array.shape}: one of (rods, 3), a direction in each row, is allowed")
            rods = dict(zip(("p1", "p2", "p3"), array.T)) if names is None else {name: array[name] for name in names}
        made = tempfile.TemporaryDirectory(prefix="shearbed-")
        self._made.append(made)
        file = Path(made.name) / "rods.csv"
        write_columns(rods, file, "rods")
        return {"file": str(file)}

    def _written(self, folder: Path, name: str | None = None) -> Path:
        """The scene as a file in ``folder``, called as its own in messages, with the one that its rods start from beside it."""
        file = folder / (name or f"{Path(self._name).stem}.toml")
        file.write_text(self._text, encoding="utf-8")
        if self._start is not None and not os.path.isabs(self._start):
            (folder / self._start).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(Path(self._name).parent / self._start, folder / self._start)
        return file

    @property
    def toml(self) -> str:
        """The scene file, with every default written out."""
        return self._resolved

    @property
    def plan(self) -> str:
        """What a run does, what it leaves out, and why; T, n a³ and what it costs. ``warnings`` are apart."""
        stages = [line for line in self._plan.splitlines(True) if not line.startswith("warning: ")]
        return "".join(stages) + _core.facts(self._name, self._text)

    @property
    def warnings(self) -> list[str]:
        """What the reader of the results should know before trusting them."""
        return list(self._warnings)

    def replace(self, **values: Any) -> Scene:
        """The scene with other values of some keys: ``scene.replace(alpha=0.3)``, or, dotted as in a sweep,
        ``scene.replace(**{"interaction.alpha": 0.3})``. ``None`` takes a key out, so that another can stand for it."""
        gone = [key for key, value in values.items() if value is None and key.rsplit(".", 1)[-1] not in _KNOWN]
        if gone:
            raise SceneError(_unknown_key(gone[0]))
        changes = [(dotted(key), None if value is None else _value(value)) for key, value in values.items()]
        scene = Scene.__new__(Scene)
        scene._name, scene._made = self._name, self._made
        scene._text = _core.changed(self._name, self._text, changes)
        scene._describe()
        return scene

    def _describe(self) -> None:
        self._resolved, self._plan, self._warnings, self._start = _core.describe(self._name, self._text)

    def __eq__(self, other: object) -> bool:
        """Whether every key has the same value, the title too, and rods start from the same file: runs give the same."""
        return isinstance(other, Scene) and self._identity() == other._identity()

    def __hash__(self) -> int:
        return hash(self._identity())

    def _identity(self) -> tuple[str, str | None]:
        start = None if self._start is None else os.path.abspath(Path(self._name).parent / self._start)
        return self._resolved, start

    def __repr__(self) -> str:
        title, what = self._plan.splitlines()[:2]
        return f"<Scene {title!r}: {what}>"

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(self._plan)}</pre>"


if Scene.__doc__ is not None:  # not under python -OO
    Scene.__doc__ += _keywords() + "\n"

# So that editors complete the keys.
_own = [given for given in inspect.signature(Scene).parameters.values() if given.kind is not inspect.Parameter.VAR_KEYWORD]
_keys = [inspect.Parameter(key, inspect.Parameter.KEYWORD_ONLY, default=None) for key in ("title", *_TABLE_OF)]
Scene.__signature__ = inspect.Signature(_own + _keys)  # type: ignore[attr-defined]


def write_columns(columns: Any, place: Path, what: str) -> None:
    """Writes a CSV file of a dictionary's or a DataFrame's columns of one length, in which one number stands for every row;
    ``what`` they are is said where that cannot be."""
    columns = {str(name): np.asarray(values) for name, values in columns.items()}
    most = max((values.shape for values in columns.values()), key=len, default=())
    columns = {name: np.full(most, values) if values.shape == () else values for name, values in columns.items()}
    lengths = {name: values.shape for name, values in columns.items()}
    if len(set(lengths.values())) != 1 or any(len(shape) != 1 for shape in lengths.values()):
        raise ValueError(f"{what}: columns of one length are allowed; there are {lengths}")
    with open(place, "w", encoding="utf-8", newline="") as text:
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows([[_cell(value) for value in row] for row in zip(*columns.values())])


def _cell(value: Any) -> str:
    """A number, nothing for NaN and None, or the text of a column that is no data."""
    try:
        return "" if value is None or value != value else repr(float(value))
    except (TypeError, ValueError):
        return str(value)


def _unknown(name: str) -> str:
    close = difflib.get_close_matches(name, _BUILT_IN)
    meant = f"did you mean {' or '.join(close)}?" if close else "shearbed.scenes() lists them"
    return f"{name}: no built-in scene has this name; {meant}"


def scene_of(scene: Scene | Mapping[str, Any] | str | os.PathLike[str]) -> Scene:
    """A scene as functions take it: itself, a dictionary, TOML such as ``results.scene``, a file's name, or the name of a
    built-in scene."""
    if isinstance(scene, Scene):
        return scene
    if isinstance(scene, str) and "\n" in scene:
        return Scene(toml=scene)
    if isinstance(scene, Mapping):
        return Scene(scene)
    if isinstance(scene, str) and not os.path.exists(scene):
        if scene in _BUILT_IN:
            return Scene(built_in=scene)
        if not os.path.splitext(scene)[1]:
            raise ValueError(_unknown(scene))
    return Scene(file=scene)
