# SPDX-License-Identifier: Apache-2.0
"""What is behind although no file looks newer: content under an unchanged stamp."""
import json
import os
import shutil

from harness import IMAGES, TinyCase, main


class StaleTest(TinyCase):
    def swap_keeping_times(self, path, change):
        """Another content of the same size in the same inode, with the old mtime, as `cp -p` leaves it."""
        before = path.stat()
        data = change(path.read_bytes())
        os.chmod(path, 0o644)
        with open(path, "r+b") as file:
            file.write(data)
        os.utime(path, ns=(before.st_atime_ns, before.st_mtime_ns))
        after = path.stat()
        self.assertEqual((after.st_size, after.st_mtime_ns, after.st_ino),
                         (before.st_size, before.st_mtime_ns, before.st_ino))

    def test_a_model_replaced_with_its_times_kept(self):
        os.utime(self.tiny / "models/box.off", (0, 0))  # as old as an archive may say
        self.build()
        self.swap_keeping_times(self.tiny / "models/box.off", lambda data: data.replace(b"-1 -1 -2", b"-1 -1 -3"))
        self.assertEqual(self.run_it("status", self.out, "--json").json["stale"], IMAGES // 2)
        self.assertEqual(self.run_it("verify", self.out).code, 1)
        self.assert_counts(self.build(), built=IMAGES // 2, reused=IMAGES // 2)
        self.assertEqual(self.run_it("verify", self.out).code, 0)

    def test_a_build_says_how_many_files_it_removes(self):
        self.build()
        files = set(self.contents(self.out / "images"))
        out = self.run_it("build", self.tiny / "recipe.toml", "-o", self.out, "--set", "camera.views=[0]").out
        gone = files - set(self.contents(self.out / "images"))
        self.assertEqual(len(gone), len(files) * 3 // 4)  # one view of four stays
        self.assertIn(f", {len(gone)} files removed that no image of the recipe has", out)
        self.assertEqual(self.build()["removed_files"], 0)

    def test_colours_count_where_a_material_reads_them(self):
        model = self.tiny / "models/tetra.ply"
        plain = model.read_text()
        files = {}
        for color in None, "255 0 0", "0 0 255":
            if color:
                lines = plain.replace("float z\n", "float z\nproperty uchar red\nproperty uchar green\n"
                                                   "property uchar blue\n").splitlines()
                at = lines.index("end_header") + 1
                model.write_text("\n".join(lines[:at] + [f"{line} {color}" for line in lines[at:at + 4]] +
                                           lines[at + 4:]) + "\n")
            self.assert_counts(self.build(), failed=0, traced=0 if files else IMAGES)
            found = self.contents(self.out / "images")
            self.assertEqual(found, files or found)
            files = found
        # They change no bit of a picture: it is traced again with them, and without.
        self.build("--force")
        self.assertEqual(self.contents(self.out / "images"), files)
        for material in "red", "green":
            (self.tiny / f"materials/{material}.mat").write_text(
                f"scene.textures.t.type = hitpointcolor\nscene.materials.{material}.kd = t\n")
        self.assert_counts(self.build(), traced=IMAGES)
        blue = self.contents(self.out / "images")
        model.write_text(model.read_text().replace(" 0 0 255\n", " 255 0 0\n"))
        self.assertEqual(self.run_it("status", self.out, "--json").json["stale"], IMAGES // 2)
        why = self.run_it("explain", self.out, "tetra.ply/0").out
        self.assertIn("colors: ", why)
        self.assert_counts(self.build(), traced=IMAGES // 2)
        changed = {path for path, data in self.contents(self.out / "images").items() if blue[path] != data}
        self.assertEqual(changed, {f"tetra.ply/{view}.png" for view in range(4)})  # and no mask

    def test_an_output_changed_with_its_times_kept(self):
        self.build()
        files = self.contents()
        picture = self.out / "images/box.off/1.png"
        shutil.copy2(picture, self.folder / "whole")
        self.swap_keeping_times(picture, lambda data: data[:-9] + b"x" + data[-8:])
        self.assertEqual(self.run_it("status", self.out, "--json").json["stale"], 1)
        self.assert_counts(self.build(), built=1, reused=IMAGES - 1)
        self.assertEqual(self.contents(), files)

    def test_a_build_says_that_it_replaces_what_was_edited(self):
        self.build()
        files = self.contents()
        out = ["-o", self.out]
        edited = ["images/box.off/0.png", "images/box.off/1.mask.png", "images/tetra.ply/3.png", "manifest/dataset.json"]
        for path in edited:
            data = (self.out / path).read_bytes()
            (self.out / path).unlink()
            (self.out / path).write_bytes(data + b"mine")
        # The same bytes under another stamp are no edit, and a file that is gone is none.
        same = self.out / "images/tetra.ply/2.png"
        data = same.read_bytes()
        same.unlink()
        same.write_bytes(data)
        (self.out / "images/tetra.ply/1.png").unlink()
        for settings, count in ([], 4), (["--set", "engine.spp=2"], 4), (["--set", "camera.views=[1]"], 4), (["--force"], 4):
            for verb in (["build", "-n"], ["plan"]):
                if settings == ["--force"] and verb == ["plan"]:
                    continue
                run = self.run_it(*verb, self.recipe, *out, *settings)
                self.assertIn(f"{count} files are not as a build wrote them, and are replaced or removed: ", run.out)
                self.assertIn("and 1 more", run.out)
                told = self.run_it(*verb, self.recipe, *out, *settings, "--json").json["edited_files"]
                self.assertEqual(told if verb != ["plan"] else len(told), count)
        self.assertEqual(set(self.run_it("plan", self.recipe, *out, "--json").json["edited_files"]), set(edited))
        run = self.run_it("build", self.recipe, *out, "--json")
        self.assertIn("dsbuild: warning: 4 files are not as a build wrote them, and are replaced or removed: ", run.err)
        self.assertEqual(run.json["edited_files"], 4)
        self.assertEqual(self.contents(), files)
        run = self.run_it("build", self.recipe, *out, "--json")
        self.assertEqual(run.json["edited_files"], 0)
        self.assertNotIn("as a build wrote", run.err)
        # As after a build that was killed between placing a file and noting it: nobody's work is lost.
        self.build("--set", "engine.spp=2")
        newer = (self.out / "images/box.off/0.png").read_bytes()
        self.build()
        (self.out / "images/box.off/0.png").unlink()
        (self.out / "images/box.off/0.png").write_bytes(newer)
        self.assert_counts(self.build(), edited_files=0, built=1)

    def replace(self, path, data):
        (self.out / path).unlink(missing_ok=True)
        (self.out / path).write_bytes(data)

    def test_what_a_build_writes_over_is_what_clean_leaves(self):
        self.build("--set", "camera.views=[0, 1]")
        new = "images/box.off/3.png"  # of a view that the recipe is given now
        self.replace(new, b"mine")
        self.replace("images/box.off/0.png", b"mine, too")
        left = self.run_it("clean", self.recipe, "-o", self.out, "--set", "camera.views=[0, 1]", "-n", "--json").json["edited"]
        self.assertEqual(left, ["images/box.off/0.png"])
        planned = self.run_it("plan", self.recipe, "-o", self.out, "--json").json["edited_files"]
        self.assertEqual(planned, ["images/box.off/0.png", new])
        run = self.run_it("build", self.recipe, "-o", self.out, "--json")
        self.assertEqual(run.json["edited_files"], 2, run)
        self.assertIn(f"warning: 2 files are not as a build wrote them, and are replaced or removed: images/box.off/0.png, {new}\n",
                      run.err)
        whole = self.contents()
        # Where the database was lost, what it knew of files is lost with it; what the store has is nobody's work.
        for file in (self.out / ".dsbuild").glob("dsbuild.sqlite*"):
            file.unlink()
        self.replace("images/box.off/2.mask.png", b"mine")
        run = self.run_it("build", self.recipe, "-o", self.out, "--json")
        self.assert_counts(run.json, edited_files=1, traced=0)
        self.assertIn("1 file is not as a build wrote it, and is replaced or removed: images/box.off/2.mask.png\n", run.err)
        self.assertEqual(self.contents(), whole)
        # Nor is what a build placed and was killed before it noted that: clean takes it, too.
        self.build("--set", "engine.spp=2")
        other = (self.out / "images/box.off/0.png").read_bytes()
        self.build()
        self.replace("images/box.off/0.png", other)
        self.assertEqual(self.run_it("clean", self.out, "--json").json["edited"], [])

    def test_rehash_reads_what_the_stamp_would_spare(self):
        self.build()
        for verb in ("build", "status", "plan"):
            run = self.run_it(verb, self.recipe, "-o", self.out, "--rehash", "--json")
            self.assertEqual(run.code, 0, run)

    def test_another_scene_in_a_file_is_explained_as_one(self):
        self.build()
        scene = self.tiny / "environments/plain/environment.scn"
        lights = "".join(f"scene.lights.l{number}.type = constantinfinite\nscene.lights.l{number}.color = 0.1 0.2 {number}\n"
                         for number in range(20))
        scene.write_text(lights)
        listed = map(json.loads, (self.out / "manifest/images.jsonl").read_text().splitlines())
        image = next(line["id"] for line in listed if line["environment"] == "plain")
        run = self.run_it("explain", self.out, image)
        told = [line for line in run.out.splitlines() if "environment: " in line]
        self.assertEqual(len(told), 1, run)
        self.assertRegex(told[0], rf"^  environment: {scene}: \d+ properties changed \(-v tells each\)$")
        self.assertLess(len(run.out.splitlines()), 12, run)
        every = self.run_it("explain", self.out, image, "-v").out
        self.assertIn("lights.l19", every)
        changes = self.run_it("explain", self.out, image, "--json").json["changes"]
        self.assertIn(f": {sum(one['part'] == 'environment' for one in changes)} properties", told[0])
        # A few are told one by one.
        self.build()
        scene.write_text(lights.replace("0.1 0.2 7", "0.1 0.2 7.5"))
        run = self.run_it("explain", self.out, image)
        self.assertIn("lights.l7", run.out)
        self.assertNotIn("-v tells", run.out)

    def test_another_assignment_is_explained_as_one(self):
        self.build()
        before = {line["id"]: line for line in map(json.loads, (self.out / "manifest/images.jsonl").read_text().splitlines())}
        (self.tiny / "materials/amber.mat").write_text(
            "scene.materials.amber.type = glossy2\nscene.materials.amber.kd = 0.9 0.5 0.1\n")
        after = {one["id"]: one for one in self.run_it("plan", self.recipe, "-o", self.out, "--json").json["stale_images"]}
        self.assertGreater(len(after), 0)
        for image in after:
            run = self.run_it("explain", self.out, image)
            self.assertEqual(run.code, 0, run)
            lines = run.out.splitlines()
            self.assertEqual(lines[0], f"{image}: trace")
            self.assertRegex(lines[1], rf"^  material: {before[image]['material']} -> \w+$")
            self.assertTrue(lines[2].startswith("render key "), run)
            told = self.run_it("explain", self.out, image, "--json").json
            self.assertEqual(told["assigned"], [{"name": "material", "before": before[image]["material"],
                                                 "after": lines[1].split()[-1]}])
            self.assertIn("material", {change["part"] for change in told["changes"]})
        # verify says what is behind.
        run = self.run_it("verify", self.out)
        self.assertEqual(run.code, 1, run)
        self.assertRegex(run.out, r"manifest: \S+: it is of an older recipe or older assets: material changed: ")
        # What changes beside the assignment is told too.
        (self.tiny / "materials/amber.mat").unlink()
        (self.tiny / "materials/green.mat").rename(self.tiny / "materials/zinc.mat")
        image = next(id for id, line in before.items() if line["material"] == "green")
        run = self.run_it("explain", self.recipe, image, "-o", self.out, "--set", "engine.spp=4")
        self.assertRegex(run.out, r"  material: green -> \w+\n  engine: spp: 1 -> 4\nrender key ")

    def test_a_file_that_no_image_has_is_said_to_be_so(self):
        self.build()
        (self.tiny / "models/tetra.ply").unlink()
        picture = self.out / "images/tetra.ply/0.png"
        own = self.out / "images/box.off/notes.txt"
        own.write_text("mine")
        for file, why in (picture, "any more; the next build removes it"), (own, "dsbuild did not make it"):
            run = self.run_it("explain", file)
            self.assertEqual(run.code, 2, run)
            self.assertEqual(len(run.err.splitlines()), 1, run)
            self.assertIn("no image of the recipe has this file", run.err)
            self.assertIn(why, run.err)

    def test_labels_are_stale_without_any_picture(self):
        self.build("--set", "classes.split={test=1.0}")
        changed = ["--set", "classes.split={test=0.0}"]
        said = "manifest behind: split of 8 images (box.off/0: test -> train)"
        for verb in (["status"], ["plan"], ["build", "-n"]):
            run = self.run_it(*verb, self.recipe, "-o", self.out, *changed)
            self.assertEqual(run.code, 0, run)
            self.assertIn(said, run.out)
        run = self.run_it("verify", self.recipe, "-o", self.out, *changed)
        self.assertEqual(run.code, 1, run)
        self.assertIn("it is behind: split of 8 images", run.out)
        self.assert_counts(self.build(*changed), built=0, reused=IMAGES)
        run = self.run_it("status", self.out, "--json")
        self.assertEqual(run.json["manifest"], {"behind": [], "older_program": ""})
        self.assertEqual(self.run_it("verify", self.out).code, 0)

    def test_an_input_that_cannot_be_read_takes_nothing_away(self):
        self.build()
        files = self.contents()
        with open(self.tiny / "environments/floor/environment.scn", "a") as file:
            file.write("scene.lights.sky.colour = 1 1 1\n")
        run = self.run_it("build", "-n", self.recipe, "-o", self.out)
        self.assertNotIn("remove", run.out)
        for arguments in ([], ["-k"]):
            counts = self.build(*arguments, code=1)
            self.assert_counts(counts, failed=IMAGES // 2, reused=IMAGES // 2)
            now = self.contents()
            dataset = "manifest/dataset.json"
            self.assertEqual({k: v for k, v in now.items() if not k.startswith("manifest/")},
                             {k: v for k, v in files.items() if not k.startswith("manifest/")})
            self.assertEqual(now["manifest/images.jsonl"], files["manifest/images.jsonl"])
            self.assertIn('"of_an_earlier_build": 4', (self.out / dataset).read_text())


if __name__ == "__main__":
    main()
