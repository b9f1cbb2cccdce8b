#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What simulating only the effects a scene calls for is worth: every shipped environment with every shipped material,
by the specialised program and by the one that holds all effects, in turns; and what compiling costs. ci/bench effects
builds and calls this. The figures also stand in build/bench/effects.json."""
import argparse
import json
import pathlib
import statistics
import subprocess
import sys

from report import goal, goal_line, plain, table
from statistics_of_runs import ratios, spread

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
MEDIAN_GAIN, LEAST_GAIN, MOST_SECONDS = 1.5, 1.0, 2.0


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/bench", help="folder of effects_bench")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "build/bench", help="folder of effects.json")
    parser.add_argument("--model", type=pathlib.Path, default=ROOT / "assets/models/mug-1.ply")
    parser.add_argument("--size", type=int, default=128, help="pixels a side")
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--repeats", type=int, default=7)
    return parser.parse_args()


def measure(options) -> dict:
    run = subprocess.run([options.build / "effects_bench", ROOT / "assets", options.model, str(options.size),
                          str(options.spp), str(options.repeats)], check=True, stdout=subprocess.PIPE, text=True)
    results = json.loads(run.stdout)
    for pair in results["pairs"]:
        for kind in ("seconds", "cpu_seconds"):
            pair[f"full_over_specialised_{kind}"] = ratios(pair["full"][kind], pair["specialised"][kind])
    return results


def goals(results: dict) -> list:
    gains = [pair["full_over_specialised_cpu_seconds"].median for pair in results["pairs"]]
    compile_seconds = [statistics.median(program["cpu_seconds"]) for program in results["compile"][:-1]]
    return [goal("median gain over the pairs, by CPU time", statistics.median(gains), f">= {MEDIAN_GAIN:g}",
                 statistics.median(gains) >= MEDIAN_GAIN),
            goal("least gain of a pair, by CPU time", min(gains), f">= {LEAST_GAIN:g}", min(gains) >= LEAST_GAIN),
            goal("most seconds to compile a specialised program, by CPU time", max(compile_seconds), f"<= {MOST_SECONDS:g}",
                 max(compile_seconds) <= MOST_SECONDS),
            goal("pairs whose bits differ", sum(not pair["equal"] for pair in results["pairs"]), "= 0",
                 all(pair["equal"] for pair in results["pairs"]))]


def text(results: dict) -> str:
    pairs = [[pair["environment"], pair["material"], spread(pair["specialised"]["seconds"]).text(3),
              spread(pair["full"]["seconds"]).text(3), pair["full_over_specialised_seconds"].text(),
              pair["full_over_specialised_cpu_seconds"].text(), "equal" if pair["equal"] else "DIFFERENT"]
             for pair in results["pairs"]]
    programs = [["(an empty one, once a process)", spread(results["compiler_start"]["seconds"]).text(2),
                 spread(results["compiler_start"]["cpu_seconds"]).text(2)]]
    programs += [[", ".join(program["pairs"]), spread(program["seconds"]).text(2), spread(program["cpu_seconds"]).text(2)]
                 for program in results["compile"]]
    return "\n".join([
        "figures are median [least, most]; both programs by turns, ratios of neighbours in time", "",
        table(["environment", "material", "specialised, s", "full, s", "full / specialised", "by CPU time", "bits"],
              pairs), "",
        table(["program", "s to compile", "CPU s"], programs), "",
        f"{len(results['compile']) - 1} specialised programs for {len(results['pairs'])} pairs", "", "goals:",
        *[goal_line(entry) for entry in results["goals"]]])


def main() -> int:
    options = arguments()
    results = measure(options)
    results["goals"] = goals(results)
    options.out.mkdir(parents=True, exist_ok=True)
    (options.out / "effects.json").write_text(json.dumps(plain(results), indent=1) + "\n", encoding="utf-8")
    print(text(results))
    return 0


if __name__ == "__main__":
    sys.exit(main())
