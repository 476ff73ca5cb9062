"""A spiral galaxy of 300,000 stars, yellow in the middle and blue in the arms, with clouds and dust: galaxy.png."""

import numpy as np

import pinhole as ph

random = np.random.default_rng(7)
blue, yellow = np.array([140, 180, 255]), np.array([255, 226, 178])


def disk(count, width, lead=0.0):
    """Points about two arms, which are logarithmic spirals."""
    radius = random.gamma(2.6, 1.5, 2 * count) + 0.5
    radius = radius[radius < random.uniform(6, 10.5, len(radius))][:count]
    angle = 2.6 * np.log(radius) + random.integers(0, 2, len(radius)) * np.pi + lead
    angle += random.normal(0, width, len(radius)) / np.sqrt(radius)
    return np.stack([radius * np.cos(angle), random.normal(0, 0.06, len(radius)), radius * np.sin(angle)], axis=1)


directions = random.normal(0, 1, (80_000, 3))
directions /= np.linalg.norm(directions, axis=1, keepdims=True)
bulge = directions * np.minimum(random.exponential(0.55, (80_000, 1)), 4) * (1, 0.6, 1)
parts = [  # points, radius, opacity, and color, if it is not that of stars
    (disk(150_000, 0.33), 0.016, 0.9, None),
    (disk(100_000, 1.3), 0.012, 0.6, None),
    (bulge, 0.013, 0.9, None),
    (disk(900, 0.25), 0.04, 0.7, (255, 90, 150)),
    (disk(7_000, 0.17, lead=-0.26) * (1, 2, 1), 0.07, 0.12, (20, 10, 8)),
]
colors = []
for points, _, _, color in parts:  # stars are yellow near the middle, and blue far away
    far = np.clip(np.linalg.norm(points, axis=1) / 4.5 + random.normal(0, 0.15, len(points)), 0, 1)[:, None]
    light = random.uniform(0.5, 1, (len(points), 1)) ** (0.3 + far)
    colors.append(((1 - far) * yellow + far * blue) * light if color is None else points * 0 + color)
counts = [len(points) for points, *_ in parts]
radii, opacities = (np.repeat([part[column] for part in parts], counts) for column in (1, 2))
stars, colors = np.concatenate([part[0] for part in parts]), np.concatenate(colors).astype("u1")
spheres = ph.Spheres(stars, radii, colors, opacity=opacities)
camera = ph.Camera.look_at((2, 14, 16), (0.2, -0.6, 0), fov=33)
spheres.render((960, 600), style="flat", background="#020308", samples=10, exposure=0.5, camera=camera).save("galaxy.png")
