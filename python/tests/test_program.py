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
        program("t.xyz", *flags, "--frames", ":", output=f"{style}-p%d.png")
        ph.read(tmp_path / "t.xyz").movie(tmp_path / f"{style}-m%d.png", **settings)
        program("rod.npy", *flags, "--radius", "0.3", "--turntable", "3", output=f"{style}-q%d.png")
        ph.Spheres(rod, 0.3).turntable(tmp_path / f"{style}-t%d.png", frames=3, **settings)
        # The program chooses the light of a turntable for the body that the spheres sweep.
        for one, other in ("pm", "qt") if style == "fast" else ("pm",):
            for number in range(3):
                wanted, made = (tmp_path / f"{style}-{kind}{number}.png" for kind in (one, other))
                assert made.read_bytes() == wanted.read_bytes(), made.name


def cubic(side, height, rows):
    atoms = "".join(f"{species} {x} {y} {z}\n" for species, x, y, z in rows)
    properties = "Properties=species:S:1:pos:R:3"
    return f'{len(rows)}\nLattice="{side} 0 0 0 {side} 0 0 0 {height}" {properties}\n{atoms}'


SALT = [("Na" if (i + j + k) % 2 else "Cl", 2.8 * i, 2.8 * j, 2.8 * k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]
ETHANE = [("C", 0, 0, 0.76), ("C", 0, 0, -0.76), ("H", 1, 0, 1.16), ("H", -0.5, 0.9, 1.16), ("H", -0.5, -0.9, 1.16)]


def protein():
    rows = [(f"ATOM  {i:5}  {name:<3} ALA {chain}{i // 2:4}", 1.2 * i, i % 3, i % 2) for i in range(1, 13)
            for name, chain in [("CA" if i % 2 else "C", "A" if i < 7 else "B")]]
    rows.append(("HETATM   20  O   HOH A  90", 5, 9, 9))
    rows.append(("HETATM   21 FE   HEM A  91", 9, 5, 5))
    return "".join(f"{head}    {x:8.3f}{y:8.3f}{z:8.3f}  1.00  0.00\n" for head, x, y, z in rows)


@pytest.mark.filterwarnings("ignore::pinhole.Note")
@pytest.mark.parametrize(
    ("name", "text", "kind"),
    [
        ("salt.xyz", cubic(5.6, 5.6, SALT), "crystal"),
        ("slab.xyz", cubic(5.6, 25.6, SALT), "slab"),
        ("ethane.xyz", "5\n\n" + "".join(f"{s} {x} {y} {z}\n" for s, x, y, z in ETHANE), "molecules"),
        ("liquid.xyz", cubic(12, 12, [("Ar", 4 * i, 4 * j, 4 * k) for i in range(3) for j in range(3) for k in range(3)]), "liquid"),
        ("beads.xyz", "9\n\n" + "".join(f"{'AB'[i % 2]} {i} {i * i % 5} {i % 3}\n" for i in range(9)), "particles"),
        ("protein.pdb", protein(), "biomolecule"),
        ("far.csv", "x,y,z\n" + "".join(f"{i % 9},{i // 9 % 9},{i // 81}\n" for i in range(1458)) + "900,0,0\n", "plain"),
    ],
)
def test_kinds_of_data(program, tmp_path, name, text, kind):
    (tmp_path / name).write_text(text)
    read = ph.read(tmp_path / name)
    assert read.kind == kind
    looks = [
        ((), None),
        (("--view", "front"), "front"),
        (("--turn", "20"), ph.Camera.frame(turn=20)),
        (("--zoom", "1.5"), ph.Camera.frame(zoom=1.5)),
        (("--fov", "25"), ph.Camera.frame(fov=25)),
        (("--camera", "orthographic"), ph.Camera("orthographic")),
        (("--up", "1,0,0"), ph.Camera.frame(up=(1, 0, 0))),
    ]
    for flags, camera in looks:
        wanted = program(name, "--size", "64x48", "--style", "fast", *flags)
        assert read.render((64, 48), style="fast", camera=camera)._repr_png_() == wanted, (flags, camera)
    plain = program(name, "--size", "64x48", "--style", "fast", "--kind", "plain")
    assert ph.read(tmp_path / name, kind="plain").render((64, 48), style="fast")._repr_png_() == plain
    scene = read.scene_file(size=(64, 48), style="fast").replace('data = "spheres"', f'data = "{name}"')
    (tmp_path / "s.toml").write_text(scene)
    assert program("s.toml") == read.render((64, 48), style="fast")._repr_png_()


@pytest.mark.filterwarnings("ignore::pinhole.Note")
def test_scans_and_stars_have_styles_of_their_own(program, tmp_path):
    scan = "x,y,z,r,g,b\n" + "".join(f"{i % 40},{i // 40},{i % 7},{i % 250},90,9\n" for i in range(1600))
    stars = "x,y,z\n" + "".join(f"{i % 31 if i % 100 else i},{i * i % 37},{i % 41}\n" for i in range(20000))
    for name, text, kind in [("scan.csv", scan, "scan"), ("stars.csv", stars, "stars")]:
        (tmp_path / name).write_text(text)
        read = ph.read(tmp_path / name)
        assert read.kind == kind
        size = ("--size", "64x48", "--backend", "cpu")
        usual = read.render((64, 48), backend="cpu")._repr_png_()
        assert usual == program(name, *size)
        for flags, settings in [(("--style", "default"), {"style": "default"}), (("--background", "red"), {"background": "red"})]:
            other = read.render((64, 48), backend="cpu", **settings)._repr_png_()
            assert other == program(name, *size, *flags) and other != usual


@pytest.mark.filterwarnings("ignore::pinhole.Note")
def test_arrays_of_atoms_are_drawn_like_their_file(program, tmp_path):
    (tmp_path / "salt.xyz").write_text(cubic(5.6, 5.6, SALT))
    elements, *places = zip(*SALT, strict=True)
    spheres = ph.Spheres(np.transpose(places), columns={"element": elements}, cell=[5.6] * 3)
    wanted = program("salt.xyz", "--size", "64x48", "--style", "fast")
    assert spheres.render((64, 48), style="fast")._repr_png_() == wanted
    wanted = program("salt.xyz", "--size", "64x48", "--style", "fast", "--bonds", "--box", "--radius-scale", "0.4")
    made = spheres.with_(bonds=True, box=True, radius_scale=0.4).render((64, 48), style="fast")
    assert made._repr_png_() == wanted
