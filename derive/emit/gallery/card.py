"""A card of the gallery: drawing, question, equation, answer and cost of a scene."""

from collections.abc import Sequence
from dataclasses import dataclass

from markupsafe import Markup

from derive.emit.drawing.drawing import drawing
from derive.emit.page.answer import AnswerLine, first_answer
from derive.emit.templates import TEMPLATES
from derive.library.library import Library
from derive.scene.wanted import JACOBIAN


@dataclass(frozen=True)
class Card:
    """What the gallery shows of one scene."""

    name: str
    title: str
    source: str
    drawing: Markup
    answer: AnswerLine
    costs: tuple[tuple[str, int], ...]
    best: str


def card(library: Library, best: str = "") -> Card:
    """Return the card of a scene; ``best`` is the sentence of its report, if there is one."""
    scene = library.scene
    return Card(
        scene.name,
        scene.title,
        scene.source,
        Markup(drawing(scene)),  # noqa: S704 (numbers and checked names)
        first_answer(library),
        tuple((p.name, p.flops()) for p in library.functions if not p.name.endswith(JACOBIAN)),
        best,
    )


def gallery(cards: Sequence[Card], reports: Sequence[str] = ()) -> str:
    """Return the text of ``index.html``; ``reports`` has the page of many cases, if it is there."""
    return TEMPLATES.get_template("gallery.html.jinja").render(cards=cards, reports=reports)
