# SPDX-License-Identifier: Apache-2.0
"""dsbuild export: what a format says of an image is what the manifest says, in the order and the words its readers take."""
import csv
import json

from harness import IMAGES, TinyCase, main

FIELDS = ("truncation", "visible_fraction", "occlusion", "model_to_world", "box_m", "lens_radius_m", "focus_distance_m", "tone_map_scale")
ONE_SCENE = ['materials.assign="random"', 'environments.assign="random"', 'materials.per="model"', 'environments.per="model"', 'outputs.tone_map="linear"']


class ExportFieldsTest(TinyCase):
    def setUp(self):
        super().setUp()
        self.to = self.folder / "export"

    def export(self, format, *sets):
        self.build(*[word for one in sets for word in ("--set", one)])
        run = self.run_it("export", self.out, "--format", format, "-o", self.to, "--json")
        self.assertEqual(run.code, 0, run)
        return run

    def records(self):
        return {record["id"]: record for record in map(json.loads, (self.out / "manifest/images.jsonl").read_text().splitlines())}

    def notes(self, *sets):
        """Of scenes whose frames differ."""
        run = self.export("nerf", *ONE_SCENE, *sets)
        notes = [note for note in run.json["notes"] if "still scene" in note]
        for note in notes:
            self.assertIn(note, run.err)
            self.assertIn(note, (self.to / "README.md").read_text())
        return notes

    def test_the_picture_stands_before_planes_in_imagefolder(self):
        """datasets gives file_name to the first of NAME_file_name and file_name that a line has."""
        self.export("imagefolder", 'outputs.planes=["amodal_mask", "albedo:png8", "depth", "shading_normal:png16"]')
        lines = (self.to / "train/metadata.jsonl").read_text().splitlines()
        self.assertEqual(len(lines), IMAGES)
        for text in lines:
            names = [name for name in json.loads(text) if name.endswith("file_name")]
            self.assertEqual(names, ["file_name", "albedo_file_name", "amodal_mask_file_name", "mask_file_name", "shading_normal_file_name"])
            self.assertIn("depth_path", json.loads(text))
            self.assertTrue((self.to / "train" / json.loads(text)["file_name"]).is_file())

    def test_tables_have_the_fields_of_the_manifest(self):
        self.export("csv", 'outputs.planes=["amodal_mask"]', "camera.target=[0.04,0.08,0.02]", "camera.distance_m=0.3")
        records = self.records()
        with open(self.to / "images.csv", newline="") as file:
            table = list(csv.DictReader(file))
        self.assertEqual(len(table), IMAGES)
        for row in table:
            for name in FIELDS:
                self.assertEqual(json.loads(row[name]), records[row["id"]][name], name)
        self.assertGreater(len({row["truncation"] for row in table}), 1, "the view is chosen to cut some")
        self.export("imagefolder")
        for line in map(json.loads, (self.to / "train/metadata.jsonl").read_text().splitlines()):
            record = self.records()[line["id"]]
            self.assertEqual([line[name] for name in FIELDS if name in record], [record[name] for name in FIELDS if name in record])
            self.assertEqual([name for name in FIELDS if name not in line], ["visible_fraction", "occlusion"])

    def test_nerf_has_intrinsics_by_frame_where_they_differ(self):
        names = {"fl_x", "fl_y", "cx", "cy", "w", "h"}
        for fov, differ in (("49", False), ("{uniform=[35,60]}", True)):
            self.export("nerf", *ONE_SCENE, f"camera.fov_deg={fov}")
            by_key = {f"{r['model'].rsplit('.', 1)[0]}-{r['view']}": r for r in self.records().values()}
            seen = []
            for path in self.to.rglob("transforms.json"):
                scene = json.loads(path.read_text())
                for frame in scene["frames"]:
                    has, lacks = (frame, scene) if differ else (scene, frame)
                    self.assertLessEqual(names, has.keys())
                    self.assertFalse(names & lacks.keys(), "readers take the scene's for all where it has them")
                    record = by_key[frame["file_path"].rsplit("/", 1)[1][:-4]]
                    k = record["intrinsics"]
                    self.assertEqual([has[name] for name in ("fl_x", "fl_y", "cx", "cy", "w", "h")],
                                     [k[0][0], k[1][1], k[0][2], k[1][2], record["width"], record["height"]])
                    seen.append(has["fl_x"])
            self.assertEqual((len(seen), len(set(seen)) > 1), (IMAGES, differ))

    def test_nerf_says_which_scenes_are_not_still(self):
        self.assertEqual(self.notes("camera.fov_deg={uniform=[35,60]}"), [], "the camera may move")
        self.assertEqual(self.notes('models.turn={rotation="up"}'),
                         ["2 of 2 scenes are not one still scene, since their frames differ in model pose"])
        self.assertEqual(self.notes("outputs.camera.exposure_ev={uniform=[-1,1]}", "outputs.camera.noise={uniform=[0,0.1]}"),
                         ["2 of 2 scenes are not one still scene, since their frames differ in exposure, picture effects"])
        self.assertEqual(self.notes("environments.turn_deg={uniform=[-90,90]}"),
                         ["2 of 2 scenes are not one still scene, since their frames differ in environment (turn, gain, temperature)"])
        self.assertEqual(self.notes('outputs.tone_map="autolinear"'),
                         ["2 of 2 scenes are not one still scene, since their frames differ in exposure"])
        self.assertEqual(self.notes("distractors.dir='{models}'", "distractors.count=1", "distractors.place_m={disc=[0.2,0.4]}"),
                         ["2 of 2 scenes are not one still scene, since their frames differ in objects"])
        self.recipe.write_text(self.recipe.read_text() + '[[lights]]\ntype = "point"\nposition_m = { ball = 1 }\ngain = 2\n')
        self.assertEqual(self.notes(), ["2 of 2 scenes are not one still scene, since their frames differ in lights"])

    def test_the_card_has_the_conventions_of_its_format(self):
        planes = 'outputs.planes=["mask", "amodal_mask", "depth"]'
        pixels, camera = "A bbox is [x, y, width, height] of that in whole pixels.", "Cameras: x right, y down, z forward; pixel centres at .5."
        for format, says, says_not in (
                ("coco", [pixels, camera], []), ("csv", [pixels, camera], []),
                ("bop", ["greatest x less least", "pixel centres at whole numbers", "in millimetres"], [pixels, camera, "World:"]),
                ("nerf", ["x right, y up, z backward (OpenGL)"], [pixels, camera]),
                ("yolo", ["the middle, width and height of its box"], [pixels, camera]),
                ("yolo_seg", ["the corners of its outline"], [pixels, camera])):
            self.export(format, planes)
            card = " ".join((self.to / "README.md").read_text().split())
            for text in says:
                self.assertIn(text, card, format)
            for text in says_not:
                self.assertNotIn(text, card, format)

    def test_bop_counts_the_sizes(self):
        more = ['outputs.planes=["mask", "amodal_mask", "depth", "object_id"]', "distractors.dir='{models}'", "distractors.count=2",
                "distractors.place_m={disc=[0.1,0.2]}", "distractors.size_m={uniform=[0.04,0.08]}"]
        run = self.export("bop", *more)
        objects = json.loads((self.to / "dataset_info.json").read_text())["objects"]
        models = {one["model"] for one in objects.values()}
        self.assertGreater(len(objects), len(models))
        [note] = [note for note in run.json["notes"] if "several sizes" in note]
        self.assertIn(f": {len(objects)} objects of {len(models)} models", note)
        sizes = {}
        for record in self.records().values():
            for one in [record, *record.get("objects", [])]:
                m = one["model_to_world"]
                sizes.setdefault(one["model"], set()).add(round(1000 * sum(m[i][0] ** 2 for i in range(3)) ** 0.5, 6))
        for name in models:
            self.assertEqual({round(one["mm_per_unit"], 6) for one in objects.values() if one["model"] == name}, sizes[name])
        run = self.export("bop", more[0])
        self.assertEqual([note for note in run.json["notes"] if "several sizes" in note], [])


if __name__ == "__main__":
    main()
