# SPDX-License-Identifier: Apache-2.0
"""dsbuild gallery: the folder whole or not at all, the same bytes each time, and only what is new made again."""
import json
import os
import shutil
import signal
import struct
import subprocess
import time

import image_reader
from harness import IMAGES, TinyCase, main

RECORD = ".dsbuild-gallery/made.txt"


def data_of(text, call):
    """What a data file hands to gallery.NAME: the arguments, as JSON."""
    assert text.startswith(f"gallery.{call}(") and text.endswith(");\n"), text[:80]
    return json.loads("[" + text[len(f"gallery.{call}("):-3] + "]")


def jpeg_size(data):
    """Width, height and components by the frame's header (ITU T.81, B.2.2), and the sampling of the first."""
    assert data[:2] == b"\xff\xd8" and data[-2:] == b"\xff\xd9"
    at = 2
    while True:
        marker, length = struct.unpack(">HH", data[at:at + 4])
        if 0xffc0 <= marker <= 0xffc2:
            height, width, components = struct.unpack(">HHB", data[at + 5:at + 10])
            return width, height, components, data[at + 11]
        at += 2 + length


class GalleryTest(TinyCase):
    def setUp(self):
        super().setUp()
        self.edit("recipe.toml", "[engine]", '[outputs]\nplanes = ["depth", "shading_normal", "amodal_mask"]\n\n[engine]')
        self.build()
        self.to = self.out / "gallery"

    def gallery(self, *arguments, target=None, code=0):
        run = self.run_it("gallery", target or self.out, "--json", *arguments)
        self.assertEqual(run.code, code, run)
        return run.json

    def meta(self, folder=None):
        return data_of(((folder or self.to) / "data/meta.js").read_text(), "meta")[0]

    def grid(self, folder=None):
        return data_of(((folder or self.to) / "data/grid-0.js").read_text(), "grid")[1]

    def lines(self, folder=None):
        return data_of(((folder or self.to) / "data/image-000.js").read_text(), "image")[1]

    def records(self):
        return [json.loads(line) for line in (self.out / "manifest/images.jsonl").read_text().splitlines()]

    def file_of(self, record, kind):
        return self.out / next(file["path"] for file in record["files"] if file["kind"] == kind)

    def test_what_it_holds(self):
        told = self.gallery()
        self.assertEqual((told["images"], told["broken"], told["notes"]), (IMAGES, 0, []))
        self.assertEqual(told["made"], 3 * IMAGES)  # thumbnails, depths, normals; browsers show masks as they are
        files = self.contents(self.to)
        self.assertEqual(told["files"], len(files) - 1)
        for i in range(IMAGES):
            for path, components in ((f"t/00/0000{i}.jpg", 3), (f"p/00/0000{i}.depth.jpg", 1), (f"p/00/0000{i}.shading_normal.jpg", 3)):
                data = (self.to / path).read_bytes()
                self.assertEqual(jpeg_size(data)[:3], (32, 32, components), path)
                if components == 3:
                    self.assertEqual(jpeg_size(data)[3], 0x22, "4:2:0")
        meta, grid, lines = self.meta(), self.grid(), self.lines()
        self.assertEqual((meta["n"], meta["name"], meta["root"], meta["chunk"], meta["image_chunk"]), (IMAGES, "tiny", "..", 5000, 100))
        columns = {column["key"]: column for column in meta["columns"]}
        records = self.records()
        self.assertEqual(grid["id"], [record["id"] for record in records])
        for key in ("model", "material", "environment", "view"):
            self.assertEqual([columns[key]["values"][v] for v in grid[key]], [record[key] for record in records])
        for i, (record, line) in enumerate(zip(records, lines)):
            self.assertEqual(line["id"], record["id"])
            self.assertEqual(line["camera_to_world"], record["camera_to_world"])
            self.assertEqual({file["kind"]: file["xxh128"] for file in line["files"]},
                             {file["kind"]: file["xxh128"] for file in record["files"]})
            self.assertNotIn("parts", line)
            width, height, _, _, samples = image_reader.read_png(self.file_of(record, "mask"))
            inside = [(k % width, k // width) for k, v in enumerate(samples) if v]
            left, top = min(x for x, _ in inside), min(y for _, y in inside)
            box = [left, top, max(x for x, _ in inside) - left + 1, max(y for _, y in inside) - top + 1]
            self.assertEqual((line["box"], grid["box"][4 * i:4 * i + 4]), (box, box))
            self.assertAlmostEqual(grid["area"][i], len(inside) / (width * height), 5)
            _, _, channels, _, samples = image_reader.read_png(self.file_of(record, "image"))
            self.assertEqual(channels, 3)
            luma = [(0.2126 * r + 0.7152 * g + 0.0722 * b) / 255
                    for r, g, b in zip(samples[::3], samples[1::3], samples[2::3])]
            mean = sum(luma) / len(luma)
            self.assertAlmostEqual(grid["brightness"][i], mean, 3)
            self.assertAlmostEqual(grid["contrast"][i], (sum((v - mean) ** 2 for v in luma) / len(luma)) ** 0.5, 3)

    def test_the_page_needs_nothing_else(self):
        self.gallery()
        page = (self.to / "index.html").read_text()
        for word in ("http://", "https://", "import ", "fetch(", "innerHTML", "eval("):
            self.assertNotIn(word, page.replace("http://www.w3.org/2000/svg", ""))
        self.assertIn("Content-Security-Policy", page)

    def test_the_same_bytes_and_only_what_is_new(self):
        self.gallery()
        before = self.contents(self.to)
        folder = self.to.stat().st_ino
        told = self.gallery()
        self.assertEqual((told["made"], told["reused"]), (0, 3 * IMAGES))
        self.assertEqual(told["files"], len(before) - 1)
        self.assertEqual(self.to.stat().st_ino, folder, "nothing was to be written, and nothing was")
        self.assertEqual(self.contents(self.to), before)
        # What a process killed after it put the gallery in its place left beside it goes all the same.
        left = self.out / ".dsbuild-gallery/1-0"
        (left / "gallery").mkdir(parents=True)
        left.with_suffix(".lock").touch()
        self.gallery()
        self.assertFalse(left.parent.exists())
        shutil.rmtree(self.to)
        self.assertEqual(self.gallery()["made"], 3 * IMAGES)
        self.assertEqual(self.contents(self.to), before)
        # One view less: the rest is taken over, under other numbers, and what is left over is gone.
        self.edit("recipe.toml", 'set = "orbit"', 'set = "orbit"\nviews = [1, 2, 3]')
        self.build()
        told = self.gallery()
        self.assertEqual((told["images"], told["made"], told["reused"]), (6, 0, 18))
        self.assertEqual(sorted(path.name for path in (self.to / "t/00").iterdir()), [f"0000{i}.jpg" for i in range(6)])
        fresh = self.folder / "fresh"
        shutil.copytree(self.out, fresh, ignore=shutil.ignore_patterns("gallery", ".dsbuild"))
        self.gallery(target=fresh)
        self.assertEqual(self.contents(fresh / "gallery"), self.contents(self.to))
        # A changed material: its pictures alone, no depth.
        self.edit("materials/red.mat", "0.7", "0.6")
        self.build()
        told = self.gallery()
        red = sum(record["material"] == "red" for record in self.records())
        self.assertGreater(red, 0)
        self.assertEqual((told["made"], told["reused"]), (red, 18 - red))

    def test_an_edited_thumbnail_is_made_again(self):
        self.gallery()
        before = self.contents(self.to)
        victim = self.to / "t/00/00003.jpg"
        os.chmod(victim, 0o644)
        victim.write_bytes(b"mine")
        self.assertEqual(self.run_it("verify", self.to).code, 1)
        told = self.gallery()
        self.assertEqual((told["made"], told["reused"]), (1, 3 * IMAGES - 1))
        self.assertEqual(self.contents(self.to), before)
        (self.to / RECORD).write_text("dsbuild gallery 0\n")
        self.assertEqual(self.gallery()["made"], 3 * IMAGES)

    def test_verify_takes_it_and_the_dataset_with_it(self):
        self.gallery()
        run = self.run_it("verify", self.to)
        self.assertEqual(run.code, 0, run)
        self.assertIn("all as the gallery's checksums say", run.out)
        run = self.run_it("verify", self.out)
        self.assertEqual(run.code, 0, run)
        run = self.run_it("build", self.recipe, "-o", self.out, "--json")
        self.assertEqual((run.code, run.json["traced"]), (0, 0), run)
        self.assertTrue((self.to / "index.html").is_file())

    def test_places(self):
        told = self.gallery("-o", "elsewhere/deep")
        self.assertEqual(self.meta(self.folder / "elsewhere/deep")["root"], "../../out")
        self.assertEqual(told["page"], "elsewhere/deep/index.html")
        for to in (self.out / "images/gallery", self.out / "manifest", self.out / ".dsbuild/g", self.out, self.folder):
            run = self.run_it("gallery", self.out, "-o", to)
            self.assertEqual(run.code, 2, run)
        (self.folder / "mine").mkdir()
        (self.folder / "mine/notes.txt").write_text("mine")
        self.assertEqual(self.run_it("gallery", self.out, "-o", "mine").code, 2)
        (self.folder / "elsewhere/deep/notes.txt").write_text("mine")
        run = self.run_it("gallery", self.out, "-o", "elsewhere/deep")
        self.assertEqual(run.code, 2, run)
        self.assertIn("notes.txt", run.err)
        run = self.run_it("gallery", self.tiny)
        self.assertEqual(run.code, 2, run)

    def test_a_folder_alone_and_one_that_may_only_be_read(self):
        alone = self.folder / "alone"
        shutil.copytree(self.out, alone, ignore=shutil.ignore_patterns(".dsbuild"))
        shutil.rmtree(self.tiny)
        self.assertEqual(self.gallery(target=alone)["images"], IMAGES)
        shutil.rmtree(alone / "gallery")
        for path in [alone, *alone.rglob("*")]:
            path.chmod(0o555 if path.is_dir() else 0o444)
        try:
            if os.access(alone, os.W_OK):  # root writes everywhere
                return
            run = self.run_it("gallery", alone)
            self.assertEqual(run.code, 2, run)
            self.assertIn("-o DIR", run.err)
            self.assertEqual(self.gallery("-o", "outside", target=alone)["images"], IMAGES)
        finally:
            for path in [alone, *alone.rglob("*")]:
                path.chmod(0o755 if path.is_dir() else 0o644)

    def test_files_that_are_not_the_manifests(self):
        records = self.records()
        self.file_of(records[0], "image").unlink()
        edited = self.file_of(records[1], "depth")
        data = edited.read_bytes()
        edited.unlink()
        edited.write_bytes(data[:-20])
        told = self.gallery()
        self.assertEqual(told["broken"], 2)
        self.assertIn(records[0]["id"], " ".join(told["notes"]))
        self.assertEqual(self.meta()["broken"], [0, 1])
        self.assertFalse((self.to / "t/00/00000.jpg").exists())
        self.build("--rehash")
        told = self.gallery()
        self.assertEqual((told["broken"], told["made"]), (0, 2))
        # A mask has no preview: the page shows the dataset's file, and nothing of the gallery changes but what it says.
        self.file_of(records[2], "mask").unlink()
        told = self.gallery()
        self.assertEqual((told["broken"], told["made"]), (1, 0))
        self.assertIn(records[2]["id"], " ".join(told["notes"]))
        self.assertEqual(self.meta()["broken"], [2])
        self.assertEqual(self.gallery()["broken"], 1)
        self.build("--rehash")
        self.assertEqual(self.gallery()["broken"], 0)

    def test_hostile_names(self):
        names = ["a b", "<img src=x onerror=alert(1)>", "quote\"and'", "Gr\u00fc\u00dfe \u65e5\u672c", "per%20cent#hash?q", "__proto__"]
        source = next((self.tiny / "models").iterdir())
        for name in names:
            shutil.copy(source, self.tiny / "models" / (name + source.suffix))
        self.build()
        self.gallery()
        self.assertEqual(set(self.grid()["id"]), {record["id"] for record in self.records()})
        models = next(column for column in self.meta()["columns"] if column["key"] == "model")["values"]
        self.assertEqual({name + source.suffix for name in names} - set(models), set())
        page = (self.to / "index.html").read_text()
        self.assertNotIn("onerror=alert", page)

    def test_killed_it_leaves_the_old_one_or_has_the_new(self):
        self.gallery()
        states = [self.contents(self.to)]
        self.edit("materials/red.mat", "0.7", "0.6")
        self.build()
        for delay in (0.02, 0.05, 0.1, 0.15, 0.2, 0.3):
            process = subprocess.Popen(self.command("gallery", self.out), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(delay)
            process.send_signal(signal.SIGKILL)
            process.wait()
            states.append(self.contents(self.to))
            self.assertEqual(self.run_it("verify", self.to).code, 0)
            self.assertEqual(self.run_it("verify", self.out).code, 0)
        self.gallery()
        states.append(self.contents(self.to))
        self.assertNotEqual(states[0], states[-1])
        for state in states:
            self.assertIn(state, (states[0], states[-1]))
        self.assertEqual([path.name for path in self.out.iterdir() if path.name.startswith(".dsbuild-")], [])


if __name__ == "__main__":
    main()
