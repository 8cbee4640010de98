"""The JSON Schemas against what the program writes and reads, by the package jsonschema."""

from __future__ import annotations

import copy
import json
import tomllib
from pathlib import Path

import jsonschema
from test_run import program

import shearbed

SCHEMAS = Path(__file__).parents[2] / "schemas"


def validator(path: Path) -> jsonschema.Draft202012Validator:
    schema = json.loads(path.read_text(encoding="utf-8"))
    jsonschema.validators.validator_for(schema).check_schema(schema)
    return jsonschema.validators.validator_for(schema)(schema)


def test_every_problem_holds_to_the_schema_and_spoilt_ones_do_not(tmp_path: Path) -> None:
    schema = validator(SCHEMAS / "problem.schema.json")
    assert json.loads(program("problems", "schema", cwd=tmp_path).stdout) == schema.schema
    assert program("problems", "export", "all", cwd=tmp_path).returncode == 0
    texts = sorted((tmp_path / "all").glob("*/problem.json"))
    assert len(texts) > 50
    spoilt = dict(
        format=2, kind="rod", tolerance=0, aspect_ratio=-1, extra=1, gradient_per_s=[[0.0] * 3] * 2, ensemble=1
    )
    for path in texts:
        problem = json.loads(path.read_text(encoding="utf-8"))
        assert not list(schema.iter_errors(problem)), path
        for key, value in spoilt.items():
            assert not schema.is_valid(problem | {key: value}), (path, key)
        for key in ("because", "times_s", "columns"):
            assert not schema.is_valid({name: value for name, value in problem.items() if name != key}), (path, key)


def test_a_report_holds_to_the_schema_and_a_spoilt_one_does_not(tmp_path: Path) -> None:
    schema = validator(SCHEMAS / "report.schema.json")
    ended = program("validate", "--case", "jeffery-period", "--case", "okagawa-mason-1973", "--out", "out", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    report = json.loads((tmp_path / "out" / "report.json").read_text(encoding="utf-8"))
    assert not list(schema.iter_errors(report))
    for spoil in (
        lambda text: text["cases"][0].update(verdict="perhaps"),
        lambda text: text["cases"][0].pop("claim"),
        lambda text: text["summary"].update({"pass": "all"}),
    ):
        wrong = copy.deepcopy(report)
        spoil(wrong)
        assert not schema.is_valid(wrong)


def test_the_schema_of_scenes_refuses_what_the_program_refuses(tmp_path: Path) -> None:
    schema = validator(SCHEMAS / "scene.json")
    for name in shearbed.scenes():
        text = program("scenes", "--show", name, cwd=tmp_path).stdout
        assert schema.is_valid(tomllib.loads(text)), name
    text = program("scenes", "--show", "fig4-n50", cwd=tmp_path).stdout
    tried = 0
    for line in text.splitlines():
        key, is_value, _ = line.partition(" = ")
        for wrong in ("-1", "[]", "{ a = 1 }", "1e999") if is_value else ():
            spoilt = text.replace(line, f"{key} = {wrong}")
            try:
                # JSON has no infinity: null stands in its place.
                table = json.loads(json.dumps(tomllib.loads(spoilt)), parse_constant=lambda _: None)
            except tomllib.TOMLDecodeError:
                continue
            try:
                shearbed.Scene(toml=spoilt)
                refused = False
            except shearbed.SceneError:
                refused = True
            assert schema.is_valid(table) != refused, f"{key} = {wrong}"
            tried += 1
    assert tried > 40
