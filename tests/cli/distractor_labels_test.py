# SPDX-License-Identifier: Apache-2.0
"""What is told of each distractor alone: how much of it the frame cuts off, by its outline as projected and clipped here,
and what was drawn of its material, by the colours that pixels of its id have."""
import json
import math

import image_reader
from distractors_test import faces_of, hull, moved
from harness import TinyCase, main

WIDTH, HEIGHT = 96, 72
SECTION = """
[distractors]
dir = "{models}"
count = 3
place_m = { disc = [0.1, 0.3] }
size_m = 0.08
turn = { rotation = "any" }

[distractors.vary]
"*.kd" = { hsv = [[0, 1], [0.2, 0.9], [0.3, 0.9]] }
"""
SETTINGS = ["--set", f"engine.width={WIDTH}", "--set", f"engine.height={HEIGHT}", "--set", "engine.filter_width=1", "--set",
            'outputs.planes=["mask", "object_id", "albedo"]', "--set", "camera.distance_m=0.5", "--set", "camera.fov_deg=45"]


def area(polygon):
    return abs(sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(polygon, polygon[1:] + polygon[:1]))) / 2


def clipped(polygon, axis, bound, keeps_below):
    """A convex polygon on one side of a line (Sutherland and Hodgman)."""
    def inside(p):
        return p[axis] <= bound if keeps_below else p[axis] >= bound
    kept = []
    for a, b in zip(polygon, polygon[1:] + polygon[:1]):
        if inside(a):
            kept.append(a)
        if inside(a) != inside(b):
            t = (bound - a[axis]) / (b[axis] - a[axis])
            kept.append(tuple(x + t * (y - x) for x, y in zip(a, b)))
    return kept


class DistractorLabelsTest(TinyCase):
    def setUp(self):
        super().setUp()
        self.recipe.write_text(self.recipe.read_text() + SECTION)

    def records(self):
        return [json.loads(line) for line in (self.out / "manifest/images.jsonl").read_text().splitlines()]

    def outline(self, record, thing):
        """Of a convex model, in pixels; none where some of it is not before the camera."""
        corners, _ = faces_of(self.tiny / "models" / thing["model"])
        places = []
        for corner in corners:
            x, y, z = moved(thing["model_to_camera"]["opencv"], corner)
            if z <= 0:
                return None
            k = record["intrinsics"]
            places.append((k[0][0] * x / z + k[0][2], k[1][1] * y / z + k[1][2]))
        return hull(places)

    def right_truncation(self, record, thing):
        polygon = self.outline(record, thing)
        if polygon is None:
            return None
        inside = polygon
        for axis, bound, below in ((0, 0, False), (0, WIDTH, True), (1, 0, False), (1, HEIGHT, True)):
            inside = clipped(inside, axis, bound, below) if inside else []
        return 1 - (area(inside) if inside else 0) / area(polygon)

    def test_what_the_frame_cuts_off(self):
        self.build(*SETTINGS)
        shares = []
        for record in self.records():
            for thing in [record, *record["objects"]]:
                right = self.right_truncation(record, thing)
                if right is None:
                    self.assertIsNone(thing["truncation"])
                    continue
                # Pixels by their centres: an outline of n pixels' length tells its area to a few of them.
                self.assertAlmostEqual(thing["truncation"], right, delta=0.06, msg=(record["id"], thing["model"]))
                shares.append(right)
        self.assertGreater(sum(0.1 < share < 0.9 for share in shares), 2)
        self.assertGreater(sum(share == 0 for share in shares), 5)

    def test_each_shows_what_was_drawn_of_its_own_material(self):
        self.build(*SETTINGS)
        colours, seen = set(), 0
        for record in self.records():
            paths = {file["kind"]: self.out / file["path"] for file in record["files"]}
            ids = image_reader.read_png(paths["object_id"])[4]
            channels = image_reader.read_exr(paths["albedo"])[2]
            albedo = list(zip(*(channels[name] for name in "RGB")))
            for thing in record["objects"]:
                drawn = record["draws"][f"distractors[{thing['id'] - 101}].vary.*.kd"]
                colours.add(tuple(drawn))
                for i, number in enumerate(ids):
                    if number != thing["id"]:
                        continue
                    seen += 1
                    for shown, wanted in zip(albedo[i], drawn):
                        self.assertTrue(math.isclose(shown, wanted, abs_tol=1e-6), (record["id"], thing["id"]))
            # The model's own is the file's.
            wanted = (0.7, 0.1, 0.1) if record["material"] == "red" else (0.1, 0.6, 0.1)
            for i, number in enumerate(ids):
                if number == 1:
                    self.assertTrue(all(math.isclose(a, b, abs_tol=1e-6) for a, b in zip(albedo[i], wanted)))
        self.assertGreater(seen, 500)
        self.assertEqual(len(colours), sum(len(record["objects"]) for record in self.records()))
        told = json.loads((self.out / "manifest/dataset.json").read_text())["draws"]
        self.assertIn("hsv", told["distractors.vary.*.kd"]["distribution"])

    def test_other_draws_move_none_of_the_models_planes(self):
        self.build(*SETTINGS)
        before = {record["id"]: record for record in self.records()}
        self.recipe.write_text(self.recipe.read_text().replace("[0.3, 0.9]] }", "[0.4, 0.8]] }"))
        self.build(*SETTINGS)
        for record in self.records():
            hashes = [{file["kind"]: file["pixels_xxh128"] for file in one["files"]} for one in (record, before[record["id"]])]
            self.assertEqual(hashes[0]["mask"], hashes[1]["mask"])
            self.assertEqual(hashes[0]["object_id"], hashes[1]["object_id"])
            if record["objects"]:
                self.assertNotEqual(record["render_key"], before[record["id"]]["render_key"])

    def test_a_pattern_must_name_a_property(self):
        run = self.run_it("build", self.recipe, "-o", self.out, "--set", 'distractors.vary={"*.kdd"=0.5}')
        self.assertEqual(run.code, 2, run)
        self.assertIn('distractors.vary "*.kdd" must name a property of each material', run.err)
        run = self.run_it("build", self.recipe, "-o", self.out, "--set", 'materials.assign="own"', "--set", "materials.dir=''")
        self.assertEqual(run.code, 2, run)
        self.assertIn('distractors.vary has no effect with materials.assign = "own"', run.err)


if __name__ == "__main__":
    main()
