"""Objects of other libraries. Those that are not installed are replaced by objects with the same attributes."""

from __future__ import annotations

import sys
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest
from conftest import cloud

import pinhole as ph
from pinhole import interop

pytestmark = pytest.mark.filterwarnings("ignore::pinhole.Note")


def test_a_table():
    table = {"x": [0, 1, 2], "y": [0, 0, 0], "z": [1, 1, 1], "radius": [0.5, 0.25, 1], "speed": [3.0, 4, 5], "kind": ["a", "b", "a"]}
    spheres = interop.from_frame(table, color_by="speed")
    assert spheres.radii.tolist() == [0.5, 0.25, 1]
    assert spheres.columns == ["speed", "kind"] and spheres["kind"].tolist() == ["a", "b", "a"]
    with pytest.raises(ph.InputError, match="there is no column 'w'; the columns are x, y, z"):
        interop.from_frame(table, positions=("x", "y", "w"))
    pandas = pytest.importorskip("pandas")
    assert interop.from_frame(pandas.DataFrame(table)).positions.tolist() == spheres.positions.tolist()


def test_ase(monkeypatch):
    try:
        import ase
    except ImportError:
        data = ModuleType("ase.data")
        data.covalent_radii = np.linspace(0.2, 2.0, 119)
        monkeypatch.setitem(sys.modules, "ase", ModuleType("ase"))
        monkeypatch.setitem(sys.modules, "ase.data", data)
        atoms = SimpleNamespace(
            numbers=np.array([8, 1, 1]), positions=cloud(3), get_chemical_symbols=lambda: ["O", "H", "H"]
        )
    else:
        atoms = ase.Atoms("OH2", positions=cloud(3))
    spheres = interop.from_ase(atoms)
    assert spheres["species"].tolist() == ["O", "H", "H"]
    assert spheres.radii[0] > spheres.radii[1] == spheres.radii[2]


def test_gsd_and_mdanalysis_and_pyvista():
    particles = SimpleNamespace(
        position=cloud(4).astype("f4"), diameter=np.full(4, 2.0), types=["A", "B"], typeid=np.array([0, 1, 1, 0]), mass=None
    )
    spheres = interop.from_gsd(SimpleNamespace(particles=particles))
    assert spheres.radii.tolist() == [1.0] * 4 and spheres["type"].tolist() == ["A", "B", "B", "A"]
    group = SimpleNamespace(positions=cloud(2), names=np.array(["CA", "N"], object), masses=np.array([12.0, 14.0]))
    spheres = interop.from_mdanalysis(SimpleNamespace(atoms=group), radius=1.0)
    assert spheres["name"].tolist() == ["CA", "N"] and spheres["mass"].tolist() == [12, 14]
    points = SimpleNamespace(points=cloud(3), point_data={"heat": np.arange(3.0), "normals": np.zeros((3, 3))})
    assert interop.from_pyvista(points, radius=0.5, color_by="heat").columns == ["heat"]


def test_matplotlib_shows_every_pixel():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    from matplotlib.figure import Figure

    image = ph.Spheres([[0, 0, 0]], 1.0).render((30, 20), backend="cpu")
    shown = interop.imshow(image, Figure().subplots())
    axes = shown.axes
    numbers = ph.Spheres(cloud(3), 0.5, color=np.array([1.0, 2.5, 4.0]), cmap="inferno", color_range=(0, 5))
    bar = interop.colorbar(numbers, axes, label="speed")
    assert (bar.vmin, bar.vmax) == (0, 5) and bar.ax.get_ylabel() == "speed"
    ours = np.array(numbers.color_key["colors"])
    assert np.array_equal((255 * bar.cmap(np.arange(len(ours)))[:, :3]).round(), ours)
    legend = interop.colorbar(ph.Spheres(cloud(3), 0.5, color=["a", "b", "a"]), axes)
    assert [text.get_text() for text in legend.get_texts()] == ["a", "b"]
    with pytest.raises(ph.InputError, match="colors mean nothing"):
        interop.colorbar(ph.Spheres(cloud(3), 0.5), axes)
    assert np.array_equal(shown.get_array(), image.rgb8) and tuple(shown.get_extent()) == (0, 30, 20, 0)
