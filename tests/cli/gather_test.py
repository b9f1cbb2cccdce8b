# SPDX-License-Identifier: Apache-2.0
"""Stores of several machines put together (store gather), and builds that place no file (--no-files): nothing is traced twice,
and nothing that is damaged is taken."""
import os
import shutil
import signal
import time

from harness import IMAGES, TinyCase, main

KILLS = int(os.environ.get("DSBUILD_TEST_KILLS", "6"))


class GatherTest(TinyCase):
    def setUp(self):
        super().setUp()
        self.a, self.b, self.store = (self.folder / name for name in ("a", "b", "store"))

    def gather(self, source, *arguments, code=0, to=None):
        run = self.run_it("store", "gather", source, to or self.store, "--json", *arguments)
        self.assertEqual(run.code, code, run)
        return run

    def files(self, store, kinds=("objects", "records")):
        return sorted(path.relative_to(store) for kind in kinds for path in (store / kind).rglob("*")
                      if path.is_file() and not path.name.startswith("."))

    def two_machines(self):
        for number, store in ((1, self.a), (2, self.b)):
            self.build("--shard", f"{number}/2", "--store", store, out=self.folder / f"out-{number}")

    def assert_as_one_machine(self, **wanted):
        self.assert_counts(self.build("--store", self.store), **(wanted or {"built": IMAGES, "traced": 0, "developed": 0}))
        one = self.folder / "one"
        self.build(out=one)
        self.assertEqual(self.contents(), self.contents(one))
        self.assertEqual(self.run_it("store", "verify", self.store, "--json").code, 0)

    def test_two_stores_are_one(self):
        self.two_machines()
        before = {store: self.files(store) for store in (self.a, self.b)}
        taken = [self.gather(store).json for store in (self.a, self.b)]
        self.assertEqual(sum(one["records"]["files"] for one in taken), IMAGES)
        self.assertEqual(sum(one["objects"]["files"] for one in taken), len(self.files(self.store, ["objects"])))
        self.assertEqual(self.files(self.store), sorted(set(before[self.a]) | set(before[self.b])))
        again = self.gather(self.a).json
        self.assertEqual((again["records"]["files"], again["objects"]["files"]), (0, 0))
        self.assertEqual(again["there"]["files"], len(before[self.a]))
        self.assertEqual({store: self.files(store) for store in before}, before)
        self.assert_as_one_machine()

    def test_into_a_store_that_has_a_database(self):
        self.build("--set", "engine.spp=2", "--store", self.store)
        self.two_machines()
        # A dataset's folder stands for its store.
        for number in (1, 2):
            self.gather(self.folder / f"out-{number}", to=self.out)
        self.assert_as_one_machine()

    def test_what_is_damaged_is_not_taken(self):
        self.two_machines()
        victim = self.a / self.files(self.a, ["objects"])[0]
        data = victim.read_bytes()
        victim.chmod(0o644)
        victim.write_bytes(bytes([data[0] ^ 1]) + data[1:])
        run = self.gather(self.a, code=1)
        self.assertEqual((run.json["faults"], run.json["missing"]), (1, 0))
        self.assertIn(f"{victim}: is damaged; not taken", run.err)
        self.assertTrue(victim.exists())
        self.gather(self.b)
        self.assertFalse((self.store / victim.relative_to(self.a)).exists())
        counts = self.build("--store", self.store)
        self.assertIn((counts["traced"], counts["developed"]), [(1, 0), (1, 1), (0, 1), (0, 0)])
        one = self.folder / "one"
        self.build(out=one)
        self.assertEqual(self.contents(), self.contents(one))

    def test_killed_at_any_moment(self):
        self.build("--store", self.a)
        wanted, partly = self.files(self.a), 0
        begin = time.monotonic()
        self.gather(self.a)
        seconds = time.monotonic() - begin
        shutil.rmtree(self.store)
        for kill in range(KILLS):
            process = self.start("store", "gather", self.a, self.store)
            time.sleep(seconds * (0.2 + 0.9 * kill / KILLS))
            process.kill()
            process.communicate(timeout=60)
            partly += self.store.exists() and self.files(self.store) != wanted
            if (self.store / "objects").exists():
                self.assertEqual(self.run_it("store", "verify", self.store, "--json").code, 0)
            self.gather(self.a)
            self.assertEqual(self.files(self.store), wanted)
            if kill + 1 < KILLS:
                shutil.rmtree(self.store)
        print(f"{partly} of {KILLS} kills came in the middle")
        self.assert_as_one_machine()

    def test_told_to_stop_at_any_moment(self):
        self.build("--store", self.a)
        wanted, told = self.files(self.a), 0
        begin = time.monotonic()
        self.gather(self.a)
        seconds = time.monotonic() - begin
        for number in range(KILLS):
            shutil.rmtree(self.store)
            stop = (signal.SIGTERM, signal.SIGINT, signal.SIGUSR1)[number % 3]
            process = self.start("store", "gather", self.a, self.store)
            time.sleep(seconds * (0.2 + 0.9 * number / KILLS))
            process.send_signal(stop)
            process.communicate(timeout=60)
            self.assertIn(process.returncode, (0, -stop))
            told += process.returncode != 0
            self.gather(self.a)
            self.assertEqual(self.files(self.store), wanted)
        self.assertGreater(told, 0)
        self.assert_as_one_machine()

    def test_several_at_once(self):
        self.two_machines()
        processes = [self.start("store", "gather", store, self.store, "--json") for store in (self.a, self.b) * 3]
        for process in processes:
            err = process.communicate(timeout=120)[1]
            self.assertEqual(process.returncode, 0, err)
        self.assert_as_one_machine()

    def test_wrong_usage(self):
        self.two_machines()
        (self.folder / "full").mkdir()
        (self.folder / "full/notes.txt").write_text("mine")
        for words, said in ((["gather", self.a], "wanted the store that takes it, too"),
                            (["gather", self.a, self.a], "wanted two stores"),
                            (["gather", self.a, self.store, "-n"], "--dry-run is for gc and verify"),
                            (["gather", self.a, self.folder / "full"], "full"),
                            (["gather", self.folder / "none", self.store], "none"),
                            (["gahter", self.a, self.store], "did you mean gather?"),
                            (["verify", self.a, "--forget"], "--forget is for gc"),
                            (["stats", self.a, "-n"], "--dry-run is for gc and verify"),
                            (["stats", self.a, self.b], "a second store and --database are for gather"),
                            (["verify", self.a, "--database", self.b], "a second store and --database are for gather")):
            run = self.run_it("store", *words)
            self.assertEqual(run.code, 2, run)
            self.assertIn(said, run.err)
        self.assertFalse(self.store.exists())


class NoFilesTest(TinyCase):
    def test_fills_the_store_only(self):
        store = self.folder / "store"
        here = ["--store", store, "--no-files"]
        passing = self.folder / "passing"
        counts = [self.build(*here, "--shard", f"{number}/2", out=passing) for number in (1, 2)]
        self.assertEqual((sum(one["built"] for one in counts), sum(one["traced"] for one in counts)), (IMAGES, IMAGES))
        self.assertEqual(list(passing.iterdir()), [passing / ".dsbuild"])
        self.assert_counts(self.build(*here, out=passing), built=0, reused=IMAGES, traced=0)
        self.assert_counts(self.build(*here, "-n", out=passing), stale=0)
        self.assertEqual(list(passing.iterdir()), [passing / ".dsbuild"])
        self.assert_counts(self.build("--store", store), built=IMAGES, traced=0)
        self.build(out=self.folder / "one")
        self.assertEqual(self.contents(), self.contents(self.folder / "one"))

    def test_leaves_a_dataset_as_it_is(self):
        self.build()
        before = self.contents()
        self.edit("materials/red.mat", "kd = 0.7 0.1 0.1", "kd = 0.6 0.1 0.1")
        counts = self.build("--no-files")
        self.assertGreater(counts["traced"], 0)
        self.assertEqual(self.contents(), before)
        self.assert_counts(self.build(), traced=0, built=counts["built"])
        self.assertNotEqual(self.contents(), before)

    def test_wrong_usage(self):
        run = self.run_it("build", self.recipe, "-o", self.out, "--no-files", "--copy")
        self.assertEqual((run.code, len(run.err.splitlines())), (2, 1), run)
        self.assertFalse(self.out.exists())


if __name__ == "__main__":
    main()
