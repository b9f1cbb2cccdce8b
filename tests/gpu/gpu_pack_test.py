#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""ci/gpu: a pack of some cases, carried elsewhere, is equal on PoCL and on oclgrind, and faults planted in it are found.

Usage: gpu_pack_test.py SOURCE_DIR BUILD_DIR
"""
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

BUILD = pathlib.Path(sys.argv.pop()).resolve()
SOURCE = pathlib.Path(sys.argv.pop()).resolve()
# The second has a guide, for which rays of their own are traced.
CASES = ["material-matte", "material-glass", "rays-shadow"]


def pack(folder: pathlib.Path, *cases: str) -> subprocess.CompletedProcess:
    return subprocess.run([SOURCE / "ci/gpu", "--build", BUILD, "pack", folder, *cases], capture_output=True, text=True,
                          check=False)


class Pack(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.made = tempfile.TemporaryDirectory(prefix="dsbuild-gpu-")
        cls.addClassCleanup(cls.made.cleanup)
        done = pack(pathlib.Path(cls.made.name) / "pack", *CASES)
        assert done.returncode == 0, done.stderr

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="dsbuild gpu ")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name) / "elsewhere"
        shutil.copytree(pathlib.Path(self.made.name) / "pack", self.folder)
        self.home = pathlib.Path(folder.name) / "home"
        self.home.mkdir()

    def run_pack(self, *arguments: str, before=()) -> tuple[int, str, str]:
        done = subprocess.run([*before, "sh", self.folder / "run", *arguments], capture_output=True, text=True, check=False,
                              cwd="/", env={"HOME": str(self.home), "PATH": "/usr/bin:/bin"})
        return done.returncode, done.stdout, done.stderr

    def unpack(self) -> pathlib.Path:
        subprocess.run(["tar", "-C", self.folder, "-xzf", self.folder / "pack.tar.gz"], check=True)
        return self.folder / "pack"

    def pack_again(self):
        subprocess.run(["tar", "-C", self.folder, "-czf", self.folder / "pack.tar.gz", "pack"], check=True)

    def reads(self, case: str) -> list:
        """[(line, bytes, offset in data.bin)] of what the case expects."""
        text = (self.folder / "pack/cases.txt").read_text(encoding="utf-8")
        inside = re.search(rf"^case {case}$(.*?)^end$", text, re.M | re.S).group(1)
        return [(m.group(0), int(m.group(1)), int(m.group(2)))
                for m in re.finditer(r"^read \d+ (\d+) \w{16} (\d+) .*$", inside, re.M)]

    def test_every_kind_has_a_case(self):
        names = subprocess.run([BUILD / "gpu_pack", "--list", SOURCE / "assets"], capture_output=True, text=True,
                               check=True).stdout.split()
        for kind in ("material", "texture", "light"):
            headers = (SOURCE / "tracer/kernels" / f"{kind}s").glob("*.h")
            self.assertEqual(sorted(n for n in names if n.startswith(f"{kind}-")),
                             sorted(f"{kind}-{header.stem}" for header in headers))

    def test_all_are_equal_and_nothing_is_left(self):
        before = sorted(p.name for p in self.folder.rglob("*"))
        code, out, err = self.run_pack()
        self.assertEqual((code, err), (0, ""), out)
        for case in CASES:
            self.assertRegex(out, rf"(?m)^{case} +equal ")
        self.assertRegex(out, r"(?m)^3 equal, 0 different, 0 failed, 0 not run;")
        self.assertRegex(out, r"(?m)^device: .+\nplatform: .+\ndriver: .+, by libOpenCL\.so\.1$")
        self.assertRegex(out, r"(?m)^rays-shadow .* \d+\.\d Mrays/s$")
        self.assertEqual(list(self.home.iterdir()), [])
        self.assertEqual(sorted(p.name for p in self.folder.rglob("*")), before)

    def test_a_driver_without_the_systems_loader(self):
        drivers = sorted(pathlib.Path("/usr/lib").glob("*/libpocl.so.[0-9]"))
        if not drivers:
            self.skipTest("PoCL has no library of its own here")
        code, out, err = self.run_pack("--library", str(drivers[0]), "material-matte")
        self.assertEqual((code, err), (0, ""), out)
        self.assertIn(f"by {drivers[0]}\n", out)

    def test_one_flipped_bit_is_found_where_it_is(self):
        inside = self.unpack()
        film = self.reads("material-matte")[0]
        data = bytearray((inside / "data.bin").read_bytes())
        at = film[2] + 4 * 1234
        expected = struct.unpack_from("<I", data, at)[0] ^ 1
        data[at] ^= 1
        (inside / "data.bin").write_bytes(data)
        self.pack_again()
        code, out, err = self.run_pack("*-matte")
        self.assertEqual((code, err), (1, ""))
        self.assertIn(f"  trace_paths:11: first difference at word 1234: {expected ^ 1:08x} ", out)
        self.assertIn(f"expected {expected:08x} ", out)
        self.assertIn(f"; 1 of {film[1] // 4} words differ", out)
        self.assertRegex(out, r"(?m)^material-matte +differs ")
        self.assertRegex(out, r"(?m)^0 equal, 1 different, 0 failed, 0 not run;")

    def test_hashes_alone_tell_too(self):
        path = self.unpack() / "cases.txt"
        text = path.read_text(encoding="utf-8")
        line, _, at = self.reads("material-matte")[0]
        alone = line.replace(f" {at} ", " - ")
        path.write_text(text.replace(line, alone), encoding="utf-8")
        self.pack_again()
        self.assertEqual(self.run_pack("material-matte")[0], 0)
        hash_text = alone.split()[3]
        other = f"{int(hash_text, 16) ^ 1:016x}"
        path.write_text(text.replace(line, alone.replace(hash_text, other)), encoding="utf-8")
        self.pack_again()
        code, out, _ = self.run_pack("material-matte")
        self.assertEqual(code, 1)
        self.assertIn(f"hash {hash_text}, expected {other}", out)

    def test_a_program_that_does_not_compile_fails_its_cases_only(self):
        (self.unpack() / "texts/0.cl").write_text("__kernel void trace_paths() { nothing }\n", encoding="utf-8")
        self.pack_again()
        code, out, err = self.run_pack("material-matte", "rays-shadow")
        self.assertEqual(code, 1)
        self.assertRegex(out, r"(?m)^material-matte +failed .* a program did not compile: -11$")
        self.assertRegex(out, r"(?m)^1 equal, 0 different, 1 failed, 0 not run;")
        self.assertIn("nothing", err)

    def test_what_time_did_not_allow_is_said(self):
        code, out, _ = self.run_pack("--seconds", "0")
        self.assertEqual(code, 3)
        self.assertRegex(out, r"(?m)^0 equal, 0 different, 0 failed, 3 not run;")

    def test_wrong_words_are_refused(self):
        for arguments, words in ((["nothing"], "no case is named so"),
                                 (["--device", "nothing"], "no OpenCL device is nothing"),
                                 (["--nothing", "1"], "unknown option --nothing"),
                                 (["--library", "nothing.so"], "no OpenCL device")):
            code, _, err = self.run_pack(*arguments)
            self.assertEqual(code, 2, arguments)
            self.assertIn(words, err)
        done = pack(self.folder, "nothing")
        self.assertEqual(done.returncode, 2)
        self.assertIn("there is no case nothing", done.stderr)
        done = pack(self.home, "material-matte")
        self.assertEqual(done.returncode, 2)
        self.assertIn("is no pack", done.stderr)

    def test_the_runner_needs_libc_alone(self):
        text = subprocess.run(["readelf", "-d", "-V", self.folder / "runner"], capture_output=True, text=True,
                              check=True).stdout
        self.assertEqual(re.findall(r"NEEDED.*\[(.*)\]", text), ["libc.so.6"])
        versions = [tuple(map(int, v.split("."))) for v in re.findall(r"GLIBC_([0-9.]+)", text)]
        self.assertLessEqual(max(versions), (2, 34))

    def test_an_interpreter_that_watches_every_access(self):
        if not shutil.which("oclgrind"):
            self.skipTest("oclgrind is not installed (ci/setup installs it)")
        # Why these options: ci/bits.md.
        before = ["oclgrind", "--build-options", "-Drestrict= -disable-llvm-passes"]
        code, out, err = self.run_pack("material-matte", before=before)
        self.assertEqual((code, err), (0, ""), out)
        self.assertRegex(out, r"(?m)^device: Oclgrind")
        self.assertRegex(out, r"(?m)^1 equal, 0 different, 0 failed, 0 not run;")


if __name__ == "__main__":
    unittest.main()
