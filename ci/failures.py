#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""ci/failures.py JUNIT: the last lines of each test that failed, for the end of a log, where people look first."""
import sys
import xml.etree.ElementTree

MOST_LINES = 40


def main():
    for case in xml.etree.ElementTree.parse(sys.argv[1]).iter("testcase"):
        if case.get("status") != "fail":
            continue
        lines = (case.findtext("system-out") or "").rstrip().splitlines()
        print(f"== {case.get('name')}, its last lines of {len(lines)}:")
        print("\n".join(lines[-MOST_LINES:]))


if __name__ == "__main__":
    main()
