"""Problems for other people's test suites, scenes by name, and what results carry with them."""

from __future__ import annotations

import inspect
import re
import unittest
from typing import Any

import numpy as np
import pytest
import shearbed
import shearbed.testing
from numpy.typing import NDArray

Array = NDArray[np.float64]


def rhs(gradient_per_s: Array, aspect_ratio: float, p: Array) -> Array:
    shape = (aspect_ratio**2 - 1) / (aspect_ratio**2 + 1)
    d, w = (gradient_per_s + gradient_per_s.T) / 2, (gradient_per_s - gradient_per_s.T) / 2
    turned: Array = p @ w.T + shape * (p @ d - p * np.einsum("ni,ij,nj->n", p, d, p)[:, None])
    return turned


@pytest.mark.parametrize("problem", shearbed.testing.problems()[:3], ids=str)
def test_a_right_function_passes(problem: shearbed.Problem) -> None:
    problem.check(rhs)


def test_a_wrong_function_fails_in_the_grader_s_words() -> None:
    problem = next(one for one in shearbed.testing.problems() if str(one) == "mid-flip-11.6")
    with pytest.raises(AssertionError, match="(?s)mid-flip-11.6 +FAIL.*transpose") as error:
        problem.check(lambda gradient_per_s, aspect_ratio, p: rhs(gradient_per_s.T, aspect_ratio, p))
    # The folder is gone when this is read.
    assert "mid-flip-11.6/answer.csv" in str(error.value) and "shearbed-" not in str(error.value)
    names = [str(one) for one in shearbed.testing.problems()]
    assert "ten-thousand-periods" not in names and len(names) == len(set(names)) > 5
    with pytest.raises(ValueError, match="'moments'.*'rods' and 'formula' are allowed"):
        shearbed.testing.problems(kind="moments")


def test_a_function_may_refuse_a_problem() -> None:
    def only_couette(gradient_per_s: Array, aspect_ratio: float, p: Array) -> Array:
        if np.count_nonzero(gradient_per_s) != 1:
            raise NotImplementedError("simple shear only")
        return rhs(gradient_per_s, aspect_ratio, p)

    report = shearbed.grade(only_couette, names=["mid-flip-2", "planar-extension"])
    assert report and report["planar-extension"]["verdict"] == "REFUSED" and "simple shear only" in str(report)
    problem = next(one for one in shearbed.testing.problems() if str(one) == "planar-extension")
    with pytest.raises(unittest.SkipTest, match="planar-extension: NotImplementedError: simple shear only"):
        problem.check(only_couette)

    def broken(gradient_per_s: Array, aspect_ratio: float, p: Array) -> Array:
        raise RuntimeError("out of luck")

    with pytest.raises(AssertionError, match="out of luck"):
        problem.check(broken)


def dadt(gradient_per_s: Array, aspect_ratio: float, a: Array, model: dict[str, Any]) -> Array:
    """Folgar & Tucker with the quadratic closure."""
    shape = (aspect_ratio**2 - 1) / (aspect_ratio**2 + 1)
    d, w = (gradient_per_s + gradient_per_s.T) / 2, (gradient_per_s - gradient_per_s.T) / 2
    rate, c_i = np.sqrt(2 * np.sum(d * d)), model["folgar-tucker"]["c_i"]
    found: Array = w @ a - a @ w + shape * (d @ a + a @ d - 2 * a * np.sum(a * d)) + 2 * c_i * rate * (np.eye(3) - 3 * a)
    return found


def quadratic(a: Array) -> Array:
    found: Array = np.einsum("ij,kl->ijkl", a, a)
    return found


def linear(a: Array) -> Array:
    one, pairs = np.eye(3), ("ij,kl->ijkl", "ik,jl->ijkl", "il,jk->ijkl")
    ones = sum(np.einsum(pair, one, one) for pair in pairs)
    mixed = sum(np.einsum(pair, one, a) + np.einsum(pair, a, one) for pair in pairs)
    found: Array = mixed / 7 - ones / 35
    return found


@pytest.mark.parametrize(
    ("name", "right", "wrong", "named"),
    [
        ("pdot-rod", rhs, lambda gradient, r, p: rhs(gradient.T, r, p), "transposed gradient"),
        ("closure-quadratic", quadratic, linear, "linear"),
        ("closure-linear", linear, quadratic, "quadratic"),
        ("dadt-ft-quadratic", dadt, lambda gradient, r, a, model: dadt(gradient, -1 / r, a, model), "Λ"),
    ],
)
def test_a_formula_is_graded_row_by_row(name: str, right: Any, wrong: Any, named: str) -> None:
    problem = next(one for one in shearbed.testing.problems(kind="formula") if one.name == name)
    assert problem.formula and problem.inputs and len(problem.inputs["row"]) >= 30
    problem.check(right)
    with pytest.raises(AssertionError, match=f"(?s){name} +FAIL.*{named}"):
        problem.check(wrong)


def test_a_function_that_is_no_formula_is_told_what_is_asked() -> None:
    with pytest.raises(TypeError, match=r"row 0: \(3, 3\) is asked for, not \(3,\)"):
        shearbed.grade(lambda gradient, r, a: a[0], names=["dadt-ft-linear"])
    with pytest.raises(ValueError, match="order = 4: a formula has none"):
        shearbed.grade(quadratic, names=["closure-quadratic"], order=4)
    with pytest.raises(ValueError, match="problems about rods and formulas"):
        shearbed.grade(rhs, names=["pdot-rod", "mid-flip-2"])


def test_a_built_in_scene_has_a_name() -> None:
    assert "fig4-n50" in shearbed.scenes()
    found = shearbed.run("fig4-n50", replicas=2)
    same = shearbed.run(shearbed.Scene(built_in="fig4-n50"), replicas=2)
    assert np.array_equal(found.x1, same.x1) and found.replicas == 2
    with pytest.raises(ValueError, match="fig4n50: no built-in scene has this name; did you mean fig4-n50"):
        shearbed.run("fig4n50")
    with pytest.raises(FileNotFoundError):
        shearbed.run("mine.toml")


def test_help_lists_the_keys() -> None:
    text = shearbed.Scene.__doc__ or ""
    for _, name, meaning, *_ in shearbed._core.keys():
        assert f"\n    {name}\n        {meaning}" in text, name
        assert name in inspect.signature(shearbed.Scene).parameters, name
    assert all(len(repr(problem)) < 200 for problem in shearbed.problems())


def test_reference_takes_any_times() -> None:
    spaced = shearbed.reference(11.6, times=(0, 1, 5))
    listed = shearbed.reference(11.6, times=[1, 0.25, 0.25])
    assert np.array_equal(listed["x1"], spaced["x1"][[4, 1, 1]])
    array = shearbed.reference(11.6, times=np.linspace(0, 1, 5))
    assert all(np.array_equal(array[name], spaced[name]) for name in spaced)


def test_reference_of_diffusing_rods() -> None:
    steady = shearbed.reference(np.inf, c_i=0.0311, times=[0, 10], steady=True)
    assert list(steady["strain"]) == [0, 10, np.inf]
    assert steady["a22"][0] == pytest.approx(1 / 3) and 0.5 < steady["a22"][1] < 1
    only = shearbed.reference(np.inf, c_i=0.0311, steady=True, fourth=True)
    assert only["a2222"] < steady["a22"][-1]


def test_a_sweep_gives_all_times_and_says_how_far_it_is() -> None:
    calls: list[tuple[int, int]] = []
    given: dict[str, Any] = {"replicas": 2, "seed": 5, "set": {"time.periods": 1}}
    over = {"interaction.alpha": [0.2, 0.6]}
    every = shearbed.sweep("fig4-n50", over, times="all", progress=lambda done, of: calls.append((done, of)), threads=1, **given)
    last = shearbed.sweep("fig4-n50", over, **given)
    ends = np.flatnonzero(np.r_[np.diff(every["t_over_T"]) < 0, True])
    assert len(ends) == 2 and calls[-1] == (2, 2)
    for name, values in every.items():
        assert np.array_equal(values[ends], last[name]), name
    # One value a point.
    derived = re.compile("x[123]_(damping_(rate(_se)?|from|to)|steady(_se|_from)?)|collisions_per_rod_and_period(_se)?")
    assert all(derived.fullmatch(name) for name in set(last) - set(every)) and {"x1", "x3_se"} <= set(every)
    extremes = shearbed.sweep("fig4-n50", over, times="extremes", **(given | {"replicas": 20}))
    assert set(extremes["interaction.alpha"]) == {0.2, 0.6} and np.nanmax(extremes["x1_amplitude"]) > 0.1
    with pytest.raises(ValueError, match="times = 'first'"):
        shearbed.sweep("fig4-n50", over, times="first")


def test_no_message_names_a_folder_that_is_gone() -> None:
    for wrong in (
        lambda: shearbed.sweep("fig4-n50", {"interaction.alpha": [-1]}),
        lambda: shearbed.fit("fig4-n50", {"t_over_T": [1], "x1": [2], "x1_u": [0.1]}, {"interaction.alpha": (0.1, 1)}),
        lambda: shearbed.reference(11.6, times=[0, 1], start=(0, 181)),
    ):
        with pytest.raises(ValueError) as error:
            wrong()
        assert "shearbed-" not in str(error.value) and "/" not in str(error.value).split(":")[0], error.value


def test_an_xarray_has_units_seed_and_scene() -> None:
    pytest.importorskip("xarray", reason="xarray is not here")
    results = shearbed.run("fig4-n50", replicas=2, seed=7)
    found = results.to_xarray()
    assert np.array_equal(found["x1"].values, results.x1) and np.array_equal(found["x1_se"].values, results.x1_se)
    assert found["time_s"].attrs["units"] == "s" and found.attrs["seed"] == 7 and found.attrs["replicas"] == 2
    assert "Fig. 4" in found.attrs["scene"]
    assert found["x1"].attrs["units"] == "1"
    rods = dict(count=10, length_mm=1, aspect_ratio=10, orientation="isotropic", alpha=0.5, concentration_per_cm3=50, shear_rate_per_s=1)
    stress = shearbed.run(dict(title="t", periods=1, viscosity_pa_s=2, observables=["stress"], **rods)).to_xarray()
    assert stress["s12_pa"].attrs["units"] == "Pa" and float(stress["s12_pa"][0]) > 0
    strained = shearbed.run("extension", replicas=1).to_xarray()
    assert "strain" in strained.dims


def test_a_plot_names_what_it_shows() -> None:
    matplotlib = pytest.importorskip("matplotlib", reason="matplotlib is not here")
    matplotlib.use("Agg")
    results = shearbed.run("fig4-n50", replicas=2)
    drawn = results.plot("x1")
    assert drawn.get_ylabel() == results.labels["projections"]
    assert drawn.get_legend().get_texts()[0].get_text() == "X̄₁"
    results.plot(["x1", "x2"], ax=drawn, label="again")
    assert drawn.get_legend().get_texts()[-1].get_text() == "again, X̄₂"
    with pytest.raises(AttributeError, match="x9: this run has the channels x1"):
        results.plot("x9")


def test_reference_follows_flows_one_after_another() -> None:
    steps = [(3.0, 1.0), (1.0, 0.0), (9.0, [[0, 0, 0], [-1, 0, 0], [0, 0, 0]])]
    values = shearbed.reference(10, d_r_per_s=0.1, steps=steps, times=[3, 4], optics=True)
    shares = values["a22"] - 1 / 3
    assert shares[1] / shares[0] == pytest.approx(np.exp(-0.6), abs=1e-10)
    tangent = 2 * values["a12"] / (values["a22"] - values["a11"])
    assert np.tan(2 * np.radians(values["extinction_angle_deg"])) == pytest.approx(tangent, abs=1e-8)
    turned = shearbed.reference(10, d_r_per_s=0.1, oscillation_period_s=4.0, times=[1.0])
    assert turned["a12"][0] == pytest.approx(0.0798814845, abs=1e-9)
    several = shearbed.reference(10, d_r_per_s=0.1, start=[[1, 0, 0], [0, 2, 0]], times=[0])
    assert several["a22"][0] == pytest.approx(0.5)
    start = shearbed.reference(10, d_r_per_s=0.1, start=(0.4, 0.5, 0.1, 0.05, 0, 0), times=[0])
    assert start["a12"][0] == 0.05 and start["a33"][0] == 0.1
