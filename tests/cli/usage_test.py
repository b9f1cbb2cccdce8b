# SPDX-License-Identifier: Apache-2.0
"""Exit codes and messages of wrong commands; needs no OpenCL device."""
import os
import shutil

from harness import IMAGES, TinyCase, main

VERBS = ["build", "plan", "status", "explain", "verify", "accuracy", "models", "log", "devices", "help"]
TOPICS = ["textures", "materials", "shapes", "objects", "lights", "film", "recipe"]


class UsageTest(TinyCase):
    def test_help_and_version(self):
        self.assertRegex(self.run_it("--version").out, r"^dsbuild \d+\.\d+\.\d+\n$")
        overview = self.run_it("--help")
        self.assertEqual(overview.code, 0)
        self.assertIn("Exit codes: 0", overview.out)
        for verb in VERBS:
            self.assertIn(verb, overview.out)
            run = self.run_it(verb, "--help")
            self.assertEqual(run.code, 0, run)
            self.assertIn("Usage: dsbuild " + verb, run.out)

    def test_help_fits_the_narrowest_terminal(self):
        texts = [self.run_it("help"), self.run_it("--help")]
        self.assertEqual(texts[0].out, texts[1].out)
        for verb in VERBS:
            texts += [self.run_it("help", verb), self.run_it(verb, "-h")]
            self.assertEqual(texts[-1].out, texts[-2].out)
        texts += [self.run_it("help", topic) for topic in TOPICS]
        for run in texts:
            self.assertEqual((run.code, run.err), (0, ""), run)
            for line in run.out.splitlines():
                self.assertLessEqual(len(line), 80, line)

    def test_alone_it_prints_help_and_fails(self):
        for arguments in ([], ["-C", self.folder]):
            run = self.run_it(*arguments)
            self.assertEqual((run.code, run.err), (2, ""), run)
            self.assertEqual(run.out, self.run_it("--help").out)

    def test_help_tells_types_and_keys(self):
        glass = self.run_it("help", "materials", "glass").out
        self.assertRegex(glass, r"interiorior +a number >= 0.01 or a texture's name \[1.5\]")
        self.assertNotIn("uroughness", glass)
        self.assertIn("uroughness", self.run_it("help", "materials").out)
        self.assertRegex(self.run_it("help", "lights", "spot").out, r"coneangle +a number in \(0, 90\) \[30\]")
        self.assertRegex(self.run_it("help", "recipe", "camera.fov_deg").out,
                         r"^\[camera\]:\n  fov_deg  a number in \(0, 180\) \(degree\) \[49\]: ")
        camera = self.run_it("help", "recipe", "camera").out
        self.assertIn("lens_radius_m", camera)
        self.assertNotIn("[engine]", camera)

    def test_misspelt_words_get_the_right_one(self):
        for arguments, message in (
                (["bulid", self.recipe], "bulid is no verb of dsbuild, did you mean build?"),
                (["paint"], "paint is no verb of dsbuild; there are build, plan, status,"),
                ([self.recipe], f"to make its images: dsbuild build {self.recipe}"),
                (["build", self.recipe, "--josn"], "build has no option --josn, did you mean --json?"),
                (["build", "--josn"], "build has no option --josn, did you mean --json?"),
                (["build", self.recipe, "--keep-goin", "-n"], "did you mean --keep-going?"),
                (["build", self.recipe, "-nx"], "build has no option -x; there are"),
                (["status", self.recipe, "--force"], "status has no option --force; build has it"),
                (["--json", "plan", self.recipe], "--json stands before the verb: write dsbuild VERB --json"),
                (["build"], "build: wanted a DATASET"),
                (["build", self.recipe, "other"], "build: does not know what to do with other"),
                (["plan", self.tiny / "recpie.toml"], "found no file, did you mean recipe.toml?"),
                (["explain", self.recipe, "box.of/0"], "no such image, did you mean box.off/0?"),
                (["explain", self.recipe, "human"], "no such image; there are box.off/0, box.off/1,"),
                (["help", "material"], "did you mean materials?"),
                (["help", "cheese"], "help: cheese is no verb or topic; there are"),
                (["help", "materials", "galss"], "galss is no type of materials, did you mean glass?"),
                (["help", "lights", "area"], "area is no type of lights; there are point, spot,"),
                (["help", "recipe", "camera.fov"], "did you mean camera.fov_deg?"),
                (["help", "recipe", "camra"], "did you mean camera?"),
                (["plan", self.recipe, "--set", "camera.set=orbti"], 'did you mean "orbit"?'),
                (["plan", self.recipe, "--set", "camra.set=orbit"], "camra is no section of a recipe, did you mean camera?"),
                (["plan", self.recipe, "--set", "lens.sharp=1"], "lens is no section of a recipe; there are dataset,"),
                (["plan", self.recipe, "--set", "camera.shutter=1"], "is no key of a recipe; camera has set,"),
                (["plan", self.recipe, "--set", "models.dir=tiny/modles"], "did you mean models?"),
                (["plan", self.recipe, "--set", "models.files=[\"tiny/models/box.of\"]"], "did you mean box.off?")):
            run = self.run_it(*arguments)
            self.assertEqual(run.code, 2, (arguments, str(run)))
            self.assertIn(message, run.err)
            self.assertEqual(run.err.count("\n"), 1, run)
            self.assertEqual(run.out, "")

    def test_one_mistake_in_a_recipe_is_one_error(self):
        whole = self.recipe.read_text()
        for before, after in (("[camera]", "[camra]"), ("[models]", "[modles]"), ('dir = "models"', 'dri = "models"'),
                              ('set = "orbit"', 'sett = "orbit"'), ('set = "orbit"', 'set = "orbti"'),
                              ('dir = "materials"', 'dir = "materails"'), ("[engine]", "[engine")):
            self.recipe.write_text(whole)
            self.edit("recipe.toml", before, after)
            run = self.run_it("plan", self.recipe)
            self.assertEqual((run.code, run.err.count("dsbuild: error: ")), (2, 1), run)
        self.recipe.write_text(whole)
        self.edit("recipe.toml", 'dir = "models"', 'dir = "modles"\n[classes]\ntrain = "{models.dir}/a.cla"')
        run = self.run_it("plan", self.recipe)
        self.assertEqual(run.err.count("dsbuild: error: "), 1, run)

    def test_a_plan_groups_by_reason_and_names_all_where_asked(self):
        new = self.run_it("plan", self.recipe).out
        self.assertEqual(new.splitlines()[:-1], ["box.off/0 and 7 more: trace: new"])
        lines = self.run_it("plan", self.recipe, "-v").out.splitlines()
        self.assertEqual(lines[0], "box.off/0 and 7 more: trace: new")
        self.assertEqual(len([line for line in lines if line.startswith("  ")]), IMAGES)
        self.assertEqual(self.run_it("build", "-n", self.recipe).out, new)
        (self.tiny / "materials/red.mat").write_text("scene.materials.red.type = galss\n")
        lines = self.run_it("plan", self.recipe).out.splitlines()
        self.assertEqual(len(lines), 3, lines)
        self.assertRegex(lines[1], r"^\S+ and 3 more: cannot be made: .*red.mat:1: .*did you mean glass\?$")

    def test_wrong_command_lines_are_exit_code_2(self):
        for arguments in (["no-such-verb"], ["build"], ["build", self.recipe, "--no-such-option"],
                          ["build", self.folder / "absent.toml"], ["status", self.tiny],
                          ["-C", self.folder / "absent", "build", self.recipe],
                          ["build", self.recipe, "--set", "engine.spp=0"],
                          ["build", self.recipe, "--set", "engine.ssp=4"],
                          ["verify", self.recipe, "--rerender", "some"],
                          ["verify", self.recipe, "--rerender", "-1"],
                          ["accuracy", self.recipe, "--against", "hours"], ["accuracy", self.recipe, "--spp", "1"],
                          ["accuracy", self.recipe, "-o", "report.csv"],
                          ["plan", self.recipe, "--error", "0"], ["plan", self.recipe, "--error", "two"],
                          ["plan", self.recipe, "--budget", "8"], ["plan", self.recipe, "--budget", "-1h"],
                          ["plan", self.recipe, "--budget", "8h", "--error", "0.02"],
                          ["plan", self.recipe, "--recalibrate"]):
            run = self.run_it(*arguments)
            self.assertEqual(run.code, 2, (arguments, str(run)))
            self.assertTrue(run.err.startswith("dsbuild: error: "), run)
            self.assertEqual(run.out, "")

    def test_accuracy_wants_pictures(self):
        run = self.run_it("accuracy", self.recipe, "--set", "outputs.image=false")
        self.assertEqual(run.code, 2, run)
        self.assertIn("found outputs.image = false; measure it with --set outputs.image=true", run.err)
        self.assertEqual(run.out, "")
        self.assertEqual(list(self.folder.glob("*accuracy*")), [])

    def test_a_wrong_recipe_names_each_place(self):
        self.edit("recipe.toml", "spp = 1", "spp = -1\nunknown = 3")
        run = self.run_it("plan", self.recipe)
        self.assertEqual(run.code, 2, run)
        self.assertEqual(run.err.count("recipe.toml:"), 2, run)

    def test_a_missing_asset_is_exit_code_1(self):
        (self.tiny / "materials/red.mat").write_text("scene.materials.red.type = no-such-type\n")
        run = self.run_it("plan", self.recipe)
        self.assertEqual(run.code, 1, run)
        self.assertIn("red.mat:1", run.out)

    def test_images_are_loaded_where_they_are_needed(self):
        alone = self.folder / "alone/bin/dsbuild"  # what it would load lies in ../lib
        alone.parent.mkdir(parents=True)
        shutil.copy(self.dsbuild, alone)
        self.dsbuild = alone
        for verb in (["--version"], ["plan", self.recipe], ["status", self.recipe], ["devices"]):
            run = self.run_it(*verb)
            self.assertEqual(run.code, 0, run)
        run = self.run_it("build", self.recipe)
        self.assertEqual(run.code, 1, run)
        self.assertIn("cannot load what reads and writes images", run.err)
        self.assertIn("dsbuild_images.so", run.err)

    def test_looking_needs_no_device_and_writes_nothing(self):
        # An empty folder of vendors leaves the OpenCL loader nothing to find.
        vendors = self.folder / "vendors"
        vendors.mkdir()
        environment = dict(os.environ, OCL_ICD_VENDORS=str(vendors), OPENCL_VENDOR_PATH=str(vendors))
        for verb in (["plan"], ["status"], ["log"], ["models"], ["build", "-n"]):
            run = self.run_it(*verb, self.recipe, env=environment)
            self.assertEqual(run.code, 0, run)
        self.assertFalse((self.folder / "out").exists())
        run = self.run_it("build", self.recipe, "--json", env=environment)
        self.assertEqual(run.code, 1, run)
        self.assert_counts(run.json, built=0, images=IMAGES)
        self.assertEqual(self.run_it("devices", env=environment).code, 1)


if __name__ == "__main__":
    main()
