# SPDX-License-Identifier: Apache-2.0
"""Where the model of an image stands, and the classes: what the manifest says, by projection and by hand."""
import itertools
import json

from harness import IMAGES, TinyCase, main
from image_reader import read_png

SIZE = ["--set", "engine.width=128", "--set", "engine.height=96"]


def corners_of(name, text):
    """The vertices that stand in a file of the tiny dataset."""
    lines = text.splitlines()
    first, count = (3, 8) if name.endswith(".off") else (lines.index("end_header") + 1, 4)
    return [tuple(map(float, line.split()[:3])) for line in lines[first:first + count]]


def moved(matrix, point):
    return [sum(m * p for m, p in zip(row, (*point, 1))) for row in matrix[:3]]


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def inverse_of_pose(pose):
    turn = [[pose[j][i] for j in range(3)] for i in range(3)]
    move = [-sum(turn[i][k] * pose[k][3] for k in range(3)) for i in range(3)]
    return [turn[i] + [move[i]] for i in range(3)] + [[0, 0, 0, 1]]


def turn(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def hull_pixels(points):
    """Pixels whose centres some triangle of three of the points holds."""
    (x0, x1), (y0, y1) = [[int(f(p[axis] for p in points)) for f in (min, max)] for axis in (0, 1)]
    corners = list(itertools.combinations(points, 3))
    def held(p):
        return any(min(t) >= 0 or max(t) <= 0 for t in ((turn(a, b, p), turn(b, c, p), turn(c, a, p)) for a, b, c in corners))
    return {(x, y) for y in range(y0, y1 + 1) for x in range(x0, x1 + 1) if held((x + 0.5, y + 0.5))}


class LabelsTest(TinyCase):
    def records(self):
        return [json.loads(line) for line in (self.out / "manifest/images.jsonl").read_text().splitlines()]

    def dataset(self):
        return json.loads((self.out / "manifest/dataset.json").read_text())

    def assert_close(self, a, b, delta=1e-9):
        for x, y in zip(itertools.chain.from_iterable(a), itertools.chain.from_iterable(b)):
            self.assertAlmostEqual(x, y, delta=delta)

    def mask_of(self, record):
        path = next(file["path"] for file in record["files"] if file["kind"] == "mask")
        width, height, _, _, values = read_png(self.out / path)
        return [(i % width, i // width) for i, value in enumerate(values) if value], width, height

    def test_vertices_of_the_file_are_projected_to_the_mask(self):
        for more in ([], ["--set", "models.up=z", "--set", "models.centre=box", "--set", "models.size_m=0.1"],
                     ["--set", "models.centre=none", "--set", "models.size_m=0", "--set", "camera.distance_m=7",
                      "--set", "models.ground_z_m=false"],
                     ["--set", 'models.turn={rotation="up"}', "--set", "models.place_m={disc=0.03}"],
                     ["--set", 'models.turn={rotation="any"}', "--set", "models.size_m={uniform=[0.05,0.1]}",
                      "--set", "models.place_m=[0.02,-0.03,0.01]"],
                     ["--set", 'models.turn={rotation="any"}', "--set", "models.place_m={disc=0.2}",
                      "--set", 'camera.distance_m="fit"'],
                     ["--set", 'models.turn=[1,0.2,0.3,0.4]', "--set", "models.ground_z_m=false", "--set", "models.centre=box",
                      "--set", "models.place_m=[0,0,0.2]", "--set", 'camera.distance_m="fit"']):
            self.build(*SIZE, *more)
            for record in self.records():
                model = corners_of(record["model"], (self.tiny / "models" / record["model"]).read_text())
                pixels, _, _ = self.mask_of(record)
                to_camera = product(inverse_of_pose(record["camera_to_world"]), record["model_to_world"])
                k = record["intrinsics"]
                seen = [[k[i][i] * p[i] / p[2] + k[i][2] for i in range(2)]
                        for p in (moved(to_camera, corner) for corner in model)]
                x, y, width, height = record["box"]
                # All of a convex body whose corners are in the picture, and nothing stands before it.
                for axis, first, size in ((0, x, width), (1, y, height)) if "turn" not in str(more) else ():
                    ends = [s[axis] for s in seen]
                    self.assertAlmostEqual(min(ends), first, delta=1.01, msg=record["id"])
                    self.assertAlmostEqual(max(ends), first + size, delta=1.01, msg=record["id"])
                inside = hull_pixels(seen) if "turn" in str(more) else set(pixels)
                self.assertLessEqual(len(inside ^ set(pixels)), 2, f"but for centres on an edge: {record['id']} {more}")
                self.assertEqual([x, y, x + width - 1, y + height - 1],
                                 [f(p[axis] for p in pixels) for f in (min, max) for axis in (0, 1)])
                # The boxes are tight around the vertices, and around what stands for them in the world.
                eight = list(itertools.product(*zip(*record["model_box"])))
                for box, points in (("model_box", model), ("box_m", [moved(record["model_to_world"], p) for p in eight])):
                    ends = [[f(p[axis] for p in points) for axis in range(3)] for f in (min, max)]
                    self.assert_close(record[box], ends)
                self.assert_close(record["model_to_camera"]["opencv"], to_camera)
                if "ground_z_m" not in str(more):
                    lift = 0.01 if "0.02,-0.03" in str(more) else 0
                    lowest = min(moved(record["model_to_world"], p)[2] for p in model)
                    self.assertAlmostEqual(lowest, -0.0574 + lift, delta=1e-9)
                flip = [[1, 0, 0, 0], [0, -1, 0, 0], [0, 0, -1, 0], [0, 0, 0, 1]]
                self.assert_close(record["model_to_camera"]["opengl"], product(flip, to_camera))

    def test_views_that_are_kept_show_the_model(self):
        sunk = ["--set", "models.place_m={box=[[-0.06,0,-0.12],[0.06,0,0]]}", *SIZE, "--set", "outputs.image=false",
                "--set", 'outputs.planes=["mask", "amodal_mask"]']
        self.build(*sunk)
        self.assertLess(min(r["visible_fraction"] for r in self.records()), 0.5)
        self.build(*sunk, "--set", "camera.keep.visible=0.7", "--set", "camera.keep.in_frame=1")
        for record in self.records():
            self.assertGreater(record["visible_fraction"], 0.66, record["id"])
            self.assertLess(record["truncation"], 0.02, record["id"])
        self.assertGreater(max(r["draw_attempts"] for r in self.records()), 1)

    def test_truncation_is_what_rays_beyond_the_frame_meet(self):
        some = 0
        for more in (["--set", "camera.target=[0.1,0.02,0.05]"],
                     ["--set", "camera.type=orthographic", "--set", "camera.extent_m=0.1"]):
            self.build(*more, "--set", "outputs.image=false", "--set", "outputs.mask=true")
            for record in self.records():
                model = corners_of(record["model"], (self.tiny / "models" / record["model"]).read_text())
                points = [moved(record["model_to_camera"]["opencv"], corner) for corner in model]
                k, pitch = record["intrinsics"], record.get("metres_per_pixel")
                seen = [(k[0][0] * x / z + k[0][2], k[1][1] * y / z + k[1][2]) if k else (x / pitch + 16, y / pitch + 16)
                        for x, y, z in points]
                # Both models are convex: a pixel shows one where no edge of its outline is to the left.
                outline = [(a, b) for a in seen for b in seen if a != b and all(turn(a, b, c) >= 0 for c in seen)]
                least, most = (f(int(c) for p in seen for c in p) for f in (min, max))
                hits = [(x, y) for x in range(least - 1, most + 1) for y in range(least - 1, most + 1)
                        if all(turn(a, b, (x + 0.5, y + 0.5)) >= 0 for a, b in outline)]
                out = [p for p in hits if not (0 <= p[0] < 32 and 0 <= p[1] < 32)]
                self.assertAlmostEqual(record["truncation"], len(out) / len(hits), delta=0.003, msg=record["id"])
                some += 0 < len(out) < len(hits)
        self.assertGreater(some, 8)

    def test_box_is_null_where_nothing_is_seen(self):
        self.build("--set", "models.centre=none", "--set", "models.size_m=0.16", "--set", "camera.target=[0,0,9]",
                   "--set", "camera.distance_m=1")
        for record in self.records():
            self.assertIsNone(record["box"])
            self.assertEqual(record["pixel_counts"]["model"], 0)

    def test_lines_of_before_get_the_boxes_without_tracing(self):
        self.build()
        before = self.contents()
        database = self.out / ".dsbuild/dsbuild.sqlite"
        import sqlite3  # what an older dsbuild left: no sides in the database, and another writer's manifest
        with sqlite3.connect(database) as connection:
            for key, facts in connection.execute("SELECT key, facts FROM product WHERE kind = 'mask'").fetchall():
                facts = json.loads(facts)
                for side in ("left", "right", "above", "below"):
                    del facts["pixel_counts"][side]
                connection.execute("UPDATE product SET facts = ? WHERE key = ?", (json.dumps(facts), key))
            connection.execute("UPDATE placed SET product = ? WHERE kind = 'manifest'", ("0" * 32,))
        connection.close()
        self.assertIn("without fields", self.run_it("plan", self.recipe, "-o", self.out).out)
        self.assert_counts(self.build(), traced=0, reused=IMAGES)
        self.assertEqual(self.contents(), before)

    def classes(self, *arguments):
        return self.run_it("classes", self.recipe, *arguments)

    def write_classes(self, text, ids=None):
        (self.tiny / "classes.csv").write_text("name,class\n" + text)
        more = ["--set", f"classes.from={self.tiny / 'classes.csv'}"]
        if ids is not None:
            (self.tiny / "ids.txt").write_text(ids)
            more += ["--set", f"classes.ids={self.tiny / 'ids.txt'}"]
        return more

    def ids(self):
        return {(record["class_path"], record["class_id"]) for record in self.records()}

    def test_ids_are_sorted_or_as_listed(self):
        more = self.write_classes("box,thing/crate\ntetra,solid\n")
        self.build(*more)
        self.assertEqual(self.ids(), {("solid", 0), ("thing/crate", 1)})
        self.assertEqual(self.dataset()["class_paths"], ["solid", "thing/crate"])
        self.assertEqual(self.classes(*more, "--ids").out, "solid\nthing/crate\n")
        # Kept, with a class that has no model yet, whatever comes behind.
        more = self.write_classes("box,thing/crate\ntetra,anything\n", "# mine\nthing/crate\nsolid\n")
        self.assertIn("class ids: anything, solid, thing/crate", self.run_it("plan", self.recipe, "-o", self.out, *more).out)
        self.assert_counts(self.build(*more), traced=0)
        self.assertEqual(self.ids(), {("thing/crate", 0), ("anything", 2)})
        self.assertEqual(self.dataset()["class_paths"], ["thing/crate", "solid", "anything"])
        listed = {entry["path"]: entry for entry in self.classes(*more, "--json").json["classes"]}
        self.assertEqual((listed["thing"]["id"], listed["thing"]["models"], listed["thing"]["images"]), (None, 1, 4))
        self.assertEqual((listed["solid"]["id"], listed["solid"]["models"]), (1, 0))

    def test_a_class_that_the_ids_lack_is_said(self):
        more = self.write_classes("box,car\ntetra,cra\n", "car\nanimal\n")
        for verb in ("plan", "build"):
            run = self.run_it(verb, self.recipe, "-o", self.out, *more)
            self.assertEqual(run.code, 0, run)
            self.assertIn(f"{self.tiny}/classes.csv:3: class cra is no line of {self.tiny}/ids.txt, did you mean car?", run.err)
            self.assertNotIn("class car is", run.err)
        more = self.write_classes("box,car\ntetra,boat\n", "car\nanimal\n")
        self.assertIn("class boat is no line of", self.run_it("plan", self.recipe, "-o", self.out, *more).err)
        more = self.write_classes("box,car\ntetra,animal\n", "car\nanimal\n")
        self.assertNotIn("no line of", self.run_it("plan", self.recipe, "-o", self.out, *more).err)

    def test_ids_that_cannot_be_meant_are_named_by_line(self):
        for text, why in (("a\nb\na\n", "ids.txt:3: class a stands in line 1 already"),
                          ("a//b\n", "ids.txt:1: a class must be names with / between")):
            run = self.run_it("plan", self.recipe, *self.write_classes("box,a\n", text))
            self.assertEqual(run.code, 2, run)
            self.assertIn(why, run.err)

    def test_further_classifications_stand_beside(self):
        for name, text in {"coarseTrain.cla": "PSB 1\n1 1\nbody 0 1\nbox\n",
                           "coarseTest.cla": "PSB 1\n2 1\nbody 0 0\nsharp body 1\ntetra\n",
                           "kind.csv": "name,class\nbox,flat\n"}.items():
            (self.tiny / name).write_text(text)
        files = json.dumps([str(self.tiny / name) for name in ("coarseTrain.cla", "coarseTest.cla", "kind.csv")])
        more = [*self.write_classes("box,crate\ntetra,solid\n"), "--set", f"classes.more={files}"]
        self.build(*more)
        self.assertEqual({(r["model"], r["classes"]["coarse"], r["classes"]["kind"]) for r in self.records()},
                         {("box.off", "body", "flat"), ("tetra.ply", "body/sharp", "")})
        self.assertEqual(self.dataset()["hierarchies"], {"coarse": ["body", "body/sharp"], "kind": ["flat"]})
        for line in (self.out / "manifest/images.jsonl").read_text().splitlines():
            self.assertEqual(list(json.loads(line)), sorted(json.loads(line)), "keys are sorted")
        self.assert_counts(self.build(*more), built=0)
        self.assertIn("also coarse: --classes coarse", self.classes(*more).out)
        table = self.classes(*more, "--classes", "coarse", "--json").json["classes"]
        self.assertEqual([(row["path"], row["id"], row["models"]) for row in table], [("body", 0, 2), ("body/sharp", 1, 1)])
        to = self.folder / "export"
        run = self.run_it("export", self.out, "--format", "csv", "--classes", "coarse", "-o", to)
        self.assertEqual(run.code, 0, run)
        self.assertIn("body/sharp", "".join(path.read_text() for path in to.rglob("*.csv")))
        run = self.run_it("export", self.out, "--format", "csv", "--classes", "corse", "-o", self.folder / "no")
        self.assertEqual(run.code, 2)
        self.assertIn("--classes: wanted coarse or kind, got corse, did you mean coarse?", run.err)
        # A class that moves is known by plan, and written without tracing.
        (self.tiny / "kind.csv").write_text("name,class,split\nbox,round,test\n")
        run = self.run_it("plan", self.recipe, "-o", self.out, *more)
        self.assertIn("classes.more of 4 images", run.out)
        self.assertIn("kind.csv: the column split is not used", run.err)
        self.assert_counts(self.build(*more), traced=0)
        self.assertEqual(self.dataset()["hierarchies"]["kind"], ["round"])

    def test_one_model_twice_is_named_with_both_places(self):
        for name in ("aTrain.cla", "aTest.cla"):
            (self.tiny / name).write_text("PSB 1\n1 1\nbody 0 1\nbox\n")
        files = json.dumps([str(self.tiny / name) for name in ("aTrain.cla", "aTest.cla")])
        run = self.run_it("plan", self.recipe, "--set", f"classes.more={files}")
        self.assertEqual(run.code, 2, run)
        self.assertRegex(run.err, r"aTest\.cla:4: model box stands in \S+aTrain\.cla:4 already")
        # By other names, and differently.
        (self.tiny / "aTest.cla").write_text("PSB 1\n1 1\nsoul 0 1\nbox.off\n")
        run = self.run_it("plan", self.recipe, "--set", f"classes.more={files}")
        self.assertEqual(run.code, 2, run)
        self.assertRegex(run.err, r"aTrain\.cla:4: must list box\.off once, found box \(body\) and, in \S+aTest\.cla:4, "
                                  r"box\.off \(soul\)")


if __name__ == "__main__":
    main()
