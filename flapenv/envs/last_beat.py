"""What a picture of an episode shows: the last beat of every row and how the beats before it went."""

import numpy as np

from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.aero.stroke import Stroke


class LastBeat:
    """The last beat of every row, kept beyond its episode's end until the next one is flown.

    Attributes:
        insect: which one beat, shape (rows,).
        beats: flown in that episode, shape (rows,); 0 before the first.
        numbers: of that beat, by name, shape (rows,) each.
        trace: numbers of every beat of that episode, shape (traces, rows, beats).
    """

    kept = ("insect", "beats", "numbers", "trace", "_stroke")

    def __init__(self, rows: int, beats: int, numbers: tuple[str, ...], traces: int) -> None:
        """Nothing has been flown.

        Args:
            rows: of the batch.
            beats: of an episode.
            numbers: names of what is kept of the last beat, beside its stroke.
            traces: how many numbers are kept of every beat.
        """
        self.insect = np.zeros(rows, dtype=np.intp)
        self.beats = np.zeros(rows, dtype=np.intp)
        self.numbers = {name: np.zeros(rows) for name in numbers}
        self.trace = np.zeros((traces, rows, beats), dtype=np.float32)
        self._stroke = {name: np.zeros(rows) for name in STROKE_PARAMETERS}

    def keep(
        self,
        mask: np.ndarray,
        insect: np.ndarray,
        flown: np.ndarray,
        stroke: dict[str, np.ndarray],
        numbers: dict[str, np.ndarray],
        traces: tuple[np.ndarray, ...],
    ) -> None:
        """Take in a beat in the rows of the mask, the one after `flown` others; arrays of shape (rows,)."""
        rows = np.flatnonzero(mask)
        self.insect[rows], self.beats[rows] = insect[rows], flown[rows] + 1
        for kept, values in ((self._stroke, stroke), (self.numbers, numbers)):
            for name, value in kept.items():
                value[rows] = values[name][rows]
        for trace, value in zip(self.trace, traces, strict=True):
            trace[rows, flown[rows]] = value[rows]

    def stroke(self, row: int) -> Stroke:
        """The stroke of a row's last beat."""
        return Stroke(**{name: float(value[row]) for name, value in self._stroke.items()})

    def traces(self, row: int) -> np.ndarray:
        """What was kept of a row's beats so far, shape (traces, beats)."""
        return self.trace[:, row, : self.beats[row]]
