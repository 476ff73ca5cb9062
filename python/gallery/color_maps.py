"""The same waves in six color maps, each with its bar: color_maps.png."""

import numpy as np

import pinhole as ph

x, y = np.meshgrid(np.linspace(-1, 1, 140), np.linspace(-1, 1, 140))
waves = np.cos(13 * np.hypot(x - 0.45, y - 0.35)) + np.cos(13 * np.hypot(x + 0.55, y + 0.25))
points = np.stack([x, 0.055 * waves, y], axis=-1).reshape(-1, 3)
images = []
for name in ("viridis", "batlow", "inferno", "vik", "RdYlBu_r", "romaO"):
    spheres = ph.Spheres(points, radius=0.03, color=waves.ravel(), cmap=name, color_range=(-2, 2))
    legend = {"title": name, "position": "bottom"}
    images.append(spheres.render((400, 320), camera=ph.Camera.frame((30, 38), margin=0.02), legend=legend))
ph.sheet("color_maps.png", images, columns=3)
