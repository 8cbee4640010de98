"""What the program wrote, read again."""

from __future__ import annotations

import json
import os
import zlib
from pathlib import Path
from typing import Any

from ._fitting import Fit
from ._running import columns, results, tables


def load(folder: str | os.PathLike[str]) -> Any:
    """What the program wrote in a folder, as the function of the same name gives it: :class:`Results` of a run, a :class:`Fit`,
    the columns of a sweep or of a study of convergence; of one of a sweep's ``points``, its columns at all times.

    Raises ``FileNotFoundError`` where there is no ``shearbed.json``, and ``ValueError`` for results of other commands, and
    where a table is gone or is no longer as the program wrote it.
    """
    folder = Path(folder)
    if not (folder / "shearbed.json").is_file():
        raise FileNotFoundError(f"{folder}: holds no results: there is no shearbed.json; a folder that the program wrote is allowed")
    try:
        origin = json.loads((folder / "shearbed.json").read_text(encoding="utf-8"))
        command, inputs = origin["command"], origin["inputs"]
        written = [(name, wrote["bytes"], wrote["crc32"]) for name, wrote in origin["files"].items()]
    except (ValueError, TypeError, AttributeError, KeyError):
        raise ValueError(f"{folder / 'shearbed.json'}: is not as the program wrote it: it was changed, or cut, since") from None
    for name, size, crc32 in written:
        if name.endswith((".csv", ".json")):
            _intact(folder / name, (size, crc32))
    if command == "run":
        return results(folder)
    if command == "fit":
        return Fit(folder)
    if command == "sweep" and "point" in inputs:
        return tables(folder)
    if command in ("sweep", "converge"):
        return columns(folder / f"{command}.csv")
    raise ValueError(f"{folder}: results of {command}; those of run, sweep, converge and fit are allowed")


def _intact(file: Path, wrote: tuple[int, str]) -> None:
    """Refuses a file that is not as ``shearbed.json`` says."""
    if not file.is_file():
        raise ValueError(f"{file}: is gone; without it the results are not whole")
    text = file.read_bytes()
    if (len(text), f"{zlib.crc32(text):08x}") != wrote:
        raise ValueError(f"{file}: is not as the program wrote it: it was changed, or cut, since")
