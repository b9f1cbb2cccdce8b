#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fails when a namespace has two types of one name, or two inline functions of one signature.

Two such definitions never meet a compiler together, and the linker takes either one's destructor for both: a program that
crashes with one set of flags and not with another. What stands in an unnamed namespace is its file's own.

Usage: ci/check_names.py [ROOT]
"""
import collections
import pathlib
import re
import sys

TOPS = ["builder", "manifests", "tracer", "tests"]
BEGIN = re.compile(r"(?:inline )?namespace ?([\w:]*) ?\{$")
END = re.compile(r"\}\s*// namespace")
TYPE = re.compile(r"(?:template <.*> )?(?:struct|class|enum class|enum|union) (?:\w+\(.*\) )?(\w+)(?: final)?(?: ?:[^:].*)?[ ]?\{")
FUNCTION = re.compile(r"(?:template <.*> )?(?:constexpr )?inline (?:constexpr )?[\w:<>&*, ]+?\b(\w+)\((.*)\)(?: const)?(?: noexcept)? \{")


def defined(path: pathlib.Path):
    """Line and qualified name of each type and inline function of a file that other files' could be taken for."""
    inside = []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if begin := BEGIN.match(line):
            inside.append(begin.group(1))
        elif END.match(line) and inside:
            inside.pop()
        elif "" not in inside:
            if kind := TYPE.match(line):
                yield number, "::".join([*inside, kind.group(1)])
            elif function := FUNCTION.match(line):
                yield number, "::".join([*inside, f"{function.group(1)}({function.group(2)})"])


def faults(root: pathlib.Path) -> list[str]:
    """One line for each name that has several definitions."""
    places = collections.defaultdict(list)
    for path in (p for top in TOPS for p in sorted((root / top).rglob("*")) if p.suffix in {".h", ".cc"}):
        for number, name in defined(path):
            places[name].append(f"{path.relative_to(root).as_posix()}:{number}")
    return [f"{name} is defined more than once: {', '.join(found)}" for name, found in places.items() if len(found) > 1]


def main(root: pathlib.Path) -> int:
    found = faults(root)
    print("\n".join(found), end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")))
