# SPDX-License-Identifier: CC0-1.0
"""Chairs, tables and lamps. Lengths in centimetres."""
import math

from .curves import add, arc, mul, rounded_polygon, spline, sub, superellipse, unit
from .mesh import Mesh
from .surfaces import box, cylinder, ellipsoid, loft, revolve, rod, slab, sweep


def bar(a, b, width, depth, up=(0, 0, 1)):
    """A straight bar of rounded rectangular section between two points."""
    return sweep([a, b], rounded_polygon([(-width / 2, -depth / 2), (width / 2, -depth / 2), (width / 2, depth / 2),
                                          (-width / 2, depth / 2)], min(width, depth) * 0.25, 3), up)


def chair_slats():
    """A wooden dining chair with a curved back of four slats."""
    seat = slab(rounded_polygon([(-19.5, -20), (19.5, -20), (22, 21),
                (-22, 21)], [3, 3, 5, 5], 6), 3.2, 1.1).moved(y=43)
    chair = Mesh().add(seat)
    for side in (-1, 1):
        chair.add(sweep([(side * 19, 0, 18), (side * 18.8, 43.5, 17.5)],
                        [superellipse(1.5, 1.5, 4, 24), superellipse(2.1, 2.1, 4, 24)], up=(0, 0, 1)))
        post = spline([(side * 17.5, 0, -23), (side * 17.5, 22, -19.5), (side * 17.5,
                      45, -18.5), (side * 17.5, 70, -21.5), (side * 17, 96, -27)], 7)
        sizes = [1.5 + 0.6 * math.sin(math.pi * (i + 4) / (len(post) + 6)) for i in range(len(post))]
        chair.add(sweep(post, [superellipse(s, s, 4, 24) for s in sizes], up=(0, 0, 1), ends="round"))
        chair.add(bar((side * 18.3, 38.5, -17), (side * 18.8, 38.5, 16), 5.5, 2.0, up=(1, 0, 0)))
        chair.add(bar((side * 17.9, 17, -18.5), (side * 18.9, 17, 17), 2.6, 1.8, up=(1, 0, 0)))
    chair.add(bar((-18, 38.5, 17), (18, 38.5, 17), 5.5, 2.0, up=(0, 0, 1)))
    chair.add(bar((-18, 17, 0), (18, 17, 0), 2.6, 1.8, up=(0, 0, 1)))
    for y, z, tall in ((58, -19.8, 4.5), (69, -21.4, 4.5), (80, -23.6, 4.5), (91, -26.0, 7.5)):
        path = spline([(-17, y, z), (-9, y, z - 2.6), (0, y, z - 3.5), (9, y, z - 2.6), (17, y, z)], 5)
        chair.add(sweep(path, superellipse(0.8, tall / 2, 4, 28), up=(0, 1, 0)))
    return chair


def chair_shell():
    """A moulded shell on four splayed legs."""
    spine = spline([(0, 41.5, 23), (0, 44, 20.5), (0, 43.5, 12), (0, 41, 0), (0, 41.5, -10), (0, 47, -17.5),
                    (0, 57, -20.5), (0, 70, -23), (0, 80, -26.5)], 5)
    upper, lower, m = [], [], 24
    for k, p in enumerate(spine):
        t = k / (len(spine) - 1)
        half = 21.5 * min(1.0, (0.30 + 2.6 * t) ** 0.35) * (1 - 0.30 * max(0.0, (t - 0.45) / 0.55) ** 2)
        if t > 0.84:  # the rounded top
            half *= (1 - ((t - 0.84) / 0.168) ** 2) ** 0.5
        ahead, behind = spine[min(k + 1, len(spine) - 1)], spine[max(k - 1, 0)]
        tangent = unit(sub(ahead, behind))
        normal = (0.0, -tangent[2], tangent[1])
        bowl = 1.5 + 5.5 * math.exp(-((t - 0.42) / 0.22) ** 2) + 3.0 * t
        row_up, row_low = [], []
        for i in range(m + 1):
            s = 2 * i / m - 1
            lift = bowl * (half / 21.5) ** 2 * s * s
            middle = add(p, (s * half, 0, 0))
            row_up.append(add(middle, mul(normal, lift + 0.6)))
            row_low.append(add(middle, mul(normal, lift - 0.6)))
        upper.append(row_up)
        lower.append(row_low)
    chair = loft([up + low[::-1] for up, low in zip(upper, lower)])
    for sx in (-1, 1):
        for top, foot in (((sx * 9, 41.2, 9), (sx * 21, 0, 20)), ((sx * 9, 41.2, -9), (sx * 21, 0, -21))):
            chair.add(rod(foot, top, (1.0, 1.7), 20))
        chair.add(rod((sx * 13.3, 26, 13), (sx * 13.3, 26, -13.4), 0.55, 12))
    chair.add(rod((-13.3, 26, 0), (13.3, 26, 0), 0.55, 12))
    chair.add(box(22, 1.6, 22, 0.5).moved(y=40.3))
    return chair


def turned_leg(height):
    """The profile of a table leg turned on a lathe; square at the top."""
    r = spline([(1.6, 0), (2.3, 0.6), (2.6, 2.0), (1.9, 3.6), (1.6, 4.4), (1.6, 4.4), (2.0, 4.8), (2.0, 5.6),
                (1.6, 6.0), (1.6, 6.0), (2.0, 14), (2.9, 30), (3.3, 42), (2.4, 49), (2.0, 51.0), (2.0, 51.0),
                (2.9, 51.6), (2.9, 53.0), (2.0, 53.6), (2.0, 53.6), (3.1, 55.0)], 4)
    leg = revolve([(0, 0)] + r + [(0, 55)], 24)
    return leg.add(box(7, height - 54.5, 7, 0.5).moved(y=54.5 + (height - 54.5) / 2))


def table_farm():
    """A long table on four turned legs."""
    table = box(160, 3.2, 84, 1.0, 4).moved(y=74.4)
    for x in (-70, 70):
        for z in (-33, 33):
            table.add(turned_leg(72.9).moved(x, 0, z))
        table.add(box(2.2, 10, 62, 0.3).moved(x, 67.6, 0))
    for z in (-33, 33):
        table.add(box(136, 10, 2.2, 0.3).moved(0, 67.6, z))
    return table


def table_round():
    """A round table on a turned pillar with three bowed feet."""
    top = revolve([(0, 71.5), (46, 71.5)] + arc((47.5, 73), 1.5, -90,
                  90, 8) + [(45.5, 74.5), (30, 74.5), (0, 74.5)], 72)
    pillar = revolve([(0, 15)] + spline([(4.2, 15), (5.2, 16.5), (5.2, 21), (3.4, 24), (3.2, 26), (3.2, 26),
                                         (4.3, 27.5), (6.2, 34), (5.6, 42), (3.4, 50), (2.9, 56), (3.6, 61),
                                         (3.6, 61), (4.6, 62.5), (4.6, 64), (3.8, 65.5), (3.8, 65.5), (6, 68),
                                         (14, 71), (16, 71.8)], 4) +
                     [(0, 71.8)], 40)
    table = top.add(pillar)
    foot = spline([(3.0, 21, 0), (10, 20.5, 0), (19, 14.5, 0), (27, 6.5, 0), (34, 2.6, 0), (38, 2.4, 0)], 6)
    sizes = [(3.6 - 2.0 * i / (len(foot) - 1)) for i in range(len(foot))]
    leg = sweep(foot, [superellipse(0.62 * s, s, 3, 24) for s in sizes], up=(0, 0, 1), ends="round")
    leg = leg.mapped(lambda x, y, z: (x, max(y, 0.0), z)).add(ellipsoid(2.2, 1.3, 2.2, 20).moved(37.5, 1.3, 0))
    for k in range(3):
        table.add(leg.turned("y", 120 * k + 90))
    return table


def shade(profile, thickness, n):
    """A thin open shade: a profile of (radius, y) given a thickness inwards."""
    return revolve(profile + [(r - thickness, y) for r, y in reversed(profile)], n, closed=True)


def lamp_desk():
    """A jointed desk lamp."""
    lamp = revolve([(0, 0)] + arc((8.2, 0.8), 0.8, -90, 0, 4)
                   + spline([(9.0, 1.4), (8.6, 2.0), (6.0, 2.6), (1.6, 3.1)], 4) + [(1.5, 5.2), (0, 5.4)], 56)
    low, knee, head = (0, 4.6, 0), (-13.0, 27.0, 0), (10.0, 45.0, 0)
    for z in (-0.9, 0.9):
        lamp.add(rod((low[0], low[1], z), (knee[0], knee[1], z), 0.5, 14))
        lamp.add(rod((knee[0], knee[1], z), (head[0], head[1], z), 0.5, 14))
    for p, r in ((low, 1.3), (knee, 1.6), (head, 1.5)):
        lamp.add(cylinder(r, 4.4, 0.4, 28).moved(y=-2.2).turned("x", 90).moved(*p))
    lamp.add(rod((-5.5, 20.5, 0), (-7.6, 31.3, 0), 0.35, 10))
    bell = spline([(1.8, 7.6), (2.4, 7.2), (2.9, 5.0), (3.4, 3.0), (5.2, 0.0), (7.4, -4.4), (7.9, -6.0)], 5)
    hood = shade(bell, 0.28, 48).add(revolve([(0, 7.0), (1.9, 7.0), (1.9, 7.9), (1.2, 9.4), (0, 9.7)], 32))
    hood.add(ellipsoid(2.6, 3.4, 2.6, 28).moved(y=-1.6)).add(cylinder(1.5, 6.5, 0.2, 24).moved(y=0.8))
    neck = rod(head, (13.2, 43.2, 0), 0.9, 16)
    return lamp.add(neck).add(hood.turned("z", 32).moved(14.2, 41.0, 0))


def lamp_table():
    """A table lamp: a turned foot and a pleated shade."""
    foot = revolve([(0, 0)] + spline([(7.6, 0), (8.0, 0.5), (7.8, 1.2), (5.6, 2.2), (2.6, 3.4), (2.0, 4.6), (2.0, 4.6),
                                      (2.8, 5.2), (2.8, 6.0), (2.2, 6.6), (2.2, 6.6), (4.4, 9.0), (6.3, 13.5),
                                      (5.2, 18.5), (2.4, 22.5), (1.6, 25.0), (1.6, 25.0), (2.3, 25.6), (2.3, 26.4),
                                      (1.2, 27.2), (1.0, 28.0)], 4) + [(0.7, 28.2), (0.7, 31.5), (0, 31.5)], 48)
    foot.add(ellipsoid(2.8, 3.6, 2.8, 24).moved(y=34.5))
    rings = []
    outer = [(12.6, 28.5), (12.2, 29.4), (10.9, 34.0), (9.6, 38.6), (8.4, 43.0), (8.2, 43.8)]
    for r, y in outer + [(r - 0.3, y) for r, y in reversed(outer)]:
        rings.append([((r + 0.16 * math.cos(60 * a)) * math.cos(a), y, (r + 0.16 * math.cos(60 * a)) * math.sin(a))
                      for a in (2 * math.pi * i / 240 for i in range(240))])
    foot.add(loft(rings, closed=True))
    for k in range(3):
        a = 2 * math.pi * k / 3
        foot.add(rod((0, 41, 0), (8.6 * math.cos(a), 42, 8.6 * math.sin(a)), 0.25, 8))
    return foot.add(rod((0, 31, 0), (0, 42.5, 0), 0.35, 10)).add(ellipsoid(0.8, 0.9, 0.8, 16).moved(y=42.8))
