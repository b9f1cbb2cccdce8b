# SPDX-License-Identifier: Apache-2.0
"""A folder of meshes, a folder for each class: solids of revolution and boxes of many proportions, as OBJ."""
import math
import random


def revolved(outline, sides=24):
    """The surface around y of a line of (radius, height)."""
    points = [(r * math.cos(2 * math.pi * i / sides), y, r * math.sin(2 * math.pi * i / sides))
              for r, y in outline for i in range(sides)]
    faces = [(a + i, a + sides + i, a + sides + (i + 1) % sides, a + (i + 1) % sides)
             for a in range(0, sides * (len(outline) - 1), sides) for i in range(sides)]
    return points, faces


def box(x, y, z):
    points = [(a * x, b * y, c * z) for a in (0, 1) for b in (0, 1) for c in (0, 1)]
    return points, [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def solid(kind, chance):
    height = chance.uniform(1.2, 2)
    if kind == "box":
        return box(chance.uniform(0.6, 1), height, chance.uniform(0.6, 1))
    if kind == "cone":
        return revolved([(0.001, height), (chance.uniform(0.5, 0.8), 0), (0.001, 0)])
    if kind == "ball":
        flat = chance.uniform(0.8, 1.1)
        turns = [math.pi * i / 12 for i in range(13)]
        return revolved([(math.sin(t) + 0.001, flat * math.cos(t)) for t in turns])
    radius, dent = chance.uniform(0.2, 0.3), chance.uniform(0.5, 0.7)  # a dumb-bell
    return revolved([(0.001, height), (dent, height), (dent, 0.8 * height), (radius, 0.7 * height), (radius, 0.3 * height),
                     (dent, 0.2 * height), (dent, 0), (0.001, 0)])


KINDS = ("ball", "bell", "box", "cone")


def write_solids(folder, each, seed=1):
    for kind in KINDS:
        (folder / kind).mkdir(parents=True, exist_ok=True)
        for number in range(each):
            points, faces = solid(kind, random.Random(f"{seed} {kind} {number}"))
            lines = ["v {:.5f} {:.5f} {:.5f}".format(*point) for point in points]
            lines += ["f " + " ".join(str(corner + 1) for corner in face) for face in faces]
            (folder / kind / f"{kind}-{number}.obj").write_text("\n".join(lines) + "\n")
