"""Equations of a scene as its page shows them: lines, grouped by the lecture steps behind them."""

from dataclasses import dataclass

from derive.lecture.step import Step


@dataclass(frozen=True)
class Line:
    """One equation of the scene, what it determines, and the place to link to."""

    place: str
    unknown: str
    mathml: str


@dataclass(frozen=True)
class Passage:
    """Lines of a scene that come from the same lecture steps."""

    steps: tuple[Step, ...]
    general: tuple[str, ...]
    lines: tuple[Line, ...]
