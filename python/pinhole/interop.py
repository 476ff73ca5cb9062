"""Spheres from objects of other libraries, none of which must be installed.

Every function also takes the settings of ``Spheres``.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from . import _arrays, _settings
from ._arrays import numbers
from ._errors import InputError
from ._files import Trajectory
from ._image import Image
from ._pinhole import JoinedFrames, SphereData, of_arrays
from ._spheres import Spheres


class _Listed:
    """Frames that are objects of another library. ``parts`` has the arguments of ``Spheres`` for an object."""

    def __init__(self, frames: list[Any], parts: Callable[[Any], dict[str, Any]], radius: float | None) -> None:
        self.frames, self.parts, self.radius = frames, parts, radius

    def __len__(self) -> int:
        return len(self.frames)

    def frame(self, index: int, text: _settings.Text, keys: JoinedFrames | None) -> SphereData:
        parts = self.parts(self.frames[index])
        centers = _arrays.positions("positions", parts["positions"])
        count = len(centers)
        radii = _arrays.radii(parts.get("radius") if self.radius is None else self.radius, centers)
        cell = _arrays.cell(parts.get("cell"), parts.get("origin"), parts.get("pbc", True))
        pairs = _arrays.pairs(parts.get("pairs"), count)
        named = list(_arrays.columns(parts["columns"], count).items())
        return of_arrays(centers, radii, None, named, text, cell, pairs, keys)


def _made(parts: dict[str, Any], settings: dict[str, Any]) -> Spheres:
    """Spheres with the parts of an object and more settings. Those take the place of parts."""
    columns = {**parts.pop("columns"), **settings.pop("columns", {})}
    return Spheres(**{**parts, "columns": columns, **settings})


def _trajectory(frames: Iterable[Any], parts: Callable[[Any], dict[str, Any]], settings: dict[str, Any]) -> Trajectory:
    radius = settings.pop("radius", None)
    if radius is not None and np.ndim(radius) > 0:
        raise InputError("radius: frames have one radius for all spheres; give a number")
    listed = _Listed(list(frames), parts, radius)
    return Trajectory(listed, range(len(listed)), _settings.data_settings(settings))


def from_ase(atoms: Any, **settings: Any) -> Any:
    """Spheres of ``ase.Atoms``, or a ``Trajectory`` of a list of them or of a file that ASE reads. Elements give radii and
    colours; the cell, momenta, tags, and forces of a calculator stay: ``color_by="|forces|"``, ``arrows="momenta"``.
    """
    if isinstance(atoms, (str, os.PathLike)):
        from ase.io import read

        try:
            atoms = read(os.fspath(atoms), index=":")
        except Exception as error:
            raise InputError(f"{os.fspath(atoms)}: ASE cannot read it: {error}") from error
        atoms = atoms[0] if len(atoms) == 1 else atoms
    if hasattr(atoms, "positions") and hasattr(atoms, "get_chemical_symbols"):
        return _made(_of_ase(atoms), settings)
    if isinstance(atoms, Iterable):
        return _trajectory(atoms, _of_ase, settings)
    raise InputError(f"from_ase takes ase.Atoms, a list of them, or the path of a file; this is {type(atoms).__name__}")


def _of_ase(atoms: Any) -> dict[str, Any]:
    if not hasattr(atoms, "get_chemical_symbols"):
        raise InputError(f"a frame of from_ase must be ase.Atoms; this is {type(atoms).__name__}")
    count = len(atoms.positions)
    columns: dict[str, Any] = {"species": np.array(atoms.get_chemical_symbols())}
    results = getattr(getattr(atoms, "calc", None), "results", {})
    for name, array in [*getattr(atoms, "arrays", {}).items(), *results.items()]:
        is_numbers = np.ndim(array) in (1, 2) and np.shape(array)[0] == count and np.asarray(array).dtype.kind in "fiubUS"
        if name not in ("numbers", "positions") and is_numbers:
            columns[name] = array
    edges = np.asarray(getattr(atoms, "cell", np.zeros((3, 3))))
    if edges.shape != (3, 3) or abs(np.linalg.det(edges)) < 1e-12:
        return {"positions": atoms.positions, "columns": columns}
    origin = atoms.get_celldisp().reshape(3)
    return {"positions": atoms.positions, "columns": columns, "cell": edges, "origin": origin, "pbc": atoms.pbc}


#: Columns and the attributes of MDAnalysis that have their values: the first one that exists and says something.
_TEXTS = (
    ("species", ("elements",)),
    ("name", ("names",)),
    ("residue", ("resnames",)),
    ("chain", ("chainIDs", "segids")),
    ("record", ("record_types",)),
    ("type", ("types",)),
)
_NUMBERS = (
    ("residue_number", "resids"),
    ("b_factor", "tempfactors"),
    ("occupancy", "occupancies"),
    ("mass", "masses"),
    ("charge", "charges"),
    ("velocity", "velocities"),
    ("force", "forces"),
)


def from_mdanalysis(group: Any, **settings: Any) -> Spheres:
    """Spheres of an MDAnalysis ``Universe`` or ``AtomGroup`` in its current frame, with its cell, its bonds, and columns as
    from a file: ``species``, ``name``, ``residue``, ``chain`` and so on. Elements give radii and colours; without them, names
    of atoms do.
    """
    atoms = getattr(group, "atoms", None)
    if atoms is None or not hasattr(atoms, "positions"):
        raise InputError(f"from_mdanalysis takes a Universe or an AtomGroup; this is {type(group).__name__}")
    columns: dict[str, Any] = {}
    for column, attributes in _TEXTS:
        found = (np.asarray(getattr(atoms, of)).astype(str) for of in attributes if hasattr(atoms, of))
        texts = next((texts for texts in found if len(texts) and (texts != "").all()), None)
        if texts is not None:
            columns[column] = texts
    for column, attribute in _NUMBERS:
        values = getattr(atoms, attribute, None)
        if values is not None:
            columns[column] = np.asarray(values, float)
    parts: dict[str, Any] = {"positions": atoms.positions, "columns": columns}
    dimensions = getattr(atoms, "dimensions", None)
    if dimensions is not None and np.all(np.asarray(dimensions) > 0):
        parts["cell"] = _edges(*(float(number) for number in dimensions))
    bonds = getattr(atoms, "bonds", None)
    if bonds is not None and len(bonds):
        places = np.full(int(max(atoms.ix.max(), bonds.indices.max())) + 1, -1)
        places[atoms.ix] = np.arange(len(atoms.ix))
        pairs = places[bonds.indices]
        parts["pairs"] = pairs[(pairs >= 0).all(axis=1)]
    return _made(parts, settings)


def _edges(a: float, b: float, c: float, alpha: float, beta: float, gamma: float) -> list[list[float]]:
    """The edges of a cell with these lengths and angles in degrees: the first along x, the second in the plane of x and y."""
    cosines = [0.0 if angle == 90.0 else float(np.cos(np.radians(angle))) for angle in (alpha, beta, gamma)]
    sine = 1.0 if gamma == 90.0 else float(np.sin(np.radians(gamma)))
    along = (cosines[0] - cosines[1] * cosines[2]) / sine
    height = float(np.sqrt(max(0.0, 1.0 - cosines[1] ** 2 - along**2)))
    return [[a, 0.0, 0.0], [b * cosines[2], b * sine, 0.0], [c * cosines[1], c * along, c * height]]


def from_gsd(frame: Any, **settings: Any) -> Any:
    """Spheres of a frame of ``gsd.hoomd``, or a ``Trajectory`` of several, with radii of half its diameters, its box and
    bonds, and the column ``type``.
    """
    if hasattr(frame, "particles"):
        return _made(_of_gsd(frame), settings)
    if isinstance(frame, Iterable):
        return _trajectory(frame, _of_gsd, settings)
    raise InputError(f"from_gsd takes a frame of gsd.hoomd, or several; this is {type(frame).__name__}")


def _of_gsd(frame: Any) -> dict[str, Any]:
    particles = getattr(frame, "particles", None)
    if particles is None:
        raise InputError(f"a frame of from_gsd must have particles; this is {type(frame).__name__}")
    columns: dict[str, Any] = {}
    if particles.types is not None and particles.typeid is not None:
        columns["type"] = np.array(particles.types)[np.asarray(particles.typeid)]
    for name in ("mass", "charge", "body", "velocity", "image"):
        if getattr(particles, name, None) is not None:
            columns[name] = getattr(particles, name)
    diameter = particles.diameter
    radius = None if diameter is None else np.asarray(diameter) / 2
    parts: dict[str, Any] = {"positions": particles.position, "radius": radius, "columns": columns}
    box = getattr(getattr(frame, "configuration", None), "box", None)
    if box is not None and np.all(np.asarray(box)[:3] > 0):
        # The box of HOOMD-blue has its centre at the origin; the last three numbers are its tilts.
        x, y, z, xy, xz, yz = (float(number) for number in box)
        edges = np.array([[x, 0.0, 0.0], [xy * y, y, 0.0], [xz * z, yz * z, z]])
        parts |= {"cell": edges, "origin": -0.5 * edges.sum(axis=0)}
    group = getattr(getattr(frame, "bonds", None), "group", None)
    if group is not None:
        parts["pairs"] = group
    return parts


def from_frame(table: Any, positions: tuple[str, str, str] = ("x", "y", "z"), **settings: Any) -> Spheres:
    """Spheres of a table with named columns, such as a pandas ``DataFrame``, a dict of arrays or an xarray
    ``Dataset``. Columns give the positions, and ``radius`` if there is one; all others become columns, those that are
    neither numbers nor texts as texts.
    """
    if not hasattr(table, "keys") and not hasattr(table, "columns"):
        raise InputError(f"from_frame takes a table with named columns; this is {type(table).__name__}")
    names = [str(name) for name in (table.keys() if hasattr(table, "keys") else table.columns)]
    missing = [name for name in positions if name not in names]
    if missing:
        raise InputError(f"there is no column {missing[0]!r}; the columns are {', '.join(names)}")
    centers = np.stack([numbers(name, np.asarray(table[name])) for name in positions], axis=1)
    radius = settings.pop("radius", np.asarray(table["radius"]) if "radius" in names else None)
    others = [name for name in names if name not in (*positions, "radius")]
    columns = {name: np.asarray(table[name]) for name in others}
    columns = {
        name: array if array.dtype.kind in "fiubUS" else array.astype(str)
        for name, array in columns.items()
        if array.shape == (len(centers),)
    }
    return _made({"positions": centers, "radius": radius, "columns": columns}, settings)


#: The same; a table of pandas is the most common.
from_pandas = from_frame


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
