"""The file that the page gives away, which `train.py evaluate` reads."""

import json

from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.aero.stroke import Stroke
from flapenv.insects import INSECTS, Insect


def stroke_text(insect: Insect, stroke: Stroke) -> str:
    """A stroke of an insect as a file holds it."""
    return json.dumps(
        {
            "insect": insect.name if insect.name in INSECTS else insect.to_dict(),
            "stroke": {name: float(getattr(stroke, name)) for name in STROKE_PARAMETERS},
        },
        indent=2,
    )
