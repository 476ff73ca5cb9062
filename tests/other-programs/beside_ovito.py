#!/usr/bin/env python3
"""Times tasks of users with OVITO and with pinhole by turns, and keeps both pictures.

    python beside_ovito.py PINHOLE DATA OUT [--turns N] [TASK ...]

PINHOLE is the program, DATA a folder with 4hhb.pdb, 4hhb.cif (from the Protein Data Bank), water.xyz (a trajectory),
cell.xyz (extended XYZ with a cell) and polymer.lammpstrj, and OUT a folder for pictures, which also gets two million
grains. This Python has ovito and numpy (`pip install ovito numpy`). A time is that of a whole process, from its start
to the written picture; the least of N turns is printed. docs/how-to/from-ovito-and-fresnel.md has the table.
"""

import argparse
import os
import subprocess
import sys
import time

import numpy as np


def write_grains(path):
    """A heap of two million grains in a drum, which flow down its surface."""
    rng = np.random.default_rng(7)
    radius = 68.0
    steps = np.arange(-radius, radius, 1.02)
    y, z = (grid.ravel() for grid in np.meshgrid(steps, steps, indexing="ij"))
    surface = 0.48 * y + 8 * np.sin(1.4 * y / radius)
    inside = (np.hypot(y, z) < radius - 0.6) & (z < surface)
    y, z, depth = y[inside], z[inside], (surface - z)[inside]
    rows = -(-2_000_000 // len(y))
    x = 1.02 * np.repeat(np.arange(rows) - rows / 2, len(y))
    at = np.stack([x, np.tile(y, rows), np.tile(z, rows)], 1)[:2_000_000]
    depth = np.tile(depth, rows)[:2_000_000]
    at += rng.normal(0, 0.13, at.shape)
    size = 0.5 * rng.uniform(0.8, 1.05, len(at))
    speed = 3 * np.exp(-depth / 6)[:, None] * [0, -0.86, -0.5] + rng.normal(0, 0.08, at.shape)
    table = np.column_stack([np.arange(1, len(at) + 1), np.ones(len(at)), at, size, speed])
    with open(path, "w", encoding="ascii") as file:
        file.write(f"ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{len(at)}\nITEM: BOX BOUNDS ff ff ff\n")
        for low, high in zip(at.min(0) - 1, at.max(0) + 1):
            file.write(f"{low:g} {high:g}\n")
        file.write("ITEM: ATOMS id type x y z radius vx vy vz\n")
        np.savetxt(file, table, fmt="%d %d %.3f %.3f %.3f %.3f %.4f %.4f %.4f")


def with_ovito(task, data, out):
    """One task, as short as its user would write it. The renderer is OpenGL, or Tachyon if the name ends with -t."""
    from ovito.io import import_file
    from ovito.modifiers import ColorCodingModifier, ComputePropertyModifier, CreateBondsModifier, SliceModifier
    from ovito.vis import ColorLegendOverlay, OpenGLRenderer, TachyonRenderer, Viewport
    from PySide6.QtCore import Qt

    renderer = TachyonRenderer() if task.endswith("-t") else OpenGLRenderer()
    task = task.removesuffix("-t")
    file = FILES[task]
    pipeline = import_file(os.path.join(out if file == "grains.dump" else data, file))
    size, legend = SIZES.get(task, (800, 600)), None
    if task == "velocity":
        length = "sqrt(Velocity.X^2+Velocity.Y^2+Velocity.Z^2)"
        pipeline.modifiers.append(ComputePropertyModifier(expressions=[length], output_property="Speed"))
        legend = ColorCodingModifier(property="Speed", gradient=ColorCodingModifier.Viridis())
    elif task == "bonds":
        pipeline.modifiers.append(CreateBondsModifier(mode=CreateBondsModifier.Mode.VdWRadius))
    elif task == "slice":
        pipeline.modifiers.append(SliceModifier(normal=(0, 0, 1), distance=9))
        legend = ColorCodingModifier(property="Position.Z", gradient=ColorCodingModifier.Viridis())
    viewport = Viewport(type=Viewport.Type.Perspective, camera_dir=(-1, -0.7, -0.6))
    if legend:
        pipeline.modifiers.append(legend)
        side = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        bar = ColorLegendOverlay(modifier=legend, alignment=side, orientation=Qt.Orientation.Vertical)
        viewport.overlays.append(bar)
    pipeline.add_to_scene()
    viewport.zoom_all(size=size)
    if task != "movie":
        viewport.render_image(size=size, filename=f"{out}/ovito-{task}.png", background=(1, 1, 1), renderer=renderer)
        return
    for frame in range(100):
        name = f"{out}/ovito-movie-{frame:03}.png"
        viewport.render_image(size=size, filename=name, frame=frame, background=(1, 1, 1), renderer=renderer)


FILES = {
    "xyz": "water.xyz",
    "dump": "polymer.lammpstrj",
    "pdb": "4hhb.pdb",
    "cover": "4hhb.pdb",
    "mmcif": "4hhb.cif",
    "grains": "grains.dump",
    "velocity": "grains.dump",
    "movie": "water.xyz",
    "bonds": "water.xyz",
    "slice": "cell.xyz",
}
SIZES = {"cover": (1240, 1754), "movie": (640, 480)}
FLAGS = {
    "dump": "--box",
    "cover": "--size 1240x1754 --style studio --color-by chain",
    "mmcif": "--color-by chain",
    "velocity": "--color-by |v| --legend",
    "movie": "--size 640x480 --frames 0:100",
    "bonds": "--bonds",
    "slice": "--select z<9 --up 0,0,1 --bonds --box --color-by z --legend",
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ["pinhole", "data", "out"]:
        parser.add_argument(name)
    parser.add_argument("tasks", nargs="*", default=list(FILES))
    parser.add_argument("--turns", type=int, default=3)
    parser.add_argument("--ovito", help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.ovito:
        return with_ovito(args.ovito, args.data, args.out)
    os.makedirs(args.out, exist_ok=True)
    grains = f"{args.out}/grains.dump"
    if not os.path.exists(grains):
        write_grains(grains)
    for task in args.tasks:
        file = grains if FILES[task] == "grains.dump" else f"{args.data}/{FILES[task]}"
        number = "-%03d.png" if task == "movie" else ".png"
        again = [sys.executable, __file__, args.pinhole, args.data, args.out, "--ovito"]
        render = [args.pinhole, "render", file, *FLAGS.get(task, "").split()]
        commands = {"pinhole": [*render, "-o", f"{args.out}/pinhole-{task}{number}"]}
        if task != "cover":
            commands["fast"] = [*render, "--style", "fast", "-o", f"{args.out}/fast-{task}{number}"]
        commands |= {"OpenGL": [*again, task], "Tachyon": [*again, f"{task}-t"]}
        if task == "movie":
            del commands["Tachyon"]
        least = dict.fromkeys(commands, float("inf"))
        for _ in range(args.turns):
            for name, command in reversed(commands.items()):
                start = time.time()
                subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                least[name] = min(least[name], time.time() - start)
        print(task, *(f"{name} {seconds:.2f} s" for name, seconds in least.items()), sep="  ", flush=True)


if __name__ == "__main__":
    sys.exit(main())
