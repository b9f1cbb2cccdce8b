# SPDX-License-Identifier: CC0-1.0
"""Chess men, snowmen, guitars and houses. Lengths in any unit; fronts towards +Z."""
import math
import random

from .curves import arc, resampled, rounded_polygon, spline, superellipse
from .mesh import Mesh
from .surfaces import cylinder, ellipsoid, loft, revolve, rod, slab, sweep, torus, tube


def chess_foot(width, waist, top):
    """The turned foot all men share: a profile from the axis up to (waist, top)."""
    return [(0, 0), (width - 0.15, 0)] + arc((width - 0.2, 0.28), 0.28, -90, 90, 8) + [(width - 0.34, 0.56)] + spline(
        [(width - 0.34, 0.56), (width - 0.38, 0.9), (width - 0.75, 1.15), (width - 0.75, 1.15), (width - 0.62, 1.3),
         (width - 0.72, 1.5), (width - 0.72, 1.5), (width - 0.85, 1.75), (waist + 0.12, top * 0.62), (waist, top)], 5)


def collar(radius, y, thick):
    return [(radius - thick * 0.2, y)] + arc((radius, y + thick),
             thick, -80, 80, 8) + [(radius - thick * 0.2, y + 2 * thick)]


def chess_pawn():
    """A pawn."""
    profile = chess_foot(1.6, 0.55, 3.5) + collar(0.95, 3.5, 0.13) + spline([(0.62, 3.85), (0.56, 4.1)], 2)
    return revolve(profile + arc((0, 4.85), 0.95, -53, 86, 24) + [(0, 5.8)], 64)


def chess_king():
    """A king with his cross."""
    profile = chess_foot(1.85, 0.72, 5.6) + collar(1.15, 5.6, 0.14) + collar(0.92, 5.92, 0.11)
    profile += spline([(0.72, 6.2), (0.74, 6.5), (0.95, 7.3), (1.22, 8.1),
                      (1.22, 8.1), (1.1, 8.25), (0.7, 8.5), (0.3, 8.62)], 5)
    king = revolve(profile + [(0.26, 8.9), (0, 8.95)], 64)
    cross = [(-0.13, 0), (0.13, 0), (0.13, 0.38), (0.5, 0.34), (0.5, 0.74), (0.13, 0.70), (0.18, 1.12), (-0.18, 1.12),
             (-0.13, 0.70), (-0.5, 0.74), (-0.5, 0.34), (-0.13, 0.38)]
    return king.add(slab([(x, -z) for x, z in cross], 0.26, 0.05, 3).turned("x", 90).moved(0, 8.82, -0.13))


def snowball(radius, squash, seed):
    """A hand-rolled ball: a sphere with shallow lumps, flat where it stands."""
    rng = random.Random(seed)
    waves = [(rng.uniform(1.5, 4.5), rng.uniform(1.5, 4.5), rng.uniform(1.5, 4.5), rng.uniform(0, 6)) for _ in range(7)]

    def lumpy(x, y, z):
        k = 1 + 0.006 * sum(math.sin(a * x + b * y + c * z + d) for a, b, c, d in waves)
        return radius * k * x, radius * squash * k * y, radius * k * z

    return ellipsoid(1, 1, 1, 40).mapped(lumpy)


def stick_arm(side, wave):
    """A twig with three fingers."""
    path = spline([(side * 1.2, 4.7, 0.1), (side * 2.2, 5.1 + wave * 0.5, 0.35), (side * 3.0, 5.4 + wave, 0.5)], 5)
    n = len(path)
    arm = tube(path, [0.13 - 0.05 * i / n for i in range(n)], 10)
    end = path[-1]
    for dx, dy, dz in ((0.45, 0.35, 0.1), (0.5, 0.02, 0.2), (0.15, 0.5, -0.1)):
        arm.add(rod((end[0] - side * 0.06, end[1] - 0.04, end[2]),
                (end[0] + side * dx, end[1] + dy, end[2] + dz), (0.075, 0.045), 8))
    return arm


def snow_face(y, r, nose):
    face = Mesh()
    for x in (-0.3, 0.3):
        face.add(ellipsoid(0.12, 0.13, 0.09, 14).moved(x, y + 0.25, r * 0.93))
    for i in range(5):
        a = math.radians(-38 + 19 * i)
        face.add(ellipsoid(0.075, 0.075, 0.06, 12).moved(0.46 * math.sin(a), y + 0.08 - 0.46 * math.cos(a), r * 0.93))
    carrot = [(0.2, 0), (0.19, 0.25), (0.12, 0.7 * nose), (0.03, nose)]
    return face.add(revolve([(0, -0.2)] + spline(carrot, 4) + [(0, nose + 0.02)],
                    20).turned("x", 90).moved(0, y, r * 0.95))


def buttons(places):
    row = Mesh()
    for y, z in places:
        row.add(ellipsoid(0.14, 0.14, 0.1, 14).moved(0, y, z))
    return row


def snowman_hat():
    """Three balls and a top hat."""
    man = snowball(2.0, 0.92, 1).moved(y=1.7)
    man.add(snowball(1.45, 0.94, 2).moved(y=4.35)).add(snowball(1.05, 0.97, 3).moved(y=6.45))
    man.add(snow_face(6.5, 1.05, 1.15)).add(buttons([(4.9, 1.36), (4.3, 1.46), (3.7, 1.36)]))
    man.add(stick_arm(1, 0.5)).add(stick_arm(-1, 0.1))
    hat = [(0, 0)] + arc((1.42, 0.08), 0.08, -90, 90, 6) + [(0.9, 0.17), (0.86, 0.6), (0.87, 1.2)]
    hat = revolve(hat + arc((0.84, 1.42), 0.08, 0, 90, 4) + [(0, 1.5)], 48)
    hat.add(torus(0.87, 0.08, 48, 10).moved(y=0.3))
    return man.add(hat.turned("z", -9).turned("x", -5).moved(0.12, 7.18, -0.08))


def snowman_scarf():
    """Two balls, a bobble cap and a scarf."""
    man = snowball(2.15, 0.95, 7).moved(y=1.85).add(snowball(1.4, 0.95, 8).moved(y=4.75))
    man.add(snow_face(4.75, 1.4, 0.9)).add(buttons([(2.9, 1.93), (2.1, 2.14)]))
    for side, wave in ((1, 0.9), (-1, -0.5)):
        man.add(stick_arm(side, wave).moved(side * 0.55, -2.2, 0))
    cap = [(0, 0.2), (1.28, 0.0)] + arc((1.32, 0.26), 0.26, -90, 90, 8)
    cap += spline([(1.22, 0.5), (1.1, 1.0), (0.75, 1.55), (0.25, 1.9)], 4)
    ribs = revolve(cap + [(0, 1.95)], 72).mapped(_ribbed)
    man.add(ribs.add(snowball(0.42, 1, 4).moved(y=2.1)).turned("z", 8).moved(-0.1, 5.35, -0.1))
    wrap = [(1.12 * math.cos(a), 3.72 + 0.06 * math.sin(2 * a), 1.12 * math.sin(a))
             for a in (math.tau * i / 60 for i in range(60))]
    man.add(sweep(wrap, superellipse(0.3, 0.3, 2.6, 20), up=(0, 1, 0), closed=True))
    end = spline([(0.55, 3.7, 1.15), (0.75, 3.2, 1.65), (0.85, 2.5, 2.0), (0.95, 1.8, 2.2)], 6)
    return man.add(sweep(end, superellipse(0.34, 0.12, 3, 20), up=(1, 0, 0)))


def _ribbed(x, y, z):
    k = 1 + 0.03 * math.cos(18 * math.atan2(z, x))
    return x * k, y, z * k


def guitar_outline(scale=1.0):
    """The right half of a guitar's body from tail to neck, mirrored to a closed curve: counter-clockwise (x, y)."""
    half = [(0, -9.6), (3.2, -9.4), (6.6, -7.4), (7.7, -4.2), (6.6, -0.9),
             (5.15, 1.4), (5.3, 3.6), (5.75, 5.6), (5.0, 8.2), (2.8, 9.5), (0, 9.75)]
    ring = spline(half + [(-x, y) for x, y in half[-2:0:-1]], 5, closed=True)
    return [(x * scale, y * scale) for x, y in resampled(ring, 96, closed=True)]


def standing(ring, z, depth, bevel, steps=4):
    """An (x, y) outline as a slab from z to z + depth."""
    return slab([(x, -y) for x, y in ring], depth, bevel, steps).turned("x", 90).moved(z=z)


def guitar_neck(length, foot, nut, z, y):
    """Neck, frets, head with six pegs; from y upwards."""
    rings = []
    for k in range(9):
        t = k / 8
        w = foot + (nut - foot) * t
        rings.append([(s, y + length * t, z + u) for s, u in [(w, 0.25), (-w, 0.25)] + [(w * math.cos(a),
                     0.75 * math.sin(a)) for a in (math.pi + math.pi * i / 12 for i in range(13))]])
    neck = loft(rings)
    for i in range(1, 13):
        at = length * (1 - 2 ** (-i / 12)) * 1.75
        if at < length:
            w = nut + (foot - nut) * at / length
            neck.add(rod((-w * 0.98, y + length - at, z + 0.27), (w * 0.98, y + length - at, z + 0.27), 0.06, 8))
    top = y + length
    head = [(-nut, top - 0.4), (nut, top - 0.4), (nut + 0.05, top + 0.3), (nut + 0.55, top + 1.1),
            (nut + 0.75, top + 4.4), (0.7, top + 5.0), (0, top + 4.7), (-0.7, top + 5.0), (-nut - 0.75, top + 4.4),
            (-nut - 0.55, top + 1.1), (-nut - 0.05, top + 0.3)]
    neck.add(standing(rounded_polygon(head, 0.22, 3), z - 0.65, 0.8, 0.12, 3))
    for k in range(3):
        for side in (-1, 1):
            py = top + 1.5 + 1.15 * k
            neck.add(rod((side * (nut + 0.2), py, z - 0.25), (side * (nut + 1.25), py, z - 0.25), 0.1, 8))
            neck.add(ellipsoid(0.22, 0.32, 0.14, 14).moved(side * (nut + 1.45), py, z - 0.25))
            neck.add(cylinder(0.14, 0.45, 0.03, 14).turned("x", 90).moved(side * (nut - 0.05), py, z + 0.1))
    return neck


def strings(low, high, spread_low, spread_high, z_low, z_high):
    mesh = Mesh()
    for i in range(6):
        s = i / 2.5 - 1
        mesh.add(rod((s * spread_low, low, z_low), (s * spread_high, high, z_high), 0.045, 6))
    return mesh


def guitar_acoustic():
    """A steel-string guitar with a sound hole."""
    outline = guitar_outline()
    guitar = standing(outline, -2.2, 4.2, 0.28, 4)
    for z in (1.92, -2.12):
        rim = [(x * 0.985, y * 0.985, z) for x, y in outline]
        guitar.add(tube(rim, 0.17, 8, closed=True))
    for r, t in ((2.25, 0.12), (2.75, 0.07), (2.95, 0.05)):
        guitar.add(torus(r, t, 56, 10).turned("x", 90).moved(0, 2.9, 2.0))
    hole = revolve([(0, -0.5), (2.1, -0.5), (2.1, 0.07), (1.95, 0.07), (1.8, 0.02), (0, 0.02)], 48)
    guitar.add(hole.turned("x", 90).moved(0, 2.9, 2.0))
    bridge = [(-3.0, -4.6), (3.0, -4.6), (3.4, -4.1), (3.0, -3.6), (-3.0, -3.6), (-3.4, -4.1)]
    guitar.add(standing(rounded_polygon(bridge, 0.2, 3), 1.9, 0.5, 0.1, 3))
    guitar.add(rod((-1.7, -3.85, 2.45), (1.7, -3.85, 2.45), 0.12, 10))
    guitar.add(guitar_neck(15.6, 1.35, 1.05, 2.2, 4.6))
    return guitar.add(strings(-4.0, 20.1, 1.25, 0.85, 2.55, 2.55))


def guitar_electric():
    """A solid-bodied guitar with two horns."""
    half = [(0.4, -8.4), (4.2, -8.0), (6.3, -5.6), (6.1, -2.4), (4.9, 0.2), (4.9, 2.3),
             (5.9, 4.6), (6.0, 6.9), (4.9, 8.0), (3.5, 6.4), (2.5, 4.7), (0.6, 4.3)]
    left = [(-x * 0.97, y + (2.1 if y > 6 else 0.0) - (0.3 if y < -5 else 0)) for x, y in reversed(half)]
    outline = resampled(spline(half + left, 6, closed=True), 128, closed=True)
    guitar = standing(outline, -0.9, 1.9, 0.5, 5)
    guard = resampled(spline([(2.8, -5.6), (4.6, -3.0), (3.7, 0.0), (4.0, 2.6), (1.6, 3.6),
                      (-2.4, 3.4), (-3.6, 0.6), (-2.6, -1.6), (0.5, -2.6)], 6, closed=True), 64, closed=True)
    guitar.add(standing(guard, 0.95, 0.16, 0.06, 2))
    for y in (-2.3, 0.1, 2.4):
        pick = rounded_polygon([(-1.6, y - 0.42), (1.6, y - 0.42), (1.6, y + 0.42), (-1.6, y + 0.42)], 0.4, 5)
        guitar.add(standing(pick, 1.0, 0.4, 0.1, 3))
    guitar.add(standing(rounded_polygon([(-1.7, -5.4), (1.7, -5.4),
               (1.7, -4.0), (-1.7, -4.0)], 0.2, 3), 0.95, 0.45, 0.1, 3))
    for x, y in ((3.0, -2.6), (3.3, -4.0), (2.6, -5.0)):
        guitar.add(cylinder(0.42, 0.5, 0.1, 24).turned("x", 90).moved(x, y, 1.0))
    guitar.add(tube(spline([(1.5, -4.9, 1.3), (2.4, -4.6, 1.9), (3.9, -2.6, 2.0), (4.6, -1.0, 1.9)], 5), 0.11, 10))
    guitar.add(guitar_neck(16.4, 1.2, 0.95, 1.15, 3.4))
    return guitar.add(strings(-4.7, 19.7, 1.05, 0.78, 1.45, 1.5))
