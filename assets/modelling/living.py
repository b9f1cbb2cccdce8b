# SPDX-License-Identifier: CC0-1.0
"""Fish, birds and trees. Lengths in any unit; heads point towards +Z."""
import math
import random

from .curves import add, cross, mix, mul, resampled, spline, sub, unit
from .mesh import Mesh
from .surfaces import ellipsoid, loft, revolve, tube


def fin(root, edge, thick, thin, rays=0, n=28, m=8):
    """A fin stretched from a root line to an edge line (3D points), swelling in rays. It stands across `side`."""
    root, edge = resampled(root, n), resampled(edge, n)
    a, b = sub(root[-1], root[0]), sub(edge[n // 2], root[n // 2])
    side = unit(cross(a, b))
    rings = []
    for k in range(n + 1):
        # The first and the last ray are thin, but not so thin that faces lose their area.
        slim = 0.25 + 0.75 * math.sin(math.pi * k / n) ** 0.5
        swell = 1 + 0.35 * (math.cos(2 * math.pi * rays * k / n) if rays else 0)
        half = [slim * (thick + (thin - thick) * i / m) * swell for i in range(m + 1)]
        line = [mix(root[k], edge[k], i / m) for i in range(m + 1)]
        rings.append([add(p, mul(side, h)) for p, h in zip(line, half)] +
                     [add(p, mul(side, -h)) for p, h in reversed(list(zip(line, half)))])
    return loft(rings)


def pair(mesh):
    return Mesh().add(mesh).add(mesh.mirrored_x())


def fish_body(stations, n=40):
    """Through (z, middle y, half width, half height); narrower towards the belly and the back than an ellipse."""
    rings = []
    for z, y, a, b in spline(stations, 6):
        if a <= 0:
            rings.append([(0.0, y, z)])
            continue
        rings.append([(a * math.cos(t) * (1 - 0.16 * abs(math.sin(t)) ** 3), y + b * math.sin(t), z)
                      for t in (2 * math.pi * i / n for i in range(n))])
    return loft(rings)


def eye(x, y, z, r):
    ball = ellipsoid(r * 0.55, r, r, 20).moved(x, y, z)
    return pair(ball.add(ellipsoid(r * 0.4, r * 0.5, r * 0.5, 16).moved(x + r * 0.35, y, z)))


def gill(x, y, z, height):
    """A raised edge behind the cheek."""
    path = spline([(x * 0.72, y + height, z + height * 0.25), (x * 0.99, y + height * 0.4, z - height * 0.22),
                   (x * 1.0, y - height * 0.3, z - height * 0.22), (x * 0.66, y - height, z + height * 0.35)], 6)
    n = len(path) - 1
    return pair(tube(path, [0.05 + 0.10 * math.sin(math.pi * i / n) for i in range(n + 1)], 10))


def fish_carp():
    """A carp-like fish."""
    fish = fish_body([(9.3, -0.35, 0.25, 0.3), (9.0, -0.3, 0.62, 0.75), (8.0, -0.1, 1.1, 1.45), (6.4, 0.1, 1.55, 2.15),
                      (3.6, 0.2, 1.9, 2.85), (0.0, 0.1, 1.85, 2.9), (-3.5, 0.0, 1.35, 2.2), (-6.3, 0.0, 0.75, 1.3),
                      (-8.2, 0.05, 0.42, 0.88), (-9.3, 0.1, 0.24, 0.95)])
    fish.add(fin(spline([(0, 2.7, 3.6), (0, 2.8, 0), (0, 1.75, -4.6)], 8), spline([(0, 3.5, 3.3),
             (0, 5.2, 1.2), (0, 4.3, -1.4), (0, 3.6, -3.6), (0, 2.9, -5.8)], 8), 0.2, 0.06, 9))
    fish.add(fin(spline([(0, -1.9, -3.4), (0, -1.2, -6.0)], 8),
                 spline([(0, -2.7, -3.7), (0, -3.9, -4.9), (0, -3.3, -6.0), (0, -1.9, -7.0)], 8), 0.17, 0.05, 5))
    for s in (1, -1):
        fish.add(fin(spline([(0, 0.1 + s * 0.05, -8.6), (0, 0.1 + s * 0.85, -9.0)], 6),
                     spline([(0, 0.1 + s * 0.05, -11.3), (0, 0.1 + s * 1.6, -12.3), (0, 0.1 + s * 3.3, -13.2),
                             (0, 0.1 + s * 3.7, -13.0), (0, 0.1 + s * 2.6, -11.0)], 6), 0.22, 0.06, 6))
    fish.add(pair(fin([(1.55, -0.9, 4.6), (1.6, -1.5, 4.0)],
                      spline([(3.3, -1.2, 2.6), (3.5, -2.2, 1.8), (2.6, -2.9, 2.2)], 6), 0.14, 0.06, 4)))
    fish.add(pair(fin([(0.75, -2.55, 0.8), (0.75, -2.45, -0.3)],
                      spline([(1.6, -4.1, -0.4), (1.6, -4.2, -1.2), (1.3, -3.3, -1.9)], 6), 0.14, 0.06, 4)))
    fish.add(gill(1.72, 0.1, 5.2, 1.5))
    lips = [(0.42 * math.cos(a), -0.42 + 0.34 * math.sin(a), 9.2) for a in (2 * math.pi * i / 28 for i in range(28))]
    return fish.add(tube(lips, 0.16, 10, closed=True)).add(eye(1.12, 0.55, 7.4, 0.48))


def fish_angel():
    """A tall tropical fish with long fins."""
    fish = fish_body([(5.6, -0.2, 0.2, 0.22), (5.3, -0.15, 0.45, 0.55), (4.4, 0.1, 0.82, 1.35), (2.6, 0.3, 1.2, 2.9),
                      (0.4, 0.3, 1.25, 3.75), (-1.8, 0.25, 0.95, 3.2), (-3.6, 0.15, 0.55, 1.7), (-4.6, 0.1, 0.32, 0.95),
                      (-5.2, 0.1, 0.2, 0.95)])
    fish.add(fin(spline([(0, 3.4, 1.9), (0, 3.7, -
    0.4), (0, 1.4, -
    4.1)], 8), spline([(0, 4.6, 1.4), (0, 6.4, -
    0.8), (0, 9.6, -
    5.0), (0, 9.8, -
    5.6), (0, 5.6, -
    4.6), (0, 2.9, -
    5.3)], 8), 0.17, 0.06, 11, 44))
    fish.add(fin(spline([(0, -
    2.9, 1.6), (0, -
    3.1, -
    0.6), (0, -
    1.1, -
    4.1)], 8), spline([(0, -
    4.2, 1.1), (0, -
    5.9, -
    1.0), (0, -
    8.8, -
    5.0), (0, -
    9.0, -
    5.6), (0, -
    5.0, -
    4.6), (0, -
    2.6, -
    5.3)], 8), 0.17, 0.06, 11, 44))
    fish.add(fin(spline([(0, 0.95, -4.9), (0, -0.75, -4.9)], 6), spline([(0, 3.0, -9.4),
             (0, 1.6, -8.3), (0, 0.1, -7.9), (0, -1.4, -8.3), (0, -2.8, -9.4)], 6), 0.2, 0.06, 9))
    fish.add(pair(fin([(1.08, -0.5, 2.5), (1.1, -1.1, 2.2)],
                      spline([(2.1, -0.3, 0.7), (2.5, -1.1, 0.2), (2.0, -1.8, 0.7)], 6), 0.12, 0.05, 4)))
    whisker = [(0.45, -2.5, 2.1), (0.7, -4.6, 1.4), (0.8, -6.9, 0.0), (0.7, -8.6, -1.6)]
    n = len(spline(whisker, 6))
    fish.add(pair(tube(spline(whisker, 6), [0.2 - 0.14 * i / n for i in range(n)], 10)))
    fish.add(gill(1.16, 0.15, 2.7, 1.2))
    lips = [(0.3 * math.cos(a), -0.22 + 0.24 * math.sin(a), 5.5) for a in (2 * math.pi * i / 28 for i in range(28))]
    return fish.add(tube(lips, 0.13, 10, closed=True)).add(eye(0.78, 0.55, 4.0, 0.42))


def tree_fir():
    """A fir: tiers of drooping, ragged skirts."""
    rng = random.Random(3)
    tree = revolve([(0, 0)] + spline([(1.35, 0), (1.0, 0.5), (0.75, 1.6), (0.55, 4), (0.3, 9)], 4) + [(0, 9)], 20)
    tiers = 9
    for k in range(tiers):
        t = k / (tiers - 1)
        y, reach, rise = 2.6 + 13.4 * t ** 0.93, 5.0 * (1 - t) ** 0.9 + 0.75, 3.3 - 1.35 * t
        points = 17 - (k + 1) // 2
        phase = rng.random() * math.tau
        lengths = [1 + 0.14 * (rng.random() - 0.5) for _ in range(points)]

        def ring(share, droop):
            out = []
            for i in range(points * 6):
                spike = abs((i % 6) / 3 - 1)  # 1 at a branch's tip, 0 between two
                length = lengths[(i + 3) // 6 % points] if i % 6 > 3 else lengths[i // 6]
                r = reach * share * (1 - 0.34 * (1 - spike) * share ** 2) * (1 + (length - 1) * share)
                a = phase + math.tau * i / (points * 6)
                out.append((r * math.cos(a), y + rise * (1 - share) - droop * share **
                           2 - 0.28 * reach * share ** 3 * spike, r * math.sin(a)))
            return out

        shares = [0.12, 0.3, 0.5, 0.7, 0.85, 1.0]
        upper = [[(0.0, y + rise * 1.04, 0.0)]] + [ring(s, 0.0) for s in shares]
        lower = [[(x * 0.985, yy - 0.22 * s ** 0.5, z * 0.985) for x, yy, z in ring(s, 0.0)]
                   for s in (1.0, 0.8, 0.55, 0.3, 0.15)]
        tree.add(loft(upper + lower))
    return tree


def leaf(at, along, facing, length, width):
    """A pointed leaf of eight triangles, folded a little along its middle."""
    along = unit(along)
    side = unit(cross(along, facing))
    face = cross(side, along)
    middle = add(at, mul(along, length * 0.45))
    ring = [at, add(middle, add(mul(side, width / 2), mul(face, width * 0.16))), add(at, mul(along, length)),
            add(middle, add(mul(side, -width / 2), mul(face, width * 0.16)))]
    mesh = Mesh(ring + [add(middle, mul(face, width * 0.07)), add(middle, mul(face, -width * 0.07))])
    for i in range(4):
        j = (i + 1) % 4
        mesh.faces += [(i, j, 4), (j, i, 5)]
    return mesh.outward()


def tree_broadleaf():
    """A broad-leaved tree: trunk, forking boughs and some fifteen hundred leaves."""
    rng = random.Random(11)
    tree = Mesh()
    tips = []

    def bough(start, direction, length, radius, level):
        path = [start]
        for k in range(1, 7):
            wander = tuple((rng.random() - 0.5) * 0.28 for _ in range(3))
            direction = unit(add(add(direction, wander), (0, 0.07, 0)))
            path.append(add(path[-1], mul(direction, length / 6)))
        tree.add(tube(path, [radius * (1 - 0.09 * k) for k in range(7)],
                 (12, 10, 7, 5)[level], ends="round" if level < 2 else "flat"))
        if level >= 2:
            tips.extend((p, direction) for p in path[2:])
        if level == 3:
            return
        forks = (5, 4, 3)[level]
        for i in range(forks):
            a = math.tau * (i + 0.35 * rng.random()) / forks + level
            lean = (0.95, 0.85, 0.9)[level]
            across = unit(cross(direction, (0.3, 0.1, 1.0) if abs(direction[1]) > 0.9 else (0, 1, 0)))
            other = cross(direction, across)
            way = add(direction, mul(add(mul(across, math.cos(a)), mul(other, math.sin(a))), lean))
            bough(path[-1 - i % 2], unit(way), length * (0.62, 0.68, 0.6)[level], radius * 0.5, level + 1)

    tree.add(revolve([(0, 0)] + spline([(1.25, 0), (0.85, 0.5), (0.68, 1.2)], 4) + [(0, 1.3)], 24))
    bough((0.0, 0.4, 0.0), (0.0, 1.0, 0.0), 5.4, 0.66, 0)
    centre = (0.0, 8.2, 0.0)
    for _ in range(1450):
        p, direction = tips[int(rng.random() * len(tips))]
        at = add(p, tuple((rng.random() - 0.5) * 1.5 for _ in range(3)))
        outward = unit(sub(at, centre))
        along = unit(add(add(outward, mul(direction, 0.4)), tuple(1.4 * (rng.random() - 0.5) for _ in range(3))))
        facing = unit(add(outward, (0.3 * (rng.random() - 0.5), 0.7, 0.3 * (rng.random() - 0.5))))
        if abs(sum(u * v for u, v in zip(along, facing))) < 0.95:
            tree.add(leaf(at, along, facing, 0.85 + 0.3 * rng.random(), 0.46 + 0.14 * rng.random()))
    return tree
