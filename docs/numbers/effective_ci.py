"""C_I, X̄₁, ⟨pp⟩ and the rods' stress of interacting rods: the tables of docs/src/theory/coefficients.md.

    python3 docs/numbers/effective_ci.py shearbed FOLDER [steps|suspensions]

The first argument is the program. FOLDER keeps the runs, so an interrupted job goes on. Each row is 8 seeds of 12 replicas of
100 rods; errors are jackknife standard errors over the seeds. It shares no code with `shearbed bench --case folgar-tucker`.
"""

import csv
import math
import pathlib
import subprocess
import sys

SCENE = """title = "effective C_I"
flow.shear_rate_per_s = 0.5
particles = {{ count = 100, length_mm = 1, aspect_ratio = {r}, orientation = "isotropic" }}
interaction = {{ concentration_per_cm3 = {n}, alpha = {alpha}, update = "{update}" }}
time = {{ periods = {periods}, outputs_per_period = 100, steps_per_period = {steps} }}
ensemble.replicas = 12
output.observables = ["projections", "orientation_tensor", "orientation_tensor_4"]
"""
SEEDS = range(1, 9)
AXES = range(3)
SPIN = [[0, -0.5, 0], [0.5, 0, 0], [0, 0, 0]]
STRAIN = [[0, 0.5, 0], [0.5, 0, 0], [0, 0, 0]]

# (n a³, r_e, α, steps a period)
BASE = (0.2, 11.6, 0.5, 200)
STEPS = [(update, (*BASE[:3], 200 * k)) for k in (1, 2, 4, 8, 16, 32) for update in ("rotation", "angles", "kick")]
SUSPENSIONS = [("kick", (na3, r, alpha, 4 * steps)) for na3, r, alpha, steps in [
    BASE, (0.05, 11.6, 0.5, 200), (0.1, 11.6, 0.5, 200), (0.5, 11.6, 0.5, 200), (1, 11.6, 0.5, 200),
    (0.2, 5, 0.5, 100), (0.2, 20, 0.5, 600), (0.2, 30, 0.5, 1300), (0.2, 11.6, 0.25, 200), (0.2, 11.6, 1, 200), (0.2, 11.6, 2, 200),
]]


def run(program, folder, update, na3, r, alpha, steps, seed):
    """The folder of one run; half of its periods reach the steady state, the other half are the window."""
    out = folder / f"{update}-{na3}-{r}-{alpha}-{steps}-{seed}"
    if not (out / "run.json").exists():
        half = min(max(math.ceil(0.5 / (na3 * alpha)), 5), 50)
        scene = out.with_suffix(".toml")
        scene.write_text(SCENE.format(r=r, n=1000 * na3, alpha=alpha, update=update, periods=2 * half, steps=steps))
        subprocess.run([program, "run", scene, "--seed", str(seed), "--threads", "1", "--out", out, "--quiet"], check=True)
    return out


def window(out):
    """⟨pp⟩, ⟨pp p₁p₂⟩, the change of ⟨pp⟩ per unit of strain and X̄₁, over the second half of a run (trapezoidal rule)."""
    names = ("orientation_tensor", "orientation_tensor_4", "projections")
    second, fourth, first = (list(csv.DictReader(open(out / f"{name}.csv"))) for name in names)
    half = (len(second) - 1) // 2
    strain = float(second[-1]["strain"]) - float(second[half]["strain"])

    def mean(rows, name):
        values = [float(row[name]) for row in rows[half:]]
        return (sum(values) - 0.5 * (values[0] + values[-1])) / half

    def name(*axes):
        return "a" + "".join(str(axis + 1) for axis in sorted(axes))

    def tensor(entry):
        return [[entry(i, j) for j in AXES] for i in AXES]

    change = tensor(lambda i, j: (float(second[-1][name(i, j)]) - float(second[half][name(i, j)])) / strain)
    return tensor(lambda i, j: mean(second, name(i, j))), tensor(lambda i, j: mean(fourth, name(i, j, 0, 1))), change, mean(first, "x1")


def product(x, y):
    return [[sum(x[i][k] * y[k][j] for k in AXES) for j in AXES] for i in AXES]


def dot(x, y):
    return sum(x[i][j] * y[i][j] for i in AXES for j in AXES)


def values(windows, r):
    """10⁴ C_I; the same of J's components 11, 22, 33 alone; relative residual; σ₁₂, N₁, N₂ over μ_fiber G;
    X̄₁; ⟨p₁p₁⟩, ⟨p₂p₂⟩, ⟨p₁p₂⟩."""
    x1 = sum(w[3] for w in windows) / len(windows)
    a, q, change = ([[sum(w[k][i][j] for w in windows) / len(windows) for j in AXES] for i in AXES] for k in range(3))
    shape = (r * r - 1) / (r * r + 1)
    terms = [product(SPIN, a), product(a, SPIN), product(STRAIN, a), product(a, STRAIN)]
    free = [[terms[0][i][j] - terms[1][i][j] + shape * (terms[2][i][j] + terms[3][i][j] - 2 * q[i][j]) for j in AXES] for i in AXES]
    gain = [[change[i][j] - free[i][j] for j in AXES] for i in AXES]
    diffusion = [[2 * ((i == j) - 3 * a[i][j]) for j in AXES] for i in AXES]
    c_i = dot(gain, diffusion) / dot(diffusion, diffusion)
    rest = [[gain[i][j] - c_i * diffusion[i][j] for j in AXES] for i in AXES]
    own = [1e4 * gain[k][k] / diffusion[k][k] for k in AXES]
    stress = [q[0][1], q[1][1] - q[0][0], q[0][0] - q[2][2]]
    return [1e4 * c_i, *own, math.sqrt(dot(rest, rest) / dot(gain, gain)), *stress, x1, a[0][0], a[1][1], a[0][1]]


def row(program, folder, update, suspension):
    windows = [window(run(program, folder, update, *suspension, seed)) for seed in SEEDS]
    r, count = suspension[1], len(windows)
    found = values(windows, r)
    without = [values(windows[:k] + windows[k + 1:], r) for k in range(count)]
    errors = []
    for k in range(len(found)):
        mean = sum(w[k] for w in without) / count
        errors.append(math.sqrt((count - 1) / count * sum((w[k] - mean) ** 2 for w in without)))
    digits = [2, 2, 2, 2, 2, 5, 5, 5, 5, 5, 5, 5]
    cells = [f"{value:.{d}f} ± {error:.{d}f}" for value, error, d in zip(found, errors, digits)]
    na3, _, alpha, steps = suspension
    print(f"| {update} | {na3} | {r} | {alpha} | {steps} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    program, folder, which = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3:] or ["steps", "suspensions"]
    folder.mkdir(parents=True, exist_ok=True)
    print("| update | n a³ | r_e | α | steps a period | 10⁴ C_I | of 11 | of 22 | of 33 | residual | σ₁₂ | N₁ | N₂ | X̄₁ | a₁₁ | a₂₂ | a₁₂ |")
    print("|" + " --- |" * 17)
    for update, suspension in [*(STEPS if "steps" in which else []), *(SUSPENSIONS if "suspensions" in which else [])]:
        row(program, folder, update, suspension)
