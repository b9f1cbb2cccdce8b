# SPDX-License-Identifier: Apache-2.0
"""Films side by side as one PNG, to see that all renderers were given the same picture."""
import struct
import zlib

import numpy as np

from statistics_of_runs import mean_luminance

MIDDLE_GREY = 0.4


def chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def write_side_by_side(file, films: list) -> None:
    """All with the exposure that suits the first, gamma 2.2."""
    factor = MIDDLE_GREY / max(mean_luminance(films[0]), 1e-30)
    row = np.concatenate([np.asarray(f, dtype=np.float64) for f in films], axis=1)
    pixels = (255 * np.clip(row * factor, 0, 1) ** (1 / 2.2) + 0.5).astype(np.uint8)
    height, width, _ = pixels.shape
    lines = b"".join(b"\0" + pixels[y].tobytes() for y in range(height))
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    file.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(lines))
                     + chunk(b"IEND", b""))
