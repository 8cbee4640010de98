"""Reference values, problems, and the grading of Python functions."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

import shearbed

Array = NDArray[np.float64]
NAMES = ["mid-flip-2", "mid-flip-11.6"]


def rate(gradient: Array, aspect_ratio: float, p: Array) -> Array:
    shape = (aspect_ratio**2 - 1) / (aspect_ratio**2 + 1)
    a = 0.5 * (1 + shape) * gradient - 0.5 * (1 - shape) * gradient.T
    turned: Array = p @ a.T
    return turned - p * np.einsum("ni,ni->n", p, turned)[:, None]


def rk4(gradient: Array, aspect_ratio: float, p: Array, dt: float) -> Array:
    k1 = rate(gradient, aspect_ratio, p)
    k2 = rate(gradient, aspect_ratio, p + 0.5 * dt * k1)
    k3 = rate(gradient, aspect_ratio, p + 0.5 * dt * k2)
    k4 = rate(gradient, aspect_ratio, p + dt * k3)
    return p + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)


def euler(gradient: Array, aspect_ratio: float, p: Array, dt: float) -> Array:
    return p + dt * rate(gradient, aspect_ratio, p)


def test_rk4_is_of_order_4_and_passes() -> None:
    report = shearbed.grade(rk4, kind="step", order=4, names=NAMES)
    assert report, str(report)
    for problem in report.problems:
        assert problem["verdict"] == "PASS" and abs(problem["observed_order"] - 4) < 0.3
        assert problem["diagnosis"] is None
    assert "PASS" in str(report)


def test_euler_is_of_order_1_and_fails() -> None:
    report = shearbed.grade(euler, kind="step", order=4, steps=(500, 1000, 2000), names=NAMES)
    assert not report
    assert all(problem["verdict"] == "FAIL" for problem in report.problems)
    assert abs(report["mid-flip-2"]["observed_order"] - 1) < 0.3


def test_steps_are_refined_until_a_right_method_is_within_the_tolerance() -> None:
    # The disc's orders come to 4 slowly, and the long rod needs more steps than others.
    report = shearbed.grade(rk4, order=4, names=["disc-0.1", "mid-flip-100"], timeout_s=1e5)
    assert report, str(report)
    assert all(problem["order_found"] == "seen" for problem in report.problems), str(report)


def test_a_lower_order_fails_and_too_little_time_does_not() -> None:
    report = shearbed.grade(euler, order=4, names=["mid-flip-2"], steps=(500, 1000, 2000, 4000))
    assert report["mid-flip-2"]["verdict"] == "FAIL" and report["mid-flip-2"]["order_found"] == "lower"
    report = shearbed.grade(euler, names=["mid-flip-2"], timeout_s=1e-6)
    assert report["mid-flip-2"]["verdict"] == "NOT REACHED" and not report
    assert "timeout_s" in report["mid-flip-2"]["note"] and report["mid-flip-2"]["error"] > 0
    report = shearbed.grade(euler, names=["mid-flip-2"], tolerance=0.01, timeout_s=1e5)
    assert report and report["mid-flip-2"]["tolerance"] == 0.01, str(report)


def test_a_transposed_gradient_is_named() -> None:
    report = shearbed.grade(
        lambda gradient, r, p, dt: rk4(gradient.T, r, p, dt), kind="step", steps=(2000,), names=["mid-flip-11.6"]
    )
    assert not report
    assert "transposed" in report["mid-flip-11.6"]["diagnosis"]


def test_an_exact_solver_passes_every_problem_of_free_rods() -> None:
    def exact(gradient: Array, r: float, start: Array, times: Array, steps: int) -> Array:
        # The certified answers themselves: what a perfect solver gives.
        for problem in shearbed.problems():
            if problem.kind == "rods" and np.array_equal(problem.gradient_per_s, gradient) and problem.aspect_ratio == r \
                    and np.array_equal(problem.start, start) and np.array_equal(problem.times_s, times):
                columns = [problem.certified[name] for name in ("p1", "p2", "p3")]
                return np.stack(columns, axis=1).reshape(len(times), len(start), 3)
        raise AssertionError("a problem that is not among the problems")

    report = shearbed.grade(exact, steps=(1,))
    assert report and all(problem["verdict"] == "PASS" for problem in report.problems), str(report)


def test_a_function_that_fails_has_no_answer_and_a_wrong_shape_is_said() -> None:
    def fails(*_: object) -> Array:
        raise ZeroDivisionError

    for kind in ("rhs", "step", "solver"):
        report = shearbed.grade(fails, kind=kind, names=["mid-flip-2"])
        assert not report and report["mid-flip-2"]["verdict"] == "MISSING"
        assert "ZeroDivisionError" in report["mid-flip-2"]["raised"] and "ZeroDivisionError" in str(report)
        assert report["mid-flip-2"]["note"] is None
    with pytest.raises(TypeError, match="times, rods, 3"):
        shearbed.grade(lambda *_: np.zeros(3), kind="solver", names=["mid-flip-2"])
    for kind in ("rhs", "step"):
        with pytest.raises(TypeError, match="rods, 3"):
            shearbed.grade(lambda *_: np.zeros(3), kind=kind, names=["mid-flip-2"])
    with pytest.raises(ValueError, match="mid-flip-2"):
        shearbed.grade(rk4, names=["mid-flop"])
    with pytest.raises(ValueError, match="'rhs', 'step' and 'solver'"):
        shearbed.grade(fails, kind="flow")
    with pytest.raises(ValueError, match="kind='rhs'"):
        shearbed.grade(fails, names=["mid-flip-2"])
    with pytest.raises(ValueError, match="order = 4"):
        shearbed.grade(rate, order=4)


def test_patterns_ask_for_problems_and_without_names_a_formula_is_told_how() -> None:
    report = shearbed.grade(rate, names=["pdot-*", "pdot-rod"])
    assert report and len(report.problems) > 3
    assert all(problem["name"].startswith("pdot-") for problem in report.problems), str(report)
    with pytest.raises(ValueError, match="mid-flop"):
        shearbed.grade(rk4, names=["mid-flip-2", "mid-flop-*"])
    with pytest.raises(ValueError, match=r"names=\['closure-\*'\]"):
        shearbed.grade(lambda a: np.einsum("ij,kl->ijkl", a, a))
    # A flow that turns is not asked of a function that is given one gradient.
    with pytest.raises(ValueError, match="turning-axes-5"):
        shearbed.grade(rk4, names=["turning-axes-5"])


def test_both_triangles_of_a_tensor_are_read() -> None:
    def quadratic(a: Array) -> Array:
        return np.einsum("ij,kl->ijkl", a, a)

    def lower(a: Array) -> Array:
        # Right in every entry that is a column of the answer.
        spoilt = quadratic(a)
        spoilt[1, 0, 2, 2] += 0.1
        return spoilt

    report = shearbed.grade(quadratic, names=["closure-quadratic"])
    assert report, str(report)
    found = shearbed.grade(lower, names=["closure-quadratic"])["closure-quadratic"]
    assert found["verdict"] == "FAIL" and found["error"] <= found["tolerance"], found
    assert "row 0: a" in found["diagnosis"] and " but a" in found["diagnosis"], found


def test_work_against_precision_is_that_of_the_method() -> None:
    def counted(gradient: Array, r: float, p: Array, dt: float) -> Array:
        counted.evaluations += 4  # type: ignore[attr-defined]
        return rk4(gradient, r, p, dt)

    counted.evaluations = 0  # type: ignore[attr-defined]
    found = shearbed.grade(counted, names=NAMES, steps=(512, 1024, 2048)).work_precision()
    assert list(found["problem"]) == [name for name in sorted(NAMES) for _ in range(3)]
    assert list(found["steps"]) == [512, 1024, 2048] * 2
    # As many steps as asked, but for the rounding of each of three times' shares.
    assert (abs(found["evaluations"] - 4 * found["steps"]) <= 4 * 3).all(), found
    # 512 steps are few for the longer rod.
    assert (abs(np.log2(found["error"][1::3] / found["error"][2::3]) - 4) < 0.3).all(), found
    assert (found["seconds"] > 0).all() and (found["seconds"][2::3] > found["seconds"][::3]).all(), found
    assert np.isnan(shearbed.grade(rk4, names=["mid-flip-2"], steps=(64,)).work_precision()["evaluations"]).all()
    with pytest.raises(ValueError, match="work_precision"):
        shearbed.grade(rate, names=["mid-flip-2"]).work_precision()


def test_a_right_hand_side_is_judged_as_it_is() -> None:
    report = shearbed.grade(rate)
    assert len(report.problems) > 10
    assert report and all(problem["verdict"] == "PASS" for problem in report.problems), str(report)
    # Controls: the mistakes that are made, one of a hundredth of a percent, and no motion at all.
    wrong = {
        "transposed": lambda gradient, r, p: rate(gradient.T, r, p),
        "shape": lambda gradient, r, p: rate(gradient, 1.0001 * r, p),
        "no motion": lambda gradient, r, p: 0 * p,
    }
    for name, mistaken in wrong.items():
        report = shearbed.grade(mistaken, names=["mid-flip-11.6"])
        assert not report and report["mid-flip-11.6"]["verdict"] == "FAIL", name
    runaway = shearbed.grade(lambda gradient, r, p: 1e3 * p, names=["mid-flip-2"])
    assert not runaway and runaway["mid-flip-2"]["verdict"] == "FAIL"
    assert "cannot be followed" in runaway["mid-flip-2"]["raised"]


def test_a_kind_is_seen_from_the_parameters() -> None:
    assert shearbed.grade(rk4, order=4, names=NAMES)
    assert not shearbed.grade(euler, names=["mid-flip-2"], steps=(250, 500))

    def solver(gradient: Array, r: float, start: Array, times: Array, steps: int, *, theta: float = 1.0) -> Array:
        return np.broadcast_to(start, (len(times), len(start), 3))

    assert not shearbed.grade(solver, names=["mid-flip-2"])


def test_an_answer_that_is_no_number_does_not_pass() -> None:
    report = shearbed.grade(
        lambda gradient, r, start, times, steps: np.full((len(times), len(start), 3), np.nan), names=["mid-flip-2"]
    )
    assert not report and report["mid-flip-2"]["verdict"] == "FAIL"


def test_reference_values_are_those_of_the_closed_form() -> None:
    r, phi, theta = 11.6, np.radians(10.0), np.radians(60.0)
    values = shearbed.reference(r, start=(10, 60), times=(0, 1, 9))
    p = np.array([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])
    turn = 2 * np.pi * values["t_over_T"]
    q = np.stack([
        p[0] * np.cos(turn) - p[1] / r * np.sin(turn),
        r * p[0] * np.sin(turn) + p[1] * np.cos(turn),
        np.full_like(turn, p[2]),
    ])
    q /= np.linalg.norm(q, axis=0)
    for k in range(3):
        assert np.allclose(values[f"p{k + 1}"], q[k], atol=1e-13)
    with pytest.raises(ValueError, match="1e100"):
        shearbed.reference(0.0, times=(0, 1, 2))


def test_problems_have_answers() -> None:
    names = [problem.name for problem in shearbed.problems()]
    assert {"mid-flip-2", "mid-flip-11.6", "mid-flip-100", "mid-flip-10000"} <= set(names)
    problem = next(problem for problem in shearbed.problems() if problem.name == "mid-flip-2")
    assert problem.start.shape[1] == 3 and problem.tolerance > 0
    assert len(problem.certified["p1"]) == len(problem.times_s) * len(problem.start)
