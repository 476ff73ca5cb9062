"""Objects of other libraries. Those that are not installed are replaced by objects with the same attributes."""

from __future__ import annotations

from types import SimpleNamespace

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


class Atoms:
    """What ``from_ase`` reads of ``ase.Atoms``."""

    def __init__(self, symbols, positions, cell=None, pbc=True, **arrays):
        self.symbols, self.positions, self.pbc = symbols, np.array(positions, float), np.array([pbc] * 3)
        self.cell = np.zeros((3, 3)) if cell is None else np.diag(cell)
        self.arrays = {"numbers": np.zeros(len(symbols)), "positions": self.positions, **arrays}
        self.calc = SimpleNamespace(results={"energy": 1.0, "forces": self.positions})

    def get_chemical_symbols(self):
        return self.symbols

    def get_celldisp(self):
        return np.zeros((3, 1))


def test_ase():
    water = Atoms(["O", "H", "H"], [[0, 0, 0], [0.96, 0, 0], [-0.24, 0.93, 0]], tags=np.array([1, 2, 3]))
    spheres = interop.from_ase(water)
    assert spheres["species"].tolist() == ["O", "H", "H"] and spheres.kind == "molecules" and spheres.cell is None
    assert spheres["tags"].tolist() == [1, 2, 3] and spheres["forces"].shape == (3, 3)
    assert interop.from_ase(water, kind="plain").radii.tolist() == [1.5, np.float32(1.2), np.float32(1.2)]
    assert interop.from_ase(water, radius=0.5, kind="plain").radii.tolist() == [0.5] * 3
    # Carbon is grey and hydrogen white, as in a file.
    shown = interop.from_ase(water, kind="plain").render((40, 30), style="fast", layers=["albedo"], backend="cpu")
    assert (shown.albedo.reshape(-1, 3).max(axis=0) > 0.5).all()
    copper = Atoms(["Cu"] * 2, [[0, 0, 0], [1.8, 1.8, 1.8]], cell=[3.6] * 3)
    assert interop.from_ase(copper).kind == "crystal" and interop.from_ase(copper, box=True).cell[0, 0] == 3.6
    frames = interop.from_ase([copper, water])
    assert isinstance(frames, ph.Trajectory) and [frame.kind for frame in frames] == ["crystal", "molecules"]
    assert len(frames[1:].with_(color_by="tags")[0]) == 3
    for bad, words in ((3, "this is int"), ([3], "a frame of from_ase must be ase.Atoms"), (object(), "this is object")):
        with pytest.raises(ph.InputError, match=words):
            interop.from_ase(bad)[0]


def test_a_movie_of_a_list_of_atoms(tmp_path):
    frames = [Atoms(["C", "O"], [[0, 0, 0], [1.1 + step, 0, 0]]) for step in (0.0, 0.1)]
    interop.from_ase(frames).movie(tmp_path / "%d.png", size=(40, 30), style="fast")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["0.png", "1.png"]


def test_gsd_and_pyvista():
    particles = SimpleNamespace(
        position=cloud(4).astype("f4"), diameter=np.full(4, 0.1), types=["A", "B"], typeid=np.array([0, 1, 1, 0]), mass=None
    )
    box = SimpleNamespace(box=[4, 4, 4, 0.5, 0, 0])
    frame = SimpleNamespace(particles=particles, configuration=box, bonds=SimpleNamespace(group=[[0, 1]]))
    spheres = interop.from_gsd(frame)
    assert np.allclose(spheres.radii, 0.05) and spheres["type"].tolist() == ["A", "B", "B", "A"]
    assert spheres.cell.tolist() == [[4, 0, 0], [2, 4, 0], [0, 0, 4]] and spheres.kind == "polymer"
    assert interop.from_gsd(frame, bonds=True)._data.cone_count() == 14
    assert len(interop.from_gsd([frame, frame])) == 2
    points = SimpleNamespace(points=cloud(3), point_data={"heat": np.arange(3.0), "normals": np.zeros((3, 3))})
    assert interop.from_pyvista(points, radius=0.5, color_by="heat").columns == ["heat"]


def test_mdanalysis():
    atoms = SimpleNamespace(
        positions=np.array([[0, 0, 0], [1.5, 0, 0], [2.2, 1.2, 0], [9, 9, 9]]),
        names=np.array(["CA", "C", "O", "OW"], object),
        resnames=np.array(["ALA"] * 3 + ["SOL"], object),
        resids=np.array([1, 1, 1, 2]),
        segids=np.array(["A"] * 4, object),
        masses=np.array([12.0, 12.0, 16.0, 16.0]),
        dimensions=np.array([20, 20, 20, 90, 90, 60], "f4"),
        ix=np.array([4, 5, 6, 9]),
    )
    atoms.bonds = type("Bonds", (), {"indices": np.array([[4, 5], [5, 6], [6, 7]]), "__len__": lambda self: 3})()
    spheres = interop.from_mdanalysis(SimpleNamespace(atoms=atoms))
    # The names of atoms say which elements they are.
    assert spheres["element"].tolist() == ["C", "C", "O", "O"] and spheres["mass"].tolist() == [12, 12, 16, 16]
    assert spheres["resname"].tolist() == ["ALA"] * 3 + ["SOL"] and len(spheres.select("protein")) == 3
    assert np.allclose(spheres.cell, [[20, 0, 0], [10, 10 * 3**0.5, 0], [0, 0, 20]])
    assert interop.from_mdanalysis(SimpleNamespace(atoms=atoms), show="sticks", pbc=False)._data.cone_count() > 0
    with pytest.raises(ph.InputError, match="this is int"):
        interop.from_mdanalysis(3)


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
