"""Compares what pinhole reads of clouds of points with what laspy, plyfile and VTK wrote.

Every file is read by `examples/frames.rs`, and compared number by number.
"""

import itertools
import os
import subprocess
import sys
import tempfile

import laspy
import numpy as np
import vtk
from plyfile import PlyData, PlyElement
from vtk.util.numpy_support import numpy_to_vtk

N = 500
RANDOM = np.random.default_rng(1)
POSITIONS = RANDOM.normal(size=(N, 3)).astype("f4")
RADII = RANDOM.uniform(0.1, 2, N)
COLORS = RANDOM.integers(0, 256, (N, 3)).astype("u1")
CHARGES = RANDOM.integers(-9, 9, N).astype("i2")
FORCES = RANDOM.normal(size=(N, 3)) * 1e-9


def build():
    """Builds the program that prints what pinhole reads."""
    command = ["cargo", "build", "--quiet", "--example", "frames", "--no-default-features"]
    subprocess.run([*command, "--features", "all-formats,parallel"], check=True)
    target = os.environ.get("CARGO_TARGET_DIR", "target")
    return os.path.abspath(f"{target}/debug/examples/frames")


def compare(program, file, expected, what, guesses_radius=False):
    """Reads a file with pinhole, and ends this script at the first column that differs."""
    run = subprocess.run([program, file], capture_output=True, text=True, check=False)
    if run.returncode:
        sys.exit(f"{what}: {run.stderr}")
    lines = [line.split("\t") for line in run.stdout.splitlines()]
    names = next(line[1:] for line in lines if line[0] == "columns")
    rows = [line for line in lines if line[0] not in ("frame", "cell", "note", "columns")]
    if guesses_radius:
        expected = {**expected, "radius": np.array([row[names.index("radius")] for row in rows])}
    if sorted(names) != sorted(expected):
        sys.exit(f"{what}: the columns are {names}, not {sorted(expected)}")
    for index, name in enumerate(names):
        found = [row[index] for row in rows]
        if name == "color":
            same = found == expected[name]
        else:
            same = np.array_equal(np.array(found, float), np.asarray(expected[name], float))
        if not same:
            sys.exit(f"{what}: the column {name} differs: {found[:3]}, not {expected[name][:3]}")
    print(f"{what}: {len(rows)} points, {len(names)} columns")


def expected(**more):
    """The columns that every file has."""
    x, y, z = POSITIONS.T
    color = [f"#{r:02x}{g:02x}{b:02x}" for r, g, b in COLORS]
    return {"x": x, "y": y, "z": z, "radius": RADII, "color": color, **more}


def ply_files(program, folder):
    """Writes PLY files with plyfile, with and without a list in the vertices and faces after them."""
    fields = [("x", "f4"), ("y", "f4"), ("z", "f4"), ("charge", "i2"), ("radius", "f8")]
    fields += [(name, "u1") for name in ("red", "green", "blue")]
    columns = [*POSITIONS.T, CHARGES, RADII, *COLORS.T]
    for text, order, has_lists in itertools.product([True, False], "<>", [False, True]):
        # Beside a list, plyfile 1.1.5 writes other numbers in the machine's order, and cannot read them either.
        if has_lists and order == ">" and not text:
            continue
        vertices = np.empty(N, fields + ([("near", "O")] if has_lists else []))
        for (name, _), values in zip(fields, columns):
            vertices[name] = values
        elements = [PlyElement.describe(vertices, "vertex")]
        if has_lists:
            for index in range(N):
                vertices["near"][index] = np.arange(index % 4, dtype="i4")
            elements = [PlyElement.describe(vertices, "vertex", val_types={"near": "i4"})]
            faces = np.array([([0, 1, 2],), ([1, 2, 3],)], [("vertex_indices", "i4", (3,))])
            elements += [PlyElement.describe(faces, "face")]
        file = os.path.join(folder, "a.ply")
        PlyData(elements, text=text, byte_order=order).write(file)
        what = f"ply, {'text' if text else 'binary ' + order}, lists: {has_lists}"
        compare(program, file, expected(charge=CHARGES), what)


def vtk_files(program, folder):
    """Writes PolyData and UnstructuredGrid with VTK in every mode."""
    kinds = [
        ("vtp", vtk.vtkPolyData, vtk.vtkXMLPolyDataWriter),
        ("vtu", vtk.vtkUnstructuredGrid, vtk.vtkXMLUnstructuredGridWriter),
    ]
    modes = [("ascii", 0), ("binary", 0), ("appended base64", 0), ("appended raw", 0)]
    modes += [(mode, 1) for mode, _ in modes[1:]]
    wide = [("UInt32", vtk.vtkXMLWriter.UInt32), ("UInt64", vtk.vtkXMLWriter.UInt64)]
    orders = [("little", vtk.vtkXMLWriter.LittleEndian), ("big", vtk.vtkXMLWriter.BigEndian)]
    for (kind, data_type, writer_type), (mode, zlib), header, order in itertools.product(
        kinds, modes, wide, orders
    ):
        data = data_type()
        points = vtk.vtkPoints()
        points.SetData(numpy_to_vtk(POSITIONS, deep=True))
        data.SetPoints(points)
        arrays = {"radius": RADII, "tint": COLORS, "charge": CHARGES, "force": FORCES}
        for name, values in arrays.items():
            array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
            array.SetName(name)
            data.GetPointData().AddArray(array)
        writer = writer_type()
        writer.SetInputData(data)
        file = os.path.join(folder, f"a.{kind}")
        writer.SetFileName(file)
        writer.SetHeaderType(header[1])
        writer.SetByteOrder(order[1])
        # Small blocks, so that there are several.
        writer.SetBlockSize(1024)
        if zlib:
            writer.SetCompressorTypeToZLib()
        else:
            writer.SetCompressorTypeToNone()
        if mode == "ascii":
            writer.SetDataModeToAscii()
        elif mode == "binary":
            writer.SetDataModeToBinary()
        else:
            writer.SetDataModeToAppended()
            writer.SetEncodeAppendedData("base64" in mode)
        if not writer.Write():
            sys.exit(f"{file}: VTK cannot write it")
        x, y, z = FORCES.T
        columns = expected(charge=CHARGES, **{"force.x": x, "force.y": y, "force.z": z})
        what = f"{kind}, {mode}{', zlib' if zlib else ''}, {header[0]}, {order[0]}"
        compare(program, file, columns, what)


def las_files(program, folder):
    """Writes LAS files with laspy, in all versions and point formats that it writes."""
    for form, version in [(0, "1.2"), (1, "1.2"), (2, "1.2"), (3, "1.3"), (6, "1.4"), (7, "1.4"), (8, "1.4")]:
        header = laspy.LasHeader(point_format=form, version=version)
        header.scales, header.offsets = [0.001, 0.01, 0.1], [4e5, -7e6, 0]
        header.add_extra_dim(laspy.ExtraBytesParams(name="more", type="u2"))
        las = laspy.LasData(header)
        las.x, las.y, las.z = (POSITIONS * 100 + [4e5, -7e6, 0]).T
        las.intensity = RANDOM.integers(0, 65536, N)
        las.return_number = RANDOM.integers(1, 4, N)
        las.number_of_returns = RANDOM.integers(4, 7, N)
        las.classification = RANDOM.integers(0, 32, N)
        names = ["x", "y", "z", "intensity", "return_number", "number_of_returns", "classification"]
        columns = {}
        if form not in (0, 2):
            las.gps_time = RANDOM.normal(size=N)
            names.append("gps_time")
        if form in (2, 3, 7, 8):
            las.red, las.green, las.blue = COLORS.T.astype("u2") * 257
            columns["color"] = expected()["color"]
        file = os.path.join(folder, "a.las")
        las.write(file)
        las = laspy.read(file)
        columns |= {name: np.array(las[name]) for name in names}
        compare(program, file, columns, f"las {version}, point format {form}", guesses_radius=True)


def main():
    """Compares all files."""
    program = build()
    with tempfile.TemporaryDirectory() as folder:
        las_files(program, folder)
        ply_files(program, folder)
        vtk_files(program, folder)
    print("all agree")


main()
