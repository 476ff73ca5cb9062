"""Arrays of every type, order and stride against a plain loop; and arrays that are refused."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import cloud

import pinhole as ph

REAL = ["f2", "f4", "f8", "i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8", ">f4", ">f8", ">i4", "bool"]


def plain(array):
    """The centres one by one, as Python numbers."""
    return [[float(x) for x in row] for row in array]


def layouts(array):
    """The same numbers in several orders and strides."""
    wide = np.zeros((2 * len(array), 7), array.dtype)
    wide[::2, 1::2] = array
    reversed_ = np.ascontiguousarray(array[::-1])[::-1]
    read_only = array.copy()
    read_only.setflags(write=False)
    return [np.ascontiguousarray(array), np.asfortranarray(array), wide[::2, 1::2], reversed_, read_only]


@pytest.mark.parametrize("dtype", REAL)
def test_every_type_and_layout_is_read(dtype):
    array = np.random.default_rng(3).integers(0, 2 if dtype == "bool" else 100, (20, 3)).astype(dtype)
    for layout in layouts(array):
        spheres = ph.Spheres(layout, radius=0.25)
        assert spheres.positions.tolist() == plain(array)
        assert spheres.radii.tolist() == [0.25] * 20


@pytest.mark.parametrize("dtype", ["f4", "f8", "i4", "u1"])
def test_radii_of_every_type_and_layout(dtype):
    radii = np.arange(1, 21).astype(dtype)
    for layout in (radii, np.repeat(radii, 2)[::2], radii[::-1].copy()[::-1], radii[:, None]):
        for positions in (cloud(20), cloud(20).astype("f4")):
            assert ph.Spheres(positions, layout).radii.tolist() == list(range(1, 21))


def test_float64_keeps_its_precision_far_away():
    near = cloud(50)
    spheres = ph.Spheres(near + [1e9, -1e9, 5e8], 0.1)
    moved = (near + [1e9, -1e9, 5e8]) - spheres.positions
    # float32 alone would be wrong by 32.
    assert np.abs(moved).max() < 1e-6


def test_lists_and_other_libraries_are_arrays_too():
    assert len(ph.Spheres([[0, 0, 0], (1, 2, 3)], 1)) == 2

    class Tensor:
        """An array of another library, in host memory."""

        def __init__(self, array):
            self.array = array

        def __dlpack__(self, **keys):
            return self.array.__dlpack__(**keys)

        def __dlpack_device__(self):
            return self.array.__dlpack_device__()

    assert ph.Spheres(Tensor(np.ones((4, 3), "f4")), 1).positions.tolist() == [[1, 1, 1]] * 4


def test_arrays_on_a_device_are_copied_with_a_note():
    class Cupy:
        """An array of CuPy, which NumPy does not copy by itself."""

        __cuda_array_interface__ = {"shape": (4, 3)}

        def get(self):
            return np.ones((4, 3), "f4")

        def __array__(self, *_):
            raise TypeError("Implicit conversion to a NumPy array is not allowed.")

    with pytest.warns(ph.Note, match="positions is copied from a CUDA device"):
        assert ph.Spheres(Cupy(), 1).positions.tolist() == [[1, 1, 1]] * 4


@pytest.mark.parametrize("count", [0, 1])
def test_few_spheres(count):
    spheres = ph.Spheres(np.zeros((count, 3)), radius=1.0)
    assert len(spheres) == count
    picture = spheres.render(size=(32, 24), backend="cpu", layers=["id"])
    assert (picture.id == 0).any() == (count == 1)
    assert repr(spheres) == f"<pinhole.Spheres: {count} sphere{'' if count == 1 else 's'}>"
    assert (spheres.bounds is None) == (count == 0)
    assert len(ph.Spheres([], radius=1)) == 0


REFUSED = [
    (np.zeros((3, 5)), "positions has the shape (3, 5); it must be (n, 3): transpose it, positions.T"),
    (np.zeros((5, 2)), "positions has the shape (5, 2); it must be (n, 3)"),
    (np.zeros((5, 4)), "radius=positions[:, 3]"),
    (np.zeros(3), "for one sphere, positions[None, :]"),
    (np.zeros((2, 2, 3)), "positions has the shape (2, 2, 3)"),
    (np.zeros((2, 3), complex), "positions has complex numbers (dtype complex128)"),
    (np.array([[1, 2, None]]), "positions has Python objects (dtype object)"),
    (np.array([["a", "b", "c"]]), "positions has texts"),
    (np.ma.masked_greater(np.zeros((2, 3)), 1), "positions is a masked array"),
    ([[1, 2, 3], [4, 5]], "positions is not an array of numbers"),
    (np.array([[0, 0, 0], [0, 0, 1], [0, np.nan, 0]]), "sphere 2: its center is [0.0, NaN, 0.0]"),
    (np.array([[0, 0, np.inf]]), "sphere 0: its center is"),
    (np.array([[0, 0, 1e300]]), "sphere 0: its center is"),
]


@pytest.mark.parametrize("positions, words", REFUSED)
def test_positions_that_are_refused(positions, words):
    with pytest.raises(ph.InputError) as error:
        ph.Spheres(positions, radius=1)
    assert words in str(error.value)
    assert isinstance(error.value, ValueError) and isinstance(error.value, ph.Error)


@pytest.mark.parametrize(
    "radius, words",
    [
        (0, "radius is 0.0; it must be finite and greater than 0"),
        (-1.5, "radius is -1.5"),
        (np.nan, "radius is nan"),
        ([1, 1, 0, 1], "radius: sphere 2 has the radius 0"),
        ([1, np.nan, 1, 1], "radius: sphere 1 has the radius nan"),
        ([1, 1], "radius has 2 values for 4 spheres"),
        (np.ones((4, 2)), "radius has the shape (4, 2); it must be (n,), here (4,)"),
        (1j, "radius has complex numbers"),
    ],
)
def test_radii_that_are_refused(radius, words):
    with pytest.raises(ph.InputError) as error:
        ph.Spheres(np.zeros((4, 3)), radius)
    assert words in str(error.value)


def test_without_radii_neighbours_about_touch():
    lattice = np.stack(np.meshgrid(*[np.arange(4.0)] * 3), axis=-1).reshape(-1, 3)
    with pytest.warns(ph.Note, match="all spheres have the radius 0.5"):
        spheres = ph.Spheres(lattice)
    assert spheres.radii.tolist() == [0.5] * 64
