"""Columns and parts of spheres."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import cloud

import pinhole as ph

pytestmark = pytest.mark.filterwarnings("ignore::pinhole.Note")

PLACES = cloud(20)
SPEEDS = np.arange(60.0).reshape(20, 3)
NAMES = np.array(["a", "b"] * 10)


def spheres(**settings):
    return ph.Spheres(PLACES, 0.1, columns={"v": SPEEDS, "kind": NAMES, "heat": SPEEDS[:, 0]}, **settings)


def test_columns():
    of = spheres()
    assert of.columns == ["v.x", "v.y", "v.z", "kind", "heat"]
    assert np.array_equal(of["v"], SPEEDS) and np.allclose(of["|v|"], np.linalg.norm(SPEEDS, axis=1))
    assert np.allclose(of["x"], PLACES[:, 0]) and of["index"].tolist() == list(range(20)) and of["radius"][0] == np.float32(0.1)
    assert of["kind"].tolist() == NAMES.tolist()
    chosen = spheres(select="kind == a")
    assert chosen["heat"].tolist() == SPEEDS[::2, 0].tolist() and len(chosen) == 10


def test_parts_by_masks_slices_and_indices():
    of = spheres(color_by="heat")
    for index in (NAMES == "b", slice(3, 9), [7, 2, 2], np.array([-1]), slice(None, None, -1), 4):
        part = of[index]
        wanted = np.atleast_2d(PLACES[index]).reshape(-1, 3)
        assert np.allclose(part.positions, wanted) and np.array_equal(part["v"], np.atleast_2d(SPEEDS[index]).reshape(-1, 3))
    assert of[NAMES == "b"].color_key["range"] == (3.0, 57.0)
    water = ph.Spheres(PLACES, 0.1, columns={"resname": ["HOH", "ALA"] * 10, "n": range(20)}, show=[("water", "hidden")])
    assert water["n"].tolist() == list(range(1, 20, 2)) and water[1:3]["n"].tolist() == [3, 5]
    assert len(water.select("water").with_(show="spacefill")) == 10
    numbered = ph.Spheres(PLACES, 0.1, columns={"index": range(5, 25)}, select="index > 9")
    assert numbered["index"].tolist() == list(range(10, 25))
    with pytest.raises(ph.InputError, match="the column `index` has other numbers"):
        numbered[:2]
    cell = ph.Spheres(PLACES, 0.1, cell=(9, 9, 9), replicate="2x1x1", select="x > 4.5", columns={"n": range(20)}, kind="plain")
    assert np.allclose(cell[:3].positions, cell.positions[:3]) and cell[:3]["n"].tolist() == cell["n"][:3].tolist()
    twice = spheres(select="kind == a")[2:][::-1]
    assert twice["heat"].tolist() == SPEEDS[::2, 0][2:][::-1].tolist()
    assert len(spheres()[[]]) == 0 and len(spheres()[np.zeros(20, bool)]) == 0
    assert [len(one) for one in of[:3]] == [1, 1, 1]
    simple = ph.Spheres(PLACES, 0.2, (255 * np.abs(PLACES) % 256).astype("u1"))
    assert np.allclose(simple[5:7].positions, PLACES[5:7]) and simple[[1]].radii.tolist() == [np.float32(0.2)]
    scaled = ph.Spheres(PLACES, 0.2, "red", radius_scale=0.5)
    assert np.allclose(scaled[:2].radii, 0.1)


def test_selections():
    of = spheres()
    assert of.mask("kind == b and heat > 20").tolist() == ((NAMES == "b") & (SPEEDS[:, 0] > 20)).tolist()
    assert of.select("kind == b").select("heat > 20")["heat"].tolist() == [21, 27, 33, 39, 45, 51, 57]
    names = ph.Spheres(PLACES, 0.2, columns={"resname": NAMES, "chain": ["A", "B", "C", "C"] * 5})
    assert len(names.select({"resn": "a", "chain": ["A", "C"]})) == 10 and names.mask({"chain": "B"}).sum() == 5
    assert not hasattr(of, "nix") and not hasattr(of, "add_licorice")
    assert len(ph.Spheres(PLACES, 0.2).select("x > 0")) == (PLACES[:, 0] > 0).sum()


def test_bonds_of_pairs_and_parts():
    chain = ph.Spheres([[i, 0, 0] for i in range(4)], 0.3, pairs=[[0, 1], [3, 2]], columns={"n": range(4)}, bonds=True)
    assert chain._data.cone_count() == 2
    assert chain[2:]._data.cone_count() == 1 and chain[[1, 2]]._data.cone_count() == 0


def test_a_cell():
    of = ph.Spheres(PLACES, 0.1, cell=(4, 5, 6), origin=(-2, -2, -2), box=True)
    assert of.cell.tolist() == [[4, 0, 0], [0, 5, 0], [0, 0, 6]] and of._data.cone_count() == 12


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda of: of["nix"], "there is no column `nix`"),
        (lambda of: of[["kind"]], "give a name of a column, a mask, a slice, or indices"),
        (lambda of: of[np.ones(3, bool)], r"the mask has the shape \(3,\) for 20 spheres"),
        (lambda of: of[1.5], "give a name"),
        (lambda of: of.select("heat > 1e9"), "select"),
        (lambda of: of.mask("nix > 1"), "there is no column `nix`"),
        (lambda of: ph.Spheres(PLACES, kind="solid"), 'kind is "solid"; the kinds are scan'),
        (lambda of: ph.Spheres(PLACES, kind=3), "write the name of a kind"),
        (lambda of: of.render(kind="plain"), "kind is not an argument here; give it to Spheres"),
        (lambda of: ph.Spheres(PLACES, cell=[1, 2]), "cell has the shape"),
        (lambda of: ph.Spheres(PLACES, cell=[1, 0, 1]), "must not lie in one plane"),
        (lambda of: ph.Spheres(PLACES, cell=[1, 1, 1], origin=[0]), "origin is"),
        (lambda of: ph.Spheres(PLACES, pairs=[[0, 20]]), "pairs has the index 20; there are 20 spheres"),
        (lambda of: ph.Spheres(PLACES, pairs=[0, 1]), "pairs has the shape"),
        (lambda of: spheres(color_by="heat", cmap=3), "cmap is 3"),
        (lambda of: of.update(positions=PLACES[:10]), "there are 10 new values for 20 spheres; first="),
        (lambda of: ph.Camera.frame("tops"), 'view is "tops": write x, -x'),
        (lambda of: of.add_licorice("HEM"), "Spheres has no add_licorice; spheres.show"),
        (lambda of: of.setStyle({}), "Spheres has no setStyle"),
    ],
)
def test_bad_input(make, words):
    with pytest.raises(ph.InputError, match=words):
        make(spheres())


def test_color_maps_of_matplotlib():
    class Map:
        name = "mine"

        def __call__(self, part):
            return (part, 0.0, 1.0 - part, 1.0)

    key = ph.Spheres(PLACES, 0.1, color=PLACES[:, 0], cmap=Map()).color_key
    assert key["colors"][0].tolist() == [0, 0, 255] and key["colors"][-1].tolist() == [255, 0, 0]
    Map.name = "plasma"
    known = ph.Spheres(PLACES, 0.1, color=PLACES[:, 0], cmap="plasma").color_key["colors"]
    assert np.array_equal(ph.Spheres(PLACES, 0.1, color=PLACES[:, 0], cmap=Map()).color_key["colors"], known)
