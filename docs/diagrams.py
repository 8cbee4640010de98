"""The drawings of the book: axes and angles, a collision, orbits, the control volume.

python3 docs/diagrams.py DIR    writes axes.svg, collision.svg, orbits.svg and volume.svg; needs the standard library only
"""

import pathlib
import re
import sys
from math import cos, hypot, pi, radians, sin, sqrt

BLUE, ORANGE, GREEN, PURPLE, BROWN = "#0072B2", "#D55E00", "#009E73", "#332288", "#8B5A2B"
INK, GREY, PALE = "#222222", "#888888", "#E0E0E0"


def number(value):
    """One decimal, without a negative zero."""
    return f"{round(value, 1) + 0.0:g}"


class Picture:
    """An SVG picture on white, in pixels."""

    def __init__(self, width, height, title, description):
        self.parts = [
            f'<svg xmlns="http://www.w3.org/2000/svg" role="img" width="{width}" height="{height}" viewBox="0 0 {width} {height}" '
            f'font-family="sans-serif" font-size="16" fill="{INK}">',
            f"<title>{title}</title>",
            f"<desc>{description}</desc>",
            f'<rect width="{width}" height="{height}" fill="#FFFFFF"/>',
        ]

    def text(self, at, text, anchor="start", colour=INK, weight="normal"):
        """`_{…}` is lowered, `*…*` italic."""
        text = re.sub(r"\*(.+?)\*", r'<tspan font-style="italic">\1</tspan>', text)
        text = re.sub(r"_\{(.+?)\}(.?)", r'<tspan dy="4" font-size="12">\1</tspan><tspan dy="-4">\2</tspan>', text)
        x, y = map(number, at)
        self.parts.append(f'<text x="{x}" y="{y}" text-anchor="{anchor}" fill="{colour}" font-weight="{weight}">{text}</text>')

    def line(self, points, colour=INK, width=1.5, dash=None, fill="none"):
        points = " ".join(f"{number(x)},{number(y)}" for x, y in points)
        dash = f' stroke-dasharray="{dash}"' if dash else ""
        self.parts.append(
            f'<polyline points="{points}" fill="{fill}" stroke="{colour}" stroke-width="{number(width)}" stroke-linecap="round"{dash}/>'
        )

    def dot(self, at, colour=INK, radius=4.0, fill=None):
        x, y = map(number, at)
        self.parts.append(f'<circle cx="{x}" cy="{y}" r="{number(radius)}" fill="{fill or colour}" stroke="{colour}"/>')

    def head(self, back, tip, colour=INK, size=10):
        """The head of an arrow that comes from `back`."""
        (x, y), (x0, y0) = tip, back
        length = hypot(x - x0, y - y0)
        u, v = size * (x - x0) / length, size * (y - y0) / length
        corners = [(x, y), (x - u - 0.4 * v, y - v + 0.4 * u), (x - u + 0.4 * v, y - v - 0.4 * u)]
        points = " ".join(f"{number(a)},{number(b)}" for a, b in corners)
        self.parts.append(f'<polygon points="{points}" fill="{colour}"/>')

    def arrow(self, points, colour=INK, width=1.5, dash=None):
        (x, y), (x0, y0) = points[-1], points[-2]
        short = 1 - min(1, 6 / hypot(x - x0, y - y0))
        self.line([*points[:-1], (x0 + short * (x - x0), y0 + short * (y - y0))], colour, width, dash)
        self.head(points[-2], points[-1], colour)

    def save(self, path):
        path.write_text("\n".join([*self.parts, "</svg>"]) + "\n", encoding="utf-8")


def view(centre, scale, azimuth, elevation):
    """Places of points seen from far away, axis 3 upwards; also whether a point is on the near side."""
    a, e = radians(azimuth), radians(elevation)

    def place(p):
        right = -sin(a) * p[0] + cos(a) * p[1]
        up = -sin(e) * (cos(a) * p[0] + sin(a) * p[1]) + cos(e) * p[2]
        return centre[0] + scale * right, centre[1] - scale * up

    return place, lambda p: cos(e) * (cos(a) * p[0] + sin(a) * p[1]) + sin(e) * p[2] >= 0


def direction(theta, phi):
    return sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)


def along(p, length):
    return tuple(length * x for x in p)


def axes(path):
    picture = Picture(
        680, 330, "Axes and angles",
        "Left, seen along the vorticity axis: the liquid moves along axis 2, faster with x1. Right: theta from axis 3, phi from axis 1 towards axis 2.",
    )
    picture.text((20, 28), "The flow", weight="bold")
    x, y = 60, 280
    picture.arrow([(x, y), (x, 60)])
    picture.arrow([(x, y), (x + 200, y)])
    picture.text((x + 10, 68), "1 gradient")
    picture.text((x + 208, y + 5), "2 flow")
    picture.dot((x, y), radius=8, fill="#FFFFFF")
    for sign in (-1, 1):
        picture.line([(x - 5.5, y - 5.5 * sign), (x + 5.5, y + 5.5 * sign)])
    picture.text((20, y + 32), "3 vorticity, away from you")
    for k in range(1, 6):
        picture.arrow([(x, y - 36 * k), (x + 32 * k, y - 36 * k)], BLUE)
    picture.text((x + 168, y - 140), "*u*_{2} = *G* *x*_{1}", colour=BLUE)

    place, _ = view((470, 215), 150, 27, 24)
    theta, phi = radians(42), radians(62)
    p = direction(theta, phi)
    flat = (p[0], p[1], 0)
    zero = (0, 0, 0)
    picture.text((350, 28), "A rod’s direction", weight="bold")
    picture.line([place(direction(pi / 2, radians(k))) for k in range(91)], PALE)
    picture.line([place(direction(radians(k), phi)) for k in range(91)], PALE)
    for end, name, shift, anchor in (
        ((1.25, 0, 0), "1 gradient", (10, 14), "start"),
        ((0, 1.2, 0), "2 flow", (0, 24), "end"),
        ((0, 0, 1.2), "3 vorticity", (10, 6), "start"),
    ):
        picture.arrow([place(zero), place(end)])
        at = place(end)
        picture.text((at[0] + shift[0], at[1] + shift[1]), name, anchor)
    picture.line([place(zero), place(flat), place(p)], GREY, dash="5 4")
    picture.line([place(along(p, -0.35)), place(p)], BLUE, 6)
    picture.arrow([place(p), place(along(p, 1.2))], BLUE, 2)
    at = place(along(p, 1.2))
    picture.text((at[0] + 8, at[1] + 4), "*p*", colour=BLUE)
    arc = [place(along(direction(theta * k / 20, phi), 0.45)) for k in range(21)]
    picture.arrow(arc, ORANGE, 2)
    picture.text((arc[10][0] - 2, arc[10][1] - 8), "θ", colour=ORANGE)
    arc = [place(along(direction(pi / 2, phi * k / 20), 0.4)) for k in range(21)]
    picture.arrow(arc, GREEN, 2)
    picture.text((arc[11][0] - 6, arc[11][1] + 20), "φ", colour=GREEN)
    picture.save(path)


def collision(path):
    picture = Picture(
        680, 400, "Two rods in collision",
        "The contact line is normal to both rods. Before, their contact points move along it at v_A and v_B; after, both at the mean.",
    )
    angles = {"A": radians(103), "B": radians(38)}
    arms = {"A": 0.55, "B": 0.4}
    heights = {"A": 0.0, "B": 0.95}
    before = {"A": 0.5, "B": -0.16}
    mean = sum(before.values()) / 2
    colours = {"A": BLUE, "B": ORANGE}
    for left, name, speeds in ((0, "Before", before), (340, "After", {"A": mean, "B": mean})):
        place, _ = view((left + 215, 262), 150, 0, 26)
        picture.text((left + 20, 28), name, weight="bold")
        points = {}
        for rod in "AB":
            p = cos(angles[rod]), sin(angles[rod])

            def point(s, rise=0.0, rod=rod, p=p):
                return place((s * p[0], s * p[1], heights[rod] + rise))

            points[rod] = point
        picture.line([points["A"](0, -0.35), points["B"](0, 0.45)], GREEN, 1.5, "6 4")
        for rod in "AB":
            point, colour, arm = points[rod], colours[rod], arms[rod]
            picture.line([point(-arm - 0.8), point(-arm + 0.8)], colour, 6)
            picture.arrow([point(-arm + 0.8), point(-arm + 1.0)], colour, 2)
            at = point(-arm + 1.0)
            picture.text((at[0] + 6, at[1] + (18 if rod == "A" else 0)), f"*p*_{{{rod}}}", colour=colour)
            centre, contact = point(-arm), point(0)
            picture.dot(centre, INK, 4)
            if left == 0:
                drop = 16 if rod == "A" else -16
                a, b = (centre[0], centre[1] + drop), (contact[0], contact[1] + drop)
                picture.arrow([a, b], INK, 1.2)
                picture.text(((a[0] + b[0]) / 2, (a[1] + b[1]) / 2 + (20 if rod == "A" else -12)), f"*r*_{{{rod}}}")
            else:
                push = (-0.15 if rod == "A" else 0.15) / arm
                end = -arm + 0.7
                picture.arrow([point(end), point(end, push)], GREY, 2)
            picture.arrow([contact, point(0, speeds[rod])], INK, 3)
            picture.dot(contact, INK, 4, "#FFFFFF")
            if left == 0:
                picture.text((contact[0] - 10, point(0, speeds[rod])[1] + 6), f"*v*_{{{rod}}}", "end")
        if left:
            picture.text((points["A"](0)[0] - 10, points["A"](0, 0.5)[1]), "both ½(*v*_{A} + *v*_{B})", "end")
        top = points["B"](0, 0.45)
        picture.text((top[0] - 4, top[1] - 6), "ℓ", colour=GREEN)
    picture.text((20, 362), "● centre, ○ contact point with its velocity along ℓ; all else stays")
    picture.text((20, 386), "grey: each rod’s change of ṗ, along ± ℓ and ∝ 1/arm", colour="#666666")
    picture.save(path)


def orbits(path):
    aspect_ratio = 5
    picture = Picture(
        680, 400, "Orbits of a rod of aspect ratio 5",
        "Closed curves around the vorticity axis, wider along the flow axis, for five orbit constants. Dots at equal times crowd near the flow axis.",
    )
    place, near = view((210, 215), 165, 24, 30)
    picture.text((20, 28), "Orbits of a rod of *r*_{e} = 5", weight="bold")
    picture.dot((210, 215), PALE, 165, "#FAFAFA")
    for end, name, shift, anchor in (
        ((1.5, 0, 0), "1 gradient", (12, 8), "start"),
        ((0, 1.22, 0), "2 flow", (-14, 22), "start"),
        ((0, 0, 1.13), "3 vorticity", (10, 4), "start"),
    ):
        outside = tuple(x and 1 for x in end)
        picture.arrow([place(outside), place(end)], GREY)
        at = place(end)
        picture.text((at[0] + shift[0], at[1] + shift[1]), name, anchor)
    kinds = ((0.05, PURPLE), (0.2, GREEN), (1, BLUE), (5, BROWN), (None, ORANGE))
    steps = 360
    for k, (constant, colour) in enumerate(kinds):

        def at_phase(phase, constant=constant):
            # q_1 = C sin, q_2 = r_e C cos, q_3 = 1; the phase grows evenly in time, and phi from 1 towards 2.
            q = (cos(phase), aspect_ratio * sin(phase), 0) if constant is None else (
                constant * cos(phase), aspect_ratio * constant * sin(phase), 1)
            length = sqrt(sum(x * x for x in q))
            return along(q, 1 / length)

        curve = [at_phase(2 * pi * step / steps) for step in range(steps + 1)]
        for side, dash, width in ((False, "3 5", 1.2), (True, None, 2.2)):
            piece = []
            for p in [*curve, None]:
                if p is not None and near(p) == side:
                    piece.append(place(p))
                    continue
                if len(piece) > 1:
                    picture.line(piece, colour, width, dash)
                piece = []
        for step in range(0, steps, 15):
            p = curve[step]
            if near(p):
                picture.dot(place(p), colour, 3)
        picture.head(place(curve[1]), place(curve[4]), colour, 12)
        y = 120 + 34 * k
        picture.line([(440, y), (480, y)], colour, 2.2)
        name = "*C* = ∞" if constant is None else f"*C* = {constant}"
        share = 1 if constant is None else constant / (1 + constant)
        picture.text((492, y + 6), f"{name}, *C*_{{b}} = {share:.2g}")
    picture.text((440, 90), "inner to outer:")
    picture.text((440, 300), "dots: 24 equal times")
    picture.save(path)


def volume(path):
    picture = Picture(
        620, 390, "The control volume",
        "A rod that leaves the cube at x2 = H comes back at x2 = 0, at x1 = H times the root of R and x3 = H times R prime.",
    )
    side, x0, y0 = 220, 150, 330

    def place(x1, x2, x3):
        """Axis 1 up, 2 to the right, 3 away from the reader; in sides of the cube."""
        return x0 + side * (x2 + 0.42 * x3), y0 - side * (x1 + 0.27 * x3)

    for a, b in (((0, 0, 1), (1, 0, 1)), ((0, 0, 1), (0, 1, 1)), ((0, 0, 0), (0, 0, 1))):
        picture.line([place(*a), place(*b)], GREY, 1.2, "4 4")
    left = [place(0, 0, 0), place(1, 0, 0), place(1, 0, 1), place(0, 0, 1)]
    right = [place(0, 1, 0), place(1, 1, 0), place(1, 1, 1), place(0, 1, 1)]
    for face, fill in ((left, "#E8F3EE"), (right, "#FBEDE4")):
        picture.line([*face, face[0]], "none", 1, fill=fill)
    picture.line([place(0, 0, 1), place(1, 0, 1)], GREY, 1.2, "4 4")
    picture.line([place(0, 0, 0), place(0, 0, 1)], GREY, 1.2, "4 4")
    for square in (
        [(0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0), (0, 0, 0)],
        [(1, 0, 0), (1, 0, 1), (1, 1, 1), (1, 1, 0)],
        [(0, 1, 0), (0, 1, 1), (1, 1, 1)],
    ):
        picture.line([place(*p) for p in square], INK)
    for k in range(1, 6):
        x1 = k / 5
        start = x0 - 120, place(x1, 0, 0)[1]
        picture.arrow([start, (start[0] + 18 * k, start[1])], BLUE)
    picture.line([(x0 - 120, y0), (x0 - 120, y0 - side)], BLUE)
    picture.text((x0 - 130, y0 - side - 14), "*u*_{2} = *G* *x*_{1}", colour=BLUE)
    picture.text((place(0, 0.5, 0)[0], y0 + 22), "2 flow, from 0 to *H*", "middle")
    picture.text((place(0, 1, 0.5)[0] + 14, place(0, 1, 0.5)[1] + 14), "3 vorticity")
    picture.text((x0 - 130, y0 + 22), "1 gradient, up")
    picture.text((x0 - 8, place(1, 0, 0)[1] + 4), "*H*", "end")
    picture.text((x0 - 8, y0 + 5), "0", "end")

    def rod(x1, x2, x3, colour):
        x, y = place(x1, x2, x3)
        picture.line([(x - 24, y + 12), (x + 24, y - 12)], colour, 5)

    out, back = (0.42, 1, 0.45), (0.72, 0, 0.6)
    start, end = place(*out), place(*back)
    floor = place(0, 0, back[2])
    picture.line([floor, end], GREEN, 1.2, "2 4")
    picture.line([place(0, 0, 0), floor], GREEN, 2.5)
    picture.text((floor[0] - 14, floor[1] + 22), "*H R*′", colour=GREEN)
    picture.text((floor[0] + 8, (floor[1] + end[1]) / 2 + 22), "*H* √*R*", colour=GREEN)
    rod(*back, GREEN)
    rod(*out, ORANGE)
    picture.arrow([(start[0] + 28, start[1]), (start[0] + 62, start[1])], ORANGE, 2)
    high = place(1, 0.5, 1)[1] - 22
    loop = [(start[0] + 70, start[1]), (start[0] + 92, start[1] - 26), (start[0] + 92, high), (end[0] - 60, high), (end[0] - 60, end[1]), (end[0] - 28, end[1])]
    picture.arrow(loop, GREY, 1.5, "5 4")
    picture.text((start[0] + 34, start[1] + 30), "leaves at *x*_{2} = *H*", colour=ORANGE)
    picture.text((place(1, 0.5, 1)[0] - 60, high - 8), "comes back at *x*_{2} = 0, with its direction", colour=INK, anchor="middle")
    picture.save(path)


def main(folder):
    folder = pathlib.Path(folder)
    for draw in (axes, collision, orbits, volume):
        draw(folder / f"{draw.__name__}.svg")


main(*sys.argv[1:])
