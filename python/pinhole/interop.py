"""Spheres from objects of other libraries, none of which must be installed.

Every function also takes the settings of ``Spheres``.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ._arrays import numbers
from ._errors import InputError
from ._image import Image
from ._spheres import Spheres


def from_ase(atoms: Any, **settings: Any) -> Spheres:
    """Spheres of ``ase.Atoms``, with covalent radii from ASE, coloured by the column ``species``."""
    from ase.data import covalent_radii

    radius = settings.pop("radius", covalent_radii[atoms.numbers])
    columns = {"species": np.array(atoms.get_chemical_symbols()), **settings.pop("columns", {})}
    return Spheres(atoms.positions, radius, columns=columns, **settings)


def from_mdanalysis(group: Any, **settings: Any) -> Spheres:
    """Spheres of an MDAnalysis ``Universe`` or ``AtomGroup`` in its current frame, with the columns ``name``,
    ``resname``, ``type`` and so on that it has.
    """
    atoms = group.atoms
    columns: dict[str, Any] = {}
    for column, attribute in (("name", "names"), ("type", "types"), ("resname", "resnames"), ("chain", "segids")):
        if hasattr(atoms, attribute):
            columns[column] = np.array(getattr(atoms, attribute)).astype(str)
    for column, attribute in (("mass", "masses"), ("charge", "charges"), ("b_factor", "tempfactors")):
        if hasattr(atoms, attribute):
            columns[column] = getattr(atoms, attribute)
    columns.update(settings.pop("columns", {}))
    return Spheres(atoms.positions, settings.pop("radius", None), columns=columns, **settings)


def from_gsd(frame: Any, **settings: Any) -> Spheres:
    """Spheres of a frame of ``gsd.hoomd``, with radii of half its diameters, and the column ``type``."""
    particles = frame.particles
    columns: dict[str, Any] = {}
    if particles.types is not None and particles.typeid is not None:
        columns["type"] = np.array(particles.types)[np.asarray(particles.typeid)]
    for name in ("mass", "charge", "body"):
        if getattr(particles, name, None) is not None:
            columns[name] = getattr(particles, name)
    columns.update(settings.pop("columns", {}))
    diameter = particles.diameter
    radius = settings.pop("radius", None if diameter is None else np.asarray(diameter) / 2)
    return Spheres(particles.position, radius, columns=columns, **settings)


def from_frame(table: Any, positions: tuple[str, str, str] = ("x", "y", "z"), **settings: Any) -> Spheres:
    """Spheres of a table with named columns, such as a pandas ``DataFrame``, a dict of arrays or an xarray
    ``Dataset``. Columns give the positions, and ``radius`` if there is one; all others become columns.
    """
    names = [str(name) for name in (table.keys() if hasattr(table, "keys") else table.columns)]
    missing = [name for name in positions if name not in names]
    if missing:
        raise InputError(f"there is no column {missing[0]!r}; the columns are {', '.join(names)}")
    centers = np.stack([numbers(name, np.asarray(table[name])) for name in positions], axis=1)
    radius = settings.pop("radius", np.asarray(table["radius"]) if "radius" in names else None)
    others = [name for name in names if name not in (*positions, "radius")]
    columns = {name: np.asarray(table[name]) for name in others}
    columns = {name: array for name, array in columns.items() if array.shape == (len(centers),)}
    columns.update(settings.pop("columns", {}))
    return Spheres(centers, radius, columns=columns, **settings)


def from_pyvista(points: Any, **settings: Any) -> Spheres:
    """Spheres at the points of a PyVista data set, such as ``PolyData``, with its arrays of one number per point."""
    data = points.point_data
    columns = {str(name): np.asarray(data[name]) for name in data.keys() if np.ndim(data[name]) == 1}
    columns.update(settings.pop("columns", {}))
    return Spheres(points.points, settings.pop("radius", None), columns=columns, **settings)


def colorbar(spheres: Spheres, axes: Any = None, **keys: Any) -> Any:
    """Adds the meaning of the spheres' colours beside matplotlib's ``axes``: a colour bar, or a legend of categories.
    Returns it. ``keys`` are those of ``figure.colorbar`` or ``axes.legend``.
    """
    import matplotlib.pyplot as plt
    from matplotlib import cm, colors, patches

    key = spheres.color_key
    if key is None:
        raise InputError("colors mean nothing here; give color an array of shape (n,), or name a column in color_by")
    if axes is None:
        axes = plt.gca()
    if "categories" in key:
        shown = [
            patches.Patch(color=(red / 255, green / 255, blue / 255), label=name)
            for name, (red, green, blue) in key["categories"].items()
        ]
        beside = {"loc": "upper left", "bbox_to_anchor": (1.0, 1.0)}
        return axes.legend(handles=shown, **{"title": key["title"], **beside, **keys})
    norm = (colors.LogNorm if key["log"] else colors.Normalize)(*key["range"])
    table = colors.ListedColormap(key["colors"] / 255)
    return axes.figure.colorbar(cm.ScalarMappable(norm, table), **{"ax": axes, "label": key["title"], **keys})


def imshow(image: Image, axes: Any = None, **keys: Any) -> Any:
    """Shows a picture in the axes of matplotlib, without ticks, and returns the result of ``axes.imshow``. The extent
    is in pixels, with row 0 at the top. ``keys``, such as ``extent``, are those of ``axes.imshow``.
    """
    if axes is None:
        import matplotlib.pyplot as plt

        axes = plt.gca()
    width, height = image.size
    shown = axes.imshow(image.rgb8, **{"extent": (0, width, height, 0), "interpolation": "nearest", **keys})
    axes.set_axis_off()
    return shown
