"""A template: put your own method in place of `advance`, and have it graded.

    shearbed grade --protocol text --command "python3 my_code.py"

A request is one line of numbers: id, du_i/dx_j row by row, r_e, the time in s, the number of steps or 0, the tolerance or 0,
the number of rods, and p1 p2 p3 of each. The answer is the id and p1 p2 p3 of each rod at that time, or "ID error REASON".
See docs/src/user/grading.md. Python functions are graded without any of this by the package: shearbed.grade(my_function).
"""

import sys


def rate(A, p):
    Ap = [sum(a * x for a, x in zip(row, p)) for row in A]
    along = sum(x * y for x, y in zip(p, Ap))
    return [y - x * along for x, y in zip(p, Ap)]


def advance(L, r, time, steps, p):
    """YOUR METHOD: p after `steps` equal steps to `time`. Here: RK4 of p' = Ap - p (p.Ap), A = W + Lambda D."""
    A = [[(r * r * L[i][j] - L[j][i]) / (r * r + 1) for j in range(3)] for i in range(3)]
    h = time / steps
    for _ in range(steps):
        k = [rate(A, p)]
        for part in (h / 2, h / 2, h):
            k.append(rate(A, [x + part * v for x, v in zip(p, k[-1])]))
        p = [x + h / 6 * (a + 2 * b + 2 * c + d) for x, a, b, c, d in zip(p, *k)]
    return p


for line in sys.stdin:
    words = line.split()
    x = [float(word) for word in words[1:]]
    L, r, time, steps, rods = [x[0:3], x[3:6], x[6:9]], x[9], x[10], int(x[11]), int(x[13])
    if steps == 0:
        print(words[0], "error it takes steps, no tolerance", flush=True)
        continue
    ends = [advance(L, r, time, steps, x[14 + 3 * n : 17 + 3 * n]) for n in range(rods)]
    print(words[0], *(repr(value) for p in ends for value in p), flush=True)
