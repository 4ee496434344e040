"""Ray for the time of a sweep: started on this machine for nobody else, or reached at an address.

Ray runs whatever code it is sent, so it must be heard by nobody who may not send any: here it listens on the loopback
alone and asks for a token that nobody else knows.
"""

import contextlib
import logging
import os
import re
import secrets
import shutil
import socket
import stat
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

from agents.benchmark.subprocesses import ONE_THREAD
from flapenv.aero.checks import one_line

ANSWER = 5.0
"""Seconds that an address has to accept a connection."""
GREETING = 15.0
"""Seconds that what accepted it has to prove itself the head of a cluster."""
OBJECTS = 100 * 2**20
"""Memory for Ray's own objects, of which a sweep has hardly any [bytes]; the least that Ray takes is 75 MB."""
TEMPORARY = "flapenv-"
"""Begins the name of a folder of Ray's sockets and logs; the process that made it follows."""
TOKEN_HINT = (
    "the cluster's token in the file that RAY_AUTH_TOKEN_PATH names, in ~/.ray/auth_token, or in RAY_AUTH_TOKEN"
)
QUIET = {
    "RAY_USAGE_STATS_ENABLED": "0",  # nothing is told to anybody
    "RAY_AIR_NEW_OUTPUT": "0",  # Tune's own pages of tables
    "TUNE_DISABLE_AUTO_CALLBACK_LOGGERS": "1",  # the run folders say it all
    "TUNE_DISABLE_SIGINT_HANDLER": "1",  # Ctrl-C is ours
}
GREET = """
import sys
from ray._raylet import GcsClient
from ray.exceptions import AuthenticationError
try:
    GcsClient(address=sys.argv[1])
except AuthenticationError:
    sys.exit(3)
"""
"""Asks the head for its cluster; apart, as Ray would wait for minutes for what is none."""


@contextlib.contextmanager
def started(jobs: int) -> Iterator[ModuleType]:
    """Ray on this machine, for this process alone; ended with it.

    Args:
        jobs: trials beside each other.

    Raises:
        ConnectionError: if it does not start.
        ImportError: if Ray is not installed.
    """
    os.environ |= (
        QUIET
        | ONE_THREAD
        | {  # inherited: Ray's workers start at once then
            "RAY_worker_niceness": "0",  # Ray's workers else give way to all others, and a plain run does not
            "RAY_AUTH_MODE": "token",
            "RAY_AUTH_TOKEN": secrets.token_hex(32),
            "RAY_ENABLE_WINDOWS_OR_OSX_CLUSTER": "0",  # as there, on Linux too: listen on the loopback alone
        }
    )
    os.environ.pop("RAY_ADDRESS", None)
    import ray

    short = "/tmp" if Path("/tmp").is_dir() else None  # Ray's sockets lie in it, whose paths must be short
    _remove_left(Path(short or tempfile.gettempdir()))
    folder = tempfile.mkdtemp(prefix=f"{TEMPORARY}{os.getpid()}-", dir=short)
    try:
        with _connected(
            ray,
            num_cpus=jobs,
            num_gpus=0,
            include_dashboard=False,
            object_store_memory=OBJECTS,
            _node_ip_address="127.0.0.1",
            _temp_dir=folder,
        ):
            yield ray
    finally:
        shutil.rmtree(folder, ignore_errors=True)


@contextlib.contextmanager
def reached(address: str) -> Iterator[ModuleType]:
    """A cluster of Ray at an address; this machine is one of its nodes.

    Args:
        address: of its head, as `require_head` accepts it.

    Raises:
        ConnectionError: if it cannot be joined.
        ImportError: if Ray is not installed.
    """
    os.environ |= QUIET | {"RAY_AUTH_MODE": "token"}
    import ray

    with _connected(ray, address=address, runtime_env={"env_vars": ONE_THREAD}):
        yield ray


def _remove_left(place: Path) -> None:
    """Remove our folders of processes that were killed."""
    for folder in place.glob(f"{TEMPORARY}*-*"):
        number = folder.name.removeprefix(TEMPORARY).split("-")[0]
        with contextlib.suppress(OSError):
            about = folder.lstat()
            ours = about.st_uid == os.getuid() and stat.S_ISDIR(about.st_mode)
            if ours and number.isascii() and number.isdigit() and not _lives(int(number)):
                shutil.rmtree(folder, ignore_errors=True)


def _lives(process: int) -> bool:
    """Whether a process is there, of whomever."""
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except PermissionError:
        return True
    return True


def _require_answer(address: str) -> None:
    """Refuse an address that is none, or where nothing listens."""
    match = re.fullmatch(r"(?:\[(?P<six>[0-9a-fA-F:.]+)\]|(?P<host>[\w.-]+)):(?P<port>\d{1,5})", address)
    if match is None or not 0 < int(match["port"]) < 2**16:
        raise ValueError(f"--address {one_line(address, 80)} is not allowed; allowed: HOST:PORT")
    try:
        socket.create_connection((match["six"] or match["host"], int(match["port"])), timeout=ANSWER).close()
    except (OSError, UnicodeError) as mistake:
        raise ConnectionError(
            f"--address {address} does not answer ({mistake}); allowed: HOST:PORT of a head that was started with "
            "'ray start --head'"
        ) from None


def _has_token() -> bool:
    """Whether Ray will find a token where it looks; without one it ends the process."""
    if os.environ.get("RAY_AUTH_TOKEN", "").strip():
        return True
    named = os.environ.get("RAY_AUTH_TOKEN_PATH")
    try:
        return bool((Path(named) if named else Path.home() / ".ray" / "auth_token").read_bytes().strip())
    except (OSError, ValueError, RuntimeError):
        return False


def require_head(address: str) -> None:
    """Refuse an address that is no head of a cluster, or does not accept our token; within seconds.

    Args:
        address: HOST:PORT.

    Raises:
        ValueError: for another form.
        ConnectionError: if it does not answer, or not as a head.
        PermissionError: without a token, or if it does not accept ours.
    """
    _require_answer(address)
    if not _has_token():
        raise PermissionError(f"--address {address}: no token was given; allowed: {TOKEN_HINT}")
    command = [sys.executable, "-c", GREET, address]
    environment = {**os.environ, **QUIET, "RAY_AUTH_MODE": "token"}
    try:
        code = subprocess.run(
            command, env=environment, stdin=subprocess.DEVNULL, capture_output=True, timeout=GREETING, check=False
        ).returncode
    except subprocess.TimeoutExpired:
        code = 1
    if code == 3:
        raise PermissionError(f"--address {address} does not accept the token; allowed: {TOKEN_HINT}")
    if code:
        raise ConnectionError(
            f"--address {address} answers, but not as the head of a Ray cluster; allowed: HOST:PORT of a head that was "
            "started with 'ray start --head'"
        )


@contextlib.contextmanager
def _connected(ray: ModuleType, **how: object) -> Iterator[None]:
    """A connection, closed whatever happens; why there is none, in one line.

    Ray's listener prints what befalls workers on our standard output, which is for tables: it is set aside meanwhile.
    """
    with Path(os.devnull).open("w", encoding="utf-8") as nowhere, contextlib.ExitStack() as until:
        until.enter_context(contextlib.redirect_stdout(nowhere))
        until.callback(ray.shutdown)
        try:
            ray.init(
                log_to_driver=False,
                logging_level=logging.CRITICAL,
                **how,
            )
        except (Exception, SystemExit) as mistake:  # Ray ends the process where it cannot reach its own
            raise ConnectionError(f"Ray did not start: {one_line(mistake)}") from None
        yield
