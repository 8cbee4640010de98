"""Runs: the same bits as the program, exceptions with its words, no growth of memory."""

from __future__ import annotations

import csv
import gc
import math
import os
import resource
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import shearbed

FREE = dict(shear_rate_per_s=0.5, count=50, length_mm=0.72, aspect_ratio=11.6, orientation="isotropic", periods=1)
SMALL = FREE | dict(concentration_per_cm3=50, alpha=0.5, count=20, periods=0.5)
EVERY = ["projections", "planar_projections", "mean_angle", "orbit_constant", "orientation_tensor"]

SCENES = {
    "free": FREE,
    "every observable": FREE | dict(observables=EVERY),
    "disc": FREE | dict(aspect_ratio=0.1),
    "one rod": FREE | dict(count=1, orientation={"phi_deg": 0, "theta_deg": 60}),
    "unequal": FREE | dict(aspect_ratio_sd_percent=8.5, replicas=3),
    "extension": {
        key: value for key, value in FREE.items() if key not in ("shear_rate_per_s", "periods")
    } | dict(gradient_per_s=np.diag([1.0, -0.5, -0.5]), strain=3),
    "reversal": {key: value for key, value in FREE.items() if key not in ("shear_rate_per_s", "periods")} | dict(
        steps=[dict(shear_rate_per_s=0.5, strain=4), dict(gradient_per_s=[[0, 0, 0], [-2, 0, 0], [0, 0, 0]], strain=4)],
        strain=8,
    ),
    "interacting": SMALL | dict(replicas=4),
    "angles": SMALL | dict(update="angles", seed=7),
    "short arms": SMALL | dict(min_contact_arm=0.05, m=2.5),
    "dense": SMALL | dict(concentration_per_cm3=500, aspect_ratio=5),
    "lengths in a box": FREE | dict(alpha=0.5, count=20, periods=0.5, length_sd_percent=20, box_mm=[10, 8, 5]),
}


def program(*words: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-m", "shearbed", *words], cwd=cwd, capture_output=True, text=True)


@pytest.mark.parametrize("name", SCENES)
def test_the_bits_are_those_of_the_program(name: str, tmp_path: Path) -> None:
    scene = shearbed.Scene(**SCENES[name])
    (tmp_path / "scene.toml").write_text(scene.toml)
    ended = program("run", "scene.toml", "--out", "out", "--quiet", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    results = shearbed.run(scene, threads=2)
    for observable, channels in results.observables.items():
        with open(tmp_path / "out" / f"{observable}.csv", newline="") as text:
            header, *rows = list(csv.reader(text))
        table = {key: np.array([float(row[k]) for row in rows]) for k, key in enumerate(header)}
        columns = {results.time_name: results.t, "time_s": results.time_s, "strain": results.strain}
        for channel in channels:
            columns |= {channel: getattr(results, channel), f"{channel}_se": getattr(results, f"{channel}_se")}
        assert set(columns) == set(table)
        for key, values in columns.items():
            same = (values.view(np.int64) == table[key].view(np.int64)) | (np.isnan(values) & np.isnan(table[key]))
            assert same.all(), key


@pytest.mark.parametrize("kind", ["free", "interacting", "lengths in a box"])
def test_rods_are_those_of_the_programs_table(kind: str, tmp_path: Path) -> None:
    scene = shearbed.Scene(**(SCENES[kind] | dict(replicas=2, rods_at=[0, 0.2])))
    (tmp_path / "scene.toml").write_text(scene.toml)
    assert program("run", "scene.toml", "--out", "out", "--quiet", cwd=tmp_path).returncode == 0
    with open(tmp_path / "out" / "rods.csv", newline="") as text:
        rows = list(csv.DictReader(text))
    rods = shearbed.run(scene).rods
    assert list(rods) == list(rows[0]) and len(rods["rod"]) == len(rows) == 2 * 2 * SCENES[kind]["count"]
    for name, values in rods.items():
        table = np.array([float(row[name] or "nan") for row in rows])
        assert np.array_equal(values, table, equal_nan=True), name
    # And in again: the rods of replica 0 at the end.
    last = [row for row in rows if row["replica"] == "0"][-SCENES[kind]["count"]:]
    (tmp_path / "below").mkdir()
    with open(tmp_path / "below" / "start.csv", "w", newline="") as out:
        table = csv.DictWriter(out, list(rows[0]))
        table.writeheader()
        table.writerows(last)
    text = shearbed.Scene(**SCENES[kind]).toml
    for old, new in (("orientation = \"isotropic\"", "rods = { file = \"below/start.csv\" }"), ("observables =", "rods_at = [0]\nobservables =")):
        assert old in text
        text = text.replace(old, new)
    (tmp_path / "on.toml").write_text(text)
    again = shearbed.run(tmp_path / "on.toml", replicas=1)
    # Read directions are divided by their length, which is 1 up to a rounding or two.
    assert np.allclose(again.rods["p2"], [float(row["p2"]) for row in last], rtol=0, atol=1e-15)
    for name in ("length_mm", "aspect_ratio", "x2_mm"):
        read = [float(row[name] or "nan") for row in last]
        assert np.allclose(again.rods[name], read, rtol=1e-15, atol=0, equal_nan=True), name
    # A sweep writes no rods, but starts from them.
    (tmp_path / "swept.toml").write_text(text.replace("rods_at = [0]\n", ""))
    swept = shearbed.sweep(tmp_path / "swept.toml", {"ensemble.seed": [1, 2]}, replicas=1)
    assert len(swept["x1"]) == 2


def test_what_the_program_wrote_is_loaded_as_a_run_gives_it(tmp_path: Path) -> None:
    scene = shearbed.Scene(**(SMALL | dict(replicas=2, rods_at=[0, 0.2], observables=EVERY)))
    (tmp_path / "scene.toml").write_text(scene.toml)
    kept = shearbed.run(scene, out=tmp_path / "out")
    loaded, own = shearbed.load(tmp_path / "out"), shearbed.run(scene)
    assert kept.x1.tobytes() == own.x1.tobytes() and (tmp_path / "out" / "projections.svg").exists()
    # The program takes it for its own.
    assert program("run", "scene.toml", "--out", "out", "--quiet", cwd=tmp_path).returncode == 0
    assert loaded.observables == own.observables and loaded.labels == own.labels and loaded.time_name == own.time_name
    assert {name: loaded.symbols[name] for name in own.channels} == own.symbols
    assert (loaded.seed, loaded.replicas, loaded.warnings) == (own.seed, own.replicas, own.warnings)
    for name in ("t", "time_s", "strain", "a", *own.channels, *(f"{name}_se" for name in own.channels)):
        assert np.array_equal(getattr(loaded, name), getattr(own, name)), name
    for tables in ("rods", "extremes", "derived"):
        pairs = zip(getattr(loaded, tables).items(), getattr(own, tables).items(), strict=True)
        assert all(a == b and np.array_equal(x, y, equal_nan=True) for (a, x), (b, y) in pairs)
    assert shearbed.Scene(toml=loaded.scene) == scene
    with pytest.raises(FileNotFoundError):
        shearbed.load(tmp_path)
    table = tmp_path / "out" / "projections.csv"
    whole = table.read_text()
    for spoilt in (whole.replace("0", "1", 1), whole[:-200]):
        table.write_text(spoilt)
        with pytest.raises(ValueError, match="projections.csv: is not as the program wrote it"):
            shearbed.load(tmp_path / "out")
    table.unlink()
    with pytest.raises(ValueError, match="projections.csv: is gone"):
        shearbed.load(tmp_path / "out")
    for spoilt in ("{", "[]", '{"command": "run", "inputs": {}, "files": null}'):
        (tmp_path / "out" / "shearbed.json").write_text(spoilt)
        with pytest.raises(ValueError, match="shearbed.json: is not as the program wrote it"):
            shearbed.load(tmp_path / "out")
    with pytest.raises(ValueError, match="out"):
        shearbed.run(scene, out="")


@pytest.mark.skipif(sys.platform != "linux", reason="the system ends no process with its parent")
def test_a_script_that_is_killed_leaves_no_process_at_work(tmp_path: Path) -> None:
    long = SMALL | dict(replicas=1_000_000, periods=100)
    script = f"import shearbed; shearbed.run({long!r}, out='out', yes=True)"
    started = subprocess.Popen([sys.executable, "-c", script], cwd=tmp_path)
    deadline = time.monotonic() + 60
    children = lambda: Path(f"/proc/{started.pid}/task/{started.pid}/children").read_text().split()
    while not children() and time.monotonic() < deadline:
        time.sleep(0.05)
    [child] = children()
    time.sleep(1)
    started.kill()
    started.wait()
    there = lambda: Path(f"/proc/{child}/stat").exists() and ") Z" not in Path(f"/proc/{child}/stat").read_text()
    while there() and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not there() and not (tmp_path / "out").exists()


def test_what_other_commands_wrote_is_loaded_as_their_functions_give_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.toml").write_text(shearbed.Scene(**SMALL).toml)
    (tmp_path / "free.toml").write_text(shearbed.Scene(**FREE).toml)
    for words in (
        "sweep scene.toml --over interaction.alpha=0.25,1 --out swept --quiet",
        "converge free.toml --out orders --quiet",
        "man pages --quiet",
    ):
        ended = program(*words.split(), cwd=tmp_path)
        assert ended.returncode == 0, ended.stderr
    swept = shearbed.sweep(SMALL, {"interaction.alpha": [0.25, 1.0]}, out="own/swept")
    orders = shearbed.converge(FREE, out="own/orders")
    for own, found in ((swept, "swept"), (orders, "orders"), (swept, "own/swept"), (orders, "own/orders")):
        loaded = shearbed.load(tmp_path / found)
        assert list(loaded) == list(own) and len(own) > 3
        for name, values in own.items():
            assert values.dtype.kind != "f" or np.array_equal(loaded[name], values, equal_nan=True), name
            assert values.dtype.kind == "f" or list(loaded[name]) == list(values), name
    assert shearbed.load(tmp_path / "swept" / "points" / "2")["x1"][-1] == swept["x1"][1]
    with pytest.raises(ValueError, match="results of man"):
        shearbed.load(tmp_path / "pages")


def test_steps_of_interacting_rods() -> None:
    found = shearbed.converge(SMALL, replicas=8, threads=2)
    steps = found["steps_per_period"][found["against"] == "steps_per_period"]
    assert list(steps[:3]) == [20, 50, 100] and np.isfinite(found["x1"]).all()


def test_rods_for_paraview(tmp_path: Path) -> None:
    scene = shearbed.Scene(**(SMALL | dict(rods_at=[0, 0.2])))
    written = shearbed.run(scene, vtk=tmp_path / "vtk")
    assert {file.name for file in (tmp_path / "vtk").iterdir()} == {"rods.pvd", "rods_0000.vtp", "rods_0001.vtp"}
    assert f'NumberOfLines="{SMALL["count"]}"' in (tmp_path / "vtk" / "rods_0001.vtp").read_text()
    assert written.x1.tobytes() == shearbed.run(scene).x1.tobytes()
    (tmp_path / "vtk" / "rods_0000.vtp").write_text("mine")
    with pytest.raises(FileExistsError, match="rods"):
        shearbed.run(scene, vtk=tmp_path / "vtk")
    assert (tmp_path / "vtk" / "rods_0000.vtp").read_text() == "mine"
    # Without rods there is nothing to write.
    with pytest.raises(ValueError, match="rods_at") as refused:
        shearbed.run(SMALL, vtk=tmp_path / "none")
    assert "--" not in str(refused.value) and not (tmp_path / "none").exists()


def test_derived_values_of_free_rods_are_those_of_their_theory() -> None:
    free = {"particles.count": 400, "time.periods": 3, "interaction": None, "particles.aspect_ratio_sd_percent": 0}
    run = shearbed.run("fig9-sd0", set=free, replicas=20)
    assert abs(run.derived["x1_damping_rate"]) < 4 * run.derived["x1_damping_rate_se"] + 1e-6
    assert np.isnan(run.derived["x1_steady"])
    amplitudes = run.extremes["x1_amplitude"]
    assert np.allclose(amplitudes[np.isfinite(amplitudes)], 0.48, atol=0.02)


def test_a_scene_with_other_values() -> None:
    scene = shearbed.Scene(**SMALL)
    changed = scene.replace(alpha=0.25, **{"ensemble.seed": 7, "title": "other"})
    assert changed == shearbed.Scene(**(SMALL | dict(alpha=0.25, seed=7, title="other"))) != scene
    assert len({scene, shearbed.Scene(**SMALL), changed}) == 2
    # Defaults follow: longer rods take more steps.
    assert scene.replace(aspect_ratio=50) == shearbed.Scene(**(SMALL | dict(aspect_ratio=50)))
    # What is said replaces what stood for it.
    in_place = scene.replace(volume_fraction=1e-4)
    assert "volume_fraction" in in_place.toml and "concentration_per_cm3" not in in_place.toml
    assert in_place == scene.replace(concentration_per_cm3=None, volume_fraction=1e-4)
    assert scene.replace(seconds=10).replace(strain=2, replicas=None) == shearbed.Scene(
        **{key: value for key, value in SMALL.items() if key not in ("periods", "steps_per_period", "outputs_per_period")}, strain=2
    )
    assert shearbed.run(scene, set={"alpha": 0.25}).x1.tobytes() == shearbed.run(scene.replace(alpha=0.25)).x1.tobytes()
    assert repr(scene) == "<Scene 'scene': 20 rods, 1 replica, t/T = 0.5, 101 outputs, 100 time steps>"
    assert "<pre>scene\n" in scene._repr_html_()
    with pytest.raises(shearbed.SceneError, match="alhpa"):
        scene.replace(alhpa=0.3)
    with pytest.raises(shearbed.SceneError, match="title is not a table: it has no key x"):
        scene.replace(**{"title.x": 1})


def test_runs_and_sweeps_warn_as_the_program_does() -> None:
    dense = shearbed.Scene(**SMALL).replace(concentration_per_cm3=50_000, periods=0.01)
    with pytest.warns(UserWarning, match="concentrated"):
        shearbed.run(dense)
    with pytest.warns(UserWarning, match="over interaction.concentration_per_cm3=60000: .*concentrated"):
        shearbed.sweep(dense, {"interaction.concentration_per_cm3": [50, 60_000]})


def test_work_of_days_is_asked_for() -> None:
    long = shearbed.Scene(**SMALL).replace(count=100_000, periods=6, replicas=1_000_000)
    for run in (lambda: shearbed.run(long), lambda: shearbed.sweep(long, {"interaction.alpha": [0.1, 0.2]})):
        with pytest.raises(ValueError, match="begin with yes(=True)? alone"):
            run()


def test_what_a_sweep_is_over_is_a_list() -> None:
    with pytest.raises(ValueError, match=r"over: interaction.alpha = 0.5: a list of values is allowed"):
        shearbed.sweep(SMALL, {"interaction.alpha": 0.5})


def test_no_threads_are_refused() -> None:
    with pytest.raises(ValueError, match="threads = 0: a whole number from 1"):
        shearbed.run(SMALL, threads=0)


def test_a_plan_has_period_concentration_and_cost() -> None:
    plan = shearbed.Scene(**SMALL).replace(concentration_per_cm3=50_000).plan
    assert "T = 146.8532 s" in plan and "n a³ = 1.866e1 (concentrated)" in plan and "rods × steps" in plan
    assert "warning" not in plan


def test_a_dense_scene_warns_here_too() -> None:
    [warning] = shearbed.Scene(**SMALL).replace(concentration_per_cm3=50_000).warnings
    assert "n a³ = 18.662: concentrated" in warning
    [warning] = shearbed.Scene(**SMALL).replace(orientation={"phi_deg": 90, "theta_deg": 90}).warnings
    assert "all rods start parallel in the shear plane" in warning


def test_until_a_standard_error_is_small_and_with_a_checkpoint(tmp_path: Path) -> None:
    found = shearbed.run(SMALL, until_se={"x1": 0.02})
    assert found.replicas >= 32 and found.x1_se.max() <= 0.02
    assert found.x1.tobytes() == shearbed.run(SMALL, replicas=found.replicas).x1.tobytes()
    with pytest.warns(UserWarning, match="x1"):
        less = shearbed.run(SMALL, until_se={"x1": 1e-5}, time_limit_s=0.2)
    assert less.replicas >= 2
    with pytest.warns(UserWarning, match="x1"):
        less = shearbed.run(SMALL, until_se={"x1": 1e-5}, time_limit_s=0.2, out=tmp_path / "less")
    assert shearbed.load(tmp_path / "less").replicas == less.replicas
    (tmp_path / "less" / "projections.csv").write_text("mine")
    with pytest.raises((ValueError, RuntimeError), match="projections.csv: was changed"):
        shearbed.run(SMALL, until_se={"x1": 1e-5}, time_limit_s=0.2, out=tmp_path / "less")
    kept = tmp_path / "kept"
    first = shearbed.run(SMALL, replicas=3, checkpoint=kept)
    assert kept.exists() and first.x1.tobytes() == shearbed.run(SMALL, replicas=3).x1.tobytes()
    assert shearbed.run(SMALL, replicas=5, checkpoint=kept).x1.tobytes() == shearbed.run(SMALL, replicas=5).x1.tobytes()
    with pytest.raises(ValueError, match="fewer|replicas"):
        shearbed.run(SMALL, replicas=2, checkpoint=kept)
    with pytest.raises(TypeError, match="until_se"):
        shearbed.run(SMALL, time_limit_s=1)


def test_a_sweep_as_a_dataset() -> None:
    pytest.importorskip("xarray", reason="xarray is not here")
    over = {"interaction.alpha": [0.25, 1.0], "interaction.update": ["kick", "rotation", "angles"]}
    table = shearbed.sweep(SMALL, over, replicas=2)
    found = shearbed.sweep(SMALL, over, replicas=2, xarray=True)
    assert dict(found.sizes) == {"interaction.alpha": 2, "interaction.update": 3}
    picked = found["x1"].sel({"interaction.alpha": 1.0, "interaction.update": "rotation"})
    assert float(picked) == table["x1"][4]
    every = shearbed.sweep(SMALL, over, replicas=2, times="all", xarray=True)
    assert np.array_equal(every["x1"].isel(output=-1).values, found["x1"].values) and every.sizes["output"] == 101
    short = shearbed.sweep(SMALL, {"alpha": [0.25, 1.0]}, replicas=2, xarray=True)
    assert dict(short.sizes) == {"interaction.alpha": 2} and "interaction.alpha" not in short.data_vars


def test_seed_and_replicas_stand_in_place_of_the_scenes_own() -> None:
    own = shearbed.run(SMALL | dict(replicas=3, seed=5))
    given = shearbed.run(SMALL, replicas=3, seed=5)
    other = shearbed.run(SMALL, replicas=3, seed=6)
    assert own.x1.tobytes() == given.x1.tobytes() != other.x1.tobytes()


def test_one_scene_in_every_form(tmp_path: Path) -> None:
    keywords = shearbed.Scene(**FREE)
    tables = shearbed.Scene({
        "title": "scene",
        "flow": {"shear_rate_per_s": 0.5},
        "particles": {key: FREE[key] for key in ("count", "length_mm", "aspect_ratio", "orientation")},
        "time": {"periods": 1},
    })
    text = shearbed.Scene(toml=keywords.toml)
    (tmp_path / "a.toml").write_text(keywords.toml)
    assert keywords.toml == tables.toml == text.toml == shearbed.Scene(file=tmp_path / "a.toml").toml
    assert "free" in keywords.plan or "rods" in keywords.plan


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        (dict(count=-1), "count"),
        (dict(aspect_ratio=math.nan), "aspect_ratio"),
        (dict(alpha=0.5), "concentration_per_cm3"),
        (dict(colour="red"), "colour"),
        (dict(orientation="up"), "orientation"),
        (dict(observables=["speed"]), "observables"),
        (dict(periods=1e9), "periods"),
        ({"title": 'a"b\nc\u202e', "count": 0}, "count"),
    ],
)
def test_a_scene_that_is_not_allowed_says_key_value_and_what_is(changed: dict[str, object], words: str) -> None:
    with pytest.raises(shearbed.SceneError, match=words):
        shearbed.Scene(**(FREE | changed))


def test_a_number_of_replicas_that_is_not_allowed_is_refused_as_in_a_scene() -> None:
    for replicas in (-1, 0):
        with pytest.raises(shearbed.SceneError, match=f"ensemble.replicas = {replicas} is not allowed"):
            shearbed.run(FREE, replicas=replicas)


def test_other_mistakes_are_type_errors() -> None:
    for call in (lambda: shearbed.Scene(), lambda: shearbed.Scene({}, toml=""), lambda: shearbed.Scene(count=object())):
        with pytest.raises(TypeError):
            call()
    with pytest.raises(AttributeError, match="x1, x2, x3"):
        shearbed.run(FREE).x4
    with pytest.raises(AttributeError, match="orientation_tensor"):
        shearbed.run(FREE).a
    with pytest.raises(AttributeError, match="rods_at"):
        shearbed.run(FREE).rods


def test_a_scene_that_would_not_fit_in_memory_is_refused() -> None:
    with pytest.raises(shearbed.SceneError, match="memory"):
        shearbed.run(FREE | dict(count=10**8), replicas=512, threads=512)


def test_the_tensor_is_symmetric_and_has_the_trace_1() -> None:
    a = shearbed.run(FREE | dict(observables=["orientation_tensor"])).a
    assert a.shape[1:] == (3, 3)
    assert np.allclose(np.trace(a, axis1=1, axis2=2), 1.0, atol=1e-14)
    assert (a == a.transpose(0, 2, 1)).all()


def test_progress_is_told_and_may_stop_the_run() -> None:
    calls: list[tuple[int, int]] = []
    shearbed.run(SMALL, replicas=200, progress=lambda done, of: calls.append((done, of)))
    assert calls[-1] == (200, 200)

    def stop(done: int, of: int) -> None:
        raise KeyError("enough")

    with pytest.raises(KeyError, match="enough"):
        shearbed.run(SMALL, replicas=100_000, progress=stop)


def test_ctrl_c_stops_a_run() -> None:
    threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        shearbed.run(SMALL, replicas=1_000_000)
    assert time.monotonic() - start < 30


def test_other_threads_go_on_during_a_run() -> None:
    results: list[shearbed.Results] = []
    worker = threading.Thread(target=lambda: results.append(shearbed.run(SMALL, replicas=300, threads=1)))
    worker.start()
    count = 0
    while worker.is_alive():
        count += 1
    worker.join()
    assert count > 1000 and len(results) == 1
    assert results[0].x1.tobytes() == shearbed.run(SMALL, replicas=300).x1.tobytes()


def test_memory_does_not_grow() -> None:
    scene = shearbed.Scene(**FREE)

    def many() -> int:
        for _ in range(500):
            shearbed.run(scene, threads=1)
        gc.collect()
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    first = many()
    # In kB; 500 results of 51 outputs in nine arrays would be 1.8 MB if one were kept of each.
    assert many() - first < 1000


def test_a_sweep_has_the_rows_of_the_program() -> None:
    table = shearbed.sweep(SMALL, {"interaction.alpha": [0.25, 1.0], "interaction.update": ["rotation", "angles"]}, replicas=2)
    assert list(table["interaction.alpha"]) == [0.25, 0.25, 1.0, 1.0]
    assert list(table["interaction.update"]) == ["rotation", "angles"] * 2
    last = shearbed.run(SMALL | dict(alpha=1.0, update="angles"), replicas=2)
    assert table["x1"][3] == last.x1[-1]
    assert list(shearbed.sweep(SMALL, {"alpha": [1.0]}, replicas=2)["interaction.alpha"]) == [1.0]
    # Messages speak of keywords, not of flags.
    with pytest.raises(ValueError, match="toml: over interaction.alhpa=1.*did you mean interaction.alpha") as refused:
        shearbed.sweep(SMALL, {"interaction.alhpa": [1.0]})
    assert "--" not in str(refused.value)


def test_the_program_is_there(tmp_path: Path) -> None:
    assert program("--version", cwd=tmp_path).stdout.startswith("shearbed ")
    ended = program("run", "nothing.toml", cwd=tmp_path)
    assert ended.returncode == 2 and "nothing.toml" in ended.stderr and not list(tmp_path.iterdir())


def test_rods_start_as_arrays_dictionaries_and_tables_say():
    directions = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.6, 0.0, 0.8]])
    columns = dict(zip(("p1", "p2", "p3"), directions.T))
    found = []
    for rods in (directions, columns, pytest.importorskip("pandas").DataFrame(columns)):
        scene = shearbed.Scene(shear_rate_per_s=0.5, aspect_ratio=11.6, length_mm=0.72, periods=1, rods=rods)
        assert shearbed.run(scene).x1[0] == pytest.approx(1.6 / 3)
        # Another scene with the same rods outlives the first.
        found.append(shearbed.run(scene.replace(periods=2)).x1[-1])
        del scene
    assert found[0] == found[1] == found[2]
    with pytest.raises(ValueError, match=r"\(rods, 3\), a direction in each row"):
        shearbed.Scene(shear_rate_per_s=0.5, aspect_ratio=11.6, length_mm=0.72, periods=1, rods=directions[:, :2])


def test_progress_without_tqdm_is_a_line(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    scene = shearbed.Scene(built_in="fig4-n50").replace(periods=1)
    shearbed.sweep(scene, {"interaction.alpha": [0.25, 0.5]}, progress=True)
    assert "2 of 2 points\n" in capsys.readouterr().err


def test_the_scene_of_results_runs_again():
    first = shearbed.run(SMALL, seed=5)
    assert np.array_equal(shearbed.run(first.scene).x1, first.x1)


def test_a_refused_folder_is_told_without_what_only_the_program_has(tmp_path):
    scene = shearbed.Scene(built_in="fig4-n50").replace(count=20, periods=0.25, replicas=2)
    shearbed.run(scene, out=tmp_path / "out", seed=2)
    with pytest.warns(UserWarning, match="replaced earlier results of run: scene.ensemble.seed was 2 and is 1 now"):
        shearbed.run(scene, out=tmp_path / "out")
    (tmp_path / "out" / "projections.csv").write_text("mine")
    with pytest.raises(ValueError, match="was changed after `shearbed run` wrote it; another out leaves it") as refused:
        shearbed.run(scene, out=tmp_path / "out")
    assert "force" not in str(refused.value)
    with pytest.raises(ValueError, match="^fig4-n50.toml: "):
        shearbed.sweep(scene, {"alhpa": [1, 2]}, out=tmp_path / "swept")


def test_wrong_arguments_are_named_in_pythons_words():
    for error, words, call in (
        (TypeError, "until_se = 0.01: a dictionary", lambda: shearbed.run(SMALL, until_se=0.01)),
        (TypeError, "until_se: x1 = 'small': a number", lambda: shearbed.run(SMALL, until_se={"x1": "small"})),
        (TypeError, r"over = \['alpha'\]: a dictionary", lambda: shearbed.sweep(SMALL, ["alpha"])),
        (ValueError, "over: no key has values", lambda: shearbed.sweep(SMALL, {})),
        (shearbed.SceneError, "aplha: unknown key; did you mean alpha", lambda: shearbed.Scene(**SMALL).replace(aplha=None)),
        (shearbed.SceneError, "^alfa: unknown key; did you mean alpha$", lambda: shearbed.Scene(**SMALL, alfa=1)),
        (ValueError, '"file": ', lambda: shearbed.Scene(**(FREE | dict(rods="nope.csv")))),
        (ValueError, "^aspect_ratio = -18.0: ", lambda: shearbed.reference(-18, times=[0])),
        (ValueError, "^missing: times$", lambda: shearbed.reference(18)),
        (ValueError, "a count of at least 2", lambda: shearbed.reference(18, times=(0, 0.5, 1))),
        (TypeError, "c_i = 'much': a number", lambda: shearbed.reference(18, times=[0], c_i="much")),
        (ValueError, r"gradient_per_s: an array of \(2, 2\)", lambda: shearbed.reference(2, times=[0], gradient_per_s=np.eye(2))),
        (ValueError, "steps: -1", lambda: shearbed.grade(lambda L, r, p, dt: p, steps=[-1], names=["mid-flip-2"])),
    ):
        with pytest.raises(error, match=words) as refused:
            call()
        assert "--" not in str(refused.value) and "Usage" not in str(refused.value)
    assert shearbed.Scene(**SMALL, title=None) == shearbed.Scene(**SMALL)
