"""Movies: ffmpeg encodes pictures one after the other, or they become numbered files."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from collections.abc import Iterable

from ._errors import FileError, InputError
from ._image import Image, write
from ._pinhole import png_of
from ._sheet import Array, pixels

#: The arguments of ffmpeg for each kind of file.
CODECS = {
    ".mp4": ["-c:v", "libx264", "-crf", "18", "-pix_fmt", "yuv420p", "-movflags", "+faststart"],
    ".mov": ["-c:v", "libx264", "-crf", "18", "-pix_fmt", "yuv420p"],
    ".mkv": ["-c:v", "libx264", "-crf", "18", "-pix_fmt", "yuv420p"],
    ".webm": ["-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-pix_fmt", "yuv420p"],
    ".apng": ["-f", "apng", "-plays", "0"],
    ".gif": ["-vf", "split[a][b];[a]palettegen[p];[b][p]paletteuse", "-loop", "0"],
}


def movie(path: str | os.PathLike[str], images: Iterable[Image | Array], *, fps: float = 25.0) -> None:
    """Writes pictures as a movie (.mp4, .mov, .mkv, .webm, .apng or .gif, which need the program ffmpeg), or as
    numbered PNG files, such as ``f%04d.png``. Pictures are ``Image`` objects, or arrays as for ``sheet``. An iterator
    may make them one by one, so that only one is in memory.
    """
    path = os.fspath(path)
    if isinstance(images, Image):
        raise InputError("images is one picture; write a list of pictures")
    if re.search(r"%0?\d*d", os.path.basename(path)):
        number = -1
        for number, image in enumerate(images):
            if isinstance(image, Image):
                image.save(path % number)
            else:
                write(path % number, png_of(pixels(number, image)))
        if number < 0:
            raise InputError(f"{path}: there are no pictures")
        return
    extension = os.path.splitext(path)[1].lower()
    codec = CODECS.get(extension)
    if codec is None:
        raise InputError(f"{path}: a movie is written as {', '.join(CODECS)}, or as numbered files, f%04d.png")
    if not fps > 0:
        raise InputError(f"fps is {fps!r}; it must be greater than 0")
    ffmpeg = shutil.which("ffmpeg")
    if ffmpeg is None:
        raise FileError(f"{path}: the program ffmpeg, which writes it, is not found; install it, or write f%04d.png")
    process: subprocess.Popen[bytes] | None = None
    size = (0, 0)
    temporary = f"{path}.part{extension}"
    try:
        for number, image in enumerate(images):
            frame = pixels(number, image)
            if process is None:
                size = (frame.shape[1], frame.shape[0])
                raw = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{size[0]}x{size[1]}", "-r", str(fps), "-i", "-"]
                # Formats with this pixel format need even sides.
                even = ["-vf", "crop=trunc(iw/2)*2:trunc(ih/2)*2"] if "yuv420p" in codec else []
                command = [ffmpeg, "-y", "-loglevel", "error", *raw, *even, *codec, temporary]
                process = subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE)
            if (frame.shape[1], frame.shape[0]) != size:
                other = (frame.shape[1], frame.shape[0])
                raise InputError(f"{path}: the pictures have different sizes, {size} and {other}")
            assert process.stdin is not None
            process.stdin.write(frame[:, :, :3].tobytes())
        if process is None:
            raise InputError(f"{path}: there are no pictures")
        _, said = process.communicate()
        if process.returncode != 0:
            raise FileError(f"{path}: ffmpeg failed: {said.decode(errors='replace').strip()}")
        os.replace(temporary, path)
    except BrokenPipeError:
        assert process is not None and process.stderr is not None
        said = process.stderr.read()
        raise FileError(f"{path}: ffmpeg failed: {said.decode(errors='replace').strip()}") from None
    finally:
        if process is not None and process.poll() is None:
            process.kill()
            process.wait()
        if process is not None and process.stderr is not None:
            process.stderr.close()
        if os.path.exists(temporary):
            os.unlink(temporary)
