"""The folder of a sweep: its plan, and its lock. What of it is finished the run folders tell, and nothing else."""

import contextlib
import shutil
from collections.abc import Iterator
from pathlib import Path

from agents.folder_lock import locked
from agents.sweep.plan import SweepPlan
from flapenv.aero.checks import shown
from flapenv.read_json import read_object
from flapenv.whole_file import write_json

PLAN, JOURNAL, RAY = "sweep.json", "search.jsonl", ".ray"
"""The plan; what a search has chosen and found, by Optuna; what Ray writes while it runs and nobody reads later."""


def read_plan(storage: Path) -> SweepPlan:
    """The plan that a storage holds.

    Raises:
        FileNotFoundError: if it holds none.
        TypeError: for an unknown key, or a value of another kind.
        ValueError: for what is not JSON, or not allowed.
        OSError: if it cannot be read.
    """
    path = storage / PLAN
    content = read_object(path, mend="the folder of a sweep")
    if not isinstance(content.get("plan"), dict):
        raise ValueError(f"{path} holds no plan; allowed: the file as a sweep wrote it")
    return SweepPlan.from_dict(content["plan"], str(path))


@contextlib.contextmanager
def opened(storage: Path, plan: SweepPlan) -> Iterator[None]:
    """Hold a storage for a plan: nobody else runs into it, and it holds this plan and no other.

    What Ray left of an earlier time is removed unread.

    Args:
        storage: made where it is missing.
        plan: written into a storage that has none.

    Raises:
        NotADirectoryError: if the storage is a file.
        FileExistsError: if it is not empty and holds no sweep.
        ValueError: if it holds another plan.
        BlockingIOError: if another sweep runs into it.
        OSError: if it cannot be made or written.
    """
    try:
        nearest = next((one for one in (storage, *storage.absolute().parents) if one.exists()), storage)
        is_folder = nearest.is_dir()
        if is_folder:
            storage.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as mistake:  # no path holds a NUL, or a name that is too long
        raise OSError(f"--storage {storage} cannot be made ({mistake}); allowed: a folder that can") from None
    if not is_folder:
        raise NotADirectoryError(f"--storage {storage}: {nearest} is a file; allowed: a folder")
    if not (storage / PLAN).exists() and any(one.name != ".lock" for one in storage.iterdir()):
        raise FileExistsError(
            f"--storage {storage} holds files but no {PLAN}; allowed: a sweep's folder, or an empty one"
        )
    with contextlib.ExitStack() as held:
        try:
            held.enter_context(locked(storage))
        except BlockingIOError:
            raise
        except OSError as mistake:
            raise type(mistake)(
                f"--storage {storage} cannot be written ({mistake}); allowed: a folder that can"
            ) from None
        if (storage / PLAN).exists():
            wanted, found = plan.to_dict(), read_plan(storage).to_dict()
            differs = [
                f"{key} = {shown(found[key])} there, wanted {shown(wanted[key])}"
                for key in wanted
                if found[key] != wanted[key]
            ]
            if differs:
                raise ValueError(
                    f"--storage {storage} holds another sweep: {'; '.join(differs)}; allowed: the same, or "
                    "another folder"
                )
        if (storage / RAY).is_symlink() or ((storage / RAY).exists() and not (storage / RAY).is_dir()):
            raise NotADirectoryError(f"{storage / RAY} is no folder; allowed: a folder that Ray made, or nothing")
        write_json(storage / PLAN, {"plan": plan.to_dict()})
        remove_ray(storage)
        yield


def remove_ray(storage: Path) -> None:
    """Remove what Ray wrote."""
    shutil.rmtree(storage / RAY, ignore_errors=True)
