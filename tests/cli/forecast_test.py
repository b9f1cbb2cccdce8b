# SPDX-License-Identifier: Apache-2.0
"""What plan forecasts; that it is right is measured by ci/forecast, since a shared machine makes any one time wrong."""
import os
import pathlib
import shutil
import tempfile

from harness import IMAGES, SAMPLES, TinyCase, main


class ForecastTest(TinyCase):
    @classmethod
    def setUpClass(cls):
        cls.programs = pathlib.Path(tempfile.mkdtemp(prefix="dsbuild-programs-"))
        cls.addClassCleanup(shutil.rmtree, cls.programs, ignore_errors=True)

    def setUp(self):
        """A calibration of its own for each test, but compiled programs for all together."""
        super().setUp()
        (self.folder / "cache/dsbuild").mkdir(parents=True)
        (self.folder / "cache/dsbuild/programs").symlink_to(self.programs)
        self.environment = dict(os.environ, XDG_CACHE_HOME=str(self.folder / "cache"))

    def plan(self, *arguments, code=0):
        run = self.run_it("plan", self.recipe, "-o", self.out, *arguments, env=self.environment)
        self.assertEqual(run.code, code, run)
        return run

    def forecast(self, *arguments, code=0):
        return self.plan(*arguments, "--json", code=code).json["forecast"]

    def stored(self):
        """Bytes of the objects in the dataset's store."""
        return sum(path.stat().st_size for path in (self.out / ".dsbuild/objects").rglob("*") if path.is_file())

    def calibrating(self):
        """Folders that calibrations work in."""
        return [path.name for path in (self.folder / "cache/dsbuild/calibrating").iterdir() if path.is_dir()]

    def test_what_a_killed_calibration_left_is_removed(self):
        killed = self.start("plan", self.recipe, "-o", self.out, "--time", "--set", "engine.spp=1024",
                            "--set", "engine.width=256", "--set", "engine.height=256",
                            env=self.environment)
        killed.stderr.readline()  # "calibrating 1 of 8 ..."
        killed.kill()
        killed.communicate()
        self.assertEqual(len(self.calibrating()), 1)
        self.plan("--time")
        self.assertEqual(self.calibrating(), [])

    def test_time_of_what_is_stale(self):
        told = self.forecast("--time")
        self.assertGreater(told["seconds"]["value"], 0)
        self.assertLess(told["seconds"]["low"], told["seconds"]["high"])
        self.assertEqual(sum(pair["made"] for pair in told["pairs"]), IMAGES)
        self.assertEqual(set(told["bytes_by_kind"]), {"film", "image", "mask"})
        self.assertGreater(told["measured"], 0)
        self.assertFalse(self.out.exists(), "plan makes no dataset")
        self.assertEqual(self.forecast("--time")["measured"], 0, "the calibration is kept")
        self.build()
        done = self.forecast("--time", "--recalibrate")
        self.assertEqual(done["seconds"]["value"], 0)
        self.assertEqual(done["bytes"]["value"], 0)
        self.assertEqual(done["measured"], 0, "nothing to make, nothing to measure")
        self.assertIn("nothing to make, so no time was measured", self.plan("--time").out)

    def test_disk_is_what_a_build_writes(self):
        told = self.forecast("--time", "--set", "engine.spp=16")
        self.build("--set", "engine.spp=16")
        # Every image of the tiny dataset is near another that was probed; equal files are stored once.
        self.assertAlmostEqual(told["bytes"]["value"] / self.stored(), 1, delta=0.25)
        before = self.stored()
        kept = ("--set", "engine.spp=17", "--set", "engine.keep_sums=true")
        told = self.forecast("--time", *kept)
        self.assertGreater(told["bytes_by_kind"]["film_sums"], IMAGES * SAMPLES * 150)
        self.build(*kept)
        self.assertAlmostEqual(told["bytes"]["value"] / (self.stored() - before), 1, delta=0.1)

    def test_kept_films_take_the_missing_samples_only(self):
        keep = ("--set", "engine.keep_sums=true")
        whole = self.forecast("--time", *keep, "--set", "engine.spp=65")
        self.build(*keep, "--set", "engine.spp=64")
        more = self.forecast("--time", *keep, "--set", "engine.spp=65")
        for before, pair in zip(whole["pairs"], more["pairs"]):
            self.assertEqual((pair["spp"], before["traced_spp"], pair["traced_spp"]), (65, 65, 1))
            self.assertEqual(pair["made"], before["made"])
        self.assertEqual(more["measured"], 0)
        self.assertLess(more["seconds"]["value"], whole["seconds"]["value"])
        self.build(*keep, "--set", "engine.error=0.02")
        for pair in self.forecast("--time", *keep, "--set", "engine.error=0.001")["pairs"]:
            self.assertGreater(pair["traced_spp"], 0)
            self.assertLessEqual(pair["traced_spp"], pair["spp"] - 16)

    def test_without_pictures_there_are_no_samples(self):
        geometry = ("--set", "outputs.image=false", "--set", "outputs.depth=exr")
        for error in ((), ("--set", "engine.error=0.05")):
            told = self.forecast("--time", *geometry, *error)
            self.assertGreater(told["seconds"]["value"], 0)
            self.assertEqual(set(told["bytes_by_kind"]), {"depth", "mask"})
            for pair in told["pairs"]:
                self.assertEqual((pair["spp"], pair["engine_error"], pair["relative_error"]), (0, None, None))
        self.assertIn("no samples, as outputs.image = false", self.plan("--time", *geometry).out)
        for question in (("--error", "0.02"), ("--budget", "8h")):
            run = self.plan(*question, *geometry, code=2)
            self.assertIn(f"{question[0]} is of pictures", run.err)
        self.build(*geometry)
        self.assertAlmostEqual(told["bytes"]["value"] / self.stored(), 1, delta=0.25)
        self.assertEqual(self.forecast("--time", *geometry)["seconds"]["value"], 0)
        self.assertEqual(self.calibrating(), [])

    def test_a_smaller_error_takes_longer_and_a_budget_buys_it_back(self):
        many = ("--set", "engine.error=0.5", "--set", "engine.max_spp=16777216")
        near, far = self.forecast("--error", "0.001", *many), self.forecast("--error", "0.1", *many)
        self.assertGreater(near["seconds"]["value"], far["seconds"]["value"])
        for pair in near["pairs"]:
            self.assertGreater(pair["spp"], 16)
            self.assertAlmostEqual(pair["engine_error"], 0.001, delta=1e-7)
            self.assertEqual(pair["capped"], 0)
        for pair in far["pairs"]:
            self.assertEqual(pair["spp"], 16, "engine.error's first step is enough")
        bought = self.forecast("--budget", f"{near['seconds']['value']:.6f}s", *many)
        self.assertAlmostEqual(bought["engine_error"]["value"], 0.001, delta=0.00005)
        self.assertFalse(bought["capped"])

    def test_max_spp_bounds_what_an_error_takes(self):
        # 1024 where the recipe has samples in place of an error.
        for most, settings in ((1024, ()), (64, ("--set", "engine.error=0.5", "--set", "engine.max_spp=64"))):
            told = self.forecast("--error", "0.00001", *settings)
            for pair in told["pairs"]:
                self.assertEqual((pair["spp"], pair["capped"]), (most, 1))
                self.assertGreater(pair["engine_error"], 0.00001)
            out = self.plan("--error", "0.00001", *settings).out
            self.assertIn(f"with at most {most} samples a pixel (engine.max_spp)", out)
            self.assertEqual(out.count("  capped\n"), len(told["pairs"]))
            bought = self.forecast("--budget", "8h", *settings)
            self.assertTrue(bought["capped"])
            worst = max(pair["engine_error"] for pair in told["pairs"])
            self.assertGreater(bought["engine_error"]["value"], 0.9 * worst)
            for pair in bought["pairs"]:
                self.assertLessEqual(pair["spp"], most + 1e-6)
                self.assertEqual(pair["capped"], 0)
            self.assertGreater(bought["more"]["max_spp"], most)
            self.assertLess(bought["more"]["engine_error"], bought["engine_error"]["value"])
            self.assertRegex(self.plan("--budget", "8h", *settings).out,
                             rf"the least with engine.max_spp = {most} \(\d+ would buy [\d.e-]+ %\), on ")

    def test_text(self):
        out = self.plan("--error", "0.05").out
        same = self.plan("--time", "--set", "engine.error=0.05").out
        self.assertIn("every picture to an engine.error of 5 %", same)
        self.assertIn("every picture to an engine.error of 5 %", out)
        self.assertRegex(out, r"time about \d+:\d\d \(\d+:\d\d to \d+:\d\d\)")
        self.assertRegex(out, r"disk [\d.]+ kB")
        self.assertRegex(self.plan("--budget", "1h").out, r"the budget buys an engine.error of [\d.e-]+ % \(")

    def test_a_budget_that_buys_nothing(self):
        run = self.plan("--budget", "0.000001s", code=1)
        self.assertIn("no engine.error can be had for this budget", run.out)


if __name__ == "__main__":
    main()
