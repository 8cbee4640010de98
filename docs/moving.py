"""The moving picture of README: rods seen along the vorticity axis, beside the mean that they make.

python3 docs/moving.py RODS.CSV PROJECTIONS.CSV > rods.svg
RODS.CSV has outputs of one replica, evenly spaced, PROJECTIONS.CSV the means of many.
"""

import csv
import sys

COLUMNS, ROWS, CELL, HALF = 8, 5, 46, 20
SECONDS = 16
WIDTH, HEIGHT = 820, 270
LEFT, TOP, PLOT_WIDTH, PLOT_HEIGHT = 460, 40, 330, 180


def read(path):
    with open(path, newline="") as text:
        return list(csv.DictReader(text))


def animated(name, values):
    values = ";".join(f"{value:.1f}" for value in values)
    return f'<animate attributeName="{name}" dur="{SECONDS}s" repeatCount="indefinite" values="{values}"/>'


def rod(k, rows):
    """A line from end to end, projected on the plane of flow (to the right) and gradient (upwards)."""
    x, y = 30 + (k % COLUMNS + 0.5) * CELL, 22 + (k // COLUMNS + 0.5) * CELL
    p = [(HALF * float(row["p2"]), -HALF * float(row["p1"])) for row in rows]
    ends = {"x1": [x - u for u, _ in p], "y1": [y - v for _, v in p], "x2": [x + u for u, _ in p], "y2": [y + v for _, v in p]}
    first = " ".join(f'{name}="{values[0]:.1f}"' for name, values in ends.items())
    return f"<line {first}>" + "".join(animated(name, values) for name, values in ends.items()) + "</line>"


def main(rods_path, means_path):
    rods = {}
    for row in read(rods_path):
        rods.setdefault(int(row["rod"]), []).append(row)
    means = read(means_path)
    end = float(means[-1]["t_over_T"])
    x = [LEFT + PLOT_WIDTH * float(row["t_over_T"]) / end for row in means]
    y = [TOP + PLOT_HEIGHT * (1 - float(row["x1"]) / 0.5) for row in means]
    curve = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y))
    ticks = "".join(
        f'<text x="{LEFT + PLOT_WIDTH * t / end:.0f}" y="{TOP + PLOT_HEIGHT + 18}" text-anchor="middle">{t}</text>' for t in range(int(end) + 1)
    )
    print(
        f'<svg xmlns="http://www.w3.org/2000/svg" role="img" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}" '
        'font-family="sans-serif" font-size="14" fill="#222222">'
        "<title>Rods in a sheared liquid, and their mean projection on the gradient axis</title>"
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#FFFFFF"/>'
        '<g stroke="#0072B2" stroke-width="3" stroke-linecap="round">'
        + "\n".join(rod(k, rods[k]) for k in range(COLUMNS * ROWS))
        + "</g>"
        f'<text x="30" y="18">rods that collide, seen along the vorticity axis</text>'
        f'<text x="{LEFT}" y="18">mean projection on the gradient axis, X̄₁</text>'
        f'<polyline points="{LEFT},{TOP} {LEFT},{TOP + PLOT_HEIGHT} {LEFT + PLOT_WIDTH},{TOP + PLOT_HEIGHT}" fill="none" stroke="#888888"/>'
        f'<text x="{LEFT - 8}" y="{TOP + 5}" text-anchor="end">0.5</text><text x="{LEFT - 8}" y="{TOP + PLOT_HEIGHT + 5}" text-anchor="end">0</text>'
        f'{ticks}<text x="{LEFT + PLOT_WIDTH}" y="{TOP + PLOT_HEIGHT + 36}" text-anchor="end">t/T</text>'
        f'<polyline points="{curve}" fill="none" stroke="#0072B2" stroke-width="2"/>'
        f'<circle r="5" fill="#D55E00" cx="{x[0]:.1f}" cy="{y[0]:.1f}">{animated("cx", x)}{animated("cy", y)}</circle></svg>'
    )


main(*sys.argv[1:])
