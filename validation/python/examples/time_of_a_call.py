"""How long a call of run takes, and the program for the same scene: python time_of_a_call.py [PROGRAM]"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import shearbed

scene = shearbed.Scene(
    shear_rate_per_s=0.5, count=50, length_mm=0.72, aspect_ratio=11.6, orientation="isotropic", periods=1
)
program = sys.argv[1:] or [sys.executable, "-m", "shearbed"]


def least_ms(work, repeats):
    def once():
        start = time.perf_counter()
        work()
        return time.perf_counter() - start

    return 1e3 * min(once() for _ in range(repeats))


with tempfile.TemporaryDirectory() as folder:
    Path(folder, "scene.toml").write_text(scene.toml)
    run = [*program, "run", "scene.toml", "--out", "out", "--quiet", "--force"]
    print(f"shearbed.run(scene): {least_ms(lambda: shearbed.run(scene), 200):.2f} ms")
    print(f"{' '.join(run[len(program):])}: {least_ms(lambda: subprocess.run(run, cwd=folder, check=True), 20):.2f} ms")
    start = [*program, "--version"]
    print(f"starting the program: {least_ms(lambda: subprocess.run(start, check=True, capture_output=True), 20):.2f} ms")
