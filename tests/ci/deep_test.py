#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""ci/deep tells what clang-tidy found, with a stand-in for clang-tidy: the real one takes an hour.

Usage: deep_test.py SOURCE_DIR
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv.pop(1)).resolve()
# As clang-tidy 14 writes with --use-color, which run-clang-tidy gives it wherever the output goes.
FINDING = r"\033[1m/a.cc:7:3: \033[0m\033[0;1;31merror: \033[0m\033[1mcast is ineffective\033[0m\n  f(x);\n"


class Tidy(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        (self.root / "ci").mkdir()
        (self.root / "build/clang").mkdir(parents=True)
        shutil.copy(SOURCE / "ci/deep", self.root / "ci/deep")
        for name in ("ci/setup", "tools/cmake"):
            self.put(name, "exit 0")

    def put(self, name: str, line: str) -> None:
        path = self.root / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(f"#!/bin/sh\n{line}\n", encoding="utf-8")
        path.chmod(0o755)

    def tidy(self) -> tuple[int, str]:
        path = f"{self.root / 'tools'}:{os.environ['PATH']}"
        done = subprocess.run([self.root / "ci/deep", "tidy"], capture_output=True, text=True, check=False,
                              env={**os.environ, "PATH": path})
        return done.returncode, done.stdout + done.stderr

    def test_shows_a_finding_and_the_line_it_is_in(self):
        self.put("tools/run-clang-tidy-14", f"printf '{FINDING}'\nexit 1")
        code, output = self.tidy()
        self.assertEqual(code, 1)
        self.assertIn("/a.cc:7:3: error: cast is ineffective\n  f(x);\n", output)
        self.assertIn("tidy   FAILED", output)

    def test_passes_where_nothing_is_found(self):
        self.put("tools/run-clang-tidy-14", "echo 3 warnings generated.")
        code, output = self.tidy()
        self.assertEqual(code, 0)
        self.assertIn("tidy   passed", output)


if __name__ == "__main__":
    unittest.main()
