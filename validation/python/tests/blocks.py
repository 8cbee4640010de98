"""Runs every Python block of the README, one after another, as a reader would: ``python blocks.py`` needs the package and NumPy."""

from __future__ import annotations

import re
from pathlib import Path

README = Path(__file__).parent.parent / "README.md"


def run_all() -> int:
    """How many blocks there were; one that fails raises."""
    blocks = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)
    names: dict[str, object] = {}
    for block in blocks:
        exec(compile(block, README.name, "exec"), names)
    return len(blocks)


if __name__ == "__main__":
    assert run_all() >= 4
