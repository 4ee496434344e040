"""Motions of the hawkmoth that the tests of moving pictures draw."""

from pathlib import Path

import numpy as np
from PIL import Image, ImageSequence

from flapenv import FourierMotion, Insect, load_insect, optimum
from flapenv.animation.beat import DrawnBeat, drawn_beat

HAWKMOTH = load_insect("hawkmoth")
BEST = optimum(HAWKMOTH).stroke
SERIES = FourierMotion(frequency=25.0, flap_sines=[0.9, 0.2], pitch_cosines=[0.1, 0.8], pitch_sines=[0.3])


def beat(motion: object = None, insect: Insect = HAWKMOTH, frames: int = 60, **options: object) -> DrawnBeat:
    return drawn_beat(insect, motion, frames=frames, **options)


def read_gif(path: Path) -> np.ndarray:
    with Image.open(path) as image:
        return np.stack([np.asarray(frame.convert("RGB")) for frame in ImageSequence.Iterator(image)])
