#!/usr/bin/env python3
"""Writes examples/sky.hdr: 64 x 32 texels of a clear sky with a low sun over brown ground, as Radiance RGBE.

    scripts/make-sky.py > examples/sky.hdr
"""
import math
import sys

WIDTH, HEIGHT = 64, 32
SUN = (0.6, 0.45, -0.66)


def radiance(x, y, z):
    if y < 0:
        return [0.18 * (1 + y), 0.15 * (1 + y), 0.12 * (1 + y)]
    toward_sun = max(0.0, x * SUN[0] + y * SUN[1] + z * SUN[2])
    glow = 0.6 * toward_sun**8 + (60.0 if toward_sun > 0.99 else 0.0)
    sky = [0.55 - 0.4 * y, 0.7 - 0.35 * y, 0.9 - 0.1 * y]
    return [c + glow * tint for c, tint in zip(sky, (1.0, 0.85, 0.6))]


def rgbe(rgb):
    largest = max(rgb)
    fraction, exponent = math.frexp(largest)
    scale = fraction * 256 / largest
    return bytes([*(int(c * scale) for c in rgb), exponent + 128])


out = sys.stdout.buffer
out.write(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {HEIGHT} +X {WIDTH}\n".encode())
for row in range(HEIGHT):
    latitude = math.pi * (0.5 - (row + 0.5) / HEIGHT)
    for column in range(WIDTH):
        # The middle is -z, to its right +x.
        angle = 2 * math.pi * ((column + 0.5) / WIDTH - 0.5)
        ring = math.cos(latitude)
        out.write(rgbe(radiance(ring * math.sin(angle), math.sin(latitude), -ring * math.cos(angle))))
