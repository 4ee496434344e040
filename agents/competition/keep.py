"""What a competition leaves in its folder."""

import math
from pathlib import Path

import numpy as np

from agents.competition.compete import CompetitionResult
from agents.competition.picture import draw_competition
from agents.competition.table import competition_table, wing_table
from agents.run_folder import RESULTS, versions
from flapenv.whole_file import write_json


def save(result: CompetitionResult, folder: Path) -> None:
    """Keep traces, table and picture.

    Args:
        result: what came out.
        folder: there already, of `open_run_folder`.
    """
    config = result.config
    write_json(
        folder / RESULTS,
        {
            "problem": config.problem.to_dict(),
            "insects": [insect.name for insect in result.insects],
            "left_out": list(result.left_out),
            "wingbeats": config.wingbeats,
            "seeds": config.seeds,
            "traces": {name: [vars(trace) for trace in traces] for name, traces in result.traces.items()},
            "policies": [{**vars(policy), "gaps": _plain(policy.gaps)} for policy in result.policies],
            "interrupted": result.interrupted,
            "versions": versions(),
        },
    )
    (folder / "table.txt").write_text(f"{competition_table(result)}\n\n{wing_table(result)}\n", encoding="utf-8")
    draw_competition(result).savefig(folder / "competition.png")


def _plain(gaps: np.ndarray) -> list[float | None]:
    """Gaps as JSON keeps them: None for those that are no finite number."""
    return [gap if math.isfinite(gap) else None for gap in gaps.tolist()]
