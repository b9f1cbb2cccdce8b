# SPDX-License-Identifier: Apache-2.0
"""Builds that keep what they make on their machine's own disk (--local): however one ends, what it made is in the store, or
is brought there by the next."""
import shutil
import signal
import subprocess
import time

from harness import IMAGES, TinyCase, main

SLOW = ["--set", "engine.spp=3000"]


class LocalTest(TinyCase):
    def setUp(self):
        super().setUp()
        self.store, self.local = self.folder / "store", self.folder / "disk/local"
        self.node = ["--store", self.store, "--database", self.folder / "db", "--no-files", "--local", self.local]

    def kept(self, store):
        return [path for path in (store / "records").rglob("*") if path.is_file() and not path.name.startswith(".")]

    def left(self):
        return [path for path in self.local.rglob("*") if path.is_file()]

    def wait_for(self, store, count):
        deadline = time.monotonic() + 60
        while len(self.kept(store)) < count:
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.01)

    def build_here(self, *arguments, **options):
        return self.build(*self.node, *arguments, out=self.folder / "passing", **options)

    def start_here(self, *arguments):
        return self.start("build", self.recipe, "-o", self.folder / "passing", "--json", *self.node, *arguments)

    def kill_a_build(self):
        """When a few images are kept; its database is lost, as a job's is."""
        process = self.start_here(*SLOW)
        self.wait_for(self.local, 2)
        process.kill()
        process.communicate(timeout=60)
        shutil.rmtree(self.folder / "db")

    def assert_whole(self, *arguments, traced=0):
        self.assert_counts(self.build("--store", self.store, *arguments), traced=traced)
        self.build(*arguments, out=self.folder / "one")
        self.assertEqual(self.contents(), self.contents(self.folder / "one"))

    def test_what_is_made_is_in_the_store_at_the_end(self):
        counts = self.build_here("--shard", "1/2")
        self.assertEqual(counts["gathered"]["records"]["files"], counts["traced"])
        self.assertEqual((len(self.kept(self.store)), self.left()), (counts["traced"], []))
        self.assertEqual((counts["gathered"]["faults"], counts["gathered"]["missing"]), (0, 0))
        # What the store has is not made again, wherever it was made.
        shutil.rmtree(self.folder / "db")
        counts = self.build_here()
        self.assertEqual(counts["reused"] + counts["traced"], IMAGES)
        self.assertEqual(counts["gathered"]["records"]["files"], counts["traced"])
        self.assert_whole()

    def test_stopped(self):
        process = self.start_here(*SLOW)
        self.wait_for(self.local, 2)
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=60)
        self.assertNotEqual(process.returncode, 0)
        kept = len(self.kept(self.store))
        self.assertGreaterEqual(kept, 2)
        self.assertEqual(self.left(), [])
        self.assert_whole(*SLOW, traced=IMAGES - kept)

    def test_killed_it_is_brought_by_the_next_one(self):
        self.kill_a_build()
        self.assertEqual(self.kept(self.store), [])
        kept = len(self.kept(self.local))
        counts = self.build_here(*SLOW)
        self.assert_counts(counts, traced=IMAGES - kept)
        self.assertEqual(counts["gathered"]["records"]["files"], IMAGES)
        self.assertEqual([path for path in self.left() if "objects" not in path.parts], [])
        self.assert_whole(*SLOW)

    def test_a_damaged_file_is_not_brought(self):
        self.kill_a_build()
        victim = self.kept(self.local)[0]
        victim.write_text("not what its name says")
        run = self.run_it("build", self.recipe, "-o", self.folder / "passing", "--json", *self.node, *SLOW)
        self.assertEqual(run.code, 0, run)
        self.assertIn(f"{victim}: a file of the store is damaged", run.err)
        self.assertFalse(victim.exists() and victim.read_text().startswith("not"))
        self.assert_whole(*SLOW)

    def test_a_full_disk_costs_what_it_has_not_made(self):
        place = self.folder / "disk"
        place.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=40k", "tmpfs", place], capture_output=True, check=False)
        if mounted.returncode != 0:
            self.skipTest("cannot mount here")
        self.addCleanup(subprocess.run, ["umount", place], check=True)
        run = self.run_it("build", self.recipe, "-o", self.folder / "passing", "--json", "-k", *self.node)
        self.assertEqual(run.code, 1, run)
        self.assertRegex(run.err, "[Nn]o space left")
        self.assertTrue(run.json["disk_failed"])
        kept = len(self.kept(self.store))
        self.assertTrue(0 < kept < IMAGES, run)
        self.assertEqual(self.kept(self.local), [])
        self.assert_whole(traced=IMAGES - kept)

    def test_a_store_that_takes_nothing(self):
        place = self.store
        place.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=32k", "tmpfs", place], capture_output=True, check=False)
        if mounted.returncode != 0:
            self.skipTest("cannot mount here")
        run = self.run_it("build", self.recipe, "-o", self.folder / "passing", "--json", "-k", *self.node)
        subprocess.run(["umount", place], check=True)
        self.assertEqual(run.code, 1, run)
        self.assertEqual(run.json["traced"], IMAGES)
        self.assertIn(f"what was made stays in {self.local}", run.err)
        # With room again it is brought, and nothing is traced again.
        self.assert_counts(self.build_here(), traced=0, reused=IMAGES)
        self.assert_whole()

    def test_wrong_usage(self):
        database = ["--database", self.folder / "db"]
        for arguments, said in ((["--local", self.local], "wants --database DIR too"),
                                (["--local", self.store, *database], "wanted another folder than the store's")):
            run = self.run_it("build", self.recipe, "-o", self.out, "--store", self.store, *arguments)
            self.assertEqual(run.code, 2, run)
            self.assertIn(said, run.err)


if __name__ == "__main__":
    main()
