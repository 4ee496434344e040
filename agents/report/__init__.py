"""The report of a run: one HTML file that holds everything and reaches for nothing; needs the extra "train"."""

from agents.report.content import ReportContent
from agents.report.page import write_report

__all__ = ["ReportContent", "write_report"]
