"""A spiral galaxy of 260,000 stars, with glowing gas and dust lanes: galaxy.png."""

import numpy as np

import pinhole as ph

random = np.random.default_rng(7)
warm, blue, pink, dust = (255, 214, 160), (150, 185, 255), (255, 96, 150), (16, 9, 6)


def arms(count, width, lead=0.0):
    """Points along two arms, which are logarithmic spirals."""
    radius = np.clip(random.gamma(2.4, 1.9, count) + 0.7, 0.7, 11)
    angle = 2.5 * np.log(radius) + random.integers(0, 2, count) * np.pi + lead + random.normal(0, width, count)
    return np.stack([radius * np.cos(angle), random.normal(0, 0.09, count), radius * np.sin(angle)], axis=1)


def blob(count, size):
    """Points around the middle."""
    return np.clip(random.normal(0, 1, (count, 3)), -3, 3) * size


parts = [  # points, radii, colors, opacities
    (arms(110_000, 0.22), 0.016, blue, 0.85),
    (arms(60_000, 0.9), 0.014, warm, 0.6),
    (blob(90_000, (0.75, 0.5, 0.75)), 0.016, warm, 0.8),
    (arms(700, 0.13), 0.055, pink, 0.8),
    (arms(6_000, 0.2), 0.30, blue, 0.012),
    (blob(900, (0.9, 0.55, 0.9)), 0.45, warm, 0.02),
    (arms(9_000, 0.06, lead=-0.35), 0.1, dust, 0.1),
]
counts = [len(points) for points, *_ in parts]
colors = np.repeat([color for _, _, color, _ in parts], counts, axis=0) * random.uniform(0.55, 1, (sum(counts), 1))
spheres = ph.Spheres(
    np.concatenate([points for points, *_ in parts]),
    np.repeat([radius for _, radius, _, _ in parts], counts),
    colors.astype("u1"),
    opacity=np.repeat([opacity for *_, opacity in parts], counts),
)
camera = ph.Camera.look_at((2, 14, 17), (0.3, -0.3, 0), fov=36)
spheres.render((960, 600), style="flat", background="#020308", samples=12, camera=camera).save("galaxy.png")
