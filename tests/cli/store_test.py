# SPDX-License-Identifier: Apache-2.0
"""dsbuild store stats|gc|verify, and dsbuild clean: what datasets name stays, whatever is killed."""
import os
import shutil
import signal
import sqlite3
import subprocess
import time

from harness import IMAGES, TinyCase, main

KILLS = int(os.environ.get("DSBUILD_TEST_KILLS", "8"))


class StoreTest(TinyCase):
    def setUp(self):
        super().setUp()
        self.store = self.folder / "store"

    def make(self, out, *arguments, **options):
        return self.build("--store", self.store, *arguments, out=self.folder / out, **options)

    def task(self, what, *arguments, code=0):
        run = self.run_it("store", what, self.store, "--json", *arguments)
        self.assertEqual(run.code, code, run)
        return run.json

    def files(self, kind):
        return {path for path in (self.store / kind).rglob("*") if path.is_file()}

    def assert_nothing_to_do(self, out, *arguments):
        self.assert_counts(self.make(out, *arguments), built=0, reused=IMAGES, traced=0)

    def mount_read_only(self):
        for words in (["--bind", self.store], ["-o", "remount,bind,ro"]):
            done = subprocess.run(["mount", *words, self.store], capture_output=True, text=True, check=False)
            if done.returncode != 0:
                self.skipTest(f"cannot mount here: {done.stderr.strip()}")
            if words[0] == "--bind":
                self.addCleanup(subprocess.run, ["umount", self.store], check=True)

    def test_what_no_dataset_names_goes(self):
        self.make("a")
        wanted = self.files("objects") | self.files("records")
        before = self.contents(self.folder / "a")
        self.make("a", "--set", "engine.spp=2")
        self.make("a")  # back again: the other samples' films and pictures are left over
        found = self.task("stats")
        self.assertEqual([(d["name"], d["images"], d["gone"]) for d in found["datasets"]], [("tiny", IMAGES, False)])
        left_over = (self.files("objects") | self.files("records")) - wanted
        self.assertEqual(found["unnamed"], {"files": len(left_over), "bytes": sum(p.stat().st_size for p in left_over)})
        self.assertEqual(len(left_over), 3 * IMAGES, "film, picture and record of each; the mask is that of both")
        dry = self.task("gc", "--dry-run")
        self.assertEqual((dry["objects"]["files"], dry["records"]["files"]), (2 * IMAGES, IMAGES))
        self.assertEqual(self.files("objects") | self.files("records"), wanted | left_over)
        self.assertEqual(self.task("gc", "--older", "1h")["objects"]["files"], 0)
        self.assertEqual({**self.task("gc"), "dry_run": True}, dry)
        self.assertEqual(self.files("objects") | self.files("records"), wanted)
        self.assertEqual(self.contents(self.folder / "a"), before)
        self.assert_nothing_to_do("a")
        # Placed anew from what is left.
        shutil.rmtree(self.folder / "a/images")
        self.assert_counts(self.make("a"), built=IMAGES, traced=0)
        self.assertEqual(self.task("verify"), {"files": len(wanted), "damaged": 0, "not_removed": 0, "missing": 0})
        # What went is traced again.
        self.assert_counts(self.make("a", "--set", "engine.spp=2"), traced=IMAGES)

    def test_oldest_first_down_to_a_size(self):
        self.make("a", "--set", "engine.spp=2")
        old = self.files("objects") | self.files("records")
        self.make("a", "--set", "engine.spp=3")
        middle = (self.files("objects") | self.files("records")) - old
        self.make("a")
        for path in old:
            os.utime(path, (1_000_000, 1_000_000))
        size = sum(path.stat().st_size for path in self.files("objects") | self.files("records"))
        gone = sum(path.stat().st_size for path in old) // 2
        result = self.task("gc", "--size", size - gone)
        self.assertLessEqual(result["kept"]["bytes"], size - gone)
        self.assertTrue(all(path.exists() for path in middle))
        self.assertLess(len([path for path in old if path.exists()]), len(old))
        run = self.run_it("store", "gc", self.store, "--size", "1k")
        self.assertIn("takes more than --size 1k", run.err)
        self.assert_nothing_to_do("a")

    def test_a_dataset_that_is_gone_is_forgotten_when_asked(self):
        self.make("a")
        self.make("b", "--set", "engine.spp=2")
        of_b = self.task("stats")["objects"]["files"]
        shutil.rmtree(self.folder / "a")
        self.assertEqual([d["gone"] for d in self.task("stats")["datasets"]], [True, False])
        run = self.run_it("store", "gc", self.store)
        self.assertIn("a: nothing of the dataset tiny lies there any more; --forget", run.err)
        self.assertEqual(self.task("stats")["objects"]["files"], of_b, "not without being asked")
        result = self.task("gc", "--forget")
        self.assertEqual((result["forgotten"], result["objects"]["files"]), (1, 2 * IMAGES))
        self.assertEqual(len(self.task("stats")["datasets"]), 1)
        self.assert_nothing_to_do("b", "--set", "engine.spp=2")
        # One that was moved is not gone once it has been built where it is.
        (self.folder / "b").rename(self.folder / "c")
        self.assert_nothing_to_do("c", "--set", "engine.spp=2", "--adopt")
        self.assertEqual(self.task("gc", "--forget")["objects"]["files"], 0)

    def test_a_lost_database_costs_nothing(self):
        self.make("a")
        for path in self.store.glob("dsbuild.sqlite*"):
            path.unlink()
        before = self.files("objects")
        run = self.run_it("store", "gc", self.store)
        self.assertEqual(run.code, 2, run)
        self.assertIn("build it once, then collect", run.err)
        self.assertEqual(self.files("objects"), before)
        self.assert_counts(self.make("a"), traced=0)
        self.assertEqual(self.task("gc")["objects"]["files"], 0)

    def test_verify_removes_what_is_damaged(self):
        self.make("a", "--copy")
        victim = sorted(self.files("objects"))[0]
        data = victim.read_bytes()
        victim.chmod(0o644)
        victim.write_bytes(bytes([data[0] ^ 1]) + data[1:])
        looked = self.task("verify", "-n", code=1)
        self.assertEqual((looked["damaged"], looked["not_removed"], victim.exists()), (1, 1, True))
        found = self.task("verify", code=1)
        self.assertEqual((found["damaged"], victim.exists()), (1, False))
        self.assertEqual(self.task("verify", code=1)["damaged"] if found["missing"] else 0, 0)
        shutil.rmtree(self.folder / "a/images")
        self.make("a")
        self.task("verify")

    def test_verify_of_a_store_that_may_not_be_written_to(self):
        self.make("a", "--copy")
        victims = sorted(self.files("objects"))[:2] + sorted(self.files("records"))[:1]
        for victim in victims:
            data = victim.read_bytes()
            victim.chmod(0o644)
            victim.write_bytes(bytes([data[0] ^ 1]) + data[1:])
        self.mount_read_only()
        run = self.run_it("store", "verify", self.store, "--json")
        self.assertEqual((run.code, run.json["damaged"], run.json["not_removed"]), (1, 3, 3), run)
        for victim in victims:
            self.assertIn(f"{victim}: a file of the store is damaged, and stays: ", run.err)
        self.assertIn("3 damaged (3 of them could not be removed)", self.run_it("store", "verify", self.store).out)

    def test_gc_waits_for_a_build(self):
        self.make("a", "--set", "engine.spp=2")
        build = self.start("build", self.recipe, "-o", self.folder / "a", "--store", self.store,
                           "--set", "engine.spp=20000")
        deadline = time.monotonic() + 60
        while self.task("stats")["objects"]["files"] == 0 or not self.running():
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.02)
        collector = self.start("store", "gc", self.store)
        time.sleep(0.5)
        self.assertIsNone(collector.poll(), "it waits")
        build.send_signal(signal.SIGINT)
        build.communicate(timeout=60)
        out, err = collector.communicate(timeout=60)
        self.assertEqual(collector.returncode, 0, err)
        self.assertIn("waits for what has the store open", err)
        self.make("a", "--set", "engine.spp=2")
        self.task("verify")

    def test_gc_and_builds_with_a_database_of_their_own_know_of_each_other(self):
        guests = self.store / "guests"
        self.make("a", "--set", "engine.spp=2")
        words = ("build", self.recipe, "-o", self.folder / "a", "--store", self.store, "--database", self.folder / "db")
        build = self.start(*words, "--set", "engine.spp=20000")
        self.addCleanup(build.kill)
        records, deadline = len(self.files("records")), time.monotonic() + 60
        while len(self.files("records")) < records + 2:
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.02)
        before = len(self.files("records"))
        run = self.run_it("store", "gc", self.store)
        self.assertEqual(run.code, 2, run)
        self.assertRegex(run.err, r"process \d+ on .* works in it with a database of its own \(build .*recipe.toml\)")
        self.assertGreaterEqual(len(self.files("records")), before)
        self.assertEqual(self.run_it("store", "gc", "-n", self.store).code, 0, "that removes nothing")
        build.send_signal(signal.SIGINT)
        build.communicate(timeout=60)
        self.assertEqual(list(guests.iterdir()), [])
        # Killed on this machine, it is known to be gone; on another, nobody can tell.
        host = os.uname().nodename
        (guests / f"{host}.{self.dead_process()}").write_text("build it")
        self.task("gc")
        self.assertEqual(list(guests.iterdir()), [])
        (guests / "elsewhere.17").write_text("build it")
        run = self.run_it("store", "gc", self.store)
        self.assertEqual(run.code, 2, run)
        self.assertIn(f"process 17 on elsewhere works in it with a database of its own (build it)", run.err)
        self.assertIn(f"remove {guests / 'elsewhere.17'} if it has", run.err)
        (guests / "elsewhere.17").unlink()
        # A build waits for a collection.
        (guests / f"{host}.{os.getpid()}").write_text("gc")
        build = self.start(*words)
        self.addCleanup(build.kill)
        time.sleep(1)
        self.assertIsNone(build.poll())
        (guests / f"{host}.{os.getpid()}").unlink()
        err = build.communicate(timeout=120)[1]
        self.assertEqual(build.returncode, 0, err)
        self.assertIn(f"waits for dsbuild store gc, process {os.getpid()} on {host}", err)
        self.task("gc")
        self.task("verify")

    def dead_process(self):
        with subprocess.Popen(["true"]) as process:
            process.wait()
        return process.pid

    def test_stats_tells_of_datasets_with_a_database_elsewhere(self):
        self.make("a", "--database", self.folder / "db", "--shard", "1/2")
        run = self.run_it("store", "stats", self.store)
        self.assertIn("it knows no dataset: what builds of a part made with --database", run.out)
        # Before its end, when it leaves a copy in the store.
        build = self.start("build", self.recipe, "-o", self.folder / "a", "--store", self.store, "--database",
                           self.folder / "db", "--set", "engine.spp=20000")
        self.addCleanup(build.kill)
        while not list(self.store.glob("datasets/[0-9a-f]*")):
            time.sleep(0.01)
        build.kill()
        build.communicate(timeout=60)
        run = self.run_it("store", "stats", self.store)
        self.assertIn(f"{self.folder / 'a'}: a dataset whose builds keep their database elsewhere (--database)", run.out)
        self.assertIn("no dataset that is known names: ", run.out)
        self.assertEqual(self.task("stats")["elsewhere"], [str(self.folder / "a")])
        self.make("a")
        self.assertEqual(self.task("stats")["elsewhere"], [])

    def test_a_build_from_a_store_that_may_not_be_written_to_says_what_to_do(self):
        self.make("a")
        self.mount_read_only()
        run = self.run_it("build", self.recipe, "-o", self.folder / "b", "--store", self.store)
        self.assertEqual(run.code, 1, run)
        self.assertIn(f"{self.store}: cannot write there: Read-only file system; ", run.err)
        self.assertIn(f"dsbuild store gather {self.store} MINE takes what it has into one of your own", run.err)
        mine = self.folder / "mine"
        self.assertEqual(self.run_it("store", "gather", self.store, mine).code, 0)
        run = self.run_it("build", self.recipe, "-o", self.folder / "b", "--store", mine, "--json")
        self.assert_counts(run.json, built=IMAGES, traced=0)

    def running(self):
        with sqlite3.connect(f"file:{self.store / 'dsbuild.sqlite'}?mode=ro", uri=True) as database:
            return database.execute("SELECT count(*) FROM build WHERE outcome = 'running'").fetchone()[0]

    def test_killed_at_any_moment_it_leaves_a_whole_store(self):
        self.make("a")
        wanted, seconds, partly = self.contents(self.folder / "a"), 0, 0
        for kill in range(-1, KILLS):
            self.make("a", "--set", f"engine.spp={2 + kill % 3}")
            self.make("a")
            before = self.files("objects") | self.files("records")
            begin = time.monotonic()
            collector = self.start("store", "gc", self.store)
            if kill >= 0:  # the first is measured
                time.sleep(seconds * (0.3 + 0.8 * kill / KILLS))
                collector.kill()
            collector.communicate(timeout=60)
            if kill < 0:
                seconds = time.monotonic() - begin
            left = self.files("objects") | self.files("records")
            self.assertLessEqual(left, before)
            partly += len(before) > len(left) and self.task("gc", "-n")["objects"]["files"] > 0
            self.assert_nothing_to_do("a")
            self.assertEqual(self.contents(self.folder / "a"), wanted)
            self.task("verify")
            if kill % 2:  # every other one is killed again in what the one before left
                self.task("gc")
        print(f"{partly} of {KILLS} kills came in the middle")
        self.task("gc")
        self.assertEqual(self.task("stats")["unnamed"]["files"], 0, "the next run finds what is left")

    def test_clean(self):
        self.make("a")
        out = self.folder / "a"
        before = self.contents(out)
        (out / "notes.txt").write_text("mine")
        edited = out / "images/box.off/0.png"
        data = edited.read_bytes()
        edited.unlink()
        edited.write_bytes(data + b"more")
        count = self.run_it("clean", out, "--dry-run", "--json").json
        self.assertEqual(self.contents(out).keys() - {"notes.txt"}, before.keys())
        run = self.run_it("clean", out, "--json")
        self.assertEqual(run.code, 0, run)
        self.assertEqual({**run.json, "dry_run": True}, count)
        self.assertEqual(run.json["edited"], ["images/box.off/0.png"])
        self.assertIn("left, since no build wrote what it holds now", run.err)
        self.assertEqual(set(self.contents(out)), {"notes.txt", "images/box.off/0.png"})
        edited.unlink()
        self.assert_counts(self.make("a"), built=IMAGES, traced=0)
        (out / "notes.txt").unlink()
        self.assertEqual(self.contents(out), before)
        # After it the store may be emptied.
        self.assertEqual(self.run_it("clean", out).code, 0)
        self.task("gc")
        self.assertEqual(self.files("objects"), set())
        self.assert_counts(self.make("a"), traced=IMAGES)
        self.assertEqual(self.contents(out), before)
        run = self.run_it("clean", self.folder / "nowhere")
        self.assertEqual(run.code, 2, run)


if __name__ == "__main__":
    main()
