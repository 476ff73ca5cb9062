"""Measures the constants of the cost model of docs/dev/notebook-2026-11.md on one core, and compares its predictions with
other jobs.

PINHOLE_PROGRAM names the program. Nothing else should run on the machine.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass

PROGRAM = os.path.abspath(os.environ.get("PINHOLE_PROGRAM", "target/release/pinhole"))


@dataclass(frozen=True)
class Job:
    frames: int
    tiles: tuple[int, int]
    spheres: int
    size: tuple[int, int]
    samples: int

    @property
    def pixels(self) -> int:
        return self.size[0] * self.size[1]

    @property
    def units(self) -> int:
        return self.frames * self.tiles[0] * self.tiles[1]


@dataclass
class Constants:
    start: float = 0.0  # of a process
    read: float = 0.0  # of a sphere
    build: float = 0.0  # of a sphere
    sample: float = 0.0  # of a pixel
    merge: float = 0.0  # of a pixel

    def parts(self, job: Job) -> float:
        """The time of all parts in one process on one core."""
        reading = job.frames * self.read * job.spheres
        building = job.units * self.build * job.spheres
        return self.start + reading + building + job.frames * job.pixels * job.samples * self.sample

    def merging(self, job: Job) -> float:
        """Reads the first frame and all parts, and encodes."""
        return self.start + self.read * job.spheres + job.frames * job.pixels * self.merge


def run(*words: str) -> float:
    began = time.monotonic()
    subprocess.run([PROGRAM, *words], check=True, env={**os.environ, "RAYON_NUM_THREADS": "1"})
    return time.monotonic() - began


def frames_of(job: Job) -> str:
    """A trajectory of random spheres in text, of which each frame is the same; density and so the picture stay the same."""
    import random

    name = f"s{job.spheres}-{job.frames}.xyz"
    if not os.path.exists(name):
        side = job.spheres ** (1 / 3) * 3.0
        rng = random.Random(1)
        lines = [f"C {rng.random() * side:.3f} {rng.random() * side:.3f} {rng.random() * side:.3f}\n" for _ in range(job.spheres)]
        with open(name, "w") as file:
            for frame in range(job.frames):
                file.write(f"{job.spheres}\nframe {frame}\n")
                file.writelines(lines)
    return name


def measure(job: Job) -> tuple[float, float, float]:
    """Seconds of all parts, of the units alone, and of the merge."""
    subprocess.run(["rm", "-rf", "job"], check=True)
    size, tiles = (f"{pair[0]}x{pair[1]}" for pair in (job.size, job.tiles))
    flags = ["--frames", ":", "--camera-from", "0", "--backend", "cpu", "--size", size, "--samples", str(job.samples)]
    run("job", "split", frames_of(job), *flags, "--tiles", tiles, "-o", "job", "-q")
    parts = run("job", "part", "job", f"0-{job.units - 1}", "-q")
    units = sum(milliseconds(f"job/parts/{unit:06}.part") for unit in range(job.units)) / 1e3
    merging = run("job", "merge", "job", "-o", "m%d.png", "-q")
    return parts, units, merging


def milliseconds(part: str) -> float:
    """How long a unit took, by the header of its part: JSON behind a line, and its length in eight bytes."""
    with open(part, "rb") as file:
        file.readline()
        return json.loads(file.read(int.from_bytes(file.read(8), "little")))["milliseconds"]


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        constants = Constants()
        tiny = Job(1, (1, 1), 1, (8, 8), 1)
        constants.start = min(measure(tiny)[0] for _ in range(3))
        # Many spheres and few pixels, few spheres and many pixels.
        dense, wide = Job(2, (2, 2), 200_000, (40, 30), 1), Job(2, (1, 1), 20_000, (640, 480), 8)
        parts, units, _ = measure(dense)
        constants.build = units / (dense.units * dense.spheres)
        constants.read = (parts - units - constants.start) / (dense.frames * dense.spheres)
        _, units, merging = measure(wide)
        constants.sample = (units - wide.units * wide.spheres * constants.build) / (wide.frames * wide.pixels * wide.samples)
        constants.merge = (merging - constants.start) / (wide.frames * wide.pixels)
        print("constants:", {name: f"{value:.2e} s" for name, value in vars(constants).items()})
        print("| frames | tiles | spheres | size | samples | predicted | measured |")
        print("|---|---|---|---|---|---|---|")
        worst = 1.0
        for job in (
            Job(4, (2, 2), 20_000, (320, 240), 8),
            Job(2, (4, 4), 50_000, (320, 240), 4),
            Job(8, (1, 1), 100_000, (160, 120), 4),
            Job(2, (2, 1), 5_000, (800, 600), 4),
        ):
            parts, _, merging = measure(job)
            predicted, measured = constants.parts(job) + constants.merging(job), parts + merging
            worst = max(worst, predicted / measured, measured / predicted)
            size, tiles = (f"{pair[0]}x{pair[1]}" for pair in (job.size, job.tiles))
            print(f"| {job.frames} | {tiles} | {job.spheres} | {size} | {job.samples} | {predicted:.1f} s | {measured:.1f} s |")
        print(f"worst factor: {worst:.2f}")
        sys.exit(worst > 2.0)


if __name__ == "__main__":
    main()
