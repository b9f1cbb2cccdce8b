# SPDX-License-Identifier: Apache-2.0
"""Distractors by the rule that is written down, in another language: what is drawn, what of it is kept, and where it stands."""
import json
import math
import pathlib
import shutil
import sys

for folder in ("cli", "builder/recipe"):
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / folder))

import golden_draws
import xxhash
from golden_draws import disc, rotation
from harness import TinyCase, main

SEED, GAP, TRIES, GROUND = 7, 0.02, 16, -0.0574
SECTION = f"""
[distractors]
dir = "others"
count = {{ integer = [0, 5] }}
place_m = {{ disc = [0.02, 0.22] }}
size_m = {{ uniform = [0.04, 0.08] }}
turn = {{ rotation = "any" }}
gap_m = {GAP}
tries = {TRIES}
"""
# Vertices of the files, which test data has.
BOX = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-2, 2)]
TETRA = [(1, 1, 1), (-1, -1, 1), (-1, 1, -1), (1, -1, -1)]
CORNERS = {"box.off": BOX, "tetra.ply": TETRA, "brick.off": BOX, "wedge.ply": TETRA}
# Centres of mass of their surfaces: both lie even about the origin.


def even(identity, key, i, attempt=0):
    return golden_draws.even(SEED, identity, key, i, attempt)


def highest(identity, purpose, names):
    """The candidate of the highest hash of seed, purpose, model, view and its name."""
    words = [*identity.split("/"), None]
    def rank(name):
        text = f"{SEED}\n{purpose}" + "".join(f"\n{len(word.encode())} {word}" for word in [*words[:-1], name])
        return xxhash.xxh3_64_intdigest(text.encode())
    return max(names, key=rank)


def turned(q, p):
    w, v = q[0], q[1:]
    def cross(a, b):
        return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    t = [2 * x for x in cross(v, p)]
    return [x + w * y + z for x, y, z in zip(p, t, cross(v, t))]


def standing(name, size, turn, place):
    """Its corners in the world, and the cylinder around its box: middle, radius, low and high."""
    corners = CORNERS[name]
    scale = size / max(max(c[a] for c in corners) - min(c[a] for c in corners) for a in range(3))
    def to_world(points):
        up = [(x, -z, y) for x, y, z in points]  # models.up = "y"
        return [[scale * c for c in turned(turn, p)] for p in up]
    world = to_world(corners)
    lift = GROUND - min(p[2] for p in world)
    world = [[p[0] + place[0], p[1] + place[1], p[2] + lift + place[2]] for p in world]
    box = to_world([(x, y, z) for x in {min(c[0] for c in corners), max(c[0] for c in corners)}
                    for y in {min(c[1] for c in corners), max(c[1] for c in corners)}
                    for z in {min(c[2] for c in corners), max(c[2] for c in corners)}])
    middle = [sum(p[a] for p in box) / 8 + place[a] for a in (0, 1)]
    radius = max(math.hypot(p[0] + place[0] - middle[0], p[1] + place[1] - middle[1]) for p in box)
    heights = [p[2] + lift + place[2] for p in box]
    return world, (*middle, radius, min(heights), max(heights))


class DrawsTest(TinyCase):
    def setUp(self):
        super().setUp()
        (self.tiny / "others").mkdir()
        shutil.copy(self.tiny / "models/box.off", self.tiny / "others/brick.off")
        shutil.copy(self.tiny / "models/tetra.ply", self.tiny / "others/wedge.ply")
        self.recipe.write_text(self.recipe.read_text() + SECTION)

    def test_distractors_are_drawn_and_placed_by_the_rule(self):
        self.assertGreater(self.follow_the_rule({}, "--set", "distractors.own=true"), 0)

    def test_the_image_s_own_mesh_is_passed_over(self):
        self.follow_the_rule({"box.off": "brick.off", "tetra.ply": "wedge.ply"})

    def follow_the_rule(self, passed_over, *options):
        """How many fitted nowhere."""
        self.build("--set", "camera.count=16", "--set", "outputs.image=false", *options)
        placed = rejected = dropped = 0
        for record in map(json.loads, (self.out / "manifest/images.jsonl").read_text().splitlines()):
            identity = record["id"]
            count = math.floor(even(identity, "distractors.count", 0) * 6)
            self.assertEqual(record["draws"]["distractors.count"], count)
            eye = [row[3] for row in record["camera_to_world"][:3]]
            taken = [standing(record["model"], 0.16, [1, 0, 0, 0], [0, 0, 0])[1]]
            wanted = []
            for n in range(count):
                key = f"distractors[{n}]."
                model = highest(identity, f"distractor {n}", [one for one in ("brick.off", "wedge.ply") if one != passed_over.get(record["model"])])
                material = highest(identity, f"distractor material {n}", ["green", "red"])
                size = 0.04 + even(identity, key + "size_m", 0) * 0.04
                turn = rotation(lambda i, k=key: even(identity, k + "turn", i))
                for tries in range(TRIES):
                    place = disc(lambda i, k=key, t=tries: even(identity, k + "place_m", i, t), 0.02, 0.22)
                    world, own = standing(model, size, turn, place)
                    touches = any(math.dist(own[:2], o[:2]) < own[2] + o[2] + GAP for o in taken)
                    holds = (own[3] - GAP < eye[2] < own[4] + GAP and math.dist(own[:2], eye[:2]) < own[2] + GAP)
                    if not touches and not holds:
                        taken.append(own)
                        wanted.append((101 + n, model, material, size, turn, place, world))
                        placed += 1
                        break
                    rejected += 1
                else:
                    dropped += 1
            self.assertEqual([(o["id"], o["model"], o["material"]) for o in record.get("objects", [])],
                             [w[:3] for w in wanted], identity)
            for o, (number, model, _, size, turn, place, world) in zip(record.get("objects", []), wanted):
                drawn = {name: record["draws"][f"distractors[{number - 101}].{name}"] for name in ("size_m", "turn", "place_m")}
                for a, b in zip([drawn["size_m"], *drawn["turn"], *drawn["place_m"]], [size, *turn, *place]):
                    self.assertAlmostEqual(a, b, delta=1e-12)
                for corner, p in zip(CORNERS[model], world):
                    at = [sum(m * c for m, c in zip(row, (*corner, 1))) for row in o["model_to_world"][:3]]
                    self.assertLess(math.dist(at, p), 1e-9)
        self.assertGreater(placed, 30)
        self.assertGreater(rejected, 30)
        return dropped


if __name__ == "__main__":
    main()
