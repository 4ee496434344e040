"""Target: checkpoints, read from their files and put into a learner that then goes on."""

import functools
import hashlib
import json
from typing import Any

import numpy as np
from safetensors.numpy import save as arrays_as_bytes

from agents.checkpoint import STATE, learner_state, read_checkpoint, restore_learner
from agents.checkpoint.files import FORMAT
from agents.presets import PRESETS
from agents.vec_env import GymnasiumVecEnv
from flapenv.whole_file import json_text
from fuzzing.documents import changed, json_bytes
from fuzzing.draw import Draw
from fuzzing.files import changed_arrays, damaged_header, folder
from fuzzing.seeds import plain
from fuzzing.verdict import require_finite

SMALL: dict[str, dict[str, Any]] = {
    "hover-ppo": {"rows": 4, "minibatch": 4, "width": 8},
    "hover-sac": {"rows": 4, "learning_starts": 4, "buffer": 16, "batch": 4, "width": 8, "critic_width": 8},
    "heave-ppo": {"rows": 4, "steps": 2, "minibatch": 4, "width": 8},
}


@functools.cache
def learner(name: str) -> tuple[Any, dict[str, Any], dict[str, np.ndarray]]:
    """A learner before its first rollout, and what its checkpoint holds."""
    known = vars(PRESETS[name].settings)
    preset = PRESETS[name].changed({}, {key: value for key, value in SMALL[name].items() if key in known})
    model = preset.settings.build(GymnasiumVecEnv(preset.make_task().vector_env(preset.settings.rows)), 0)
    model._setup_learn(total_timesteps=100)
    state = learner_state(model)
    return model, plain(state.numbers), {key: np.array(array) for key, array in state.arrays.items()}


def checkpoint(data: bytes) -> Any:
    """`read_checkpoint` past its checksums, `restore_learner`, and a beat of what it takes."""
    draw = Draw(data)
    model, numbers, arrays = learner(draw.one_of(tuple(SMALL)))
    how, place = draw.byte(), folder() / "checkpoint"
    place.mkdir(exist_ok=True)
    if how % 4 == 1:
        arrays = changed_arrays(arrays, draw)
    content = arrays_as_bytes(arrays)
    if how % 4 == 2:
        content = damaged_header(content, draw)
    (place / "arrays-0.safetensors").write_bytes(content)
    digest = hashlib.sha256(content).hexdigest()
    told = {"file": "arrays-0.safetensors", "bytes": len(content), "sha256": digest}
    state = {"format": FORMAT, "arrays": told, **numbers}
    if how >= 96:
        state = changed(state, draw)
    if isinstance(state, dict) and how % 8:
        state.pop("sha256", None)
        try:
            state["sha256"] = hashlib.sha256(json_text(state).encode()).hexdigest()
        except (TypeError, ValueError):  # NaN, or halves of characters
            state["sha256"] = ""
    (place / STATE).write_bytes(json_bytes(state, draw) if how >= 224 else json.dumps(state).encode())
    found = read_checkpoint(place)
    assert found is not None
    restore_learner(model, found)
    actions, _ = model.predict(model._last_obs, deterministic=True)
    seen, rewards, _, _ = model.env.step(actions)
    require_finite([actions, seen, rewards], "beat")
    return None
