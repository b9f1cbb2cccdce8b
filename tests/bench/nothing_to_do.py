#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What a command costs when nothing changed: dsbuild build, status and plan of 1,814 tiny models from 14 sides, all made, beside
ninja on as many steps and files, by turns; and dsbuild plan of the same recipe with no database. ci/bench build builds and calls
this. The pictures are made up by fake_build, everything else is as dsbuild build leaves it. The figures also stand in
build/bench/nothing_to_do.json."""
import argparse
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

from report import goal, goal_line, plain, table

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
VIEWS = 14
GOAL_SECONDS, GOAL_MB, GOAL_FIRST_SECONDS = 0.5, 60, 1.0

RECIPE = """[dataset]
name = "tiny-{models}"
[models]
dir = "models"
up = "y"
size_m = 0.16
ground_z_m = -0.0574
centre = "mass"
normals = "smooth"
[materials]
dir = "{assets}/materials"
assign = "random"
[environments]
dir = "{assets}/environments"
assign = "cycle"
[camera]
set = "half-dodecahedron"
distance_m = 0.252
lens_radius_m = 0.002
[engine]
width = 16
height = 16
spp = 1
"""


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/bench",
                        help="folder of dsbuild and fake_build")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "build/bench", help="folder of nothing_to_do.json")
    parser.add_argument("--models", type=int, nargs="+", default=[72, 1814])
    parser.add_argument("--repeats", type=int, default=7)
    return parser.parse_args()


def write_tree(folder: pathlib.Path, models: int) -> None:
    """Tetrahedra, all different, the recipe, and ninja's description of as many steps that make as many files."""
    (folder / "models").mkdir(parents=True)
    steps = ["rule make", "  command = touch $out"]
    for i in range(models):
        stretch = 1 + i / models
        (folder / f"models/m{i}.off").write_text(
            f"OFF\n4 4 6\n0 0 0\n1 0 0\n0 {stretch:.6f} 0\n0 0 {2 - stretch / 2:.6f}\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n")
        for view in range(VIEWS):
            name = f"made/m{i}.off/{view}"
            steps.append(f"build {name}.png {name}.mask.png: make models/m{i}.off")
    (folder / "build.ninja").write_text("\n".join(steps) + "\n")
    (folder / "tiny.toml").write_text(RECIPE.format(models=models, assets=ROOT / "assets"))


def measure(command: list, folder: pathlib.Path) -> dict:
    """Wall clock of the whole command, the processor time it was given, and the most memory it held."""
    start = time.perf_counter()
    process = subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    text = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    seconds = time.perf_counter() - start
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"{command}: exit code {process.returncode}\n{text}")
    return {"seconds": seconds, "cpu_seconds": usage.ru_utime + usage.ru_stime, "mb": usage.ru_maxrss / 1024, "text": text}


def run(options, models: int) -> dict:
    folder = pathlib.Path(tempfile.mkdtemp(prefix="dsbuild-bench-"))
    try:
        write_tree(folder, models)
        print(f"making {models * VIEWS} images with fake_build, and as many steps with ninja", file=sys.stderr)
        subprocess.run([options.build / "fake_build", "tiny.toml", "out"], cwd=folder, check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        dsbuild = str(options.build / "dsbuild")
        commands = {"dsbuild build": [dsbuild, "build", "tiny.toml", "-o", "out"],
                    "dsbuild status": [dsbuild, "status", "tiny.toml", "-o", "out"],
                    "dsbuild plan": [dsbuild, "plan", "tiny.toml", "-o", "out"],
                    "dsbuild plan, no database": [dsbuild, "plan", "tiny.toml", "-o", "nowhere"]}
        if shutil.which("ninja"):
            subprocess.run(["ninja", "--quiet"], cwd=folder, check=True)
            commands["ninja"] = ["ninja"]
        runs = {name: [] for name in commands}
        for turn in range(options.repeats + 1):
            for name, command in commands.items():
                result = measure(command, folder)
                if turn > 0:  # the first brings files into memory
                    runs[name].append(result)
        if "0 built" not in runs["dsbuild build"][-1]["text"]:
            sys.exit("there was something to do: " + runs["dsbuild build"][-1]["text"])
        return runs
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def summary(results: list, peers: list) -> dict:
    """`peers`: ninja's results of the same turns; what slows the machine slows both of a turn."""
    seconds = [result["seconds"] for result in results]
    over = [result["cpu_seconds"] / peer["cpu_seconds"] for result, peer in zip(results, peers)]
    return {"seconds": statistics.median(seconds), "least": min(seconds), "most": max(seconds),
            "over_ninja": statistics.median(over) if over else None,
            "cpu_seconds": statistics.median(result["cpu_seconds"] for result in results),
            "mb": max(result["mb"] for result in results)}


def processor() -> str:
    lines = pathlib.Path("/proc/cpuinfo").read_text().splitlines()
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return f"{names[0] if names else 'unknown'}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}"


def main() -> None:
    options = arguments()
    report = {"processor": processor(), "sizes": {}}
    print(report["processor"])
    for models in options.models:
        runs = run(options, models)
        figures = {name: summary(results, runs.get("ninja", [])) for name, results in runs.items()}
        report["sizes"][models * VIEWS] = figures
        rows = [[name, f"{f['seconds']:.3f}", f"{f['least']:.3f} .. {f['most']:.3f}", f"{f['cpu_seconds']:.3f}",
                 f"{f['over_ninja']:.2f}" if f["over_ninja"] else "", f"{f['mb']:.0f}"]
                for name, f in figures.items()]
        print(f"\n{models * VIEWS} images, {2 * models * VIEWS} files")
        print(table(["command", "s", "least .. most", "CPU s", "over ninja", "MB"], rows))
    most = report["sizes"][max(report["sizes"])]
    no_ops = [most[name] for name in ("dsbuild build", "dsbuild status", "dsbuild plan")]
    first = most["dsbuild plan, no database"]["seconds"]
    goals = [goal("slowest command with nothing to do, s", max(f["seconds"] for f in no_ops), f"<= {GOAL_SECONDS:g}",
                  max(f["seconds"] for f in no_ops) <= GOAL_SECONDS),
             goal("most memory of one, MB", max(f["mb"] for f in no_ops), f"<= {GOAL_MB:g}",
                  max(f["mb"] for f in no_ops) <= GOAL_MB),
             goal("first plan without a database, s", first, f"<= {GOAL_FIRST_SECONDS:g}", first <= GOAL_FIRST_SECONDS)]
    print()
    for one in goals:
        print(goal_line(one))
    options.out.mkdir(parents=True, exist_ok=True)
    (options.out / "nothing_to_do.json").write_text(json.dumps(plain({**report, "goals": goals}), indent=1) + "\n")


if __name__ == "__main__":
    main()
