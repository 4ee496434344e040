"""A page for every environment, made from its docstring, so that help() and the documentation cannot differ."""

import inspect
from pathlib import Path

import gymnasium as gym
from gymnasium.envs.registration import load_env_creator

from flapenv.envs.arguments import arguments_of
from flapenv.envs.describe import markdown_table
from flapenv.envs.registration import ENV_IDS


def page(env_id: str) -> str:
    """The page of an environment: its docstring under its id, and every argument with its default.

    Args:
        env_id: one of `ENV_IDS`.

    Returns:
        Markdown.
    """
    entry_point = gym.spec(env_id).entry_point
    assert isinstance(entry_point, str)
    environment = load_env_creator(entry_point)
    batch = vars(environment)["batch_class"]
    body = inspect.getdoc(environment) or ""
    return "\n".join(
        [
            f"# {env_id}",
            "",
            body,
            "",
            "## Arguments in full",
            "",
            "`gymnasium.make_vec` takes all of them, `gymnasium.make` all but `num_envs` and `autoreset_mode`.",
            "",
            markdown_table(("Argument", "Default", "Meaning"), argument_rows(batch)),
            "",
        ]
    )


def argument_rows(batch: type) -> list[tuple[str, str, str]]:
    """Name, default and meaning of every argument of a batched environment, as its docstring has them."""
    meanings = _documented_arguments(inspect.getdoc(vars(batch)["__init__"]) or "")
    parameters = inspect.signature(batch).parameters
    rows = []
    for name in arguments_of(batch):
        default = parameters[name].default
        shown = getattr(default, "name", default) if hasattr(default, "name") else default
        rows.append((f"`{name}`", f"`{shown!r}`", meanings[name].replace("|", "\\|")))
    return rows


def _documented_arguments(docstring: str) -> dict[str, str]:
    """The Args section of a Google docstring by name, each on one line."""
    lines = docstring.splitlines()
    meanings: dict[str, str] = {}
    name = ""
    for line in lines[lines.index("Args:") + 1 :]:
        if not line.strip():
            break
        if line.startswith("    ") and not line.startswith("     "):
            name, _, meaning = line.strip().partition(": ")
            meanings[name] = meaning
        else:
            meanings[name] += f" {line.strip()}"
    return meanings


def write_pages(folder: Path) -> list[Path]:
    """Write every environment's page into a folder; the files."""
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for env_id in ENV_IDS:
        path = folder / f"{env_id.split('/')[1].lower()}.md"
        path.write_text(page(env_id), encoding="utf-8")
        written.append(path)
    return written
