"""A spiral galaxy of 300,000 stars, yellow in the middle and blue in the arms, with clouds and dust: galaxy.png."""

import numpy as np

import pinhole as ph

random = np.random.default_rng(7)


def disk(count, width, lead=0.0):
    """Points about two arms, which are logarithmic spirals, and their distances from the middle."""
    radius = random.gamma(2.6, 1.5, 2 * count) + 0.5
    radius = radius[radius < random.uniform(6, 10.5, len(radius))][:count]
    angle = 2.6 * np.log(radius) + random.integers(0, 2, len(radius)) * np.pi + lead
    angle += random.normal(0, width, len(radius)) / np.sqrt(radius)
    height = random.normal(0, 0.06, len(radius))
    return np.stack([radius * np.cos(angle), height, radius * np.sin(angle)], axis=1), radius


def bulge(count):
    """Points that crowd about the middle, and their distances from it."""
    towards = random.normal(0, 1, (count, 3))
    radius = np.minimum(random.exponential(0.55, count), 4)
    return towards / np.linalg.norm(towards, axis=1, keepdims=True) * radius[:, None] * (1, 0.6, 1), radius


def mixed(radius):
    """The color of stars: yellow near the middle, and blue far away."""
    part = np.clip(radius / 4.5 + random.normal(0, 0.15, len(radius)), 0, 1)[:, None]
    light = random.uniform(0.5, 1, (len(radius), 1)) ** (0.3 + part)
    return ((1 - part) * (255, 226, 178) + part * (140, 180, 255)) * light


parts = []  # points, radii, colors, opacities
for (points, radius), size, opacity in (
    (disk(150_000, 0.33), 0.016, 0.9),
    (disk(100_000, 1.3), 0.012, 0.6),
    (bulge(80_000), 0.013, 0.9),
):
    parts.append((points, size, mixed(radius), opacity))
parts.append((disk(900, 0.25)[0], 0.04, np.array([[255, 90, 150]] * 900), 0.7))
dust = disk(7_000, 0.17, lead=-0.26)[0] * (1, 2, 1)
parts.append((dust, 0.07, np.array([[20, 10, 8]] * 7_000), 0.12))
counts = [len(points) for points, *_ in parts]
spheres = ph.Spheres(
    np.concatenate([points for points, *_ in parts]),
    np.repeat([size for _, size, *_ in parts], counts),
    np.concatenate([colors[:count] for (_, _, colors, _), count in zip(parts, counts)]).astype("u1"),
    opacity=np.repeat([opacity for *_, opacity in parts], counts),
)
camera = ph.Camera.look_at((2, 14, 16), (0.2, -0.6, 0), fov=33)
spheres.render((960, 600), style="flat", background="#020308", samples=16, exposure=0.5, camera=camera).save("galaxy.png")
