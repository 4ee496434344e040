"""The paper's tables and figures beside ours: `python -m flapenv.validation` prints and draws them."""

from flapenv.validation.convergence import step_errors, strip_errors, term_errors
from flapenv.validation.report import report, write_report
from flapenv.validation.tables import (
    specific_power_errors,
    table2,
    table3,
    weight_support_errors,
)

__all__ = [
    "report",
    "specific_power_errors",
    "step_errors",
    "strip_errors",
    "table2",
    "table3",
    "term_errors",
    "weight_support_errors",
    "write_report",
]
