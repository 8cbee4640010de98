#!/usr/bin/env python3
"""Makes the samples in layouts/ from exported problems: record.py REF [DIR with fiberpy's package].

fiberoripy.csv and fiberpy.csv are made by these programs; openfoam.csv and lammps.dump are the certified answers, written
as the programs' documentation says (the addresses are in docs/src/user/grading.md).
"""

import csv
import json
import sys
from pathlib import Path

import numpy as np

here, reference = Path(__file__).parent / "layouts", Path(sys.argv[1])
sys.path[:0] = sys.argv[2:3]


def problem(name):
    folder = reference / name
    with open(folder / "certified.csv") as file:
        rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    return json.loads((folder / "problem.json").read_text()), rows


tensor, rows = problem("isotropic-3")
L, times, r_e = np.array(tensor["gradient_per_s"]), np.array(tensor["times_s"]), tensor["aspect_ratio"]

from fiberoripy_peer import tensors

found = tensors(L, r_e, np.eye(3) / 3, times, "IBOF", 1e-10)
np.savetxt(here / "fiberoripy.csv", np.column_stack([times, found]), delimiter=",")

from fiberpy.orientation import fiber_orientation
from fiberpy.tensor import Mat2

# fiberpy's shear rate is fixed by L; ci = 0 is Jeffery's equation. Its solver starts at the first time.
found = fiber_orientation(np.eye(3) / 3, np.append(0.0, times), L, 0.0, r_e, closure="orthotropic", rtol=1e-8, atol=1e-8)
found = [Mat2(a.reshape(3, 3)) for a in found.T[1:]]
np.savetxt(here / "fiberpy.csv", np.column_stack([times, found]), delimiter=",")

with open(here / "openfoam.csv", "w") as file:
    print("time", *(f"A2_{k}" for k in range(6)), sep=",", file=file)
    for row in rows:
        print(row["time_s"], *(row[name] for name in "a11 a12 a13 a22 a23 a33".split()), sep=",", file=file)

rods, rows = problem("shear-plane")
with open(here / "lammps.dump", "w") as file:
    for time in sorted({row["time_s"] for row in rows}):
        print(f"ITEM: TIME\n{time!r}\nITEM: TIMESTEP\n{round(time * 1000)}\nITEM: NUMBER OF ATOMS\n{len(rows) // len(rods['times_s'])}", file=file)
        print("ITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\nITEM: ATOMS id type shapex shapey shapez quatw quati quatj quatk", file=file)
        # LAMMPS does not sort atoms. The rod's axis is z of the body: the shortest turn from z to p.
        for row in reversed([row for row in rows if row["time_s"] == time]):
            p = np.array([row["p1"], row["p2"], row["p3"]])
            q = np.append(1 + p[2], np.cross([0, 0, 1], p))
            print(int(row["rod"]) + 1, 1, 1.0, 1.0, 11.6, *(q / np.linalg.norm(q)).tolist(), file=file)
