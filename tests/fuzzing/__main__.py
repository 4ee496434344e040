"""`python -m tests.fuzzing`: let a coverage-guided fuzzer (atheris) choose the inputs; needs the extra "fuzz"."""

import argparse
import hashlib
import json
import math
import os
import shutil
import subprocess
import sys
import time
import traceback
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]
OUT = Path("runs/fuzz")
MOST_SECONDS = 24 * 3600.0


def parser() -> argparse.ArgumentParser:
    """The command line."""
    made = argparse.ArgumentParser(
        prog="python -m tests.fuzzing",
        description="Fuzz what takes a file, a number or a word from outside; 1 where an input broke the rule.",
    )
    made.add_argument("--inputs", type=int, default=1_000_000, metavar="N", help="in all (default 1,000,000)")
    made.add_argument("--target", action="append", metavar="NAME", help="only this one; repeatable")
    made.add_argument("--together", action="store_true", help="all targets in one process, for a short run")
    made.add_argument("--seconds", type=float, default=MOST_SECONDS, metavar="S", help="of a target at most")
    made.add_argument("--seed", type=int, default=1, metavar="N", help="of the fuzzer's draws (default 1)")
    made.add_argument("--out", type=Path, default=OUT, metavar="DIR", help="findings and corpora (default runs/fuzz)")
    made.add_argument("--replay", type=Path, metavar="FILE", help="run one kept finding of the --target again")
    made.add_argument("--worker", action="store_true", help=argparse.SUPPRESS)
    return made


def main() -> int:
    """Fuzz every target in a process of its own, or be one of these."""
    options = parser().parse_args()
    if options.worker:
        work(options.target[0], options.inputs, options.seconds, options.seed, options.out)
    from fuzzing.targets import TARGETS, TOGETHER, target_of
    from fuzzing.verdict import judge

    unknown = [name for name in options.target or () if name not in (*TARGETS, TOGETHER)]
    if unknown:
        print(f"target {unknown[0]!r} is unknown; allowed: {', '.join(TARGETS)}", file=sys.stderr)
        return 2
    names = options.target or ([TOGETHER] if options.together else list(TARGETS))
    if options.replay is not None:
        print(judge(target_of(names[0]).call, options.replay.read_bytes()))
        return 0
    shares = {name: target_of(name).share for name in names}
    begun, total, broken = time.monotonic(), 0, 0
    print(f"{'target':20} {'inputs':>9} {'accepted':>9} {'seconds':>8} {'/s':>7} {'findings':>8}")
    for name in names:
        count = max(1, math.ceil(options.inputs * shares[name] / sum(shares.values())))
        told = fuzzed(name, count, options)
        total, broken = total + told["inputs"], broken + len(told["findings"])
        rate = told["inputs"] / max(told["seconds"], 1e-9)
        print(
            f"{name:20} {told['inputs']:>9,} {told['accepted']:>9,} {told['seconds']:>8.1f} {rate:>7.0f} "
            f"{len(told['findings']):>8}",
            flush=True,
        )
        for finding in told["findings"]:
            print(f"    {finding}", flush=True)
    print(f"{'in all':20} {total:>9,} {'':9} {time.monotonic() - begun:>8.1f} {'':7} {broken:>8}")
    return 1 if broken else 0


def fuzzed(name: str, count: int, options: argparse.Namespace) -> dict:
    """What came of one target, in a process of its own: whatever happens to that is a finding."""
    folder = options.out / name
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "told.json").unlink(missing_ok=True)
    words = ["--worker", "--target", name, "--inputs", str(count), "--seed", str(options.seed)]
    words += ["--seconds", str(options.seconds), "--out", str(options.out)]
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "PYTHONPATH": str(ROOT)}
    with (folder / "log.txt").open("wb") as log:
        ended = subprocess.run(
            [sys.executable, "-m", "tests.fuzzing", *words], stdout=log, stderr=log, env=environment, check=False
        )
    if not (folder / "told.json").exists():
        why = f"the process ended with {ended.returncode}; see {folder / 'log.txt'}"
        return {"inputs": 0, "accepted": 0, "seconds": 0.0, "findings": [why]}
    told: dict = json.loads((folder / "told.json").read_text())
    return told


def work(name: str, count: int, seconds: float, seed: int, out: Path) -> None:
    """Be the process of one target; never returns."""
    import atheris

    with atheris.instrument_imports(include=["flapenv", "agents"], enable_loader_override=False):
        from fuzzing.targets import SPREAD, target_of
    from fuzzing.files import folder as scratch
    from fuzzing.verdict import FindingError, judge

    target, folder = target_of(name), out / name
    corpus = folder / "corpus"
    corpus.mkdir(parents=True, exist_ok=True)
    for one in (*SPREAD, *target.corpus):
        (corpus / hashlib.sha256(one).hexdigest()[:16]).write_bytes(one)
    told: dict = {"inputs": 0, "accepted": 0, "seconds": 0.0, "findings": []}
    seen: set[object] = set()
    begun = time.monotonic()

    def once(data: bytes) -> None:
        try:
            told["accepted"] += judge(target.call, data) == "accepted"
        except FindingError as finding:
            cause = finding.__cause__ or finding
            place = [(frame.filename, frame.lineno) for frame in traceback.extract_tb(cause.__traceback__)[-2:]]
            if (key := (type(cause), *place)) not in seen:
                seen.add(key)
                kept = folder / f"finding-{hashlib.sha256(data).hexdigest()[:16]}"
                kept.write_bytes(data)
                lines = " < ".join(f"{Path(file).name}:{line}" for file, line in reversed(place))
                told["findings"].append(f"{kept}: {finding} ({lines})")
        told["inputs"] += 1
        told["seconds"] = time.monotonic() - begun
        if told["inputs"] >= count or told["seconds"] >= seconds:
            (folder / "told.json").write_text(json.dumps(told))
            shutil.rmtree(scratch(), ignore_errors=True)
            os._exit(0)  # libFuzzer ends processes in its own way, without a word

    words = [f"-seed={seed}", f"-max_len={target.longest}", "-timeout=60", "-rss_limit_mb=4096", "-len_control=0"]
    words += [f"-artifact_prefix={folder}/", str(corpus)]
    atheris.Setup([sys.argv[0], *words], once)
    atheris.Fuzz()


if __name__ == "__main__":
    sys.exit(main())
