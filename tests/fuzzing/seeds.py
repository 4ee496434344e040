"""Valid documents that the fuzzers begin with, made in code from what the project itself writes."""

import functools
import json
from pathlib import Path
from typing import Any

from safetensors.numpy import load as load_tensors

from agents.policy_file import shipped_policies
from agents.presets import PRESETS
from agents.training_config import TrainingConfig
from flapenv import PROBLEMS, load_insect
from flapenv.files import NamedStroke, WingFile, strokes_to_text
from flapenv.files.wings import wing_to_text

ROOT = Path(__file__).parents[2]
TABLE_RADII, TABLE_CHORDS = (0.0, 0.02, 0.035, 0.05), (0.01, 0.015, 0.01, 0.0)


def plain(value: Any) -> Any:
    """As JSON gives it back."""
    return json.loads(json.dumps(value))


@functools.cache
def own_insect() -> dict[str, Any]:
    """An insect under its own name, every optional field told."""
    return {**plain(load_insect("bumblebee").to_dict()), "name": "mine"}


@functools.cache
def stroke_documents() -> list[Any]:
    """Stroke files, and the results of a run."""
    stroke = load_insect("hawkmoth").stroke
    named = NamedStroke(stroke=stroke, insect="hawkmoth")
    own = NamedStroke(stroke=stroke, insect=own_insect())
    texts = (strokes_to_text([named]), strokes_to_text([own, NamedStroke(stroke=stroke)]))
    entry = {"stroke": {name: float(value) for name, value in vars(stroke).items()}}
    results = {"insects": {"hawkmoth": entry, "mine": {**entry, "insect": own_insect()}}, "seed": 0}
    return [*map(json.loads, texts), results]


@functools.cache
def wing_documents() -> list[Any]:
    """Wing files: three numbers, a planform in metres, one relative, one in a file beside."""
    robot = json.loads((ROOT / "docs/examples/robot.json").read_text(encoding="utf-8"))
    robot["wing"]["planform_file"] = "planform.csv"  # beside it, as in `files.wing`
    insect = load_insect("bumblebee")
    made = json.loads(wing_to_text(WingFile(insect=as_own(insect), limits={"frequency": (100.0, 200.0)})))
    table = {"planform": {"radius": list(TABLE_RADII), "chord": list(TABLE_CHORDS)}, "mass": 1e-5}
    relative = {"length": 0.05, "mean_chord": 0.018, "planform": {"r_hat": [0.0, 0.5, 1.0], "chord": [1.0, 1.0, 0.5]}}
    beside = {"planform_file": "planform.csv", "pitch_axis": 0.3}
    return [robot, made, *({**robot, "wing": wing} for wing in (table, relative, beside))]


def as_own(insect: Any) -> Any:
    """One of the eight under another name."""
    import dataclasses

    return dataclasses.replace(insect, name="mine")


STROKE_TABLE = (
    "insect,frequency [Hz],flap_amplitude [rad],flap_shape [-],pitch_shape [-],pitch_amplitude [rad],"
    "pitch_phase [rad]\n"
    "hawkmoth,26.3,1.0,0.1,0.5,0.9,1.57\n"
    ",30,1.1,0.5,2,0.8,1.5\n"
)
PLANFORM_TABLE = "radius [m],chord [m]\n0,0.01\n0.02,0.015\n0.035,0.01\n0.05,0\n"


@functools.cache
def config_documents() -> list[Any]:
    """config.json of every preset."""
    return [plain(TrainingConfig(preset=name).to_dict()) for name in PRESETS]


@functools.cache
def problem_documents() -> list[Any]:
    """The named problems that are solved in a moment, and two with little told."""
    told = [plain(problem.to_dict()) for name, problem in PROBLEMS.items() if name != "inertial"]  # takes seconds
    return [*told, {}, {"box": {"frequency": [20.0, 200.0]}, "model": {"air_density": 1.2}}]


@functools.cache
def policies() -> list[tuple[dict[str, Any], bytes, dict[str, Any]]]:
    """Small ones of the shipped policies: card, weights as the file holds them, tensors."""
    found = []
    for path in shipped_policies().values():
        content = path.read_bytes()
        found.append(
            (json.loads(path.with_suffix(".json").read_text(encoding="utf-8")), content, load_tensors(content))
        )
    return found
