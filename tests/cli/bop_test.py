# SPDX-License-Identifier: Apache-2.0
"""export --format bop, read as the format is specified: poses are rotations, and models stand where the masks are."""
import json
import math

import image_reader
from harness import IMAGES, TinyCase, main

PLANES = ["--set", 'outputs.planes=["mask", "amodal_mask", "depth"]', "--set", "engine.width=96", "--set", "engine.height=64"]


def read_ply(path):
    lines = path.read_text().splitlines()
    points = int(next(line for line in lines if line.startswith("element vertex")).split()[2])
    body = lines[lines.index("end_header") + 1:]
    return [list(map(float, line.split())) for line in body[:points]], [list(map(int, line.split()))[1:] for line in body[points:]]


def applied(rotation, translation, point):
    return [sum(rotation[3 * i + j] * point[j] for j in range(3)) + translation[i] for i in range(3)]


def covers(a, b, c, x, y):
    """Whether a triangle holds a point."""
    turns = [(q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]) for p, q in ((a, b), (b, c), (c, a))]
    return min(turns) >= 0 or max(turns) <= 0


class BopTest(TinyCase):
    def setUp(self):
        super().setUp()
        (self.tiny / "test.cla").write_text("PSB 1\n1 1\nspike 0 1\ntetra\n")
        (self.tiny / "train.cla").write_text("PSB 1\n1 1\nbox 0 1\nbox\n")
        self.edit("recipe.toml", "[materials]", '[classes]\ntrain = "train.cla"\ntest = "test.cla"\n\n[materials]')
        self.to = self.folder / "bop"

    def export(self, *more, code=0):
        self.build(*PLANES, *more)
        run = self.run_it("export", self.out, "--format", "bop", "-o", self.to, "--json")
        self.assertEqual(run.code, code, run)
        return run

    def load(self, name):
        return json.loads((self.to / name).read_text())

    def pixels(self, path):
        width, height, channels, _, values = image_reader.read_png(path)
        self.assertEqual(channels, 1)
        return [(i % width, i // width) for i, value in enumerate(values) if value], values, width, height

    def check_pose(self, folder, image, models, info):
        """Pixel centres that the projected triangles cover are the mask, and depth is there where the model is."""
        camera, pose = self.load(f"{folder}/scene_camera.json")[image], self.load(f"{folder}/scene_gt.json")[image][0]
        labels = self.load(f"{folder}/scene_gt_info.json")[image][0]
        rotation, translation = pose["cam_R_m2c"], pose["cam_t_m2c"]
        for i in range(3):  # a rotation, no scale
            for j in range(3):
                dot = sum(rotation[3 * i + k] * rotation[3 * j + k] for k in range(3))
                self.assertAlmostEqual(dot, 1 if i == j else 0, delta=1e-12)
        k = camera["cam_K"]
        points, faces = models[pose["obj_id"]]
        in_camera = [applied(rotation, translation, p) for p in points]
        seen = [(k[0] * p[0] / p[2] + k[2], k[4] * p[1] / p[2] + k[5]) for p in in_camera]
        whole, _, _, _ = self.pixels(self.to / folder / f"mask/{int(image):06}_000000.png")
        inside = {(x, y) for y in range(64) for x in range(96)
                  if any(covers(*(seen[v] for v in face), x, y) for face in faces)}
        self.assertLessEqual(len(inside ^ set(whole)), 2, "but for a pixel centre on an edge")
        part, _, _, _ = self.pixels(self.to / folder / f"mask_visib/{int(image):06}_000000.png")
        for pixels, box in ((whole, "bbox_obj"), (part, "bbox_visib")):
            xs, ys = [p[0] for p in pixels], [p[1] for p in pixels]
            self.assertEqual(labels[box], [min(xs), min(ys), max(xs) - min(xs), max(ys) - min(ys)])
        self.assertEqual((labels["px_count_all"], labels["px_count_visib"]), (len(whole), len(part)))
        self.assertAlmostEqual(labels["visib_fract"], len(part) / len(whole))
        # Depth at a mask's pixels lies between the nearest and the farthest point of the model.
        _, ticks, width, _ = self.pixels(self.to / folder / f"depth/{int(image):06}.png")
        depths = [ticks[y * width + x] * camera["depth_scale"] for x, y in part]
        self.assertGreater(min(depths), min(p[2] for p in in_camera) - 0.6)
        self.assertLess(max(depths), max(p[2] for p in in_camera) + 0.6)
        self.assertEqual(labels["px_count_valid"], sum(ticks[y * width + x] > 0 for x, y in whole))
        self.assertEqual(info[str(pose["obj_id"])].keys(),
                         {"diameter", "min_x", "min_y", "min_z", "size_x", "size_y", "size_z"})

    def test_models_and_poses_agree_with_masks_and_depths(self):
        for more in ([], ["--set", "models.up=z", "--set", "models.size_m=0.1", "--set", "camera.azimuth_deg=33"],
                     ["--set", 'models.turn={rotation="any"}', "--set", "models.size_m={uniform=[0.08,0.12]}",
                      "--set", "models.place_m={disc=0.02}"]):
            self.export(*more)
            info, objects = self.load("models/models_info.json"), self.load("dataset_info.json")["objects"]
            self.assertEqual([objects[i]["model"] for i in ("1", "2")], ["box.off", "tetra.ply"])
            models = {i: read_ply(self.to / f"models/obj_{i:06}.ply") for i in (1, 2)}
            for i, (points, faces) in models.items():
                farthest = max(math.dist(p[:3], q[:3]) for p in points for q in points)
                self.assertAlmostEqual(info[str(i)]["diameter"], farthest, delta=1e-4)
                for axis, name in enumerate("xyz"):
                    least, most = min(p[axis] for p in points), max(p[axis] for p in points)
                    self.assertAlmostEqual(least, -most, delta=1e-4, msg="the origin is the box's middle")
                    self.assertAlmostEqual(info[str(i)][f"min_{name}"], least, delta=1e-4)
                    self.assertAlmostEqual(info[str(i)][f"size_{name}"], most - least, delta=1e-4)
                for face in faces:  # outwards, as normals are
                    a, b, c = (points[v] for v in face)
                    for v in face:
                        self.assertGreater(sum(points[v][3 + j] * points[v][j] for j in range(3)), 0)
            for folder, count in (("train/000000", IMAGES // 2), ("test/000000", IMAGES // 2)):
                self.assertEqual(list(self.load(f"{folder}/scene_gt.json")), [str(i) for i in range(count)])
                for image in map(str, range(count)):
                    self.check_pose(folder, image, models, info)
            targets = self.load("test_targets_bop19.json")
            self.assertEqual([t["im_id"] for t in targets], list(range(IMAGES // 2)))
            coco = self.load("test/000000/scene_gt_coco.json")
            self.assertEqual(len(coco["annotations"]), IMAGES // 2)
            self.assertEqual(self.run_it("verify", self.to).code, 0)

    def test_what_the_picture_cuts_off_counts(self):
        self.export("--set", "camera.target=[0,0.07,0.02]", "--set", "camera.distance_m=0.5")
        cut = 0
        for split in ("train", "test"):
            folder = f"{split}/000000"
            for image, (labels,) in self.load(f"{folder}/scene_gt_info.json").items():
                x, y, w, h = labels["bbox_obj"]
                out = x < 0 or y < 0 or x + w > 95 or y + h > 63
                whole, _, _, _ = self.pixels(self.to / folder / f"mask/{int(image):06}_000000.png")
                cut += out
                if out:
                    self.assertGreater(labels["px_count_all"], len(whole))
        self.assertGreater(cut, 0, "the view is chosen to cut some")

    def project(self, folder, image, models):
        """Where BOP's own numbers put a model's triangles in the picture, pixel centres at whole numbers."""
        camera, pose = self.load(f"{folder}/scene_camera.json")[image], self.load(f"{folder}/scene_gt.json")[image][0]
        k, (points, faces) = camera["cam_K"], models[pose["obj_id"]]
        in_camera = [applied(pose["cam_R_m2c"], pose["cam_t_m2c"], p) for p in points]
        seen = [(k[0] * p[0] / p[2] + k[2], k[4] * p[1] / p[2] + k[5]) for p in in_camera]
        return [[seen[v] for v in face] for face in faces]

    def test_what_is_wholly_beside_the_picture_has_its_box(self):
        # Left of it, above, right, below, and over the corner where rows and columns are less than none.
        for target in ([0.7, 0, 0.05], [-0.7, 0, 0.05], [0, 0, -0.6], [0, 0, 0.7], [0.7, 0, -0.6]):
            self.export("--set", f"camera.target={target}", "--set", "camera.set=list",
                        "--set", "camera.positions=[[0,0.9,0.05]]")
            models, beside = {i: read_ply(self.to / f"models/obj_{i:06}.ply") for i in (1, 2)}, 0
            for split in ("train", "test"):
                folder = f"{split}/000000"
                for image, (labels,) in self.load(f"{folder}/scene_gt_info.json").items():
                    triangles = self.project(folder, image, models)
                    inside = [(x, y) for y in range(-64, 128) for x in range(-96, 192)
                              if any(covers(*t, x, y) for t in triangles)]
                    xs, ys = [x for x, _ in inside], [y for _, y in inside]
                    hidden = max(xs) < -1 or max(ys) < -1 or min(xs) > 96 or min(ys) > 64
                    beside += hidden
                    right = [min(xs), min(ys), max(xs) - min(xs), max(ys) - min(ys)]
                    for found, wanted in zip(labels["bbox_obj"], right):  # but for a centre on an edge
                        self.assertAlmostEqual(found, wanted, delta=1, msg=(target, labels, right))
                    if hidden:
                        self.assertEqual((labels["bbox_visib"], labels["px_count_visib"]), ([-1, -1, -1, -1], 0))
            self.assertGreater(beside, 0, f"{target} is chosen to show nothing")

    def test_depths_as_they_are_in_png(self):
        self.export("--set", 'outputs.planes=["mask", "amodal_mask", "depth:png16"]')
        self.assertEqual(self.load("camera.json")["depth_scale"], 1.0)

    def test_has_no_camera_of_parallel_rays(self):
        self.edit("recipe.toml", "fov_deg = 49", 'type = "orthographic"')
        run = self.export(code=1)
        self.assertIn("bop has no camera of parallel rays, got one that is orthographic", run.err)
        self.assertFalse(self.to.exists())

    def test_wants_the_models_and_the_planes(self):
        self.build(*PLANES)
        (self.tiny / "recipe.toml").rename(self.tiny / "other.toml")
        run = self.run_it("export", self.out, "--format", "bop", "-o", self.to)
        self.assertEqual(run.code, 2, run)
        self.assertIn("name the recipe", run.err)
        (self.tiny / "other.toml").rename(self.tiny / "recipe.toml")
        self.edit("models/box.off", "-1 -1 -2", "-1 -1 -3")
        run = self.run_it("export", self.out, "--format", "bop", "-o", self.to)
        self.assertEqual(run.code, 1, run)
        self.assertIn("is no longer the model of the pictures", run.err)
        self.assertFalse(self.to.exists())


if __name__ == "__main__":
    main()
