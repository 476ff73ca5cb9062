"""A slice of a turning drum, half full of grains of three sizes, colored by speed: drum.png."""

import numpy as np

import pinhole as ph

random = np.random.default_rng(5)
drum, half, count = 10.0, 1.3, 1500
radii = random.choice([0.24, 0.34, 0.48], count, p=[0.5, 0.35, 0.15])
grains = np.empty((count, 3))
for number, radius in enumerate(radii):
    # Of many places where a grain may fall, the lowest.
    x = random.uniform(-1, 1, 120) * (drum - radius)
    z = random.uniform(-1, 1, 120) * (half - radius)
    apart = (x[:, None] - grains[:number, 0]) ** 2 + (z[:, None] - grains[:number, 2]) ** 2
    reach = (radius + radii[:number]) ** 2 - apart
    tops = np.where(reach > 0, grains[:number, 1] + np.sqrt(np.maximum(reach, 0)), -np.inf)
    y = np.maximum(-np.sqrt((drum - radius) ** 2 - x**2), tops.max(axis=1, initial=-np.inf))
    best = np.argmin(y)
    grains[number] = x[best], y[best], z[best]

# Most grains turn with the drum; those at the top flow down, all the faster the nearer they are to the surface.
turn = 0.1
below = np.quantile(grains[:, 1], 0.99) - grains[:, 1]
speed = np.abs(2.4 * np.exp(-np.maximum(below, 0) / 1.1) - turn * np.hypot(grains[:, 0], grains[:, 1]))

angle, depth = np.meshgrid(np.linspace(0, 2 * np.pi, 420, endpoint=False), np.linspace(-half, half, 9))
wall = np.stack([10.15 * np.cos(angle), 10.15 * np.sin(angle), depth], axis=-1).reshape(-1, 3)
slope = np.radians(27)
tilt = np.array([[np.cos(slope), -np.sin(slope), 0], [np.sin(slope), np.cos(slope), 0], [0, 0, 1]])
spheres = ph.Spheres(
    np.concatenate([grains @ tilt.T, wall]),
    np.concatenate([radii, np.full(len(wall), 0.16)]),
    color=np.concatenate([speed, np.full(len(wall), turn * drum)]),
    cmap="batlow",
)
camera = ph.Camera.frame((16, 16), margin=0.05)
legend = {"title": "speed (m/s)"}
spheres.render((900, 720), style="path", samples=16, camera=camera, legend=legend).save("drum.png")
