"""How Ray is started: for nobody else, heard by nobody else, and silent; without Ray itself."""

import os
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from agents.sweep import cluster
from agents.sweep.cluster import reached, require_head, started


class FakeRay(ModuleType):
    """Keeps what it was started with."""

    def __init__(self) -> None:
        super().__init__("ray")
        self.how: dict[str, Any] = {}
        self.environment: dict[str, str] = {}
        self.ended = 0
        self.fails: BaseException | None = None

    def init(self, **how: Any) -> None:
        self.how, self.environment = how, dict(os.environ)
        print("started")
        if self.fails is not None:
            raise self.fails

    def shutdown(self) -> None:
        print("ended")
        self.ended += 1


@pytest.fixture
def ray(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[FakeRay]:
    fake, before = FakeRay(), dict(os.environ)
    monkeypatch.setitem(sys.modules, "ray", fake)
    monkeypatch.setattr(cluster.tempfile, "mkdtemp", lambda prefix, **_: _made(tmp_path / f"{prefix}xyz"))
    monkeypatch.setattr(cluster, "_remove_left", lambda place: None)
    yield fake
    os.environ.clear()
    os.environ.update(before)


def _made(folder: Path) -> str:
    folder.mkdir()
    return str(folder)


def test_a_local_cluster_asks_for_a_token_that_is_new_each_time_and_listens_on_the_loopback(
    ray: FakeRay, tmp_path: Path
) -> None:
    tokens = set()
    for _ in range(2):
        os.environ["RAY_ADDRESS"] = "10.0.0.1:6379"  # of some other cluster
        with started(3):
            assert Path(ray.how["_temp_dir"]) == tmp_path / f"flapenv-{os.getpid()}-xyz"
            assert Path(ray.how["_temp_dir"]).is_dir()
        assert not Path(ray.how["_temp_dir"]).exists()
        assert ray.how["_node_ip_address"] == "127.0.0.1"
        assert ray.how["num_cpus"] == 3
        assert ray.how["include_dashboard"] is False
        assert ray.environment["RAY_AUTH_MODE"] == "token"
        assert ray.environment["RAY_ENABLE_WINDOWS_OR_OSX_CLUSTER"] == "0"
        assert ray.environment["RAY_USAGE_STATS_ENABLED"] == "0"
        assert ray.environment["OMP_NUM_THREADS"] == "1"
        assert "RAY_ADDRESS" not in ray.environment
        tokens.add(ray.environment["RAY_AUTH_TOKEN"])
    assert len(tokens) == 2
    assert min(map(len, tokens)) == 64
    assert ray.ended == 2


def test_a_cluster_at_an_address_gets_our_token_and_one_thread_a_worker(
    ray: FakeRay, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("RAY_AUTH_TOKEN", "mine")
    with reached("10.0.0.1:6379"):
        pass
    assert ray.environment["RAY_AUTH_MODE"] == "token"
    assert ray.environment["RAY_AUTH_TOKEN"] == "mine"
    assert ray.how["address"] == "10.0.0.1:6379"
    assert ray.how["runtime_env"]["env_vars"]["OMP_NUM_THREADS"] == "1"


@pytest.mark.parametrize("mistake", [RuntimeError("no\nluck"), SystemExit(1)])
def test_a_start_that_fails_is_one_line_and_leaves_nothing(
    mistake: BaseException, ray: FakeRay, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    ray.fails = mistake
    with pytest.raises(ConnectionError, match=r"Ray did not start: (no\\nluck|1)$"), started(1):
        pass
    assert ray.ended == 1
    assert not list(tmp_path.iterdir())
    assert not capsys.readouterr().out


def test_what_rays_threads_print_is_not_on_standard_output(ray: FakeRay, capsys: pytest.CaptureFixture[str]) -> None:
    with reached("10.0.0.1:6379"):
        thread = threading.Thread(target=lambda: print("(raylet) A worker died", file=sys.stdout))
        thread.start()
        thread.join()
    print("the table")
    assert capsys.readouterr().out == "the table\n"


def test_folders_of_processes_that_are_gone_are_removed_and_no_others(tmp_path: Path) -> None:
    gone = subprocess.Popen([sys.executable, "-c", ""])
    gone.wait()
    names = [f"flapenv-{gone.pid}-abc", f"flapenv-{os.getpid()}-abc", "flapenv-1-abc", "flapenv-thesis-abc"]
    for name in [*names, f"flapenv-{gone.pid}", f"other-{gone.pid}-abc"]:
        (tmp_path / name).mkdir()
    (tmp_path / f"flapenv-{gone.pid}-file").touch()
    (tmp_path / f"flapenv-{gone.pid}-link").symlink_to(tmp_path / "other")
    before = {one.name for one in tmp_path.iterdir()}
    cluster._remove_left(tmp_path)
    assert before - {one.name for one in tmp_path.iterdir()} == {f"flapenv-{gone.pid}-abc"}


def test_folders_of_other_people_are_left(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / f"flapenv-{2**22 + 1}-abc").mkdir()
    monkeypatch.setattr(os, "getuid", lambda: tmp_path.stat().st_uid + 1)
    cluster._remove_left(tmp_path)
    assert list(tmp_path.iterdir())


@pytest.mark.parametrize(("where", "said"), [("nowhere", "no token was given"), ("RAY_AUTH_TOKEN", "not as the head")])
@pytest.mark.parametrize("written", ["", "  \n"])
def test_without_a_token_none_is_sent(
    where: str, said: str, written: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(cluster, "_require_answer", lambda address: None)
    monkeypatch.setattr(
        subprocess, "run", lambda *_, **__: subprocess.CompletedProcess(args=[], returncode=1, stdout=b"", stderr=b"")
    )
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("RAY_AUTH_TOKEN", "mine" if where == "RAY_AUTH_TOKEN" else written)
    monkeypatch.delenv("RAY_AUTH_TOKEN_PATH", raising=False)
    with pytest.raises(OSError, match=said):
        require_head("127.0.0.1:1")


@pytest.mark.parametrize("named", [True, False])
def test_a_token_is_found_in_its_files(named: bool, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.delenv("RAY_AUTH_TOKEN", raising=False)
    monkeypatch.delenv("RAY_AUTH_TOKEN_PATH", raising=False)
    path = tmp_path / "token" if named else tmp_path / ".ray" / "auth_token"
    if named:
        monkeypatch.setenv("RAY_AUTH_TOKEN_PATH", str(path))
    assert not cluster._has_token()
    path.parent.mkdir(exist_ok=True)
    path.write_text("mine\n")
    assert cluster._has_token()
