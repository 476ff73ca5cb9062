"""A perovskite with bonds, a legend, a scale bar and a label, ready for a paper: labels.png."""

import itertools

import numpy as np

import pinhole as ph

edge, cells = 3.905, 2  # SrTiO₃, in Å
atoms = []
for cell in itertools.product(range(cells + 1), repeat=3):
    atoms.append(("Sr", 0.62, cell))
    atoms.append(("Ti", 0.46, np.add(cell, 0.5)))
    atoms += [("O", 0.36, np.add(cell, 0.5 * (1 - np.eye(3)[axis]))) for axis in range(3)]
species, radii, places = zip(*[atom for atom in atoms if max(atom[2]) <= cells])
spheres = ph.Spheres(
    np.array(places) * edge,
    radii,
    columns={"species": species},
    color_by={"column": "species", "map": "tol-bright"},
    bonds={"length": 2.2},
)
spheres.render(
    (960, 740),
    style="illustration",
    samples=16,
    camera=ph.Camera.frame((22, 14), kind="orthographic", margin=0.07),
    legend={"position": "right", "title": "element"},
    scale_bar={"length": 4, "unit": "Å", "position": "bottom-right"},
    labels=[{"text": "SrTiO₃, a = 3.905 Å", "position": "top-right"}],
    text={"scale": 1.2},
    dpi=300,
).save("labels.png")
