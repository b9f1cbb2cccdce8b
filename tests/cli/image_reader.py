# SPDX-License-Identifier: Apache-2.0
"""Reads the PNG and EXR files that dsbuild writes, by their specifications and with Python's standard library alone."""
import itertools
import pathlib
import struct
import zlib


def read_png(path: pathlib.Path):
    """Width, height, channels, bits, and samples row by row, interleaved."""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", path
    at, packed, header = 8, b"", None
    while at < len(data):
        size, name = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        assert zlib.crc32(name + body) == struct.unpack(">I", data[at + 8 + size:at + 12 + size])[0], path
        if name == b"IHDR":
            header = struct.unpack(">IIBBBBB", body)
        elif name == b"IDAT":
            packed += body
        at += 12 + size
    width, height, bits, colour, _, _, interlaced = header
    assert interlaced == 0 and bits in (8, 16)
    channels = {0: 1, 2: 3, 6: 4}[colour]
    pixel = channels * bits // 8
    raw, rows, above = zlib.decompress(packed), [], bytes(width * pixel)
    for y in range(height):
        line = bytearray(raw[y * (width * pixel + 1):(y + 1) * (width * pixel + 1)])
        above = unfiltered(line[0], line[1:], above, pixel)
        rows.append(bytes(above))
    samples = b"".join(rows)
    values = list(samples) if bits == 8 else list(struct.unpack(f">{len(samples) // 2}H", samples))
    return width, height, channels, bits, values


def unfiltered(kind, line, above, pixel):
    """PNG, 9.2."""
    for i in range(len(line)):
        left = line[i - pixel] if i >= pixel else 0
        corner = above[i - pixel] if i >= pixel else 0
        guess = left + above[i] - corner
        paeth = min((left, above[i], corner), key=lambda v, g=guess: abs(g - v))
        line[i] = (line[i] + [0, left, above[i], (left + above[i]) // 2, paeth][kind]) & 255
    return line


def read_exr(path: pathlib.Path):
    """Width, height, and channel -> samples row by row: of a scan line file, float or half, ZIP."""
    data = path.read_bytes()
    magic, version = struct.unpack("<II", data[:8])
    assert magic == 20000630 and version == 2, path
    at, header = 8, {}
    while data[at] != 0:
        name, at = text_at(data, at)
        _, at = text_at(data, at)
        size = struct.unpack("<I", data[at:at + 4])[0]
        header[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    assert header["compression"] == b"\x03", header["compression"]  # ZIP: blocks of 16 lines
    x0, y0, x1, y1 = struct.unpack("<4i", header["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    channels, place = [], 0
    while header["channels"][place] != 0:
        name, place = text_at(header["channels"], place)
        channels.append((name, {1: "e", 2: "f"}[struct.unpack("<I", header["channels"][place:place + 4])[0]]))
        place += 16
    planes = {name: [] for name, _ in channels}
    blocks = (height + 15) // 16
    for offset in struct.unpack(f"<{blocks}Q", data[at + 1:at + 1 + 8 * blocks]):
        y, size = struct.unpack("<iI", data[offset:offset + 8])
        lines = min(16, y1 + 1 - y)
        wanted = lines * width * sum(struct.calcsize(kind) for _, kind in channels)
        block, place = unpacked(data[offset + 8:offset + 8 + size], wanted), 0
        for _ in range(lines):
            for name, kind in channels:
                end = place + width * struct.calcsize(kind)
                planes[name] += struct.unpack(f"<{width}{kind}", block[place:end])
                place = end
    return width, height, planes


def unpacked(block: bytes, wanted: int) -> bytes:
    """OpenEXR's ZIP: deflate over differences over the even bytes and then the odd ones. What gains nothing is as it is."""
    if len(block) == wanted:
        return block
    summed = bytes(itertools.accumulate(zlib.decompress(block), lambda a, b: (a + b - 128) & 255))
    half = (len(summed) + 1) // 2
    joined = bytearray(len(summed))
    joined[0::2], joined[1::2] = summed[:half], summed[half:]
    return bytes(joined)


def text_at(data: bytes, at: int):
    end = data.index(0, at)
    return data[at:end].decode(), end + 1
