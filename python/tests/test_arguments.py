"""Short forms of arguments, and what is said about those that mean nothing."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import cloud

import pinhole as ph

pytestmark = pytest.mark.filterwarnings("ignore::pinhole.Note")


def test_views_of_every_kind_are_the_same():
    spheres = ph.Spheres(cloud(20), 0.2)
    asked = spheres.scene_file(camera=ph.Camera.frame((30, 20)))
    for camera in ((30, 20), [30, 20.0], np.array([30, 20]), ph.Camera.frame(np.array([30.0, 20.0]))):
        assert spheres.scene_file(camera=camera) == asked
    assert spheres.scene_file(camera="30,20") == asked


@pytest.mark.parametrize(
    "camera, words",
    [
        (3, "camera is 3; write a Camera, a view"),
        ((1, 2, 3), "a camera at a point is Camera.look_at(eye, at)"),
        (np.zeros(3), "or (azimuth, elevation) in degrees"),
    ],
)
def test_what_is_no_camera(camera, words):
    with pytest.raises(ph.InputError) as error:
        ph.Spheres(cloud(20), 0.2).render((8, 8), camera=camera)
    assert words in str(error.value)


def test_cameras_that_are_refused_at_once():
    for make, words in (
        (lambda: ph.Camera(fov=30, vertical_fov=20), "fov and vertical_fov say the same"),
        (lambda: ph.Camera(up="y"), "up is 'y'; write three numbers"),
        (lambda: ph.Camera(view=3), "view is 3"),
    ):
        with pytest.raises(ph.InputError, match=words):
            make()


def test_truth_values_and_texts_stand_for_tables():
    spheres = ph.Spheres(cloud(20), 0.2, color=np.arange(20.0))
    assert spheres.scene_file(legend=True, scale_bar=True) == spheres.scene_file(legend={}, scale_bar={})
    assert spheres.scene_file(legend=False, scale_bar=False) == spheres.scene_file()
    asked = spheres.scene_file(labels=[{"text": "a"}], lights=[{"kind": "head"}])
    for labels in ("a", ["a"], {"text": "a"}):
        assert spheres.scene_file(labels=labels, lights={"kind": "head"}) == asked


def test_with_takes_a_color_map():
    spheres = ph.Spheres(cloud(20), 0.2, columns={"q": np.arange(20.0)}, color_by="q")
    asked = spheres.with_(color_by={"column": "q", "map": "magma", "range": (0, 30)})
    assert spheres.with_(cmap="magma", color_range=(0, 30)).scene_file() == asked.scene_file()
    with pytest.raises(ph.InputError, match="cmap needs numbers"):
        ph.Spheres(cloud(20), 0.2).with_(cmap="magma")


@pytest.mark.parametrize(
    "settings, words",
    [
        ({"columns": cloud(20)}, "columns is ndarray; it must be a dict"),
        ({"select": np.ones(20, bool)}, "select is not a text"),
        ({"color": (255, 99, 71)}, 'write "#ff6347"'),
        ({"color": np.full((20, 3), 200)}, 'write color.astype("u1")'),
        ({"color": np.full((20, 4), 0.5)}, 'write (255 * color).astype("u1")'),
    ],
)
def test_data_that_is_refused(settings, words):
    with pytest.raises(ph.InputError) as error:
        ph.Spheres(cloud(20), 0.2, **settings)
    assert words in str(error.value)


def test_rules_say_what_is_drawn(tmp_path):
    path = tmp_path / "a.xyz"
    path.write_text("3\n\nO 0 0 0\nH 0.96 0 0\nC 9 0 0\n")
    with pytest.warns(ph.Note, match="1 of 3 spheres are in no rule"):
        sticks = ph.read(path).show("element O H", "licorice", radius=0.2)
    np.testing.assert_allclose(sticks.radii, [0.2, 0.2])
    both = sticks.show("rest", "ghost")
    # A ghost is not among the spheres, but in the picture.
    np.testing.assert_allclose(both.radii, [0.2, 0.2])
    look = {"size": (64, 48), "camera": ph.Camera.look_at((4, 0, 30), (4, 0, 0)), "backend": "cpu", "layers": ["id"]}
    faint, without = both.render(**look), sticks.render(**look)
    np.testing.assert_array_equal(faint.id, without.id)
    changed = np.any(faint.color != without.color, axis=2)
    assert 20 < changed.sum() < 2000
    again = ph.read(path, show=[("element O H", "licorice", {"radius": 0.2}), ("rest", "ghost")])
    np.testing.assert_array_equal(again.radii, both.radii)
    np.testing.assert_allclose(ph.read(path, show="lines").radii, 0.07)
    with pytest.raises(ph.InputError, match=r"render\(...\) makes a picture"):
        sticks.show()
    with pytest.raises(ph.InputError, match="`stick-figure` is no style"):
        sticks.show("stick-figure")
    with pytest.raises(ph.InputError, match="is no rule"):
        ph.read(path, show=[3])
