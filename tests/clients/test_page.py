"""docs/clients.md: its code runs, and what it names is there."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "clients.md").read_text(encoding="utf-8")
MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")


def test_every_code_block_runs_in_order(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    for block in re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL):
        exec(compile(block, "clients.md", "exec"), names)
    assert "batch" in names


def test_every_make_target_and_file_it_names_is_there() -> None:
    targets = set(re.findall(r"make ([a-z-]+)`", PAGE))
    assert {"clients", "client-ppo", "client-zoo", "client-rllib", "test-floor"} <= targets
    for target in targets:
        assert re.search(rf"^{target}:", MAKEFILE, flags=re.MULTILINE), target
    for link in re.findall(r"\]\((?!http)([^)#]+)\)", PAGE):
        assert (ROOT / "docs" / link).exists(), link


def test_the_command_of_rl_zoo3_is_the_one_that_make_runs() -> None:
    (command,) = re.findall(r"    (python -m rl_zoo3\.train .*?)\n\n", PAGE, flags=re.DOTALL)
    (recipe,) = re.findall(r"\$\(ZOO\)/bin/(python -m rl_zoo3.*?) \$\(ARGS\)", MAKEFILE, flags=re.DOTALL)
    for variable in ("ENV_ID", "ZOO_ALGO"):
        (default,) = re.findall(rf"^{variable} \?= (\S+)", MAKEFILE, flags=re.MULTILINE)
        recipe = recipe.replace(f"$({variable})", default)
    assert command.replace("\\", "").split() == recipe.replace("\\", "").split()
