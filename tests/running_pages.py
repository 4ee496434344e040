"""Pages of docs/ that are run as a reader would: Python in order, then the shell commands that take seconds.

What is printed by plain physics stands in `text` blocks and must be so to the letter; what a policy or a search printed
stands in indented blocks, whose numbers may differ from machine to machine.
"""

import contextlib
import io
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

DOCS = Path(__file__).parents[1] / "docs"
FENCE = re.compile(r"^```(\w+)\n(.*?)^```$", flags=re.DOTALL | re.MULTILINE)


def run_python(page: Path, names: dict[str, object] | None = None) -> dict[str, object]:
    """Run every Python block in order, compare what it prints with the text block that follows; the names it leaves."""
    names = {"__name__": "page"} if names is None else names
    fences = FENCE.findall(page.read_text(encoding="utf-8"))
    assert any(language == "python" for language, _ in fences), f"{page.name} has no Python"
    for (language, block), (following, expected) in zip(fences, [*fences[1:], ("", "")], strict=True):
        if language != "python":
            continue
        with contextlib.redirect_stdout(io.StringIO()) as printed:
            exec(compile(block, page.name, "exec", dont_inherit=True), names)
        if following == "text":
            assert printed.getvalue() == expected, f"{page.name} prints otherwise:\n{printed.getvalue()}"
    return names


def run_shell(page: Path) -> dict[str, str]:
    """Run every command of the `sh` blocks where the process stands, as in a clone; what each printed."""
    printed = {}
    fences = FENCE.findall(page.read_text(encoding="utf-8"))
    blocks = [block.replace("\\\n", " ") for language, block in fences if language == "sh"]
    commands = [line for block in blocks for line in block.splitlines()]
    assert commands, f"{page.name} has no command"
    environment = {**os.environ, "PYTHONPATH": str(DOCS.parent), "OMP_NUM_THREADS": "1"}
    for command in commands:
        words = shlex.split(command, comments=True)
        assert words[0] == "python", f"{page.name}: {command}"
        words = [str(DOCS.parent / word) if word == "train.py" else word for word in words[1:]]
        done = subprocess.run([sys.executable, *words], env=environment, capture_output=True, text=True, check=False)
        assert done.returncode == 0, f"{page.name}: {command}\n{done.stdout}{done.stderr}"
        printed[command] = done.stdout
    return printed


def require_quoted(page: Path, printed: str) -> None:
    """Require that every indented line of a page, but "...", was printed, whatever its numbers."""
    text = FENCE.sub("", page.read_text(encoding="utf-8"))
    quoted = [line for line in text.splitlines() if line.startswith("    ") and line.strip() != "..."]
    assert quoted, f"{page.name} quotes nothing"
    known = {_shape(line) for line in printed.splitlines()}
    for line in quoted:
        assert _shape(line) in known, f"{page.name} quotes what is not printed: {line}\n{printed}"


def _shape(line: str) -> str:
    """A line without its numbers and the width of its columns."""
    return re.sub(r"-{3,}", "---", re.sub(r"[-+]?\d[\d.,]*(e[-+]\d+)?", "#", " ".join(line.split())))
