"""Targets: what takes words and numbers of a command line, of a dict, or of the explorer's page."""

import argparse
import contextlib
import io
import json
import shlex
from typing import Any

from agents.benchmark.command import benchmark_parser
from agents.benchmark.runner import BenchmarkConfig
from agents.commands import evaluate, explore, optimum, train
from agents.competition import command as compare
from agents.competition.compete import CompetitionConfig
from agents.explorer.cases import EXPLORED, Cases
from agents.explorer.controls import OWN_WING, WING_CONTROLS, read_insect, read_stroke, shown_stroke, stroke_controls
from agents.presets import PRESETS, setting_of
from agents.sweep.command import plan_of, sweep_parser
from agents.training_config import TrainingConfig
from flapenv import INSECTS, load_insect
from flapenv.aero.checks import LONGEST_LINE, require_count
from flapenv.files.plausible import require_insect
from flapenv.insects import as_insect
from flapenv.problem import as_problem
from fuzzing import seeds
from fuzzing.documents import changed
from fuzzing.draw import Draw
from fuzzing.verdict import FindingError

WORDS = (
    "--preset",
    "--algorithm",
    "--list",
    "--config",
    "--seed",
    "--out",
    "--insects",
    "--wing",
    "--problem",
    "--leave-out",
    "--wingbeats",
    "--set",
    "--no-report",
    "--quiet",
    "--noise",
    "--pool-seed",
    "--robustness",
    "--costs",
    "--port",
    "--insect",
    "--no-browser",
    "--presets",
    "--seeds",
    "--jobs",
    "--root",
    "--report",
    "--wings",
    "--competitors",
    "--policy",
    "--problems",
    "--search",
    "--space",
    "--trials",
    "--batch",
    "--storage",
    "--resume",
    "--address",
    "rows=1:8",
    "learning_rate=1e-3:1e-2:log",
    "activation=relu,tanh",
    "2",
    "--help",
    "-h",
    "--",
    "--preset=hover-sac",
    "--seed=1",
    "--out=/",
    "hover",
    "hawkmoth",
    "published",
    "random-wings",
    "hover-ppo",
    "hover-sac",
    "free-frequency",
    "inertial",
    "docs/examples/robot.json",
    "0",
    "1",
    "-1",
    "1e3",
    "3.5",
    "999999999999999999999",
    "nan",
    "rows=64",
    "learning_rate=0.001",
    "rows=[1]",
    "rows=null",
    "wingbeats=1e400",
    "=1",
    "a=",
)
"""Of a command line, in no order."""


def settings(data: bytes) -> Any:
    """`--set NAME=VALUE` on every preset."""
    draw = Draw(data)
    preset = draw.one_of(list(PRESETS.values()))
    own = seeds.plain(vars(preset.settings))
    chosen = {}
    for _ in range(1 + draw.byte() % 3):
        name = draw.one_of(list(own)) if draw.byte() % 8 else draw.text()
        usual = own.get(name)
        how = draw.byte()
        real = isinstance(usual, int | float) and not isinstance(usual, bool)
        value = draw.number(float(usual)) if real and how < 160 else draw.thing()
        if real and how < 80 and isinstance(value, float) and abs(value) < 1e15:
            value = round(value)
        text = draw.text() if how > 240 else json.dumps(value) if how % 8 else str(value)
        key, read = setting_of(f"{name}={text}")
        chosen[key] = read
    return vars(TrainingConfig(preset=preset.changed({}, chosen)).preset.settings)


def training_config(data: bytes) -> Any:
    """`TrainingConfig` from the dict of config.json."""
    draw = Draw(data)
    told = draw.one_of(seeds.config_documents())
    preset = {key: told[key] for key in ("task", "algorithm", "settings")}
    fields: Any = {"preset": preset, "seed": 0, "name": "", "command": ""}
    fields = changed(fields, draw)
    if not isinstance(fields, dict) or not all(isinstance(key, str) for key in fields):
        return None
    return TrainingConfig(**fields).to_dict()


def insect(data: bytes) -> Any:
    """`as_insect` of a dict, and what files allow of it."""
    found = as_insect(changed(seeds.own_insect(), Draw(data)))
    require_insect(found)
    return found


def problem(data: bytes) -> Any:
    """`as_problem` of a dict."""
    draw = Draw(data)
    found = as_problem(changed(draw.one_of(seeds.problem_documents()), draw))
    return found.to_dict()


def page_numbers(data: bytes) -> Any:
    """What the explorer's page sends: a wing, a stroke, names, keys."""
    draw = Draw(data)
    known = {name: load_insect(name) for name in INSECTS}
    name = draw.one_of((OWN_WING, "hawkmoth", "dronefly")) if draw.byte() % 8 else draw.thing()
    own: Any = ["mine", *(control.start for control in WING_CONTROLS)]
    flyer = read_insect(name, changed(own, draw) if draw.byte() % 2 else own, known)
    controls = stroke_controls(flyer)
    usual = [(one.low + one.high) / 2 for one in controls]
    sent: list[Any] = list(usual)
    for _ in range(draw.byte() % 4):
        place = draw.index(len(sent))
        sent[place] = draw.number(usual[place]) if draw.byte() % 4 else draw.thing()
    stroke = read_stroke(sent if draw.byte() % 32 else draw.thing(), flyer)
    key = draw.thing()
    with contextlib.suppress(ValueError):
        _CASES.known(key)
        raise FindingError(f"the key {key!r} is known, which nobody gave out")
    return flyer, stroke, shown_stroke(stroke, flyer)


_CASES = Cases()


def page_answers(data: bytes) -> Any:
    """The explorer's callbacks, of named insects: what they answer is numbers and text that JSON can hold."""
    from agents.explorer.answers import file_text, note, numbers, remarks

    draw = Draw(data)
    name = draw.one_of(("hawkmoth", "fruitfly")) if draw.byte() % 16 else draw.thing()
    explored = draw.one_of(EXPLORED) if draw.byte() % 16 else draw.thing()
    _, case = _CASES.solve(name, None, explored)
    own = shown_stroke(case.insect.stroke, case.insect)
    stroke = read_stroke([draw.number(value) for value in own], case.insect)
    told = [*numbers(case, stroke), *note(case), *(remarks(case, stroke) if draw.byte() % 8 == 0 else ())]
    text = json.dumps([part.to_plotly_json() for part in told], default=lambda part: part.to_plotly_json())
    if "NaN" in text or "Infinity" in text:
        raise FindingError(f"the page is told NaN or inf: {text[:300]}")
    return json.loads(file_text(case, stroke))["strokes"]


def command_line(data: bytes) -> Any:
    """Words of a command line, up to where training, solving or serving would begin."""
    draw = Draw(data)
    name = draw.one_of(("train", "evaluate", "optimum", "explore", "benchmark", "compare", "sweep"))
    words = [draw.one_of(WORDS) if draw.byte() % 8 else draw.text() for _ in range(draw.byte() % 8)]
    said = io.StringIO()
    try:
        with contextlib.redirect_stderr(said), contextlib.redirect_stdout(io.StringIO()):
            return _asked(name, words)
    except SystemExit as end:
        text = said.getvalue()
        if end.code not in (0, 2) or text.count("\n") > 1 or len(text) > 2 * LONGEST_LINE:
            raise FindingError(f"{shlex.join(words)!r} ends with {end.code} and says {text[:500]!r}") from None
        return None


def _asked(name: str, words: list[str]) -> Any:
    """What a command makes of its words before it does anything."""
    parse = {
        "train": train.parser,
        "evaluate": evaluate.parser,
        "optimum": optimum.parser,
        "explore": explore.parser,
        "benchmark": benchmark_parser,
        "compare": compare.parser,
        "sweep": sweep_parser,
    }[name]
    options = _parsed(name, parse).parse_args(words)
    if name == "train":
        if options.list:
            return None
        return train.config_of(options, shlex.join(train.what_counts(words))).to_dict()
    if name == "evaluate":
        return evaluate._asked(options)
    if name == "optimum":
        return [one.to_dict() for _, one in optimum.cases(options)]
    if name == "explore":
        return require_count("--port", options.port, low=0, high=explore.HIGHEST_PORT)
    if name == "benchmark":
        given = {key: getattr(options, key) for key in ("presets", "seeds", "jobs", "wingbeats")}
        if given["seeds"] and given["seeds"] > 1000:
            return None
        return BenchmarkConfig(**{key: value for key, value in given.items() if value is not None})
    if name == "sweep":
        if options.seeds and options.seeds > 100:
            return None
        asked, _ = plan_of(options)
        return asked.to_dict()
    config = CompetitionConfig(
        problem=options.problem,
        insects=options.insects,
        wings=options.wings,
        competitors=options.competitors,
        wingbeats=options.wingbeats,
        seeds=options.seeds,
        policies=options.policy,
    )
    return [config.wings, config.wingbeats, config.seeds]


_PARSERS: dict[str, argparse.ArgumentParser] = {}


def _parsed(name: str, parse: Any) -> argparse.ArgumentParser:
    """A parser, made once."""
    if name not in _PARSERS:
        _PARSERS[name] = parse()
    return _PARSERS[name]
