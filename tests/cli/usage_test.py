# SPDX-License-Identifier: Apache-2.0
"""Exit codes and messages of wrong commands; needs no OpenCL device."""
import os
import shutil

from harness import IMAGES, TinyCase, main

VERBS = ["build", "plan", "status", "explain", "verify", "accuracy", "models", "log", "devices"]


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

    def test_wrong_command_lines_are_exit_code_2(self):
        for arguments in ([], ["no-such-verb"], ["build"], ["build", self.recipe, "--no-such-option"],
                          ["build", self.folder / "absent.toml"], ["status", self.tiny],
                          ["-C", self.folder / "absent", "build", self.recipe],
                          ["build", self.recipe, "--set", "engine.spp=0"],
                          ["build", self.recipe, "--set", "engine.ssp=4"],
                          ["verify", self.recipe, "--rerender", "some"],
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
