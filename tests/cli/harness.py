# SPDX-License-Identifier: Apache-2.0
"""What the command-line tests share: a copy of tests/data/tiny in a temporary folder, and runs of the real binary."""
import hashlib
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

IMAGES = 8  # of tests/data/tiny: two models, four views
SAMPLES = 32 * 32  # an image


class Run:
    """One finished run."""

    def __init__(self, process):
        self.code = process.returncode
        self.out = process.stdout
        self.err = process.stderr

    @property
    def json(self):
        return json.loads(self.out.splitlines()[-1])

    def __str__(self):
        return f"exit code {self.code}\n{self.out}\n{self.err}"


class TinyCase(unittest.TestCase):
    dsbuild = ""
    source = pathlib.Path()

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="dsbuild-cli-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.tiny = self.folder / "tiny"
        shutil.copytree(self.source / "tests/data/tiny", self.tiny)
        self.recipe = self.tiny / "recipe.toml"
        self.out = self.folder / "out"

    def command(self, *arguments):
        return [self.dsbuild, *map(str, arguments)]

    def start(self, *arguments, **options):
        return subprocess.Popen(self.command(*arguments), cwd=self.folder, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True, **options)

    def run_it(self, *arguments, **options):
        return Run(subprocess.run(self.command(*arguments), cwd=self.folder, capture_output=True, text=True,
                                  timeout=600, check=False, **options))

    def build(self, *arguments, code=0, out=None, **options):
        """Builds the recipe and returns the counters."""
        run = self.run_it("build", self.recipe, "-o", out or self.out, "--json", *arguments, **options)
        self.assertEqual(run.code, code, run)
        return run.json

    def assert_counts(self, counts, **wanted):
        self.assertEqual({name: counts[name] for name in wanted}, wanted, counts)

    def edit(self, file, before, after):
        path = self.tiny / file
        text = path.read_text()
        self.assertIn(before, text)
        path.write_text(text.replace(before, after))

    def contents(self, folder=None):
        """Hash of every file of the dataset but its state folder."""
        folder = folder or self.out
        return {path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
                for path in sorted(folder.rglob("*"))
                if path.is_file() and ".dsbuild" not in path.relative_to(folder).parts}


def main():
    TinyCase.dsbuild = os.path.abspath(sys.argv.pop(1))
    TinyCase.source = pathlib.Path(sys.argv.pop(1)).resolve()
    signal.signal(signal.SIGINT, signal.default_int_handler)
    result = unittest.main(verbosity=2, exit=False).result
    if result.wasSuccessful() and len(result.skipped) == result.testsRun:
        sys.exit(125)  # ctest says then that it was skipped
    sys.exit(0 if result.wasSuccessful() else 1)
