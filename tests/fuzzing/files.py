"""Targets: what reads a file."""

import atexit
import functools
import hashlib
import json
import shutil
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from safetensors.numpy import save as tensors_as_bytes

from agents.commands.train import read_config, recipe
from agents.policy_card import PolicyCard
from agents.policy_file import load_policy
from agents.presets import as_preset
from agents.training_config import TrainingConfig
from flapenv.assessment import assess
from flapenv.files import NamedStroke, read_strokes, read_wing, strokes_to_text
from flapenv.files.wings import wing_to_text
from flapenv.problem import PROBLEMS
from flapenv.read_json import read_object
from fuzzing import seeds
from fuzzing.documents import changed, damaged, json_bytes
from fuzzing.draw import Draw
from fuzzing.verdict import FindingError

RAW = 0
"""A first byte that is a multiple of four says: the rest is the file itself."""


@functools.cache
def folder() -> Path:
    """Where the files lie that the readers get; gone with the process."""
    made = tempfile.mkdtemp(prefix="fuzz-", dir="/dev/shm" if Path("/dev/shm").is_dir() else None)
    atexit.register(shutil.rmtree, made, ignore_errors=True)
    return Path(made)


def _document(name: str, data: bytes, documents: list[Any]) -> Path:
    """A file of JSON: the bytes themselves, or a document with changes."""
    draw, path = Draw(data), folder() / name
    how = draw.byte()
    if how % 4 == RAW:
        path.write_bytes(draw.rest())
    else:
        document = changed(draw.one_of(documents), draw)
        path.write_bytes(json_bytes(document, draw))
    return path


def _table(name: str, data: bytes, text: str) -> Path:
    """A file of CSV: the bytes themselves, or a table with changes."""
    draw, path = Draw(data), folder() / name
    if draw.byte() % 4 == RAW:
        path.write_bytes(draw.rest())
        return path
    rows = [line.split(",") for line in text.splitlines()]
    for _ in range(draw.byte() % 6):
        row, how = draw.one_of(rows), draw.byte() % 8
        place = draw.index(len(row))
        if how < 4:
            row[place] = str(draw.number(float(row[place]) if row[place].replace(".", "").isdigit() else 1.0))
        elif how == 4:
            row[place] = draw.text().encode(errors="replace").decode()
        elif how == 5:
            row.insert(place, draw.text().encode(errors="replace").decode())
        elif how == 6 and len(row) > 1:
            del row[place]
        else:
            rows.insert(draw.index(len(rows)), list(row))
    path.write_bytes(damaged("\n".join(map(",".join, rows)).encode(), draw))
    return path


def json_object(data: bytes) -> Any:
    """`read_object`, of any bytes; what it takes, it takes again as it is written."""
    path = folder() / "any.json"
    path.write_bytes(data)
    found = read_object(path)
    path.write_text(json.dumps(found, allow_nan=False), encoding="utf-8")
    if read_object(path) != found:
        raise FindingError("JSON that was read is another when it is written and read again")
    return found


def strokes_json(data: bytes) -> Any:
    """`read_strokes` of JSON; what it takes, it can write and read again."""
    found = read_strokes(_document("strokes.json", data, seeds.stroke_documents()))
    again = folder() / "again.json"
    again.write_text(strokes_to_text(found), encoding="utf-8")
    if read_strokes(again) != found:
        raise FindingError("strokes that were read are others when they are written and read again")
    return found


def strokes_csv(data: bytes) -> Any:
    """`read_strokes` of CSV."""
    return read_strokes(_table("strokes.csv", data, seeds.STROKE_TABLE))


def wing(data: bytes) -> Any:
    """`read_wing`, and the problem within its limits; what it takes, it can write and read again."""
    (folder() / "planform.csv").write_text(seeds.PLANFORM_TABLE)
    found = read_wing(_document("wing.json", data, seeds.wing_documents()))
    again = folder() / "again.json"
    again.write_text(wing_to_text(found), encoding="utf-8")
    if read_wing(again) != found:
        raise FindingError("a wing that was read is another when it is written and read again")
    return found, found.problem(PROBLEMS["free-frequency"])


def planform(data: bytes) -> Any:
    """`read_wing` with its planform in a CSV file."""
    _table("planform.csv", data, seeds.PLANFORM_TABLE)
    path = folder() / "beside.json"
    path.write_text(json.dumps(seeds.wing_documents()[-1]), encoding="utf-8")
    return read_wing(path)


def judged_strokes(data: bytes) -> Any:
    """Strokes of named insects that a file may hold, judged as `evaluate` does it."""
    draw = Draw(data)
    named = draw.one_of(("hawkmoth", "fruitfly"))
    stroke = dict(seeds.stroke_documents()[0]["strokes"][0])
    stroke.pop("insect")
    for name in stroke:
        stroke[name] = draw.number(stroke[name])
    one = NamedStroke(stroke=stroke, insect=named)
    return assess(one.insect, one.stroke).to_dict()


def config(data: bytes) -> Any:
    """`train.py --config FILE`, up to the training."""
    path = _document("config.json", data, seeds.config_documents())
    told = read_config(path, str(path))
    return TrainingConfig(preset=as_preset(recipe(told)), name=told["preset"], seed=told["seed"]).to_dict()


def policy(data: bytes) -> Any:
    """`load_policy`, past the checksum, and a flight of what it takes."""
    draw = Draw(data)
    card, content, tensors = draw.one_of(seeds.policies())
    how = draw.byte()
    if how % 4 == RAW:
        content = draw.rest()
    elif how % 4 == 1:
        content = tensors_as_bytes(changed_arrays(tensors, draw))
    elif how % 4 == 2:
        content = damaged_header(content, draw)
    card = {**card, "sha256": hashlib.sha256(content).hexdigest()}
    if how >= 128:
        card = changed(card, draw)
    path = folder() / "policy.safetensors"
    path.write_bytes(content)
    path.with_suffix(".json").write_bytes(json_bytes(card, draw) if how >= 128 else json.dumps(card).encode())
    actor, found = load_policy(path)
    getattr(actor, "start", lambda: None)()
    actions, _ = actor.predict(np.zeros((2, actor.observation_size), np.float32))
    again = PolicyCard.from_dict(json.loads(json.dumps(found.to_dict())))
    if again != found:
        raise FindingError("a card that was read is another when it is written and read again")
    return actions


def changed_arrays(tensors: dict[str, np.ndarray], draw: Draw) -> dict[str, np.ndarray]:
    """Tensors with one left out, renamed, reshaped, of another type, or with odd numbers."""
    made = dict(tensors)
    for _ in range(1 + draw.byte() % 3):
        name = draw.one_of(sorted(made)) if made else "layers.0.weight"
        array, how = made.pop(name, np.zeros((1, 1), np.float32)), draw.byte() % 6
        if how == 0:
            continue
        if how == 1:
            name = f"layers.{draw.byte()}.weight"
        elif how == 2 and array.ndim:
            array = array[: draw.byte()]
        elif how == 3:
            with np.errstate(all="ignore"):
                array = array.astype(draw.one_of(("float64", "float16", "int8", "int64", "bool")))
        elif how == 4 and array.dtype == np.float32 and array.size:
            array = array.copy()
            array.flat[draw.index(array.size)] = np.frombuffer(draw.take(4), np.float32)[0]
        else:
            array = array.reshape(-1) if draw.byte() % 2 else array.T.copy()
        made[name] = np.ascontiguousarray(array)
    return made


def damaged_header(content: bytes, draw: Draw) -> bytes:
    """Weights whose header says something else."""
    size = int.from_bytes(content[:8], "little")
    header = changed(json.loads(content[8 : 8 + size]), draw)
    text = json_bytes(header, draw)
    told = len(text) if draw.byte() % 8 else int.from_bytes(draw.take(8), "little")
    return told.to_bytes(8, "little") + text + content[8 + size :]
