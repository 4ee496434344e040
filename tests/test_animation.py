"""Moving pictures: what is drawn is the physics, the loop closes, and files are whole or not there."""

import dataclasses
import importlib.util
import math
import subprocess
import sys
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from imageio_ffmpeg import get_ffmpeg_exe
from PIL import Image, ImageSequence

import flapenv.animation.__main__ as command
from flapenv import FourierMotion, Insect, SampledMotion, Stroke, animate, evaluate, load_insect, optimum, simulate
from flapenv.aero import TERMS
from flapenv.aero.axes import LEFT, RIGHT
from flapenv.aero.inertia import wing_inertia
from flapenv.animation import film
from flapenv.animation.beat import DrawnBeat, drawn_beat
from flapenv.animation.panels import SectionPanel, arrow_outline
from flapenv.animation.sheet import MovingSheet
from flapenv.whole_file import whole_file

HAWKMOTH = load_insect("hawkmoth")
BEST = optimum(HAWKMOTH).stroke
SERIES = FourierMotion(frequency=25.0, flap_sines=[0.9, 0.2], pitch_cosines=[0.1, 0.8], pitch_sines=[0.3])


def beat(motion: object = None, insect: Insect = HAWKMOTH, frames: int = 60, **options: object) -> DrawnBeat:
    return drawn_beat(insect, motion, frames=frames, **options)


def read_gif(path: Path) -> np.ndarray:
    with Image.open(path) as image:
        return np.stack([np.asarray(frame.convert("RGB")) for frame in ImageSequence.Iterator(image)])


def read_mp4(path: Path, width: int, height: int) -> tuple[str, np.ndarray]:
    """What the decoder says of a film, and its frames."""
    words = [get_ffmpeg_exe(), "-i", str(path), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    done = subprocess.run(words, capture_output=True, check=True)
    return done.stderr.decode(), np.frombuffer(done.stdout, np.uint8).reshape(-1, height, width, 3)


# what is drawn


def test_the_mean_of_the_arrows_vertical_part_is_the_weight_support(insect: Insect) -> None:
    for stroke in (insect.stroke, optimum(insect).stroke):
        drawn, ours = beat(stroke, insect), evaluate(insect, stroke)
        assert drawn.weight_support == np.mean(drawn.force[:, 1])
        assert drawn.weight_support == pytest.approx(ours.weight_support, rel=1e-5)
        assert drawn.mean_power == pytest.approx(ours.specific_power, rel=1e-5)


@pytest.mark.parametrize("motion", [HAWKMOTH.stroke, BEST, SERIES])
def test_the_arrow_is_normal_to_the_chord_and_its_drag_brakes(motion: object) -> None:
    drawn = beat(motion)
    chord = drawn.leading - drawn.trailing
    np.testing.assert_allclose(np.sum(chord * drawn.force, axis=1), 0, atol=1e-9 * np.max(np.abs(drawn.force)))
    assert np.all(drawn.force[:, 0] * drawn.history.kinematics.flap_rate <= 1e-12)


def test_the_arrow_along_the_stroke_times_the_speed_of_its_centre_is_the_power() -> None:
    drawn = beat()
    arm = HAWKMOTH.wing.moment(3) / HAWKMOTH.wing.moment(2) * HAWKMOTH.wing.length  # of drag ∝ r²
    power = -drawn.force[:, 0] * 9.81 * arm * drawn.history.kinematics.flap_rate
    np.testing.assert_allclose(power, drawn.specific_power, rtol=1e-3)


@pytest.mark.parametrize("term", TERMS)
def test_the_tangential_force_of_both_wings_gives_the_forward_force_of_the_pair(term: str) -> None:
    stroke = dataclasses.replace(HAWKMOTH.stroke, pitch_phase=math.radians(100))
    history = simulate(HAWKMOTH, stroke, terms=[term], steps=2000)
    found = history.terms[term]
    forward = np.sum(found.tangential_force, axis=0) * np.cos(history.kinematics.flap)
    if term == "inertia":  # pulls along the wing too
        at, moments = history.kinematics, wing_inertia(HAWKMOTH.wing)
        turning = 2 * np.cos(at.pitch) * at.pitch_rate * at.flap_rate + np.sin(at.pitch) * at.flap_acceleration
        forward += 2 * (moments.first_radius * at.flap_rate**2 - moments.first_chord * turning) * np.sin(at.flap)
    np.testing.assert_allclose(forward, found.force[:, 0], atol=1e-9 * np.max(np.abs(found.force)))


def test_the_section_is_as_long_as_its_chord_and_lies_on_its_arc() -> None:
    drawn, wing = beat(), HAWKMOTH.wing
    r_hat = math.sqrt(wing.moment(2))
    length = np.hypot(*(drawn.leading - drawn.trailing).T)
    np.testing.assert_allclose(length * wing.mean_chord, wing.chord(np.array([r_hat]))[0])
    np.testing.assert_allclose(
        drawn.axis[:, 0] * wing.mean_chord, drawn.history.kinematics.flap * r_hat * wing.length, atol=1e-15
    )
    np.testing.assert_allclose(
        drawn.axis, (1 - wing.pitch_axis) * drawn.leading + wing.pitch_axis * drawn.trailing, atol=1e-12
    )


def test_inertia_enters_the_power_and_not_the_arrow() -> None:
    air, all_ = beat(terms=["translational", "added-mass"]), beat(terms=["translational", "added-mass", "inertia"])
    np.testing.assert_array_equal(air.force, all_.force)
    assert np.max(np.abs(air.specific_power - all_.specific_power)) > 10
    paid = evaluate(HAWKMOTH, accounting="positive")
    assert beat(model=command.PROBLEMS["inertial"].model).mean_power == pytest.approx(paid.specific_power, rel=1e-3)


@pytest.mark.parametrize("frames", [2, 7, 60, 5000])
def test_frames_divide_the_cycle_evenly(frames: int) -> None:
    drawn = beat(frames=frames)
    np.testing.assert_allclose(drawn.time[drawn.rows], (np.arange(frames) + 0.5) / frames, rtol=1e-12)


@pytest.mark.parametrize("motion", [HAWKMOTH.stroke, SERIES])
def test_the_trail_holds_sections_of_this_half_stroke_only(motion: object) -> None:
    drawn = beat(motion)
    lengths = []
    for row in drawn.rows:
        stamps, fresh = drawn.trail(row)
        assert all(drawn.sense(stamp) == drawn.sense(row) for stamp in stamps)
        assert np.all((fresh > 0) & (fresh < 1))
        behind = drawn.sense(row) * (drawn.axis[row, 0] - drawn.axis[stamps, 0])
        assert np.all(behind > 0)
        lengths.append(len(stamps))
    assert min(lengths) <= 1
    assert max(lengths) >= 10


def test_the_wings_from_above_mirror_each_other_and_lead_with_their_leading_edge() -> None:
    drawn = beat()
    row = int(drawn.rows[0])  # forward, in the middle
    right, left = drawn.outline(row, RIGHT), drawn.outline(row, LEFT)
    np.testing.assert_allclose(right * [1, -1], left, atol=1e-12)
    assert np.all(right[1:, 1] < 1e-9)  # the right wing is to the right of the root
    half = len(right) // 2
    middle = half // 2
    assert right[middle, 0] > right[-1 - middle, 0]
    assert np.hypot(*right[half - 1]) == pytest.approx(1.0)


def test_an_arrow_ends_at_its_tip_and_has_no_size_without_a_force() -> None:
    outline = arrow_outline(np.array([1.0, 2.0]), np.array([3.0, 4.0]), 0.1)
    np.testing.assert_allclose(outline[3], [4.0, 6.0])
    np.testing.assert_allclose((outline[0] + outline[-1]) / 2, [1.0, 2.0])
    assert np.ptp(arrow_outline(np.ones(2), np.zeros(2), 0.1), axis=0).tolist() == [0.0, 0.0]


@pytest.mark.parametrize(
    "stroke",
    [
        HAWKMOTH.stroke,
        BEST,
        SERIES,
        dataclasses.replace(HAWKMOTH.stroke, pitch_phase=-math.pi / 2),
        Stroke(frequency=5.0, flap_amplitude=0.02, pitch_amplitude=1.5),
        Stroke(frequency=26.0, flap_amplitude=1.0, pitch_amplitude=0.0),
    ],
)
def test_section_and_arrow_never_leave_their_panel(stroke: object) -> None:
    drawn = beat(stroke)
    sheet = MovingSheet([drawn], 480)
    section = sheet.panels[0][0]
    assert isinstance(section, SectionPanel)
    low, high = np.transpose([section.axes.get_xlim(), section.axes.get_ylim()])
    for points in (drawn.leading, drawn.trailing, drawn.axis + section.unit * drawn.force):
        assert np.all(points >= low)
        assert np.all(points <= high)
    scales = section.axes.transData.transform([[0, 0], [1, 1]])
    assert np.ptp(np.ptp(scales, axis=0)) < 0.1  # both directions alike


# frames


def test_the_loop_closes() -> None:
    sheet = MovingSheet([beat(frames=12)], 480)
    images = np.stack([sheet.image(frame) for frame in range(13)]).astype(int)
    np.testing.assert_array_equal(images[12], images[0])
    steps = np.abs(np.diff(images, axis=0)).mean(axis=(1, 2, 3))
    assert np.all(steps > 0.1)
    assert steps[-1] < 1.5 * np.max(steps[:-1])  # from the last to the first is a step like others


def test_two_beats_share_their_scales() -> None:
    sheet = MovingSheet([beat(), beat(BEST)], 480)
    own, best = (panels[0] for panels in sheet.panels)
    assert isinstance(own, SectionPanel)
    assert isinstance(best, SectionPanel)
    assert own.unit == pytest.approx(best.unit, rel=0.02)
    assert sheet.image(0).shape == (2 * 270, 480, 3)


# files


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
    def refuse(path: Path) -> None:
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


# the command line


def test_the_command_writes_the_picture(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    words = ["fruitfly", "--stroke", "both", "--frames", "2", "--width", "320", "--out", "fly.gif"]
    command.main(words)
    assert read_gif(tmp_path / "fly.gif").shape == (2, 360, 320, 3)
    assert capsys.readouterr().out.startswith("wrote fly.gif (")
    seen = {}
    monkeypatch.setattr(command, "animate", lambda *given, **_: seen.update(given=given) or tmp_path / "fly.gif")
    command.main(["hawkmoth", "--stroke", "optimal"])
    assert seen["given"][:2] == (BEST, HAWKMOTH)
    command.main([])
    assert seen["given"][:2] == (HAWKMOTH.stroke, HAWKMOTH)


@pytest.mark.parametrize("words", [["hawkmot"], ["--frames", "1"], ["--out", "a.png"], ["--problem", "inertial", "x"]])
def test_the_command_says_what_is_wrong_in_one_line(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stopped:
        command.main(words)
    assert stopped.value.code == 2
    assert "allowed: " in capsys.readouterr().err


def test_the_module_runs_without_a_warning() -> None:
    words = [sys.executable, "-W", "error", "-m", "flapenv.animation", "--help"]
    assert "--stroke" in subprocess.run(words, capture_output=True, text=True, check=True).stdout


def test_the_defaults_last_between_two_and_three_seconds() -> None:
    assert 2 < film.FRAMES / film.FRAMES_PER_SECOND < 3
