"""A double helix with the shape of DNA: two strands, and the pairs of bases between them: helix.png."""

import numpy as np

import pinhole as ph

sequence = "ATGCGTACCTGAGATTA"
pair = {"A": "T", "T": "A", "G": "C", "C": "G"}
rise, twist, groove = 3.4, np.radians(34.3), np.radians(140)  # Å, and angles of the B form


def strand(turns, offset, radius=9.0):
    """Points on a helix around x, at any number of base pairs."""
    angle = turns * twist + offset
    return np.stack([turns * rise, radius * np.cos(angle), radius * np.sin(angle)], axis=-1)


along = np.linspace(-0.8, len(sequence) - 0.2, 60 * len(sequence))
points = [strand(along, 0.0), strand(along, groove)]
kinds = ["backbone"] * (2 * len(along))
part = np.linspace(0.0, 1.0, 121)
for number, base in enumerate(sequence):
    left, right = strand(number, 0.0), strand(number, groove)
    points.append(left + part[:, None] * (right - left))
    kinds += [base if here < 0.5 else pair[base] for here in part]
spheres = ph.Spheres(
    np.concatenate(points),
    np.where(np.array(kinds) == "backbone", 1.45, 1.05),
    columns={"kind": kinds},
    color_by={"column": "kind", "map": "tol-bright"},
    material={"kind": "lambert", "specular": 0.04, "roughness": 0.35},
)
camera = ph.Camera.frame((24, 14), margin=0.04)
spheres.render((1000, 460), style="studio", samples=16, camera=camera, legend={"title": "DNA"}).save("helix.png")
