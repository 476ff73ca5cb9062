"""Files and trajectories, certificates and movies."""

from __future__ import annotations

import shutil

import numpy as np
import pytest
from conftest import cloud

import pinhole as ph

WATER = "3\nwater\nO 0 0 0.1\nH 0.76 0 -0.5\nH -0.76 0 -0.5\n"


def frames(count):
    """An extended XYZ trajectory, in which one atom moves."""
    head = 'Lattice="4 0 0 0 4 0 0 0 4" Properties=species:S:1:pos:R:3:energy:R:1'
    return "".join(f"2\n{head}\nC 0 0 0 1.5\nN {frame} 1 0 -1\n" for frame in range(count))


def test_a_file_with_one_frame(tmp_path):
    (tmp_path / "water.xyz").write_text(WATER)
    water = ph.read(tmp_path / "water.xyz")
    assert isinstance(water, ph.Spheres) and len(water) == 3
    assert water["species"].tolist() == ["O", "H", "H"]
    assert np.allclose(water.positions[1], [0.76, 0, -0.5])
    assert len(ph.read(tmp_path / "water.xyz", select="species == H")) == 2
    assert len(ph.read(tmp_path / "water.xyz").with_(leave_out={"species": ["O"]})) == 2
    with pytest.raises(ph.InputError, match="there is no column `x2`; did you mean `x`. the columns are"):
        water["x2"]
    assert water.render(size=(16, 12), backend="cpu").size == (16, 12)


def test_a_trajectory_is_a_sequence(tmp_path):
    (tmp_path / "t.extxyz").write_text(frames(10))
    trajectory = ph.read(tmp_path / "t.extxyz")
    assert repr(trajectory) == "<pinhole.Trajectory: 10 frames>"
    part = trajectory[2::3]
    assert len(part) == 3
    assert [frame.positions[1, 0] for frame in part] == [2, 5, 8]
    assert part[-1].positions[1, 0] == 8 and part[::-1][0].positions[1, 0] == 8
    assert trajectory[0]["energy"].tolist() == [1.5, -1] and trajectory[0]["energy"].dtype == float
    assert trajectory[0].cell.tolist() == [[4, 0, 0], [0, 4, 0], [0, 0, 4]]
    assert ph.read(tmp_path / "t.extxyz", frame=4).positions[1, 0] == 4
    with pytest.raises(IndexError, match="there is no frame 10"):
        trajectory[10]
    with pytest.raises(ph.InputError, match="there is no frame 10; the file has 10"):
        ph.read(tmp_path / "t.extxyz", frame=10)


@pytest.mark.filterwarnings("ignore::pinhole.Note")
def test_several_files_are_a_trajectory(tmp_path):
    for number in (9, 10, 100):
        (tmp_path / f"a{number}.xyz").write_text(WATER.replace("0.76", str(number)))
    for path, numbers in [("a*.xyz", (9, 10, 100)), ("a{9,100}.xyz", (9, 100))]:
        assert [frame.positions[1][0] for frame in ph.read(tmp_path / path)] == list(numbers)
    paths = [tmp_path / f"a{number}.xyz" for number in (100, 10)]
    assert [frame.positions[1][0] for frame in ph.read(paths)] == [10, 100]
    assert ph.read(tmp_path / "a*.xyz", frame=-1).positions[1][0] == 100
    assert len(ph.read(paths[:1])) == 3
    with pytest.raises(ph.Error, match="b.xyz"):
        ph.read([*paths, tmp_path / "b.xyz"])
    with pytest.raises(ph.InputError, match="cannot have commas or braces"):
        ph.read([*paths, tmp_path / "b,c.xyz"])
    with pytest.raises(ph.Error, match="a number in the place of the"):
        ph.read(tmp_path / "b*.xyz")
    with pytest.raises(ph.InputError, match="there is no frame -4"):
        ph.read(tmp_path / "a*.xyz", frame=-4)


def test_other_files_are_put_together(program, tmp_path):
    (tmp_path / "water.xyz").write_text(WATER)
    (tmp_path / "points.csv").write_text("x,y,z,radius\n9,0,0,1\n")
    both = ph.read([tmp_path / "water.xyz", tmp_path / "points.csv"])
    assert {"file", "species"} <= {*both.columns}
    assert both.positions[-1][0] == 9
    wanted = program("water.xyz", "points.csv", "--size", "80x60")
    assert both.render((80, 60))._repr_png_() == wanted


def test_the_program_sees_the_same_file(program, tmp_path):
    (tmp_path / "t.extxyz").write_text(frames(3))
    wanted = program("t.extxyz", "--frame", "1", "--bonds", "--box", "--size", "80x60")
    spheres = ph.read(tmp_path / "t.extxyz", frame=1, bonds=True, box=True)
    assert spheres.render((80, 60))._repr_png_() == wanted


@pytest.mark.filterwarnings("ignore:.*no radii")
def test_kinds_have_colors(program, tmp_path):
    rows = "".join(f"{x},0,0,{kind}\n" for x, kind in enumerate("abab"))
    (tmp_path / "p.csv").write_text("x,y,z,type\n" + rows)
    wanted = program("p.csv", "--size", "80x60")
    with pytest.warns(ph.Note, match="colored by type"):
        spheres = ph.read(tmp_path / "p.csv")
    assert spheres.render((80, 60))._repr_png_() == wanted


def test_files_that_are_refused(tmp_path):
    with pytest.raises(ph.FileError, match="none.xyz: cannot be read: No such file") as error:
        ph.read(tmp_path / "none.xyz")
    assert isinstance(error.value, OSError)
    (tmp_path / "a.txt").write_text("something else")
    with pytest.raises(ph.InputError, match="shows its format"):
        ph.read(tmp_path / "a.txt")
    (tmp_path / "b.xyz").write_text("2\n\nC 0 0 x\nC 0 0 0\n")
    with pytest.raises(ph.InputError, match="b.xyz: line 3"):
        ph.read(tmp_path / "b.xyz")
    (tmp_path / "w.xyz").write_text(WATER)
    with pytest.raises(ph.InputError, match="format is \"word\"; the formats are"):
        ph.read(tmp_path / "w.xyz", format="word")
    with pytest.raises(ph.InputError, match="radius"):
        ph.read(tmp_path / "w.xyz", radius=-1)
    with pytest.raises(ph.InputError, match="topology"):
        ph.read(tmp_path / "w.xyz", topology="a.pdb")


def test_a_certificate():
    spheres = ph.Spheres(cloud(200), 0.2)
    try:
        certificate = spheres.verify((64, 48))
    except ph.DeviceError as error:
        pytest.skip(str(error))
    assert certificate.is_legal and bool(certificate) and certificate.violations == []
    assert sum(certificate.counts.values()) == 64 * 48 == certificate.verdicts.size
    assert certificate.counts["violation"] == 0
    assert "legal" in repr(certificate) and "worst depth" in str(certificate)


def test_numbered_pictures_of_a_turntable(tmp_path):
    spheres = ph.Spheres(cloud(50), 0.2, "tomato")
    spheres.turntable(tmp_path / "f%02d.png", frames=4, size=(32, 24), samples=1, backend="cpu")
    files = sorted(tmp_path.iterdir())
    assert [file.name for file in files] == ["f00.png", "f01.png", "f02.png", "f03.png"]
    assert len({file.read_bytes() for file in files}) == 4


def colors_of(picture):
    """The different colours of an image, or of a PNG file."""
    if not isinstance(picture, ph.Image):
        picture = pytest.importorskip("PIL.Image", reason="Pillow, which reads PNG files, is missing").open(picture)
    return {*map(tuple, np.asarray(picture).reshape(-1, 3).tolist())}


@pytest.mark.filterwarnings("ignore::pinhole.Note")
def test_equal_values_have_equal_colors_in_all_frames(tmp_path):
    rows = [(0, 1), (5, 10)]
    text = "".join(
        "2\nProperties=species:S:1:pos:R:3:charge:R:1\n" + "".join(f"C {3 * i} 0 0 {value + 0.5}\n" for i, value in enumerate(row))
        for row in rows
    )
    (tmp_path / "t.extxyz").write_text(text)
    settings = {"size": (60, 20), "style": "fast", "shading": "flat", "backend": "cpu", "camera": "z"}
    ph.read(tmp_path / "t.extxyz", color_by="charge").movie(tmp_path / "f%d.png", **settings)
    fixed = ph.read(tmp_path / "t.extxyz", color_by={"column": "charge", "range": (0.5, 10.5)})
    for number, frame in enumerate(fixed):
        assert colors_of(tmp_path / f"f{number}.png") == colors_of(frame.render(**settings))
    # Alone, each frame has the range of its own values.
    alone = ph.read(tmp_path / "t.extxyz", color_by="charge")[0].render(**settings)
    assert colors_of(tmp_path / "f0.png") != colors_of(alone)


@pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="ffmpeg is missing")
def test_a_movie_of_a_trajectory(tmp_path):
    (tmp_path / "t.extxyz").write_text(frames(5))
    ph.read(tmp_path / "t.extxyz").movie(tmp_path / "a.mp4", size=(64, 48), samples=1)
    assert (tmp_path / "a.mp4").stat().st_size > 500
    assert sorted(file.name for file in tmp_path.iterdir()) == ["a.mp4", "t.extxyz"]


def test_movies_that_are_refused(tmp_path):
    with pytest.raises(ph.InputError, match="a movie is written as .mp4"):
        ph.movie(tmp_path / "a.avi", [])
