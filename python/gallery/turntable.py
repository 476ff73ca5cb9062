"""A buckyball that turns, in a movie or in numbered pictures, and four of its pictures: turntable.png."""

import itertools
import shutil

import numpy as np

import pinhole as ph

golden = (1 + 5**0.5) / 2
kinds = [(0, 1, 3 * golden), (1, 2 + golden, 2 * golden), (2, 1 + 2 * golden, golden)]
corners = [
    np.roll(np.multiply(kind, signs), turn)
    for kind in kinds
    for signs in itertools.product((-1, 1), repeat=3)
    for turn in range(3)
]
atoms = np.unique(np.round(corners, 6), axis=0) * 0.72  # in Å; a bond has 1.44
spheres = ph.Spheres(atoms, radius=0.46, color=atoms[:, 1], cmap="batlow", bonds={"length": 1.6})
view = {"camera": ph.Camera.frame((0, 20)), "size": (300, 300), "samples": 8}
spheres.turntable("turntable.gif" if shutil.which("ffmpeg") else "turntable%02d.png", frames=24, fps=12, **view)

# A turn by 72 degrees shows the same.
images = [spheres.render(**{**view, "camera": ph.Camera.frame((turn, 20))}) for turn in (0, 18, 36, 54)]
ph.sheet("turntable.png", images)
