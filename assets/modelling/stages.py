# SPDX-License-Identifier: CC0-1.0
"""The meshes of the environments: Z up, metres, the object's place on the ground at x = y = 0, z = GROUND."""
import math

from .curves import arc
from .mesh import Mesh
from .normals import with_normals
from .surfaces import box, loft, revolve

GROUND = -0.0574


def turned(profile, n, tip=None):
    """Turns a (radius, z) profile with normals about the Z axis: points, normals and faces of a smooth surface seen
    from the side its normals (dr, dz) point to. `tip` is the height of a point on the axis before the first ring."""
    mesh, normals = Mesh(), []
    if tip is not None:
        mesh.points.append((0.0, 0.0, tip))
        normals.append((0.0, 0.0, math.copysign(1.0, profile[0][1][1])))
    base = len(mesh.points)
    for (r, z), (dr, dz) in profile:
        for i in range(n):
            c, s = math.cos(2 * math.pi * i / n), math.sin(2 * math.pi * i / n)
            mesh.points.append((r * c, r * s, z))
            normals.append((dr * c, dr * s, dz))
    for i in range(n):
        j = (i + 1) % n
        if tip is not None:
            mesh.faces.append((0, base + i, base + j))
        for k in range(len(profile) - 1):
            low, high = base + k * n, base + (k + 1) * n
            mesh.quad(low + i, high + i, high + j, low + j)
    return facing(mesh, normals), normals


def facing(mesh, normals):
    """Turns every face to the side of its corners' normals."""
    faces = []
    for a, b, c in mesh.faces:
        p, q, r = (mesh.points[i] for i in (a, b, c))
        u, v = [q[k] - p[k] for k in range(3)], [r[k] - p[k] for k in range(3)]
        face = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        towards = [sum(normals[i][k] for i in (a, b, c)) for k in range(3)]
        faces.append((a, b, c) if sum(x * y for x, y in zip(face, towards)) > 0 else (a, c, b))
    return Mesh(mesh.points, faces)


def backdrop():
    """The studio's bowl: a level floor that bends up into a wall all round, without an edge anywhere."""
    floor, bend, top = 0.8, 1.4, 3.2
    profile = [((floor * k / 8, GROUND), (0.0, 1.0)) for k in range(1, 8)]
    for r, z in arc((floor, GROUND + bend), bend, -90, 0, 32):
        profile.append(((r, z), ((floor - r) / bend, (GROUND + bend - z) / bend)))
    wall = floor + bend
    profile += [((wall, GROUND + bend + (top - bend) * k / 4), (-1.0, 0.0)) for k in range(1, 5)]
    return turned(profile, 128, tip=GROUND)


def z_up(mesh):
    return mesh.turned("x", 90)


def table_top():
    """A round table top, 1.5 m across, its edge a quarter round."""
    thickness, edge = 0.028, 0.012
    top = [(r, thickness) for r in (0.1, 0.25, 0.5)] + arc((0.738, thickness - edge), edge, 90, 0, 6)
    low = arc((0.738, edge), edge, 0, -90, 6) + [(0, 0)]
    return with_normals(z_up(revolve([(0, thickness)] + top + low, 96)).moved(z=GROUND - thickness))


def terrace():
    """A round terrace of three steps with rounded noses."""
    profile, height, nose = [(0, 0)], 0.0, 0.004
    for radius, rise in ((0.56, 0.026), (0.48, 0.026), (0.40, 0.026)):
        profile.append((radius, height))
        height += rise
        profile += arc((radius - nose, height - nose), nose, 0, 90, 4)
    return with_normals(z_up(revolve(profile + [(0.2, height), (0, height)], 96)).moved(z=GROUND - height))


def column(height, broken=False):
    """A fluted column with a turned foot and, unless it is broken off, a capital with a square slab."""
    r = 0.0105
    foot = revolve([(0, 0)] + arc((r * 1.35, 0.004), 0.004, -90, 90, 8) + [(r * 1.25, 0.010)] +
                   arc((r * 1.2, 0.0125), 0.0025, -90, 90, 6) + [(0, 0.015)], 32)
    plinth = box(r * 3.6, 0.005, r * 3.6, 0.0006, 2).moved(y=-0.0025)
    flutes, steps = 16, 12
    top = height - (0.0 if broken else 0.014)
    rings = []
    for k in range(steps + 1):
        t = k / steps
        radius = r * (1.0 - 0.16 * t * t)
        ring = []
        for i in range(flutes * 4):
            a = 2 * math.pi * i / (flutes * 4)
            depth = (0.0, 0.07, 0.1, 0.07)[i % 4]
            y = 0.015 + (top - 0.015) * t
            if broken:
                y += t * t * (0.006 * math.sin(a + 1) + 0.0025 * math.sin(3 * a) + 0.0012 * math.sin(7 * a + 2))
            ring.append((radius * (1 - depth) * math.cos(a), y, radius * (1 - depth) * math.sin(a)))
        rings.append(ring)
    mesh = plinth.add(foot).add(loft(rings))
    if not broken:
        neck = r * 0.84
        mesh.add(revolve([(0, top - 0.001), (neck * 1.12, top - 0.001), (neck * 1.12, top + 0.001)] +
                         arc((neck * 1.12, top + 0.006), 0.005, -80, 20, 6) + [(0, top + 0.009)], 32))
        mesh.add(box(r * 3.1, 0.006, r * 3.1, 0.0006, 2).moved(y=top + 0.011))
    return mesh.moved(y=0.005)


def columns():
    """Five columns round the object, nearer to it than the cameras, so that some views see it past one of them."""
    mesh = Mesh()
    for k, (height, broken) in enumerate(((0.138, False), (0.150, False), (0.110, True), (0.064, True),
                                          (0.150, False))):
        a = math.radians(8 + 72 * k)
        placed = column(height, broken).turned("y", 40 * k)
        mesh.add(z_up(placed).moved(0.172 * math.cos(a), 0.172 * math.sin(a), GROUND))
    return with_normals(mesh)


def meadow():
    """The ground to the horizon, finer near the terrace."""
    low = GROUND - 0.078
    profile = [((r, low), (0.0, 1.0)) for r in (0.3, 1, 3, 10, 30, 100, 300, 1000, 3000)]
    return turned(profile, 48, tip=low)
