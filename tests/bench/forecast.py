# SPDX-License-Identifier: Apache-2.0
"""Compares what `dsbuild plan --time` foretells of a recipe with what building it then takes.

Calibration and build run one after the other, so that they meet the same load, several times over; what counts is the
median of the ratios. No test of the suite: a machine that others use makes any single time wrong.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]


def last_json(command):
    out = subprocess.run(command, check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout
    return json.loads(out.splitlines()[-1])


def stored_bytes(folder):
    """Of the objects in the dataset's store."""
    return sum(path.stat().st_size for path in (folder / ".dsbuild/objects").rglob("*") if path.is_file())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("dsbuild")
    parser.add_argument("--recipe", default=ROOT / "recipes/figurines.toml")
    parser.add_argument("--size", type=int, default=128, help="width and height in pixels [128]")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--bound", type=float, default=0.25, help="how far the median may be off [0.25]")
    options = parser.parse_args()
    settings = ["--set", f"engine.width={options.size}", "--set", f"engine.height={options.size}"]
    ratios = []
    for number in range(options.repeats):
        with tempfile.TemporaryDirectory(prefix="dsbuild-forecast-") as scratch:
            folder = pathlib.Path(scratch) / "out"
            command = [options.dsbuild, "plan", options.recipe, *settings, "-o", folder, "--json", "--time",
                       "--recalibrate"]
            told = last_json(command)["forecast"]
            built = last_json([options.dsbuild, "build", options.recipe, *settings, "-o", folder, "--json"])
            ratio = told["seconds"]["value"] / built["seconds"]
            ratios.append(ratio)
            inside = told["seconds"]["low"] <= built["seconds"] <= told["seconds"]["high"]
            size = stored_bytes(folder)
            print(f"{number + 1}: foretold {told['seconds']['value']:.1f} s ({told['seconds']['low']:.1f} to "
                  f"{told['seconds']['high']:.1f}), took {built['seconds']:.1f} s: {ratio:.2f}, "
                  f"{'inside' if inside else 'outside'}; disk {told['bytes']['value'] / 1e6:.1f} MB, "
                  f"took {size / 1e6:.1f} MB: {told['bytes']['value'] / size:.2f}", flush=True)
    median = statistics.median(ratios)
    print(f"median of the times: {median:.2f}, wanted {1 - options.bound:.2f} to {1 + options.bound:.2f}")
    return 0 if abs(median - 1) <= options.bound else 1


if __name__ == "__main__":
    sys.exit(main())
