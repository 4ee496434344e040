"""`train.py explore`: one line for what is wrong, the loopback alone, and a quiet end."""

import contextlib
import socket
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from werkzeug.serving import BaseWSGIServer

import train
from agents.commands import explore as explore_command


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--port", "65536"], "--port = 65536 is not allowed; allowed: whole numbers from 0 to 65535"),
        (["--port", "-1"], "--port = -1 is not allowed"),
        (["--insect", "hawkmot"], "did you mean 'hawkmoth'?"),
        (["--wing", "nowhere.json"], "nowhere.json does not exist"),
    ],
)
def test_a_mistake_is_told_in_one_line(arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert train.main(["explore", "--no-browser", *arguments, *([] if "--port" in arguments else ["--port", "0"])]) == 2
    told = capsys.readouterr().err
    assert message in told
    assert told.count("\n") == 1


def test_a_port_that_is_taken_is_told_in_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    with contextlib.closing(explore_command.listen(0)) as taken:
        port = taken.getsockname()[1]
        assert train.main(["explore", "--no-browser", "--port", str(port)]) == 2
    told = capsys.readouterr().err
    assert f"port {port} of 127.0.0.1 is not free" in told
    assert told.count("\n") == 1


@pytest.mark.parametrize("missing", ["dash", "flask", "plotly", "jinja2"])
def test_what_is_missing_is_told_with_its_mend(missing: str) -> None:
    """In a process of its own, which has imported nothing yet."""
    asked = f"import sys; sys.modules[{missing!r}] = None; import train; sys.exit(train.main(sys.argv[1:]))"
    command = [sys.executable, "-c", asked, "explore", "--no-browser", "--port", "0"]
    root = Path(train.__file__).parent
    ended = subprocess.run(command, check=False, cwd=root, capture_output=True, text=True, timeout=60)
    assert ended.returncode == 2
    assert missing in ended.stderr
    assert "pip install -e '.[explore]'" in ended.stderr
    assert ended.stderr.count("\n") == 1


def test_nothing_but_the_loopback_is_listened_on() -> None:
    with contextlib.closing(explore_command.listen(0)) as listening:
        assert listening.family == socket.AF_INET
        assert listening.getsockname()[0] == "127.0.0.1"


def test_the_address_is_printed_a_browser_opened_and_ctrl_c_ends_it_quietly(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    opened: list[str] = []

    def interrupted(server: BaseWSGIServer, **_: Any) -> None:
        server.server_close()
        raise KeyboardInterrupt

    monkeypatch.setattr(BaseWSGIServer, "serve_forever", interrupted)
    monkeypatch.setattr("webbrowser.open", opened.append)
    assert train.main(["explore", "--port", "0", "--insect", "hawkmoth"]) == 0
    told = capsys.readouterr()
    assert told.err == ""
    (address,) = opened
    assert address.startswith("http://127.0.0.1:")
    assert address in told.out
    assert train.main(["explore", "--port", "0", "--no-browser"]) == 0
    assert opened == [address]
