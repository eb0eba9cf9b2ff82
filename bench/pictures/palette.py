"""The colours of pictures on light and on dark pages."""

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Palette:
    """What text, frames and curves are drawn in.

    curves : colours of our own methods; those of others are drawn in ``soft``, dashed
    """

    ink: str
    soft: str
    frame: str
    panel: str
    curves: Mapping[str, str]


PALETTES = {
    "light": Palette(
        "#1a1c20",
        "#59636e",
        "#d0d7de",
        "#f6f8fa",
        {"flow_exact": "#1a1c20", "step_split6": "#6639ba", "step_rk4": "#1a7f37"},
    ),
    "dark": Palette(
        "#e6edf3",
        "#9198a1",
        "#3d444d",
        "#151b23",
        {"flow_exact": "#e6edf3", "step_split6": "#d2a8ff", "step_rk4": "#7ee787"},
    ),
}
