"""Targets: what a sweep reads: its plan, a search space, the search's journal, and results of its runs."""

import functools
import json
from pathlib import Path
from typing import Any

from agents.run_folder import RESULTS
from agents.sweep.plan import SweepPlan
from agents.sweep.runs import result_of
from agents.sweep.search_space import Choices, Range, dimension_of, read_space
from agents.sweep.storage import PLAN, read_plan
from agents.sweep.study import Study
from fuzzing.documents import changed, damaged, json_bytes
from fuzzing.draw import Draw
from fuzzing.files import RAW, folder
from fuzzing.verdict import FindingError

MANY_SEEDS = 8
"""A plan of more is not made: every run of it is."""
WORDS = ("1", "8", "1e-3", "-1", "log", "relu", "true", "null", "nan", "1e999", "rows=", ":", ",", "=")


@functools.cache
def search() -> SweepPlan:
    """A search with a range and choices."""
    space = {"learning_rate": Range(low=1e-4, high=1e-2, log=True), "width": Choices(values=[16, 32, 64])}
    return SweepPlan(presets=["hover-ppo"], seeds=2, search=space, trials=4, batch=2)


@functools.cache
def plan_documents() -> list[Any]:
    """sweep.json of a sweep and of a search."""
    plain = SweepPlan(
        presets=["hover-ppo", "hover-sac"], problems=["A", "C"], insects=["hawkmoth"], seeds=2, settings={"rows": 64}
    )
    return [{"plan": one.to_dict()} for one in (plain, search())]


@functools.cache
def space_documents() -> list[Any]:
    """Search spaces."""
    return [search().to_dict()["search"], {"rows": {"low": 1, "high": 8}}]


@functools.cache
def result_documents() -> list[Any]:
    """What results.json of a run tells."""
    verdict = {"mean": 0.01, "worst": 0.02, "distance": "gap to the optimum"}
    return [{"verdict": verdict, "seconds": 1.5, "wingbeats": 4096, "interrupted": False}]


@functools.cache
def journal_lines() -> tuple[bytes, ...]:
    """A journal as Optuna writes it, of trials of all kinds."""
    path = folder() / "seed.jsonl"
    study = Study(search(), path)
    study.batch()
    study.tell(0, 0.1)
    study.tell(1, None, {"trial0001-seed0": "diverged"})
    study.batch()
    return tuple(path.read_bytes().splitlines(keepends=True))


def _written(path: Path, data: bytes, documents: list[Any]) -> None:
    """A file of JSON: the bytes themselves, or a document with changes."""
    draw = Draw(data)
    if draw.byte() % 4 == RAW:
        path.write_bytes(draw.rest())
        return
    document = changed(draw.one_of(documents), draw)
    if isinstance(document, dict) and isinstance(document.get("plan"), dict):
        seeds = document["plan"].get("seeds")
        if isinstance(seeds, int) and seeds > MANY_SEEDS:
            document["plan"]["seeds"] = MANY_SEEDS
    path.write_bytes(json_bytes(document, draw))


def plan(data: bytes) -> Any:
    """`read_plan`; what it takes, it can write and read again."""
    path = folder() / PLAN
    _written(path, data, plan_documents())
    found = read_plan(folder())
    path.write_text(json.dumps({"plan": found.to_dict()}), encoding="utf-8")
    if read_plan(folder()) != found:
        raise FindingError("a plan that was read is another when it is written and read again")
    return found.to_dict()


def space(data: bytes) -> Any:
    """`read_space`."""
    path = folder() / "space.json"
    _written(path, data, space_documents())
    return [one.to_json() for one in read_space(path).values()]


def search_words(data: bytes) -> Any:
    """`--search NAME=SPACE`."""
    draw = Draw(data)
    words = [draw.one_of(WORDS) if draw.byte() % 8 else draw.text() for _ in range(1 + draw.byte() % 4)]
    text = draw.one_of((":", ",", "")).join(words)
    return dimension_of(f"width={text}" if draw.byte() % 4 else text)[1].to_json()


def results(data: bytes) -> Any:
    """`result_of` of a run."""
    run = search().runs_of_trial(0, {})[0]
    (folder() / run.name).mkdir(exist_ok=True)
    _written(folder() / run.name / RESULTS, data, result_documents())
    found = result_of(run, folder())
    return found.mean, found.worst, found.wingbeats, found.seconds


def journal(data: bytes) -> Any:
    """`Study` of a journal with lines changed, left out and put elsewhere; what it would try next."""
    draw, path, lines = Draw(data), folder() / "search.jsonl", list(journal_lines())
    for _ in range(draw.byte() % 4):
        place, how = draw.index(len(lines)), draw.byte() % 4
        if how == 0 and len(lines) > 1:
            del lines[place]
        elif how == 1:
            lines.insert(draw.index(len(lines)), lines[place])
        elif how == 2:
            told = json.loads(draw.one_of(journal_lines()))
            lines[place] = json.dumps(changed(told, draw)).encode() + b"\n"
        else:
            lines[place] = damaged(lines[place], draw)
    path.write_bytes(b"".join(lines) if draw.byte() % 16 else draw.rest())
    study = Study(search(), path)
    return [dict(one.chosen) for one in study.batch()], [one.value for one in study.trials()]
