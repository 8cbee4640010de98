#!/usr/bin/env python3
"""Rods that collide (Lee & Springer 1982), as a researcher writes them with NumPy: all distances in every step, collisions one by
one. 100 rods at 50 per cm3, alpha = 0.5, m = 3, r_e = 11.6, isotropic at t = 0; a colliding rod takes Jeffery's step and then the
turn that the collision adds.

    numpy_suspension.py REPLICAS STEPS_PER_PERIOD SEED    prints {"x1": [mean |p_1| at 2T of each replica], "seconds": ...}

Needs numpy alone, and shares nothing with shearbed.
"""

import json
import sys
import time

import numpy as np

N, G, LENGTH, R_E, ALPHA, M, PER_MM3 = 100, 0.5, 0.72, 11.6, 0.5, 3, 0.05
SIDE = (N / PER_MM3) ** (1 / 3)
PERIOD = 2 * np.pi * (R_E + 1 / R_E) / G
SHEAR = np.array([[0, 0, 0], [G, 0, 0], [0, 0, 0]])
SHAPE = (R_E**2 - 1) / (R_E**2 + 1)
A = (SHEAR - SHEAR.T) / 2 + SHAPE * (SHEAR + SHEAR.T) / 2


def jeffery(p):
    q = p @ A.T
    return q - p * np.sum(p * q, axis=-1, keepdims=True)


def rk4(p, h):
    k1 = jeffery(p)
    k2 = jeffery(p + h / 2 * k1)
    k3 = jeffery(p + h / 2 * k2)
    k4 = jeffery(p + h * k3)
    p = p + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return p / np.linalg.norm(p, axis=-1, keepdims=True)


def kicks(xa, pa, xb, pb):
    """What a collision adds to both rods' rates of turn; None for parallel rods."""
    line = np.cross(pa, pb)
    size = np.linalg.norm(line)
    if size == 0:
        return None
    line /= size
    arms = np.linalg.solve(np.column_stack([pa, -pb, line]), xb - xa)[:2]
    if 0 in arms:
        return None
    along = [line @ (SHEAR @ x + arm * jeffery(p)) for x, p, arm in ((xa, pa, arms[0]), (xb, pb, arms[1]))]
    mean = sum(along) / 2
    # The line is normal to both rods.
    return [line * (mean - own) / arm for own, arm in zip(along, arms)]


def turned(end, p, kick, h):
    """`end` turned about p x kick by |kick| h."""
    about = np.cross(p, kick)
    size = np.linalg.norm(about)
    if size == 0:
        return end
    about /= size
    angle = np.linalg.norm(kick) * h
    return end * np.cos(angle) + np.cross(about, end) * np.sin(angle) + about * (about @ end) * (1 - np.cos(angle))


def replica(rng, steps_per_period):
    h = PERIOD / steps_per_period
    x = rng.random((N, 3)) * SIDE
    phi, cos = 2 * np.pi * rng.random(N), 1 - 2 * rng.random(N)
    sin = np.sqrt(1 - cos**2)
    p = np.column_stack([sin * np.cos(phi), sin * np.sin(phi), cos])
    for _ in range(2 * steps_per_period):
        apart = np.linalg.norm(x[:, None] - x[None, :], axis=-1)
        np.fill_diagonal(apart, np.inf)
        other = apart.argmin(axis=1)
        distance = apart[np.arange(N), other]
        collide = np.flatnonzero((ALPHA / (distance / LENGTH + ALPHA)) ** M > rng.random(N))
        end, free = rk4(p, h), np.ones(N, dtype=bool)
        for a in collide[np.argsort(distance[collide], kind="stable")]:
            b = other[a]
            if free[a] and free[b]:
                both = kicks(x[a], p[a], x[b], p[b])
                if both is not None:
                    free[a] = free[b] = False
                    for rod, kick in zip((a, b), both):
                        end[rod] = turned(end[rod], p[rod], kick, h)
        p = end
        x[:, 1] += G * x[:, 0] * h
        out = (x[:, 1] < 0) | (x[:, 1] >= SIDE)
        x[out] = np.column_stack([SIDE * np.sqrt(rng.random(out.sum())), x[out, 1] % SIDE, SIDE * rng.random(out.sum())])
    return np.abs(p[:, 0]).mean()


if __name__ == "__main__":
    replicas, steps_per_period, seed = map(int, sys.argv[1:])
    start = time.perf_counter()
    x1 = [replica(np.random.default_rng([seed, k]), steps_per_period) for k in range(replicas)]
    print(json.dumps({"x1": x1, "seconds": time.perf_counter() - start}))
