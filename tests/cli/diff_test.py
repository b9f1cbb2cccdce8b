# SPDX-License-Identifier: Apache-2.0
"""dsbuild diff: two datasets, or two image files."""
import collections
import json
import os
import subprocess
import sys

import image_reader
from harness import IMAGES, TinyCase, main

Picture = collections.namedtuple("Picture", "width height channels bits values")


def read(path):
    return Picture(*image_reader.read_png(path))


class DiffTest(TinyCase):
    def diff(self, a, b, *more, code):
        run = self.run_it("diff", a, b, *more)
        self.assertEqual(run.code, code, run)
        return run

    def test_datasets(self):
        self.build()
        other = self.folder / "other"
        self.build("--set", "engine.spp=2", "--set", f'models.files=["{self.tiny}/models/box.off"]', out=other)
        run = self.diff(self.out, self.out, code=0)
        self.assertEqual(run.out, f"{IMAGES} images are the same, 0 differ, 0 are in A alone, 0 in B alone\n")
        # A recipe stands for its folder.
        self.diff(self.recipe, self.folder / "out/tiny", code=2)

        run = self.diff(self.out, other, "--json", "-o", self.folder / "shown", code=1)
        found = run.json
        self.assertEqual(found["only_a"], [f"tetra.ply/{view}" for view in range(4)])
        self.assertEqual(found["only_b"], [])
        self.assertEqual(len(found["changed"]) + found["same"], 4)
        self.assertIn("recipe", found["dataset_fields"])
        self.assertEqual(json.loads((self.folder / "shown/.dsbuild-diff/diff.json").read_text()), found)
        for own in ("images", "manifest", ".dsbuild"):
            run = self.diff(self.out, other, "-o", other / own / "shown", code=2)
            self.assertIn(f"outside the dataset's own {own}", run.err)
        shown = 0
        for image in found["changed"]:
            self.assertIn("engine", image["parts"])
            for file in image["files"]:
                self.assertEqual(file["kind"], "image", "more samples move no mask")
                a, b, picture = (read(folder / file["path"])
                                 for folder in (self.out, other, self.folder / "shown"))
                self.check(file, a, b, picture)
                shown += 1
        self.assertGreater(shown, 0)
        text = self.diff(self.out, other, code=1).out
        self.assertIn("in A alone: 4: tetra.ply/0, tetra.ply/1, tetra.ply/2, tetra.ply/3\n", text)
        self.assertRegex(text, r"differ in .*engine.*: \d: ")
        self.assertRegex(text, r"  image: \d files, the worst: images/\S+\.png: \d+ of 1024 pixels, largest \S+ at \d+, \d+, RMS ")

    def most_memory(self, a, b):
        """In bytes, of a diff that finds nothing."""
        # A sanitizer would keep what is freed.
        environment = {**os.environ, "ASAN_OPTIONS": os.environ.get("ASAN_OPTIONS", "") + ":quarantine_size_mb=1"}
        # What is forked has its parent's memory for a moment, which is to be little.
        small = ("import os, sys\n"
                 "_, status, usage = os.wait4(os.posix_spawn(sys.argv[1], sys.argv[1:], os.environ), 0)\n"
                 "print(os.waitstatus_to_exitcode(status), usage.ru_maxrss)")
        run = subprocess.run([sys.executable, "-c", small, *self.command("diff", a, b)], cwd=self.folder, env=environment,
                             capture_output=True, text=True, check=True)
        code, kilobytes = map(int, run.stdout.splitlines()[-1].split())
        self.assertEqual(code, 0, run)
        return kilobytes * 1024

    def test_lines_that_are_the_same_are_not_kept(self):
        self.build()
        manifest = self.out / "manifest/images.jsonl"
        lines, large = manifest.read_text().splitlines(), []
        for name in range(1500):
            for view, line in enumerate(lines):
                large.append(line.replace(json.loads(line)["id"], f"m{name:05}.off/{view}"))
        datasets = [self.folder / name for name in ("few", "few-too", "many", "many-too")]
        for folder, text in zip(datasets, [lines, lines, large, large]):
            (folder / "manifest").mkdir(parents=True)
            (folder / "manifest/images.jsonl").write_text("\n".join(text) + "\n")
            (folder / "manifest/dataset.json").write_bytes((self.out / "manifest/dataset.json").read_bytes())
        size = (datasets[2] / "manifest/images.jsonl").stat().st_size
        self.assertGreater(size, 24e6)
        self.assertLess(self.most_memory(*datasets[2:]), self.most_memory(*datasets[:2]) + size / 4)
        self.assertIn(f"{len(large)} images are the same, 0 differ", self.diff(*datasets[2:], code=0).out)

    def test_a_material_of_another_program_is_no_engine_and_no_model(self):
        self.build()
        # The path tracer of glass is another program; colours of a mesh count where its material reads them.
        material = self.tiny / "materials/red.mat"
        for number, text in enumerate(("scene.materials.red.type = glass\n",
                                       "scene.textures.t.type = hitpointcolor\nscene.materials.red.type = matte\n"
                                       "scene.materials.red.kd = t\n")):
            material.write_text(text)
            other = self.folder / f"other-{number}"
            self.build(out=other)
            found = self.diff(self.out, other, "--json", code=1).json
            self.assertGreater(len(found["changed"]), 0)
            for image in found["changed"]:
                self.assertEqual(image["parts"], ["material"])
            self.assertIn(f"differ in material: {len(found['changed'])}: ", self.diff(self.out, other, code=1).out)
        deeper = self.folder / "deeper"
        self.build("--set", "engine.depth_total=5", out=deeper)
        for image in self.diff(self.out, deeper, "--json", code=1).json["changed"]:
            self.assertIn("engine", image["parts"])

    def test_what_is_not_there(self):
        self.build()
        (self.folder / "empty").mkdir()
        for a, b, wanted in ((self.out, "nowhere", "diff: wanted B, a recipe, the folder of a dataset or an image file, found nothing "
                              "at nowhere"),
                             ("no.png", "no.jpg", "diff: wanted A, a recipe, the folder of a dataset or an image file, found nothing "
                              "at no.png"),
                             (self.recipe, self.out, f"diff: wanted A, a dataset that is made, found the recipe {self.recipe}, of which "
                              f"nothing is built in {self.folder}/out/tiny (name its folder, or dsbuild build it)"),
                             ("empty", self.out, f"{self.folder}/empty: wanted the folder of a dataset, found one without "
                              "manifest/images.jsonl")):
            run = self.diff(a, b, code=2)
            self.assertEqual(run.err, f"dsbuild: error: {wanted}\n")

    def check(self, file, a, b, picture):
        """By hand, from PNG files that another reader decoded."""
        self.assertEqual((a.width, a.height, a.channels), (b.width, b.height, b.channels))
        pairs = list(zip(a.values, b.values))
        apart = [abs(x - y) for x, y in pairs]
        pixels = [apart[i:i + a.channels] for i in range(0, len(apart), a.channels)]
        self.assertEqual(file["of"], len(pixels))
        self.assertEqual(file["pixels"], sum(any(pixel) for pixel in pixels))
        self.assertAlmostEqual(file["largest"], max(apart) / 255, places=12)
        self.assertAlmostEqual(file["rms"], (sum(d * d for d in apart) / len(apart)) ** 0.5 / 255, places=12)
        self.assertEqual(max(pixels[file["y"] * a.width + file["x"]]), max(apart))
        for value, distance in zip(picture.values, apart):
            self.assertLessEqual(abs(value - 255 * distance / max(apart)), 1)
            self.assertEqual(value > 0, distance > 0)

    def test_files(self):
        self.build()
        images = self.out / "images/box.off"
        self.assertEqual(self.diff(images / "0.png", images / "0.png", code=0).out, "the same pixels\n")
        run = self.diff(images / "0.png", images / "1.png", "--json", "-o", self.folder / "shown", code=1)
        a, b, picture = (read(path) for path in
                         (images / "0.png", images / "1.png", self.folder / "shown/0.png"))
        self.check(run.json, a, b, picture)
        run = self.diff(images / "0.png", self.out, code=2)
        self.assertIn("wanted two datasets or two image files", run.err)
        run = self.diff(images / "0.png", self.tiny / "models/box.off", code=1)
        self.assertIn("box.off", run.err)
        # No folder of somebody else is written into.
        (self.folder / "mine").mkdir()
        (self.folder / "mine/notes.txt").write_text("mine")
        self.diff(images / "0.png", images / "1.png", "-o", self.folder / "mine", code=2)
        self.assertEqual((self.folder / "mine/notes.txt").read_text(), "mine")

    def test_an_edited_file_is_an_error(self):
        self.build()
        other = self.folder / "other"
        self.build("--set", "engine.spp=2", out=other)
        file = other / "images/box.off/0.png"
        data = file.read_bytes()
        file.unlink()
        file.write_bytes(data + b"x")
        run = self.diff(self.out, other, code=1)
        self.assertIn("images/box.off/0.png: is not what the manifest says", run.err)


if __name__ == "__main__":
    main()
