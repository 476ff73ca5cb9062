"""A knot among drops, left and right beside each other for two eyes: stereo.png."""

import numpy as np

import pinhole as ph

random = np.random.default_rng(4)
t = np.linspace(0, 2 * np.pi, 900, endpoint=False)
knot = np.stack([np.sin(t) + 2 * np.sin(2 * t), np.cos(t) - 2 * np.cos(2 * t), -1.5 * np.sin(3 * t)], axis=1)
drops = random.uniform(-4, 4, (500, 3)) * (1, 1, 1.2)
apart = np.linalg.norm(drops[:, None] - knot[::10], axis=2).min(axis=1)
drops = drops[(apart > 0.75) & (np.abs(drops[:, :2]).max(axis=1) < 3.3)][:70]
spheres = ph.Spheres(
    np.concatenate([knot, drops]),
    np.concatenate([np.full(len(knot), 0.42), random.uniform(0.05, 0.14, len(drops))]),
    columns={"along": np.concatenate([t, np.full(len(drops), np.nan)])},
    color_by={"column": "along", "map": "romaO", "missing": "#f2c14e"},
)
# Each eye looks at its own half. The knot is half before the paper and half behind it.
camera = ph.Camera.look_at((0, 0, 14), (0, 0, 0), fov=33, stereo={"separation": 0.9, "convergence": 14})
spheres.render((500, 500), style="path", samples=16, exposure=0.4, camera=camera, background="#1b2430").save("stereo.png")
