#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What an image costs beside its samples: dsbuild build of tiny models at 16x16 pixels and 1 sample a pixel into an empty folder.
ci/bench tiny builds and calls this. Three recipes: one view of each model (each image is a scene of its own), 14 views of each model
in environments by turns (three scenes a model), and a few pictures of 512x512 pixels and 16 samples, where nothing may be lost.
`--peer BINARY` times another dsbuild by turns. The figures also stand in build/bench/tiny_images.json."""
import argparse
import json
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

from nothing_to_do import RECIPE, ROOT, measure, processor, write_tree
from report import goal, goal_line, plain, table

GOAL_MS = 15
ONE_VIEW = "views = [4]\n"


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/bench", help="folder of dsbuild")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "build/bench", help="folder of tiny_images.json")
    parser.add_argument("--peer", type=pathlib.Path, help="another dsbuild, timed by turns")
    parser.add_argument("--models", type=int, default=1814)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--recipes", nargs="+", choices=["one", "many", "large"], default=["one", "many", "large"])
    return parser.parse_args()


def recipe_text(kind: str, models: int) -> str:
    text = RECIPE.format(models=models, assets=ROOT / "assets")
    if kind != "many":
        text = text.replace("[engine]", ONE_VIEW + "[engine]")
    if kind == "large":
        text = text.replace("= 16\n", "= 512\n").replace("spp = 1\n", "spp = 16\n")
    return text


def models_of(kind: str, models: int) -> int:
    """Of as many images each, but for the large ones, which take seconds."""
    return {"one": models, "many": max(models // 14, 1), "large": 6}[kind]


def build(binary: pathlib.Path, folder: pathlib.Path) -> dict:
    """Into an empty folder and store, with the programs compiled before."""
    shutil.rmtree(folder / "out", ignore_errors=True)
    result = measure([str(binary), "build", "tiny.toml", "-o", "out"], folder)
    found = re.search(r"(\d+) built", result["text"])
    if not found:
        sys.exit("no image was built: " + result["text"])
    result["images"] = int(found.group(1))
    return result


def picture_hashes(folder: pathlib.Path) -> str:
    """Of every file under images, by path."""
    return subprocess.run("find images -type f | LC_ALL=C sort | xargs sha256sum | sha256sum", cwd=folder / "out", shell=True,
                          check=True, capture_output=True, text=True).stdout


def run(binaries: dict, kind: str, models: int, repeats: int) -> dict:
    folder = pathlib.Path(tempfile.mkdtemp(prefix="dsbuild-bench-"))
    try:
        write_tree(folder, models)
        (folder / "tiny.toml").write_text(recipe_text(kind, models))
        runs = {name: [] for name in binaries}
        hashes = set()
        for _ in range(repeats):
            for name, binary in binaries.items():
                runs[name].append(build(binary, folder))
                hashes.add(picture_hashes(folder))
        if len(hashes) > 1:
            sys.exit(f"{kind}: the files differ")
        return runs
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def summary(results: list) -> dict:
    ms = [1000 * result["seconds"] / result["images"] for result in results]
    return {"images": results[0]["images"], "ms": statistics.median(ms), "least": min(ms), "most": max(ms),
            "cpu_ms": statistics.median(1000 * result["cpu_seconds"] / result["images"] for result in results),
            "mb": max(result["mb"] for result in results)}


def main() -> None:
    options = arguments()
    binaries = {"dsbuild": options.build / "dsbuild"}
    if options.peer:
        binaries["peer"] = options.peer.resolve()
    run(binaries, "many", 12, 1)  # compiles the programs
    report = {"processor": processor(), "recipes": {}}
    print(report["processor"])
    rows = []
    for kind in options.recipes:
        figures = {name: summary(results)
                   for name, results in run(binaries, kind, models_of(kind, options.models), options.repeats).items()}
        report["recipes"][kind] = figures
        rows += [[kind, name, f["images"], f"{f['ms']:.1f}", f"{f['least']:.1f} .. {f['most']:.1f}", f"{f['cpu_ms']:.1f}",
                  f"{f['mb']:.0f}"] for name, f in figures.items()]
    print(table(["recipe", "binary", "images", "ms an image", "least .. most", "CPU ms", "MB"], rows))
    tiny = [report["recipes"][kind]["dsbuild"]["ms"] for kind in options.recipes if kind != "large"]
    goals = [goal("ms a tiny image", max(tiny), f"<= {GOAL_MS}", max(tiny) <= GOAL_MS)] if tiny else []
    for one in goals:
        print(goal_line(one))
    options.out.mkdir(parents=True, exist_ok=True)
    (options.out / "tiny_images.json").write_text(json.dumps(plain({**report, "goals": goals}), indent=1) + "\n")


if __name__ == "__main__":
    main()
