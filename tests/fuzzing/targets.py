"""The table of targets: what is fuzzed, its share of the inputs, and what the fuzzers begin with."""

import bisect
import json
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any

from fuzzing import checkpoints, environments, files, seeds, settings, sweeps

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
        share=60,
        corpus=[raw[1:] for raw in _raw([*seeds.stroke_documents(), {"a": [1, -2.5e-3, None, True, "\u00e9"]}])],
        longest=2000,
    ),
    "strokes-json": Target(call=files.strokes_json, share=12, corpus=_raw(seeds.stroke_documents()), longest=4000),
    "strokes-csv": Target(call=files.strokes_csv, share=12, corpus=[RAW + seeds.STROKE_TABLE.encode()], longest=600),
    "strokes-judged": Target(call=files.judged_strokes, share=0.3),
    "wing-json": Target(call=files.wing, share=10, corpus=_raw(seeds.wing_documents()), longest=3000),
    "planform-csv": Target(call=files.planform, share=8, corpus=[RAW + seeds.PLANFORM_TABLE.encode()], longest=400),
    "config-json": Target(call=files.config, share=8, corpus=_raw(seeds.config_documents()), longest=3000),
    "policy": Target(call=files.policy, share=6),
    "checkpoint": Target(call=checkpoints.checkpoint, share=3),
    "sweep-json": Target(call=sweeps.plan, share=4, corpus=_raw(sweeps.plan_documents()), longest=2000),
    "space-json": Target(call=sweeps.space, share=8, corpus=_raw(sweeps.space_documents()), longest=1000),
    "search-words": Target(call=sweeps.search_words, share=10),
    "run-results": Target(call=sweeps.results, share=8, corpus=_raw(sweeps.result_documents()), longest=1000),
    "search-journal": Target(call=sweeps.journal, share=0.5),
    "settings": Target(call=settings.settings, share=14),
    "training-config": Target(call=settings.training_config, share=8),
    "insect": Target(call=settings.insect, share=14),
    "problem": Target(call=settings.problem, share=14),
    "page-numbers": Target(call=settings.page_numbers, share=20),
    "page-answers": Target(call=settings.page_answers, share=0.3),
    "command-line": Target(call=settings.command_line, share=3),
    **{f"actions-{name}": Target(call=environments.actions(env), share=5) for name, env in environments.NAMES.items()},
    **{
        f"reset-{name}": Target(call=environments.reset_options(env), share=4)
        for name, env in environments.NAMES.items()
    },
    **{
        f"arguments-{name}": Target(call=environments.arguments(env), share=0.5)
        for name, env in environments.NAMES.items()
    },
    **{
        f"insects-{name}": Target(call=environments.insects_flown(env), share=0.03 if name == "hover" else 0.5)
        for name, env in environments.NAMES.items()
    },
    "problems-hover": Target(call=environments.problems_flown(environments.NAMES["hover"]), share=0.03),
    "problems-waveform": Target(call=environments.problems_flown(environments.NAMES["waveform"]), share=0.5),
}
"""By name, what `python -m tests.fuzzing --target NAME` knows."""

TOGETHER = "together"
"""All targets as one, the first two bytes of an input saying which; slow ones come as seldom as their share says."""


def target_of(name: str) -> Target:
    """A target by name, or all together."""
    return _together() if name == TOGETHER else TARGETS[name]


def _together() -> Target:
    """One target that is all of them."""
    names, shares = list(TARGETS), [target.share for target in TARGETS.values()]
    ends = [sum(shares[: number + 1]) / sum(shares) for number in range(len(names))]

    def call(data: bytes) -> Any:
        place = int.from_bytes(data[:2].ljust(2, b"\0"), "big") / 65536
        return TARGETS[names[bisect.bisect_right(ends, place)]].call(data[2:])

    corpus = [
        int(65536 * (end - share / sum(shares) / 2)).to_bytes(2, "big") + one
        for end, share, target in zip(ends, shares, TARGETS.values(), strict=True)
        for one in (*SPREAD[:3], *list(target.corpus)[:2])
    ]
    return Target(call=call, share=1, corpus=corpus, longest=4000)
