"""Pictures and movies of files, rendered by the workers of a Dask cluster in the same parts as ``pinhole job``.

The files have the same bytes as those of ``pinhole render`` on one machine, whichever worker renders which part, and
however often one is lost: Dask retries. The workers, the scheduler's client and this package must have the same
version. The program ``pinhole`` must be on their ``PATH`` (or ``PINHOLE_PROGRAM`` must name it), and all must see the
same folder.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterable, Mapping
from typing import Any

from ._errors import DeviceError, Error, FileError, InputError, PackageError
from ._pinhole import __version__

__all__ = ["movie", "render"]

#: The exit codes of the program for wrong usage, and for a device that was lost or does not answer.
USAGE, DEVICE = 2, 5


def render(
    frames: str | os.PathLike[str],
    output: str | os.PathLike[str] = "f%04d.png",
    *,
    client: Any,
    tiles: tuple[int, int] = (1, 1),
    by_depth: int | None = None,
    layers: Mapping[str, str | os.PathLike[str]] | None = None,
    units_per_task: int | None = None,
    retries: int = 3,
    folder: str | os.PathLike[str] | None = None,
    fps: float | None = None,
    allow_mixed_adapters: bool = False,
    **flags: Any,
) -> None:
    """Renders the frames of a file, or a scene, on the workers of ``client``, a ``dask.distributed.Client``.

    ``frames`` is the path of a data file or a scene file. ``output`` is that of ``pinhole render``: a picture, a
    pattern such as ``f%04d.png``, or a movie. ``layers`` names files of layers, as ``{"depth": "d%04d.npy"}``. Each
    picture is divided into ``tiles``, columns and rows; or the spheres of a file of bricks into ``by_depth`` groups.
    Other arguments are flags of the program, with ``_`` for ``-``: ``size="640x480"``, ``transparent=True``, and
    ``frames_range="0:100"`` for ``--frames`` (all, unless the output is one picture). A list repeats a flag.

    The parts are stored in ``folder``, which all workers must see. The default is a folder beside the output, which is
    removed at the end. A named folder stays, and parts in it are not rendered again.
    """
    if not hasattr(client, "submit") or not hasattr(client, "gather"):
        raise InputError(f"client is {client!r}; give a dask.distributed.Client")
    path, target = os.path.abspath(os.fspath(frames)), os.path.abspath(os.fspath(output))
    if not os.path.exists(path):
        raise FileError(f"{path}: there is no such file; frames is the path of a data file or a scene file")
    _check_versions(client)
    many = "%" in os.path.basename(target) or os.path.splitext(target)[1].lower() != ".png"
    wanted = flags.pop("frames_range", ":" if many and "turntable" not in flags and "camera_path" not in flags else None)
    arguments = _flags({**flags, "frames": wanted, "layer": list(layers or ())})
    job = os.fspath(folder) if folder is not None else tempfile.mkdtemp(prefix=".pinhole-", dir=os.path.dirname(target))
    job = os.path.abspath(os.path.join(job, "job") if folder is None else job)
    try:
        if not os.path.exists(os.path.join(job, "job.json")):
            exr = ["--exr"] if target.lower().endswith(".exr") else []
            columns, rows = tiles
            units = ["--tiles", f"{columns}x{rows}"] if by_depth is None else ["--by-depth", str(by_depth)]
            _run("job", "split", path, *arguments, *exr, *units, "-o", job, "-q")
        missing = _missing(job)
        if missing:
            each = units_per_task or max(1, len(missing) // 200)
            chunks = [",".join(map(str, missing[i : i + each])) for i in range(0, len(missing), each)]
            tasks = [client.submit(_part, job, units, __version__, retries=retries, pure=False) for units in chunks]
            client.gather(tasks)
        named = [word for layer, file in (layers or {}).items() for word in ("--layer", f"{layer}={os.path.abspath(os.fspath(file))}")]
        more = [] if fps is None else ["--fps", f"{fps:g}"]
        mixed = ["--allow-mixed-adapters"] if allow_mixed_adapters else []
        _run("job", "merge", job, *named, *more, *mixed, "-o", target, "--wait", "60", "-q")
    finally:
        if folder is None:
            shutil.rmtree(os.path.dirname(job), ignore_errors=True)


def movie(
    path: str | os.PathLike[str],
    frames: str | os.PathLike[str],
    *,
    client: Any,
    fps: float | None = None,
    **settings: Any,
) -> None:
    """Renders the frames of a file into a movie on the workers of ``client``; see ``render``."""
    render(frames, path, client=client, fps=fps, **settings)


def _flags(flags: Mapping[str, Any]) -> list[str]:
    """Returns the arguments for the program."""
    words: list[str] = []
    for name, value in flags.items():
        flag = "--" + name.replace("_", "-")
        values: Iterable[Any] = value if isinstance(value, (list, tuple)) else [value]
        for one in values:
            if one is True:
                words.append(flag)
            elif one is not None and one is not False:
                # The flag and its value are one word, so that the value may begin with a minus.
                words.append(f"{flag}={one}")
    return words


def _program() -> str:
    program = os.environ.get("PINHOLE_PROGRAM") or shutil.which("pinhole")
    if program is None:
        raise PackageError("the program pinhole is not on PATH; install it with cargo install, or set PINHOLE_PROGRAM")
    return program


def _run(*arguments: str) -> str:
    """Runs the program. Its line about an error becomes an exception."""
    program = _program()
    try:
        done = subprocess.run([program, *arguments], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    except OSError as error:
        raise PackageError(f"{program}: this program cannot be started: {error.strerror}") from None
    if done.returncode == 0:
        return done.stdout
    lines = [line for line in done.stderr.splitlines() if line.strip()]
    why = lines[-1].removeprefix("error: ") if lines else f"the program ended with {done.returncode}"
    kind = {USAGE: InputError, DEVICE: DeviceError}.get(done.returncode, FileError)
    raise kind(why)


def _missing(job: str) -> list[int]:
    """The units of a job without a valid part."""
    return [int(unit) for unit in _run("job", "status", job, "--missing", "--check").split()]


def _versions() -> tuple[str, str]:
    """The versions of the package and of the program on a worker."""
    return __version__, _run("--version").split()[-1]


def _check_versions(client: Any) -> None:
    """Refuses workers whose pixels may differ."""
    if _versions() != (__version__, __version__):
        raise Error(f"the program pinhole is {_versions()[1]}, and this package is {__version__}; install the same version")
    try:
        found: Mapping[str, tuple[str, str]] = client.run(_versions)
    except Error:
        raise
    except Exception as error:
        raise Error(f"a worker cannot run pinhole {__version__}: {type(error).__name__}: {error}") from None
    if not found:
        raise Error("the Dask cluster has no worker")
    for worker, versions in found.items():
        if versions != (__version__, __version__):
            package, program = versions
            raise Error(
                f"the worker {worker} has the package {package} and the program {program}, and this is {__version__}; "
                "install the same version everywhere"
            )


def _part(job: str, units: str, version: str) -> str:
    """Renders units on a worker. A worker that joined later may have another version, which is refused."""
    if version != __version__:
        raise Error(f"this worker has pinhole {__version__}, and the job is of {version}; install the same version")
    _run("job", "part", job, units, "-q")
    return units
