"""Films have the frames that were asked for; files are whole or not there; bad input is named."""

import dataclasses
import importlib.util
import math
import subprocess
import sys
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from drawn_beats import BEST, HAWKMOTH, SERIES, beat, read_gif
from imageio_ffmpeg import get_ffmpeg_exe
from PIL import Image

from flapenv import SampledMotion, animate
from flapenv.aero import TERMS
from flapenv.animation import film
from flapenv.animation.sheet import MovingSheet
from flapenv.whole_file import whole_file


def read_mp4(path: Path, width: int, height: int) -> tuple[str, np.ndarray]:
    """What the decoder says of a film, and its frames."""
    words = [get_ffmpeg_exe(), "-i", str(path), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    done = subprocess.run(words, capture_output=True, check=True)
    return done.stderr.decode(), np.frombuffer(done.stdout, np.uint8).reshape(-1, height, width, 3)


def test_a_gif_has_the_frames_size_and_pace_that_were_asked_for_and_loops(tmp_path: Path) -> None:
    path = animate(BEST, "hawkmoth", tmp_path / "best.gif", frames=6, width=480, frames_per_second=20)
    assert path == tmp_path / "best.gif"
    frames = read_gif(path)
    assert frames.shape == (6, 270, 480, 3)
    assert np.any(frames[0] != frames[-1])
    assert frames[0, 0, 0].tolist() == [255, 255, 255]
    with Image.open(path) as image:
        assert (image.info["loop"], image.info["duration"]) == (0, 50)
    sheet = MovingSheet([beat(BEST, frames=6)], 480)
    assert np.mean(np.abs(frames[3].astype(int) - sheet.image(3))) < 2  # the palette is good enough
    assert list(tmp_path.iterdir()) == [path]


def test_an_mp4_has_the_frames_size_and_pace_that_were_asked_for(tmp_path: Path) -> None:
    path = animate(None, HAWKMOTH.to_dict(), tmp_path / "own.MP4", frames=6, width=362, frames_per_second=10)
    about, frames = read_mp4(path, 362, 204)
    assert "h264" in about
    assert "10 fps" in about
    assert frames.shape == (6, 204, 362, 3)
    assert np.any(frames[0] != frames[-1])
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(
    "motion",
    [SERIES, SampledMotion.from_functions(26.0, np.sin, lambda phase: 0.8 * np.cos(phase))],
)
def test_any_motion_can_be_shown_and_compared(motion: object, tmp_path: Path) -> None:
    path = animate(motion, HAWKMOTH, tmp_path / "a.gif", compare=BEST, terms=TERMS, frames=2, width=320, progress=True)
    assert read_gif(path).shape == (2, 360, 320, 3)


@pytest.mark.parametrize(("name", "error"), [("a.gif", MemoryError), ("a.mp4", KeyboardInterrupt)])
def test_a_file_that_was_there_is_replaced_only_by_a_whole_one(
    name: str, error: type[BaseException], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, draw = tmp_path / name, MovingSheet.image
    path.write_bytes(b"old")

    def failing(sheet: MovingSheet, frame: int) -> np.ndarray:
        if frame == 2:
            raise error
        return draw(sheet, frame)

    monkeypatch.setattr(MovingSheet, "image", failing)
    with pytest.raises(error):
        animate(None, "hawkmoth", path, frames=4, width=320)
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_film_that_lost_frames_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("imageio_ffmpeg.count_frames_and_secs", lambda _: (3, 0.1))
    with pytest.raises(OSError, match="3 of 4 frames were encoded"):
        animate(None, "hawkmoth", tmp_path / "a.mp4", frames=4, width=320)
    assert not list(tmp_path.iterdir())


def test_a_folder_that_cannot_be_written_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(path: Path, *_: object, **__: object) -> None:
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr(Path, "touch", refuse)
    with (
        pytest.raises(PermissionError, match=r"path = '.*a\.gif' cannot be written .*allowed: a folder that can"),
        whole_file(tmp_path / "a.gif"),
    ):
        pytest.fail("not reached")


@pytest.mark.parametrize(
    ("arguments", "kind", "said"),
    [
        ({"path": "a.webm"}, ValueError, r"path = 'a.webm' is not allowed; allowed: a path that ends in .gif or .mp4"),
        ({"path": "gif"}, ValueError, "path = 'gif' is not allowed"),
        ({"path": 3}, TypeError, "path = 3 is not allowed; allowed: a path"),
        ({"path": "nowhere/a.gif"}, FileNotFoundError, "nowhere is not a folder; allowed: one that exists"),
        ({"path": "folder.gif"}, IsADirectoryError, "path = 'folder.gif' is a folder; allowed: a file"),
        ({"frames": 1}, ValueError, "frames = 1 is not allowed; allowed: whole numbers from 2"),
        ({"frames": 2.5}, TypeError, "frames = 2.5 is not a whole number"),
        ({"frames_per_second": 0}, ValueError, r"frames_per_second = 0 is not allowed; allowed: finite, in \[1, 50\]"),
        ({"frames_per_second": math.nan}, ValueError, "frames_per_second = nan"),
        ({"width": 961}, ValueError, "width = 961 is not allowed; allowed: even numbers from 320 to 3840 pixels"),
        ({"width": 100}, ValueError, "width = 100 is not allowed"),
        ({"width": 9600}, ValueError, "width = 9600 is not allowed"),
        ({"width": True}, TypeError, "width = True is not a whole number"),
        ({"progress": 1}, TypeError, "progress = 1 is not allowed"),
        ({"stroke": "hawkmoth"}, TypeError, r"stroke = 'hawkmoth' is not allowed; .*animate\(None, insect\)"),
        ({"stroke": object()}, TypeError, "is not allowed; allowed: a Stroke"),
        ({"compare": HAWKMOTH}, TypeError, "compare = Insect.* is not allowed"),
        ({"insect": "hawkmot"}, ValueError, "insect = 'hawkmot' is unknown; .*did you mean 'hawkmoth'"),
        ({"insect": 3}, TypeError, "insect = 3 is not allowed"),
        ({"model": {"air_desnity": 1.0}}, TypeError, "did you mean 'air_density'"),
        ({"model": 0}, TypeError, "model = 0 is not allowed; allowed: a HoverModel or a dict"),
        ({"terms": ["lift"]}, ValueError, "terms = 'lift' is unknown"),
        ({"stroke": dataclasses.replace(BEST, frequency=[1.0, 2.0])}, TypeError, "array fields"),
    ],
)
def test_bad_input_is_named_and_leaves_nothing(
    arguments: dict[str, object], kind: type[Exception], said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder.gif").mkdir()
    with pytest.raises(kind, match=said):
        animate(**arguments)
    assert [path.name for path in tmp_path.iterdir()] == ["folder.gif"]


def test_a_motion_that_gives_nan_is_refused(tmp_path: Path) -> None:
    class Broken:
        """A stroke whose pitching angle is not a number somewhere."""

        def __getattr__(self, name: str) -> object:
            return getattr(BEST, name)

        def pitch_angle(self, phase: np.ndarray) -> np.ndarray:
            return np.where(phase > 3, np.nan, BEST.pitch_angle(phase))

    with pytest.raises(ValueError, match=r"the motion's pitch\[\d+\] = nan is not allowed; allowed: finite"):
        animate(Broken(), "hawkmoth", tmp_path / "a.gif")


def test_what_is_missing_is_named_with_its_extra(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    found = importlib.util.find_spec

    def find(missing: str, name: str) -> object:
        return None if name == missing else found(name)

    for missing, name in (("matplotlib", "a.gif"), ("imageio_ffmpeg", "a.mp4")):
        monkeypatch.setattr("importlib.util.find_spec", partial(find, missing))
        with pytest.raises(ImportError, match=r"pip install 'flapenv\[report\]'"):
            animate(None, "hawkmoth", tmp_path / name)
    monkeypatch.undo()
    monkeypatch.setitem(sys.modules, "tqdm", None)
    with pytest.raises(ImportError, match="progress = True needs tqdm"):
        animate(None, "hawkmoth", tmp_path / "a.gif", progress=True)


def test_the_defaults_last_between_two_and_three_seconds() -> None:
    assert 2 < film.FRAMES / film.FRAMES_PER_SECOND < 3
