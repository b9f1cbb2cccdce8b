# SPDX-License-Identifier: Apache-2.0
"""Pipes, folders, damaged and strange files where dsbuild wants files of its own or of the user: nothing hangs, nothing is
passed over in silence, and who only looks removes nothing."""
import hashlib
import os
import shutil
import socket
import subprocess

from harness import IMAGES, Run, TinyCase, main

SECONDS = 120  # of a run: all of them end in less than one


class OddFilesTest(TinyCase):
    def setUp(self):
        super().setUp()
        self.store = self.folder / "store"

    def run_it(self, *arguments, **options):
        return Run(subprocess.run(self.command(*arguments), cwd=self.folder, capture_output=True, text=True,
                                  timeout=SECONDS, check=False, stdin=subprocess.DEVNULL, **options))

    def make(self, *arguments, **options):
        return self.build("--store", self.store, *arguments, **options)

    def files(self, kind):
        return sorted(path for path in (self.store / kind).glob("*/*") if path.is_file())

    def bytes_of_store(self):
        """Of all but its database and locks."""
        return {path.relative_to(self.store): hashlib.sha256(path.read_bytes()).digest()
                for kind in ("objects", "records") for path in (self.store / kind).rglob("*") if path.is_file()}

    def lose_database(self):
        for path in self.store.glob("dsbuild.sqlite*"):
            path.unlink()

    def put_in_place(self, what, path):
        path.unlink()
        if what == "a pipe":
            os.mkfifo(path)
        elif what == "a socket":
            with socket.socket(socket.AF_UNIX) as listener:
                before = os.getcwd()
                os.chdir(path.parent)  # a socket's name is short
                listener.bind(path.name)
                os.chdir(before)
        elif what == "a device":
            path.symlink_to("/dev/zero")
        else:
            path.mkdir()

    def put_back(self, path, data):
        path.unlink()
        path.write_bytes(data)


class StoreTest(OddFilesTest):
    def test_in_an_objects_place(self):
        self.make()
        wanted, objects = self.contents(), len(self.files("objects"))
        for what in ("a pipe", "a socket", "a device", "a folder"):
            victim = self.files("objects")[1]
            self.put_in_place(what, victim)
            said = f"{victim}: wanted a file, found {what}"
            run = self.run_it("store", "gather", self.store, self.folder / what.replace(" ", "-"), "--json")
            self.assertEqual((run.code, run.json["faults"]), (1, 1), run)
            self.assertIn("is damaged; not taken", run.err)
            self.assertEqual(run.json["objects"]["files"], objects - 1)
            shutil.rmtree(self.out / "images")
            # A build mends it, and so does verify.
            for mend in ("build", "verify"):
                if mend == "verify":
                    self.put_in_place(what, victim)
                    run = self.run_it("store", "verify", self.store, "--json")
                    self.assertEqual((run.code, run.json["damaged"], run.json["not_removed"]), (1, 1, 0), run)
                    self.assertIn(said, run.err)
                    self.assertFalse(os.path.lexists(victim))
                self.assert_counts(self.make("--force"), built=IMAGES, failed=0)
                self.assertTrue(victim.is_file() and not victim.is_symlink())
                self.assertEqual(self.contents(), wanted)
        self.assertEqual(self.run_it("store", "verify", self.store).code, 0)

    def test_a_full_folder_in_an_objects_place_is_left_and_said(self):
        self.make()
        victim = self.files("objects")[1]
        self.put_in_place("a folder", victim)
        (victim / "mine.txt").write_text("mine")
        said = f"{victim}: wanted a file, found a folder, and stays (move it away)"
        for _ in range(2):
            run = self.run_it("store", "verify", self.store, "--json")
            self.assertEqual((run.code, run.json["damaged"], run.json["not_removed"]), (1, 1, 1), run)
            self.assertIn(said, run.err)
        run = self.run_it("build", self.recipe, "-o", self.out, "--store", self.store, "--force", "-k", "--json")
        self.assertEqual((run.code, run.json["failed"]), (1, 1), run)
        self.assertIn(said, run.err)
        self.assertEqual((victim / "mine.txt").read_text(), "mine")
        self.run_it("store", "gc", self.store)
        self.assertEqual((victim / "mine.txt").read_text(), "mine", "what is no file of the store's stays")
        victim.rename(self.folder / "away")
        self.assert_counts(self.make(), failed=0)
        self.assertEqual(self.run_it("store", "verify", self.store).code, 0)

    def test_in_a_records_place(self):
        self.make()
        for number, what in enumerate(("a pipe", "a folder")):
            victim = self.files("records")[number]
            kept = victim.read_bytes()
            self.put_in_place(what, victim)
            run = self.run_it("store", "gather", self.store, self.folder / f"to-{number}", "--json")
            self.assertEqual((run.code, run.json["faults"], run.json["records"]["files"]), (1, 1, IMAGES - 1), run)
            self.assertIn(f"{victim}: wanted a file, found {what}; not taken", run.err)
            run = self.run_it("store", "verify", self.store, "--json")
            self.assertEqual((run.code, run.json["damaged"]), (1, 1), run)
            victim.write_bytes(kept)
        # In the place of a folder of records.
        folder = self.files("records")[0].parent
        shutil.rmtree(folder)
        folder.write_text("mine")
        run = self.run_it("store", "gather", self.store, self.folder / "to", "--json")
        self.assertEqual((run.code, run.json["faults"]), (1, 1), run)
        self.assertIn(f"{folder}: wanted a folder, found a file; not taken", run.err)
        run = self.run_it("store", "verify", self.store, "--json")
        self.assertEqual((run.code, run.json["damaged"], run.json["not_removed"]), (1, 1, 1), run)

    def test_who_only_looks_removes_nothing(self):
        self.make()
        records = self.files("records")
        for victim, edit in zip(records, (lambda text: text[:40], lambda text: "{\"newfield\":[1],%s" % text[1:],
                                          lambda text: text.replace("seconds", "days"))):
            victim.chmod(0o644)
            victim.write_text(edit(victim.read_text()))
        victim = self.files("objects")[0]
        victim.chmod(0o644)
        victim.write_bytes(b"damaged")
        before = self.bytes_of_store()
        for words in (("store", "stats", self.store), ("store", "gc", "-n", self.store), ("plan", self.recipe, "-o", self.out),
                      ("status", self.recipe, "-o", self.out), ("build", "-n", self.recipe, "-o", self.out),
                      ("explain", self.recipe, "-o", self.out), ("log", self.out), ("verify", self.out)):
            # A database that is new is filled from the records.
            for lost in (False, True):
                if lost:
                    self.lose_database()
                self.run_it(*words)
                self.assertEqual(self.bytes_of_store(), before, words)
        self.make()
        for victim in records[:3]:
            victim.parent.mkdir(exist_ok=True)
            victim.write_text("damaged")
        run = self.run_it("store", "stats", self.store, "--json")
        self.assertEqual((run.code, run.json["faults"], run.json["unreadable_records"]), (0, 3, 0), run)
        self.assertIn(f"{records[0]}: is damaged (dsbuild store verify)", run.err)
        # gather says so, too, whoever looked before.
        run = self.run_it("store", "gather", self.store, self.folder / "to", "--json")
        self.assertEqual((run.code, run.json["faults"]), (1, 3), run)
        # gc counts what it removes.
        dry = self.run_it("store", "gc", self.store, "--json", "-n").json
        run = self.run_it("store", "gc", self.store, "--json")
        # How large the database is afterwards a dry run does not know.
        self.assertEqual({**run.json, "dry_run": True, "database_left": None}, dry)
        self.assertEqual((run.json["records"]["files"], run.json["faults"]), (3, 3), run)
        self.assertFalse(any(victim.exists() for victim in records[:3]))

    def test_a_newer_dsbuilds_records_stay(self):
        self.make()
        record, newer = self.files("records")[0], self.folder / "newer"
        text = record.read_text()
        if not shutil.which("xxhsum"):
            self.skipTest("xxhsum is not installed")

        def hash_of(path):
            return subprocess.run(["xxhsum", "-H2", path], capture_output=True, text=True, check=True).stdout.split()[0]

        # A record of a form that this program does not know, with an object that nothing else names.
        newer.write_text("something new, of which this program knows nothing")
        hashes = [hash_of(newer)]
        self.enter("objects", hashes[0], newer.read_bytes())
        for edited in ('{"form":2,"made":[{"object":"%s"}]}\n' % hashes[0], text.replace('{"', '{"newfield":[1],"', 1)):
            newer.write_text(edited)
            hashes.append(hash_of(newer))
            self.enter("records", hashes[-1], newer.read_bytes())
        before = self.bytes_of_store()
        run = self.run_it("store", "stats", self.store, "--json")
        self.assertEqual((run.json["faults"], run.json["unreadable_records"]), (0, 1), run)
        run = self.run_it("store", "gc", self.store, "--json")
        self.assertEqual((run.code, run.json["unreadable_records"], run.json["objects"]["files"]), (0, 1, 0), run)
        self.assertIn("1 records of another dsbuild's form", run.err)
        self.assertEqual(self.bytes_of_store(), before)
        self.lose_database()
        run = self.run_it("build", self.recipe, "-o", self.out, "--store", self.store, "--json")
        self.assert_counts(run.json, traced=0, failed=0)
        self.assertIn("1 record of another dsbuild's form, left as it is", run.err)
        self.assertEqual(self.bytes_of_store(), before)

    def enter(self, kind, name, data):
        path = self.store / kind / name[:2] / name[2:]
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)

    def test_gather_mends_what_the_target_has_damaged(self):
        self.make()
        to = self.folder / "to"
        self.assertEqual(self.run_it("store", "gather", self.store, to).code, 0)
        victims = [to / self.files(kind)[0].relative_to(self.store) for kind in ("objects", "records")]
        for victim in victims:
            size = victim.stat().st_size
            victim.chmod(0o644)
            victim.write_bytes(b"x" * size)
        run = self.run_it("store", "gather", self.store, to, "--json")
        self.assertEqual((run.code, run.json["objects"]["files"], run.json["records"]["files"]), (0, 1, 1), run)
        self.assertEqual(self.run_it("store", "verify", to).code, 0)

    def test_files_that_are_not_the_stores_stay(self):
        self.make()
        strangers = [self.store / "objects/notes.txt", self.files("records")[0].parent / "notes.txt"]
        for path in strangers:
            path.write_text("mine")
        run = self.run_it("store", "gc", self.store, "--json")
        self.assertEqual((run.code, run.json["strangers"], run.json["temporaries"]["files"]), (0, 2, 0), run)
        self.assertIn("no file of the store's, left alone, and 1 more", run.err)
        self.assertTrue(all(path.read_text() == "mine" for path in strangers))

    def test_a_folder_that_cannot_be_listed_is_an_error(self):
        if os.geteuid() == 0 and not shutil.which("runuser"):
            self.skipTest("root lists any folder")
        self.make()
        self.folder.chmod(0o755)
        folder = self.files("records")[0].parent
        folder.chmod(0)
        self.addCleanup(folder.chmod, 0o755)
        before = ["runuser", "-u", "nobody", "--"] if os.geteuid() == 0 else []
        run = subprocess.run([*before, self.dsbuild, "store", "gather", str(self.store), f"/tmp/{self.folder.name}-to"],
                             capture_output=True, text=True, check=False, timeout=SECONDS, cwd="/tmp")
        self.addCleanup(shutil.rmtree, f"/tmp/{self.folder.name}-to", ignore_errors=True)
        self.assertEqual(run.returncode, 1, run)
        self.assertIn(f"{folder}: cannot list: Permission denied", run.stderr)


class InputsTest(OddFilesTest):
    def setUp(self):
        super().setUp()
        (self.tiny / "tiny.cla").write_text("PSB 1\n1 2\nsolid 0 2\nbox\ntetra\n")
        (self.tiny / "picture.png").write_bytes(b"no picture")

    def test_inputs_that_are_no_files(self):
        texture = self.tiny / "materials/red.mat"
        named = {"recipe": (self.recipe, []), "mesh": (self.tiny / "models/box.off", ['models.files=["models/box.off"]']),
                 "material": (self.tiny / "materials/green.mat", []),
                 "environment": (self.tiny / "environments/floor/environment.scn", []),
                 "picture's settings": (self.tiny / "environments/plain/environment.cfg", []),
                 "environment's mesh": (self.tiny / "environments/floor/floor.ply", []),
                 "classes": (self.tiny / "tiny.cla", ['classes.train="tiny.cla"']),
                 "texture": (self.tiny / "picture.png", [])}
        for name, (path, settings) in named.items():
            if name == "texture":
                texture.write_text("scene.textures.t.type = imagemap\nscene.textures.t.file = ../picture.png\n"
                                   "scene.materials.red.type = matte\nscene.materials.red.kd = t\n")
            kept = path.read_bytes()
            for what in ("a pipe", "a device"):
                with self.subTest(name=name, what=what):
                    self.put_in_place(what, path)
                    words = [word for setting in settings for word in ("--set", setting)]
                    run = self.run_it("build", self.recipe, "-o", self.out, *words)
                    if name in ("material", "environment"):  # of a folder, what is none is not used
                        self.assertIn("1 that is no file (a pipe, socket or device)", run.err)
                    else:
                        self.assertIn(run.code, (1, 2), run)
                        self.assertRegex(run.err, f"error: .*{path.name}")
                self.put_back(path, kept)

    def test_files_of_a_dataset(self):
        self.build()
        for name in ("manifest/images.jsonl", "manifest/dataset.json", "manifest/checksums.xxh128", ".dsbuild/dataset",
                     "images/box.off/0.png"):
            path = self.out / name
            kept = path.read_bytes()
            path.chmod(0o644)
            self.put_in_place("a pipe", path)
            for words in (("verify", self.out), ("check", self.out), ("export", self.out, "--format", "csv", "-o",
                          self.folder / "to"), ("gallery", self.out, "-o", self.folder / "gallery"), ("status", self.out),
                          ("diff", self.out, self.out), ("build", self.recipe, "-o", self.out, "-n")):
                run = self.run_it(*words)  # ends
                if words[0] == "verify":
                    self.assertEqual(run.code, 1, (name, str(run)))
            self.put_back(path, kept)


if __name__ == "__main__":
    main()
