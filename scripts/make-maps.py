#!/usr/bin/env python3
"""Writes a table of color maps below crates/figure/src/color_by/maps: for each name 256 colors of three bytes. The names
are in the order of `CRAMERI` and `MATPLOTLIB` in crates/figure/src/color_by/maps.rs. The sources are Crameri's Scientific
colour maps, as the package cmcrameri (MIT) has them, and Matplotlib (license in maps/LICENSE-matplotlib).

    pip install --target /tmp/maps cmcrameri matplotlib
    scripts/make-maps.py /tmp/maps/cmcrameri/cmaps > crates/figure/src/color_by/maps/crameri.rgb
    PYTHONPATH=/tmp/maps scripts/make-maps.py matplotlib > crates/figure/src/color_by/maps/matplotlib.rgb
"""
import pathlib
import sys

CRAMERI = """acton bam bamako batlow batlowK batlowW berlin bilbao broc buda bukavu cork davos devon fes glasgow grayC
hawaii imola lajolla lapaz lipari lisbon managua navia nuuk oleron oslo roma tofino tokyo turku vanimo vik
bamO brocO corkO romaO vikO""".split()
MATPLOTLIB = "jet coolwarm hot bwr seismic hsv".split()


def rows_of(name):
    if sys.argv[1] == "matplotlib":
        from matplotlib import colormaps
        return [colormaps[name](index)[:3] for index in range(256)]
    lines = (pathlib.Path(sys.argv[1]) / f"{name}.txt").read_text().split("\n")
    return [[float(x) for x in line.split()] for line in lines if line.strip()]


for name in MATPLOTLIB if sys.argv[1] == "matplotlib" else CRAMERI:
    rows = rows_of(name)
    assert len(rows) == 256, name
    sys.stdout.buffer.write(bytes(min(255, int(c * 255 + 0.5)) for row in rows for c in row))
