"""Sheets of pictures, and movies of arrays."""

from __future__ import annotations

import numpy as np
import pytest

import pinhole as ph


def pixels_of(file) -> np.ndarray:
    """The pixels of a PNG file."""
    return np.array(pytest.importorskip("PIL.Image", reason="Pillow, which reads PNG files, is missing").open(file))


@pytest.mark.parametrize("channels", [3, 4])
def test_a_sheet_has_every_pixel(tmp_path, channels):
    random = np.random.default_rng(1)
    pictures = [random.integers(0, 256, (4, 6, channels), dtype=np.uint8) for _ in range(5)]
    ph.sheet(tmp_path / "a.png", pictures, columns=2, gap=3)
    found = pixels_of(tmp_path / "a.png")
    assert found.shape == (3 * 4 + 2 * 3, 2 * 6 + 3, channels)
    for index, picture in enumerate(pictures):
        top, left = index // 2 * 7, index % 2 * 9
        assert np.array_equal(found[top : top + 4, left : left + 6], picture)
        found[top : top + 4, left : left + 6] = 255
    assert (found == 255).all()


def test_a_sheet_takes_pictures_and_arrays(tmp_path):
    image = ph.Spheres([[0, 0, 0]], 1.0, color="tomato").render((12, 8), backend="cpu")
    ph.sheet(tmp_path / "a.png", (picture for picture in (image, image.rgb8[:, ::-1])))
    found = pixels_of(tmp_path / "a.png")
    assert np.array_equal(found, np.concatenate([image.rgb8, image.rgb8[:, ::-1]], axis=1))


@pytest.mark.parametrize(
    "path, images, keys, words",
    [
        ("a.jpg", [np.zeros((2, 2, 3), "u1")], {}, "written as .png"),
        ("a.png", [], {}, "there are no pictures"),
        ("a.png", [np.zeros((2, 2, 3))], {}, "picture 0 has the shape (2, 2, 3) and the type float64"),
        ("a.png", [np.zeros((2, 2), "u1")], {}, "picture 0 has the shape (2, 2)"),
        ("a.png", [np.zeros((2, 2, 3), "u1"), np.zeros((2, 3, 3), "u1")], {}, "picture 1 has (2, 3, 3)"),
        ("a.png", [np.zeros((2, 2, 3), "u1")], {"columns": 0}, "at least 1 column"),
        ("a.png", [np.zeros((2, 2, 3), "u1")], {"gap": -1}, "no negative gap"),
    ],
)
def test_what_is_no_sheet(tmp_path, path, images, keys, words):
    with pytest.raises(ph.InputError) as error:
        ph.sheet(tmp_path / path, images, **keys)
    assert words in str(error.value) and not list(tmp_path.iterdir())


def test_movies_of_arrays(tmp_path):
    frames = [np.full((4, 6, 3), value, np.uint8) for value in (10, 20)]
    ph.movie(tmp_path / "f%02d.png", frames)
    assert np.array_equal(pixels_of(tmp_path / "f01.png"), frames[1])
    image = ph.Spheres([[0, 0, 0]], 1.0).render((8, 8), backend="cpu")
    for path, images, words in (
        ("g%02d.png", [], "there are no pictures"),
        ("g%02d.png", image, "images is one picture"),
        ("g%02d.png", [np.zeros((2, 2))], "picture 0 has the shape (2, 2)"),
    ):
        with pytest.raises(ph.InputError) as error:
            ph.movie(tmp_path / path, images)
        assert words in str(error.value)
    for frames in (0, -1, 2.5):
        with pytest.raises(ph.InputError, match="frames is"):
            ph.Spheres([[0, 0, 0]], 1.0).turntable(tmp_path / "g%02d.png", frames=frames, size=(8, 8))
