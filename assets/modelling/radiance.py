# SPDX-License-Identifier: CC0-1.0
"""Radiance RGBE pictures with run-length coded lines (G. Ward, "Real Pixels", Graphics Gems II)."""
import math


def rgbe(r, g, b):
    """Shared-exponent bytes of a colour; each component is good to one part in 256 of the largest."""
    top = max(r, g, b)
    if top < 1e-32:
        return 0, 0, 0, 0
    exponent = math.frexp(top)[1]
    scale = math.ldexp(256.0, -exponent)
    return int(r * scale), int(g * scale), int(b * scale), exponent + 128


def write_hdr(path, width, rows):
    """`rows` holds lines of (r, g, b), the top one first."""
    with open(path, "wb") as file:
        file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (len(rows), width))
        for row in rows:
            file.write(bytes((2, 2, width >> 8, width & 255)))
            for channel in zip(*(rgbe(*pixel) for pixel in row)):
                file.write(_packed(channel))


def _packed(values):
    """Runs of four and more as (128 + length, value), the rest as (length, values...)."""
    result, literal, i = bytearray(), bytearray(), 0

    def flush():
        for k in range(0, len(literal), 128):
            piece = literal[k:k + 128]
            result.append(len(piece))
            result.extend(piece)
        literal.clear()

    while i < len(values):
        run = 1
        while i + run < len(values) and run < 127 and values[i + run] == values[i]:
            run += 1
        if run >= 4:
            flush()
            result.extend((128 + run, values[i]))
        else:
            literal.extend(values[i:i + run])
        i += run
    flush()
    return bytes(result)
