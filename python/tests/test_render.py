"""Pictures: layers, files, settings, interruption and threads."""

from __future__ import annotations

import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from conftest import cloud

import pinhole as ph
from pinhole import _pinhole

ALL = ["alpha", "depth", "normal", "position", "albedo", "id", "samples", "variance"]


def test_layers_are_arrays():
    picture = ph.Spheres([[0, 0, 0]], 1.0).render(size=(40, 30), samples=3, layers=ALL, backend="cpu")
    assert picture.size == (40, 30) and picture.layers == ["color", *ALL]
    assert picture.adapter is None
    kinds = {name: (getattr(picture, name).dtype.str, getattr(picture, name).shape) for name in picture.layers}
    vector, number = ("<f4", (30, 40, 3)), ("<f4", (30, 40))
    assert kinds == {
        "color": vector, "alpha": number, "depth": number, "normal": vector, "position": vector, "albedo": vector,
        "id": ("<u4", (30, 40)), "samples": ("<u4", (30, 40)), "variance": number,
    }  # fmt: skip
    hit = picture.id == 0
    assert hit.any() and (~hit).any()
    assert np.isinf(picture.depth[~hit]).all() and np.isfinite(picture.depth[hit]).all()
    assert np.allclose(np.linalg.norm(picture.normal[hit], axis=1), 1, atol=1e-5)
    assert np.allclose(np.linalg.norm(picture.position[hit], axis=1), 1, atol=1e-5)
    assert (picture.samples == 3).all()
    array = np.asarray(picture)
    assert array.dtype == np.uint8 and array.shape == (30, 40, 3)
    assert np.array(picture, dtype=float).dtype == float
    with pytest.raises(ValueError):
        picture.color[0] = 1


def test_a_layer_that_was_not_asked_for():
    picture = ph.Spheres([[0, 0, 0]], 1.0).render(size=(8, 8), backend="cpu")
    with pytest.raises(ph.InputError, match=r"no layer depth; ask for it with render\(layers=\['depth'\]\)"):
        picture.depth


def test_files(tmp_path):
    picture = ph.Spheres([[0, 0, 0]], 1.0).render(size=(20, 10), backend="cpu", layers=["depth"], transparent=True)
    assert picture.rgb8.shape == (10, 20, 4)
    for name in ("a.png", "a.exr", "a.npy"):
        picture.save(tmp_path / name)
    picture.save(tmp_path / "depth.npy", layer="depth")
    assert (tmp_path / "a.png").read_bytes() == picture._repr_png_()
    assert (tmp_path / "a.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    assert (tmp_path / "a.exr").read_bytes()[:4] == b"\x76\x2f\x31\x01"
    assert np.array_equal(np.load(tmp_path / "a.npy"), picture.color)
    assert np.array_equal(np.load(tmp_path / "depth.npy"), picture.depth)
    assert sorted(os.listdir(tmp_path)) == ["a.exr", "a.npy", "a.png", "depth.npy"]
    with pytest.raises(ph.InputError, match="written as .png or .exr"):
        picture.save("a.jpg")
    with pytest.raises(ph.FileError, match="cannot be written: No such file") as error:
        picture.save(tmp_path / "none" / "a.png")
    assert isinstance(error.value, OSError)


@pytest.mark.parametrize(
    "keys, words",
    [
        ({"studio": {"outlin": 1}}, "studio.outlin: unknown key `outlin`; did you mean `outline`?"),
        ({"samples": 0}, "sampling.samples: `samples` is 0; it must be from 1 to"),
        ({"style": "pretty"}, "style: unknown style `pretty`"),
        ({"layers": ["dept"]}, "there is no layer `dept`"),
        ({"backend": "tpu"}, 'backend is "tpu"'),
        ({"size": (0, 10)}, "film"),
        ({"size": 10}, "size is 10; write (width, height) in pixels"),
        ({"camera": "diagonal"}, 'view is "diagonal"'),
        ({"camera": {"pinhol": {}}}, "did you mean `pinhole`?"),
        ({"camera": ph.Camera.frame(fov=200)}, "camera"),
        ({"samples": 2, "sampling": {"samples": 3}}, "samples is given twice"),
        ({"studio": {}, "path": {}}, "choose one with"),
        ({"select": "x > 0"}, "select is not an argument here; give it to Spheres"),
        ({"sample": 4}, "did you mean samples?"),
        ({"studio": {"outline": object()}}, "studio.outline: object cannot be a setting"),
        ({"legend": {}}, "legend"),
        ({"integrator": "path", "sky": {"kind": "image", "image": "none.exr"}}, "none.exr: cannot be read"),
    ],
)
def test_settings_that_are_refused(keys, words):
    with pytest.raises(ph.Error) as error:
        ph.Spheres([[0, 0, 0]], 1.0).render(**{"size": (8, 8), "backend": "cpu", **keys})
    assert words in str(error.value)
    assert "\n" not in str(error.value)


def test_the_scene_file_says_the_settings():
    spheres = ph.Spheres([[0, 0, 0]], 1.0, material={"kind": "conductor"})
    text = spheres.scene_file(size=(8, 8), samples=2, lights=[{"direction": [0, 1, 0]}])
    for line in ('data = "spheres"', "[film]", "width = 8", "samples = 2", "[[lights]]", 'style = "default"'):
        assert line in text.splitlines()


def test_threads_render_side_by_side():
    clouds = [ph.Spheres(cloud(200, seed), 0.1) for seed in range(4)]
    alone = [spheres.render(size=(64, 48), samples=2).rgb8 for spheres in clouds]
    found = [None] * 8
    def render(place):
        found[place] = clouds[place % 4].render(size=(64, 48), samples=2).rgb8
    threads = [threading.Thread(target=render, args=(place,)) for place in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for place, picture in enumerate(found):
        assert np.array_equal(picture, alone[place % 4])


def test_the_gil_is_released():
    spheres = ph.Spheres(cloud(2000), 0.1)
    done = threading.Event()
    def render():
        spheres.render(size=(400, 300), samples=16, backend="cpu")
        done.set()
    thread = threading.Thread(target=render)
    turns = 0
    thread.start()
    while not done.is_set():
        turns += 1
        time.sleep(0.001)
    thread.join()
    assert turns > 20


@pytest.mark.parametrize("backend", ["auto", "cpu"])
def test_ctrl_c_stops_within_a_second(backend):
    spheres = ph.Spheres(cloud(2000), 0.1)
    spheres.render(size=(8, 8), backend=backend)
    sent = []
    def interrupt():
        time.sleep(0.5)
        sent.append(time.monotonic())
        signal.raise_signal(signal.SIGINT) if os.name == "nt" else os.kill(os.getpid(), signal.SIGINT)
    thread = threading.Thread(target=interrupt)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        spheres.render(size=(1600, 1200), samples=10_000, style="path", backend=backend)
    assert time.monotonic() - sent[0] < 1.0
    thread.join()
    # The device still works.
    assert spheres.render(size=(8, 8), backend=backend).size == (8, 8)


def test_ctrl_c_stops_who_waits_for_another_thread():
    spheres = ph.Spheres(cloud(2000), 0.1)
    stopped = threading.Event()

    def progress(part):
        if stopped.is_set():
            raise RuntimeError("enough")

    def long_render():
        with pytest.raises(RuntimeError):
            spheres.render(size=(1600, 1200), samples=10_000, style="path", progress=progress)

    other = threading.Thread(target=long_render)
    other.start()
    time.sleep(0.5)
    sent = []

    def interrupt():
        time.sleep(0.3)
        sent.append(time.monotonic())
        signal.raise_signal(signal.SIGINT) if os.name == "nt" else os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=interrupt).start()
    try:
        with pytest.raises(KeyboardInterrupt):
            spheres.render(size=(8, 8), samples=1)
        assert time.monotonic() - sent[0] < 1.0
    finally:
        stopped.set()
        other.join()


BUILD = """
import os, signal, sys, threading, time
import numpy as np, pinhole as ph
spheres = ph.Spheres(np.random.default_rng(1).random((2_000_000, 3), "f4"), 0.005, (1.0, 0.0, 0.0))
ph.Spheres([[0, 0, 0]], 1.0).render(size=(8, 8))
signal.signal(signal.SIGINT, signal.default_int_handler)
sent = []
def interrupt():
    # Long before the structure is built.
    time.sleep(0.1)
    sent.append(time.monotonic())
    os.kill(os.getpid(), signal.SIGINT)
threading.Thread(target=interrupt).start()
try:
    spheres.render(size=(8, 8), style="fast")
except KeyboardInterrupt:
    print(time.monotonic() - sent[0])
"""


@pytest.mark.skipif(os.name == "nt", reason="this system has no signals")
def test_ctrl_c_stops_while_a_structure_is_built_and_the_process_ends_well():
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", BUILD], capture_output=True, text=True, timeout=100)
    assert done.returncode == 0, done.stderr
    assert 0 < float(done.stdout) < 1.0


def test_adapters_are_chosen_by_name():
    names = ph.adapters()
    picture = ph.Spheres([[0, 0, 0]], 1.0).render(size=(8, 8))
    assert picture.adapter == (names[0] if names else None)
    with pytest.raises(ph.DeviceError):
        ph.use_adapter("an adapter that nobody has")
    if names:
        ph.use_adapter(names[-1][:8].upper())
        assert ph.Spheres([[0, 0, 0]], 1.0).render(size=(8, 8)).adapter == names[-1]
        ph.use_adapter()


def test_progress_is_told():
    parts = []
    ph.Spheres(cloud(2000), 0.1).render(size=(500, 400), samples=16, backend="cpu", progress=parts.append)
    assert parts == sorted(parts) and all(0 <= part <= 1 for part in parts)


FORK = """
import os, sys, warnings
import pinhole as ph
spheres = ph.Spheres([[0, 0, 0]], 1.0)
parent = spheres.render(size=(16, 12), backend="auto")
process = os.fork()
if process == 0:
    code = 1
    try:
        found = ph.Spheres([[0, 0, 0]], 1.0).render(size=(16, 12), backend="cpu")
        try:
            ph.Spheres([[0, 0, 0]], 1.0).render(size=(16, 12))
            code = 0 if parent.adapter is None else 2
        except ph.DeviceError as error:
            code = 0 if "forked" in str(error) else 3
    finally:
        os._exit(code)
_, status = os.waitpid(process, 0)
sys.exit(os.waitstatus_to_exitcode(status))
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")
def test_after_fork_the_cpu_renders_and_the_device_says_why_not():
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", FORK], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr


def test_many_renders_and_updates_leak_nothing():
    positions = cloud(100)
    spheres = ph.Spheres(positions, 0.1)
    def round_(count):
        for _ in range(count):
            spheres.update(positions=positions)
            spheres.render(size=(16, 12), style="fast")
    def held():
        with open("/proc/self/status") as status:
            memory = next(int(line.split()[1]) for line in status if line.startswith("VmRSS"))
        return memory, len(os.listdir("/proc/self/fd"))
    if not os.path.exists("/proc/self/status"):
        pytest.skip("this system has no /proc")
    round_(200)
    memory, files = held()
    round_(800)
    more_memory, more_files = held()
    assert more_files <= files + 2
    assert more_memory - memory < 30_000, "kilobytes"


@pytest.mark.filterwarnings("ignore::pinhole.Note")
def test_updates_give_the_picture_of_new_spheres():
    before, after = cloud(300, 1), cloud(300, 2)
    colors = np.random.default_rng(5).integers(0, 255, (300, 3), np.uint8)
    camera = ph.Camera.look_at((0, 0, 9), (0, 0, 0))
    keys = {"size": (64, 48), "samples": 2, "camera": camera}
    spheres = ph.Spheres(before.astype("f4"), 0.2, colors)
    spheres.render(**keys)
    spheres.update(positions=after.astype("f4"), radius=0.3, color=colors[::-1])
    wanted = ph.Spheres(after.astype("f4"), 0.3, colors[::-1])
    assert np.array_equal(spheres.render(**keys).rgb8, wanted.render(**keys).rgb8)
    with_columns = ph.Spheres(before, 0.2, columns={"a": np.arange(300)}, color_by={"column": "a"})
    with_columns.update(radius=0.3, first=299)
    with pytest.raises(ph.InputError, match="were updated"):
        with_columns.with_(color="red")
    with pytest.raises(ph.InputError, match="there is no sphere"):
        spheres.update(positions=after[:2], first=299)
    with pytest.raises(ph.InputError, match="sphere 7: its center"):
        spheres.update(positions=np.full((1, 3), np.nan), first=7)
    bonded = ph.Spheres([[0, 0, 0], [4, 0, 0]], 0.5, bonds={"length": 5.0})
    with pytest.raises(ph.InputError, match="these spheres have bonds, arrows or rules of show, which would not follow them"):
        bonded.update(positions=[[0, 0, 1], [0, 0, 2]])
    assert bonded.positions.shape == (2, 3) and bonded.radii.shape == (2,)


def test_panics_become_exceptions_without_a_message_on_the_terminal(capfd):
    assert _pinhole.panic_for_tests(0) == 1
    with pytest.raises(ph.InternalError, match="please report it: index out of bounds") as error:
        _pinhole.panic_for_tests(3)
    assert isinstance(error.value, RuntimeError)
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize("backend", ["auto", "cpu"])
def test_a_picture_that_does_not_fit_is_refused(backend):
    with pytest.raises(ph.Error, match="bytes of (host )?memory, but .* free; choose"):
        ph.Spheres([[0, 0, 0]], 1.0).render(size=(1_000_000, 1_000_000), backend=backend)


WITHOUT_DRIVER = """
import pinhole as ph
spheres = ph.Spheres([[0, 0, 0]], 1.0)
assert spheres.render(size=(16, 12)).adapter is None
for work in (lambda: spheres.render(size=(16, 12), backend="gpu"), spheres.verify):
    try:
        work()
    except ph.DeviceError as error:
        assert "no Vulkan, Metal or DX12 adapter was found" in str(error), error
    else:
        raise AssertionError
"""


@pytest.mark.skipif(sys.platform != "linux", reason="the variable is that of the Vulkan loader of Linux")
def test_without_a_driver_the_cpu_renders():
    without = {**os.environ, "VK_DRIVER_FILES": "/nonexistent", "VK_ICD_FILENAMES": "/nonexistent"}
    done = subprocess.run(
        [sys.executable, "-c", WITHOUT_DRIVER], env=without, capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0, done.stderr


def spawned(seed):
    """Renders in another process."""
    return ph.Spheres(cloud(50, seed), 0.1).render(size=(32, 24), samples=1).rgb8


def test_spawned_processes_render():
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        found = pool.map(spawned, [1, 2])
    for seed, picture in zip([1, 2], found):
        assert np.array_equal(picture, spawned(seed))
