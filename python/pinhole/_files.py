"""Files of spheres, and trajectories."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from typing import Any, Protocol, overload

from . import _settings
from ._camera import Camera
from ._errors import InputError
from ._image import Image
from ._movie import movie
from ._pinhole import FileData, JoinedFrames, SphereData
from ._shapes import warn
from ._spheres import Spheres


class Frames(Protocol):
    """What reads frames."""

    def __len__(self) -> int: ...

    def frame(self, index: int, text: _settings.Text, keys: JoinedFrames | None) -> SphereData: ...


class Trajectory(Sequence[Spheres]):
    """The frames of a file. A frame is read when it is indexed. A slice is another trajectory, and reads nothing.

    ``render`` renders the first frame, and ``movie`` all of them.
    """

    __slots__ = ("_file", "_frames", "_settings", "camera")

    #: The default camera of ``render`` and ``movie``.
    camera: Camera | None

    def __init__(self, file: Frames, frames: range, settings: dict[str, Any]) -> None:
        self._file, self._frames, self._settings = file, frames, settings
        self.camera = None

    def __len__(self) -> int:
        return len(self._frames)

    @overload
    def __getitem__(self, index: int) -> Spheres: ...
    @overload
    def __getitem__(self, index: slice) -> Trajectory: ...
    def __getitem__(self, index: int | slice) -> Spheres | Trajectory:
        """The spheres of a frame, or a part of the trajectory."""
        if isinstance(index, slice):
            part = Trajectory(self._file, self._frames[index], self._settings)
            part.camera = self.camera
            return part
        try:
            frame = self._frames[index]
        except IndexError:
            raise IndexError(f"there is no frame {index}; there are {len(self)}") from None
        return self._read(frame, None)

    def _read(self, frame: int, keys: JoinedFrames | None) -> Spheres:
        data = self._file.frame(frame, _settings.data_text(self._settings), keys)
        if keys is None:
            warn(data.notes)
        return Spheres._of(data, self._settings, self.camera)

    def with_(self, **settings: Any) -> Trajectory:
        """Returns the same frames with other settings about data, such as ``color_by``."""
        checked = {**self._settings, **_settings.data_settings(settings)}
        made = Trajectory(self._file, self._frames, checked)
        made.camera = self.camera
        return made

    def render(self, size: tuple[int, int] | None = None, **settings: Any) -> Image:
        """Renders the first frame; arguments are those of ``Spheres.render``."""
        return self[0].render(size, **settings)

    def movie(self, path: str | os.PathLike[str], *, fps: float = 25.0, **settings: Any) -> None:
        """Renders all frames into a movie, as ``pinhole.movie`` does. One camera frames all frames, and equal values
        have equal colours in each.

        All frames are read twice, because the positions and values of all spheres must be known before.
        """
        camera = settings.pop("camera", None) or self.camera
        keys = JoinedFrames()
        for frame in self:
            keys.add(frame._data)
        placed = self[0]._placed({**settings, "camera": camera}, frames=keys)
        frames = (self._read(frame, keys) for frame in self._frames)
        movie(path, (frame.render(camera=placed, **settings) for frame in frames), fps=fps)

    def __repr__(self) -> str:
        return f"<pinhole.Trajectory: {len(self)} {'frame' if len(self) == 1 else 'frames'}>"

    def _repr_png_(self) -> bytes:
        return self[0]._repr_png_()


def _has_places_alone(path: str | os.PathLike[str]) -> bool:
    """Whether a file is a trajectory that needs a topology."""
    return os.fspath(path).lower().endswith((".xtc", ".trr", ".dcd"))


def _name_of(path: str | os.PathLike[str] | Sequence[str | os.PathLike[str]]) -> str:
    """The name of a file, or the one that stands for several."""
    if isinstance(path, (str, os.PathLike)):
        return os.fspath(path)
    paths = [os.fspath(one) for one in path]
    if len(paths) == 1:
        return paths[0]
    name = FileData.name_of(paths)
    if name is None:
        raise InputError("path: names of several files cannot have commas or braces; rename them")
    return name


def read(
    path: str | os.PathLike[str] | Sequence[str | os.PathLike[str]],
    topology: str | os.PathLike[str] | None = None,
    *,
    frame: int | None = None,
    radius: float | None = None,
    format: str | None = None,
    columns: Iterable[str] = (),
    **settings: Any,
) -> Any:
    """Reads a file of spheres: PDB, mmCIF, XYZ, LAMMPS, GSD, GROMACS, DCD, PLY, VTK, LAS, CSV, NumPy and more.

    Returns ``Spheres``, or a ``Trajectory`` if there are several frames and ``frame`` is None.

    Parameters
    ----------
    path
        The file. Several files are frames, in the order of the numbers in which their names differ: ``"dump.*"``, or a list.
        Others are put together: ``["protein.pdb", "ligand.sdf"]``, or ``"{protein.pdb,ligand.sdf}"``.
    topology
        The file that describes the spheres of a trajectory, for formats that have positions alone. It may also come first.
    frame
        The frame of a trajectory, counted from 0; -1 is the last.
    radius
        The radius of all spheres, for files without radii.
    format
        The name of the format; by default, the file's extension or content shows it.
    columns
        The names of the columns of a table without a header.
    settings
        Settings about data, as for ``Spheres``.
    """
    checked = _settings.data_settings(settings)
    name = _name_of(path)
    where = None if topology is None else os.fspath(topology)
    if where is not None and _has_places_alone(where) and not _has_places_alone(name):
        name, where = where, name
    file = FileData(name, format, radius, where, list(columns))
    if file.problem is not None:
        warn([f"{name}: after the {len(file)} complete frames: {file.problem}"])
    frames = Trajectory(file, range(len(file)), checked)
    if frame is not None:
        if not -len(file) <= frame < len(file):
            raise InputError(f"{name}: there is no frame {frame}; the file has {len(file)}, counted from 0")
        return frames[frame]
    return frames[0] if len(file) == 1 else frames
