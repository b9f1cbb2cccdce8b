# SPDX-License-Identifier: Apache-2.0
"""dsbuild store stats|gc|verify, and dsbuild clean: what datasets name stays, whatever is killed."""
import hashlib
import json
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
        self.assertEqual(self.task("gc", "--older", "1h")["objects"]["files"], 0)
        dry = self.task("gc", "--dry-run")
        self.assertEqual((dry["objects"]["files"], dry["records"]["files"]), (2 * IMAGES, IMAGES))
        self.assertEqual(self.files("objects") | self.files("records"), wanted | left_over)
        done = self.task("gc")
        self.assertGreater(done["database_left"], 0)
        self.assertEqual({**done, "dry_run": True, "database_left": None}, dry)
        self.assertEqual(self.files("objects") | self.files("records"), wanted)
        self.assertEqual(self.contents(self.folder / "a"), before)
        self.assert_nothing_to_do("a")
        # Placed anew from what is left.
        shutil.rmtree(self.folder / "a/images")
        self.assert_counts(self.make("a"), built=IMAGES, traced=0)
        self.assertEqual(self.task("verify"), {"files": len(wanted), "damaged": 0, "not_removed": 0, "restored": 0, "missing": 0})
        # What went is traced again.
        self.assert_counts(self.make("a", "--set", "engine.spp=2"), traced=IMAGES)

    def test_what_gc_took_is_not_missed_by_who_gathers(self):
        self.make("a")
        self.make("a", "--set", "engine.spp=2")
        older = self.folder / "older"
        shutil.copytree(self.store, older)
        done = self.task("gc")
        self.assertEqual((done["objects"]["files"], done["lines"]), (2 * IMAGES, 2 * IMAGES), "the masks are those of both")
        found = self.task("gather", self.folder / "other")
        self.assertEqual((found["missing"], found["faults"]), (0, 0))
        # An older dsbuild left the lines of what it took.
        left = {path.name for path in self.files("objects")}
        self.store = older
        for path in self.files("objects"):
            if path.name not in left:
                path.unlink()
        found = self.task("gather", self.folder / "other")
        self.assertEqual((found["missing"], found["faults"]), (2 * IMAGES, 0))
        self.store = self.folder / "other"
        self.assert_counts(self.make("b", "--set", "engine.spp=2"), built=IMAGES, traced=0)
        self.assertEqual(self.contents(self.folder / "b"), self.contents(self.folder / "a"))
        self.assert_counts(self.make("b"), built=IMAGES, traced=IMAGES)

    def test_oldest_first_down_to_a_size(self):
        self.make("a", "--set", "engine.spp=2")
        old = self.files("objects") | self.files("records")
        self.make("a", "--set", "engine.spp=3")
        middle = (self.files("objects") | self.files("records")) - old
        self.make("a")
        for path in old:
            os.utime(path, (1_000_000, 1_000_000))
        size = sum(path.stat().st_size for path in self.files("objects") | self.files("records"))
        database = (self.store / "dsbuild.sqlite").stat().st_size
        gone = sum(path.stat().st_size for path in old) // 2
        result = self.task("gc", "--size", size + database - gone)
        self.assertLessEqual(result["kept"]["bytes"] + result["database_left"], size + database - gone)
        self.assertEqual(result["database_left"], (self.store / "dsbuild.sqlite").stat().st_size)
        self.assertTrue(all(path.exists() for path in middle))
        self.assertLess(len([path for path in old if path.exists()]), len(old))
        run = self.run_it("store", "gc", self.store, "--size", "1k")
        self.assertIn("takes more than --size 1k", run.err)
        self.assert_nothing_to_do("a")

    def rows(self, table, columns, store=None):
        with sqlite3.connect(f"file:{(store or self.store) / 'dsbuild.sqlite'}?mode=ro", uri=True) as database:
            return set(database.execute(f"SELECT {columns} FROM {table}"))

    def test_the_database_counts_and_shrinks(self):
        self.make("a")
        file = self.store / "dsbuild.sqlite"
        self.assertEqual(self.task("stats")["database"], {"bytes": file.stat().st_size, "free": 0})
        for spp in range(2, 8):
            self.make(f"b{spp}", "--set", f"engine.spp={spp}", "--set", "outputs.mask=false")
            shutil.rmtree(self.folder / f"b{spp}")
        large = file.stat().st_size
        dry = self.task("gc", "--forget", "-n")
        self.assertEqual((dry["database"], file.stat().st_size), (large, large))
        done = self.task("gc", "--forget")
        self.assertEqual(done["database_left"], file.stat().st_size)
        self.assertLess(file.stat().st_size, large)
        self.assertEqual(self.task("stats")["database"], {"bytes": file.stat().st_size, "free": 0})
        self.assert_nothing_to_do("a")
        # What is left is what a store has that never had the others.
        self.build("--store", self.folder / "fresh", out=self.folder / "c")
        for table, columns in (("text", "*"), ("product", "key, object"), ("image", "id, model, engine, files")):
            self.assertEqual(self.rows(table, columns), self.rows(table, columns, self.folder / "fresh"), table)

    def test_dead_lines_of_records_go(self):
        self.make("a")
        other = ["--set", "outputs.tone_map=linear", "--set", "outputs.tone_map_scale=0.5"]
        self.make("a", *other)  # the same films and masks, other pictures
        lines = sum(len(path.read_text().splitlines()) for path in self.files("records"))
        dry = self.task("gc", "-n")
        done = self.task("gc")
        self.assertEqual((dry["lines"], done["lines"], done["records"]["files"]), (IMAGES, IMAGES, 0))
        self.assertEqual(done["kept"]["bytes"], sum(path.stat().st_size for path in self.files("objects") | self.files("records")))
        records = [json.loads(line) for path in self.files("records") for line in path.read_text().splitlines()]
        self.assertEqual(len(records), lines - IMAGES)
        for record in records:
            self.assertTrue((self.store / "objects" / record["object"][:2] / record["object"][2:]).exists(), record)
        self.assertEqual(self.task("verify")["damaged"], 0)
        self.assertEqual(self.task("gc")["lines"], 0)
        # They still are enough where the database is lost.
        for path in self.store.glob("dsbuild.sqlite*"):
            path.unlink()
        self.assert_counts(self.make("a", *other), traced=0, developed=0)
        self.assertEqual(self.task("stats")["unnamed"]["files"], 0)

    def test_what_a_build_is_at_is_its(self):
        self.make("a")
        other = self.folder / "other"
        self.build("--store", other, "--set", "engine.spp=3", out=self.folder / "b")
        mine = {path.name for path in self.files("objects")}
        old, new = [path for path in sorted(other.glob("objects/*/*")) if path.name not in mine][:2]

        def put(path):
            to = self.store / "objects" / path.parent.name / path.name
            to.parent.mkdir(exist_ok=True)
            shutil.copy(path, to)
            return to

        os.utime(put(old), (1_000_000_000, 1_000_000_000))
        build = self.start("build", self.recipe, "-o", self.folder / "a", "--store", self.store, "--set", "engine.spp=1000000")
        self.addCleanup(build.kill)
        deadline = time.monotonic() + 60
        while not self.running():
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.02)
        put(new)  # as what a build writes before it tells the database
        found = self.task("stats")
        self.assertEqual((found["unnamed"]["files"], found["being_made"]["files"], len(found["running"])), (1, 1, 1))
        self.assertRegex(found["running"][0], r"^process \d+ on .*, which builds tiny$")
        run = self.run_it("store", "stats", self.store)
        self.assertRegex(run.out, r"  at work: process \d+ on .*, which builds tiny\n  written since, and named by no dataset yet: 1 files, ")
        dry = self.task("gc", "-n")
        self.assertEqual((dry["objects"]["files"], dry["being_made"]["files"], dry["running"]), (1, 1, found["running"]))
        build.kill()
        build.communicate(timeout=60)
        deadline = time.monotonic() + 60
        while self.task("stats")["running"]:  # its other process goes, too
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.05)
        found = self.task("stats")
        self.assertEqual((found["unnamed"]["files"], found["being_made"]["files"]), (2, 0))
        # One that has its database elsewhere is at work, too.
        (self.store / "guests").mkdir(exist_ok=True)
        (self.store / "guests/elsewhere.17").write_text("build it")
        os.utime(self.store / "guests/elsewhere.17", (time.time() - 3600, time.time() - 3600))
        found = self.task("stats")
        self.assertEqual(found["running"], ["process 17 on elsewhere, which has its database elsewhere (build it)"])
        self.assertEqual((found["unnamed"]["files"], found["being_made"]["files"]), (1, 1))

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
        self.assertEqual((found["damaged"], found["not_removed"], found["missing"]), (1, 0, 0))
        self.assertEqual(self.task("verify")["damaged"], 0)

    def test_verify_puts_back_what_folders_have(self):
        self.make("a", "--copy")
        out = self.folder / "a"
        masks = {}  # views may have the same
        for path in sorted((out / "images").rglob("*.mask.png")):
            masks.setdefault(hashlib.sha256(path.read_bytes()).hexdigest(), []).append(path)
        for victim in self.files("objects"):
            if hashlib.sha256(victim.read_bytes()).hexdigest() in masks:
                victim.unlink()
        lost = len(masks)
        # To a build the folder's files are up to date, so it makes nothing.
        self.assert_nothing_to_do("a")
        self.assertEqual(self.task("verify", "-n", code=1)["missing"], lost)
        run = self.run_it("store", "verify", self.store, "-n")
        self.assertIn("store verify without -n puts back what datasets' folders have of them", run.out)
        edited = sorted(masks.values())[0]
        whole = edited[0].read_bytes()
        for path in edited:
            path.write_bytes(whole + b"mine")
        run = self.run_it("store", "verify", self.store)
        self.assertEqual(run.code, 1, run)
        self.assertIn(f"{lost - 1} objects put back from datasets' folders; 1 objects that datasets name are missing; dsbuild build of "
                      "their datasets, which lack them, too, makes them again", run.out)
        found = self.task("verify", code=1)
        self.assertEqual((found["restored"], found["missing"]), (0, 1))
        # As it says: the build makes that one again, for the store and the folder.
        self.assert_counts(self.make("a"), built=len(edited), reused=IMAGES - len(edited), edited_files=len(edited))
        self.assertEqual({path.read_bytes() for path in edited}, {whole})
        self.assertEqual(self.task("verify")["missing"], 0)
        shutil.rmtree(out / "images")
        self.assert_counts(self.make("a"), built=IMAGES, traced=0)

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
        dry = self.run_it("store", "gc", self.store, "-n")
        self.assertEqual(dry.code, 0, dry)
        self.assertIn("gc would wait for what has the store open, and may then find more that is named", dry.err)
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
        for also in ([], ["-n"]):
            run = self.run_it("store", "gc", self.store, *also)
            self.assertEqual(run.code, 2, run)
            self.assertRegex(run.err, r"process \d+ on .* works in it with a database of its own \(build .*recipe.toml\)")
        self.assertGreaterEqual(len(self.files("records")), before)
        build.send_signal(signal.SIGINT)
        build.communicate(timeout=60)
        self.assertEqual(list(guests.iterdir()), [])
        # Killed on this machine, it is known to be gone; on another, nobody can tell.
        host = os.uname().nodename
        (guests / f"{host}.{self.dead_process()}").write_text("build it")
        self.task("gc", "-n")
        self.assertEqual(len(list(guests.iterdir())), 1, "who only looks removes nothing")
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
        self.assertIn(f"'{self.recipe}': builds of a part (--shard, --no-files), which a build of all images is to place\n", run.out)
        self.assertEqual(self.task("stats")["parts"], [f"'{self.recipe}'"])
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

    def test_gc_leaves_what_builds_of_a_part_made(self):
        """With databases of their own, as on other machines, or none; in a store that knows another dataset."""
        self.make("other", "--set", "engine.spp=2")
        spp = ["--set", "engine.spp=3"]
        for own in (["--database", self.folder / "db"], []):
            for number in (1, 2):
                self.make("passing", *spp, *own, "--no-files", "--shard", f"{number}/2")
            before = self.files("objects") | self.files("records")
            for also in ([], ["-n"]):
                run = self.run_it("store", "gc", self.store, *also)
                self.assertEqual((run.code, len(run.err.splitlines())), (2, 1), run)
                self.assertIn(f"builds of a part (--shard, --no-files) of the recipe '{self.recipe}' --set 'engine.spp=3' made things "
                              "here that no build has placed yet", run.err)
            self.assertEqual(self.files("objects") | self.files("records"), before)
            # Another whole build is not the one that places them.
            self.make("other", "--set", "engine.spp=2")
            self.assertEqual(self.run_it("store", "gc", self.store).code, 2)
            self.assert_counts(self.make("a", *spp), built=IMAGES, traced=0, developed=0)
            self.assertEqual(self.task("gc")["objects"]["files"], 0)
            self.assertFalse((self.store / "filled").exists())
            shutil.rmtree(self.folder / "a")
            self.task("gc", "--forget")
        self.make("passing", *spp, "--no-files")
        note = list((self.store / "parts").iterdir())
        self.assertIn(f"or remove {note[0]} to give them up", self.run_it("store", "gc", self.store).err)
        note[0].unlink()
        self.assertGreater(self.task("gc", "--forget")["objects"]["files"], 0)

    def test_what_is_not_there(self):
        (self.folder / "empty").mkdir()
        for what in ("stats", "gc", "verify", "gather"):
            to = ["mine"] if what == "gather" else []
            for target, found in (("nowhere", "nothing at nowhere"), ("empty", "the folder empty, which is neither"),
                                  (self.recipe, f"the recipe {self.recipe}, of which nothing is built in {self.folder}/out/tiny")):
                run = self.run_it("store", what, target, *to)
                self.assertEqual((run.code, run.err), (2, f"dsbuild: error: store {what}: wanted a store, or a dataset that has one, "
                                                          f"found {found}\n"))
        self.make("a")
        (self.folder / "empty/file").write_text("mine")
        run = self.run_it("store", "gather", self.store, "empty")
        self.assertEqual((run.code, run.err), (2, "dsbuild: error: store gather: wanted a store, or a dataset that has one, found the "
                                                  f"folder {self.folder}/empty, which is neither\n"))
        self.assertIn("nowhere: must be a recipe or the folder of a dataset, found no file", self.run_it("status", "nowhere").err)

    def test_a_build_from_a_store_that_may_not_be_written_to(self):
        self.make("a")
        self.mount_read_only()
        before = {path: path.read_bytes() for path in self.store.rglob("*") if path.is_file()}
        out = self.folder / "b"
        for more in ([], ["--database", self.folder / "db"]):
            self.assert_counts(self.make("b", *more), built=IMAGES, traced=0, developed=0)
            self.assertEqual(self.contents(out), self.contents(self.folder / "a"))
            # It is a dataset as any other, which its verbs know.
            self.assert_nothing_to_do("b", *more)
            status = self.run_it("status", out, *more, "--json").json
            self.assertEqual((status["up_to_date"], status["builds"]), (IMAGES, 2))
            self.assertEqual(self.run_it("verify", out, *more).code, 0)
            (out / "images/box.off/0.png").unlink()
            self.assert_counts(self.make("b", *more), built=1, reused=IMAGES - 1, traced=0)
            shutil.rmtree(out)
        self.make("b")
        self.assertEqual(self.run_it("clean", out).code, 0)
        self.assert_counts(self.make("b"), built=IMAGES, traced=0)
        self.assertEqual({path: path.read_bytes() for path in self.store.rglob("*") if path.is_file()}, before)
        # What it has not cannot be made, and is not begun.
        run = self.run_it("build", self.recipe, "-o", out, "--store", self.store, "--set", "engine.spp=2")
        self.assertEqual((run.code, len(run.err.splitlines())), (1, 1), run)
        self.assertIn(f"{self.store}: cannot write there: Read-only file system; of {IMAGES} of {IMAGES} images it has not all", run.err)
        self.assertIn(f"dsbuild store gather {self.store} MINE takes what it has into one of your own", run.err)
        mine = self.folder / "mine"
        self.assertEqual(self.run_it("store", "gather", self.store, mine).code, 0)
        run = self.run_it("build", self.recipe, "-o", self.folder / "c", "--store", mine, "--json")
        self.assert_counts(run.json, built=IMAGES, traced=0)
        # A dataset's own store is one that it cannot do without.
        self.build(out=self.folder / "d")
        self.store = self.folder / "d/.dsbuild"
        self.mount_read_only()
        run = self.run_it("build", self.recipe, "-o", self.folder / "d")
        self.assertEqual(run.code, 1, run)
        self.assertIn("cannot write there: Read-only file system; a build keeps there what it makes", run.err)

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
