# SPDX-License-Identifier: CC0-1.0
"""Houses. Lengths in metres; the front door towards +Z."""
from .curves import arc
from .mesh import Mesh
from .surfaces import box, cylinder, ellipsoid, loft, revolve, rod, slab


def block(x0, x1, y0, y1, z0, z1, bevel=0.0):
    return box(x1 - x0, y1 - y0, z1 - z0, bevel, 2).moved((x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2)


def gable(width, eaves, ridge, z0, z1):
    """A house's walls up to the roof: a five-cornered prism along z."""
    ring = [(-width / 2, 0), (width / 2, 0), (width / 2, eaves), (0, ridge), (-width / 2, eaves)]
    return loft([[(x, y, z0) for x, y in ring], [(x, y, z1) for x, y in ring]])


def roof(width, eaves, ridge, z0, z1, out, thick):
    """Two slopes with their eaves `out` beyond the walls, and rows of tiles as low steps."""
    slope = (ridge - eaves) / (width / 2)
    rows, top = 9, []
    for k in range(rows):
        for t, lift in ((k / rows, thick + 0.05), ((k + 0.98) / rows, thick)):
            x = (width / 2 + out) * (1 - t)
            top.append((x, ridge - slope * x + lift))
    ring = top + [(0.0, ridge + thick + 0.02)] + [(-x, y) for x, y in reversed(top)]
    under = [(-(width / 2 + out), eaves - slope * out), (0.0, ridge), (width / 2 + out, eaves - slope * out)]
    outline = ring + under
    cap = rod((0, ridge + thick + 0.03, z0 - out), (0, ridge + thick + 0.03, z1 + out), 0.11, 12, "flat")
    return prism(outline, z0 - out, z1 + out).add(cap)


def prism(ring, z0, z1):
    """An (x, y) outline of any shape pulled along z."""
    return slab([(x, -y) for x, y in ring], z1 - z0).turned("x", 90).moved(z=z0)


def window(width, height, shutters=True):
    """A framed window with cross bars and a sill about the origin, standing out towards +Z."""
    w, h = width / 2, height / 2
    mesh = block(-w - 0.09, -w, -h - 0.09, h + 0.09, -0.05, 0.07, 0.015)
    mesh.add(block(w, w + 0.09, -h - 0.09, h + 0.09, -0.05, 0.07, 0.015))
    mesh.add(block(-w, w, h, h + 0.09, -0.05, 0.07, 0.015))
    mesh.add(block(-w - 0.16, w + 0.16, -h - 0.14, -h, -0.05, 0.16, 0.02))
    mesh.add(block(-0.025, 0.025, -h, h, -0.05, 0.05)).add(block(-w, w, -0.025, 0.025, -0.05, 0.045))
    if shutters:
        for s in (-1, 1):
            middle = s * (w + 0.11 + w * 0.5)
            mesh.add(block(middle - w * 0.48, middle + w * 0.48, -h - 0.08, h + 0.08, -0.05, 0.05, 0.015))
            for k in range(6):
                y = -h + height * (k + 0.5) / 6
                mesh.add(box(w * 0.74, height / 9, 0.05).turned("x", 24).moved(middle, y, 0.055))
    return mesh


def door(width, height):
    mesh = block(-width / 2, width / 2, 0, height, -0.05, 0.03)
    for s in (-1, 1):
        mesh.add(block(s * width / 2 - 0.07, s * width / 2 + 0.07, 0, height + 0.07, -0.05, 0.1, 0.02))
        for y0, y1 in ((0.15, 0.48), (0.54, 0.92)):
            middle, half = s * width / 4, width * 0.17
            mesh.add(block(middle - half, middle + half, height * y0, height * y1, 0.0, 0.055, 0.02))
    mesh.add(block(-width / 2 - 0.1, width / 2 + 0.1, height, height + 0.14, -0.05, 0.12, 0.02))
    return mesh.add(ellipsoid(0.05, 0.05, 0.05, 12).moved(width * 0.4, height * 0.48, 0.07))


def chimney(x, z, low, high):
    mesh = block(x - 0.35, x + 0.35, low, high, z - 0.3, z + 0.3, 0.02)
    mesh.add(block(x - 0.43, x + 0.43, high - 0.25, high, z - 0.38, z + 0.38, 0.03))
    pot = revolve([(0, 0), (0.17, 0)] + arc((0.13, 0.36), 0.04, 0, 180, 4) + [(0.09, 0.1), (0, 0.1)], 24)
    return mesh.add(pot.moved(x - 0.14, high, z)).add(pot.moved(x + 0.16, high, z))


def steps(width, count, z):
    mesh = Mesh()
    for k in range(count):
        left = count - k
        half = width / 2 + 0.12 * left
        mesh.add(block(-half, half, 0, 0.13 * (k + 1), z - 0.1, z + 0.28 * left, 0.02))
    return mesh


def house_cottage():
    """A cottage: gabled roof, shutters, chimney, a porch on two posts."""
    house = gable(6.4, 3.1, 5.9, -4.4, 4.4).turned("y", 90).moved(y=0.25)
    house.add(roof(6.4, 3.35, 6.15, -4.4, 4.4, 0.42, 0.16).turned("y", 90))
    house.add(block(-4.55, 4.55, 0, 0.35, -3.35, 3.35, 0.04))
    for x in (-2.7, 2.7):
        house.add(window(0.95, 1.25).moved(x, 1.95, 3.2))
        house.add(window(0.95, 1.25).turned("y", 180).moved(x, 1.95, -3.2))
    house.add(window(0.95, 1.25).turned("y", 180).moved(0, 1.95, -3.2))
    for s in (-1, 1):
        for z in (-1.4, 1.4):
            house.add(window(0.85, 1.2, False).turned("y", 90 * s).moved(s * 4.4, 1.95, z))
        house.add(window(0.8, 0.95, False).turned("y", 90 * s).moved(s * 4.4, 4.3, 0))
    house.add(door(1.0, 2.05).moved(0, 0.35, 3.2)).add(steps(1.3, 2, 3.9))
    house.add(block(-1.0, 1.0, 0, 0.32, 3.1, 4.3, 0.03))
    porch = gable(2.2, 0.16, 0.95, -1.25, 0).moved(0, 2.62, 4.35)
    house.add(porch).add(roof(2.2, 2.78, 3.57, 3.1, 4.35, 0.14, 0.08))
    for x in (-0.95, 0.95):
        house.add(cylinder(0.09, 2.4, 0.02, 20).moved(x, 0.3, 4.15))
        for y in (0.38, 2.6):
            house.add(box(0.26, 0.12, 0.26, 0.02).moved(x, y, 4.15))
    return house.add(chimney(2.6, -0.9, 4.3, 7.3))


def house_tower():
    """A tall house with a round stair tower and a steep roof."""
    house = gable(5.2, 5.2, 8.9, -3.2, 3.2).add(roof(5.2, 5.2, 8.9, -3.2, 3.2, 0.32, 0.16))
    house.add(block(-2.75, 2.75, 0, 0.4, -3.35, 3.35, 0.04))
    house.add(block(-2.68, 2.68, 2.75, 2.92, -3.28, 3.28, 0.03))
    for y in (1.6, 4.1):
        for z in (-1.9, 0.0, 1.9):
            for s in (-1, 1):
                house.add(window(0.8, 1.2, False).turned("y", 90 * s).moved(2.6 * s, y, z))
        for x in (-1.3, 1.3):
            house.add(window(0.8, 1.2, False).turned("y", 180).moved(x, y, -3.2))
    for x, y in ((-1.35, 1.6), (-1.35, 4.1), (0.3, 4.1)):
        house.add(window(0.8, 1.2, False).moved(x, y, 3.2))
    for turn, z in ((0, 3.2), (180, -3.2)):
        house.add(window(0.75, 1.0, False).turned("y", turn).moved(0, 6.5, z))
    house.add(door(1.0, 2.1).moved(0.3, 0.3, 3.2)).add(steps(1.2, 2, 3.35).moved(0.3))
    tower = revolve([(0, 0), (1.62, 0), (1.62, 0.4), (1.5, 0.46), (1.5, 2.72), (1.58, 2.76),
                    (1.58, 2.92), (1.5, 2.96), (1.5, 6.3), (1.62, 6.4), (1.72, 6.7), (0, 6.7)], 56)
    tower.add(revolve([(0, 6.55), (1.98, 6.55), (2.0, 6.66), (1.55, 7.4),
              (1.05, 8.7), (0.55, 10.2), (0.1, 11.6), (0, 11.7)], 56))
    tower.add(rod((0, 11.4, 0), (0, 12.5, 0), 0.05, 10)).add(ellipsoid(0.14, 0.14, 0.14, 16).moved(y=12.0))
    for a, y in ((45, 1.5), (20, 3.6), (70, 5.2), (-20, 5.2), (120, 3.6)):
        tower.add(window(0.55, 0.95, False).moved(0, y, 1.47).turned("y", a))
    return house.add(tower.moved(2.5, 0, 3.0)).add(chimney(-1.2, -1.4, 6.4, 9.3))
