"""Compares what pinhole reads of binary files with what the programs and libraries say that wrote them.

Every file is written here by gsd, MDAnalysis or NumPy, read by `examples/frames.rs`, and compared number by number.
"""

import os
import subprocess
import sys
import tempfile
import warnings

import gsd.hoomd
import MDAnalysis
import numpy as np
from MDAnalysis.lib.mdamath import triclinic_vectors

warnings.filterwarnings("ignore")
N = 200
CELL = [30, 40, 50, 80, 95, 100]


def build():
    """Builds the program that prints what pinhole reads."""
    command = ["cargo", "build", "--quiet", "--example", "frames", "--no-default-features"]
    subprocess.run([*command, "--features", "all-formats,parallel"], check=True)
    target = os.environ.get("CARGO_TARGET_DIR", "target")
    os.environ["FRAMES"] = os.path.abspath(f"{target}/debug/examples/frames")


def read(file, *topology):
    """Returns the frames of a file: for each, its columns by name, its cell and its notes."""
    command = [os.environ["FRAMES"], file, *topology]
    text = subprocess.run(command, capture_output=True, text=True, check=False)
    if text.returncode:
        sys.exit(f"{file}: {text.stderr}")
    frames = []
    for line in text.stdout.splitlines():
        fields = line.split("\t")
        match fields[0]:
            case "frame":
                frames.append({"cell": [], "notes": [], "rows": []})
            case "cell":
                frames[-1]["cell"].append([float(value) for value in fields[1:]])
            case "note":
                frames[-1]["notes"].append(fields[1])
            case "columns":
                frames[-1]["names"] = fields[1:]
            case "problem":
                sys.exit(f"{file}: {line}")
            case _:
                frames[-1]["rows"].append(fields)
    for frame in frames:
        for index, name in enumerate(frame["names"]):
            values = [row[index] for row in frame["rows"]]
            try:
                frame[name] = np.array(values, float)
            except ValueError:
                frame[name] = values
    return frames


def vectors(frame, name):
    names = ["x", "y", "z"] if name == "positions" else [f"{name}.{axis}" for axis in "xyz"]
    return np.stack([frame[part] for part in names], axis=1)


def same(what, found, expected, most=1e-6):
    found, expected = np.asarray(found, float), np.asarray(expected, float)
    if found.shape != expected.shape:
        sys.exit(f"{what}: shape {found.shape} instead of {expected.shape}")
    difference = np.abs(found - expected).max(initial=0) / max(np.abs(expected).max(initial=0), 1e-30)
    print(f"{what}: {difference:.1e}")
    if not difference <= most:
        sys.exit(f"{what} differs")


def universe():
    atoms = MDAnalysis.Universe.empty(N, trajectory=True, velocities=True, forces=True)
    elements = ["O", "H", "C", "N"] * (N // 4)
    for name, values in [
        ("names", elements),
        ("elements", elements),
        ("resnames", ["WAT"]),
        ("resids", [1]),
        ("chainIDs", ["A"] * N),
    ]:
        atoms.add_TopologyAttr(name, values)
    return atoms


def place(atoms, frame, count=N):
    random = np.random.default_rng(frame)
    atoms.atoms.positions = random.normal(size=(count, 3)) * 8
    atoms.atoms.velocities = random.normal(size=(count, 3))
    atoms.atoms.forces = random.normal(size=(count, 3))
    atoms.dimensions = CELL
    atoms.trajectory.ts.frame, atoms.trajectory.ts.time = frame, float(frame)


def of_mdanalysis():
    atoms = universe()
    place(atoms, 0)
    atoms.atoms.write("top.pdb")
    radii = {"O": 1.5, "H": 1.2, "C": 1.77, "N": 1.66}
    for extension in ["dcd", "trr", "xtc"]:
        file = f"t.{extension}"
        with MDAnalysis.Writer(file, N) as writer:
            for frame in range(5):
                place(atoms, frame)
                writer.write(atoms.atoms)
        expected = MDAnalysis.Universe("top.pdb", file)
        frames = read(file, "top.pdb")
        assert len(frames) == len(expected.trajectory)
        for frame, step in zip(frames, expected.trajectory):
            what = f"{file} frame {step.frame}"
            same(f"{what} positions", vectors(frame, "positions"), step.positions)
            same(f"{what} cell", frame["cell"], triclinic_vectors(step.dimensions), 1e-5)
            assert frame["species"] == list(expected.atoms.elements)
            same(f"{what} radii", frame["radius"], [radii[name] for name in frame["species"]])
            if extension == "trr":
                same(f"{what} velocities", vectors(frame, "velocity"), step.velocities)
                same(f"{what} forces", vectors(frame, "force"), step.forces)


def of_few_atoms():
    """Up to nine atoms are not compressed."""
    few = MDAnalysis.Merge(universe().atoms[:7])
    few.load_new(np.random.default_rng(9).normal(size=(2, 7, 3)) * 5)
    few.atoms.write("few.pdb")
    few.atoms.write("few.xtc", frames="all")
    for frame, step in zip(read("few.xtc", "few.pdb"), MDAnalysis.Universe("few.pdb", "few.xtc").trajectory):
        same(f"few.xtc frame {step.frame}", vectors(frame, "positions"), step.positions)


def of_water():
    """Molecules in large boxes: runs of small differences, numbers of up to 72 bits, and ranges beyond 24 bits."""
    for file, size in [("water.xtc", 100), ("wide.xtc", 100_000), ("far.xtc", 300_000)]:
        count = 3 * 4000
        random = np.random.default_rng(7)
        oxygen = random.uniform(0, size, (count // 3, 1, 3))
        positions = (oxygen + random.normal(size=(count // 3, 3, 3)) * 0.6).reshape(1, -1, 3)
        atoms = MDAnalysis.Universe.empty(count, trajectory=True)
        atoms.add_TopologyAttr("names", ["O", "H", "H"] * (count // 3))
        atoms.add_TopologyAttr("elements", ["O", "H", "H"] * (count // 3))
        atoms.load_new(positions)
        with open("water.xyz", "w") as out:
            out.write(f"{count}\n\n" + "O 0 0 0\nH 0 0 0\nH 0 0 0\n" * (count // 3))
        atoms.atoms.write(file)
        expected = MDAnalysis.Universe(file, file, topology_format="MINIMAL").trajectory[0].positions
        same(file, vectors(read(file, "water.xyz")[0], "positions"), expected)


def of_gsd():
    for name, types in [("beads.gsd", ["A", "B", "poly"]), ("atoms.gsd", ["O", "H", "Na"])]:
        with gsd.hoomd.open(name, "w") as file:
            for index in range(5):
                random = np.random.default_rng(index)
                frame = gsd.hoomd.Frame()
                frame.configuration.step = index * 10
                frame.configuration.box = [30, 40, 50, 0.1, 0.2, 0.3]
                # The number of particles may change.
                count = N if index != 3 else N - 7
                particles = frame.particles
                particles.N = count
                particles.position = (random.normal(size=(count, 3)) * 8).astype("f4")
                particles.velocity = random.normal(size=(count, 3))
                particles.image = random.integers(-2, 3, (count, 3))
                if index == 0:
                    particles.types = types
                    particles.typeid = random.integers(0, 3, count)
                    particles.diameter = random.uniform(0.5, 2, count)
                    particles.mass = random.uniform(1, 2, count)
                if index > 1:
                    particles.orientation = random.normal(size=(count, 4))
                frame.bonds.N = 2
                frame.bonds.types = ["b"]
                frame.bonds.group = [[0, 1], [1, 2]]
                frame.log["particles/energy"] = random.normal(size=count)
                frame.log["particles/md/net_force"] = random.normal(size=(count, 3))
                frame.log["value"] = np.array([1.0 * index])
                file.append(frame)
        frames = read(name)
        with gsd.hoomd.open(name, "r") as file:
            assert len(frames) == len(file)
            for index, (found, frame) in enumerate(zip(frames, file)):
                what, particles = f"{name} frame {index}", frame.particles
                same(f"{what} positions", vectors(found, "positions"), particles.position)
                same(f"{what} velocities", vectors(found, "velocity"), particles.velocity)
                same(f"{what} images", vectors(found, "image"), particles.image)
                kinds = [particles.types[kind] for kind in particles.typeid]
                assert found["species"] == kinds, what
                same(f"{what} radii", found["radius"], particles.diameter / 2)
                if index != 3:
                    same(f"{what} masses", found["mass"], particles.mass)
                lx, ly, lz, xy, xz, yz = frame.configuration.box
                cell = [[lx, 0, 0], [xy * ly, ly, 0], [xz * lz, yz * lz, lz]]
                same(f"{what} cell", found["cell"], cell)
                same(f"{what} energies", found["energy"], frame.log["particles/energy"])
                same(f"{what} forces", vectors(found, "net_force"), frame.log["particles/md/net_force"])
                assert any("bonds" in note for note in found["notes"])


def of_arrays():
    random = np.random.default_rng(5)
    positions = random.normal(size=(N, 3))
    radii, energy = random.uniform(0.5, 1, N), random.normal(size=N)
    colors = random.integers(0, 256, (N, 3), dtype=np.uint8)
    hexes = [f"#{r:02x}{g:02x}{b:02x}" for r, g, b in colors]
    kinds = np.array(["O", "H", "Na", "C"] * (N // 4))
    spheres = np.column_stack([positions, radii])
    for dtype in ["<f4", ">f8", "<f2", "<i2", ">i8"]:
        for order in "CF":
            numbers = np.asarray(np.abs(spheres) * 90 + 1, dtype, order=order)
            np.save("a.npy", numbers)
            (found,) = read("a.npy")
            what = f"{dtype} {order}"
            same(f"{what} positions", vectors(found, "positions"), numbers[:, :3])
            same(f"{what} radii", found["radius"], numbers[:, 3])
    np.save("a.npy", np.column_stack([spheres, energy]).astype("f4"))
    same("a value", read("a.npy")[0]["value"], energy)
    np.save("a.npy", np.column_stack([spheres, colors]))
    assert read("a.npy")[0]["color"] == hexes
    fields = [("id", "u8"), ("pos", "f4", (3,)), ("radius", "f8"), ("rgb", "u1", (3,)), ("kind", "U2"), ("c", "c8")]
    table = np.zeros(N, np.dtype(fields, align=True))
    table["id"], table["pos"], table["radius"] = np.arange(N), positions, radii
    table["rgb"], table["kind"] = colors, kinds
    np.save("a.npy", table)
    (found,) = read("a.npy")
    same("fields positions", vectors(found, "positions"), positions)
    same("fields radii", found["radius"], radii)
    same("fields id", found["id"], np.arange(N))
    assert found["color"] == hexes and found["kind"] == list(kinds)
    assert any(note.endswith(": c") for note in found["notes"])
    for save in [np.savez, np.savez_compressed]:
        save("a.npz", positions=positions, radii=radii, colors=colors, energy=energy, kind=kinds, box=np.eye(3))
        (found,) = read("a.npz")
        same("archive positions", vectors(found, "positions"), positions)
        same("archive radii", found["radius"], radii)
        same("archive energy", found["energy"], energy)
        assert found["color"] == hexes and found["kind"] == list(kinds)
        assert any("`box` has the shape (3, 3)" in note for note in found["notes"])


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        build()
        os.chdir(folder)
        of_mdanalysis()
        of_few_atoms()
        of_water()
        of_gsd()
        of_arrays()
    print("all agree")
