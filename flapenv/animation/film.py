"""A moving picture of a wingbeat, from a stroke and an insect to the file."""

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from flapenv.aero.checks import require_count, require_flag, require_scalar, shown
from flapenv.aero.motions import Motion
from flapenv.animation.beat import drawn_beat
from flapenv.animation.files import WRITERS, checked_path
from flapenv.animation.sheet import WIDTH, MovingSheet
from flapenv.drawing import require_matplotlib
from flapenv.insects import Insect, as_insect
from flapenv.model import HoverModel, as_model
from flapenv.whole_file import whole_file

FRAMES, FRAMES_PER_SECOND = 60, 25.0
"""A wingbeat that one can follow, 2.4 s long."""
FASTEST = 50.0
"""Frames a second; a GIF with shorter delays is slowed down by browsers."""
WIDTHS = (320, 3840)


def animate(
    stroke: Motion | None = None,
    insect: Insect | Mapping[str, Any] | str = "hawkmoth",
    path: str | os.PathLike[str] = "wingbeat.gif",
    *,
    compare: Motion | None = None,
    model: HoverModel | Mapping[str, Any] | None = None,
    terms: Sequence[str] | None = None,
    frames: int = FRAMES,
    frames_per_second: float = FRAMES_PER_SECOND,
    width: int = WIDTH,
    progress: bool = False,
) -> Path:
    """One wingbeat as a looping GIF or an MP4: the wing section with its force, the wings from above, and traces.

    The section at r̂₂ R of the right wing goes along its unrolled arc, to scale. The arrow on it is the force of both
    wings over the weight, the left one's turned into the plane of the right one's section; its vertical part is the
    lift of the trace beside it. With it run φ, θ, α, lift over weight and power over mass against t/T.

    Args:
        stroke: a `Stroke` or any other motion that `simulate` takes; the insect's own stroke where None.
        insect: one insect, the dict of its fields, or a name of `INSECTS`.
        path: ends in .gif or .mp4; its folder exists.
        compare: another motion of the same insect, drawn below on the same scales.
        model: a `HoverModel` or the dict of its options.
        terms: of the force, as in `simulate`; what `evaluate` counts where None. Inertia enters the power alone.
        frames: of the wingbeat, at least 2.
        frames_per_second: of the picture, in [1, 50]; a GIF keeps the nearest whole hundredth of a second.
        width: an even number [pixels]; the height of one beat is 9/16 of it.
        progress: whether to show a bar in the terminal (needs tqdm: the extra "train").

    Returns:
        The path of the file, which is there whole or, after an error, as it was before.

    Raises:
        ImportError: without matplotlib, for MP4 without imageio-ffmpeg, or without tqdm where progress is asked for.
        TypeError: for arguments of another kind, and what `simulate` refuses.
        ValueError: for numbers out of range, another suffix, a motion that gives NaN, and what `simulate` refuses.
        OSError: if the file cannot be written.

    Source: Nabawy & Crowther (2014), Part II, (2.1)-(2.16), by the blade element.
    """
    require_matplotlib()
    file = checked_path(path)
    count = require_count("frames", frames, low=2)
    rate = require_scalar("frames_per_second", frames_per_second, 1.0, FASTEST, unit="1/s")
    pixels = _even_width(width)
    require_flag("progress", progress)
    insect, options = as_insect(insect), as_model(model)
    motions = [stroke] if compare is None else [stroke, compare]
    for name, motion in zip(("stroke", "compare"), motions, strict=False):
        if isinstance(motion, str | Insect | Mapping):
            raise TypeError(
                f"{name} = {shown(motion)} is not allowed; allowed: a Stroke, SampledMotion, FourierMotion, or None "
                "for the "
                "insect's own: animate(None, insect)"
            )
    beats = [drawn_beat(insect, motion, model=options, terms=terms, frames=count) for motion in motions]
    numbers = _with_bar(range(count), file.name) if progress else range(count)
    with whole_file(file) as beside:
        sheet = MovingSheet(beats, pixels)
        WRITERS[file.suffix.lower()](beside, (sheet.image(number) for number in numbers), rate)
    return file


def _even_width(width: object) -> int:
    """A width that H.264 and the eye can take."""
    low, high = WIDTHS
    pixels = require_count("width", width)
    if not low <= pixels <= high or pixels % 2:
        raise ValueError(f"width = {pixels} is not allowed; allowed: even numbers from {low} to {high} pixels")
    return pixels


def _with_bar(numbers: Sequence[int], name: str) -> Any:
    """The numbers with a bar in the terminal that advances with them."""
    try:
        from tqdm import tqdm
    except ImportError:
        raise ImportError("progress = True needs tqdm: pip install tqdm, or progress=False") from None
    return tqdm(numbers, desc=name, unit="frame")
