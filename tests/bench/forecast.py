# SPDX-License-Identifier: Apache-2.0
"""Compares what `dsbuild plan --time` and `--error` forecast of a recipe with what building it then takes.

Calibration and build run one after the other, so that they meet the same load, several times over; what counts is the
median of the ratios, of each question. No test of the suite: a machine that others use makes any single time wrong.
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


class Comparison:
    def __init__(self, options):
        self.dsbuild, self.recipe, self.size = options.dsbuild, options.recipe, options.size
        self.settings = ["--set", f"engine.width={options.size}", "--set", f"engine.height={options.size}"]

    def row(self, name, question, build_settings):
        """Prints a line; the seconds forecast over those taken."""
        with tempfile.TemporaryDirectory(prefix="dsbuild-forecast-") as scratch:
            folder = pathlib.Path(scratch) / "out"
            common = [self.recipe, *self.settings, "-o", folder, "--json"]
            told = last_json([self.dsbuild, "plan", *common, *question, "--recalibrate"])["forecast"]
            built = last_json([self.dsbuild, "build", *common, *build_settings])
            size = stored_bytes(folder)
        seconds, took = told["seconds"], built["seconds"]
        samples = sum(pair["made"] * pair["traced_spp"] for pair in told["pairs"]) * self.size * self.size
        inside = seconds["low"] <= took <= seconds["high"]
        print(f"{name}: forecast {seconds['value']:.1f} s ({seconds['low']:.1f} to {seconds['high']:.1f}), "
              f"took {took:.1f} s: {seconds['value'] / took:.2f}, {'inside' if inside else 'outside'}; "
              f"disk {told['bytes']['value'] / 1e6:.1f} MB, took {size / 1e6:.1f} MB: "
              f"{told['bytes']['value'] / size:.2f}; samples {samples / 1e6:.1f} M, "
              f"took {built['traced_samples'] / 1e6:.1f} M: {samples / built['traced_samples']:.2f}", flush=True)
        return seconds["value"] / took


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("dsbuild")
    parser.add_argument("--recipe", default=ROOT / "recipes/figurines.toml")
    parser.add_argument("--size", type=int, default=128, help="width and height in pixels [128]")
    parser.add_argument("--repeats", type=int, default=3, help="rows of each question [3]")
    parser.add_argument("--error", default="0.02", metavar="E",
                        help="ask plan --error E and build with engine.error = E [0.02]")
    parser.add_argument("--only", choices=("time", "error"), help="ask this only [one row of each by turns]")
    parser.add_argument("--bound", type=float, default=0.25, help="how far a median may be off [0.25]")
    options = parser.parse_args()
    comparison = Comparison(options)
    questions = {"time": ("time", ["--time"], []),
                 "error": (f"error {options.error}", ["--error", options.error],
                           ["--set", f"engine.error={options.error}"])}
    if options.only:
        questions = {options.only: questions[options.only]}
    ratios = {name: [] for name in questions}
    for _ in range(options.repeats):
        for name, question in questions.items():
            ratios[name].append(comparison.row(*question))
    medians = {name: statistics.median(of_question) for name, of_question in ratios.items()}
    for name, median in medians.items():
        print(f"{questions[name][0]}: median of the times {median:.2f}, "
              f"wanted {1 - options.bound:.2f} to {1 + options.bound:.2f}")
    return 0 if all(abs(median - 1) <= options.bound for median in medians.values()) else 1


if __name__ == "__main__":
    sys.exit(main())
