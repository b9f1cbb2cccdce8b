#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""ci/check refuses what it is there to refuse: a wrong include planted in each layer, each forbidden word of kernels,
a file that is not formatted, a folder of no layer, a name with two definitions.

Usage: check_test.py SOURCE_DIR
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv.pop(1)).resolve()
sys.path.insert(0, str(SOURCE / "ci"))
import check_layers  # noqa: E402

FORBIDDEN = ["x = sin(x);", "x = native_sqrt(x);", "atomic_inc(p);", "float3 v;", "x = 1.5;"]


class Tree:
    """A project of one header a layer, with the real ci/."""

    def __init__(self, root: pathlib.Path):
        self.root = root
        for name in ("check", "check_layers.py", "check_names.py", "lint_kernels.sh", "format"):
            self.put(f"ci/{name}", (SOURCE / "ci" / name).read_text(encoding="utf-8"))
            shutil.copymode(SOURCE / "ci" / name, root / "ci" / name)
        shutil.copy(SOURCE / ".clang-format", root)
        for folder in check_layers.RANK:
            self.put(f"{folder}/own.h", "#pragma once\n")
        for name in ("program.cl", "nodes/node.h"):
            self.put(f"tracer/kernels/{name}", "#pragma once\n")
        subprocess.run(["git", "init", "-q", str(root)], check=True)

    def put(self, name: str, text: str) -> None:
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def check(self) -> tuple[int, str]:
        done = subprocess.run([self.root / "ci/check"], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr


class Check(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        # A checkout may lie below any name, also one that tools take for a build tree.
        self.tree = Tree(pathlib.Path(folder.name) / "build" / "project")

    def refuses(self, name: str, text: str, words: str) -> None:
        file = self.tree.root / name
        before = file.read_text(encoding="utf-8") if file.exists() else None
        self.tree.put(name, text)
        code, output = self.tree.check()
        self.assertNotEqual(code, 0, f"{name} was let through: {text}")
        self.assertIn(words, output)
        if before is None:
            file.unlink()
        else:
            self.tree.put(name, before)

    def test_takes_what_is_right(self):
        folders = [row[0] for row in check_layers.LAYERS]
        for low, high in zip(folders, folders[1:]):
            self.tree.put(f"{high}/own.h", f'#pragma once\n\n#include "{low}/own.h"\n')
        code, output = self.tree.check()
        self.assertEqual((code, output), (0, ""))

    def test_refuses_includes_up_and_sideways_in_each_layer(self):
        rank = check_layers.RANK
        for low in rank:
            for high in (f for f in rank if f != low and rank[f] in (rank[low], rank[low] + 1)):
                self.refuses(f"{low}/own.h", f'#pragma once\n\n#include "{high}/own.h"\n', f"{low} may not include {high}")

    def test_refuses_folders_of_no_layer(self):
        self.refuses("builder/build/own.h", "#pragma once\n", "builder/build/own.h: stands in no row")
        self.refuses("tests/own.h", '#pragma once\n\n#include "builder/build/own.h"\n', "stands in no row")

    def test_refuses_each_forbidden_word_of_kernels(self):
        for statement in FORBIDDEN:
            for name in ("program.cl", "own.h", "nodes/node.h"):
                self.refuses(f"tracer/kernels/{name}", f"void f() {{\n  {statement}\n}}\n", "kernel code must not use")

    def test_refuses_what_is_not_formatted(self):
        self.refuses("tracer/base/own.h", "int  f( );\n", "own.h")

    def test_refuses_names_with_two_definitions(self):
        self.tree.put("tracer/base/own.h", "#pragma once\n\nnamespace ds {\n\nstruct Row {\n  int a;\n};\n\n"
                                           "inline int twice(int a) {\n  return 2 * a;\n}\n\n}  // namespace ds\n")
        of_its_file = "namespace {\n\nstruct Row {};\n\n}  // namespace\n\nstruct Other::Row {};\nstruct Row;\nRow one{};\n"
        self.tree.put("tracer/scene/own.cc", f"namespace ds {{\n{of_its_file}\n}}  // namespace ds\n")
        self.tree.put("tracer/scene/other.cc", "namespace other {\n\nstruct Row {};\n\n}  // namespace other\n")
        code, output = self.tree.check()
        self.assertEqual((code, output), (0, ""))
        for text, name in (("struct Row {};", "ds::Row"), ("class Row final : public Base {};", "ds::Row"),
                           ("template <typename T> struct Row {};", "ds::Row"), ("enum class Row { a };", "ds::Row"),
                           ("inline int twice(int a) {\n  return a + a;\n}", "ds::twice(int a)")):
            self.refuses("builder/plan/own.h", f"#pragma once\n\nnamespace ds {{\n\n{text}\n\n}}  // namespace ds\n",
                         f"{name} is defined more than once: builder/plan/own.h:5, tracer/base/own.h:")

    def test_every_source_of_the_project_stands_in_a_layer(self):
        self.assertEqual(check_layers.faults(SOURCE), [])


if __name__ == "__main__":
    unittest.main()
