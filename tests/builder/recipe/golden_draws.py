#!/usr/bin/env python3
"""Prints golden_draws.txt: draws by the rule of builder/recipe/even_number.h, in the libraries' own arithmetic.

Wants xxhash (Debian: python3-xxhash). Each line: distribution, key, seed, model, view, attempt | first even number |
values.
"""
import math
import statistics

import xxhash

NORMAL = statistics.NormalDist()


def even(seed, identity, key, i, attempt):
    text = "".join(f"{word}\0" for word in ("dsbuild draw 1", seed, identity, key, i, attempt))
    return (xxhash.xxh3_128_intdigest(text.encode()) >> 64 >> 11) * 2.0**-53


def uniform(u, a, b):
    return [a + u(0) * (b - a)]


def log_uniform(u, a, b):
    return [a * (b / a) ** u(0)]


def normal(u, mean, deviation, low, high):
    below, above = NORMAL.cdf((low - mean) / deviation), NORMAL.cdf((high - mean) / deviation)
    return [mean + deviation * NORMAL.inv_cdf(below + u(0) * (above - below))]


def integer(u, a, b):
    return [float(a + math.floor(u(0) * (b - a + 1)))]


def shell(u, inner, outer, low, high):
    radius = (inner**3 + u(0) * (outer**3 - inner**3)) ** (1 / 3)
    bottom, top = math.sin(math.radians(low)), math.sin(math.radians(high))
    z = bottom + u(1) * (top - bottom)
    across, azimuth = math.sqrt(1 - z * z), math.tau * u(2)
    return [radius * across * math.cos(azimuth), radius * across * math.sin(azimuth), radius * z]


def disc(u, inner, outer):
    radius = math.sqrt(inner**2 + u(0) * (outer**2 - inner**2))
    return [radius * math.cos(math.tau * u(2)), radius * math.sin(math.tau * u(2)), 0.0]


def rotation(u):
    share, first, second = u(0), math.tau * u(1), math.tau * u(2)
    a, b = math.sqrt(1 - share), math.sqrt(share)
    return [b * math.cos(second), a * math.sin(first), a * math.cos(first), b * math.sin(second)]


WORDS = [
    ("{uniform = [35, 60]}", "camera.fov_deg", lambda u: uniform(u, 35, 60), "view"),
    ("{log_uniform = [0.5, 2]}", "environments.gain", lambda u: log_uniform(u, 0.5, 2), "view"),
    ("{normal = [0, 4], within = [-10, 10]}", "camera.roll_deg", lambda u: normal(u, 0, 4, -10, 10), "view"),
    ("{integer = [60, 95]}", "outputs.camera.jpeg_quality", lambda u: integer(u, 60, 95), "view"),
    ("{shell = [0.22, 0.35], elevation_deg = [-5, 75]}", "camera.position_m",
     lambda u: shell(u, 0.22, 0.35, -5, 75), "view"),
    ("{disc = [0.1, 0.3]}", "models.place_m", lambda u: disc(u, 0.1, 0.3), "view"),
    ('{rotation = "any"}', "models.turn", rotation, "view"),
    ('{uniform = [0.1, 0.2], per = "model"}', "models.size_m", lambda u: uniform(u, 0.1, 0.2), "model"),
    ('{uniform = [0, 1], per = "dataset"}', "environments.gain", lambda u: uniform(u, 0, 1), "dataset"),
    ("{spread = [0, 360]}", "environments.turn_deg", None, "model"),
]
IMAGES = [(0, "mug.ply", "0", 0), (1, "mug.ply", "13", 0), (2**62 + 1, "chair/1/model.obj", "7", 2), (0, "ütf.off", "0", 0)]

if __name__ == "__main__":
    for seed, model, view, attempt in IMAGES:
        for text, key, word, per in WORDS:
            identity = {"view": f"{model}/{view}", "model": model, "dataset": ""}[per]
            u = lambda i: even(seed, identity, key, i, attempt)
            values = word(u) if word else [360 * ((u(0) + int(view) * 0.6180339887498949) % 1)]
            print("|".join([text, key, str(seed), model, view, str(attempt), u(0).hex(),
                            " ".join(repr(value) for value in values)]))
