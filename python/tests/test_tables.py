"""Tables of scene files as objects."""

from __future__ import annotations

import copy
import inspect
import pickle
import sys

import numpy as np
import pytest
from conftest import cloud

import pinhole as ph
from pinhole import _tables

#: What each table needs besides other keys.
NEEDS = {
    "Arrows": {"vector": "forces"},
    "Light": {"kind": "head"},
    "Sky": {"kind": "constant"},
    "Material": {"kind": "lambert"},
    "ColorBy": {"column": "a"},
    "RadiusBy": {"column": "a"},
    "OpacityBy": {"column": "a"},
    "EmissionBy": {"column": "a"},
    "Label": {"text": "a", "position": "top-left"},
    "Sun": {"toward": [0, 1, 0]},
}


@pytest.mark.parametrize("table", _tables.ALL, ids=lambda table: table.__name__)
def test_the_keys_are_those_of_the_library(table):
    with pytest.raises(ph.InputError):
        table(zzzzzzzzzzzz=1)
    assert set(NEEDS.get(table.__name__, {})) <= set(table.names) and table.names
    assert getattr(ph, table.__name__) is table and table.__name__ in ph.__all__
    assert list(inspect.signature(table).parameters) == list(table.names)
    assert table(**NEEDS.get(table.__name__, {})) == NEEDS.get(table.__name__, {})


def test_tables_print_as_in_scene_files():
    studio = ph.Studio(occlusion=ph.Occlusion(samples=4, radius=2.5), shadows=False, outline={"width": 1}, ambient=None)
    text = """\
[studio]
shadows = false

[studio.occlusion]
samples = 4
radius = 2.5

[studio.outline]
width = 1"""
    assert repr(studio) == str(studio) == text
    assert repr(ph.Light(kind="head")) == '[[lights]]\nkind = "head"'
    assert repr(ph.Material(kind="conductor")).splitlines()[0] == "[materials.given]"
    if sys.version_info >= (3, 11):
        import tomllib

        assert tomllib.loads(repr(studio)) == {"studio": studio}


def test_tables_and_dicts_give_the_same_picture():
    positions = cloud(50)
    columns = {"a": np.arange(50.0)}
    keys = {"size": (48, 36), "backend": "cpu"}
    objects = ph.Spheres(
        positions, 0.2, columns=columns, color_by=ph.ColorBy(column="a", map="magma"), material=ph.Material(kind="emissive")
    ).render(
        sampling=ph.Sampling(samples=2, seed=3),
        studio=ph.Studio(occlusion=ph.Occlusion(samples=1)),
        lights=[ph.Light(kind="directional", toward=np.array([1, 2, 3]))],
        ground=ph.Ground(color="red"),
        **keys,
    )
    dicts = ph.Spheres(
        positions, 0.2, columns=columns, color_by={"column": "a", "map": "magma"}, material={"kind": "emissive"}
    ).render(
        sampling={"samples": 2, "seed": 3},
        studio={"occlusion": {"samples": 1}},
        lights=[{"kind": "directional", "toward": [1, 2, 3]}],
        ground={"color": "red"},
        **keys,
    )
    assert objects._repr_png_() == dicts._repr_png_()
    samples = ph.Spheres(positions, 0.2).render(samples=2, sampling=ph.Sampling(seed=1), layers=["samples"], **keys).samples
    assert (samples == 2).all()


@pytest.mark.parametrize(
    "make, words",
    [
        (lambda: ph.Studio(outlin=1), "studio.outlin: unknown key `outlin`; did you mean `outline`?"),
        (lambda: ph.Occlusion(samples=-1), "studio.occlusion"),
        (lambda: ph.Sampling(samples=0), "`samples` is 0; it must be from 1 to"),
        (lambda: ph.Path(max_depth="many"), "path.max_depth"),
        (lambda: ph.Light(kind="dark"), "lights[0]"),
        (lambda: ph.Studio(outline=ph.Occlusion()), "studio.outline: the table Occlusion is for studio.occlusion"),
    ],
)
def test_tables_are_checked_when_they_are_made(make, words):
    with pytest.raises(ph.InputError) as error:
        make()
    assert words in str(error.value) and "\n" not in str(error.value)


def test_tables_in_the_wrong_place():
    spheres = ph.Spheres([[0, 0, 0]], 1.0)
    with pytest.raises(ph.InputError, match="studio: the table Path is for path"):
        spheres.render(studio=ph.Path())
    with pytest.raises(ph.InputError, match="lights: the table Sun is for sun"):
        spheres.render(lights=[ph.Sun(toward=(0, 1, 0))])
    with pytest.raises(ph.InputError, match="radius_by: the table ColorBy is for color_by"):
        ph.Spheres([[0, 0, 0]], 1.0, columns={"a": [1]}, radius_by=ph.ColorBy(column="a"))


def test_tables_are_dicts():
    studio = ph.Studio(shadows=False, occlusion=ph.Occlusion(samples=2))
    assert studio == {"shadows": False, "occlusion": {"samples": 2}}
    for copied in (copy.deepcopy(studio), pickle.loads(pickle.dumps(studio))):
        assert copied == studio and isinstance(copied, ph.Studio) and repr(copied) == repr(studio)
    assert {**studio, "shadows": True}["shadows"]
