"""The README's code runs, and the stubs are what the binding has."""

from __future__ import annotations

import inspect
import re
from pathlib import Path

import pytest

import shearbed
from shearbed import _core

HERE = Path(__file__).parent.parent
BLOCKS = re.findall(r"```python\n(.*?)```", (HERE / "README.md").read_text(encoding="utf-8"), re.DOTALL)


def test_every_block_of_the_readme_runs(capsys: pytest.CaptureFixture[str]) -> None:
    assert len(BLOCKS) >= 3
    names: dict[str, object] = {}
    for block in BLOCKS:
        exec(compile(block, "README.md", "exec"), names)
    assert "mid-flip-11.6" in capsys.readouterr().out


def test_the_stub_has_what_the_binding_has() -> None:
    stub = (Path(shearbed.__file__).parent / "_core.pyi").read_text(encoding="utf-8")
    for name, of in inspect.getmembers(_core):
        if name.startswith("_") and name != "__version__":
            continue
        declared = re.search(rf"^(?:def|class) {name}\b\(?(.*?)(?:\) ->|\): \.\.\.)|^{name}:", stub, re.M | re.S)
        assert declared, name
        if inspect.isbuiltin(of):
            given = re.findall(r"(\w+):", re.sub(r"\[[^\]]*\]", "", declared.group(1)))
            assert given == list(inspect.signature(of).parameters), name
    for name in re.findall(r"^(?:def|class) (\w+)", stub, re.M):
        assert hasattr(_core, name), name
