# SPDX-License-Identifier: Apache-2.0
"""Medians with spread, and errors of films."""
import statistics
from typing import NamedTuple

LUMINANCE = (0.212671, 0.715160, 0.072169)
WORST_SHARE = 0.001


class Spread(NamedTuple):
    median: float
    least: float
    most: float

    def text(self, digits: int = 2) -> str:
        return f"{self.median:.{digits}f} [{self.least:.{digits}f}, {self.most:.{digits}f}]"


def spread(values: list) -> Spread:
    return Spread(statistics.median(values), min(values), max(values))


def ratios(ours: list, theirs: list) -> Spread:
    """Of runs that stood side by side in time, pair by pair: what slows both down falls out."""
    return spread([a / b for a, b in zip(ours, theirs)])


def relative_errors(film, reference):
    """(without the worst 0.1 % of pixels, plain): the mean over pixels of the mean over r, g, b of
    (film - reference)^2 / (reference^2 + e), e = (mean luminance of the reference / 10)^2, which keeps black pixels
    from ruling."""
    import numpy as np
    reference = reference.astype(np.float64)
    floor = (0.1 * float((reference @ np.array(LUMINANCE)).mean())) ** 2
    pixels = np.sort((((film - reference) ** 2) / (reference ** 2 + floor)).mean(axis=2).ravel())
    kept = len(pixels) - max(1, round(WORST_SHARE * len(pixels)))
    return float(pixels[:kept].mean()), float(pixels.mean())


def read_film(file, size: int):
    import numpy as np
    return np.fromfile(file, np.float32).reshape(size, size, 3)


def mean_luminance(film) -> float:
    import numpy as np
    return float((film.astype(np.float64) @ np.array(LUMINANCE)).mean())
