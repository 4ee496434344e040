"""The table of targets: what is fuzzed, its share of the inputs, and what the fuzzers begin with."""

import json
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any

from fuzzing import environments, files, seeds, settings

RAW = bytes([files.RAW])


@dataclass(frozen=True, kw_only=True)
class Target:
    """One thing that is fuzzed.

    Attributes:
        call: of bytes; returns numbers, or raises.
        share: of the inputs, beside the others' shares.
        corpus: bytes to begin with, beside `SPREAD`.
        longest: bytes of an input at most.
    """

    call: Callable[[bytes], Any]
    share: float
    corpus: Iterable[bytes] = field(default=())
    longest: int = 256


SPREAD = tuple(
    bytes((start + step * number) % 256 for number in range(96)) for start in range(8) for step in (0, 7, 37)
)
"""Inputs that make various choices, for every target."""


def _raw(documents: Iterable[Any]) -> tuple[bytes, ...]:
    """Documents as they are."""
    return tuple(RAW + json.dumps(one).encode() for one in documents)


TARGETS: dict[str, Target] = {
    "json": Target(
        call=files.json_object,
        share=25,
        corpus=[raw[1:] for raw in _raw([*seeds.stroke_documents(), {"a": [1, -2.5e-3, None, True, "\u00e9"]}])],
        longest=2000,
    ),
    "strokes-json": Target(call=files.strokes_json, share=20, corpus=_raw(seeds.stroke_documents()), longest=4000),
    "strokes-csv": Target(call=files.strokes_csv, share=16, corpus=[RAW + seeds.STROKE_TABLE.encode()], longest=600),
    "strokes-judged": Target(call=files.judged_strokes, share=2),
    "wing-json": Target(call=files.wing, share=16, corpus=_raw(seeds.wing_documents()), longest=3000),
    "planform-csv": Target(call=files.planform, share=16, corpus=[RAW + seeds.PLANFORM_TABLE.encode()], longest=400),
    "config-json": Target(call=files.config, share=12, corpus=_raw(seeds.config_documents()), longest=3000),
    "policy": Target(call=files.policy, share=12),
    "settings": Target(call=settings.settings, share=16),
    "training-config": Target(call=settings.training_config, share=10),
    "insect": Target(call=settings.insect, share=16),
    "problem": Target(call=settings.problem, share=16),
    "page-numbers": Target(call=settings.page_numbers, share=16),
    "page-answers": Target(call=settings.page_answers, share=2),
    "command-line": Target(call=settings.command_line, share=6),
    **{f"actions-{name}": Target(call=environments.actions(env), share=8) for name, env in environments.NAMES.items()},
    **{
        f"reset-{name}": Target(call=environments.reset_options(env), share=6)
        for name, env in environments.NAMES.items()
    },
    **{
        f"arguments-{name}": Target(call=environments.arguments(env), share=1)
        for name, env in environments.NAMES.items()
    },
    **{
        f"insects-{name}": Target(call=environments.insects_flown(env), share=0.1 if name == "hover" else 1)
        for name, env in environments.NAMES.items()
    },
    "problems-hover": Target(call=environments.problems_flown(environments.NAMES["hover"]), share=0.1),
    "problems-waveform": Target(call=environments.problems_flown(environments.NAMES["waveform"]), share=1),
}
"""By name, what `python -m tests.fuzzing --target NAME` knows."""
