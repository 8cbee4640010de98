#!/usr/bin/env python3
"""fiberoripy 1.4.0 (PyPI) on the reference problems, as its users would run it: DOP853 of SciPy over its Jeffery model.

    fiberoripy_peer.py REF MINE    rods: answer.csv; isotropic tensors: fiberoripy's own tables, headless t, A row by row
    fiberoripy_peer.py --live      answers requests with a tolerance, lines of JSON

One rod is the tensor pp, for which the quadratic closure A_ijkl = a_ij a_kl is exact; p is its eigenvector. For isotropic
tensors the closure is --closure NAME (default IBOF), so their error is the closure's.
"""

import csv
import json
import sys
from pathlib import Path

import numpy as np
from fiberoripy.closures import compute_closure
from fiberoripy.orientation import (
    ard_rsc_ode,
    folgar_tucker_ode,
    iard_ode,
    integrate_ori_ode,
    jeffery_ode,
    mrd_ode,
    pard_ode,
    rsc_ode,
)
from scipy.integrate import solve_ivp


def tensors(gradient, r_e, a0, times, closure, tolerance):
    """a at the times (rows of nine), as fiberoripy's examples compute it. SciPy's own error where it gives up."""
    L = np.array(gradient, dtype=float)
    times = np.array(times, dtype=float)
    found = solve_ivp(
        integrate_ori_ode,
        (0.0, times[-1]),
        np.array(a0, dtype=float).ravel(),
        t_eval=times,
        method="DOP853",
        rtol=tolerance,
        atol=tolerance,
        args=(lambda t: L, lambda a: compute_closure(a, closure), jeffery_ode, {"xi": (r_e**2 - 1) / (r_e**2 + 1)}),
    )
    if not found.success:
        raise RuntimeError(found.message)
    return found.y.T


def direction(a):
    values, vectors = np.linalg.eigh(0.5 * (a + a.T))
    return vectors[:, np.argmax(values)]


def rod(gradient, r_e, p, times, tolerance):
    a0 = np.outer(p, p)
    return [direction(a.reshape(3, 3)) for a in tensors(gradient, r_e, a0, times, "QUADRATIC", tolerance)]


SIX = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]
CLOSURES = {"linear": "LINEAR", "quadratic": "QUADRATIC", "hybrid": "HYBRID", "orw": "ORW", "ibof": "IBOF"}
MODELS = {
    "folgar-tucker": (folgar_tucker_ode, lambda c_i: {"Ci": c_i}),
    "rsc": (rsc_ode, lambda c_i, kappa: {"Ci": c_i, "kappa": kappa}),
    "iard": (iard_ode, lambda c_i, c_m: {"Ci": c_i, "Cm": c_m}),
    "pard": (pard_ode, lambda c_i, omega: {"Ci": c_i, "Omega": omega}),
    "mrd": (mrd_ode, lambda c_i, d: {"Ci": c_i, "D1": d[0], "D2": d[1], "D3": d[2]}),
    "phelps-tucker": (ard_rsc_ode, lambda b, kappa: {f"b{k + 1}": b for k, b in enumerate(b)} | {"kappa": kappa}),
}


def formula(asked, row):
    """The answer to a row of a formula; nothing where fiberoripy has no such closure."""
    if asked["of"] == "pdot":
        p, L, r_e = row[:3], row[3:12].reshape(3, 3), row[12]
        W, D = 0.5 * (L - L.T), 0.5 * (L + L.T)
        rate = jeffery_ode(np.outer(p, p), np.einsum("i,j,k,l", p, p, p, p), D, W, (r_e**2 - 1) / (r_e**2 + 1))
        # d(pp)/dt p = ṗ + p (p·ṗ), and ṗ is normal to p.
        return rate @ p
    if asked["closure"] not in CLOSURES:
        return None
    a = np.empty((3, 3))
    for (i, j), x in zip(SIX, row):
        a[i, j] = a[j, i] = x
    A = compute_closure(a, CLOSURES[asked["closure"]])
    if asked["of"] == "closure":
        return [A[SIX[m] + SIX[n]] for m in range(6) for n in range(m, 6)]
    L, r_e = row[6:15].reshape(3, 3), row[15]
    ((name, parameters),) = asked["model"].items()
    ode, words = MODELS[name]
    rate = ode(a, A, 0.5 * (L + L.T), 0.5 * (L - L.T), (r_e**2 - 1) / (r_e**2 + 1), **words(**parameters))
    return [rate[place] for place in SIX]


def files(reference, mine, closure):
    for file in sorted(reference.glob("*/problem.json")):
        problem = json.loads(file.read_text())
        gradient, r_e, times = problem["gradient_per_s"], problem["aspect_ratio"], problem["times_s"]
        folder = mine / problem["name"]
        if "rotation_rad_per_s" in problem:
            continue  # it takes steady flows
        if problem["kind"] == "rods":
            with open(file.parent / "start.csv") as start:
                rods = [[float(row[f"p{i}"]) for i in (1, 2, 3)] for row in csv.DictReader(start)]
            found = [rod(gradient, r_e, p, times, 1e-12) for p in rods]
            folder.mkdir(parents=True, exist_ok=True)
            with open(folder / "answer.csv", "w") as answer:
                print("time_s,rod,p1,p2,p3", file=answer)
                for k, time in enumerate(times):
                    for number, of_rod in enumerate(found):
                        print(time, number, *map(repr, map(float, of_rod[k])), sep=",", file=answer)
        elif problem["kind"] == "formula":
            rows = np.loadtxt(file.parent / "inputs.csv", delimiter=",", skiprows=1)
            found = [formula(problem["formula"], row[1:]) for row in rows]
            if found[0] is not None:
                folder.mkdir(parents=True, exist_ok=True)
                table = np.column_stack([rows[:, 0], found])
                np.savetxt(folder / "answer.csv", table, delimiter=",", header=",".join(problem["columns"]), comments="")
        elif problem["kind"] == "tensor" and "closed" not in problem and problem["columns"][1:] == ["a11", "a22", "a33", "a12", "a13", "a23"]:
            found = tensors(gradient, r_e, np.eye(3) / 3, times, closure, 1e-10)
            folder.mkdir(parents=True, exist_ok=True)
            np.savetxt(folder / "answer.csv", np.column_stack([times, found]), delimiter=",")


def live():
    for line in sys.stdin:
        request = json.loads(line)
        answer = {"id": request["id"]}
        try:
            if "tolerance" not in request:
                raise RuntimeError("it chooses its own steps and takes a tolerance")
            ends = [
                rod(request["gradient_per_s"], request["aspect_ratio"], p, [request["end_s"]], request["tolerance"])
                for p in request["start"]
            ]
            answer["p"] = [end[0].tolist() for end in ends]
        except (RuntimeError, ValueError, AssertionError) as error:
            answer["error"] = f"{type(error).__name__}: {error}"
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    closure = sys.argv[sys.argv.index("--closure") + 1] if "--closure" in sys.argv else "IBOF"
    if "--live" in sys.argv:
        live()
    else:
        files(Path(sys.argv[1]), Path(sys.argv[2]), closure)
