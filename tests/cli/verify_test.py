# SPDX-License-Identifier: Apache-2.0
"""`dsbuild verify`: what it finds, and what it calls it."""
import os
import shutil

from harness import IMAGES, TinyCase, main


class VerifyTest(TinyCase):
    def setUp(self):
        super().setUp()
        self.build()

    def findings(self, *arguments, target=None):
        run = self.run_it("verify", target or self.out, "--json", *arguments)
        found = [(finding["kind"], finding["path"]) for finding in run.json["findings"]]
        self.assertEqual(run.code, 1 if found else 0, run)
        return found

    def replace(self, path, data):
        path.unlink()
        path.write_bytes(data)

    def test_a_damaged_manifest_hides_no_damaged_picture(self):
        self.build()
        picture = self.out / "images/box.off/0.png"
        os.chmod(picture.parent, 0o755)
        picture.unlink()
        picture.write_bytes(b"no picture")
        manifest = self.out / "manifest/images.jsonl"
        for text in manifest.read_text() + "{\n", manifest.read_text()[:100]:
            manifest.unlink()
            manifest.write_text(text)
            run = self.run_it("verify", self.out, "--json")
            self.assertEqual(run.code, 1, run)
            found = {finding["path"]: finding["kind"] for finding in run.json["findings"]}
            self.assertEqual(found, {"manifest/images.jsonl": "manifest", "images/box.off/0.png": "changed"})
            self.assertIn("cannot be read", run.json["not_checked"])
        self.build()
        self.assertEqual(self.run_it("verify", self.out).code, 0)

    def test_a_whole_dataset(self):
        self.assertEqual(self.findings(), [])
        self.assertEqual(self.run_it("verify", self.recipe, "-o", self.out).code, 0)

    def test_missing_extra_changed_encoding(self):
        images = self.out / "images/box.off"
        (images / "0.png").unlink()
        (images / "note.txt").write_text("mine")
        self.replace(images / "1.png", (images / "2.png").read_bytes())
        self.replace(images / "3.png", (images / "3.png").read_bytes() + b"x")
        self.assertEqual(sorted(self.findings()),
                         [("changed", "images/box.off/1.png"), ("encoding", "images/box.off/3.png"),
                          ("extra", "images/box.off/note.txt"), ("missing", "images/box.off/0.png")])
        text = self.run_it("verify", self.out)
        self.assertIn("changed: images/box.off/1.png: the pixels differ", text.out)
        self.assertIn("encoding: images/box.off/3.png: the pixels are the same", text.out)

    def test_findings_of_one_cause_share_a_line(self):
        for view in range(4):
            (self.out / f"images/box.off/{view}.png").unlink()
            self.replace(self.out / f"images/tetra.ply/{view}.png", b"no picture")
        run = self.run_it("verify", self.out)
        self.assertIn("missing: images/box.off/0.png and 3 more: the file is missing\n", run.out)
        self.assertIn("changed: images/tetra.ply/0.png and 3 more: it is no readable image\n", run.out)
        self.assertEqual(len(run.out.splitlines()), 3, run)
        self.assertIn(": 8 differences", run.out)
        all_lines = self.run_it("verify", self.out, "-v").out
        self.assertEqual(len(all_lines.splitlines()), 9, all_lines)
        self.assertIn("changed: images/tetra.ply/2.png: it is no readable image; wanted ", all_lines)
        # One for all images of another recipe, too.
        self.edit("materials/red.mat", "kd = 0.7 0.1 0.1", "kd = 0.6 0.1 0.1")
        self.build("--set", "outputs.mask=true")
        self.edit("materials/red.mat", "kd = 0.6 0.1 0.1", "kd = 0.5 0.1 0.1")
        run = self.run_it("verify", self.out)
        self.assertRegex(run.out, r"manifest: box\.off/\d and 3 more: it is of an older recipe or older assets: ")

    def test_one_flipped_bit(self):
        for path in sorted(self.out.rglob("*.png"))[:4]:
            data = bytearray(path.read_bytes())
            data[len(data) // 2] ^= 1
            self.replace(path, bytes(data))
            self.assertEqual([path_ for _, path_ in self.findings()], [path.relative_to(self.out).as_posix()])
            path.unlink()
            self.build()
        self.assertEqual(self.findings(), [])

    def test_a_copy_without_its_database(self):
        copy = self.folder / "copy"
        shutil.copytree(self.out, copy, ignore=shutil.ignore_patterns(".dsbuild"))
        self.assertEqual(self.findings(target=copy), [])
        os.remove(copy / "images/box.off/0.png")
        self.assertEqual(self.findings(target=copy), [("missing", "images/box.off/0.png")])

    def test_a_stale_dataset(self):
        self.edit("materials/red.mat", "kd = 0.7 0.1 0.1", "kd = 0.6 0.1 0.1")
        self.assertEqual({kind for kind, _ in self.findings()}, {"manifest"})

    def test_rerender_traces_the_chosen_again(self):
        run = self.run_it("verify", self.out, "--rerender", 3, "--json")
        self.assertEqual(run.code, 0, run)
        self.assertEqual(run.json["rerendered"], 3)
        self.assertEqual(run.err.count("tracing "), 3)
        again = self.run_it("verify", self.out, "--rerender", 3, "--json")
        self.assertEqual(again.err, run.err, "the same images each time")
        everything = self.run_it("verify", self.out, "--rerender", 1000, "--seed", 5, "--json")
        self.assertEqual(everything.json["rerendered"], IMAGES)

    def test_rerender_sees_a_picture_that_the_tracer_does_not_make(self):
        # A forger who changes picture, manifest and checksums alike is found by tracing only.
        images = self.out / "images/box.off"
        manifest = self.out / "manifest/images.jsonl"
        before = self.run_it("verify", self.out, "--rerender", IMAGES, "--json").json
        self.assertEqual(before["differences"], 0)
        lines = manifest.read_text().splitlines(keepends=True)
        one, two = ([line for line in lines if f'"id":"box.off/{view}"' in line][0] for view in (0, 1))
        swapped = (images / "1.png").read_bytes()
        field = '"path":"images/box.off/{}.png",'
        start, end = one.index(field.format(0)), one.index("}", one.index(field.format(0)))
        other_start = two.index(field.format(1)) + len(field.format(1))
        forged = one[:start] + field.format(0) + two[other_start:two.index("}", other_start)] + one[end:]
        manifest.write_text("".join(forged if line == one else line for line in lines))
        self.replace(images / "0.png", swapped)
        self.assertIn(("rerender", "images/box.off/0.png"), self.findings("--rerender", IMAGES))


if __name__ == "__main__":
    main()
