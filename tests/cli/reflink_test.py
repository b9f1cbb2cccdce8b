# SPDX-License-Identifier: Apache-2.0
"""On a file system that shares blocks (btrfs, in a file): outputs are reflinks, and editing one reaches no other."""
import os
import shutil
import subprocess

from harness import IMAGES, TinyCase, main


class ReflinkTest(TinyCase):
    def setUp(self):
        super().setUp()
        if os.geteuid() != 0 or shutil.which("mkfs.btrfs") is None:
            self.skipTest("wants root and mkfs.btrfs")
        disk, self.place = self.folder / "disk", self.folder / "place"
        self.place.mkdir()
        with open(disk, "wb") as file:
            file.truncate(160 << 20)
        for command in (["mkfs.btrfs", "-q", disk], ["mount", "-o", "loop,max_inline=0", disk, self.place]):
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            if done.returncode != 0:
                self.skipTest(f"no btrfs here: {done.stderr.strip()}")
        self.addCleanup(subprocess.run, ["umount", self.place], check=True)
        self.out = self.place / "out"

    def shared(self, path):
        """Whether all bytes of the file lie where another file has them, too (FIEMAP's flag, by filefrag)."""
        subprocess.run(["sync", "-f", path], check=True)
        told = subprocess.run(["filefrag", "-v", path], capture_output=True, text=True, check=True).stdout
        extents = [line for line in told.splitlines() if line.split(":")[0].strip().isdigit()]
        self.assertTrue(extents, told)
        return all("shared" in line for line in extents)

    def test_edit_in_place_stays_in_one_file(self):
        more = ("--set", "outputs.depth=exr", "--set", "engine.width=64", "--set", "engine.height=64")
        self.build(*more)
        wanted = self.contents()
        depth = self.out / "images/box.off/1.depth.exr"
        self.assertEqual(depth.stat().st_nlink, 1)
        self.assertTrue(depth.stat().st_mode & 0o200, "whoever owns a reflink may edit it")
        self.assertTrue(self.shared(depth))
        store = sorted(path for path in (self.out / ".dsbuild").rglob("*") if path.is_file() and "objects" in path.parts)
        before = [path.read_bytes() for path in store]
        with open(depth, "r+b") as file:
            file.write(b"scribble")
        self.assertEqual([path.read_bytes() for path in store], before)
        self.assertEqual(self.run_it("verify", self.out).code, 1)
        self.assert_counts(self.build(*more), built=1, reused=IMAGES - 1, traced=0)
        self.assertEqual(self.contents(), wanted)
        self.assertTrue(self.shared(depth))

    def test_copies_share_nothing(self):
        more = ("--set", "outputs.depth=exr", "--set", "engine.width=64", "--set", "engine.height=64")
        self.build(*more, "--copy")
        self.assertFalse(self.shared(self.out / "images/box.off/1.depth.exr"))
        self.assertEqual(self.run_it("verify", self.out).code, 0)


if __name__ == "__main__":
    main()
