"""Rendering on the workers of a cluster: what is asked of Dask, and what the program makes of it."""

from __future__ import annotations

import os
from typing import Any

import pytest
from conftest import PROGRAM

import pinhole as ph
from pinhole import farm

FRAMES = "".join(f"2\nframe\nO {frame} 0 0\nH 1 {frame} 0\n" for frame in range(4))
FLAGS = {"backend": "cpu", "size": "40x30", "samples": 2}


class Here:
    """A client whose only worker is this process, and which notes what is asked of it."""

    def __init__(self, versions: tuple[str, str] | None = None) -> None:
        self.tasks: list[tuple[Any, ...]] = []
        self.versions = versions
        self.retries: set[int] = set()

    def run(self, function: Any) -> dict[str, Any]:
        return {"tcp://here": self.versions or function()}

    def submit(self, function: Any, *arguments: Any, retries: int, pure: bool) -> Any:
        assert not pure
        self.retries.add(retries)
        self.tasks.append(arguments)
        return function(*arguments)

    def gather(self, tasks: list[Any]) -> list[Any]:
        return tasks


@pytest.fixture
def folder(tmp_path: Any, monkeypatch: Any) -> Any:
    if PROGRAM is None:
        pytest.skip("PINHOLE_PROGRAM does not name the program")
    (tmp_path / "a.xyz").write_text(FRAMES)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_frames_are_those_of_the_program(folder):
    client = Here()
    farm.render("a.xyz", "f%d.png", client=client, tiles=(2, 2), units_per_task=5, layers={"depth": "d%d.npy"}, **FLAGS)
    assert [task[1] for task in client.tasks] == ["0,1,2,3,4", "5,6,7,8,9", "10,11,12,13,14", "15"]
    assert client.retries == {3}
    flags = ["--frames", ":", "--backend", "cpu", "--size", "40x30", "--samples", "2"]
    os.mkdir("w")
    done = farm._run("render", "a.xyz", *flags, "--layer", "depth=w/d%d.npy", "-o", "w/f%d.png", "-q")
    assert done == ""
    for name in sorted(os.listdir("w")):
        assert (folder / name).read_bytes() == (folder / "w" / name).read_bytes(), name
    # Nothing is left beside the pictures.
    assert sorted(os.listdir()) == sorted(["a.xyz", "w", *os.listdir("w")])


def test_a_named_folder_is_kept_and_not_rendered_again(folder):
    for count in (4, 0):
        client = Here()
        farm.movie("m.apng", "a.xyz", client=client, folder="job", fps=12, **FLAGS)
        assert len(client.tasks) == count
    os.remove("job/parts/000002.part")
    client = Here()
    farm.movie("m.apng", "a.xyz", client=client, folder="job", **FLAGS)
    assert [task[1] for task in client.tasks] == ["2"]


def test_errors_are_exceptions_with_one_line(folder):
    for call, kind, words in [
        (lambda: farm.render("none.xyz", client=Here()), ph.FileError, "there is no such file"),
        (lambda: farm.render("a.xyz", client="x"), ph.InputError, "give a dask.distributed.Client"),
        (lambda: farm.render("a.xyz", client=Here(), tiles=(0, 1)), ph.InputError, "write columns and rows"),
        (lambda: farm.render("a.xyz", client=Here(), sample=3), ph.InputError, "--sample"),
        (lambda: farm.render("a.xyz", client=Here(("9.9", "9.9"))), ph.Error, "tcp://here has the package 9.9"),
        (lambda: farm._part("job", "0", "9.9"), ph.Error, "the job is of 9.9"),
    ]:
        with pytest.raises(kind, match=words) as raised:
            call()
        assert "\n" not in str(raised.value)
        assert os.listdir() == ["a.xyz"]


def test_a_real_cluster(folder):
    distributed = pytest.importorskip("distributed", reason="Dask is missing: pip install 'dask[distributed]'")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:
            farm.render("a.xyz", "f%d.png", client=client, tiles=(2, 1), **FLAGS)
    assert sorted(os.listdir()) == ["a.xyz", "f0.png", "f1.png", "f2.png", "f3.png"]
