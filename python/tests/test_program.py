"""The package and the program make the same pictures, byte for byte."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import cloud

import pinhole as ph


def test_an_array_with_the_default_look(program, tmp_path):
    positions = cloud(400).astype("f4")
    np.save(tmp_path / "p.npy", positions)
    wanted = program("p.npy", "--size", "160x120")
    with pytest.warns(ph.Note, match="there are no radii"):
        spheres = ph.Spheres(positions)
    assert spheres.render(size=(160, 120))._repr_png_() == wanted


def test_radii_and_settings_of_a_studio(program, tmp_path):
    spheres = np.concatenate([cloud(300) * 5 + 1e6, np.linspace(0.1, 0.5, 300)[:, None]], axis=1)
    np.save(tmp_path / "p.npy", spheres)
    flags = ["--size", "120x90", "--view", "iso", "--fov", "20", "--samples", "3", "--background", "navy"]
    wanted = program("p.npy", *flags, "--color", "tomato")
    made = ph.Spheres(spheres[:, :3], spheres[:, 3], "tomato")
    picture = made.render(
        (120, 90), samples=3, background="navy", camera=ph.Camera.frame("iso", fov=20)
    )
    assert picture._repr_png_() == wanted


def test_a_scene_file_with_paths_and_metal(program, tmp_path):
    positions = cloud(100)
    np.save(tmp_path / "p.npy", positions)
    spheres = ph.Spheres(positions, 0.2, material={"kind": "conductor", "roughness": 0.1}, color="gold")
    spheres.camera = ph.Camera.look_at((3, 2, 9), (0, 0, 0), fov=35)
    settings = {"size": (96, 72), "samples": 4, "style": "path", "ground": {}, "exposure": 0.5}
    text = spheres.scene_file(**settings).replace('data = "spheres"', 'data = "p.npy"\nradius = 0.2')
    (tmp_path / "s.toml").write_text(text)
    wanted = program("s.toml")
    assert spheres.render(**settings)._repr_png_() == wanted


@pytest.mark.filterwarnings("ignore::pinhole.Note")
def test_numbers_with_a_legend(program, tmp_path):
    positions, energy = cloud(200), np.linspace(-1, 1, 200)
    np.savez(tmp_path / "p.npz", positions=positions, energy=energy)
    flags = ["--radius", "0.15", "--color-by", "energy", "--cmap", "plasma", "--legend", "--size", "200x150"]
    wanted = program("p.npz", *flags)
    spheres = ph.Spheres(positions, 0.15, columns={"energy": energy}, color_by="energy", cmap="plasma")
    assert spheres.render((200, 150), legend={})._repr_png_() == wanted


def test_one_ray_for_each_pixel_and_layers(program, tmp_path):
    positions = cloud(300).astype("f4")
    np.save(tmp_path / "p.npy", positions)
    flags = ["--radius", "0.1", "--style", "fast", "--layer", "depth=d.npy", "--size", "100x100"]
    wanted = program("p.npy", *flags)
    picture = ph.Spheres(positions, 0.1).render((100, 100), style="fast", layers=["depth"])
    assert picture._repr_png_() == wanted
    picture.save(tmp_path / "own.npy", layer="depth")
    assert (tmp_path / "own.npy").read_bytes() == (tmp_path / "d.npy").read_bytes()


@pytest.mark.filterwarnings("ignore::pinhole.Note")
def test_movies_and_turntables(program, tmp_path):
    rod = np.stack([np.linspace(0, 9, 40), np.zeros(40), np.sin(np.arange(40.0))], axis=1).astype("f4")
    np.save(tmp_path / "rod.npy", rod)
    frames = ["40\nframe\n" + "".join(f"C {x * part} {y} {z}\n" for x, y, z in rod) for part in (0.3, 1.0, 0.6)]
    (tmp_path / "t.xyz").write_text("".join(frames))
    for style in ("fast", "default"):
        flags = ["--size", "96x72", "--style", style, "--backend", "cpu"]
        settings = {"size": (96, 72), "style": style, "backend": "cpu"}
        program("t.xyz", *flags, "--kind", "plain", "--frames", ":", output=f"{style}-p%d.png")
        ph.read(tmp_path / "t.xyz").movie(tmp_path / f"{style}-m%d.png", **settings)
        program("rod.npy", *flags, "--radius", "0.3", "--turntable", "3", output=f"{style}-q%d.png")
        ph.Spheres(rod, 0.3).turntable(tmp_path / f"{style}-t%d.png", frames=3, **settings)
        # The program chooses the light of a turntable for the body that the spheres sweep.
        for one, other in ("pm", "qt") if style == "fast" else ("pm",):
            for number in range(3):
                wanted, made = (tmp_path / f"{style}-{kind}{number}.png" for kind in (one, other))
                assert made.read_bytes() == wanted.read_bytes(), made.name
