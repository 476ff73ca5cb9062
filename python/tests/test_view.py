"""The kernel's half of the notebook view, to which messages go as the page sends them."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import cloud

import pinhole as ph
from pinhole._orbit import Orbit
from pinhole._refine import Refiner, screen_size

KEYS = {"style": "studio", "samples": 6, "backend": "cpu"}
SIZE = (64, 48)


def spheres_of(count=30):
    return ph.Spheres(cloud(count), 0.3, columns={"energy": np.arange(count) / 2}, color="teal")


@pytest.fixture
def view():
    pytest.importorskip("anywidget", reason="the view needs anywidget")
    # Tests of the widget need no kernel: messages to the page go nowhere.
    made = spheres_of().view(SIZE, **KEYS)
    made.wait(60)
    yield made
    made._refiner.wait(60)


def send(view, kind, **keys):
    """A message of the page."""
    view._handle_custom_msg({"kind": kind, **keys}, [])


def move(view, turn=(0, 0), pan=(0, 0), zoom=0, roll=0):
    send(view, "move", turn=list(turn), pan=list(pan), zoom=zoom, roll=roll)


def test_the_final_picture_is_that_of_render(view):
    first = view.image
    assert view._picture == spheres_of().render(SIZE, camera=view.camera, **KEYS)._repr_png_()
    # The first camera is the one without a view.
    assert view._picture == spheres_of().render(SIZE, **KEYS)._repr_png_()
    move(view, turn=(0.2, 0.1))
    move(view, zoom=50, pan=(0.05, 0), roll=0.3)
    send(view, "still")
    image = view.wait(60)
    assert image is view.image and not np.array_equal(image.rgb8, first.rgb8)
    assert view._picture == spheres_of().render(SIZE, camera=view.camera, **KEYS)._repr_png_()
    assert view._status == ""
    send(view, "reset")
    assert np.array_equal(view.wait(60).rgb8, first.rgb8)


def test_pictures_while_the_camera_moves_are_quick_and_the_last_one_counts(view):
    stages = []
    show = view._refiner.show
    view._refiner.show = lambda stage: (stages.append(stage), show(stage))
    for _ in range(200):
        move(view, turn=(0.01, 0))
    view.wait(60)
    quick = [stage for stage in stages if stage.is_quick]
    refined = [stage.samples for stage in stages if not stage.is_quick]
    assert 1 <= len(quick) < 200
    assert quick[0].image.size < SIZE
    # At the end, the camera was still. On a busy machine, it may have seemed so before.
    assert refined[-3:] == [1, 4, 6] and [stage.is_final for stage in stages[-3:]] == [False, False, True]
    assert all(repr(stage.camera) == repr(view.camera) for stage in stages[-3:])
    assert view._picture == spheres_of().render(SIZE, camera=view.camera, **KEYS)._repr_png_()


def test_pictures_that_nobody_waits_for_stop():
    spheres = ph.Spheres(cloud(2000), 0.1)
    settings = {"style": "path", "samples": 20_000, "backend": "cpu", "size": (400, 300)}
    orbit = Orbit(spheres._placed(settings), spheres.bounds)
    stages, first = [], threading.Event()

    def show(stage):
        stages.append(stage)
        first.set()

    refiner = Refiner(spheres, orbit.camera, (400, 300), {**settings, "size": None}, show, pytest.fail)
    refiner.ask(orbit.camera, moves=False)
    assert first.wait(60)
    # All samples would take many minutes.
    time.sleep(0.3)
    refiner.settings.update(samples=1)
    refiner.samples = 1
    orbit.turn(0.1, 0)
    asked = time.monotonic()
    refiner.ask(orbit.camera, moves=False)
    assert refiner.wait(60)
    assert time.monotonic() - asked < 10
    assert stages[-1].is_final and stages[-1].camera.keys == orbit.camera.keys
    assert sum(stage.is_final for stage in stages) == 1


def test_a_click_picks_a_sphere(view):
    told, observed = [], []
    image = view.image
    view.on_pick(told.append)
    view.observe(lambda change: observed.append(change["new"]), "picked")
    ids = spheres_of().render(SIZE, camera=view.camera, style="fast", layers=["id"], backend="cpu").id
    y, x = np.argwhere(ids < 30)[40]
    wanted = int(ids[y, x])
    send(view, "pick", at=[(x + 0.5) / SIZE[0], (y + 0.5) / SIZE[1]])
    view._refiner.wait(60)
    assert view.picked == wanted
    assert view._label == f"sphere {wanted}, energy {wanted / 2:g}"
    y, x = np.argwhere(ids > 30)[0]
    send(view, "pick", at=[(x + 0.5) / SIZE[0], (y + 0.5) / SIZE[1]])
    view._refiner.wait(60)
    assert view.picked is None and view._label == ""
    assert told == observed == [wanted, None]
    view.picked = 3
    assert view._label == "sphere 3, energy 1.5"
    send(view, "unpick")
    assert view.picked is None
    assert view.wait(60) is image, "the picture is still the same"


def test_a_click_is_answered_while_the_picture_is_refined():
    pytest.importorskip("anywidget", reason="the view needs anywidget")
    view = spheres_of().view((400, 300), style="path", samples=4000, backend="cpu")
    told = threading.Event()
    view.on_pick(lambda _: told.set())
    view.picked = 0
    told.clear()
    send(view, "pick", at=[0.001, 0.001])
    assert told.wait(10) and view.picked is None
    # The picture would take long.
    view._refiner.samples, view._refiner.settings["samples"] = 1, 1
    view.refresh()
    view.wait(60)


def test_bonds_are_picked_as_nothing():
    pytest.importorskip("anywidget", reason="the view needs anywidget")
    two = ph.Spheres([[0, 0, 0], [4, 0, 0]], 0.5, columns={"a": [1, 2]}, bonds={"length": 5.0})
    view = two.view(SIZE, camera="z", samples=1, backend="cpu")
    ids = two.render(SIZE, camera="z", style="fast", layers=["id"], backend="cpu").id
    assert 2 <= ids[24, 32] < 2**32 - 1, "a bond"
    view.picked = 1
    send(view, "pick", at=[0.5, 0.5])
    view._refiner.wait(60)
    assert view.picked is None


def test_messages_that_make_no_sense_do_nothing(view):
    before = repr(view.camera)
    for message in (None, 3, {}, {"kind": "move"}, {"kind": "move", "turn": [1], "zoom": "x"}, {"kind": "none"}):
        view._handle_custom_msg(message, [])
    send(view, "move", turn=[float("nan"), 0], pan=[float("inf"), 0], zoom=None, roll=[])
    send(view, "screen", ratio="large")
    send(view, "pick", at=[7, 7])
    assert repr(view.camera) == before
    view.wait(60)
    assert view.picked is None


def test_cameras_are_assigned(view):
    view.camera = "x"
    image = view.wait(60)
    assert np.array_equal(image.rgb8, spheres_of().render(SIZE, camera="x", **KEYS).rgb8)
    view.camera = ph.Camera.look_at((0, 0, 9), (0, 0, 0))
    image = view.wait(60)
    wanted = spheres_of().render(SIZE, camera=ph.Camera.look_at((0, 0, 9), (0, 0, 0)), **KEYS)
    assert np.array_equal(image.rgb8, wanted.rgb8)
    with pytest.raises(ph.InputError, match='view is "diagonal"'):
        view.camera = "diagonal"


def test_two_eyes_are_side_by_side(view):
    view.camera = ph.Camera.frame(stereo={"separation": 0.1, "convergence": 8.0})
    image = view.wait(60)
    assert image.size == (128, 48) and view._size == [128, 48]
    assert view._picture == spheres_of().render(SIZE, camera=view.camera, **KEYS)._repr_png_()
    view.camera = None
    assert view.wait(60).size == SIZE and view._size == list(SIZE)


def test_screens_with_small_pixels_get_more_of_them(view):
    send(view, "screen", ratio=2)
    assert view.size == (128, 96) and view.wait(60).size == (128, 96)
    assert view._size == list(SIZE)
    send(view, "screen", ratio=1)
    assert view.wait(60).size == SIZE
    assert screen_size((4000, 3000), 3) == (4619, 3464)
    assert screen_size((9000, 9000), 3) == (9000, 9000)


def test_updates_are_shown_by_refresh():
    pytest.importorskip("anywidget", reason="the view needs anywidget")
    spheres = ph.Spheres(cloud(20).astype("f4"), 0.3)
    view = spheres.view(SIZE, samples=1, backend="cpu")
    before = view.wait(60).rgb8
    spheres.update(radius=0.1)
    view.refresh()
    assert not np.array_equal(view.wait(60).rgb8, before)


@pytest.mark.parametrize(
    "keys, words",
    [
        ({"size": 10}, "write (width, height) in pixels"),
        ({"studio": {"outlin": 1}}, "did you mean `outline`?"),
        ({"sample": 4}, "did you mean samples?"),
        ({"camera": "diagonal"}, 'view is "diagonal"'),
        ({"style": "pretty"}, "unknown style"),
    ],
)
def test_settings_are_checked_at_once(keys, words):
    pytest.importorskip("anywidget", reason="the view needs anywidget")
    with pytest.raises(ph.InputError) as error:
        spheres_of().view(**{"size": SIZE, "backend": "cpu", **keys})
    assert words in str(error.value)


def test_errors_of_the_thread_are_raised_and_shown(view):
    view._refiner.settings["sampling"] = {"seed": "x"}
    view.refresh()
    with pytest.raises(ph.Error, match="seed"):
        view.wait(60)
    assert "seed" in view._status
    del view._refiner.settings["sampling"]
    view.refresh()
    view.wait(60)
    assert view._status == ""


def test_no_spheres_have_a_view():
    pytest.importorskip("anywidget", reason="the view needs anywidget")
    view = ph.Spheres(np.zeros((0, 3)), 1.0).view(SIZE, backend="cpu")
    move(view, turn=(0.1, 0.1), zoom=10)
    assert view.wait(60).size == SIZE


@pytest.mark.parametrize(
    "camera",
    [
        ph.Camera.frame("iso"),
        ph.Camera.frame("z", zoom=2.0),
        ph.Camera.frame("x", kind="orthographic"),
        ph.Camera.frame(kind="thin-lens", aperture_radius=0.1),
        ph.Camera.look_at((0, 0, 9), (0, 0, 0)),
    ],
)
def test_the_pointer_takes_things_along(camera):
    spheres = ph.Spheres([[0, 0, 0], [0.4, 0.2, 0.3], [-1, 0, 1]], 0.1)
    size = (200, 160)

    def orbit():
        return Orbit(spheres._placed({"size": size, "camera": camera}), spheres.bounds)

    still = orbit()
    seen = [spheres.render(size, style="fast", camera=of, layers=["id"]).id for of in (still.camera, camera)]
    assert (seen[0] == seen[1]).mean() > 0.999 and (seen[0] < 3).sum() > 20
    # Where the pivot is, things follow the pointer.
    pivot = ph.Spheres([still.pivot], 0.1)
    panned = orbit()
    panned.pan(0.25, 0.125)
    ids = pivot.render(size, style="fast", camera=panned.camera, layers=["id"], backend="cpu").id
    assert np.allclose(np.argwhere(ids == 0).mean(axis=0), (79.5 + 20, 99.5 + 40), atol=1.0)
    # What is in front moves to the right and down.
    turned = orbit()
    front = ph.Spheres([still.pivot - 0.3 * still.depth * still.direction], 0.1)
    turned.turn(0.05, 0.03)
    ids = front.render(size, style="fast", camera=turned.camera, layers=["id"], backend="cpu").id
    row, column = np.argwhere(ids == 0).mean(axis=0)
    assert row > 82 and column > 103
    zoomed = orbit()
    zoomed.zoom(100)
    def area(camera):
        return (pivot.render(size, style="fast", camera=camera, layers=["id"], backend="cpu").id == 0).sum()
    assert area(zoomed.camera) > 1.3 * area(still.camera)
    zoomed.zoom(-100)
    assert np.allclose(zoomed.eye, still.eye) and area(zoomed.camera) == area(still.camera)


def test_a_panorama_turns_about_itself():
    spheres = spheres_of()
    camera = ph.Camera("panorama", eye=[0, 0, 0], direction=[0, 0, -1])
    orbit = Orbit(spheres._placed({"camera": camera}), spheres.bounds)
    orbit.turn(0.3, 0.1)
    assert np.array_equal(orbit.eye, [0, 0, 0]) and not np.allclose(orbit.direction, [0, 0, -1])


AT_THE_END = """
import pinhole as ph, time
spheres = ph.Spheres([[x, y, 0] for x in range(30) for y in range(30)], 0.5)
view = spheres.view((640, 480), style="path", samples=5000, backend="cpu")
time.sleep(0.5)
print(view._refiner.stage is None or not view._refiner.stage.is_final)
"""


def test_the_interpreter_ends_while_a_picture_is_refined():
    pytest.importorskip("anywidget", reason="the view needs anywidget")
    done = subprocess.run([sys.executable, "-c", AT_THE_END], capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stdout, done.stderr) == (0, "True\n", "")


WITHOUT = """
import sys
sys.modules["anywidget"] = None
import pinhole as ph
spheres = ph.Spheres([[0, 0, 0]], 1.0)
assert spheres._repr_png_()[:4] == b"\\x89PNG"
try:
    spheres.view()
except ph.PackageError as error:
    assert isinstance(error, ImportError)
    print(error)
"""


def test_without_anywidget_the_remedy_is_said():
    done = subprocess.run([sys.executable, "-c", WITHOUT], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    words = "views need the package anywidget: pip install 'pinhole-rt[notebook]'; render(...) needs none\n"
    assert done.stdout == words


@pytest.fixture
def page(tmp_path):
    """The page's half, for node."""
    if shutil.which("node") is None:
        pytest.skip("node, which runs the page's half of the view, is missing")
    copy = tmp_path / "view.mjs"
    copy.write_bytes(Path(ph.__file__).with_name("_view.js").read_bytes())
    return copy


def test_the_pages_half_is_a_module(page):
    done = subprocess.run(["node", "--check", str(page)], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr


def test_what_the_page_sends(page):
    script = Path(__file__).with_name("view_page.mjs")
    done = subprocess.run(["node", str(script), str(page)], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    steps = json.loads(done.stdout)

    def moved(turn=(0, 0), pan=(0, 0), zoom=0, roll=0):
        return {"kind": "move", "turn": list(turn), "pan": list(pan), "zoom": zoom, "roll": roll}

    still = {"kind": "still"}
    # Parts of the height, 240, in pixels.
    wanted = {
        "start": [{"kind": "screen", "ratio": 2}],
        "click": [{"kind": "pick", "at": [0.5, 0.5]}],
        "drag": [moved(turn=(0.1, 0.1))],
        "without an answer": [],
        "with an answer": [moved(turn=(0.1, 0))],
        "release": [still],
        "shift": [moved(pan=(0.1, 0)), still],
        "ctrl": [moved(roll=0.2), still],
        "pinch": [moved(pan=(50 / 240, 0), zoom=pytest.approx(np.log(2) / 0.003)), still],
        "wheel": [moved(zoom=-100), still],
        "keys": [{"kind": "pick", "at": [0.5, 0.5]}, {"kind": "unpick"}, {"kind": "reset"}],
    }
    for name, messages in wanted.items():
        for message in steps[name]:
            for key in ("turn", "pan", "roll"):
                if key in message:
                    message[key] = np.round(message[key], 12).tolist()
        for message in messages:
            for key in ("turn", "pan", "roll"):
                if key in message:
                    message[key] = np.round(message[key], 12).tolist()
        assert steps[name] == messages, name
    assert steps["wheelIsTaken"] and steps["keysAreTaken"] == [True] * 4 + [False]
    assert (steps["label"], steps["status"], steps["tabIndex"]) == ("sphere 7", "4 of 16 samples", 0)
    assert (steps["name"], steps["width"], steps["isNew"]) == ("picture of 3 spheres", 320, True)
    # Old pictures are given back.
    assert (steps["urls"], steps["urlsAtTheEnd"], steps["listenersAtTheEnd"]) == (1, 0, 0)
