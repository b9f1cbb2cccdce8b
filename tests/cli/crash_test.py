# SPDX-License-Identifier: Apache-2.0
"""kill -9 at random moments, and builds beside each other: the bytes are always those of an undisturbed build."""
import json
import os
import random
import shutil
import time

from harness import IMAGES, TinyCase, main

KILLS = int(os.environ.get("DSBUILD_TEST_KILLS", "8"))  # ci/deep long asks for more


class CrashTest(TinyCase):
    def setUp(self):
        super().setUp()
        self.build()  # compiles the programs
        self.wanted = self.contents()
        shutil.rmtree(self.out)
        started = time.monotonic()
        self.build()
        self.seconds = time.monotonic() - started
        shutil.rmtree(self.out)

    def check(self):
        counts = self.build()
        self.assertEqual(counts["built"] + counts["reused"], IMAGES)
        self.assertEqual(self.contents(), self.wanted)
        self.assertEqual(self.run_it("verify", self.out).code, 0)

    def test_kill_at_random_moments(self):
        chance = random.Random(3)
        kills = 0
        while kills < KILLS:
            process = self.start("build", self.recipe, "-o", self.out)
            time.sleep(chance.uniform(0, 1.2 * self.seconds))
            process.kill()
            process.communicate()
            if process.returncode != -9:  # it was through before
                shutil.rmtree(self.out, ignore_errors=True)
                continue
            kills += 1
            # Every third time build to the end and compare; else go on from the wreck.
            if kills % 3 == 0:
                self.check()
                shutil.rmtree(self.out)
        self.check()

    def test_status_of_a_first_build_that_runs_or_was_killed(self):
        process = self.start("build", self.recipe, "-o", self.out, "--set", "engine.spp=6000")
        placed = self.out / "images/box.off/0.png"
        while process.poll() is None and not placed.exists():
            time.sleep(0.005)
        time.sleep(0.3)  # what is placed is recorded
        running = self.run_it("status", self.out).out
        process.kill()
        process.communicate()
        self.assertEqual(process.returncode, -9, running)
        self.assertRegex(running, rf"UTC, running, [1-{IMAGES}] of {IMAGES} images are made")
        self.assertIn("manifest is written at the build's end", running)
        self.assertNotIn("never written", running)
        self.assertNotIn("0 built", running)
        killed = self.run_it("status", self.out).out
        self.assertRegex(killed, rf"UTC, killed before its end, [1-{IMAGES}] of {IMAGES} images are made")
        self.assertNotIn("0 built", killed)

    def test_a_killed_build_is_told_of(self):
        self.build()
        process = self.start("build", self.recipe, "-o", self.out, "--set", "engine.spp=6000")
        placed = self.out / "images/box.off/0.png"
        before = placed.stat().st_ino
        while process.poll() is None and (not placed.exists() or placed.stat().st_ino == before):
            time.sleep(0.005)
        status = self.run_it("status", self.recipe, "-o", self.out, "--json").json["last_build"]
        self.assertIn("is still under way", self.run_it("verify", self.out).out)
        process.kill()
        process.communicate()
        self.assertEqual((status["outcome"], process.returncode), ("running", -9))
        self.assertEqual(self.run_it("status", self.recipe, "-o", self.out, "--json").json["last_build"]["outcome"],
                         "killed")
        self.assertIn("UTC, killed before its end, ", self.run_it("status", self.recipe, "-o", self.out).out)
        for target in ([self.out], [self.recipe, "-o", self.out]):
            run = self.run_it("verify", *target)
            self.assertIn("the last build was killed before its end: the manifest may be behind", run.out)
            self.assertEqual(self.run_it("verify", *target, "--json").json["unfinished_build"], "killed")
        self.build()
        self.assertIsNone(self.run_it("verify", self.out, "--json").json["unfinished_build"])
        self.assertNotIn("last build", self.run_it("verify", self.out).out)

    def test_two_processes_build_one_dataset(self):
        for _ in range(5):
            both = [self.start("build", self.recipe, "-o", self.out, "--json") for _ in range(2)]
            for process in both:
                _, err = process.communicate(timeout=300)
                self.assertEqual(process.returncode, 0, err)
            self.check()
            shutil.rmtree(self.out)

    def test_two_processes_share_the_work_of_one_store(self):
        store, other = self.folder / "store", self.folder / "other"
        work = ["--set", "engine.spp=64", "--set", "camera.count=12", "--store", store, "--json"]
        both = [self.start("build", self.recipe, "-o", out, *work) for out in (self.out, other)]
        traced = 0
        for process in both:
            out, err = process.communicate(timeout=300)
            self.assertEqual(process.returncode, 0, err)
            traced += json.loads(out.splitlines()[-1])["traced"]
        self.assertEqual(traced, 24, "each image is traced once, by one of the two")
        self.assertEqual(self.contents(), self.contents(other))


if __name__ == "__main__":
    main()
