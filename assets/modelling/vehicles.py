# SPDX-License-Identifier: CC0-1.0
"""Aeroplanes, cars and boats. Lengths in metres; the bow points towards +Z."""
import math

from .curves import arc, circle, mix, rounded_polygon, spline, superellipse
from .mesh import Mesh
from .surfaces import box, cylinder, ellipsoid, loft, revolve, rod, slab, sweep, torus, tube


def aerofoil(n=28):
    """A closed symmetric section, chord 1 from the nose at 0, half thickness for a depth of 1 (NACA four-digit)."""
    ring = []
    for i in range(n):
        a = 2 * math.pi * i / n
        x = (1 + math.cos(a)) / 2
        y = 5 * (0.2969 * math.sqrt(x) - 0.126 * x - 0.3516 * x * x + 0.2843 * x ** 3 - 0.1036 * x ** 4)
        y += 0.09 * x * math.sqrt(1 - x)  # a rounded trailing edge, so that no face there is without area
        ring.append((x, math.copysign(y, math.sin(a)) if 0 < i != n // 2 else 0.0))
    return ring


def wing(stations, upright=False):
    """A wing through (nose point, chord, depth as a share of the chord); an upright one is a fin."""
    rings = []
    for (x, y, z), chord, depth in stations:
        ring = []
        for s, t in aerofoil():
            off = t * depth * chord
            ring.append((x + off, y, z - s * chord) if upright else (x, y + off, z - s * chord))
        rings.append(ring)
    return loft(rings)


def tipped(root, tip, depth_root, depth_tip, steps=6):
    """Stations from root to tip ((point, chord) each), the last ones rounding the tip off."""
    stations = []
    for k in range(steps + 1):
        t = k / steps
        stations.append((mix(root[0], tip[0], t), root[1] + (tip[1] - root[1]) *
                        t, depth_root + (depth_tip - depth_root) * t))
    (x, y, z), chord, depth = stations[-1]
    ahead = unit_step(stations[-2][0], stations[-1][0])
    for k in range(1, 5):
        a = math.pi / 2 * k / 4.4
        keep, out = math.cos(a), 0.28 * chord * math.sin(a)
        stations.append(((x + ahead[0] * out, y + ahead[1] * out, z - chord * (1 - keep) *
                        0.6), chord * (0.35 + 0.65 * keep), depth * (0.3 + 0.7 * keep)))
    return stations


def unit_step(a, b):
    """Direction from a to b across the flight, with nothing along it."""
    length = math.hypot(b[0] - a[0], b[1] - a[1])
    return (b[0] - a[0]) / length, (b[1] - a[1]) / length


def span(stations):
    """A wing from tip to tip; the first station stands at x = 0."""
    other = [((-x, y, z), chord, depth) for (x, y, z), chord, depth in stations[:0:-1]]
    return wing(other + stations)


def both_sides(mesh):
    return Mesh().add(mesh).add(mesh.mirrored_x())


def fuselage(stations, n=40, power=2.0):
    """A body through (z, middle y, half width, half height); the ends are drawn in to points."""
    rings = []
    for z, y, a, b in stations:
        rings.append([(0.0, y, z)] if a == 0 else [(s, y + t, z) for s, t in superellipse(a, b, power, n)])
    return loft(rings)


def airliner():
    """A twin-engined airliner."""
    body = spline([(19.0, -0.55, 0.0, 0.0), (18.85, -0.5, 0.42, 0.42), (18.2, -0.36, 1.0, 1.0),
                   (16.8, -0.14, 1.62, 1.62), (14.6, 0, 1.96, 1.98), (11, 0, 2.0, 2.05), (0, 0, 2.0, 2.05),
                   (-7, 0.02, 2.0, 2.03), (-12, 0.45, 1.62, 1.6), (-16, 0.95, 0.95, 0.98), (-18.6, 1.3, 0.4, 0.45),
                   (-19.3, 1.38, 0.15, 0.18)], 4)
    body[0] = (19.0, -0.55, 0.0, 0.0)
    plane = fuselage(body)
    plane.add(fuselage(spline([(6.5, -1.5, 0.3, 0.2), (4.5, -1.55, 1.7, 0.75),
              (0, -1.55, 1.95, 0.9), (-4.5, -1.5, 1.7, 0.75), (-7.0, -1.4, 0.3, 0.2)], 4), 32))
    inner = [((0.6, -1.25, 4.4), 8.2, 0.065), ((2.0, -1.15, 3.4), 7.2, 0.062), ((6.2, -0.75, 0.35), 4.3, 0.055)]
    outer = tipped(((6.2, -0.75, 0.35), 4.3), ((16.6, 0.55, -6.4), 1.7), 0.055, 0.05)[1:]
    plane.add(both_sides(wing(inner + outer)))
    winglet = tipped(((16.75, 0.5, -6.6), 1.6), ((17.5, 2.5, -8.1), 0.85), 0.08, 0.1, 3)
    plane.add(both_sides(wing([((x, y, z), c, d) for (x, y, z), c, d in winglet], upright=True)))
    plane.add(both_sides(wing(tipped(((0.3, 1.25, -13.6), 4.0), ((6.5, 1.85, -17.6), 1.5), 0.055, 0.05))))
    plane.add(wing(tipped(((0, 1.4, -11.2), 6.0), ((0, 8.0, -17.0), 2.1), 0.055, 0.05), upright=True))
    shell = spline([(0.95, 0.0), (1.12, 0.1), (1.2, 0.6), (1.17, 1.9), (0.98, 3.1), (0.86, 3.5)], 4)
    duct = [(0.8, 3.45), (0.82, 2.6), (0.9, 1.2), (0.88, 0.35)]
    core = revolve([(0, 0.75)] + spline([(0.15, 0.8), (0.3, 1.15), (0.35, 1.3)], 3)
                   + [(0.86, 1.35), (0.7, 3.2), (0.52, 3.7), (0.2, 4.2), (0, 4.4)], 32)
    engine = revolve(shell + duct, 40, closed=True).add(core).turned("x", -90)
    pylon = wing([((5.9, -1.55, 2.6), 3.9, 0.05), ((5.9, -0.6, 1.4), 4.2, 0.05)], upright=True)
    plane.add(both_sides(engine.moved(5.9, -2.35, 3.9).add(pylon)))
    return plane


def biplane():
    """A biplane with wheels, struts and a pilot."""
    body = spline([(3.05, 0, 0.35, 0.35), (2.9, 0, 0.56, 0.56), (2.3, 0, 0.62, 0.62), (1.2, 0.02, 0.58,
                  0.62), (-0.4, 0.03, 0.5, 0.58), (-2.2, 0.1, 0.3, 0.38), (-3.9, 0.2, 0.08, 0.2)], 5)
    plane = fuselage(body, 36, 2.5)
    for y, z, half in ((1.28, 1.95, 4.5), (-0.42, 1.35, 4.1)):
        side = tipped(((0.0, y, z), 1.45), ((half, y + 0.22 * (y < 0), z), 1.4), 0.085, 0.085, 5)
        plane.add(span(side))
    for x, far in ((1.0, False), (3.5, True)):
        for top, low in ((1.7, 1.05), (0.85, 0.25)):
            plane.add(both_sides(rod((x, 1.25, top), (x if far else 0.45, -0.28 if far else 0.4, low), 0.045, 10)))
    plane.add(both_sides(rod((1.0, 1.25, 1.7), (3.5, -0.2, 1.05), 0.016, 8)))
    plane.add(both_sides(rod((1.0, -0.3, 1.05), (3.5, 1.25, 1.7), 0.016, 8)))
    plane.add(span(tipped(((0.0, 0.25, -2.9), 1.15), ((1.45, 0.25, -3.2), 0.75), 0.06, 0.06, 4)))
    plane.add(wing(tipped(((0, 0.2, -2.85), 1.3), ((0, 1.15, -3.35), 0.85), 0.06, 0.06, 4), upright=True))
    plane.add(revolve([(0, 0)] + spline([(0.06, 0.02), (0.18, -0.12), (0.23, -0.35)], 4) + [(0, -0.36)], 24)
              .turned("x", 90).moved(0, 0, 3.42))
    for k in (0, 180):
        blade = []
        for i in range(9):
            t = i / 8
            c, twist = 0.05 + 0.11 * math.sin(math.pi * (0.12 + 0.8 * t)), math.radians(62 - 45 * t)
            cos, sin = math.cos(twist), math.sin(twist)
            blade.append([(0.1 + 1.05 * t, s * cos - u * sin, s * sin + u * cos) for s, u in circle(c, 16, 0.22)])
        plane.add(loft(blade).moved(z=3.22).turned("z", k + 25))
    rim = torus(0.5, 0.05, 28, 8).scaled(0.72, 1.0, 1.0).moved(0, 0.55, -0.45)
    plane.add(rim).add(ellipsoid(0.2, 0.25, 0.22, 20).moved(0, 0.82, -0.5))
    plane.add(slab(rounded_polygon([(-0.3, 0), (0.3, 0), (0.2, 0.28), (-0.2, 0.28)], 0.06, 3), 0.03, 0.008, 2)
              .turned("x", -62).moved(0, 0.58, 0.1))
    for x in (-0.85, 0.85):
        plane.add(torus(0.36, 0.09, 36, 12).turned("z", 90).moved(x, -1.45, 1.7))
        plane.add(cylinder(0.34, 0.1, 0.03, 28).moved(y=-0.05).turned("z", 90).moved(x, -1.45, 1.7))
        for z in (2.2, 1.1):
            plane.add(rod((x * 0.9, -1.42, 1.7), (x * 0.45, -0.45, z), 0.045, 10))
    plane.add(rod((-0.95, -1.45, 1.7), (0.95, -1.45, 1.7), 0.045, 10))
    return plane.add(rod((0, 0.0, -3.3), (0, -0.35, -3.8), (0.05, 0.035), 10))


def wheel(radius, width):
    """A tyre and a dished hub about the X axis."""
    half = width / 2
    tyre = [(radius * 0.62, -half * 0.9)] + arc((radius - half * 0.55, -half * 0.4), half * 0.55, -90, 0, 5)
    tyre += arc((radius - half * 0.55, half * 0.4), half * 0.55, 0, 90, 5) + [(radius * 0.62, half * 0.9)]
    mesh = revolve(tyre, 32, closed=True)
    hub = [(0, -half * 0.7), (radius * 0.18, -half * 0.75), (radius * 0.24, -half * 0.45), (radius * 0.55, -half * 0.6),
           (radius * 0.64, -half * 0.85)]
    mesh.add(revolve(hub + [(r, -y) for r, y in reversed(hub)], 24))
    return mesh.turned("z", 90)


def arch(radius, width, z, x):
    """A raised lip round a wheel's upper half."""
    path = [(x, radius + 0.31 + (radius + 0.075) * math.sin(a) - radius, z + (radius + 0.075) * math.cos(a))
            for a in (math.pi * k / 18 for k in range(-1, 20))]
    return tube(path, width, 8)


def cabin(base, roof, shrink, thickness, pillars):
    """A glasshouse: a core set back behind pillars and a roof. base and roof: (half width, front z, back z, y)."""
    (bw, bf, bb, by), (rw, rf, rb, ry) = base, roof

    def ring(t, less):
        w, f, b = bw + (rw - bw) * t - less, bf + (rf - bf) * t - less, bb + (rb - bb) * t + less
        y = by + (ry - by) * t
        return [(s, y, (f + b) / 2 + u) for s, u in superellipse(w, (f - b) / 2, 5, 56)]

    mesh = loft([ring(t, shrink) for t in (0, 0.25, 0.5, 0.75, 1.0)])
    top = []
    for k in range(7):
        a = math.pi / 2 * k / 6
        less = 0.16 * (1 - math.cos(a))
        top.append([(x, y + thickness * math.sin(a), z) for x, y, z in ring(1.0, less)])
    mesh.add(loft([[(x, y - 0.05, z) for x, y, z in ring(1.0, 0.0)]] + top))
    for t0, t1 in pillars:
        foot, head = (bw * 0.965, by - 0.03, t0), (rw * 0.95, ry, t1)
        mesh.add(both_sides(rod(foot, head, 0.038, 10)))
    return mesh


def car(stations, base, roof, axles, radius, pillars, extras):
    """A car: body through (z, low y, high y, half width), glasshouse, wheels, lips, lamps and bumpers."""
    rings = []
    for z, low, high, w in spline(stations, 5):
        rings.append([(s, (low + high) / 2 + t, z) for s, t in superellipse(w, (high - low) / 2, 4.5, 48)])
    mesh = loft(rings).add(cabin(base, roof, 0.045, 0.09, pillars))
    side = max(s[3] for s in stations)
    for z in axles:
        for x in (-1, 1):
            mesh.add(wheel(radius, 0.24).moved(x * (side - 0.075), radius, z))
            mesh.add(arch(radius, 0.035, z, x * (side - 0.02)))
    return mesh.add(extras)


def car_saloon():
    """A saloon."""
    stations = [(2.26, 0.42, 0.66, 0.55), (2.2, 0.32, 0.74, 0.72), (1.9, 0.24, 0.83, 0.84), (1.2, 0.22, 0.92, 0.88),
                (0.2, 0.22, 0.97, 0.89), (-0.9, 0.22, 0.99, 0.89), (-1.8, 0.26, 0.99, 0.87), (-2.15, 0.34, 0.95, 0.8),
                (-2.24, 0.44, 0.86, 0.66)]
    extras = Mesh()
    for z, w in ((2.22, 0.74), (-2.2, 0.76)):
        path = spline([(-w - 0.08, 0.44, z * 0.9), (-w, 0.44, z * 0.985), (0, 0.44, z * 1.035), (w, 0.44, z * 0.985),
                       (w + 0.08, 0.44, z * 0.9)], 6)
        extras.add(sweep(path, superellipse(0.05, 0.075, 3, 20), up=(0, 1, 0), ends="round"))
    extras.add(both_sides(ellipsoid(0.17, 0.085, 0.1, 20).moved(0.56, 0.66, 2.14)))
    extras.add(both_sides(box(0.3, 0.11, 0.1, 0.03).moved(0.55, 0.78, -2.17)))
    extras.add(both_sides(ellipsoid(0.09, 0.07, 0.06, 16).moved(0.97, 1.02, 0.62)))
    extras.add(box(0.62, 0.13, 0.06, 0.02).moved(0, 0.62, 2.24))
    pillars = [(1.02, 0.22), (-0.12, -0.22), (-1.42, -0.92)]
    return car(stations, (0.82, 1.12, -1.62, 0.93), (0.62, 0.3, -1.02, 1.40), (1.36, -1.34), 0.325, pillars, extras)


def car_van():
    """A small round-nosed van."""
    stations = [(1.98, 0.45, 0.9, 0.55), (1.94, 0.34, 1.0, 0.7), (1.75, 0.26, 1.1, 0.82), (1.3, 0.23, 1.16, 0.86),
                (0.2, 0.22, 1.18, 0.88), (-1.2, 0.22, 1.18, 0.88), (-1.95, 0.26, 1.18, 0.86), (-2.1, 0.36, 1.12, 0.8),
                (-2.15, 0.5, 1.0, 0.7)]
    extras = Mesh()
    for z in (1.98, -2.1):
        path = spline([(-0.86, 0.42, z * 0.86), (-0.76, 0.42, z * 0.96), (0, 0.42, z * 1.03), (0.76, 0.42, z * 0.96),
                       (0.86, 0.42, z * 0.86)], 6)
        extras.add(sweep(path, superellipse(0.045, 0.07, 3, 20), up=(0, 1, 0), ends="round"))
    lamp = revolve([(0, 0), (0.15, 0), (0.16, 0.05)] +
     spline([(0.13, 0.08), (0.07, 0.12), (0, 0.13)], 3), 28).turned("x", 90)
    extras.add(both_sides(lamp.moved(0.53, 0.78, 1.88)))
    extras.add(cylinder(0.2, 0.06, 0.02, 36).turned("x", 90).moved(0, 0.8, 1.95))
    extras.add(both_sides(ellipsoid(0.08, 0.11, 0.05, 16).moved(0.98, 1.32, 1.25)))
    for x in (-0.5, 0, 0.5):
        extras.add(rod((x, 1.86, 0.6), (x, 1.86, -1.6), 0.025, 10))
    for z in (0.4, -0.5, -1.4):
        extras.add(rod((-0.62, 1.86, z), (0.62, 1.86, z), 0.025, 10))
        for x in (-0.62, 0.62):
            extras.add(rod((x, 1.86, z), (x, 1.68, z), 0.025, 10))
    pillars = [(1.55, 1.12), (0.62, 0.52), (-0.6, -0.58), (-1.95, -1.78)]
    return car(stations, (0.83, 1.66, -2.04, 1.13), (0.7, 1.22, -1.9, 1.70), (1.22, -1.28), 0.33, pillars, extras)


def hull(stations, freeboard, n=10):
    """An open boat: (z, half beam, keel y, gunwale y) from stern to bow; `freeboard`: deck to gunwale."""
    rings = []
    for z, beam, keel, rail in stations:
        deep = rail - keel
        out = []
        for i in range(2 * n + 1):
            a = math.pi * i / (2 * n)
            across = math.copysign(abs(math.cos(a)) ** 0.62, math.cos(a))
            out.append((-beam * across, rail - deep * math.sin(a) ** 0.85, z))
        inner = max(beam - 0.09, beam * 0.5)
        deck = min(freeboard, deep * 0.5)
        back = [(inner, rail, z), (inner, rail - deck, z), (inner * 0.5, rail - deck, z), (0.0, rail - deck, z),
                (-inner * 0.5, rail - deck, z), (-inner, rail - deck, z), (-inner, rail, z)]
        rings.append(out + back)
    return loft(rings)


def sail(corners, belly, n=14):
    """A triangular sail of cloth (tack, clew, head), its middle pushed out to +X by `belly`."""
    tack, clew, head = corners
    rings = []
    for k in range(n + 1):
        t = min(k / n, 0.985)
        luff, leech = mix(tack, head, t), mix(clew, head, t)
        ring = []
        for side in (1, -1):
            for i in range(9):
                s = i / 8 if side > 0 else 1 - i / 8
                p = mix(luff, leech, s)
                push = belly * 4 * s * (1 - s) ** 1.2 * math.sin(math.pi * min(1.0, t * 0.9 + 0.12))
                ring.append((p[0] + push + side * 0.018, p[1], p[2] - 0.08 * math.sin(math.pi * t) * s))
        rings.append(ring)
    return loft(rings)


def boat_sailing():
    """A sloop under mainsail and jib."""
    lines = spline([(-3.3, 0.75, -0.15, 0.62), (-2.0, 1.05, -0.42, 0.58), (-0.3, 1.2, -0.55, 0.56),
                   (1.4, 1.0, -0.48, 0.62), (2.8, 0.5, -0.2, 0.74), (3.5, 0.12, 0.25, 0.84),
                    (3.68, 0.03, 0.62, 0.87)], 5)
    boat = hull(lines, 0.16)
    house = [[(s, y, 0.35 + u) for s, u in superellipse(w, l, 3.2, 44)]
             for w, l, y in ((0.68, 1.35, 0.38), (0.66, 1.3, 0.62), (0.6, 1.2, 0.78), (0.5, 1.05, 0.84),
                             (0.2, 0.5, 0.87))]
    boat.add(loft(house))
    boat.add(rod((0, 0.3, 0.75), (0, 8.6, 0.6), (0.075, 0.045), 16))
    boat.add(rod((0, 1.3, 0.72), (0.45, 1.35, -2.75), (0.06, 0.05), 14))
    boat.add(sail([(0.0, 1.42, 0.62), (0.42, 1.45, -2.6), (0.0, 8.3, 0.52)], 0.42))
    boat.add(sail([(0.0, 1.0, 3.45), (0.5, 1.25, 0.55), (0.0, 7.0, 0.78)], 0.42))
    for a, b in (((0, 0.85, 3.58), (0, 7.2, 0.66)), ((0, 0.62, -3.2), (0, 8.5, 0.6)),
                 ((1.1, 0.55, 0.4), (0.05, 6.6, 0.65)), ((-1.1, 0.55, 0.4), (-0.05, 6.6, 0.65))):
        boat.add(rod(a, b, 0.022, 8))
    keel = wing([((0, -0.35, 1.2), 2.6, 0.08), ((0, -0.82, 0.9), 2.1, 0.09),
                 ((0, -0.9, 0.75), 1.8, 0.05)], upright=True)
    rudder = wing([((0, 0.45, -3.25), 0.35, 0.14), ((0, -0.6, -3.2), 0.42, 0.12),
                  ((0, -0.68, -3.25), 0.3, 0.06)], upright=True)
    return boat.add(keel).add(rudder)


def boat_tug():
    """A harbour tug."""
    lines = spline([(-4.2, 1.1, 0.2, 1.15), (-3.9, 1.5, -0.35, 1.12), (-2.2, 1.85, -0.7, 1.05), (0.0, 1.95, -0.8, 1.1),
                    (2.0, 1.75, -0.75, 1.35), (3.4, 1.1, -0.55, 1.72), (4.1, 0.4, -0.1, 1.98),
                    (4.3, 0.06, 0.5, 2.06)], 5)
    boat = hull(lines, 0.4)
    rub = [(beam + 0.02, rail - 0.12, z) for z, beam, keel, rail in lines[2:]]
    boat.add(both_sides(tube(rub, 0.1, 10)))

    def storey(w, l, low, high, z):
        return loft([[(s, y, z + u) for s, u in superellipse(w - d, l - d, 4.5, 48)]
                     for y, d in ((low, 0), (high - 0.06, 0.03), (high - 0.06, -0.12), (high, -0.12),
                                  (high + 0.04, -0.02))])

    boat.add(storey(1.15, 1.7, 0.55, 1.95, 0.2)).add(storey(0.85, 0.75, 1.9, 3.05, 0.95))
    for a in (-52, -18, 18, 52, 90, -90):
        turn = math.radians(a)
        boat.add(box(0.34, 0.42, 0.06, 0.02).turned("y", a).moved(
            0.79 * math.sin(turn) * 1.03, 2.52, 0.95 + 0.70 * math.cos(turn) * 1.03))
    funnel = [(0, 1.8), (0.42, 1.8), (0.4, 3.0), (0.45, 3.0), (0.45, 3.12), (0.39, 3.12), (0.37, 3.45)]
    funnel = revolve(funnel + arc((0.34, 3.45), 0.03, 0, 180, 4) + [(0.3, 3.1), (0, 3.1)], 36)
    boat.add(funnel.mapped(lambda x, y, z: (x, y, z * 1.15 - 0.75 - 0.06 * y)))
    boat.add(rod((0, 3.0, 0.75), (0, 4.7, 0.6), (0.06, 0.035), 12)).add(
        rod((-0.5, 4.1, 0.65), (0.5, 4.1, 0.65), 0.03, 10))
    for z, beam, _, rail in lines[8:28:5]:
        ring = torus(0.24, 0.1, 28, 12).turned("z", 90).moved(beam + 0.12, rail - 0.36, z)
        boat.add(both_sides(ring))
    for x in (-0.35, 0.35):
        boat.add(cylinder(0.1, 0.6, 0.04, 20).moved(x, 0.55, -2.7))
    boat.add(rod((-0.55, 0.98, -2.7), (0.55, 0.98, -2.7), 0.06, 12))
    return boat
