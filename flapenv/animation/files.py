"""Frames into a GIF or an MP4 file."""

import contextlib
import importlib.util
import os
from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np

from flapenv.aero.checks import shown
from flapenv.drawing import BLACK, BLUE, GREEN, ORANGE, RED

TINTS = 10
"""Steps from white to each colour of a picture in the palette of a GIF."""
QUALITY = 8
"""Of an MP4, from 1 to 10; lines and letters want more than films."""


def checked_path(path: str | os.PathLike[str]) -> Path:
    """A path that a moving picture can be written to.

    Raises:
        TypeError: if it is no path.
        ValueError: for another suffix than .gif or .mp4.
        ImportError: where what writes the format is missing, naming the extra to install.
        FileNotFoundError: if its folder does not exist.
        IsADirectoryError: if it is a folder itself.
    """
    if not isinstance(path, str | os.PathLike):
        raise TypeError(f"path = {shown(path)} is not allowed; allowed: a path that ends in {' or '.join(WRITERS)}")
    found = Path(path)
    if found.suffix.lower() not in WRITERS:
        raise ValueError(
            f"path = {shown(str(path))} is not allowed; allowed: a path that ends in {' or '.join(WRITERS)}"
        )
    if found.suffix.lower() == ".mp4" and importlib.util.find_spec("imageio_ffmpeg") is None:
        raise ImportError("MP4 needs imageio-ffmpeg: pip install 'flapenv[report]'; a path that ends in .gif does not")
    if not found.parent.is_dir():
        raise FileNotFoundError(f"path = {shown(str(path))}: {found.parent} is not a folder; allowed: one that exists")
    if found.is_dir():
        raise IsADirectoryError(f"path = {shown(str(path))} is a folder; allowed: a file")
    return found


def _palette() -> list[int]:
    """Tints of the colours that pictures are drawn with, from white on; red, green, blue in turn."""
    inks = np.array([[int(ink[i : i + 2], 16) for i in (1, 3, 5)] for ink in (BLUE, ORANGE, GREEN, RED, BLACK)])
    shares = np.arange(1, TINTS + 1)[:, None, None] / TINTS
    tints = np.rint(255 + shares * (inks - 255.0)).astype(int)
    return [255, 255, 255, *tints.ravel().tolist()]


def write_gif(path: Path, frames: Iterable[np.ndarray], frames_per_second: float) -> None:
    """Frames (height, width, 3) of uint8 as a GIF that loops for ever; delays are whole hundredths of a second."""
    from PIL import Image

    palette = Image.new("P", (1, 1))
    palette.putpalette(_palette())
    first, *rest = (Image.fromarray(frame).quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames)
    delay = 10 * round(100 / frames_per_second)
    first.save(path, format="GIF", save_all=True, append_images=rest, duration=delay, loop=0, optimize=True)


def write_mp4(path: Path, frames: Iterable[np.ndarray], frames_per_second: float) -> None:
    """Frames (height, width, 3) of uint8, both even, as an MP4 in H.264 that every browser plays.

    Raises:
        OSError: if the encoder fails.
    """
    import imageio_ffmpeg

    frames, written = iter(frames), 1
    first = next(frames)
    height, width = first.shape[:2]
    encoder = imageio_ffmpeg.write_frames(
        str(path), (width, height), fps=frames_per_second, quality=QUALITY, macro_block_size=2, ffmpeg_log_level="error"
    )
    with contextlib.closing(encoder):
        encoder.send(None)
        encoder.send(first.tobytes())
        for frame in frames:
            encoder.send(frame.tobytes())
            written += 1
    try:  # the encoder's end says nothing of whether it went well
        kept, _ = imageio_ffmpeg.count_frames_and_secs(str(path))
    except RuntimeError:
        kept = 0
    if kept != written:
        raise OSError(f"{kept} of {written} frames were encoded; allowed: all (is the disk full?)")


WRITERS: dict[str, Callable[[Path, Iterable[np.ndarray], float], None]] = {".gif": write_gif, ".mp4": write_mp4}
"""What writes which kind of file, by its suffix."""
