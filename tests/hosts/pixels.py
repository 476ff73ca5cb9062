#!/usr/bin/env python3
"""Screenshots of Xvfb, and comparisons of pictures, with nothing but Python's standard library.

    pixels.py shot SCREEN.xwd WIDTHxHEIGHT+X+Y OUT.png   writes a part of the screen
    pixels.py colors A.png                               prints the number of different colours
    pixels.py color A.png X Y                            prints the colour of a pixel as [R, G, B]
    pixels.py differ A.png B.png                         prints the share of pixels that differ, in percent
    pixels.py seen SPHERES.png SCREEN.png X Y            of the pixels of SPHERES.png that differ from its pixel (X, Y):
                                                         prints the share that SCREEN.png has as well, in percent

Pixels differ if a channel differs by more than 2 of 255.
"""

import re
import struct
import sys
import zlib

TOLERANCE = 2


def read_screen(path):
    """The screen of `Xvfb -fbdir`, a file in the format of xwd, as rows of RGB bytes."""
    with open(path, "rb") as file:
        data = file.read()
    header = struct.unpack(">25I", data[:100])
    size, width, height = header[0], header[4], header[5]
    byte_order, bits, bytes_per_line, colors = header[7], header[11], header[12], header[19]
    if bits != 32 or byte_order != 0:
        sys.exit(f"{path} has {bits} bits per pixel and byte order {byte_order}; start Xvfb with 24 bits")
    start = size + 12 * colors
    rows = []
    for y in range(height):
        line = data[start + y * bytes_per_line :][: 4 * width]
        row = bytearray(3 * width)
        row[0::3], row[1::3], row[2::3] = line[2::4], line[1::4], line[0::4]
        rows.append(bytes(row))
    return rows


def write_png(path, rows):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", len(rows[0]) // 3, len(rows), 8, 2, 0, 0, 0)
    data = zlib.compress(b"".join(b"\0" + row for row in rows), 6)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", data) + chunk(b"IEND", b""))


def read_png(path):
    """Rows of RGB bytes of a PNG file with 8 bits and without interlacing."""
    with open(path, "rb") as file:
        data = file.read()
    at, packed = 8, b""
    while at < len(data):
        length = struct.unpack(">I", data[at : at + 4])[0]
        kind, body = data[at + 4 : at + 8], data[at + 8 : at + 8 + length]
        if kind == b"IHDR":
            width, height, bits, color, _, _, interlaced = struct.unpack(">IIBBBBB", body)
        elif kind == b"IDAT":
            packed += body
        at += 12 + length
    if bits != 8 or color not in (2, 6) or interlaced:
        sys.exit(f"{path} is not an RGB or RGBA picture with 8 bits")
    channels = 3 if color == 2 else 4
    stride = channels * width
    raw, before, rows = zlib.decompress(packed), bytearray(stride), []
    for y in range(height):
        method, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1 :][:stride])
        for i in range(stride) if method else ():
            left = line[i - channels] if i >= channels else 0
            up, corner = before[i], before[i - channels] if i >= channels else 0
            if method == 1:
                add = left
            elif method == 2:
                add = up
            elif method == 3:
                add = (left + up) // 2
            else:
                p = left + up - corner
                add = min((abs(p - left), 0, left), (abs(p - up), 1, up), (abs(p - corner), 2, corner))[2]
            line[i] = (line[i] + add) & 255
        before = line
        if channels == 4:
            rgb = bytearray(3 * width)
            rgb[0::3], rgb[1::3], rgb[2::3] = line[0::4], line[1::4], line[2::4]
            line = rgb
        rows.append(bytes(line))
    return rows


def pixels(rows):
    """Pixels as (r, g, b)."""
    data = b"".join(rows)
    return zip(data[0::3], data[1::3], data[2::3])


def is_other(a, b):
    return any(abs(x - y) > TOLERANCE for x, y in zip(a, b))


def differ(a, b):
    if (len(a), len(a[0])) != (len(b), len(b[0])):
        return 100.0
    count = len(a) * len(a[0]) // 3
    return 100 * sum(p != q and is_other(p, q) for p, q in zip(pixels(a), pixels(b))) / count


def main(command, *arguments):
    if command == "shot":
        screen, place, out = arguments
        width, height, x, y = map(int, re.fullmatch(r"(\d+)x(\d+)\+(\d+)\+(\d+)", place).groups())
        rows = read_screen(screen) if screen.endswith("screen0") else read_png(screen)
        write_png(out, [row[3 * x : 3 * (x + width)] for row in rows[y : y + height]])
    elif command == "colors":
        print(len(set(pixels(read_png(arguments[0])))))
    elif command == "color":
        path, x, y = arguments[0], int(arguments[1]), int(arguments[2])
        print(list(read_png(path)[y][3 * x : 3 * x + 3]))
    elif command == "differ":
        print(f"{differ(*map(read_png, arguments)):.3f}")
    elif command == "seen":
        spheres, screen = map(read_png, arguments[:2])
        x, y = map(int, arguments[2:])
        empty = tuple(spheres[y][3 * x : 3 * x + 3])
        both = [(p, q) for p, q in zip(pixels(spheres), pixels(screen)) if is_other(p, empty)]
        print(f"{100 * sum(not is_other(p, q) for p, q in both) / max(len(both), 1):.1f}")
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main(*(sys.argv[1:] or ["help"]))
