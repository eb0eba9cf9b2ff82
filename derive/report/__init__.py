"""A scene in, its speed against error out: steps over lengths, functions, hard cases, as a page."""

from derive.report.files import report_files
from derive.report.whole import SceneReport, report

__all__ = ["SceneReport", "report", "report_files"]
