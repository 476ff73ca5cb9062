#!/usr/bin/env python3
"""Writes crates/figure/src/color_by/maps/crameri.rgb: for each name below 256 colors of three bytes, from the tables of Crameri's
Scientific colour maps, as the package cmcrameri (MIT) has them.

    pip install --no-deps --target /tmp/maps cmcrameri
    scripts/make-maps.py /tmp/maps/cmcrameri/cmaps > crates/figure/src/color_by/maps/crameri.rgb
"""
import pathlib
import sys

# The order of `CRAMERI` in crates/figure/src/color_by/maps.rs.
NAMES = """acton bam bamako batlow batlowK batlowW berlin bilbao broc buda bukavu cork davos devon fes glasgow grayC
hawaii imola lajolla lapaz lipari lisbon managua navia nuuk oleron oslo roma tofino tokyo turku vanimo vik
bamO brocO corkO romaO vikO""".split()

for name in NAMES:
    lines = (pathlib.Path(sys.argv[1]) / f"{name}.txt").read_text().split("\n")
    rows = [[float(x) for x in line.split()] for line in lines if line.strip()]
    assert len(rows) == 256, name
    sys.stdout.buffer.write(bytes(min(255, int(c * 255 + 0.5)) for row in rows for c in row))
