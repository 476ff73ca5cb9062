"""Checks the device pixel by pixel, and marks where two answers are right: verify.png."""

import numpy as np

import pinhole as ph

t = np.linspace(0, 2 * np.pi, 20_000, endpoint=False)
rope = (1 + 0.4 * np.cos(9 * t))[:, None] * np.stack([np.cos(2 * t), 0 * t, np.sin(2 * t)], axis=1)
rope[:, 1] = 0.4 * np.sin(9 * t)
spheres = ph.Spheres(rope, radius=0.11, color=t, cmap="romaO")

camera = ph.Camera.frame((30, 40))
certificate = spheres.verify((600, 480), camera=camera)
print(certificate)
if not certificate:
    raise SystemExit(f"this device is wrong: {certificate.violations}")

# The picture that was checked in gray, with ties and silhouettes in color.
image = spheres.render((600, 480), style="fast", camera=camera)
marked = np.repeat(image.rgb8.mean(axis=2, keepdims=True) // 2 + 127, 3, axis=2).astype("u1")
for verdict, color in (("silhouette", (0, 140, 255)), ("tie", (230, 60, 0))):
    marked[certificate.verdicts == list(certificate.counts).index(verdict)] = color
ph.sheet("verify.png", [image, marked])
