#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""dsbuild beside LuxCore, Mitsuba and Embree: one table, and the same as JSON. ci/bench builds and calls this.

Renderers take turns (A B C A B C), so that what else the machine does falls on all of them; every ratio is of
neighbours in time, and every figure is a median with its least and greatest.
"""
import argparse
import json
import os
import pathlib
import platform
import subprocess
import sys
import time

import report
from statistics_of_runs import mean_luminance, ratios, read_film, relative_errors, spread
from workers import Answer, Failed, Worker

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
SCENES = [("studio", "red-plastic"), ("office", "rough-aluminium"), ("outdoor", "marbled-plastic")]
REFERENCE_SEED, FIRST_SEED = 900, 1


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/bench", help="folder of the programs")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "build/bench", help="folder of results.json")
    parser.add_argument("--model", type=pathlib.Path, default=ROOT / "assets/models/mug-1.ply")
    parser.add_argument("--scenes", default=",".join(s for s, _ in SCENES), help="which, with commas between")
    parser.add_argument("--size", type=int, default=512, help="pixels a side where samples a second are measured")
    parser.add_argument("--spp", type=int, default=64, help="samples a pixel there")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--error-size", type=int, default=128, help="pixels a side where the error is measured")
    parser.add_argument("--error-seconds", type=float, default=1.5, help="each renderer's time for one picture there")
    parser.add_argument("--reference", type=int, default=32, help="samples of a reference, in such pictures")
    parser.add_argument("--ray-repeats", type=int, default=9)
    parser.add_argument("--filter-width", type=float, default=3.0, help="pixels; 0: a box of one pixel for all")
    parser.add_argument("--quick", action="store_true", help="three minutes: small pictures, poor references")
    options = parser.parse_args()
    if options.quick:
        options.size, options.spp, options.error_seconds, options.reference, options.ray_repeats = 192, 32, 0.5, 8, 5
    return options


def peer_python(build: pathlib.Path):
    python = build / "venv/bin/python"
    return python if python.exists() else None


def has_module(python, name: str) -> bool:
    return python is not None and subprocess.run([python, "-c", f"import importlib.util as u, sys; "
                                                  f"sys.exit(u.find_spec('{name}') is None)"]).returncode == 0


def mitsuba_setting(build: pathlib.Path):
    """llvm where ci/bench could get LLVM 19, else scalar."""
    library = build / "llvm/usr/lib/x86_64-linux-gnu/libLLVM.so.19.1"
    if library.exists():
        return "llvm_ad_rgb", {"DRJIT_LIBLLVM_PATH": str(library)}
    return "scalar_rgb", {}


def start_workers(options, environment: str, material: str, folder: pathlib.Path, notes: dict) -> dict:
    """Label -> Worker, dsbuild first: it writes what the others read. A peer that is not there goes to `notes`."""
    scene = ROOT / "assets/environments" / environment
    material_file = ROOT / "assets/materials" / f"{material}.mat"
    folder.mkdir(parents=True, exist_ok=True)
    workers = {"dsbuild": Worker("dsbuild", [options.build / "render_bench", options.model, material_file, scene,
                                             folder, options.filter_width], folder / "dsbuild.log")}
    python = peer_python(options.build)
    variant, variables = mitsuba_setting(options.build)
    peers = [("luxcore", "pyluxcore", [HERE / "peer_luxcore.py", material_file, scene, folder], {}),
             ("mitsuba", "mitsuba", [HERE / "peer_mitsuba.py", variant, folder], variables)]
    for label, module, command, extra in peers:
        if not has_module(python, module):
            notes[label] = "not installed"
            continue
        try:
            workers[label] = Worker(label, [python] + command, folder / f"{label}.log", extra)
        except Failed as failure:
            notes[label] = str(failure)
    return workers


def take_turns(workers: dict, notes: dict, repeats: int, trace) -> dict:
    """Label -> answers; `trace` takes worker, label, round. A peer that fails leaves the round for good."""
    answers = {label: [] for label in workers}
    for turn in range(repeats):
        for label in list(workers):
            try:
                answers[label].append(trace(workers[label], label, turn))
            except Failed as failure:
                if label == "dsbuild":
                    raise
                notes[label] = str(failure)
                del workers[label], answers[label]
    return answers


def measure_rates(options, workers: dict, folder: pathlib.Path, notes: dict) -> dict:
    answers = take_turns(workers, notes, options.repeats, lambda worker, label, turn: worker.trace(
        options.size, options.spp, FIRST_SEED + turn, folder / f"{label}-rate.f32"))
    rates = {label: [a.msamples_per_second() for a in runs] for label, runs in answers.items()}
    busy = {label: [a.msamples_per_cpu_second() for a in runs] for label, runs in answers.items()}
    return {label: {"msamples_per_second": spread(rates[label]), "msamples_per_cpu_second": spread(busy[label]),
                    "dsbuild_over_it": ratios(rates["dsbuild"], rates[label]),
                    "dsbuild_over_it_by_cpu_time": ratios(busy["dsbuild"], busy[label])} for label in rates}


def spp_for(worker: Worker, options, film: pathlib.Path) -> int:
    """What a renderer traces in the time given. The first picture of a size warms up, the second is measured."""
    size, spp = options.error_size, 4
    worker.trace(size, spp, FIRST_SEED, film)
    answer = worker.trace(size, 4 * spp, FIRST_SEED, film)
    return max(1, round(options.error_seconds * answer.samples / answer.seconds / size ** 2))


def error_of(options, answer: Answer, reference) -> tuple:
    """Errors as they were after exactly the time given: the square error of unbiased samples falls as 1 / time."""
    film = read_film(answer.film, options.error_size)
    return tuple(e * answer.seconds / options.error_seconds for e in relative_errors(film, reference))


def measure_errors(options, workers: dict, folder: pathlib.Path, notes: dict) -> dict:
    spp = {label: runs[0] for label, runs in take_turns(workers, notes, 1, lambda worker, label, turn: spp_for(
        worker, options, folder / f"{label}-warm.f32")).items()}
    size = options.error_size
    runs = take_turns(workers, notes, options.repeats, lambda worker, label, turn: worker.trace(
        size, spp[label], FIRST_SEED + turn, folder / f"{label}-error-{turn}.f32"))
    references = take_turns(workers, notes, 1, lambda worker, label, turn: worker.trace(
        size, spp[label] * options.reference, REFERENCE_SEED, folder / f"{label}-reference.f32"))
    films = {label: read_film(answers[0].film, size) for label, answers in references.items()}
    import pictures
    pictures.write_side_by_side(folder / "side-by-side.png", list(films.values()))
    errors = {label: [error_of(options, a, films[label]) for a in runs[label]] for label in films}
    result = {}
    for label, pairs in errors.items():
        result[label] = {"spp": spp[label],
                         "seconds": spread([a.seconds for a in runs[label]]),
                         "mean_luminance": mean_luminance(films[label]),
                         "dsbuild_mean_luminance_over_it": mean_luminance(films["dsbuild"]) / mean_luminance(films[label])}
        for column, name in enumerate(("relmse_trimmed", "relmse")):
            ours, theirs = [p[column] for p in errors["dsbuild"]], [p[column] for p in pairs]
            result[label][name] = spread(theirs)
            result[label][f"dsbuild_over_it_{name}"] = ratios(ours, theirs)
    return result


def measure_scene(options, environment: str, material: str) -> dict:
    notes, names = {}, {}
    folder = options.out / "films" / environment
    workers = start_workers(options, environment, material, folder, notes)
    try:
        names = {label: worker.name for label, worker in workers.items()}
        rates = measure_rates(options, workers, folder, notes)
        print(f"  {environment}: samples a second measured", file=sys.stderr)
        # The errors need numpy, which comes with the peers.
        errors = measure_errors(options, workers, folder, notes) if len(workers) > 1 else {}
        print(f"  {environment}: errors measured", file=sys.stderr)
    finally:
        for worker in workers.values():
            worker.close()
    return {"material": material, "names": names, "notes": notes, "rates": rates, "errors": errors}


def measure_rays(options) -> dict:
    run = subprocess.run([options.build / "ray_bench", str(options.ray_repeats)], check=True, capture_output=True,
                         text=True)
    raw = json.loads(run.stdout)
    for kind in ("camera", "bounce"):
        ours, theirs = raw[kind]["dsbuild"], raw[kind]["embree"]
        raw[kind] |= {"dsbuild": spread(ours), "embree": spread(theirs), "dsbuild_over_embree": ratios(ours, theirs)}
    return raw


def machine() -> dict:
    model = next((line.split(":", 1)[1].strip() for line in open("/proc/cpuinfo", encoding="utf-8")
                  if line.startswith("model name")), platform.processor())
    return {"cpu": model, "cores": os.cpu_count(), "system": platform.platform(), "load_before": os.getloadavg()[0]}


def main() -> int:
    options = arguments()
    options.out.mkdir(parents=True, exist_ok=True)
    begin = time.monotonic()
    settings = {name: str(value) if isinstance(value, pathlib.Path) else value
                for name, value in vars(options).items()}
    results = {"machine": machine(), "settings": settings, "rays": measure_rays(options), "scenes": {}}
    for environment, material in SCENES:
        if environment in options.scenes.split(","):
            results["scenes"][environment] = measure_scene(options, environment, material)
    results["wall_seconds"] = time.monotonic() - begin
    results["goals"] = report.goals(results)
    (options.out / "results.json").write_text(json.dumps(report.plain(results), indent=1) + "\n", encoding="utf-8")
    print(report.text(results))
    print(f"\nwritten: {options.out / 'results.json'}, {options.out / 'films'}/*/side-by-side.png")
    return 0


if __name__ == "__main__":
    # numpy comes with the peers: run with their Python where there is one.
    wanted = peer_python(arguments().build)
    if wanted and pathlib.Path(sys.executable) != wanted.absolute():
        os.execv(wanted, [str(wanted), __file__] + sys.argv[1:])
    sys.exit(main())
