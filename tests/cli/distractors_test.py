# SPDX-License-Identifier: Apache-2.0
"""Distractors: what stands beside the models, told by the files' own geometry, rays cast here, and readers of exports."""
import itertools
import json
import math
import shutil

import image_reader
from harness import IMAGES, TinyCase, main

GROUND = -0.0574
GAP = 0.01
WIDTH, HEIGHT = 48, 36
SIZE = ["--set", f"engine.width={WIDTH}", "--set", f"engine.height={HEIGHT}"]
SECTION = """
[distractors]
dir = "others"
count = { integer = [1, 4] }
place_m = { disc = [0.02, 0.2] }
size_m = { uniform = [0.04, 0.08] }
turn = { rotation = "any" }
gap_m = 0.01
"""
PLANES = 'planes = ["mask", "amodal_mask", "object_id", "depth"]\n'
CLASSES = '[classes]\nfrom = "classes.csv"\n\n'
TABLE = "name,class,split\nbox.off,solid/box,train\ntetra.ply,solid/spike,test\n"


def faces_of(path):
    """The triangles that stand in an OFF or PLY file, corners counter-clockwise from outside."""
    lines = path.read_text().splitlines()
    if path.suffix == ".off":
        rows = [line for line in lines[1:] if not line.startswith("#")]
        points, faces = map(int, rows[0].split()[:2])
        rows = rows[1:]
    else:
        points, faces = (int(next(l for l in lines if l.startswith(f"element {w}")).split()[2]) for w in ("vertex", "face"))
        rows = lines[lines.index("end_header") + 1:]
    corners = [tuple(map(float, row.split()[:3])) for row in rows[:points]]
    polygons = [list(map(int, row.split()))[1:] for row in rows[points:points + faces]]
    return corners, [(p[0], p[i], p[i + 1]) for p in polygons for i in range(1, len(p) - 1)]


def moved(matrix, point):
    return tuple(sum(m * p for m, p in zip(row, (*point, 1))) for row in matrix[:3])


def less(a, b):
    return tuple(x - y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


class Body:
    """A convex thing in the world."""

    def __init__(self, number, path, to_world):
        self.id = number
        corners, faces = faces_of(path)
        self.corners = [moved(to_world, corner) for corner in corners]
        self.planes = []  # normal outwards, and how far along it
        middle = [sum(c[axis] for c in self.corners) / len(self.corners) for axis in range(3)]
        for a, b, c in ([self.corners[v] for v in face] for face in faces):
            normal = cross(less(b, a), less(c, a))
            if dot(normal, less(middle, a)) > 0:
                normal = tuple(-x for x in normal)
            self.planes.append((normal, dot(normal, a)))

    def nearest(self, origin, direction):
        """Where a ray enters; none where it passes: all half-spaces at once."""
        enters, leaves = -math.inf, math.inf
        for normal, along in self.planes:
            speed, before = dot(normal, direction), along - dot(normal, origin)
            if speed < 0:
                enters = max(enters, before / speed)
            elif speed > 0:
                leaves = min(leaves, before / speed)
            elif before < 0:
                return None
        return enters if 0 < enters < leaves else None

    def footprint(self):
        return [corner[:2] for corner in self.corners]


def segment_distance(a, b, c, d):
    """Of two segments of a plane that do not cross."""
    def to_segment(p, q, r):
        long = (r[0] - q[0]) ** 2 + (r[1] - q[1]) ** 2
        t = 0 if long == 0 else max(0, min(1, ((p[0] - q[0]) * (r[0] - q[0]) + (p[1] - q[1]) * (r[1] - q[1])) / long))
        return math.dist(p, (q[0] + t * (r[0] - q[0]), q[1] + t * (r[1] - q[1])))
    return min(to_segment(a, c, d), to_segment(b, c, d), to_segment(c, a, b), to_segment(d, a, b))


def hull(points):
    """Counter-clockwise (Andrew's chain)."""
    points = sorted(set(points))
    def half(run):
        chain = []
        for p in run:
            while len(chain) > 1 and (chain[-1][0] - chain[-2][0]) * (p[1] - chain[-2][1]) <= (chain[-1][1] - chain[-2][1]) * (p[0] - chain[-2][0]):
                chain.pop()
            chain.append(p)
        return chain[:-1]
    return half(points) + half(points[::-1])


def apart(a, b):
    """Distance of two convex outlines; -1 where they meet."""
    edges = [list(zip(h, h[1:] + h[:1])) for h in (a, b)]
    for own in edges:  # separated by an edge of one, or not at all
        for p, q in own:
            out = (q[1] - p[1], p[0] - q[0])
            if max(out[0] * x + out[1] * y for x, y in a) < min(out[0] * x + out[1] * y for x, y in b) or \
               max(out[0] * x + out[1] * y for x, y in b) < min(out[0] * x + out[1] * y for x, y in a):
                return min(segment_distance(*e, *f) for e in edges[0] for f in edges[1])
    return -1


class DistractorsTest(TinyCase):
    def setUp(self):
        super().setUp()
        (self.tiny / "others").mkdir()
        for name, as_name in (("box.off", "brick.off"), ("tetra.ply", "wedge.ply"), ("tetra.ply", "tetra.ply")):
            shutil.copy(self.tiny / "models" / name, self.tiny / "others" / as_name)
        self.recipe.write_text(self.recipe.read_text() + "\n[outputs]\n" + PLANES + SECTION)
        self.plain = ["--set", f'environments.files=["{self.tiny}/environments/plain"]']

    def records(self, out=None):
        return [json.loads(line) for line in ((out or self.out) / "manifest/images.jsonl").read_text().splitlines()]

    def plane(self, record, kind):
        path = self.out / next(file["path"] for file in record["files"] if file["kind"] == kind)
        if path.suffix == ".exr":
            return image_reader.read_exr(path)[2]["Y"]
        return image_reader.read_png(path)[4]

    def bodies(self, record):
        bodies = [Body(1, self.tiny / "models" / record["model"], record["model_to_world"])]
        return bodies + [Body(o["id"], self.tiny / "others" / o["model"], o["model_to_world"]) for o in record["objects"]]

    def stale(self, *arguments):
        run = self.run_it("build", self.recipe, "-o", self.out, "-n", "--json", *arguments)
        self.assertEqual(run.code, 0, run)
        return run.json["stale"]

    def test_they_stand_on_the_ground_and_touch_nothing(self):
        self.build("--set", "camera.count=12", "--set", "outputs.image=false")
        shown = set()
        for record in self.records():
            drawn = record["draws"]["distractors.count"]
            self.assertEqual(len(record["objects"]), drawn, "all find a place here")
            self.assertEqual([o["id"] for o in record["objects"]], list(range(101, 101 + drawn)))
            bodies = self.bodies(record)
            eye = [row[3] for row in record["camera_to_world"][:3]]
            for body in bodies[1:]:
                self.assertAlmostEqual(min(c[2] for c in body.corners), GROUND, delta=1e-9)
                # Nearer than the gap is no other, and not the camera, if it is no higher.
                if eye[2] < max(c[2] for c in body.corners):
                    self.assertGreater(min(math.dist(eye[:2], c) for c in body.footprint()), GAP)
            for a, b in itertools.combinations(bodies, 2):
                self.assertGreater(apart(hull(a.footprint()), hull(b.footprint())), GAP - 1e-9, record["id"])
            for n, o in enumerate(record["objects"]):
                size, place = record["draws"][f"distractors[{n}].size_m"], record["draws"][f"distractors[{n}].place_m"]
                self.assertTrue(0.04 <= size < 0.08 and 0.02 <= math.hypot(*place[:2]) <= 0.2)
                # As long as its drawn size before it is turned: a turn keeps lengths.
                corners, _ = faces_of(self.tiny / "others" / o["model"])
                longest = max(max(c[axis] for c in corners) - min(c[axis] for c in corners) for axis in range(3))
                scale = math.sqrt(sum(row[0] ** 2 for row in o["model_to_world"][:3]))
                self.assertAlmostEqual(scale * longest, size, delta=1e-9)
            shown |= {(o["model"], o["material"]) for o in record["objects"]}
        self.assertEqual(shown, set(itertools.product(("brick.off", "wedge.ply", "tetra.ply"), ("red", "green"))))

    def test_ids_boxes_and_visible_shares_are_what_rays_meet(self):
        self.build(*SIZE, *self.plain, "--set", "camera.distance_m=0.3", "--set", "camera.elevation_deg=12")
        hidden = seen_whole = 0
        for record in self.records():
            bodies, pose, k = self.bodies(record), record["camera_to_world"], record["intrinsics"]
            eye = tuple(row[3] for row in pose[:3])
            ids, alone, depths = [], {body.id: set() for body in bodies}, []
            for y, x in itertools.product(range(HEIGHT), range(WIDTH)):
                local = ((x + 0.5 - k[0][2]) / k[0][0], (y + 0.5 - k[1][2]) / k[1][1], 1)
                ray = tuple(dot(row[:3], local) for row in pose[:3])
                hits = [(t, body.id) for body in bodies if (t := body.nearest(eye, ray)) is not None]
                for _, body in hits:
                    alone[body].add((x, y))
                depths.append(min(hits)[0] if hits else 0)
                ids.append(min(hits)[1] if hits else 0)
            found = self.plane(record, "object_id")
            differ = [i for i, (a, b) in enumerate(zip(found, ids)) if a != b]
            self.assertLessEqual(len(differ), 3, f"but for centres on an edge: {record['id']}")
            self.assertEqual([i == 1 for i in found], [v > 0 for v in self.plane(record, "mask")])
            for i, depth in enumerate(self.plane(record, "depth")):
                if i not in differ and ids[i]:
                    self.assertAlmostEqual(depth, depths[i], delta=1e-5)
            for o in [{**record, "id": 1, "pixels": None}, *record["objects"]]:
                own = {(i % WIDTH, i // WIDTH) for i, v in enumerate(found) if v == o["id"]}
                if o["pixels"]:
                    self.assertEqual(o["pixels"]["seen"], len(own))
                    self.assertLessEqual(abs(o["pixels"]["amodal"] - len(alone[o["id"]])), 2)
                    self.assertEqual(o["pixels"]["frame"], sum(x in (0, WIDTH - 1) or y in (0, HEIGHT - 1) for x, y in own))
                    share = o["pixels"]["seen"] / o["pixels"]["amodal"] if o["pixels"]["amodal"] else None
                    self.assertEqual(o["visible_fraction"], share)
                if o["visible_fraction"] is not None:
                    self.assertAlmostEqual(o["visible_fraction"] + o["occlusion"], 1, delta=1e-12)
                    self.assertLessEqual(abs(o["visible_fraction"] * len(alone[o["id"]]) - len(own)), 4)
                    hidden += o["visible_fraction"] < 0.9
                    seen_whole += o["visible_fraction"] == 1
                if not own:
                    self.assertIsNone(o["box"])
                    continue
                low, high = ([f(p[axis] for p in own) for axis in (0, 1)] for f in (min, max))
                self.assertEqual(o["box"], [*low, high[0] - low[0] + 1, high[1] - low[1] + 1])
                # The box in the world holds all corners, and the camera's matrix is the product.
                body = next(b for b in bodies if b.id == o["id"])
                for corner in body.corners:
                    for axis in range(3):
                        self.assertTrue(o["box_m"][0][axis] - 1e-9 <= corner[axis] <= o["box_m"][1][axis] + 1e-9)
                for point in ((0, 0, 0), (1, 2, 3)):
                    in_camera = moved(o["model_to_camera"]["opencv"], point)
                    back = tuple(e + dot(row[:3], in_camera) for e, row in zip(eye, pose[:3]))
                    self.assertLess(math.dist(back, moved(o["model_to_world"], point)), 1e-9)
        self.assertGreater(hidden, 3)
        self.assertGreater(seen_whole, 3)

    def test_what_is_added_elsewhere_makes_nothing_else_anew(self):
        self.build()
        before = {r["id"]: r for r in self.records()}
        self.assertEqual(self.stale(), 0)
        shutil.copy(self.tiny / "models/box.off", self.tiny / "models/third.off")
        self.assertEqual(self.stale(), IMAGES // 2, "the new model's own")
        (self.tiny / "models/third.off").unlink()
        # Counts are drawn one by one, so that more are more: those there were stay where they were.
        self.assertEqual(self.stale("--set", "distractors.count=0"), IMAGES)
        self.build("--set", "distractors.count=4", "--set", "camera.lens_radius_m={uniform=[0,0.001]}")
        for record in self.records():
            old = before[record["id"]]["objects"]
            self.assertGreaterEqual(len(record["objects"]), len(old))
            for a, b in zip(old, record["objects"]):
                self.assertEqual((a["id"], a["model"], a["material"], a["model_to_world"]),
                                 (b["id"], b["model"], b["material"], b["model_to_world"]))
        # A further candidate: who does not show it stays.
        self.build()
        corners = (self.tiny / "others/brick.off").read_text().replace("-2", "-3")
        (self.tiny / "others/slab.off").write_text(corners)
        stale = self.stale()
        self.build()
        takers = {r["id"] for r in self.records() if any(o["model"] == "slab.off" for o in r["objects"])}
        self.assertEqual(stale, len(takers))
        self.assertTrue(0 < stale < IMAGES, stale)
        for record in self.records():
            if record["id"] not in takers:
                self.assertEqual(record["render_key"], before[record["id"]]["render_key"])

    def test_none_is_as_without_the_section(self):
        self.build("--set", "distractors.count=0")
        keys = [(r["render_key"], r["files_key"]) for r in self.records()]
        self.recipe.write_text(self.recipe.read_text().replace(SECTION, ""))
        counts = self.build(out=self.folder / "without")
        self.assertEqual(keys, [(r["render_key"], r["files_key"]) for r in self.records(self.folder / "without")])
        self.assertNotIn("objects", self.records(self.folder / "without")[0])
        self.assertEqual(counts["traced"], IMAGES)

    def test_one_that_finds_no_place_is_counted(self):
        counts = self.build("--set", "distractors.place_m={disc=0.01}", "--set", "distractors.tries=3", "--set", "outputs.image=false")
        self.assertEqual(counts["concerns"]["distractors_unplaced"], IMAGES)
        self.assertNotIn("objects", self.records()[0])
        run = self.run_it("build", self.recipe, "-o", self.out, "--set", "distractors.place_m={disc=0.01}", "--set", "outputs.image=false")
        self.assertIn("8 of 8 images show fewer distractors than were drawn, for want of places or of other models: box.off/0 (", run.err)

    def test_none_is_the_images_own_model(self):
        self.edit("recipe.toml", 'dir = "others"', 'dir = "{models}"')
        (self.tiny / "models/third.off").write_text((self.tiny / "models/box.off").read_text().replace("-1 -1 -2", "-1 -1 -3"))
        # The box again, by another name and in another form of text: one mesh.
        (self.tiny / "models/again.off").write_text((self.tiny / "models/box.off").read_text().replace("OFF\n", "OFF\n# again\n"))
        own = {"box.off": "box.off again.off", "again.off": "box.off again.off", "third.off": "third.off", "tetra.ply": "tetra.ply"}
        small = ("--set", "outputs.image=false", "--set", "distractors.count=6", "--set", "distractors.size_m=0.02")
        self.build(*small)
        others = {(r["id"], o["id"]): o["model"] for r in self.records() for o in r["objects"]}
        self.assertGreater(len(others), 40)
        for (image, _), model in others.items():
            self.assertNotIn(model, own[image.split("/")[0]].split(), image)
        self.build(*small, "--set", "distractors.own=true")
        free = {(r["id"], o["id"]): o["model"] for r in self.records() for o in r["objects"]}
        redrawn = {key for key, model in free.items() if model in own[key[0].split("/")[0]].split()}
        self.assertGreater(len(redrawn), 5)
        self.assertEqual({key: model for key, model in free.items() if key not in redrawn},
                         {key: model for key, model in others.items() if key in free and key not in redrawn})

    def test_what_is_drawn_is_counted_by_what_it_is_drawn_for(self):
        run = self.run_it("plan", self.recipe, "-o", self.out, "--draws")
        shown = self.run_it("plan", self.recipe, "-o", self.out, "--draws", "--json").json["draws"]["distractors.size_m"]["count"]
        self.assertGreater(shown, IMAGES)
        self.assertRegex(run.out, rf"distractors\.size_m +\S.* of {shown} distractors\n")
        self.assertRegex(run.out, rf"distractors\.count +\S.* of {IMAGES} images\n")

    def test_masks_are_made_anew_for_shapes_and_pictures_alone_for_colours(self):
        self.build("--set", "distractors.count=2")
        self.edit("materials/red.mat", "0.", "0.1")
        counts = self.build("--set", "distractors.count=2")
        self.assertEqual((counts["traced"], self.stale("--set", "distractors.count=2")), (counts["built"], 0))
        run = self.run_it("build", self.recipe, "-o", self.out, "-n", "--set", "distractors.count=2", "--set", "distractors.size_m=0.05")
        self.assertIn("distractors changed: distractors[0].size_m: ", run.out)
        run = self.run_it("verify", self.recipe, "-o", self.out, "--set", "distractors.count=2", "--rerender=3")
        self.assertEqual(run.code, 0, run)

    def test_models_of_the_recipe_stay_in_their_split(self):
        table = TABLE + "brick.off,solid/box,train\nwedge.off,solid/spike,test\n"
        (self.tiny / "classes.csv").write_text(table)
        box = (self.tiny / "models/box.off").read_text()
        for name, height in (("brick.off", 3), ("wedge.off", 4)):
            (self.tiny / "models" / name).write_text(box.replace("-1 -1 -2", f"-1 -1 -{height}"))
        other = {"box.off": "brick.off", "brick.off": "box.off", "tetra.ply": "wedge.off", "wedge.off": "tetra.ply"}
        self.edit("recipe.toml", "[materials]", CLASSES + "[materials]")
        self.edit("recipe.toml", 'dir = "others"', 'dir = "{models}"')
        self.build("--set", "distractors.count=3")
        for record in self.records():
            for o in record["objects"]:
                self.assertEqual((o["model"], o["class_path"], o["class_id"]), (other[record["model"]], record["class_path"], record["class_id"]))
        # A class that is renamed is told without a picture made anew.
        (self.tiny / "classes.csv").write_text(table.replace("spike", "thorn"))
        counts = self.build("--set", "distractors.count=3")
        self.assertEqual(counts["built"], 0)
        self.assertEqual({o["class_path"] for r in self.records() for o in r["objects"]}, {"solid/box", "solid/thorn"})

    def test_wrong_sections_are_said(self):
        for settings, message in (
                (["distractors.dir=nowhere"], "--set distractors.dir: must be a folder"),
                (["distractors.place_m=[0,0,0]"], "distractors.place_m: must be a distribution"),
                (["distractors.count=16"], "--set distractors.count: must be"),
                (["distractors.class=solid/brick"], "distractors.class: wants classes"),
                (['distractors.dir="{model}"'], "must be a folder")):
            run = self.run_it("build", self.recipe, "-n", *(word for s in settings for word in ("--set", s)))
            self.assertEqual(run.code, 2, run)
            self.assertIn(message, run.err)
        self.edit("recipe.toml", "place_m = { disc = [0.02, 0.2] }\n", "")
        self.assertIn("distractors.place_m must be given", self.run_it("build", self.recipe, "-n").err)
        self.edit("environments/floor/environment.scn", "scene.objects.floor.material", "scene.objects.floor.id = 101\nscene.objects.floor.material")
        run = self.run_it("build", self.recipe, "-o", self.out, "-k", "--set", "distractors.place_m={disc=0.2}")
        self.assertIn("scene.objects.NAME.id must be below 101", run.err)

    def export(self, format, code=0):
        to = self.folder / format
        run = self.run_it("export", self.out, "--format", format, "-o", to)
        self.assertEqual(run.code, code, run)
        return to, run

    def build_classed(self, *arguments):
        (self.tiny / "classes.csv").write_text(TABLE)
        self.edit("recipe.toml", "[materials]", CLASSES + "[materials]")
        self.edit("recipe.toml", 'dir = "others"', 'dir = "others"\nclass = "solid/other"')
        self.build(*SIZE, *self.plain, *arguments)

    def expected(self, record):
        """(class, pixels) of all that is seen."""
        found = self.plane(record, "object_id")
        for of, number in [(record["class_path"], 1)] + [(o["class_path"], o["id"]) for o in record["objects"]]:
            pixels = {i for i, v in enumerate(found) if v == number}
            if pixels:
                yield of, pixels

    def test_coco_and_yolo_list_all(self):
        self.build_classed()
        coco, _ = self.export("coco")
        yolo, _ = self.export("yolo")
        names = ["solid/box", "solid/other", "solid/spike"]
        listed = 0
        for split in ("train", "test"):
            text = json.loads((coco / f"annotations/instances_{split}.json").read_text())
            category = {c["id"]: c["name"] for c in text["categories"]}
            self.assertEqual(sorted(category.values()), names)
            for image in text["images"]:
                [record] = [r for r in self.records() if r["id"] == image["dsbuild_id"]]
                wanted = list(self.expected(record))
                found = []
                for a in (a for a in text["annotations"] if a["image_id"] == image["id"]):
                    # Pycocotools' string of run lengths, by its definition: down the columns.
                    runs, value, shift = [], 0, 0
                    for c in a["segmentation"]["counts"]:
                        code = ord(c) - 48
                        value |= (code & 31) << shift
                        shift += 5
                        if not code & 32:
                            runs.append(value - (1 << shift) * bool(code & 16) + (runs[-2] if len(runs) > 2 else 0))
                            value = shift = 0
                    bits = [i % 2 for i, run in enumerate(runs) for _ in range(run)]
                    pixels = {(i % HEIGHT) * WIDTH + i // HEIGHT for i, bit in enumerate(bits) if bit}
                    self.assertEqual(a["area"], len(pixels))
                    xs, ys = [p % WIDTH for p in pixels], [p // WIDTH for p in pixels]
                    self.assertEqual(a["bbox"], [min(xs), min(ys), max(xs) - min(xs) + 1, max(ys) - min(ys) + 1])
                    found.append((category[a["category_id"]], pixels))
                self.assertEqual(found, wanted)
                listed += len(found)
                lines = (yolo / f"labels/{split}/{image['file_name'][:-4]}.txt").read_text().splitlines()
                self.assertEqual([names[int(line.split()[0])] for line in lines], [of for of, _ in wanted])
                for line, (_, pixels) in zip(lines, wanted):
                    cx, cy, w, h = (float(v) * s for v, s in zip(line.split()[1:], (WIDTH, HEIGHT) * 2))
                    xs, ys = [p % WIDTH for p in pixels], [p // WIDTH for p in pixels]
                    for value, edge in ((cx - w / 2, min(xs)), (cx + w / 2, max(xs) + 1), (cy - h / 2, min(ys)), (cy + h / 2, max(ys) + 1)):
                        self.assertAlmostEqual(value, edge, delta=1e-4)
        self.assertGreater(listed, 2 * IMAGES)

    def test_what_has_no_class_is_not_listed_and_what_cannot_be_told_apart_is_an_error(self):
        self.build_classed("--set", 'distractors.class=""')
        coco, run = self.export("coco")
        self.assertIn("distractors without a class have no annotation", run.err)
        for split in ("train", "test"):
            text = json.loads((coco / f"annotations/instances_{split}.json").read_text())
            self.assertLessEqual(len(text["annotations"]), len(text["images"]))
        _, run = self.export("csv")
        self.assertIn("left out, the format csv lists models alone", run.err)
        self.build_classed_again('planes = ["mask"]\n')
        _, run = self.export("yolo", code=1)
        self.assertIn('build with "object_id" in outputs.planes', run.err)

    def build_classed_again(self, planes):
        self.edit("recipe.toml", PLANES, planes)
        self.build(*SIZE, *self.plain)

    def test_bop_has_poses_and_masks_of_all(self):
        self.build_classed("--set", "distractors.size_m=0.06")
        to, _ = self.export("bop")
        models = {}
        names = json.loads((to / "dataset_info.json").read_text())["objects"]
        for number in names:
            lines = (to / f"models/obj_{int(number):06}.ply").read_text().splitlines()
            count = int(next(l for l in lines if l.startswith("element vertex")).split()[2])
            body = lines[lines.index("end_header") + 1:]
            models[int(number)] = [tuple(map(float, line.split()[:3])) for line in body[:count]]
        checked = 0
        for split in ("train", "test"):
            folder = to / split / "000000"
            gt, info, camera, coco = (json.loads((folder / f"scene_{n}.json").read_text()) for n in ("gt", "gt_info", "camera", "gt_coco"))
            for image in coco["images"]:
                [record] = [r for r in self.records() if r["id"] == image["dsbuild_id"]]
                number = str(image["id"])
                k = camera[number]["cam_K"]
                found = self.plane(record, "object_id")
                shown = [{**record, "id": 1}, *record["objects"]]
                self.assertEqual([names[str(g["obj_id"])]["model"] for g in gt[number]], [o["model"] for o in shown])
                for place, (g, i, o) in enumerate(zip(gt[number], info[number], shown)):
                    files = [folder / name / f"{image['id']:06}_{place:06}.png" for name in ("mask", "mask_visib")]
                    whole, visible = ({p for p, v in enumerate(image_reader.read_png(f)[4]) if v} for f in files)
                    self.assertEqual(visible, {p for p, v in enumerate(found) if v == o["id"]})
                    self.assertLessEqual(visible, whole)
                    self.assertEqual(i["px_count_visib"], len(visible))
                    # Corners, turned and moved as the file says, in millimetres, are the body's.
                    r, t = g["cam_R_m2c"], g["cam_t_m2c"]
                    corners = [[dot(r[3 * a:3 * a + 3], p) + t[a] for a in range(3)] for p in models[g["obj_id"]]]
                    folder_of = "models" if place == 0 else "others"
                    own, _ = faces_of(self.tiny / folder_of / o["model"])
                    for a, b in zip(corners, own):
                        self.assertLess(math.dist(a, [1000 * c for c in moved(o["model_to_camera"]["opencv"], b)]), 0.01)
                    # Pixel centres, which are at whole numbers, inside the outline of the projected corners.
                    outline = hull([tuple(k[j * 3 + j] * c[j] / c[2] + k[3 * j + 2] for j in (0, 1)) for c in corners])
                    edges = list(zip(outline, outline[1:] + outline[:1]))
                    inside = {y * WIDTH + x for y in range(HEIGHT) for x in range(WIDTH)
                              if all((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) >= 0 for a, b in edges)}
                    self.assertLessEqual(len(inside ^ whole), 2, "but for a centre on an edge")
                    amodal = o["pixels"]["amodal"] if place else o["pixel_counts"]["amodal"]
                    self.assertLessEqual(abs(amodal - len(whole)), 2)
                    checked += place > 0
        self.assertGreater(checked, IMAGES)

    def test_gallery_and_check_take_them(self):
        self.build()
        run = self.run_it("gallery", self.out, "-o", self.folder / "gallery")
        self.assertEqual(run.code, 0, run)
        text = (self.folder / "gallery/data/image-000.js").read_text()
        lines = json.loads(text[text.index("["):text.rindex("]") + 1])
        self.assertEqual([len(l["objects"]) for l in lines], [len(r["objects"]) for r in self.records()])
        self.assertNotIn("error", self.run_it("check", self.out, "--json").err)
        self.assertIn("distractors[0].place_m", self.run_it("plan", self.recipe, "-o", self.out, "--draws", "-v").out)


if __name__ == "__main__":
    main()
