"""A gold particle cut open, its atoms colored by how many neighbors they have: lattice.png."""

import numpy as np

import pinhole as ph

edge = 4.08  # of the cubic cell of gold, in Å
cells = np.stack(np.meshgrid(*[np.arange(-6, 7)] * 3, indexing="ij"), axis=-1).reshape(-1, 1, 3)
atoms = np.array([[0, 0, 0], [0, 1, 1], [1, 0, 1], [1, 1, 0]])
points = (2 * cells + atoms).reshape(-1, 3)  # in halves of the edge

# A truncated octahedron, the shape of small crystals with the faces {111} and {100}.
size = np.abs(points)
points = points[(size.sum(axis=1) <= 15) & (size.max(axis=1) <= 10)]

there = {tuple(point) for point in points.tolist()}
steps = [step for step in np.ndindex(3, 3, 3) if sum(abs(part - 1) for part in step) == 2]
neighbors = [sum((x + i - 1, y + j - 1, z + k - 1) in there for i, j, k in steps) for x, y, z in points.tolist()]

names = {6: "corner (6)", 7: "edge (7)", 8: "face 100 (8)", 9: "face 111 (9)", 12: "inside (12)"}
spheres = ph.Spheres(
    points * edge / 2,
    radius=edge / 8**0.5,  # touching atoms
    columns={"place (neighbors)": [names[number] for number in neighbors]},
    color_by={"column": "place (neighbors)", "map": "magma"},
    select="not (x > 0.1 and y > 0.1 and z > 0.1)",
)
camera = ph.Camera.frame((28, 24), margin=0.04)
spheres.render((900, 680), style="studio", samples=16, camera=camera, legend={}).save("lattice.png")
