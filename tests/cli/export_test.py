# SPDX-License-Identifier: Apache-2.0
"""dsbuild export: each format as a reader of its own sees it, and the folder whole or not at all."""
import csv
import json
import os
import shutil
import signal
import subprocess
import tarfile
import time

import image_reader
from harness import IMAGES, TinyCase, main

FORMATS = ["coco", "croissant", "csv", "imagefolder", "nerf", "parquet", "webdataset", "yolo", "yolo_seg"]
TRAIN = "PSB 1\n2 1\nsolid 0 0\nbox solid 1\nbox\n"
TEST = "PSB 1\n2 1\nsolid 0 0\nspike solid 1\ntetra\n"
CLASSES = ["solid/box", "solid/spike"]


def decode_runs(counts, height, width):
    """COCO's compressed run lengths, by their definition: rows of 0 and 1."""
    runs, at = [], 0
    while at < len(counts):
        value, shift, more = 0, 0, True
        while more:
            digit = ord(counts[at]) - 48
            value |= (digit & 31) << shift
            more = bool(digit & 32)
            shift += 5
            at += 1
            if not more and digit & 16:
                value -= 1 << shift
        runs.append(value + (runs[-2] if len(runs) > 2 else 0))
    flat = [i % 2 for i, run in enumerate(runs) for _ in range(run)]
    assert len(flat) == height * width, (len(flat), height, width)
    return [[flat[x * height + y] for x in range(width)] for y in range(height)]


class ExportTest(TinyCase):
    def setUp(self):
        super().setUp()
        (self.tiny / "train.cla").write_text(TRAIN)
        (self.tiny / "test.cla").write_text(TEST)
        self.edit("recipe.toml", "[materials]",
                  '[classes]\ntrain = "train.cla"\ntest = "test.cla"\n\n[materials]')
        self.build()
        self.to = self.folder / "export"

    def export(self, format, *arguments, code=0, target=None):
        run = self.run_it("export", target or self.out, "--format", format, "-o", self.to, "--json", *arguments)
        self.assertEqual(run.code, code, run)
        return run.json

    def records(self):
        return [json.loads(line) for line in (self.out / "manifest/images.jsonl").read_text().splitlines()]

    def rows(self, path):
        """Rows of a grey PNG, 0 and 1."""
        width, height, channels, _, samples = image_reader.read_png(path)
        self.assertEqual(channels, 1)
        return [[1 if v else 0 for v in samples[y * width:(y + 1) * width]] for y in range(height)]

    def mask(self, record):
        return self.rows(self.out / next(f["path"] for f in record["files"] if f["kind"] == "mask"))

    def box(self, rows):
        ys = [y for y, row in enumerate(rows) if any(row)]
        xs = [x for x in range(len(rows[0])) if any(row[x] for row in rows)]
        return [xs[0], ys[0], xs[-1] - xs[0] + 1, ys[-1] - ys[0] + 1]

    def key(self, record):
        return record["model"].rsplit(".", 1)[0] + "-" + record["view"]

    def test_every_format_whole_the_same_twice_and_verified(self):
        for format in FORMATS:
            told = self.export(format)
            self.assertEqual((told["images"], told["left_out"]), (IMAGES, {}), format)
            self.assertEqual(told["splits"], {"test": IMAGES // 2, "train": IMAGES // 2})
            files = self.contents(self.to)
            self.assertIn("README.md", files)
            self.assertEqual(told["files"], len(files) - 1)  # its own checksums are listed nowhere
            run = self.run_it("verify", self.to)
            self.assertEqual(run.code, 0, run)
            self.export(format, "--copy")
            self.assertEqual(self.contents(self.to), files, format)
            self.assertEqual([p.name for p in self.folder.iterdir() if p.name.startswith(".")], [])
            victim = next(path for path in sorted(files) if path.endswith((".png", ".tar", ".parquet")))
            (self.to / victim).unlink()
            (self.to / victim).write_bytes(b"mine")
            (self.to / "extra").write_bytes(b"")
            run = self.run_it("verify", self.to)
            self.assertEqual(run.code, 1, run)
            self.assertIn(f"changed: {victim}", run.out)
            self.assertIn("extra: extra", run.out)
            shutil.rmtree(self.to)
        self.assertEqual(self.run_it("verify", self.out).code, 0)

    def test_coco(self):
        self.export("coco")
        seen = {}
        for split in ("train", "test"):
            told = json.loads((self.to / f"annotations/instances_{split}.json").read_text())
            self.assertEqual([c["name"] for c in told["categories"]], CLASSES)
            self.assertEqual([c["id"] for c in told["categories"]], [1, 2])
            self.assertEqual(told["categories"][1]["supercategory"], "solid")
            by_image = {a["image_id"]: a for a in told["annotations"]}
            self.assertEqual(len(by_image), len(told["annotations"]))
            for image in told["images"]:
                self.assertTrue((self.to / "images" / split / image["file_name"]).is_file())
                seen[image["dsbuild_id"]] = (split, image, by_image[image["id"]])
        self.assertEqual(len({image["id"] for _, image, _ in seen.values()}), IMAGES)
        for record in self.records():
            split, image, annotation = seen[record["id"]]
            mask = self.mask(record)
            self.assertEqual(split, record["split"])
            self.assertEqual(image["file_name"], self.key(record) + ".png")
            self.assertEqual(annotation["category_id"], CLASSES.index(record["class_path"]) + 1)
            self.assertEqual(annotation["bbox"], self.box(mask))
            self.assertEqual(annotation["area"], sum(map(sum, mask)))
            segmentation = annotation["segmentation"]
            self.assertEqual(segmentation["size"], [record["height"], record["width"]])
            self.assertEqual(decode_runs(segmentation["counts"], *segmentation["size"]), mask)

    def test_yolo(self):
        self.export("yolo")
        text = (self.to / "data.yaml").read_text()
        self.assertEqual(text, 'train: images/train\nval: images/test\ntest: images/test\nnames:\n'
                               '  0: "solid/box"\n  1: "solid/spike"\n')
        for record in self.records():
            name = f"{record['split']}/{self.key(record)}"
            self.assertTrue((self.to / "images" / (name + ".png")).is_file())
            numbers = (self.to / "labels" / (name + ".txt")).read_text().split()
            self.assertEqual(CLASSES[int(numbers[0])], record["class_path"])
            cx, cy, w, h = map(float, numbers[1:])
            x, y, width, height = self.box(self.mask(record))
            for found, wanted in ((cx * record["width"], x + width / 2), (cy * record["height"], y + height / 2),
                                  (w * record["width"], width), (h * record["height"], height)):
                self.assertAlmostEqual(found, wanted, 9)
        self.assertEqual(list((self.to / "images").rglob("*mask*")), [])

    def test_yolo_seg(self):
        self.export("yolo_seg")
        for record in self.records():
            numbers = (self.to / "labels" / f"{record['split']}/{self.key(record)}.txt").read_text().split()
            self.assertEqual(CLASSES[int(numbers[0])], record["class_path"])
            xs = [float(x) * record["width"] for x in numbers[1::2]]
            ys = [float(y) * record["height"] for y in numbers[2::2]]
            self.assertGreaterEqual(len(xs), 4)
            self.assertEqual(self.filled(list(zip(xs, ys)), record["width"], record["height"]), self.mask(record))

    @staticmethod
    def filled(polygon, width, height):
        """Pixels whose centre has an odd number of edges to the right of it."""
        edges = list(zip(polygon, polygon[1:] + polygon[:1]))
        return [[sum((a[1] > y + 0.5) != (b[1] > y + 0.5) and
                     x + 0.5 < a[0] + (y + 0.5 - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) for a, b in edges) % 2
                 for x in range(width)] for y in range(height)]

    def test_imagefolder_and_csv(self):
        self.export("imagefolder")
        lines = [json.loads(line) for split in ("train", "test")
                 for line in (self.to / split / "metadata.jsonl").read_text().splitlines()]
        self.assertEqual({tuple(sorted(line)) for line in lines}, {tuple(sorted(lines[0]))})
        by_id = {line["id"]: line for line in lines}
        for record in self.records():
            line = by_id[record["id"]]
            self.assertEqual((line["label"], line["class_path"], line["bbox"]),
                             (CLASSES.index(record["class_path"]), record["class_path"], self.box(self.mask(record))))
            self.assertEqual(line["intrinsics"], record["intrinsics"])
            for kind, field in (("image", "file_name"), ("mask", "mask_file_name")):
                source = next(f["path"] for f in record["files"] if f["kind"] == kind)
                self.assertEqual((self.to / line["split"] / line[field]).read_bytes(),
                                 (self.out / source).read_bytes())
        # Every float is written as one: readers take the type from the first line.
        self.assertNotRegex((self.to / "train/metadata.jsonl").read_text(), r'"camera_to_world":\[\[-?\d+,')
        self.export("csv")
        with open(self.to / "images.csv", newline="") as file:
            table = list(csv.DictReader(file))
        self.assertEqual(len(table), IMAGES)
        for row in table:
            self.assertEqual(json.loads(row["camera_to_world"]), by_id[row["id"]]["camera_to_world"])
            self.assertTrue((self.to / row["image_file"]).is_file())
            self.assertTrue((self.to / row["mask_file"]).is_file())

    def test_webdataset(self):
        self.export("webdataset")
        self.assertEqual(sorted(p.name for p in self.to.glob("*.tar")),
                         ["tiny-test-000000.tar", "tiny-train-000000.tar"])
        samples = {}
        for path in self.to.glob("*.tar"):
            with tarfile.open(path) as tar:
                keys = []
                for member in tar:
                    self.assertEqual((member.mtime, member.uid, member.gid, member.mode), (0, 0, 0, 0o644))
                    key, ending = member.name.split(".", 1)
                    if not keys or keys[-1] != key:
                        keys.append(key)
                    samples.setdefault(key, {})[ending] = tar.extractfile(member).read()
                self.assertEqual(len(keys), len(set(keys)), "a sample's members follow each other")
        self.assertEqual({tuple(sorted(s)) for s in samples.values()}, {("cls", "json", "mask.png", "png")})
        for record in self.records():
            sample = samples[self.key(record)]
            self.assertEqual((CLASSES[int(sample["cls"])], json.loads(sample["json"])["id"]), (record["class_path"], record["id"]))
            source = next(f["path"] for f in record["files"] if f["kind"] == "image")
            self.assertEqual(sample["png"], (self.out / source).read_bytes())

    def test_what_the_recipe_says_of_the_dataset_goes_out_with_it(self):
        about = {"description": "Two solids.", "creator": "A. Maker", "url": "https://example.org/solids",
                 "published": "2026-11-27", "version": "2.1.0", "cite": "A. Maker: Solids. 2026."}
        more = [word for name, text in about.items() for word in ("--set", f"dataset.{name}={json.dumps(text)}")]
        self.assert_counts(self.build(*more), traced=0)
        dataset = json.loads((self.out / "manifest/dataset.json").read_text())
        self.assertEqual(dataset["about"], about)
        self.export("croissant")
        croissant = json.loads((self.to / "croissant.json").read_text())
        for name, field in (("description", "description"), ("url", "url"), ("published", "datePublished"),
                            ("version", "version"), ("cite", "citeAs")):
            self.assertEqual(croissant[field], about[name])
        self.assertEqual((croissant["creator"]["name"], croissant["license"]),
                         ("A. Maker", "https://spdx.org/licenses/CC0-1.0.html"))
        card = (self.to / "README.md").read_text()
        self.assertIn("Two solids.\n\nby A. Maker, version 2.1.0, published 2026-11-27, at https://example.org/solids.", card)
        self.assertIn("## How to cite\n\n```\nA. Maker: Solids. 2026.\n```", card)
        run = self.run_it("plan", self.recipe, "--set", "dataset.published=yesterday")
        self.assertEqual(run.code, 2)
        self.assertIn("must be a day as 2026-11-27, got", run.err)

    def test_a_recipe_may_refuse_what_has_no_licence(self):
        strict = ["--set", "dataset.unlicensed=error"]
        run = self.run_it("plan", self.recipe, "-o", self.out, *strict)
        self.assertEqual(run.code, 2, run)
        self.assertIn("found none for models/box.off, models/tetra.ply, materials/green.mat and 3 more", run.err)
        for folder in ("models", "materials", "environments"):
            (self.tiny / folder / "LICENSE").write_text("SPDX-License-Identifier: MIT\n")
        # What holds no words is no licence.
        for nothing in (b"", b" \n\t\n", b"-----\n", b"\x00\x01MZ\x00"):
            (self.tiny / "models/LICENSE").write_bytes(nothing)
            run = self.run_it("plan", self.recipe, "-o", self.out, *strict)
            self.assertEqual(run.code, 2, (nothing, run))
            self.assertIn("found none for models/box.off, models/tetra.ply: put", run.err)
            self.assertIn("models/LICENSE: holds no words, which is no licence", run.err)
        (self.tiny / "models/LICENSE").write_text("SPDX-License-Identifier: MIT\n")
        self.assert_counts(self.build(*strict), traced=0)

    def test_sources_go_along_and_may_be_wanted(self):
        strict = ["--set", "dataset.unsourced=error"]
        run = self.run_it("plan", self.recipe, "-o", self.out, *strict)
        self.assertEqual(run.code, 2, run)
        self.assertIn('dataset.unsourced = "error" wants a source beside every asset, found none for models/box.off, '
                      "models/tetra.ply, materials/green.mat and 3 more: put a SOURCE file", run.err)
        (self.tiny / "models/SOURCE.txt").write_text("")
        self.assertIn("found none for models/box.off", self.run_it("plan", self.recipe, "-o", self.out, *strict).err)
        (self.tiny / "models/SOURCE.txt").write_text("Solids of Plato, https://example.org/solids.\nFound 2026.\n")
        self.assertIn("found none for materials/green.mat", self.run_it("plan", self.recipe, "-o", self.out, *strict).err)
        self.build()
        self.assertIn("sources", [finding["check"] for finding in self.run_it("check", self.out, "--json").json["findings"]])
        (self.tiny / "SOURCE").write_text("by hand\n")
        run = self.run_it("build", "-n", self.recipe, "-o", self.out)
        self.assertIn("sources: environments/floor, environments/plain, materials/green.mat, materials/red.mat", run.out + run.err)
        self.assert_counts(self.build(*strict), built=0, reused=IMAGES)
        told = json.loads((self.out / "manifest/dataset.json").read_text())["sources"]
        models = {"url": "https://example.org/solids", "assets": ["models/box.off", "models/tetra.ply"],
                  "text": "Solids of Plato, https://example.org/solids.\nFound 2026.\n"}
        self.assertIn(models, told)
        self.assertEqual([(one["url"], len(one["assets"])) for one in told if one != models], [(None, 4)])
        self.assertNotIn("sources", [f["check"] for f in self.run_it("check", self.out, "--json").json["findings"]])
        self.export("croissant")
        self.assertIn("- models/box.off, models/tetra.ply: Solids of Plato, https://example.org/solids.\n",
                      (self.to / "README.md").read_text())
        based = json.loads((self.to / "croissant.json").read_text())["isBasedOn"]
        self.assertIn("https://example.org/solids", [one.get("url") for one in based])

    def test_nerf(self):
        """A point of the world lands on one pixel by the manifest's pose and by the scene's."""
        told = self.export("nerf")
        frames = {}
        for path in self.to.rglob("transforms.json"):
            scene = json.loads(path.read_text())
            listed = [name for split in ("train", "val", "test") for name in scene.get(split + "_filenames", [])]
            self.assertFalse([name for name in scene if name.endswith("_filenames")])
            for frame in scene["frames"]:
                self.assertTrue((path.parent / frame["file_path"]).is_file())
                self.assertTrue((path.parent / frame["mask_path"]).is_file())
                frames[os.path.basename(frame["file_path"])[:-4]] = (scene, frame)
        self.assertEqual(len(frames), IMAGES)
        for record in self.records():
            scene, frame = frames[self.key(record)]
            point = (0.01, -0.02, 0.03)

            def camera(pose):
                way = [point[i] - pose[i][3] for i in range(3)]
                return [sum(pose[i][axis] * way[i] for i in range(3)) for axis in range(3)]

            x, y, z = camera(record["camera_to_world"])
            gx, gy, gz = camera(frame["transform_matrix"])
            k = record["intrinsics"]
            self.assertAlmostEqual(k[0][0] * x / z + k[0][2], scene["fl_x"] * gx / -gz + scene["cx"], 9)
            self.assertAlmostEqual(k[1][1] * y / z + k[1][2], scene["fl_y"] * -gy / -gz + scene["cy"], 9)
        scales = {}
        for record in self.records():
            scales.setdefault((record["model"], record["material"], record["environment"]), []).append(record["tone_map_scale"])
        single = any(len(of) < 2 for of in scales.values())
        unlike = sum(len(set(of)) > 1 for of in scales.values())  # autolinear has a factor for each picture
        self.assertEqual(told["notes"], ["scenes of a single view teach no depth: materials.per and environments.per = \"model\" "
                                         "keep a model's views together"] * single +
                         [f"{unlike} of {len(scales)} scenes are not one still scene, since their frames differ in exposure"])
        self.assertGreater(unlike, 0)

    def test_splits_and_filters(self):
        told = self.export("csv", "--split", "test")
        self.assertEqual((told["images"], told["left_out"]), (IMAGES // 2, {"split": IMAGES // 2}))
        told = self.export("csv", "--filter", "model=b*", "--filter", "view=0", "--filter", "view=2")
        self.assertEqual((told["images"], told["left_out"]), (2, {"filter": 6}))
        for arguments, message in ((["--split", "val"], "--split: wanted test or train, got val"),
                                   (["--filter", "clas=x"], "did you mean class?"),
                                   (["--filter", "model"], "wanted KEY=PATTERN"),
                                   (["--filter", "model=none"], "no image to export (left out: 8 by filter)")):
            run = self.run_it("export", self.out, "--format", "csv", "-o", self.folder / "other", *arguments)
            self.assertEqual(run.code, 2, run)
            self.assertIn(message, run.err)
        run = self.run_it("export", self.out, "--format", "cocco", "-o", self.folder / "other")
        self.assertIn("did you mean coco?", run.err)
        self.assertFalse((self.folder / "other").exists())

    def test_what_is_in_the_way_and_what_is_missing(self):
        self.to.mkdir()
        (self.to / "mine").write_text("mine")
        run = self.run_it("export", self.out, "--format", "csv", "-o", self.to)
        self.assertEqual(run.code, 2, run)
        self.assertEqual((self.to / "mine").read_text(), "mine")
        shutil.rmtree(self.to)
        # What somebody put into an export stays, and so does a link; a dataset takes no export in.
        real = self.folder / "real"
        self.to.symlink_to(real)
        real.mkdir()
        self.export("csv")
        self.assertTrue(self.to.is_symlink())
        self.export("yolo")
        (real / "mine").write_text("mine")
        run = self.run_it("export", self.out, "--format", "csv", "-o", self.to)
        self.assertEqual(run.code, 2, run)
        self.assertIn("holds mine, which no export put there", run.err)
        self.assertEqual(self.run_it("verify", real).code, 1)
        (real / "mine").unlink()
        self.assertIn("files: all as the export's checksums say", self.run_it("verify", real).out)
        self.to.unlink()
        for inside in (self.out / "export", self.out, self.folder):
            run = self.run_it("export", self.out, "--format", "csv", "-o", inside)
            self.assertEqual(run.code, 2, run)
        for missing, said in (["--format", "csv"], "wanted --output"), (["-o", self.to], "wanted --format"):
            run = self.run_it("export", self.out, *missing)
            self.assertEqual((run.code, said in run.err), (2, True), run)
        # A missing or damaged picture ends it, and names the file.
        picture = self.out / "images/box.off/1.png"
        whole = picture.read_bytes()
        picture.unlink()
        run = self.run_it("export", self.out, "--format", "imagefolder", "-o", self.to)
        self.assertIn("images/box.off/1.png: is missing; dsbuild build makes it again", run.err)
        picture.write_bytes(whole[:-20])
        run = self.run_it("export", self.out, "--format", "imagefolder", "-o", self.to)
        self.assertEqual(run.code, 1, run)
        self.assertIn("images/box.off/1.png: is not what the manifest says", run.err)
        self.assertFalse(self.to.exists())
        self.build("--set", "outputs.mask=false")
        run = self.run_it("export", self.out, "--format", "coco", "-o", self.to)
        self.assertIn('coco needs image, mask of every image, and the dataset has image; build it with '
                      'outputs.mask = true', run.err)
        # All that is lacking at once, by keys that there are.
        run = self.run_it("export", self.out, "--format", "bop", "-o", self.to)
        self.assertIn('bop needs image, mask, amodal_mask, depth of every image, and the dataset has image; build it with '
                      'outputs.mask = true, "amodal_mask", "depth" in outputs.planes', run.err)
        self.assertEqual([p.name for p in self.folder.iterdir() if p.name.startswith(".")], [])

    def test_a_dataset_that_is_behind_is_said_to_be(self):
        self.edit("materials/red.mat", "kd = 0.7 0.1 0.1", "kd = 0.6 0.1 0.1")
        run = self.run_it("export", self.recipe, "--format", "csv", "-o", self.to)
        self.assertEqual(run.code, 2, run)  # its dataset would be out/tiny
        run = self.run_it("export", self.out, "--format", "csv", "-o", self.to)
        self.assertEqual(run.code, 0, run)
        self.assertIn("of 8 images are not as their recipe wants them", run.err)
        self.assertIn("of 8 images are not as their recipe wants them", (self.to / "README.md").read_text())

    def test_the_card_calls_its_settings_a_record(self):
        self.export("csv")
        card = (self.to / "README.md").read_text()
        self.assertIn("a record to compare with, no recipe that can be built", " ".join(card.split()))
        # As it is: names without folders, classes by themselves.
        settings = card.split("```")[-2]
        self.assertIn('models.files = ["box.off", "tetra.ply"]', settings)
        (self.folder / "card.toml").write_text(settings)
        self.assertEqual(self.run_it("plan", self.folder / "card.toml").code, 2)

    def test_a_dataset_that_is_not_finished(self):
        half = self.folder / "half"
        self.build("--shard", "1/2", out=half)
        listed = len((half / "manifest/images.jsonl").read_text().splitlines())
        self.assertTrue(0 < listed < IMAGES)
        run = self.run_it("export", half, "--format", "csv", "-o", self.to)
        self.assertEqual((run.code, self.to.exists()), (1, False), run)
        self.assertIn(f"{IMAGES - listed} of {IMAGES} images are not made; dsbuild build makes them, and --partial", run.err)
        run = self.run_it("export", half, "--format", "csv", "-o", self.to, "--partial", "--json")
        self.assertEqual((run.code, run.json["images"]), (0, listed), run)
        self.assertIn("images are not as their recipe wants them", run.err)
        # What is handed on without its recipe is what it is.
        shutil.rmtree(self.to)
        shutil.rmtree(half / ".dsbuild")
        self.assertEqual(self.run_it("export", half, "--format", "csv", "-o", self.to).code, 0)

    def test_an_export_of_another_format_is_replaced_and_said_to_be(self):
        for format, said in (("csv", False), ("csv", False), ("coco", True)):
            run = self.run_it("export", self.out, "--format", format, "-o", self.to)
            self.assertEqual((run.code, "the export as csv that stood there is replaced" in run.err), (0, said), run)

    def test_names_that_are_one_without_their_endings(self):
        shutil.copy(self.tiny / "models/box.off", self.tiny / "models/tetra.off")
        (self.tiny / "test.cla").write_text("PSB 1\n2 2\nsolid 0 0\nspike solid 2\ntetra.ply\ntetra.off\n")
        self.build()
        self.export("csv")
        names = {path.name for path in (self.to / "images").iterdir()}
        self.assertLessEqual({"box-0.png", "tetra_ply-0.png", "tetra_off-0.png"}, names)
        # With its ending tetra.ply is tetra_ply, and so is tetra_ply.off without: both get a hash of their own.
        shutil.copy(self.tiny / "models/box.off", self.tiny / "models/tetra_ply.off")
        self.build("--set", "classes.unlisted=keep")
        self.export("csv")
        names = sorted(path.name for path in (self.to / "images").iterdir())
        self.assertEqual(len(names), 2 * IMAGES)
        self.assertEqual(len([name for name in names if name.startswith("tetra_ply_")]), IMAGES)

    def test_a_manifest_that_was_edited_is_not_handed_on(self):
        manifest = self.out / "manifest/images.jsonl"
        whole = manifest.read_text()
        secret = self.folder / "secret.png"
        secret.write_bytes((self.out / "images/box.off/0.png").read_bytes())
        for before, after in (("solid/box", "solid/ox"), ('"split":"train"', '"split":"x/../../../../gone"'),
                              ("images/box.off/0.png", "../secret.png"), ("images/box.off/0.png", str(secret))):
            edited = whole.replace(before, after)
            self.assertNotEqual(edited, whole)
            manifest.write_text(edited)
            run = self.run_it("export", self.out, "--format", "coco", "-o", self.to)
            self.assertEqual(run.code, 1, run)
            self.assertIn("images.jsonl: is not what manifest/checksums.xxh128 says", run.err)
            # And where the checksums were edited with it.
            sums = self.out / "manifest/checksums.xxh128"
            kept = sums.read_text()
            digest = subprocess.run(["xxhsum", "-H128", manifest], capture_output=True, text=True, check=True).stdout
            sums.write_text("".join(f"{digest.split()[0]}  manifest/images.jsonl\n" if "images.jsonl" in line
                                    else line + "\n" for line in kept.splitlines()))
            if before != "solid/box":
                for format in FORMATS:
                    run = self.run_it("export", self.out, "--format", format, "-o", self.to)
                    self.assertEqual(run.code, 1, run)
            sums.write_text(kept)
        manifest.write_text(whole)
        self.assertEqual({path.name for path in self.folder.iterdir()}, {"tiny", "out", "secret.png"})
        # What is no regular file is not waited for.
        picture = self.out / "images/box.off/0.png"
        picture.unlink()
        os.mkfifo(picture)
        run = self.run_it("export", self.out, "--format", "csv", "-o", self.to)
        self.assertIn("0.png: is no regular file", run.err)
        run = self.run_it("export", self.out, "--format", "csv", "-o", self.folder / ("x" * 256))
        self.assertEqual(run.code, 1, run)
        self.assertEqual({path.name for path in self.folder.iterdir()}, {"tiny", "out", "secret.png"})

    def test_images_without_a_class(self):
        (self.tiny / "test.cla").write_text("PSB 1\n1 0\nspike 0 0\n")
        self.build()
        self.assertEqual(self.export("webdataset")["left_out"], {"unclassified": IMAGES // 2})
        self.assertIn("4 images are left out: they have no class or split", (self.to / "README.md").read_text())
        self.assertEqual((self.export("csv")["images"], self.export("nerf")["images"]), (IMAGES, IMAGES))

    def test_the_card_claims_no_licence_that_nobody_gave(self):
        self.build()
        shutil.copy(self.source / "LICENSE", self.tiny / "materials/LICENSE")
        self.build("--set", 'dataset.licence=""')
        self.export("csv")
        card = (self.to / "README.md").read_text()
        self.assertIn("license: other\nlicense_name: \"not stated\"\nlicense_link: LICENSES\n", card)
        self.assertIn("no licence stands beside these: environments/floor, environments/plain, models/box.off, "
                      "models/tetra.ply", card)
        self.build("--set", "dataset.licence=CC-BY-4.0")
        self.export("csv")
        self.assertIn("license: cc-by-4.0\n", (self.to / "README.md").read_text())

    def test_planes_that_have_no_place(self):
        self.build("--set", 'outputs.planes=["depth"]')
        self.assertEqual(self.export("coco")["notes"], ["depth: left out, the format coco has no place for it"])
        self.assertEqual(self.export("csv")["notes"], [])
        self.assertIn("- `depth` (exr): ", (self.to / "README.md").read_text())

    def test_a_camera_of_parallel_rays(self):
        self.edit("recipe.toml", "fov_deg = 49", 'type = "orthographic"\nextent_m = 0.25')
        self.build()
        self.export("imagefolder", "--split", "train")
        records = {record["id"]: record for record in self.records()}
        lines = (self.to / "train/metadata.jsonl").read_text().splitlines()
        self.assertEqual(len(lines), IMAGES // 2)
        for line in map(json.loads, lines):
            self.assertEqual((line["camera_model"], line["intrinsics"], line["metres_per_pixel"]),
                             ("orthographic", None, 0.25 / 32))
            self.assertEqual(line["camera_to_world"], records[line["id"]]["camera_to_world"])
        for format in FORMATS:
            if format != "nerf":
                self.export(format)
        run = self.run_it("export", self.out, "--format", "nerf", "-o", self.folder / "other")
        self.assertNotEqual(run.code, 0, run)
        self.assertIn("nerf has no camera of parallel rays, got one that is orthographic", run.err)
        self.assertFalse((self.folder / "other").exists())

    def test_killed_at_any_moment(self):
        self.export("coco")
        before = self.contents(self.to)
        for delay in (0.02, 0.05, 0.1, 0.2):
            process = self.start("export", self.out, "--format", "imagefolder", "-o", self.to)
            time.sleep(delay)
            process.send_signal(signal.SIGKILL)
            process.communicate()
            files = self.contents(self.to)
            if "annotations/instances_test.json" in files:
                self.assertEqual(files, before)
            self.assertEqual(self.run_it("verify", self.to).code, 0)
        self.export("coco")
        self.assertEqual(self.contents(self.to), before)
        self.assertEqual([p.name for p in self.folder.iterdir() if p.name.startswith(".")], [])


if __name__ == "__main__":
    main()
