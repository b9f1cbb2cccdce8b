# SPDX-License-Identifier: Apache-2.0
"""Full disks and damaged files, through the real binary."""
import json
import os
import resource
import shutil
import signal
import sqlite3
import subprocess

from harness import IMAGES, TinyCase, main


def limit_file_size(size):
    """For preexec_fn: no file may grow past `size` bytes, which fails as a full disk does (EFBIG, not ENOSPC)."""

    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_DFL)  # the program itself must turn the signal into an error
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    return limit


class FaultsTest(TinyCase):
    def setUp(self):
        super().setUp()
        self.build()
        self.wanted = self.contents()

    def test_a_disk_that_takes_no_more(self):
        shutil.rmtree(self.out)
        for size in (0, 100, 2000, 6000, 20_000, 80_000):
            run = self.run_it("build", self.recipe, "-o", self.out, preexec_fn=limit_file_size(size))
            self.assertEqual(run.code, 1, (size, str(run)))
            self.assertIn("dsbuild: error: ", run.err)
        self.assert_counts(self.build(), images=IMAGES, failed=0)
        self.assertEqual(self.contents(), self.wanted)

    def test_a_full_file_system(self):
        # A file system of its own in a user namespace, where the machine lets us have one.
        script = ('mount -t tmpfs -o size=$1 tmpfs "$2" || exit 125; shift; folder=$1; shift; '
                  '"$@" -o "$folder/out" --json; code=$?; mount -o remount,size=64m "$folder" || exit 125; '
                  '"$1" status "$3" -o "$folder/out" --json || exit 124; "$1" status "$3" -o "$folder/out" >&2; '
                  '"$1" verify "$folder/out" >&2; "$1" log "$3" -o "$folder/out" >&2; '
                  '"$@" -o "$folder/out" --json && "$1" status "$3" -o "$folder/out" --json && cp -r "$folder/out" "$folder.copy"; exit $code')
        small = self.folder / "small"
        small.mkdir()
        endings = []
        for size in ("64k", "200k", "300k", "400k"):
            run = subprocess.run(["unshare", "-rm", "sh", "-c", script, "sh", size, str(small),
                                  *self.command("build", self.recipe)],
                                 capture_output=True, text=True, cwd=self.folder, check=False)
            if run.returncode == 125 or "unshare" in run.stderr:
                self.skipTest("no mount in a user namespace: " + run.stderr.strip())
            self.assertEqual(run.returncode, 1, run.stderr)
            self.assertRegex(run.stderr, "(?i)no space left|disk is full|disk i/o error")
            told = [json.loads(line) for line in run.stdout.splitlines()]
            before, built, after = told[-3:]
            self.assertEqual(after["last_build"]["outcome"], "done")
            self.assertEqual(built["failed"], 0)
            self.assertEqual(self.contents(self.folder / "small.copy"), self.wanted)
            shutil.rmtree(self.folder / "small.copy")
            if before["last_build"] is None:  # there was no room for a database
                continue
            endings.append(before["last_build"]["outcome"])
            self.assertEqual(endings[-1], "disk failed", run.stderr)
            failed = told[0]
            self.assertEqual(before["last_build"]["built"], failed["built"])
            self.assertEqual(before["last_build"]["not_reached"], failed["not_reached"])
            self.assertEqual((failed["disk_failed"], failed["seconds"] > 0), (True, True), failed)
            self.assertIn("UTC, disk failed (full, read only or broken), ", run.stderr)
            self.assertIn("the last build was ended by its disk", run.stderr)
            self.assertIn("UTC  disk failed ", run.stderr)
        self.assertTrue(endings)

    def test_damaged_objects_are_made_again(self):
        objects = [path for path in (self.out / ".dsbuild/objects").rglob("*") if path.is_file()]
        for number, path in enumerate(sorted(objects)):
            data = bytearray(path.read_bytes())
            path.unlink()
            if number % 3 == 0:
                path.write_bytes(data[:len(data) // 2])  # torn
            elif number % 3 == 1:
                data[len(data) // 2] ^= 1
                path.write_bytes(data)  # a flipped bit; the rest are lost
        shutil.rmtree(self.out / "images")
        counts = self.build()
        self.assert_counts(counts, built=IMAGES, failed=0)
        self.assertEqual(self.contents(), self.wanted)

    def test_a_damaged_database_costs_no_tracing(self):
        database = self.out / ".dsbuild/dsbuild.sqlite"
        whole = database.read_bytes()
        self.assertGreater(len(whole), 4096 * 4)
        for damage in (b"", b"no database", whole[:len(whole) // 2], whole[:5000] + os.urandom(6000) + whole[11000:]):
            database.write_bytes(damage)
            run = self.run_it("build", self.recipe, "-o", self.out, "--json")
            self.assertEqual(run.code, 0, run)
            self.assert_counts(run.json, images=IMAGES, failed=0, developed=0, traced_samples=0)
            self.assertEqual(self.contents(), self.wanted)
            self.assert_counts(self.build(), reused=IMAGES)

    def test_a_database_of_a_newer_program_is_left_alone(self):
        database = self.out / ".dsbuild/dsbuild.sqlite"
        with sqlite3.connect(database) as connection:
            connection.execute("PRAGMA user_version = 999")
        connection.close()
        before = database.read_bytes()
        run = self.run_it("build", self.recipe, "-o", self.out)
        self.assertEqual(run.code, 1, run)
        self.assertIn("made by a newer dsbuild", run.err)
        self.assertEqual(database.read_bytes(), before)

    def test_an_output_folder_that_cannot_be_written(self):
        file = self.folder / "file"
        file.write_text("in the way")
        run = self.run_it("build", self.recipe, "-o", file / "out")
        self.assertEqual(run.code, 1, run)
        self.assertIn("dsbuild: error: ", run.err)


if __name__ == "__main__":
    main()
