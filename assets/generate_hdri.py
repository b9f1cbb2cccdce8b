#!/usr/bin/env python3
# SPDX-License-Identifier: CC0-1.0
"""Writes assets/environments/office/office.hdr: the light of an office as seen from a table top in it.

The room is a box with furniture of boxes. Each pixel's ray is followed to what it meets; that is lit by the windows and
the ceiling lamps (sampled at fixed points, with shadows) and by an even share of light that has gone about the room.
Latitude-longitude, Z up, the zenith in the top row. Python 3.9 or later, standard library only; takes a few minutes.
"""
import math
import sys
from pathlib import Path

sys.dont_write_bytecode = True  # keeps the source tree clean

from modelling.radiance import write_hdr

WIDTH, HEIGHT = 1024, 512
# The room in metres; the table top's middle is the origin, 0.78 m above the floor.
LOW, HIGH = (-3.1, -2.6, -0.78), (3.9, 3.4, 2.02)
WINDOWS = [(-2.3, -0.75), (-0.35, 1.2), (1.6, 3.15)]  # x from, to, in the wall y = HIGH
SILL, LINTEL, FRAME = 0.12, 1.72, 0.045
LAMPS = [(x, y) for x in (-1.7, 0.4, 2.5) for y in (-1.3, 1.5)]
LAMP_HALF = (0.62, 0.14)
SKY, TREES = (27.0, 32.0, 39.0), (0.75, 1.05, 0.42)
HOUSES, HOUSE_PANE = 2.6, (0.6, 0.75, 0.95)
LAMP_LIGHT = (30.0, 23.5, 15.5)
BOUNCE = (0.22, 0.20, 0.17)

WALL, CEILING, CARPET = (0.60, 0.55, 0.46), (0.74, 0.72, 0.68), (0.105, 0.098, 0.095)
DARK, OAK, STEEL = (0.035, 0.032, 0.030), (0.30, 0.17, 0.08), (0.22, 0.23, 0.25)


def furniture():
    """(low corner, high corner, albedo) of every box in the room."""
    floor = LOW[2]
    boxes = [
        ((-3.1, -2.6, floor), (-2.65, 0.6, 1.15), DARK),                        # a wall of shelves
        ((0.2, -2.6, floor), (1.6, -2.1, 0.35), OAK),                           # a sideboard
        ((2.3, -2.55, floor), (3.2, -2.45, 1.32), (0.16, 0.09, 0.05)),          # the door
        ((-1.9, -2.6, 0.25), (-0.5, -2.55, 1.15), (0.72, 0.74, 0.75)),          # a whiteboard
        ((2.6, -0.9, -0.07), (3.9, 1.9, -0.03), OAK),                           # a desk
        ((2.7, -0.8, floor), (2.8, 1.8, -0.07), STEEL),
        ((3.35, -0.1, 0.02), (3.4, 0.55, 0.42), (0.012, 0.012, 0.014)),         # its screens
        ((3.35, 0.65, 0.02), (3.4, 1.3, 0.42), (0.012, 0.012, 0.014)),
        ((-1.9, 2.3, floor), (-0.6, 3.3, -0.05), STEEL),                        # cabinets under a window
        ((0.5, 1.55, floor), (1.1, 2.15, -0.33), (0.05, 0.06, 0.09)),           # a chair
        ((0.5, 2.08, -0.33), (1.1, 2.18, 0.24), (0.05, 0.06, 0.09)),
        ((-2.3, 1.6, floor), (-1.95, 1.95, -0.3), (0.40, 0.33, 0.27)),          # a plant in its pot
        ((0.35, -2.5, 0.35), (0.75, -2.2, 0.62), (0.45, 0.44, 0.42)),           # a printer
        ((1.1, -2.55, 0.35), (1.35, -2.3, 0.8), (0.36, 0.07, 0.05)),            # folders
    ]
    for i in range(90):  # its leaves
        reach = 0.12 + 0.26 * math.sin(math.pi * (i + 8) / 100)
        x, y, z = -2.12 + reach * math.sin(2.4 * i), 1.78 + reach * math.cos(2.4 * i), -0.35 + 0.0125 * i
        leaf = (0.03 + 0.012 * (i % 4), 0.085 + 0.02 * (i % 3), 0.02 + 0.006 * (i % 5))
        boxes.append(((x - 0.035, y - 0.035, z), (x + 0.035, y + 0.035, z + 0.09 + 0.03 * (i % 3)), leaf))
    tints = [(0.45, 0.10, 0.06), (0.10, 0.17, 0.30), (0.52, 0.44, 0.28), (0.11, 0.22, 0.14), (0.5, 0.48, 0.44)]
    for shelf in range(4):
        y, i = -2.5, 3 * shelf
        while y < 0.3:
            width, height = 0.16 + 0.05 * ((7 * i) % 5), 0.26 + 0.02 * ((5 * i) % 4)
            if i % 6 != 4:
                z = floor + 0.12 + 0.47 * shelf
                boxes.append(((-2.66, y, z), (-2.6, y + width - 0.02, z + height), tints[(i * i + shelf) % 5]))
            y, i = y + width, i + 1
    return boxes


BOXES = furniture()
SHADOWING = BOXES[:13]  # leaves and books are too small to matter


def hit_box(origin, inverse, low, high):
    """Distance to a box along a ray, or None."""
    near, far = 1e-4, 1e9
    for k in range(3):
        a, b = (low[k] - origin[k]) * inverse[k], (high[k] - origin[k]) * inverse[k]
        if a > b:
            a, b = b, a
        near, far = max(near, a), min(far, b)
        if near > far:
            return None
    return near if near > 1e-4 else None


def glass(x, z):
    """Whether a point of the window wall is glass: inside a frame, off its cross bars."""
    for left, right in WINDOWS:
        if left + FRAME < x < right - FRAME and SILL + FRAME < z < LINTEL - FRAME:
            return abs(x - (left + right) / 2) > FRAME / 2 and abs(z - (SILL + 0.62 * (LINTEL - SILL))) > FRAME / 2
    return False


def outside(direction):
    """The view through a window: trees before a row of houses, above them a sky that is brighter to the horizon."""
    x, y, z = direction
    level, along = z / math.hypot(x, y), math.atan2(x, y)
    trees = 0.07 + 0.03 * math.sin(9 * along) + 0.02 * math.sin(23 * along + 1) + 0.01 * math.sin(61 * along)
    if level < trees:
        shade = 0.75 + 0.25 * math.sin(37 * along) * math.sin(90 * level + 11 * along)
        return tuple(c * shade for c in TREES)
    block = math.floor(along / 0.17)
    if level < (0.27, 0.19, 0.31, 0.23, 0.29, 0.21, 0.26)[block % 7]:
        pane = 0.25 < (along / 0.17 * 5) % 1 < 0.7 and 0.3 < (level * 24) % 1 < 0.8
        tint = ((1.0, 0.86, 0.68), (0.95, 0.62, 0.48), (0.9, 0.9, 0.86))[block % 3]
        return HOUSE_PANE if pane else tuple(HOUSES * c for c in tint)
    haze = math.exp(-4 * level)
    return tuple(c * (0.85 + 0.5 * haze) for c in SKY)


def light_points():
    """(position, normal, radiance times area) of the points that stand for windows and lamps."""
    points = []
    for left, right in WINDOWS:
        for x in (left + 0.3 * (right - left), left + 0.7 * (right - left)):
            for z in (0.5, 1.3):
                weight = (right - left) * (LINTEL - SILL) / 4 * 0.6  # the houses hide a part of the sky
                points.append(((x, HIGH[1] - 0.01, z), (0, -1, 0), tuple(c * weight for c in SKY)))
    for x, y in LAMPS:
        weight = 4 * LAMP_HALF[0] * LAMP_HALF[1]
        points.append(((x, y, HIGH[2] - 0.06), (0, 0, -1), tuple(c * weight for c in LAMP_LIGHT)))
    return points


LIGHTS = light_points()


def shaded(p, normal, albedo):
    """Diffuse radiance at a point. Points on the furniture and on the walls alike."""
    total = list(BOUNCE)
    origin = tuple(p[k] + 1e-3 * normal[k] for k in range(3))
    for position, facing, power in LIGHTS:
        to = tuple(position[k] - origin[k] for k in range(3))
        square = to[0] * to[0] + to[1] * to[1] + to[2] * to[2]
        cosine = to[0] * normal[0] + to[1] * normal[1] + to[2] * normal[2]
        emitted = -(to[0] * facing[0] + to[1] * facing[1] + to[2] * facing[2])
        if cosine <= 0 or emitted <= 0:
            continue
        inverse = tuple(1 / c if abs(c) > 1e-9 else 1e9 for c in to)
        blocked = False
        for low, high, _ in SHADOWING:
            distance = hit_box(origin, inverse, low, high)
            if distance is not None and distance < 1:
                blocked = True
                break
        if not blocked:
            # The square is kept off zero, or a point next to a light would glare.
            form = cosine * emitted / (math.pi * (square * square + 0.6))
            total = [t + c * form for t, c in zip(total, power)]
    return tuple(t * a for t, a in zip(total, albedo))


def wall_colour(axis, side, p):
    """Albedo of the room itself where a ray leaves it, or a radiance (marked by True) if it shines."""
    x, y, z = p
    if axis == 2 and side:
        for lx, ly in LAMPS:
            if abs(x - lx) < LAMP_HALF[0] and abs(y - ly) < LAMP_HALF[1]:
                tube = 0.62 + 0.38 * math.cos(math.pi * (y - ly) / LAMP_HALF[1]) ** 2
                return tuple(c * tube for c in LAMP_LIGHT), True
            if abs(x - lx) < LAMP_HALF[0] + 0.04 and abs(y - ly) < LAMP_HALF[1] + 0.04:
                return STEEL, False
        seam = min((x + 30.1) % 0.6, (y + 30.4) % 0.6) < 0.012
        return (tuple(c * 0.75 for c in CEILING) if seam else CEILING), False
    if axis == 2:
        return CARPET, False
    if z < LOW[2] + 0.09:
        return DARK, False
    if axis == 1 and side:
        near = any(left < x < right and SILL < z < LINTEL for left, right in WINDOWS)
        return ((0.7, 0.7, 0.68) if near else WALL), False
    if axis == 1 and 1.75 < x < 2.15 and 0.55 < z < 1.05 and not (1.79 < x < 2.11 and 0.59 < z < 1.01):
        return DARK, False  # a picture frame
    if axis == 1 and 1.75 < x < 2.15 and 0.55 < z < 1.05:
        return (0.55 - 0.3 * (z - 0.55), 0.22, 0.08 + 0.5 * (z - 0.55)), False
    return ((0.16, 0.22, 0.27) if axis == 0 and side else WALL), False


def radiance(direction):
    inverse = tuple(1 / c if abs(c) > 1e-9 else 1e9 for c in direction)
    nearest, what = 1e9, None
    for low, high, albedo in BOXES:
        distance = hit_box((0.0, 0.0, 0.0), inverse, low, high)
        if distance is not None and distance < nearest:
            nearest, what = distance, (low, high, albedo)
    if what:
        p = tuple(c * nearest for c in direction)
        low, high, albedo = what
        gaps = [(abs(p[k] - bound[k]), k, sign) for k in range(3) for bound, sign in ((low, -1), (high, 1))]
        _, axis, sign = min(gaps)
        return shaded(p, tuple(float(sign) if k == axis else 0.0 for k in range(3)), albedo)
    exits = [((HIGH if direction[k] > 0 else LOW)[k] * inverse[k], k) for k in range(3) if direction[k] != 0]
    distance, axis = min(exits)
    p = tuple(c * distance for c in direction)
    side = direction[axis] > 0
    if axis == 1 and side and glass(p[0], p[2]):
        return outside(direction)
    colour, shines = wall_colour(axis, side, p)
    if shines:
        return colour
    return shaded(p, tuple((-1.0 if side else 1.0) if k == axis else 0.0 for k in range(3)), colour)


def main():
    rows = []
    for j in range(HEIGHT):
        theta = math.pi * (j + 0.5) / HEIGHT
        row = []
        for i in range(WIDTH):
            phi = 2 * math.pi * (i + 0.5) / WIDTH
            row.append(radiance((math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta))))
        rows.append(row)
    path = Path(__file__).resolve().parent / "environments" / "office" / "office.hdr"
    path.parent.mkdir(parents=True, exist_ok=True)
    write_hdr(path, WIDTH, rows)
    print(f"{path.name} {WIDTH}x{HEIGHT} {path.stat().st_size} bytes")


if __name__ == "__main__":
    main()
