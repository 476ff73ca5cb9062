"""Colours of all kinds: what a picture without light shows is the sphere's own colour."""

from __future__ import annotations

import numpy as np
import pytest

import pinhole as ph

ROW = np.array([[0.0, 0, 0], [3, 0, 0], [6, 0, 0]])


def shown(**keys):
    """The colours of three spheres in a picture without light, in sRGB bytes."""
    spheres = ph.Spheres(ROW, radius=1.0, **keys)
    camera = ph.Camera.frame("z", kind="orthographic")
    picture = spheres.render(
        size=(90, 30), style="fast", shading="flat", camera=camera, backend="cpu", layers=["id"]
    )
    return [picture.rgb8[picture.id == index].reshape(-1, 3)[0].tolist() for index in range(3)]


def test_one_color():
    assert shown(color="tomato") == [[255, 99, 71]] * 3
    assert shown(color="#102030") == [[16, 32, 48]] * 3
    # Triples are linear light, as in scene files.
    assert shown(color=(1.0, 0.0, 0.5)) == [[255, 0, 188]] * 3


def test_a_color_for_each_sphere():
    rgb = np.array([[1, 2, 3], [40, 50, 60], [255, 0, 128]], np.uint8)
    assert shown(color=rgb) == rgb.tolist()
    rgba = np.concatenate([rgb, np.full((3, 1), 255, np.uint8)], axis=1)
    assert shown(color=np.asfortranarray(rgba)) == rgb.tolist()
    linear = np.array([[1.0, 0, 0], [0, 0.5, 0], [0.0, 0, 0.25]])
    assert shown(color=linear) == [[255, 0, 0], [0, 188, 0], [0, 0, 137]]


@pytest.mark.filterwarnings("ignore::pinhole.Note")
def test_numbers_on_a_color_map():
    viridis = [[0x44, 0x01, 0x54], [0x21, 0x91, 0x8C], [0xFD, 0xE7, 0x25]]
    numbers = np.array([0.0, 0.5, 1.0])
    assert np.abs(np.array(shown(color=numbers)) - viridis).max() <= 1
    assert shown(color=numbers, cmap="viridis") == shown(color=numbers)
    halved = shown(color=np.array([0.0, 1, 2]), cmap="gray", color_range=(0, 4))
    assert halved[0] == [0, 0, 0] and abs(halved[2][0] - 128) <= 1
    by_column = shown(columns={"energy": numbers}, color_by="energy")
    assert by_column == shown(color=numbers)
    # A few whole numbers are kinds, which get the colours of a palette.
    assert shown(color=np.array([0, 1, 2])) == shown(color=np.array(["a", "b", "c"]))


@pytest.mark.filterwarnings("ignore::pinhole.Note")
def test_texts_have_colors_of_a_palette():
    first, second, third = shown(color=np.array(["a", "b", "a"]))
    assert first == third != second


def test_names_of_colors_for_each_sphere():
    bytes_of = [[255, 99, 71], [70, 130, 180], [255, 99, 71]]
    assert shown(color=["tomato", "steelblue", "tomato"]) == bytes_of
    assert shown(color=np.array(["#ff6347", "rgb(70 130 180)", "tomato"])) == bytes_of
    assert ph.Spheres(ROW, radius=1.0, color=["red", "lime", "blue"]).color_key is None


@pytest.mark.filterwarnings("ignore::pinhole.Note")
def test_what_colors_mean():
    assert ph.Spheres(ROW, radius=1.0, color="red").color_key is None
    scale = ph.Spheres(ROW, radius=1.0, columns={"v": [1.0, 5.5, 10]}, color_by={"column": "v", "log": True}).color_key
    assert scale["title"] == "v" and scale["range"] == (1.0, 10.0) and scale["log"] is True
    assert scale["colors"].dtype == np.uint8 and scale["colors"][0].tolist() == [0x44, 0x01, 0x54]
    kinds = ph.Spheres(ROW, radius=1.0, columns={"species": ["A", "B", "A"]})
    assert [*kinds.color_key["categories"].values()] == [tuple(rgb) for rgb in shown(columns={"species": ["A", "B", "A"]})[:2]]
    assert [*kinds.color_key["categories"]] == ["A", "B"]


def lit(material, **keys):
    spheres = ph.Spheres(ROW, 1.0, "white", material=material, **keys)
    return spheres.render((90, 30), style="path", samples=4, camera=ph.Camera.frame("z"), backend="cpu").color


def test_a_material_for_each_sphere():
    lamp, metal = ph.Material(kind="emissive", strength=3.0), ph.Material(kind="conductor", roughness=0.1)
    different = lit([metal, lamp, metal])
    assert np.allclose(different[15, 45], 3.0) and not np.allclose(different[15, 75], 3.0)
    named = lit(["gold", "bulb", "gold"], materials={"bulb": lamp, "gold": metal})
    assert np.array_equal(named, different)
    assert np.array_equal(named, lit(np.array(["gold", "bulb", "gold"]), materials={"bulb": lamp, "gold": dict(metal)}))
    assert np.array_equal(lit([metal] * 3), lit(metal))


@pytest.mark.parametrize(
    "keys, words",
    [
        ({"material": [ph.Material(kind="emissive")]}, "material has 1 values for 3 spheres"),
        ({"material": ["a", "b", "a"]}, "there is no material 'a'; materials has none"),
        ({"material": ["a", "b", "a"], "materials": {"a": {}}}, "there is no material 'b'; materials has a"),
        ({"material": [1, 2, 3]}, "that of sphere 0 is 1"),
        ({"material": [{"kind": "glass"}] * 3}, "glass"),
        ({"material": [ph.Ground(height=1)] * 3}, "the table Ground is for ground"),
        ({"material": [{}] * 3, "elements": {"A": {}}}, "material for each sphere and elements exclude each other"),
    ],
)
def test_materials_that_are_refused(keys, words):
    with pytest.raises(ph.InputError) as error:
        ph.Spheres(ROW, radius=1.0, **keys)
    assert words in str(error.value)


@pytest.mark.parametrize(
    "keys, words",
    [
        ({"color": "reddish"}, "`reddish` is not a valid color"),
        ({"color": np.array([0.0, 1, 2]), "cmap": "virid"}, "did you mean `viridis`? maps for numbers are viridis"),
        ({"cmap": "viridis"}, "cmap needs numbers"),
        ({"color": np.zeros((2, 3))}, "color has 2 rows for 3 spheres"),
        ({"color": np.zeros((3, 2))}, "color has the shape (3, 2)"),
        ({"color": np.zeros((3, 3), int)}, "it must be (n, 3) or (n, 4) in uint8"),
        ({"color": np.array([[0, 0, -1.0]] * 3)}, "color: sphere 0"),
        ({"color": np.zeros(4)}, "color has 4 values for 3 spheres"),
        ({"color_by": "speed"}, "speed"),
        ({"opacity": 2.0}, "`opacity` is 2"),
        ({"opacity": [0.5, 1]}, "opacity has 2 values for 3 spheres"),
        ({"columns": {"a": [1, 2]}}, "columns['a'] has 2 values"),
        ({"material": {"kind": "glass"}}, "glass"),
        ({"size": (2, 2)}, "size is not an argument here; give it to render"),
        ({"colour": "red"}, "did you mean color?"),
    ],
)
def test_colors_that_are_refused(keys, words):
    with pytest.raises(ph.InputError) as error:
        ph.Spheres(ROW, radius=1.0, **keys)
    assert words in str(error.value)
