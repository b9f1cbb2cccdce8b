# SPDX-License-Identifier: Apache-2.0
"""LuxCore's PATHCPU on the same SDL files: peer_luxcore.py MATERIAL ENVIRONMENT FOLDER.

FOLDER is what render_bench wrote: the normalised model, camera and engine settings come from there; materials, lights
and the rest of the scene are read by LuxCore itself from the files dsbuild reads.
"""
import json
import os
import pathlib
import re
import sys
import time

import peer_protocol

# Debian's PoCL and the one thing pyluxcore asks of it end in a double free; PATHCPU needs no OpenCL at all.
os.environ["OCL_ICD_VENDORS"] = "/nonexistent"
ANSWERS = peer_protocol.take_standard_output()

import numpy as np  # noqa: E402
import pyluxcore  # noqa: E402

POLL_SECONDS = 0.01


def properties(prefix: str, values: dict) -> "pyluxcore.Properties":
    result = pyluxcore.Properties()
    for name, value in values.items():
        result.Set(pyluxcore.Property(f"{prefix}.{name}", value))
    return result


def last_material(file: pathlib.Path) -> str:
    """The material a file is for is the last one it defines."""
    return re.findall(r"^scene\.materials\.([^.\s]+)\.type", file.read_text(encoding="utf-8"), re.MULTILINE)[-1]


def load_scene(material: pathlib.Path, environment: pathlib.Path, folder: pathlib.Path, camera: dict):
    os.chdir(environment)  # file names in the SDL are relative to it
    scene = pyluxcore.Scene()
    scene.Parse(pyluxcore.Properties(str(material)))
    scene.Parse(pyluxcore.Properties(str(environment / "environment.scn")))
    scene.Parse(properties("scene.objects.bench-model", {
        "ply": str(folder / "model.ply"), "material": last_material(material), "id": 1}))
    scene.Parse(properties("scene.camera", {
        "type": "perspective", "lookat.orig": camera["position"], "lookat.target": camera["target"],
        "up": camera["up"], "fieldofview": camera["fov_deg"], "lensradius": 0.0, "autovolume.enable": False}))
    return scene


def config_of(engine: dict, width: int, height: int, seed: int):
    """LuxCore's filter width is half of what the filter covers."""
    half_width = engine["filter_width"] / 2
    config = pyluxcore.Properties()
    config.Set(properties("renderengine", {"type": "PATHCPU", "seed": seed + 1}))
    config.Set(properties("sampler", {"type": "SOBOL"}))
    config.Set(properties("path", {
        "pathdepth.total": engine["depth_total"], "pathdepth.diffuse": engine["depth_diffuse"],
        "pathdepth.glossy": engine["depth_glossy"], "pathdepth.specular": engine["depth_specular"],
        "russianroulette.depth": engine["roulette_depth"], "russianroulette.cap": engine["roulette_cap"],
        "clamping.variance.maxvalue": 0.0}))
    config.Set(properties("film", {
        "width": width, "height": height,
        "filter.type": "BLACKMANHARRIS" if half_width > 0 else "BOX",
        "filter.width": half_width if half_width > 0 else 0.5,
        "outputs.0.type": "RGB", "outputs.0.filename": "unused.exr"}))
    return config


def render(scene, engine: dict, width: int, height: int, spp: int, seed: int) -> peer_protocol.Picture:
    """Runs until the film's own count says `spp`. The clock starts with the first samples, so that LuxCore's
    preparation (its BVH, its light tables) is not in it, as dsbuild's is not."""
    session = pyluxcore.RenderSession(pyluxcore.RenderConfig(config_of(engine, width, height, seed), scene))

    def samples() -> float:
        session.UpdateStats()
        return session.GetStats().Get("stats.renderengine.total.samplecount").GetFloat()

    session.Start()
    while (first := samples()) == 0:
        time.sleep(POLL_SECONDS / 10)
    begin, cpu_begin = time.perf_counter(), time.process_time()
    while (last := samples()) < spp * width * height:
        time.sleep(POLL_SECONDS)
    seconds, cpu_seconds = time.perf_counter() - begin, time.process_time() - cpu_begin
    session.Stop()
    count = max(samples(), last)
    whole = count / (last - first)  # what was traced before the clock and while it stopped is in the film too
    pixels = np.zeros(width * height * 3, dtype=np.float32)
    session.GetFilm().GetOutputFloat(pyluxcore.FilmOutputType.RGB, pixels, 0)
    return peer_protocol.Picture(seconds * whole, cpu_seconds * whole, count,
                                 pixels.reshape(height, width, 3)[::-1])


def main() -> None:
    material, environment, folder = (pathlib.Path(a).resolve() for a in sys.argv[1:4])
    exported = json.loads((folder / "scene.json").read_text(encoding="utf-8"))
    pyluxcore.Init()
    scene = load_scene(material, environment, folder, exported["camera"])
    peer_protocol.serve(ANSWERS, f"LuxCore {pyluxcore.Version()} PATHCPU",
                        lambda *request: render(scene, exported["engine"], *request))


if __name__ == "__main__":
    main()
