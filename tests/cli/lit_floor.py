# SPDX-License-Identifier: Apache-2.0
"""What tests share that know how light a floor must be."""
import json
import math

import image_reader
from harness import TinyCase

MODEL_RADIUS = 0.16  # no model of this dataset leaves a ball of this radius around the origin: the farthest vertex is at 0.153


def less(a, b):
    return [x - y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def scaled(a, by):
    return [x * by for x in a]


def passes_model(point, way, far):
    """Whether a segment of `far` metres from the point stays out of the ball around the model."""
    along = min(max(-dot(point, way), 0), far)
    nearest = [p + w * along for p, w in zip(point, way)]
    return math.sqrt(dot(nearest, nearest)) > MODEL_RADIUS


def from_point(position, gain, point, normal):
    """What a lamp that sheds `gain` to all sides lets fall on a point; None where the model may stand between."""
    way = less(position, point)
    far = math.sqrt(dot(way, way))
    way = scaled(way, 1 / far)
    return gain / (4 * math.pi) * max(dot(way, normal), 0) / far ** 2 if passes_model(point, way, far) else None


class LitFloorCase(TinyCase):
    def records(self):
        return [json.loads(line) for line in (self.out / "manifest/images.jsonl").read_text().splitlines()]

    def plane(self, record, kind):
        path = self.out / next(file["path"] for file in record["files"] if file["kind"] == kind)
        if path.suffix == ".png":
            return image_reader.read_png(path)[4]
        channels = image_reader.read_exr(path)[2]
        return list(zip(*(channels[name] for name in "RGB")))

    def floor(self, record):
        """Pixels that show the floor and nothing else, with place and normal: at outlines a pixel shows two things."""
        mask, position = self.plane(record, "mask"), self.plane(record, "position")
        normal, width = self.plane(record, "geometry_normal"), record["width"]
        for i in range(width + 1, len(mask) - width - 1, 5):
            around = [i + dx + dy * width for dx in (-1, 0, 1) for dy in (-1, 0, 1)]
            if not any(mask[j] or normal[j] == (0, 0, 0) for j in around):
                yield i, position[i], normal[i]
