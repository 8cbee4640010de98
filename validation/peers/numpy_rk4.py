#!/usr/bin/env python3
"""Free rods with NumPy: RK4 of q' = A q in equal steps, p = q/|q|. With --euler explicit Euler: of p' = Ap - p (p.Ap) for
single rods, of q' = A q for means over isotropic ones.

    numpy_rk4.py REF MINE [--euler]    answers every problem of REF without diffusion in MINE/NAME/steps-N.csv
    numpy_rk4.py --live [--euler]      answers requests, lines of JSON, until its input ends

Needs numpy alone. Shares nothing with shearbed but the problems' files.
"""

import csv
import json
import math
import sys
from pathlib import Path

import numpy as np

EULER = "--euler" in sys.argv


def rate_matrix(gradient, r_e):
    """A = W + Lambda D with Lambda = (r_e^2 - 1)/(r_e^2 + 1), without its cancellation at large and small r_e."""
    L = np.array(gradient, dtype=float)
    return (r_e**2 * L - L.T) / (r_e**2 + 1)


def power(matrix, n):
    """matrix^n (of a stack, each) as a matrix and the logarithm of a factor, so that nothing overflows."""

    def scaled(matrix, log_factor):
        scale = np.abs(matrix).max(axis=(-2, -1), keepdims=True)
        return matrix / scale, log_factor + np.log(scale)

    result, base, log_result, log_base = np.eye(3), matrix, 0.0, 0.0
    while n:
        if n & 1:
            result, log_result = scaled(result @ base, log_result + log_base)
        base, log_base = scaled(base @ base, 2 * log_base)
        n >>= 1
    return result, log_result


def map_over(A, time, steps):
    """The map over time: one step of q' = A q is a polynomial in hA, and equal steps are its power."""
    hA, one = A * (time / steps), np.eye(3)
    step = one + hA if EULER else one + hA @ (one + hA / 2 @ (one + hA / 3 @ (one + hA / 4)))
    matrix, log_factor = power(step, steps)
    return matrix * np.exp(np.minimum(log_factor, 700.0))


def euler(A, start, time, steps):
    p, h = start.copy(), time / steps
    for _ in range(steps):
        Ap = p @ A.T
        p = p + h * (Ap - p * (p * Ap).sum(axis=1, keepdims=True))
    return p


def directions(gradient, r_e, start, time, steps):
    """The directions at time of rods that start so (rows p1, p2, p3)."""
    A, start = rate_matrix(gradient, r_e), np.array(start, dtype=float)
    if EULER:
        return euler(A, start, time, steps)
    q = start @ map_over(A, time, steps).T
    return q / np.linalg.norm(q, axis=1, keepdims=True)


def isotropic_means(F):
    """|p_i| and a_ij of directions F p0/|F p0| with p0 isotropic, for each F of a stack.

    p0 may be read as a normal vector's direction, so q = F p0 is normal with the covariance S = F F^T. With
    1/|q| = 2/sqrt(pi) int exp(-u^2 q.q) du and 1/q.q = int exp(-s q.q) ds all means are integrals of one variable, here
    by the double-exponential rule.
    """
    F = F / np.abs(np.linalg.det(F))[:, None, None] ** (1 / 3)
    V, s, _ = np.linalg.svd(F)
    s, W, tau = (s * s)[:, None, :], V.transpose(0, 2, 1), np.arange(-4.4, 4.4, 1 / 32)
    u = np.exp(math.pi / 2 * np.sinh(tau))
    weight = u * math.pi / 2 * np.cosh(tau) / 32
    damp = 1 + 2 * u[:, None] * s
    spread = s / damp / np.sqrt(damp.prod(axis=2, keepdims=True))
    a = V * (weight @ spread)[:, None, :] @ W
    damp = 1 + 2 * (u * u)[:, None] * s
    x = weight @ (np.sqrt((s / damp) @ (W * W)) / np.sqrt(damp.prod(axis=2, keepdims=True)))
    return 2 / math.pi * math.sqrt(2) * x, a


def tensor(problem, mine):
    """Means over isotropic rods, of one aspect ratio or of Gaussian ones (trapezoidal rule over +-8 deviations)."""
    mean, sd = problem["aspect_ratio"], problem.get("aspect_ratio_sd_percent", 0.0) / 100
    offsets = np.linspace(-8, 8, 801) if sd else np.zeros(1)
    weights = np.exp(-offsets**2 / 2)
    ratios = mean * (1 + sd * offsets)
    ratios, weights = ratios[ratios > 0], weights[ratios > 0] / weights[ratios > 0].sum()
    A = np.stack([rate_matrix(problem["gradient_per_s"], r_e) for r_e in ratios])
    for steps in doublings(problem):
        with open(mine / f"steps-{steps}.csv", "w") as file:
            print(",".join(problem["columns"]), file=file)
            for time in problem["times_s"]:
                share = max(math.ceil(steps * time / problem["times_s"][-1]), 1)
                x, a = isotropic_means(map_over(A, time, share))
                x, a = weights @ x, np.tensordot(weights, a, 1)
                axes = [[int(digit) - 1 for digit in name[1:]] for name in problem["columns"][1:]]
                values = [a[tuple(of)] if len(of) == 2 else x[of[0]] for of in axes]
                print(repr(time), *(f"{value:.17g}" for value in values), sep=",", file=file)


def doublings(problem):
    """Steps a problem: the finest of four is to have a quarter of the tolerance, by RK4's (wh)^4/120 a radian of phase."""
    time = problem["times_s"][-1]
    r_e = problem["aspect_ratio"]
    A = rate_matrix(problem["gradient_per_s"], r_e)
    if EULER:
        # Forty a unit of strain, 8000 at most: enough to read an order off, never enough for a tolerance.
        strain = np.linalg.norm(problem["gradient_per_s"]) * time
        return [math.ceil(share * min(max(40 * strain, 400), 8000)) for share in (0.25, 0.5, 1)]
    phase = max(np.abs(np.linalg.eigvals(A)).max() * time, 1.0)
    stretch = max(r_e, 1 / r_e)
    finest = phase * (stretch * phase * 4 / (120 * problem["tolerance"])) ** 0.25
    finest = 8 * max(math.ceil(finest / 8), 2)
    return [finest // 8, finest // 4, finest // 2, finest]


def rods(problem, folder, mine):
    with open(folder / "start.csv") as file:
        start = [[float(row[f"p{i}"]) for i in (1, 2, 3)] for row in csv.DictReader(file)]
    end = problem["times_s"][-1]
    for steps in doublings(problem):
        with open(mine / f"steps-{steps}.csv", "w") as file:
            print("time_s,rod,p1,p2,p3", file=file)
            for time in problem["times_s"]:
                # Steps of one length: each time has its share of them.
                share = max(math.ceil(steps * time / end), 1)
                found = directions(problem["gradient_per_s"], problem["aspect_ratio"], start, time, share)
                for rod, p in enumerate(found):
                    print(f"{time!r},{rod},{p[0]:.17g},{p[1]:.17g},{p[2]:.17g}", file=file)


def free_rate(gradient, r_e, p):
    """Jeffery's p' of a rod (A.1)."""
    Ap = rate_matrix(gradient, r_e) @ p
    return Ap - p * (p @ Ap)


def kicked(gradient, a, b):
    """p' of both rods in contact (A.7 to A.12): both contact points get the mean of their velocities along the line."""
    gradient = np.array(gradient, dtype=float)
    (x_a, p_a, r_a), (x_b, p_b, r_b) = a, b
    line = np.cross(p_a, p_b)
    line /= np.linalg.norm(line)
    # Where the rods' axes are nearest: x_a + s_a p_a and x_b + s_b p_b.
    s_a, s_b, _ = np.linalg.solve(np.column_stack([p_a, -p_b, line]), x_b - x_a)
    free = [free_rate(gradient, r_a, p_a), free_rate(gradient, r_b, p_b)]
    along = [line @ (gradient @ x_a + free[0] * s_a), line @ (gradient @ x_b + free[1] * s_b)]
    mean = (along[0] + along[1]) / 2
    return [f + line * ((mean - v) / s) for f, v, s in zip(free, along, (s_a, s_b))]


def angles(p, rate, step):
    """The rates of phi and theta (A.13, corrected), and both angles after a step (A.14)."""
    phi, theta = math.atan2(p[1], p[0]), math.atan2(math.hypot(p[0], p[1]), p[2])
    phi_rate = (-rate[0] * math.sin(phi) + rate[1] * math.cos(phi)) / math.sin(theta)
    theta_rate = (rate[0] * math.cos(phi) + rate[1] * math.sin(phi)) * math.cos(theta) - rate[2] * math.sin(theta)
    return [phi_rate, theta_rate, phi + phi_rate * step, theta + theta_rate * step]


def contact(problem, folder, mine):
    with open(folder / "inputs.csv") as file, open(mine / "answer.csv", "w") as answer:
        print(",".join(problem["columns"]), file=answer)
        for row in csv.DictReader(file):
            number = lambda rod, names: np.array([float(row[f"{rod}_{name}"]) for name in names.split()])
            pair = [
                (number(rod, "x1_mm x2_mm x3_mm"), number(rod, "p1 p2 p3"), float(row[f"{rod}_aspect_ratio"]))
                for rod in "ab"
            ]
            values = []
            for (_, p, _), rate in zip(pair, kicked(problem["gradient_per_s"], *pair)):
                step = problem.get("time_step_s")
                values += angles(p, rate, step) if step else list(rate)
            print(row["snapshot"], *(f"{value:.17g}" for value in values), sep=",", file=answer)


def pdot(problem, folder, mine):
    rows = np.loadtxt(folder / "inputs.csv", delimiter=",", skiprows=1)
    found = [free_rate(row[4:13].reshape(3, 3), row[13], row[1:4]) for row in rows]
    table = np.column_stack([rows[:, 0], found])
    np.savetxt(mine / "answer.csv", table, fmt="%.17g", delimiter=",", header=",".join(problem["columns"]), comments="")


def main():
    arguments = [word for word in sys.argv[1:] if not word.startswith("--")]
    if "--live" in sys.argv:
        return live()
    reference, mine = map(Path, arguments)
    for file in sorted(reference.glob("*/problem.json")):
        problem = json.loads(file.read_text())
        if {"c_i", "d_r_per_s", "closed", "rotation_rad_per_s"} & problem.keys() or problem.get("formula", {}).get("of", "pdot") != "pdot":
            continue  # rods with rotary diffusion, closures and flows that turn, which free rods in steady flow do not answer
        folder = mine / problem["name"]
        folder.mkdir(parents=True, exist_ok=True)
        if problem["kind"] == "rods":
            rods(problem, file.parent, folder)
        elif problem["kind"] == "tensor":
            tensor(problem, folder)
        elif problem["kind"] == "contact":
            contact(problem, file.parent, folder)
        elif problem["kind"] == "formula":
            pdot(problem, file.parent, folder)


def live():
    for line in sys.stdin:
        request = json.loads(line)
        answer = {"id": request["id"]}
        if "rotation_rad_per_s" in request:
            answer["error"] = "it takes a steady flow"
        elif "steps" in request:
            found = directions(
                request["gradient_per_s"], request["aspect_ratio"], request["start"], request["end_s"], request["steps"]
            )
            answer["p"] = found.tolist()
        else:
            answer["error"] = "it takes steps, no tolerance"
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    with np.errstate(all="ignore"):
        main()
