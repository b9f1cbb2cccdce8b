# SPDX-License-Identifier: CC0-1.0
"""Mugs, jugs, vases and bottles. Lengths in centimetres."""
import math

from .curves import add, arc, circle, mul, spline, superellipse
from .surfaces import frames, loft, revolve, sweep


def mug_straight():
    """A straight stoneware mug with a D-shaped handle."""
    outer = [(0, 0.25), (2.9, 0.25)] + arc((3.15, 0.2), 0.2, 180, 270, 3) + arc((3.5, 0.5), 0.5, -90, 0, 6)
    rim = arc((3.8, 9.0), 0.2, 0, 180, 8)
    inner = arc((2.7, 1.5), 0.9, 0, -90, 8) + [(0, 0.6)]
    body = revolve(outer + [(4.0, 1.0 + i) for i in range(8)] + rim + [(3.6, 8.5 - i) for i in range(7)] + inner, 64)
    path = spline([(3.8, 7.6, 0), (5.0, 7.75, 0), (6.3, 7.1, 0), (6.75, 5.2, 0), (6.3, 3.2, 0), (5.0, 2.3, 0),
                   (3.8, 2.3, 0)], 6)
    handle = sweep(path, superellipse(0.62, 0.36, 2.6, 20), up=(0, 0, 1))
    return body.add(handle)


def mug_round():
    """A wide cappuccino cup with a curled ear."""
    outer = spline([(0, 0.2), (2.0, 0.2), (2.0, 0.2), (2.15, 0), (2.45, 0), (2.45, 0),
                   (2.5, 0.35), (3.6, 1.2), (4.7, 3.0), (5.1, 5.2), (5.15, 6.4)], 5)
    rim = arc((5.0, 6.45), 0.15, 0, 180, 6)
    inner = spline([(4.85, 6.4), (4.8, 5.2), (4.4, 3.1), (3.3, 1.5), (1.6, 0.75), (0, 0.65)], 5)
    body = revolve(outer[:-1] + rim + inner[1:], 64)
    path = spline([(4.85, 5.4, 0), (5.9, 5.95, 0), (7.2, 5.7, 0), (7.55, 4.5, 0), (6.7, 3.3, 0), (5.5, 2.7, 0),
                   (4.35, 2.75, 0)], 6)
    sizes = [0.42 + 0.16 * abs(2 * i / (len(path) - 1) - 1) for i in range(len(path))]
    handle = sweep(path, [superellipse(s, 0.72 * s, 2.3, 18) for s in sizes], up=(0, 0, 1))
    return body.add(handle)


def spout(path, radii, wall):
    """A tapering pipe that is hollow from its end down to a third of its length."""
    rings = [circle(r, 20) for r in radii]
    back = [(p, circle(r - wall, 20)) for p, r in list(zip(path, radii))[:len(path) * 2 // 3:-1]]
    return sweep_rings(list(zip(path, rings)) + back, path)


def sweep_rings(stations, path):
    """Rings carried to points of a path, in the given order; each takes the frame of its point."""
    axes = dict(zip(path, frames(path, (0, 0, 1))))
    rings = []
    for p, ring in stations:
        side, normal = axes[p]
        rings.append([add(p, add(mul(side, s), mul(normal, t))) for s, t in ring])
    return loft(rings)


def teapot_round():
    """A round-bellied teapot: lid with a knob, curved spout, looped handle."""
    body = revolve([(0, 0)] + spline([(3.6, 0), (3.9, 0.15), (4.2, 0.6), (5.8, 2.2), (6.6, 4.6), (5.9, 7.1), (4.0, 8.8),
                                      (3.7, 9.1)], 5) + [(3.55, 9.1), (0, 9.1)], 64)
    lid = revolve([(0, 8.8), (3.85, 8.9)] + spline([(3.95, 9.1), (3.8, 9.35), (2.8, 10.0), (1.3, 10.5),
                  (0.65, 10.75), (0.55, 11.05), (0.95, 11.5), (0.85, 12.0), (0.4, 12.25), (0, 12.3)], 4), 48)
    path = spline([(4.6, 2.9, 0), (7.2, 3.6, 0), (8.8, 5.8, 0), (9.9, 8.1, 0), (11.2, 9.2, 0)], 6)
    n = len(path) - 1
    nose = spout(path, [1.75 - 1.0 * (i / n) ** 0.8 for i in range(n + 1)], 0.17)
    grip = spline([(-5.2, 7.6, 0), (-7.6, 8.6, 0), (-9.6, 7.6, 0), (-9.9, 5.4, 0), (-8.4, 3.4, 0), (-5.6, 2.6, 0)], 7)
    return body.add(lid).add(nose).add(sweep(grip, superellipse(0.62, 0.45, 2.3, 18), up=(0, 0, 1)))


def teapot_tall():
    """A tall coffee pot with a straight spout and an angular handle."""
    body = revolve([(0, 0)] + spline([(4.7, 0), (4.9, 0.2), (4.95, 0.6), (4.6, 4.0), (3.9, 8.0),
                   (3.2, 12.0), (3.15, 12.6), (3.4, 13.0)], 5) + [(3.3, 13.1), (0, 13.1)], 64)
    lid = revolve([(0, 12.9), (3.35, 13.0)] + spline([(3.4, 13.2), (2.9, 13.9), (1.6, 14.7), (0.6, 15.0), (0.45, 15.2),
                                                     (0.8, 15.7), (0.6, 16.2), (0, 16.4)], 5), 48)
    path = spline([(3.6, 5.6, 0), (5.3, 7.4, 0), (6.5, 10.0, 0), (7.1, 12.3, 0)], 8)
    n = len(path) - 1
    nose = spout(path, [1.5 - 0.85 * (i / n) ** 0.7 for i in range(n + 1)], 0.15)
    grip = spline([(-3.2, 11.6, 0), (-5.2, 12.1, 0), (-7.0, 11.7, 0), (-7.6, 10.4, 0), (-6.9, 7.4, 0), (-5.6, 4.4, 0),
                   (-4.2, 3.2, 0)], 7)
    return body.add(lid).add(nose).add(sweep(grip, superellipse(0.6, 0.38, 2.6, 18), up=(0, 0, 1)))


def vase_amphora():
    """A slim vase with a flared lip and two ears."""
    outer = spline([(2.6, 0), (2.75, 0.25), (2.2, 0.9), (2.2, 0.9), (2.6, 2.2), (4.6, 6.5), (5.3, 10.0), (4.5, 13.2),
                    (2.5, 15.6), (1.9, 17.6), (2.2, 19.4), (3.0, 20.4)], 5)
    inner = spline([(2.95, 20.75), (2.7, 20.6), (1.85, 19.4), (1.55, 17.6), (2.1, 15.6), (3.9, 13.0), (0, 10.0)], 5)
    body = revolve([(0, 0)] + outer + inner, 64)
    ear = spline([(1.8, 18.6, 0), (3.3, 19.2, 0), (4.9, 18.2, 0), (5.3, 16.0, 0), (4.6, 13.9, 0), (3.9, 13.2, 0)], 6)
    grip = sweep(ear, superellipse(0.5, 0.3, 2.4, 16), up=(0, 0, 1))
    return body.add(grip).add(grip.turned("y", 180))


def vase_twisted():
    """A tall vase whose seven ribs wind up round it."""
    outer = spline([(3.0, 0), (3.3, 0.4), (4.2, 4.0), (4.9, 8.0),
                   (4.4, 12.0), (3.0, 15.5), (2.7, 17.5), (3.5, 20.0)], 6)
    inner = [(r - 0.35, y) for r, y in outer[:6:-1]]
    rings = []
    for k, (r, y) in enumerate(outer + inner):
        deep = 0.085 * min(1.0, y / 2.5) * min(1.0, (20.6 - y) / 4)
        ring = []
        for i in range(84):
            a = 2 * math.pi * i / 84
            rr = r * (1 + deep * math.cos(7 * (a - 0.075 * y)))
            ring.append((rr * math.cos(a), y, rr * math.sin(a)))
        rings.append(ring)
    return loft(rings)


def bottle_wine():
    """A Bordeaux bottle with its punt and cork."""
    profile = [(0, 2.4)] + spline([(1.2, 1.9), (2.6, 0.5), (3.2, 0)], 4) + arc((3.35, 0.4), 0.4, -80, 0, 5)
    profile += [(3.75, y) for y in (2, 5, 8, 11, 14, 17)]
    profile += spline([(3.75, 18.4), (3.6, 19.4), (2.9, 20.6), (1.85, 21.6), (1.5, 22.8), (1.42, 24.5), (1.4, 27.6)], 4)
    profile += arc((1.42, 27.95), 0.22, -70, 0, 3) + arc((1.42, 28.6), 0.22, 0, 90, 3)
    cork = [(1.02, 28.85), (0.98, 28.9), (0.98, 29.5)] + arc((0.88, 29.55), 0.1, 0, 90, 3) + [(0, 29.65)]
    return revolve(profile + cork, 56)


def bottle_square():
    """A square decanter with a ball stopper."""
    rings = []
    for k, (half, y, power) in enumerate(spline([(3.6, 0, 6), (3.9, 0.25, 6), (4.0, 0.8, 6), (4.05, 5, 6), (4.1, 11, 6),
                                                 (4.0, 12.2, 5.5), (3.3, 13.4, 4), (1.9, 14.2, 2.6), (1.45, 15.0, 2),
                                                 (1.4, 17.2, 2), (1.45, 17.5, 2)], 4)):
        rings.append([(x, y, z) for x, z in superellipse(half, half, power, 72)])
    lip = revolve([(0, 17.2), (1.5, 17.2)] + arc((1.75, 17.55), 0.3, -90, 90, 8) + [(0, 17.85)], 48)
    stopper = revolve([(0, 17.6), (0.9, 17.7), (0.85, 18.3)] + arc((0, 20.0), 1.75, -58, 85, 20) + [(0, 21.75)], 40)
    return loft(rings).add(lip).add(stopper)
