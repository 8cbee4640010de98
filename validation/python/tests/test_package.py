"""The README's code and the example run, and the stubs are what the binding has."""

from __future__ import annotations

import inspect
import re
import runpy
from pathlib import Path

import pytest
from blocks import run_all

import shearbed
from shearbed import _core

HERE = Path(__file__).parent.parent


def test_every_block_of_the_readme_runs(capsys: pytest.CaptureFixture[str]) -> None:
    assert run_all() >= 4
    assert "mid-flip-11.6" in capsys.readouterr().out


def test_the_example_grades_fiberoripy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("fiberoripy", reason="fiberoripy, scipy and matplotlib are not here")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "Agg")
    names = runpy.run_path(str(HERE / "examples" / "verify_my_code.py"))
    # What the example says of it, and docs/src/user/grading.md.
    verdicts = {problem["name"]: problem["verdict"] for problem in names["report"].problems}
    assert verdicts == {
        "mid-flip-2": "PASS", "mid-flip-11.6": "PASS", "mid-flip-100": "FAIL", "mid-flip-10000": "FAIL"
    }
    assert (tmp_path / "verify_my_code.png").stat().st_size > 10_000
    lines = (HERE / "examples" / "verify_my_code.py").read_text(encoding="utf-8").splitlines()
    assert len(lines) < 40, "an example is short"


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
