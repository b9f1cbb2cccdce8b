# SPDX-License-Identifier: Apache-2.0
"""Mitsuba on an equivalent scene: peer_mitsuba.py VARIANT FOLDER.

FOLDER is what render_bench wrote. llvm_ad_rgb needs LLVM 19 (DRJIT_LIBLLVM_PATH); scalar_rgb needs nothing.
"""
import json
import pathlib
import sys
import time

import peer_protocol

ANSWERS = peer_protocol.take_standard_output()

import mitsuba as mi  # noqa: E402
import numpy as np  # noqa: E402

# Samples a pass: what a pass keeps for each one has to fit the memory.
MOST_SAMPLES_A_PASS = 1 << 24


class Renderer:
    def __init__(self, folder: pathlib.Path):
        import mitsuba_scene  # after the variant is set
        self.translate = mitsuba_scene
        self.exported = json.loads((folder / "scene.json").read_text(encoding="utf-8"))
        self.scene = mitsuba_scene.load(mi, self.exported, folder)
        self.sensors = {}

    def sensor(self, width: int, height: int):
        """The first picture of a size compiles, and compiles again for the first count of samples that is no power of
        two (it divides where the other shifts). Those two are not timed."""
        if (width, height) not in self.sensors:
            sensor = mi.load_dict(self.translate.sensor(mi, self.exported, width, height))
            for spp in (3, 4):
                np.array(mi.render(self.scene, sensor=sensor, spp=spp))
            self.sensors[width, height] = sensor
        return self.sensors[width, height]

    def render(self, width: int, height: int, spp: int, seed: int) -> peer_protocol.Picture:
        sensor = self.sensor(width, height)
        most = max(1, MOST_SAMPLES_A_PASS // (width * height))
        passes = [most] * (spp // most) + ([spp % most] if spp % most else [])
        total = np.zeros((height, width, 3))
        begin, cpu_begin = time.perf_counter(), time.process_time()
        for i, part in enumerate(passes):
            image = mi.render(self.scene, sensor=sensor, spp=part, seed=seed * 65536 + i)
            total += np.array(image, dtype=np.float64)[:, :, :3] * (part / spp)
        return peer_protocol.Picture(time.perf_counter() - begin, time.process_time() - cpu_begin,
                                     width * height * spp, total)


def main() -> None:
    mi.set_variant(sys.argv[1])
    renderer = Renderer(pathlib.Path(sys.argv[2]).resolve())
    peer_protocol.serve(ANSWERS, f"Mitsuba {mi.__version__} {sys.argv[1]}", renderer.render)


if __name__ == "__main__":
    main()
