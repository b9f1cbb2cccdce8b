# SPDX-License-Identifier: CC0-1.0
"""Closed surfaces from curves: revolved, lofted, swept, extruded. Every function returns a Mesh that faces outwards."""
import math

from .curves import add, arc, circle, cross, dot, mul, rounded_polygon, sub, unit
from .mesh import Mesh


def revolve(profile, n=48, closed=False):
    """Turns (radius, y) points about the Y axis. An open profile starts and ends on the axis (radius 0)."""
    mesh = Mesh()
    rows = []
    for r, y in profile:
        start = len(mesh.points)
        count = 1 if r == 0 else n
        mesh.points += [(r * math.cos(2 * math.pi * i / n), y, r * math.sin(2 * math.pi * i / n)) for i in range(count)]
        rows.append((start, count))
    pairs = list(zip(rows, rows[1:])) + ([(rows[-1], rows[0])] if closed else [])
    for (a, a_count), (b, b_count) in pairs:
        for i in range(n):
            j = (i + 1) % n
            if a_count == 1 and b_count > 1:
                mesh.faces.append((a, b + i, b + j))
            elif b_count == 1 and a_count > 1:
                mesh.faces.append((a + j, a + i, b))
            elif a_count > 1:
                mesh.quad(a + i, b + i, b + j, a + j)
    return mesh.outward()


def loft(rings, closed=False):
    """Skins a row of rings of equal length. The first and last ring are closed by fans about their middles, so they
    must be star-shaped about them; a ring of one point is a tip."""
    mesh = Mesh()
    rows = []
    for ring in rings:
        rows.append((len(mesh.points), len(ring)))
        mesh.points += [tuple(p) for p in ring]
    n = max(len(ring) for ring in rings)
    for (a, a_count), (b, b_count) in list(zip(rows, rows[1:])) + ([(rows[-1], rows[0])] if closed else []):
        for i in range(n):
            j = (i + 1) % n
            if a_count == 1:
                mesh.faces.append((a, b + j, b + i))
            elif b_count == 1:
                mesh.faces.append((a + i, a + j, b))
            else:
                mesh.quad(a + i, a + j, b + j, b + i)
    if not closed:
        for (start, count), flip in ((rows[0], True), (rows[-1], False)):
            if count > 1:
                _fan(mesh, start, count, flip)
    return mesh.outward()


def _fan(mesh, start, count, flip):
    ring = mesh.points[start:start + count]
    centre = len(mesh.points)
    mesh.points.append(mul(tuple(sum(c) for c in zip(*ring)), 1 / count))
    for i in range(count):
        a, b = start + i, start + (i + 1) % count
        mesh.faces.append((b, a, centre) if flip else (a, b, centre))


def frames(path, up=None, closed=False):
    """(side, normal) for each point of a path: carried along without twist, or, with `up`, side = up x tangent."""
    n = len(path)
    result, normal = [], None
    for i in range(n):
        before = path[i - 1] if i or closed else path[0]
        after = path[(i + 1) % n] if i + 1 < n or closed else path[-1]
        tangent = unit(sub(after, before))
        if up is not None:
            side = unit(cross(up, tangent))
        else:
            if normal is None:
                least = min(range(3), key=lambda k: abs(tangent[k]))
                normal = tuple(1.0 if k == least else 0.0 for k in range(3))
            normal = sub(normal, mul(tangent, dot(normal, tangent)))
            side = unit(cross(normal, tangent))
        normal = unit(cross(tangent, side))
        result.append((side, normal))
    return result


def sweep(path, sections, up=None, closed=False, ends="flat"):
    """Carries a ring of (side, normal) coordinates along a path of 3D points. `sections` is one ring or one for each
    point. `ends` is "flat" or "round" (domes as high as half the section is wide)."""
    if isinstance(sections[0][0], (int, float)):
        sections = [sections] * len(path)
    path, sections, axes = list(path), list(sections), frames(path, up, closed)
    if ends == "round" and not closed:
        path, sections, axes = _domed(path, sections, axes)
    rings = []
    for p, section, (side, normal) in zip(path, sections, axes):
        rings.append([add(p, add(mul(side, s), mul(normal, t))) for s, t in section])
    return loft(rings, closed)


def _domed(path, sections, axes, steps=5):
    for end, inner in ((0, 1), (-1, -2)):
        outward = unit(sub(path[end], path[inner]))
        height = min(math.hypot(*p) for p in sections[end])
        base, section, axis = path[end], sections[end], axes[end]
        for k in range(1, steps + 1):
            a = math.pi / 2 * k / steps
            width = math.cos(a)
            ring = [(s * width, t * width) for s, t in section] if k < steps else [(0.0, 0.0)]
            at = 0 if end == 0 else len(path)
            path.insert(at, add(base, mul(outward, height * math.sin(a))))
            sections.insert(at, ring)
            axes.insert(at, axis)
    return path, sections, axes


def tube(path, radius, n=12, up=None, closed=False, ends="round"):
    """A round pipe; `radius` is one number or one for each point."""
    radii = [radius] * len(path) if isinstance(radius, (int, float)) else radius
    return sweep(path, [circle(r, n) for r in radii], up, closed, ends)


def inset(ring, distance):
    """A counter-clockwise plane ring moved inwards along its corner bisectors (keeps the number of points)."""
    n, result = len(ring), []
    for i in range(n):
        a, b = unit(sub(ring[i], ring[i - 1])), unit(sub(ring[(i + 1) % n], ring[i]))
        normal = unit((-a[1] - b[1], a[0] + b[0]))
        lean = max(0.25, dot(normal, (-a[1], a[0])))
        result.append(add(ring[i], mul(normal, distance / lean)))
    return result


def slab(ring, height, bevel=0.0, steps=4):
    """A plane (x, z) ring extruded from y = 0 to `height`, its edges rounded by `bevel`. Any simple polygon will do."""
    if sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(ring, ring[1:] + ring[:1])) < 0:
        ring = ring[::-1]
    if bevel > 0:
        low = [(bevel * (1 - math.cos(a)), bevel * (1 - math.sin(a)))
               for a in (math.pi / 2 * k / steps for k in range(steps + 1))]
        rows = low + [(d, height - y) for d, y in reversed(low)]
    else:
        rows = [(0.0, 0.0), (0.0, height)]
    mesh, n = Mesh(), len(ring)
    for distance, y in rows:
        mesh.points += [(x, y, z) for x, z in inset(ring, distance)]
    for k in range(len(rows) - 1):
        for i in range(n):
            j = (i + 1) % n
            mesh.quad(k * n + i, (k + 1) * n + i, (k + 1) * n + j, k * n + j)
    top = (len(rows) - 1) * n
    for a, b, c in ears([(x, z) for x, _, z in mesh.points[:n]]):
        mesh.faces.append((a, b, c))
        mesh.faces.append((top + a, top + c, top + b))
    return mesh.outward()


def ears(ring):
    """Triangles of a simple counter-clockwise polygon by ear clipping; the roundest ear goes first."""
    left, result = list(range(len(ring))), []

    def turn(a, b, c):
        (ax, ay), (bx, by), (cx, cy) = ring[a], ring[b], ring[c]
        return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)

    def is_ear(a, b, c):
        if turn(a, b, c) <= 0:
            return False
        return not any(turn(a, b, p) >= 0 and turn(b, c, p) >= 0 and turn(c, a, p) >= 0
                       for p in left if p not in (a, b, c))

    while len(left) > 3:
        best, best_shape = None, -1.0
        for i in range(len(left)):
            a, b, c = left[i - 1], left[i], left[(i + 1) % len(left)]
            sides = sum(math.dist(ring[p], ring[q]) ** 2 for p, q in ((a, b), (b, c), (c, a)))
            shape = turn(a, b, c) / sides
            if shape > best_shape and is_ear(a, b, c):
                best, best_shape = i, shape
        if best is None:
            raise ValueError("ears: the polygon crosses itself")
        result.append((left[best - 1], left[best], left[(best + 1) % len(left)]))
        del left[best]
    return result + [tuple(left)]


def box(x, y, z, bevel=0.0, steps=3):
    """A box with its middle at the origin and all edges and corners rounded by `bevel`."""
    corners = [(-x / 2, -z / 2), (x / 2, -z / 2), (x / 2, z / 2), (-x / 2, z / 2)]
    # The inset of the slab's edge needs corner arcs that are a little wider than the edge itself.
    ring = rounded_polygon(corners, bevel * 1.02, steps) if bevel > 0 else corners
    return slab(ring, y, bevel, steps).moved(y=-y / 2)


def ellipsoid(x, y, z, n=32):
    """Half axes x, y, z about the origin."""
    half = [(math.cos(a), math.sin(a)) for a in (math.pi * (k / (n // 2) - 0.5) for k in range(1, n // 2))]
    return revolve([(0, -1)] + half + [(0, 1)], n).scaled(x, y, z)


def cylinder(radius, height, bevel=0.0, n=32, steps=3):
    """An upright cylinder from y = 0 with rounded rims."""
    if bevel == 0:
        return revolve([(0, 0), (radius, 0), (radius, height), (0, height)], n)
    low = arc((radius - bevel, bevel), bevel, -90, 0, steps)
    high = arc((radius - bevel, height - bevel), bevel, 0, 90, steps)
    return revolve([(0, 0)] + low + high + [(0, height)], n)


def torus(radius, thickness, n=48, m=16):
    """A ring about the Y axis."""
    return revolve([(radius + x, y) for x, y in circle(thickness, m)], n, closed=True)


def rod(a, b, radius, n=12, ends="round"):
    """A straight round bar between two points; `radius` may be a pair for a tapering one."""
    r = (radius, radius) if isinstance(radius, (int, float)) else radius
    return tube([a, b], r, n, ends=ends)
