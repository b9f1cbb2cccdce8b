# SPDX-License-Identifier: CC0-1.0
"""Curves as lists of points (tuples of any dimension) and the small vector algebra the surfaces need."""
import math


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def mul(a, s):
    return tuple(x * s for x in a)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(dot(a, a))
    return mul(a, 1 / length)


def mix(a, b, t):
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def spline(points, steps, closed=False):
    """Centripetal Catmull-Rom curve through `points`, `steps` pieces between two of them. A point given twice in a row
    is a corner: the curve stops there and starts anew."""
    if closed:
        return _smooth(points, steps, True)
    result, run = [], [points[0]]
    for p in points[1:]:
        if p == run[-1]:
            result += _smooth(run, steps, False)[:-1]
            run = [p]
        else:
            run.append(p)
    return result + _smooth(run, steps, False)


def _smooth(points, steps, closed):
    n = len(points)
    if n == 1:
        return list(points)
    if n == 2 and not closed:
        return [mix(points[0], points[1], i / steps) for i in range(steps + 1)]
    if closed:
        ring = [points[-1]] + list(points) + [points[0], points[1]]
    else:
        ring = [sub(mul(points[0], 2), points[1])] + list(points) + [sub(mul(points[-1], 2), points[-2])]
    result = []
    for i in range(len(ring) - 3):
        result += [_catmull_rom(ring[i:i + 4], k / steps) for k in range(steps)]
    return result if closed else result + [tuple(points[-1])]


def _catmull_rom(p, t):
    """Barry and Goldman's pyramid with knots at the square roots of the distances; t from 0 to 1 is p[1] to p[2]."""
    k = [0.0]
    for a, b in zip(p, p[1:]):
        k.append(k[-1] + math.sqrt(math.dist(a, b)))
    t = k[1] + (k[2] - k[1]) * t
    a = [mix(p[i], p[i + 1], (t - k[i]) / (k[i + 1] - k[i])) for i in range(3)]
    b = [mix(a[i], a[i + 1], (t - k[i]) / (k[i + 2] - k[i])) for i in range(2)]
    return mix(b[0], b[1], (t - k[1]) / (k[2] - k[1]))


def arc(centre, radius, start, end, steps):
    """Points of a circular arc in the plane, degrees, both ends included."""
    angles = (math.radians(start + (end - start) * i / steps) for i in range(steps + 1))
    return [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in angles]


def circle(radius, n, aspect=1.0):
    """A closed ring in the plane, counter-clockwise; `aspect` scales its second axis."""
    return [(radius * math.cos(2 * math.pi * i / n), radius * aspect * math.sin(2 * math.pi * i / n)) for i in range(n)]


def superellipse(a, b, power, n):
    """|x/a|^power + |y/b|^power = 1, counter-clockwise; 2 is an ellipse, large powers near a rectangle."""
    ring = []
    for i in range(n):
        t = 2 * math.pi * i / n
        c, s = math.cos(t), math.sin(t)
        ring.append((math.copysign(abs(c) ** (2 / power), c) * a, math.copysign(abs(s) ** (2 / power), s) * b))
    return ring


def rounded_polygon(corners, radius, steps):
    """A counter-clockwise polygon with every corner replaced by an arc of `steps` pieces (radius: one, or one each)."""
    n = len(corners)
    radii = [radius] * n if isinstance(radius, (int, float)) else radius
    ring = []
    for i in range(n):
        p, r = corners[i], radii[i]
        if r <= 0:
            ring.append(tuple(p))
            continue
        to_last, to_next = unit(sub(corners[i - 1], p)), unit(sub(corners[(i + 1) % n], p))
        half = 0.5 * math.acos(max(-1.0, min(1.0, dot(to_last, to_next))))
        centre = add(p, mul(unit(add(to_last, to_next)), r / math.sin(half)))
        first = add(p, mul(to_last, r / math.tan(half)))
        last = add(p, mul(to_next, r / math.tan(half)))
        start = math.atan2(first[1] - centre[1], first[0] - centre[0])
        turn = math.atan2(last[1] - centre[1], last[0] - centre[0]) - start
        turn = (turn + math.pi) % (2 * math.pi) - math.pi
        angles = (start + turn * k / steps for k in range(steps + 1))
        ring += [(centre[0] + r * math.cos(a), centre[1] + r * math.sin(a)) for a in angles]
    return ring


def resampled(points, n, closed=False):
    """The same line as n + 1 points (n, if closed) at equal distances along it."""
    line = list(points) + ([points[0]] if closed else [])
    lengths = [0.0]
    for a, b in zip(line, line[1:]):
        lengths.append(lengths[-1] + math.dist(a, b))
    result, piece = [], 0
    for i in range(n if closed else n + 1):
        want = lengths[-1] * i / n
        while piece < len(line) - 2 and lengths[piece + 1] < want:
            piece += 1
        width = lengths[piece + 1] - lengths[piece]
        result.append(mix(line[piece], line[piece + 1], (want - lengths[piece]) / width if width else 0.0))
    return result
