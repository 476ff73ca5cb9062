"""A cloud of spheres, colored by their distance from the middle: first.png."""

import numpy as np

import pinhole as ph

positions = np.random.default_rng(1).normal(size=(3000, 3))
distance = np.linalg.norm(positions, axis=1)
spheres = ph.Spheres(positions, radius=0.12, columns={"distance": distance}, color_by="distance", cmap="viridis")
image = spheres.render(size=(960, 720), samples=16, legend={})
image.save("first.png")
print(f"first.png: {len(spheres)} spheres, rendered by {image.adapter or 'the CPU'}")
