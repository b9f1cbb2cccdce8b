# SPDX-License-Identifier: Apache-2.0
"""Exports as their real consumers read them: pycocotools, Hugging Face datasets, mlcroissant, webdataset."""
import contextlib
import csv
import io
import json
import logging
import os
import pathlib
import sys
import tomllib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
os.environ["HF_HUB_OFFLINE"] = "1"  # nothing here is to ask a server

import datasets
import jsonschema
import mlcroissant
import numpy
import pyarrow.parquet as parquet
import webdataset
import yaml
from harness import IMAGES, TinyCase, main
from huggingface_hub import DatasetCard
from PIL import Image
from pycocotools.coco import COCO
from pycocotools.cocoeval import COCOeval


CLASSES = ["solid/box", "solid/spike"]


class ConsumersTest(TinyCase):
    def setUp(self):
        super().setUp()
        (self.tiny / "train.cla").write_text("PSB 1\n2 1\nsolid 0 0\nbox solid 1\nbox\n")
        (self.tiny / "test.cla").write_text("PSB 1\n2 1\nsolid 0 0\nspike solid 1\ntetra\n")
        self.edit("recipe.toml", "[materials]",
                  '[classes]\ntrain = "train.cla"\ntest = "test.cla"\n\n[materials]')
        self.build()
        lines = (self.out / "manifest/images.jsonl").read_text().splitlines()
        self.records = {record["id"]: record for record in map(json.loads, lines)}
        self.to = self.folder / "export"

    def export(self, format):
        run = self.run_it("export", self.out, "--format", format, "-o", self.to)
        self.assertEqual(run.code, 0, run)

    def picture(self, record, kind="image"):
        path = next(file["path"] for file in record["files"] if file["kind"] == kind)
        return numpy.asarray(Image.open(self.out / path))

    def load(self, *arguments, **options):
        return datasets.load_dataset(*arguments, cache_dir=str(self.folder / "cache"), **options)

    def test_formats_for_other_readers_are_no_image_folders(self):
        """Of folders' names the library would make labels that are none (of coco's: train and test)."""
        for name in ("coco", "nerf", "yolo", "yolo_seg"):
            with self.subTest(format=name):
                self.to = self.folder / name
                self.export(name)
                with self.assertRaisesRegex(datasets.exceptions.DataFilesNotFoundError, "No .*data files"):
                    self.load(str(self.to))
        self.to = self.folder / "csv"
        self.export("csv")
        table = self.load(str(self.to))
        self.assertEqual(list(table), ["images"])
        self.assertEqual(dict(zip(table["images"]["id"], table["images"]["split"])),
                         {name: record["split"] for name, record in self.records.items()})

    def test_coco(self):
        self.export("coco")
        seen = 0
        for split in ("train", "test"):
            with contextlib.redirect_stdout(io.StringIO()):
                coco = COCO(str(self.to / f"annotations/instances_{split}.json"))
                # The truth as its own result must be found perfectly.
                result = coco.loadRes([{"image_id": a["image_id"], "category_id": a["category_id"], "score": 1.0,
                                        "segmentation": a["segmentation"], "bbox": a["bbox"]}
                                       for a in coco.dataset["annotations"]])
                for kind in ("bbox", "segm"):
                    score = COCOeval(coco, result, kind)
                    score.evaluate()
                    score.accumulate()
                    score.summarize()
                    self.assertEqual(score.stats[0], 1.0, kind)
            for image in coco.dataset["images"]:
                [annotation] = coco.loadAnns(coco.getAnnIds(imgIds=image["id"], iscrowd=False))
                mask = self.picture(self.records[image["dsbuild_id"]], "mask") != 0
                numpy.testing.assert_array_equal(coco.annToMask(annotation), mask)
                self.assertEqual(annotation["area"], mask.sum())
                seen += 1
        self.assertEqual(seen, IMAGES)

    def expect_card(self, format):
        """The card tells the features and counts: a wrong count raises, and features that are not the files' do."""
        info = DatasetCard.load(self.to / "README.md").data.to_dict()["dataset_info"]
        self.assertEqual([(split["name"], split["num_examples"]) for split in info["splits"]],
                         [("test", IMAGES // 2), ("train", IMAGES // 2)])
        loaded = self.load(str(self.to))
        for rows in loaded.values():
            self.assertEqual({feature["name"] for feature in info["features"]}, set(rows.features))
            if format == "parquet":
                self.assertEqual(rows.features["label"].names, CLASSES)
            self.assertEqual(set(rows["label"]), {0} if rows.split == "train" else {1})
            self.assertEqual((type(rows.features["image"]), type(rows.features["mask"])), (datasets.Image, datasets.Image))
            numpy.testing.assert_array_equal(numpy.asarray(rows[0]["image"]), self.picture(self.records[rows[0]["id"]]))

    def test_imagefolder(self):
        self.export("imagefolder")
        self.expect_card("imagefolder")
        loaded = self.load("imagefolder", data_dir=str(self.to))
        self.assertEqual({split: len(rows) for split, rows in loaded.items()},
                         {"train": IMAGES // 2, "test": IMAGES // 2})
        for split, rows in loaded.items():
            for row in rows:
                record = self.records[row["id"]]
                self.assertEqual((record["split"], CLASSES[row["label"]], row["class_path"]),
                                 (split, record["class_path"], record["class_path"]))
                numpy.testing.assert_array_equal(numpy.asarray(row["image"]), self.picture(record))
                numpy.testing.assert_array_equal(numpy.asarray(row["mask"]), self.picture(record, "mask"))
                self.assertEqual(row["camera_to_world"], record["camera_to_world"])

    def test_imagefolder_with_planes_whose_names_come_first(self):
        self.build("--set", 'outputs.planes=["amodal_mask", "albedo:png8"]')
        self.records = {record["id"]: record for record in
                        map(json.loads, (self.out / "manifest/images.jsonl").read_text().splitlines())}
        self.export("imagefolder")
        self.expect_card("imagefolder")
        for loaded in (self.load("imagefolder", data_dir=str(self.to)), self.load(str(self.to))):
            for rows in loaded.values():
                self.assertEqual(len(rows), IMAGES // 2)
                for row in rows:
                    record = self.records[row["id"]]
                    for kind in ("image", "albedo", "amodal_mask", "mask"):
                        numpy.testing.assert_array_equal(numpy.asarray(row[kind]), self.picture(record, kind))
                    self.assertEqual((row["box_m"], row["visible_fraction"]), (record["box_m"], record["visible_fraction"]))

    def test_parquet(self):
        self.export("parquet")
        self.expect_card("parquet")
        table = parquet.read_table(self.to / "data/train-00000.parquet")
        self.assertEqual(table.num_rows, IMAGES // 2)
        loaded = self.load("parquet", data_files={split: str(self.to / f"data/{split}-*.parquet")
                                                  for split in ("train", "test")})
        self.assertEqual(loaded["train"].features["label"].names, CLASSES)
        seen = set()
        for split, rows in loaded.items():
            for row in rows:
                record = self.records[row["id"]]
                seen.add(row["id"])
                self.assertEqual((record["split"], CLASSES[row["label"]]), (split, record["class_path"]))
                for kind in ("image", "mask"):
                    numpy.testing.assert_array_equal(numpy.asarray(row[kind]), self.picture(record, kind))
                for name in ("camera_to_world", "intrinsics", "model_to_world", "box_m", "truncation", "lens_radius_m",
                             "focus_distance_m", "tone_map_scale"):
                    self.assertEqual(row[name], record[name], name)
                ys, xs = numpy.nonzero(self.picture(record, "mask"))
                self.assertEqual(row["bbox"], [xs.min(), ys.min(), numpy.ptp(xs) + 1, numpy.ptp(ys) + 1])
        self.assertEqual(seen, set(self.records))

    def test_what_is_drawn_is_columns(self):
        self.recipe.write_text(self.recipe.read_text() + """
[distractors]
dir = "{models}"
count = { integer = [0, 2] }
place_m = { disc = [0.1, 0.3] }
[[lights]]
type = "point"
position_m = [0.3, 0.3, 0.6]
gain = { uniform = [1, 2] }
[outputs.camera]
exposure_ev = { normal = [0, 0.3], within = [-1, 1] }
jpeg_quality = { integer = [60, 95] }
""")
        self.build("--set", 'models.turn={rotation="up"}', "--set", "camera.target={ball=0.01}", "--set", 'dataset.licence="CC0-1.0"')
        lines = (self.out / "manifest/images.jsonl").read_text().splitlines()
        self.records = {record["id"]: record for record in map(json.loads, lines)}
        keys = ["camera.target", "distractors.count", "lights[0].gain", "models.turn", "outputs.camera.exposure_ev", "outputs.camera.jpeg_quality"]
        for format in ("parquet", "imagefolder"):
            self.export(format)
            self.expect_card(format)
            seen = 0
            for rows in self.load(str(self.to)).values():
                self.assertEqual([name for name in rows.features if name.startswith("draws.")], [f"draws.{key}" for key in keys])
                for row in rows:
                    for key in keys:
                        self.assertEqual(row[f"draws.{key}"], self.records[row["id"]]["draws"][key], (format, key))
                        seen += 1
            self.assertEqual(seen, IMAGES * len(keys))
        self.export("croissant")
        dataset = mlcroissant.Dataset(jsonld=str(self.to / "croissant.json"))
        for row in dataset.records("images"):
            record = self.records[row["images/id"].decode()]
            for key in (key for key in keys if key not in ("distractors.count", "models.turn")):
                numpy.testing.assert_allclose(row[f"images/draws.{key}"], record["draws"][key], rtol=0)

    def test_parquet_of_parallel_rays(self):
        self.edit("recipe.toml", "fov_deg = 49", 'type = "orthographic"\nextent_m = 0.25')
        self.build()
        self.export("parquet")
        rows = parquet.read_table(self.to / "data/train-00000.parquet").to_pylist()
        self.assertEqual([(row["camera_model"], row["intrinsics"], row["metres_per_pixel"]) for row in rows],
                         [("orthographic", None, 0.25 / 32)] * (IMAGES // 2))

    def test_croissant(self):
        (self.tiny / "SOURCE").write_text("Solids of https://example.org/solids\n")
        self.build("--set", 'dataset.cite="Solids"', "--set", 'dataset.published="2026-11-27"')
        self.export("croissant")
        dataset = mlcroissant.Dataset(jsonld=str(self.to / "croissant.json"))
        issues = dataset.metadata.ctx.issues
        self.assertEqual((set(issues.errors), set(issues.warnings)), (set(), set()))
        logging.disable(logging.WARNING)  # "Could not match": of paths that it has cut already
        self.addCleanup(logging.disable, logging.NOTSET)
        for split in ("train", "test"):
            rows = list(dataset.records("images", filters={"images/split": split}))
            self.assertEqual(len(rows), IMAGES // 2)
            for row in rows:
                record = self.records[row["images/id"].decode()]
                self.assertEqual((row["images/split"].decode(), CLASSES[row["images/label"]]), (split, record["class_path"]))
                for kind in ("image", "mask"):
                    numpy.testing.assert_array_equal(numpy.asarray(row[f"images/{kind}"]), self.picture(record, kind))
                for name in ("camera_to_world", "model_to_world", "box_m"):
                    self.assertEqual(numpy.asarray(row[f"images/{name}"]).tolist(), record[name], name)
                self.assertEqual(list(row["images/bbox"]), record["box"])

    def test_schemas(self):
        def validator(what):
            schema = json.loads(self.run_it("schema", what).out)
            jsonschema.Draft202012Validator.check_schema(schema)
            return jsonschema.Draft202012Validator(schema)

        recipes = validator("recipe")
        for file in [*self.source.glob("recipes/*.toml"), self.recipe]:
            recipes.validate(tomllib.loads(file.read_text()))
        lamp = 'lights = [{ type = "point", position_m = { ball = 1 }, gain = 2, temperature_k = false, count = { integer = [0, 2] } }]'
        recipes.validate(tomllib.loads(lamp))
        for wrong in (lamp.replace("point", "pint"), lamp.replace("gain = 2", "gain = -2"), lamp.replace("gain", "gian"),
                      lamp.replace("{ ball = 1 }", "{ uniform = [0, 1] }"), lamp.replace("position_m = { ball = 1 }, ", "")):
            self.assertFalse(recipes.is_valid(tomllib.loads(wrong)), wrong)
        for wrong in ('camera.fov_deg = 180', 'camera.fov = 49', 'camera.distance_m = "fits"', 'engine.spp = 0.5',
                      'models.up = "x"', 'outputs.planes = "mask"', 'camera.target = [0, 1]', 'dataset.name = ".x"'):
            self.assertFalse(recipes.is_valid(tomllib.loads(wrong)), wrong)
        for right in ('camera.distance_m = "fit"', 'models.ground_z_m = false', 'engine.error = 0.02',
                      'classes.split = { test = 0.25, by = "model" }'):
            recipes.validate(tomllib.loads(right))
        (self.tiny / "more.csv").write_text("name,class\nbox,a\n")
        for more in ([], ["outputs.planes=['mask', 'amodal_mask', 'depth']", f"classes.more=['{self.tiny / 'more.csv'}']",
                          "dataset.cite='me'", "engine.error=0.5"],
                     ["distractors.dir='{models}'", "distractors.count=2", "distractors.place_m={disc=[0.2,0.4]}"],
                     ["models.size_m=0.1"]):
            if "models.size_m=0.1" in more:
                self.edit("recipe.toml", "fov_deg = 49", 'type = "orthographic"\nextent_m = 0.25')
            self.build(*[word for one in more for word in ("--set", one)])
            lines, wanted = validator("images"), {}
            for line in (self.out / "manifest/images.jsonl").read_text().splitlines():
                wanted = json.loads(line)
                lines.validate(wanted)
            self.assertFalse(lines.is_valid({**wanted, "more": 1}))
            self.assertFalse(lines.is_valid({**wanted, "class_id": "1"}))
            validator("dataset").validate(json.loads((self.out / "manifest/dataset.json").read_text()))

    def test_a_validation_split(self):
        """train, val and test as each reader wants them: as the manifest has them, picture by picture."""
        for copy in ("box2.off", "box3.off"):
            (self.tiny / "models" / copy).write_text((self.tiny / "models/box.off").read_text().replace("-1 -1 -2", "-1 -1 -3"))
        (self.tiny / "all.csv").write_text("name,class,split\nbox,solid/box,train\nbox2,solid/box,validation\nbox3,solid/box,test\ntetra,solid/spike,val\n")
        self.edit("recipe.toml", 'train = "train.cla"\ntest = "test.cla"\n', 'from = "all.csv"\n')
        self.build()
        self.records = {record["id"]: record for record in
                        map(json.loads, (self.out / "manifest/images.jsonl").read_text().splitlines())}
        wanted = {split: {id for id, record in self.records.items() if record["split"] == split} for split in ("train", "val", "test")}
        self.assertEqual([len(wanted[split]) for split in wanted], [IMAGES // 2, IMAGES, IMAGES // 2])
        named = {"train": wanted["train"], "validation": wanted["val"], "test": wanted["test"]}  # as the library calls them

        for format in ("imagefolder", "parquet"):
            self.export(format)
            for loaded in (self.load(format, data_dir=str(self.to)), self.load(str(self.to))):
                self.assertEqual({split: set(rows["id"]) for split, rows in loaded.items()}, named, format)
        self.export("croissant")
        dataset = mlcroissant.Dataset(jsonld=str(self.to / "croissant.json"))
        self.assertEqual(set(dataset.metadata.ctx.issues.errors), set())
        urls = {row["splits/name"]: row["splits/url"] for row in dataset.records("splits")}
        self.assertEqual({str(name): str(url).rpartition(":")[2].rpartition("/")[2] for name, url in urls.items()},
                         {"train": "TrainingSplit", "val": "ValidationSplit", "test": "TestSplit"})
        logging.disable(logging.WARNING)
        self.addCleanup(logging.disable, logging.NOTSET)
        for split, ids in wanted.items():
            rows = dataset.records("images", filters={"images/split": split})
            self.assertEqual({row["images/id"].decode() for row in rows}, ids)
        self.export("webdataset")
        for split, ids in wanted.items():
            samples = webdataset.WebDataset(str(self.to / f"tiny-{split}-000000.tar"), shardshuffle=False).decode("rgb8")
            self.assertEqual({sample["json"]["id"] for sample in samples}, ids)
        self.export("coco")
        for split, ids in wanted.items():
            with contextlib.redirect_stdout(io.StringIO()):
                coco = COCO(str(self.to / f"annotations/instances_{split}.json"))
            self.assertEqual({image["dsbuild_id"] for image in coco.dataset["images"]}, ids)
        self.export("yolo")
        data = yaml.safe_load((self.to / "data.yaml").read_text())
        for split, ids in wanted.items():
            pictures = sorted((self.to / data[split]).iterdir())
            self.assertEqual(len(pictures), len(ids))
            self.assertEqual({tuple(numpy.asarray(Image.open(picture)).ravel()) for picture in pictures},
                             {tuple(self.picture(self.records[id]).ravel()) for id in ids})
        only = self.run_it("export", self.out, "--format", "csv", "-o", self.folder / "part", "--split", "val")
        self.assertEqual(only.code, 0, only)
        self.assertEqual({row["id"] for row in csv.DictReader((self.folder / "part/images.csv").open())}, wanted["val"])

    def test_webdataset(self):
        self.export("webdataset")
        seen = set()
        for split in ("train", "test"):
            pattern = str(self.to / f"tiny-{split}-000000.tar")
            for sample in webdataset.WebDataset(pattern, shardshuffle=False).decode("rgb8"):
                record = self.records[sample["json"]["id"]]
                seen.add(record["id"])
                self.assertEqual((CLASSES[sample["cls"]], record["split"]), (record["class_path"], split))
                numpy.testing.assert_array_equal(sample["png"], self.picture(record))
        self.assertEqual(seen, set(self.records))
        loaded = self.load("webdataset", data_files={"train": str(self.to / "tiny-train-*.tar")})
        for row in loaded["train"]:
            numpy.testing.assert_array_equal(numpy.asarray(row["png"]), self.picture(self.records[row["json"]["id"]]))


if __name__ == "__main__":
    main()
