# SPDX-License-Identifier: Apache-2.0
"""What `dsbuild build` makes and what it leaves alone."""
import contextlib
import json
import os
import pty
import re
import shutil
import signal
import sqlite3
import subprocess
import time

from harness import IMAGES, SAMPLES, TinyCase, main


class BuildTest(TinyCase):
    def test_hidden_files_are_no_models(self):
        self.build()
        (self.tiny / "models/.DS_Store").write_bytes(b"\0\0\0\1Bud1")
        (self.tiny / "models/.git").mkdir()
        (self.tiny / "models/.git/old.off").write_text("not looked at")
        run = self.run_it("build", self.recipe, "-o", self.out, "--set", "models.recursive=true")
        self.assertIn(f"0 built, {IMAGES} reused", run.out)
        self.assertNotIn("not used", run.err)
        # What macOS leaves beside a file on other file systems: of the same ending, and no model.
        for count, name in enumerate(("._box.off", "._tetra.ply"), 1):
            (self.tiny / "models" / name).write_bytes(b"\0\5\x16\7\0\2\0\0Mac OS X")
            run = self.run_it("build", self.recipe, "-o", self.out)
            self.assertIn(f"0 built, {IMAGES} reused", run.out)
            self.assertEqual(run.err.count("dsbuild: warning: models.dir: not used of"), 1, run)
            self.assertIn("1 whose name begins with a dot, which hides it (._box.off)" if count == 1 else
                          "2 whose names begin with a dot, which hides them (._box.off, ...)", run.err)

    def test_second_build_makes_nothing(self):
        first = self.build()
        self.assert_counts(first, images=IMAGES, built=IMAGES, reused=0, failed=0, traced_samples=IMAGES * SAMPLES)
        self.assertGreater(first["seconds"], 0)
        files = self.contents()
        self.assertEqual(len(files), 2 * IMAGES + 3)
        self.assert_counts(self.build(), images=IMAGES, built=0, reused=IMAGES, failed=0, traced_samples=0)
        self.assertEqual(self.contents(), files)

    def test_what_changes_no_pixel_makes_nothing_stale(self):
        self.build()
        for path in self.tiny.rglob("*"):
            os.utime(path)
        self.edit("materials/red.mat", "# A matte red.", "# Another comment.\n\n")
        self.edit("materials/green.mat", "kd = 0.1 0.6 0.1", "kd =  0.10 0.60  0.1")
        self.edit("environments/plain/environment.scn", "# Light", "# A light")
        self.edit("models/box.off", "# a box, longer than wide\n", "")
        self.edit("models/tetra.ply", "comment a tetrahedron", "comment saved anew")
        self.edit("recipe.toml", "# The smallest", "# Still the smallest")
        self.assert_counts(self.build(), built=0, reused=IMAGES, traced_samples=0)

    def test_a_model_in_another_format_is_the_same_model(self):
        self.build()
        (self.tiny / "models/box.off").write_text(
            "OFF 8 6 0\n" + "-1 -1 -2\n1.0 -1 -2\n1 1 -2\n-1 1 -2\n-1 -1 2\n1 -1 2\n1 1 2e0\n-1 1 2\n"
            "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n")
        self.assert_counts(self.build(), built=0, reused=IMAGES)

    def test_an_edited_material_makes_its_images_only(self):
        self.build()
        records = [json.loads(line) for line in (self.out / "manifest/images.jsonl").read_text().splitlines()]
        red = {record["id"] for record in records if record["material"] == "red"}
        self.assertTrue(0 < len(red) < IMAGES)
        self.edit("materials/red.mat", "kd = 0.7 0.1 0.1", "kd = 0.6 0.1 0.1")
        plan = self.run_it("plan", self.recipe, "-o", self.out, "--json").json
        self.assertEqual({image["id"] for image in plan["stale_images"]}, red)
        for image in plan["stale_images"]:
            self.assertRegex(image["reasons"][0], r"material changed: .*kd.*: 0\.7 0\.1 0\.1 -> 0\.6 0\.1 0\.1")
        self.assert_counts(self.build(), built=len(red), reused=IMAGES - len(red), traced_samples=len(red) * SAMPLES)

    def test_a_tone_map_traces_nothing(self):
        self.build()
        counts = self.build("--set", "outputs.tone_map=linear", "--set", "outputs.tone_map_scale=0.25")
        self.assert_counts(counts, built=IMAGES, developed=IMAGES, traced=0, traced_samples=0)

    def test_a_removed_file_comes_from_the_store(self):
        self.build()
        files = self.contents()
        (self.out / "images/box.off/2.png").unlink()
        self.assert_counts(self.build(), built=1, reused=IMAGES - 1, developed=0, traced_samples=0)
        self.assertEqual(self.contents(), files)

    def test_depth_on_request_traces_no_sample(self):
        self.build()
        self.assert_counts(self.build("--set", "outputs.depth=exr"), built=IMAGES, traced_samples=0)
        self.assertTrue((self.out / "images/tetra.ply/0.depth.exr").exists())

    def test_dry_run_makes_nothing(self):
        counts = self.build("-n")
        self.assert_counts(counts, images=IMAGES, built=0, stale=IMAGES)
        self.assertFalse(self.out.exists())

    def test_force_gives_the_same_bytes(self):
        self.build()
        files = self.contents()
        self.assert_counts(self.build("--force"), built=IMAGES, traced_samples=IMAGES * SAMPLES)
        self.assertEqual(self.contents(), files)

    def test_default_folder_and_change_of_folder(self):
        run = self.run_it("-C", self.tiny, "build", "recipe.toml")
        self.assertEqual(run.code, 0, run)
        self.assertTrue((self.tiny / "out/tiny/images/box.off/0.png").exists())
        again = self.run_it("build", "-C", self.tiny, "out/tiny", "--json")
        self.assert_counts(again.json, built=0, reused=IMAGES)

    def test_keep_going_makes_the_rest(self):
        (self.tiny / "models/bad.ply").write_text("ply\nformat ascii 1.0\nelement vertex 3\n")
        run = self.run_it("build", self.recipe, "-o", self.out, "--json")
        self.assertEqual(run.code, 1, run)
        self.assert_counts(run.json, built=0, failed=4)
        self.assertEqual(run.err.count("bad.ply:"), 1, "one clear error")
        self.assert_counts(self.build("-k", code=1), built=IMAGES, failed=4)
        self.assert_counts(self.build("-k", code=1), built=0, reused=IMAGES, failed=4)

    def test_what_fails_on_the_way_is_told_once(self):
        environment = self.tiny / "environments/plain"
        (environment / "cut.hdr").write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n")
        with (environment / "environment.scn").open("a") as file:
            file.write('scene.lights.cut.type = infinite\nscene.lights.cut.file = cut.hdr\n')
        run = self.run_it("build", self.recipe, "-o", self.out, "--json", "-k")
        self.assertEqual(run.code, 1, run)
        self.assert_counts(run.json, failed=4)
        # The first as it comes; at the end how many there are. One alone is not told again.
        self.assertEqual(run.err.count("dsbuild: error: "), 2, run)
        self.assertEqual(run.err.count("4 images, "), 1, run)
        (self.tiny / "models/tetra.ply").unlink()
        run = self.run_it("build", self.recipe, "-o", self.folder / "one", "--json", "-k", "--set", "camera.views=[1]")
        self.assert_counts(run.json, failed=1)
        self.assertEqual(run.err.count("dsbuild: error: "), 1, run)

    def test_no_folder_is_named_that_nothing_was_made_in(self):
        for environment in (self.tiny / "environments").iterdir():
            (environment / "environment.scn").write_text("nothing that can be read\n")
        run = self.run_it("build", self.recipe, "-o", self.out, "-k")
        self.assertEqual(run.code, 1, run)
        self.assertIn("0 built", run.out)
        named = [line.split(": ", 1)[1] for line in run.out.splitlines() if line.startswith(("pictures: ", "manifest: "))]
        for path in named:
            self.assertTrue(os.path.exists(path), run)

    def test_explain_says_why(self):
        run = self.run_it("build", self.recipe, "-o", self.out, "--explain")
        self.assertIn("box.off/0 and 7 more: trace: new\n", run.out)
        image = self.out / "images/box.off/0.png"
        self.assertIn("box.off/0: up to date", self.run_it("explain", image).out)
        self.edit("recipe.toml", "fov_deg = 49", "fov_deg = 50")
        for arguments in ([image], [self.out, "box.off/0"], [self.recipe, "-o", self.out, "box.off/0"]):
            run = self.run_it("explain", *arguments)
            self.assertEqual(run.code, 0, run)
            self.assertEqual(run.out.count("fov_deg: 49 -> 50"), 1, run)
            self.assertIn("box.off/0: trace\n  camera: fov_deg: 49 -> 50\n", run.out)
        changes = self.run_it("explain", image, "--json").json["changes"]
        self.assertEqual([(c["part"], c["name"]) for c in changes], [("camera", "fov_deg")])

    def test_explain_lists_what_is_simulated(self):
        arguments = ["explain", self.recipe, "-o", self.out, "box.off/0", "--effects"]
        effects = {(e["sort"], e["name"]): e for e in self.run_it(*arguments, "--json").json["effects"]}
        simulated = {key for key, effect in effects.items() if effect["simulated"]}
        self.assertEqual(simulated, {("material", "matte"), ("light", "constant_infinite"),
                                     ("transport", "light from beyond the scene"), ("output", "image"),
                                     ("output", "mask")})
        self.assertIn("object model", effects["material", "matte"]["why"])
        self.assertEqual(effects["light", "constant_infinite"]["why"], "light sky")
        self.assertEqual(effects["material", "glass"]["why"], "no material is of this type")
        self.assertEqual(effects["output", "depth"]["why"], "outputs.depth is not set")
        text = self.run_it(*arguments).out
        self.assertRegex(text, r"effects: \d+ of \d+ are in this image's program")
        self.assertRegex(text, r"  simulated +material +matte +material \S+ of object")
        self.assertRegex(text, r"  compiled out +camera +lens +the lens radius is 0")
        self.assertFalse(self.out.exists(), "looking makes nothing")

    def test_programs_are_as_many_as_feature_sets_and_are_made_ahead(self):
        # Two of matte and glossy2, each alone and with the other: the floor is matte.
        self.edit("materials/green.mat", "type = matte", "type = glossy2")
        new_cache = {"env": {**os.environ, "XDG_CACHE_HOME": str(self.folder / "cache")}}
        every = ["--set", "materials.assign=all", "--set", "environments.assign=all"]
        first = self.build(*every, **new_cache)
        ids = [json.loads(line)["id"] for line in (self.out / "manifest/images.jsonl").read_text().splitlines()]
        sets = set()
        for image in ids[:first["images"] // 2]:  # the first model's
            effects = self.run_it("explain", self.out, image, "--effects", "--json").json["effects"]
            sets.add(tuple(e["name"] for e in effects if e["simulated"]))
        self.assertEqual(len(sets), 3)
        self.assert_counts(first, programs=3, programs_compiled=3, programs_ahead=2)
        again = self.build(*every, out=self.folder / "again", **new_cache)
        self.assert_counts(again, programs=3, programs_compiled=0, built=first["built"])
        self.assertEqual(self.contents(), self.contents(self.folder / "again"))

    def test_status_and_log(self):
        self.build()
        status = self.run_it("status", self.out, "--json").json
        self.assertEqual((status["up_to_date"], status["stale"], status["builds"]), (IMAGES, 0, 1))
        builds = self.run_it("log", self.out, "--json").json["builds"]
        self.assertEqual((builds[0]["outcome"], builds[0]["built"]), ("done", IMAGES))
        self.assertRegex(builds[0]["started_at"], r"^\d{4}-\d\d-\d\d \d\d:\d\d:\d\d$")

    def test_status_says_that_the_folder_was_built_otherwise(self):
        self.build("--set", "engine.spp=2")
        run = self.run_it("status", self.recipe, "-o", self.out)
        self.assertIn(f"built with --set 'engine.spp=2': dsbuild status {self.out} looks at it with these", run.out)
        for same in ([self.out], [self.recipe, "-o", self.out, "--set", "engine.spp=2"]):
            run = self.run_it("status", *same)
            self.assertNotIn("built with", run.out)
            self.assertIn(f"{IMAGES} up to date", run.out)

    def test_manifest_names_no_time_no_device_and_no_path(self):
        self.build()
        text = "".join(path.read_text() for path in (self.out / "manifest").iterdir())
        device = self.run_it("log", self.out, "--json").json["builds"][0]["device"]
        self.assertNotIn(device, text)
        self.assertNotIn(str(self.folder), text)
        self.assertNotIn(str(time.gmtime().tm_year) + "-", text)

    def test_checksums_are_what_xxhsum_reads(self):
        if not shutil.which("xxhsum"):
            self.skipTest("xxhsum is not installed")
        self.build()
        run = subprocess.run(["xxhsum", "-c", "manifest/checksums.xxh128"], cwd=self.out, capture_output=True,
                             text=True, check=False)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        self.assertEqual(run.stdout.count(": OK"), 2 * IMAGES + 2)

    def begun_builds(self):
        """How many the dataset's database knows of."""
        file = self.out / ".dsbuild/dsbuild.sqlite"
        if not file.exists():
            return 0
        try:
            with contextlib.closing(sqlite3.connect(f"file:{file}?mode=ro", uri=True)) as database:
                return database.execute("SELECT count(*) FROM build").fetchone()[0]
        except sqlite3.OperationalError:  # it is being created
            return 0

    def test_a_name_that_no_folder_takes_is_told_beforehand(self):
        # "1-" + 247 + ".png" has 253 bytes, but ".mask.png" makes 258 of it.
        (self.tiny / "materials" / ("m" * 247 + ".mat")).write_bytes((self.tiny / "materials/red.mat").read_bytes())
        every = ["--set", "materials.assign=all"]
        plan = self.run_it("plan", self.recipe, "-o", self.out, *every)
        self.assertEqual(plan.code, 1, plan)
        self.assertIn("at most 255 bytes, got 258", plan.out + plan.err)
        run = self.run_it("build", self.recipe, "-o", self.out, "-k", "--json", *every)
        self.assertEqual(run.code, 1, run)
        self.assertEqual(run.json["failed"], IMAGES)
        self.assertEqual(run.json["built"], run.json["images"] - IMAGES)

    def test_interrupt_ends_cleanly(self):
        # Large enough that the signal finds the first image under way.
        slow = ["--set", "engine.spp=4000", "--set", "engine.width=128", "--set", "engine.height=128"]
        for begun, number in enumerate((signal.SIGINT, signal.SIGTERM), start=1):
            process = self.start("build", self.recipe, "-o", self.out, "--json", *slow)
            while self.begun_builds() < begun:
                self.assertIsNone(process.poll(), "it ended by itself")
                time.sleep(0.05)
            time.sleep(1.0)
            process.send_signal(number)
            out, err = process.communicate(timeout=60)
            self.assertEqual(process.returncode, -number, err)  # by dying of the signal
            self.assertIn("stopped", err)
            counts = json.loads(out.splitlines()[-1])
            self.assertTrue(counts["stopped"])
            self.assertEqual(counts["built"] + counts["reused"] + counts["not_reached"], IMAGES)
        self.assertEqual(self.run_it("log", self.out, "--json").json["builds"][0]["outcome"], "stopped")

    def test_progress_moves_on_a_terminal_and_is_plain_elsewhere(self):
        plain = self.run_it("build", self.recipe, "-o", self.out)
        self.assertNotIn("\r", plain.err)
        self.assertRegex(plain.err, rf"\[{IMAGES}/{IMAGES}\] 100% \S+")
        master, slave = pty.openpty()
        process = subprocess.Popen(self.command("build", self.recipe, "-o", self.out, "--force"), stderr=slave,
                                   stdout=subprocess.DEVNULL, cwd=self.folder)
        os.close(slave)
        shown = b""
        while True:
            try:
                block = os.read(master, 4096)
            except OSError:  # the other side closed
                break
            if not block:
                break
            shown += block
        os.close(master)
        self.assertEqual(process.wait(), 0)
        self.assertRegex(shown.decode(), r"\r\x1b\[K\[\d/8\] .*Msamples/s  ETA \d+:\d\d")
        self.assertFalse(re.search(r"[^\r]\n", shown.decode()), "one line only")

    def test_a_mended_model_is_told_once(self):
        self.assertNotIn("warning", self.run_it("build", self.recipe, "-o", self.out).err)
        dataset = self.out / "manifest/dataset.json"
        self.assertNotIn("mended_models", json.loads(dataset.read_text()))
        (self.tiny / "models/torn.off").write_text(
            "OFF 5 6 0\n0 0 0\n4 0 0\n0 4 0\n0 0 4\n3e38 0 0\n"
            "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n3 0 1 4\n3 0 1 9\n")
        for built in (IMAGES // 2, 0):  # whether it is read now or was read before
            run = self.run_it("build", self.recipe, "-o", self.out, "--json")
            self.assertEqual(run.code, 0, run)
            self.assert_counts(run.json, built=built)
            warnings = [line for line in run.err.splitlines() if "warning" in line]
            self.assertEqual(len(warnings), 1, run)
            self.assertRegex(warnings[0], r"^dsbuild: warning: .*/models/torn\.off: mended: faces with an index out of "
                                          r"range removed: 1, vertices not finite or beyond 1e18 removed with their "
                                          r"faces: 1$")
            self.assertEqual(json.loads(dataset.read_text())["mended_models"],
                             {"torn.off": {"non_finite": 1, "out_of_range": 1}})
        models = {model["model"]: model for model in self.run_it("models", self.recipe, "--json").json["models"]}
        self.assertEqual((models["torn.off"]["non_finite"], models["torn.off"]["out_of_range"]), (1, 1))

    def test_models_turned_outwards_are_told_in_one_line(self):
        for name in ("one", "two"):
            (self.tiny / f"models/{name}.off").write_text(
                "OFF 4 4 0\n0 0 0\n4 0 0\n0 4 0\n0 0 4\n3 0 1 2\n3 0 1 3\n3 0 2 3\n3 1 3 2\n")
        run = self.run_it("build", self.recipe, "-o", self.out)
        self.assertEqual(run.code, 0, run)
        self.assertEqual([line for line in run.err.splitlines() if "warning" in line],
                         ["dsbuild: warning: 2 models with closed surfaces that face inwards: mended, 6 triangles "
                          "turned outwards (dsbuild models lists them as flipped)"])
        self.assertEqual(json.loads((self.out / "manifest/dataset.json").read_text())["mended_models"],
                         {"one.off": {"flipped": 3}, "two.off": {"flipped": 3}})

    def test_a_failing_image_is_told_once(self):
        (self.tiny / "materials/broken.png").write_bytes(b"no picture")
        (self.tiny / "materials/red.mat").write_text("scene.textures.t.file = broken.png\nscene.materials.red.kd = t\n")
        run = self.run_it("build", self.recipe, "-o", self.out)
        self.assertEqual(run.code, 1, run)
        self.assertEqual(run.err.count("dsbuild: error:"), 1, run)
        self.assertIn("broken.png", run.err)
        going_on = self.run_it("build", self.recipe, "-o", self.out, "-k")
        self.assertRegex(going_on.err, rf"dsbuild: error: {IMAGES // 2} images, \S+ \.\.\.: .*broken.png")

    def test_small_builds_count_samples_in_thousands(self):
        run = self.run_it("build", self.recipe, "-o", self.out)
        self.assertRegex(run.out, r"; 8\.2 ksamples traced on ")
        self.assertRegex(self.run_it("log", self.out).out, r" 8\.2 ksamples ")

    def test_models_are_reported(self):
        run = self.run_it("models", self.recipe, "--json")
        self.assertEqual(run.code, 0, run)
        models = {model["model"]: model for model in run.json["models"]}
        self.assertEqual((models["box.off"]["faces"], models["box.off"]["n_gons"]), (6, 6))
        self.assertEqual(models["box.off"]["triangles"], 12)
        table = self.run_it("models", self.recipe).out
        self.assertRegex(table, r"(?m)^box.off +8 +6 +12  6 n_gons$")
        self.assertIn("tetra.ply", table)
        for line in table.splitlines():
            self.assertLessEqual(len(line), 80, line)


if __name__ == "__main__":
    main()
