"""Cylinders and cones: alone, with other shapes, and refused."""

from __future__ import annotations

import numpy as np
import pytest

import pinhole as ph

SIZE = (64, 48)
MISS = np.uint32(0xFFFFFFFF)


def rods(count: int = 20) -> tuple[np.ndarray, np.ndarray]:
    start = np.random.default_rng(5).normal(size=(count, 3)) * 5
    return start, start + np.random.default_rng(6).normal(size=(count, 3))


def picture(shapes, **settings):
    return shapes.render(size=SIZE, samples=1, backend="cpu", layers=["id"], **settings)


def test_a_sum_shows_all_shapes_with_ids_of_spheres_first():
    spheres = ph.Spheres([[-3, 0, 0]], 1, color="red")
    cylinders = ph.Cylinders([[0, -1, 0]], [[0, 1, 0]], 0.5, color="navy")
    cones = ph.Cones([[3, -1, 0]], [[3, 1, 0]], (1, 0), color=[[0.0, 1.0, 0.0]])
    joined = cylinders + spheres + cones
    assert repr(joined) == "<pinhole.Shapes: 1 sphere, 2 cones>"
    assert set(np.unique(picture(joined).id)) == {0, 1, 2, MISS}
    low, high = joined.bounds
    assert (low[0], high[0]) == (-4, 4)
    for shapes in (cylinders, cones):
        assert len(shapes) == 1
        assert set(np.unique(picture(shapes).id)) == {0, MISS}
    # A sum is a copy.
    spheres.update(positions=[[50, 0, 0]])
    assert joined.bounds[1][0] == 4


def test_arrays_and_numbers_say_the_same():
    start, end = rods()
    one = ph.Cylinders(start, end, 0.25, color="tomato")
    for other in (
        ph.Cylinders(start.tolist(), np.asfortranarray(end), np.full(20, 0.25), color=["tomato"] * 20),
        ph.Cones(start, end, (0.25, 0.25), color="#ff6347"),
        ph.Cones(start, end, np.full((20, 2), 0.25), color=np.full((20, 3), [255, 99, 71], "u1")),
    ):
        assert np.array_equal(np.asarray(picture(one)), np.asarray(picture(other)))


def test_a_far_sum_keeps_its_shape():
    near = ph.Spheres([[0, 0, 0]], 1) + ph.Cylinders([[0, 0, 0]], [[0, 3, 0]], 0.25)
    far = np.array([1e9, -1e9, 5e8])
    moved = ph.Spheres([far], 1) + ph.Cylinders([far], [far + [0, 3, 0]], 0.25)
    assert np.array_equal(picture(near).id, picture(moved).id)


def test_round_ends_are_spheres():
    capsule = ph.Cylinders([[0, 0, 0]], [[0, 4, 0]], 1, round=True)
    assert [bound.tolist() for bound in capsule.bounds] == [[-1, -1, -1], [1, 5, 1]]
    assert repr(capsule) == "<pinhole.Cylinders: 1 cylinder>"
    assert set(np.unique(picture(capsule).id)) <= {0, 1, 2, MISS}


def test_material_and_opacity_are_those_of_all():
    start, end = rods()
    plain, clear = ph.Cylinders(start, end, 0.3), ph.Cylinders(start, end, 0.3, opacity=0.25)
    gold = ph.Cylinders(start, end, 0.3, material=ph.Material(kind="conductor", roughness=0.3))
    pictures = [np.asarray(picture(shapes, style="path")) for shapes in (plain, clear, gold, plain + clear)]
    assert all(not np.array_equal(one, other) for one, other in zip(pictures, pictures[1:]))


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda a, b: ph.Cylinders(a, b[:5], 1), "start has 20 rows and end has 5"),
        (lambda a, b: ph.Cylinders(a, b, [1, 2]), "radius has 2 values for 20 cylinders"),
        (lambda a, b: ph.Cylinders(a, b, -1), "shape 0: its radius is -1.0"),
        (lambda a, b: ph.Cylinders(a, a, 1), "shape 0: it has no length"),
        (lambda a, b: ph.Cylinders(a * np.nan, b, 1), "shape 0: its start is"),
        (lambda a, b: ph.Cylinders(a, b, 1, caps="all"), "caps is 'all'; it must be one of none, first, second, both"),
        (lambda a, b: ph.Cylinders(a, b, 1, caps="none", round=True), "caps and round exclude each other"),
        (lambda a, b: ph.Cylinders(a, b, 1, opacity=[1] * 20), "opacity: all cylinders have one"),
        (lambda a, b: ph.Cylinders(a, b, 1, color=np.zeros((20, 4), "u1")), "color has an alpha"),
        (lambda a, b: ph.Cylinders(a, b, 1, color=np.zeros((2, 3))), "color has 2 rows for 20 cylinders"),
        (lambda a, b: ph.Cylinders(a, b, 1, color="no color"), "color"),
        (lambda a, b: ph.Cylinders(a, b, 1, material=ph.Material(kind="emissive", strength=1)), "only spheres emit"),
        (lambda a, b: ph.Cones(a, b, 1), r"radii has the shape \(\); it must be \(2,\)"),
        (lambda a, b: ph.Spheres(a, 1).render(cylinders=[]), "there is no argument cylinders"),
    ],
)
def test_what_is_refused(make, words):
    with pytest.raises(ph.InputError, match=words):
        make(*rods())
