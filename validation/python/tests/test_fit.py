"""Fits: the result of the program, in its words. The points are synthetic, made here by the model itself."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import shearbed

SCENE = shearbed.Scene(
    shear_rate_per_s=0.5, count=20, length_mm=0.72, aspect_ratio=11.6, orientation="isotropic",
    concentration_per_cm3=50, alpha=0.5, periods=0.5, steps_per_period=100, outputs_per_period=20,
)
OVER = {"interaction.alpha": (0.05, 5.0)}


@pytest.fixture(scope="module")
def points() -> dict[str, np.ndarray]:
    """The mean curve at alpha = 0.8 with an uncertainty of 0.01 and noise of about that, which is fixed."""
    truth = shearbed.run(shearbed.Scene(toml=SCENE.toml.replace("alpha = 0.5", "alpha = 0.8")), seed=7, replicas=400)
    noise = 0.01 * np.array([-1.2, 0.3, 0.9, -0.4, 0.1, 1.1, -0.8, 0.5, -0.1, -0.5])
    return {"t_over_T": truth.t[1:], "x1": truth.x1[1:] + noise, "x1_u": np.full(10, 0.01)}


def test_the_result_is_that_of_the_program(points: dict[str, np.ndarray], tmp_path: Path) -> None:
    found = shearbed.fit(SCENE, points, OVER, replicas=60, seed=3, threads=2, out=tmp_path / "kept")
    assert shearbed.load(tmp_path / "kept").record == found.record and "\nin " not in str(found)
    (tmp_path / "scene.toml").write_text(SCENE.toml)
    with open(tmp_path / "points.csv", "w", newline="") as text:
        writer = csv.writer(text)
        writer.writerow(points)
        writer.writerows(zip(*(map(repr, map(float, column)) for column in points.values())))
    words = "fit scene.toml --data points.csv --over interaction.alpha=0.05:5 --replicas 60 --seed 3 --out out"
    started = [sys.executable, "-m", "shearbed", *words.split()]
    ended = subprocess.run(started, cwd=tmp_path, capture_output=True, text=True, encoding="utf-8")
    assert ended.returncode == 0, ended.stderr
    record = json.loads((tmp_path / "out" / "fit.json").read_text())
    of_the_call = {"command", "data"}
    same = {key: value for key, value in record.items() if key not in of_the_call}
    assert {key: value for key, value in found.record.items() if key not in of_the_call} == same
    alpha = found["interaction.alpha"]
    assert alpha.estimate == record["parameters"]["interaction.alpha"]["estimate"]
    assert alpha.low_95 < alpha.low_68 < alpha.estimate < alpha.high_68 < alpha.high_95
    # Correct code is outside four standard uncertainties at one seed in 16 000.
    assert abs(alpha.estimate - 0.8) < 4 * alpha.standard_uncertainty
    assert str(found).splitlines()[0] == ended.stdout.splitlines()[0] and "out:" not in str(found)
    assert repr(found).startswith(f"<Fit interaction.alpha = {alpha.estimate:.4g} ± ")
    loaded = shearbed.load(tmp_path / "out")
    assert loaded.parameters == found.parameters and repr(loaded) == repr(found) == str(loaded)
    assert found.covariance.shape == (1, 1) and found.degrees_of_freedom == 9
    calls: list[tuple[int, int]] = []
    watched = shearbed.fit(
        SCENE, points, OVER, replicas=60, seed=3, threads=1, progress=lambda done, of: calls.append((done, of))
    )
    assert str(watched) == str(found) and calls and calls == sorted(calls)
    assert all(0 <= done <= of for done, of in calls) and max(calls)[0] > 1
    for _ in range(2):
        kept = shearbed.fit(SCENE, points, OVER, replicas=60, seed=3, threads=2, checkpoint=tmp_path / "fit.ckpt")
        assert kept.record["parameters"] == record["parameters"] and str(kept) == str(found)
    assert np.array_equal(found.residuals["measured"], points["x1"])
    samples = found.samples["interaction.alpha"]
    assert len(samples) == 4000 and abs(np.median(samples) - alpha.estimate) < alpha.standard_uncertainty
    assert len(found.extremes) == len(found.derived) == 1 and "x1_damping_rate" in found.derived[0]
    assert np.nanmax(found.extremes[0]["x1_maximum"]) > 0.3
    values, rise = found.profiles["interaction.alpha"]
    assert len(values) == len(rise) > 5 and rise.min() >= 0
    [tested] = shearbed.fit(SCENE, points, OVER, replicas=60, seed=3, test=["interaction.alpha=0.8"]).tests
    assert tested["hypothesis"] == "interaction.alpha=0.8" and tested["p_value"] > 6e-5 and found.tests == []
    # The points as a file, and in two sets with a value that was not measured.
    assert shearbed.fit(SCENE, tmp_path / "points.csv", OVER, replicas=60, seed=3)["interaction.alpha"] == alpha
    bare = {name: column for name, column in points.items() if name != "x1_u"}
    assert shearbed.fit(SCENE, bare, OVER, u=0.01, u_contains="reading", replicas=60, seed=3)["interaction.alpha"] == alpha
    # One number for every row, and a column that is no data.
    with pytest.warns(UserWarning, match="who"):
        one = shearbed.fit(SCENE, bare | {"x1_u": 0.01, "who": ["me"] * 10}, OVER, replicas=60, seed=3)
    assert one["interaction.alpha"] == alpha
    np.savetxt(tmp_path / "bare.txt", np.stack([points["x1"], points["t_over_T"]], axis=1), fmt="%.17g", delimiter=",")
    named = shearbed.fit(SCENE, tmp_path / "bare.txt", OVER, columns=["x1", "t_over_T"], u=0.01, replicas=60, seed=3)
    assert named["interaction.alpha"] == alpha
    for wrong, why in [
        (dict(replicas=5), "^replicas = 5: a whole number from 20"),
        (dict(u_contains="foo"), "^u_contains = foo: reading, rods are allowed"),
        (dict(columns="t_over_T,x9,x1_u"), "^data"),
    ]:
        with pytest.raises(ValueError, match=why) as refused:
            shearbed.fit(SCENE, points, OVER, **wrong)
        assert "--" not in str(refused.value) and ".csv" not in str(refused.value)
    halves = [{name: column[half] for name, column in points.items()} for half in (slice(0, 5), slice(5, 10))]
    halves[1]["x1"] = np.where(np.arange(5) == 2, np.nan, halves[1]["x1"])
    both = shearbed.fit(SCENE, halves[0], OVER, also=[(SCENE, halves[1])], replicas=60, seed=3)
    assert both.degrees_of_freedom == 8 and set(both.residuals["set"]) == {1.0, 2.0}
    assert len(both.extremes) == 2


def test_a_plot_has_the_best_curve_and_the_residuals(points: dict[str, np.ndarray]) -> None:
    matplotlib = pytest.importorskip("matplotlib", reason="matplotlib is not here")
    matplotlib.use("Agg")
    found = shearbed.fit(SCENE, points, OVER, replicas=60, seed=3)
    upper, lower = found.plot().figure.axes
    assert [text.get_text() for text in upper.get_legend().get_texts()] == ["X̄₁, best fit", "X̄₁, 95 %", "X̄₁, measured ± u"]
    # The curve is drawn between the points too.
    assert max(len(line.get_xdata()) for line in upper.lines) > 100
    below = [line.get_ydata() for line in lower.lines if len(line.get_ydata()) == 10]
    assert any(np.array_equal(values, found.residuals["residual"]) for values in below)


def test_what_is_not_allowed_is_said_in_the_programs_words(points: dict[str, np.ndarray], tmp_path: Path) -> None:
    for changed, words in [
        (dict(over={"interaction.alhpa": (0.05, 5)}), "interaction.alpha"),
        (dict(over={"interaction.alpha": (5, 0.05)}), "interaction.alpha"),
        (dict(data={"t_over_T": points["t_over_T"], "x9": points["x1"], "x9_u": points["x1_u"]}), "x9"),
        (dict(data={**points, "x1_u": 0 * points["x1"]}), "x1_u"),
        (dict(data={**points, "x1": points["x1"][1:]}), "one length"),
        (dict(data=tmp_path / "nothing.csv"), "nothing.csv"),
        (dict(replicas=1), "20"),
    ]:
        with pytest.raises(ValueError, match=words):
            shearbed.fit(**({"scene": SCENE, "data": points, "over": OVER} | changed))
    with pytest.raises(shearbed.SceneError, match="count"):
        shearbed.fit({"particles": {"count": -1}}, points, OVER)


def test_ctrl_c_ends_a_fit_and_its_process(points: dict[str, np.ndarray]) -> None:
    long = shearbed.Scene(toml=SCENE.toml.replace("count = 20", "count = 2000"))
    threading.Timer(1.0, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        shearbed.fit(long, points, OVER, replicas=1000)
    assert time.monotonic() - start < 30
    children = Path(f"/proc/{os.getpid()}/task/{threading.get_native_id()}/children")
    assert not children.exists() or not children.read_text().split()


def test_ctrl_c_leaves_a_last_checkpoint(points: dict[str, np.ndarray], tmp_path: Path) -> None:
    kept, counts = tmp_path / "runs", []
    long = shearbed.Scene(toml=SCENE.toml.replace("count = 20", "count = 500"))

    def stop(done: int, of: int) -> None:
        counts.append(done)
        if done > 20:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        shearbed.fit(long, points, OVER, replicas=40, checkpoint=kept, progress=stop)
    first = counts[-1]
    counts.clear()
    shearbed.fit(long, points, OVER, replicas=40, checkpoint=kept, progress=lambda done, of: counts.append(done))
    assert counts[0] >= first > 20, (first, counts[:3])


def test_columns_without_names_and_values_that_were_not_measured():
    with pytest.raises(ValueError, match='needs them: columns='):
        shearbed.fit("fig4-n50", np.ones((3, 3)))
    some = {"t_over_T": [0.25, 0.5, 0.75], "x1": [0.2, None, 0.2], "x1_u": 0.05}
    found = shearbed.fit("fig4-n50", some, replicas=20, rods=50)
    assert list(found.residuals["time"]) == [0.25, 0.75]
    assert "--" not in "".join(found.warnings)
