# SPDX-License-Identifier: Apache-2.0
"""The peers' side of the protocol of render_bench.cc: requests on standard input, answers on standard output."""
import json
import os
import sys
from typing import Callable, NamedTuple

import numpy as np


class Picture(NamedTuple):
    seconds: float  # of tracing alone
    cpu_seconds: float  # of all threads
    samples: float  # traced in that time and all in `rgb`
    rgb: np.ndarray  # height x width x 3, linear, row 0 at the top


def take_standard_output():
    """The stream for answers. What the renderers print themselves goes to standard error from here on."""
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    return answers


def serve(answers, name: str, render: Callable[[int, int, int, int], Picture]) -> None:
    """Answers requests until standard input ends. `render` takes width, height, samples a pixel, seed."""
    def answer(entry: dict) -> None:
        print(json.dumps(entry), file=answers, flush=True)

    answer({"name": name})
    for line in sys.stdin:
        width, height, spp, seed, file = line.split()
        picture = render(int(width), int(height), int(spp), int(seed))
        np.ascontiguousarray(picture.rgb, dtype=np.float32).tofile(file)
        answer({"seconds": picture.seconds, "cpu_seconds": picture.cpu_seconds, "samples": picture.samples})
