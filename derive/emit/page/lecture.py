"""The lecture as a page: every step numbered, with its sentence, its equation and its reasons."""

import re
from collections.abc import Sequence

from markupsafe import Markup
from sympy import Matrix

from derive import __version__
from derive.emit.notation import equation_mathml, mathml, sympy_equation_mathml
from derive.emit.page.prose import prose
from derive.emit.templates import TEMPLATES
from derive.lecture.chapters import CHAPTERS, LECTURE, Chapter
from derive.lecture.chapters.letters import LETTERS, Letter
from derive.lecture.step import Step
from derive.lecture.vectors import components

# Steps from which code is printed: what they rest on is listed at the end of the page.
ENDS = (
    "mass_centre_motion", "angular_momentum", "rate_in_axes", "transport_theorem", "general_form",
    "moving_point_form", "energy_of_turning", "kinetic_energy_about_point", "koenig",
    "gyrostat_momentum", "gyrostat_form", "wheel_equation", "gyrostat_energy", "rotation_of_vector",
    "quaternion_rate_scalar", "quaternion_rate_vector", "angular_velocities_add",
)  # fmt: skip
# Steps that are also shown along x, y and z.
IN_COMPONENTS = (
    "angular_momentum", "general_form", "moving_point_form", "body_axes_form", "gyrostat_form",
    "quaternion_rate_vector", "rotation_of_vector",
)  # fmt: skip
# The arguments of emitted functions that carry a symbol, in C and in CasADi where that differs.
_CARRIED = {
    "F": ("force[3]", "force"),
    "M": ("moment[3]", "moment"),
    "T": ("kinetic_energy", ""),
    "v_G": ("velocity[3]", "velocity"),
    "a_G": ("velocity_rate[3]", "velocity_rate"),
    "a_A": ("point_acceleration[3]", "point_acceleration"),
    "l": ("angular_momentum[3]", "angular_momentum"),
    "l_dot": ("rate_in_axes[3]", "rate_in_axes"),
    "l_N_dot": ("rate_absolute[3]", "rate_absolute"),
    "omega": ("omega[3]", "omega"),
    "omega_dot": ("omega_dot[3]", "omega_dot"),
    "q_w": ("attitude[0]", ""),
    "q_v": ("attitude[1..3]", "attitude[1:4]"),
    "s": ("wheel_speeds[k]", ""),
    "s_dot": ("wheel_accelerations[k]", ""),
    "u": ("wheel_torques[k]", ""),
}
GALLERY = "index.html"
_MARKS = {"assume": "assumed", "define": "defined", "deduce": "checked"}
_BUILT = {
    ("symbol", ()): 'scalar("{}")',
    ("symbol", (3,)): 'vector("{}")',
    ("symbol", (3, 3)): 'tensor("{}")',
    ("inertia", (3, 3)): 'inertia("{}")',
}


def lecture_page(reports: Sequence[str] = (), galleries: Sequence[str] = (GALLERY,)) -> str:
    """Return the text of ``lecture.html``, complete in one file and without scripts.

    reports, galleries : the page of many cases and that of all scenes, if they are there
    """
    pages = dict.fromkeys(galleries, "Scenes") | dict.fromkeys(reports, "Speed against error")
    return TEMPLATES.get_template("lecture.html.jinja").render(
        title=LECTURE.title,
        version=__version__,
        pages=pages,
        chapters=CHAPTERS,
        marks=_MARKS,
        kinds={kind: sum(s.kind == kind for s in LECTURE.steps) for kind in _MARKS},
        assumed=[s for s in LECTURE.steps if s.kind == "assume"],
        ends=[(LECTURE[name], LECTURE.assumptions(name)) for name in ENDS],
        numbers={s.name: n for n, s in enumerate(LECTURE.steps, 1)},
        letters=[_letter_row(letter) for letter in LETTERS],
        prose=prose,
        introduction=_introduction,
        equation=equation_mathml,
        in_components=_in_components,
        needed_by=_needed_by,
    )


def _needed_by(step: Step) -> str:
    """Return the first step that an assumption is needed by."""
    if step.kind != "assume":
        return ""
    return next((s.name for s in LECTURE.steps if step.name in s.using), "")


def _in_components(step: Step) -> Markup:
    """Return the equations along x, y and z of a step that is shown so too."""
    if step.name not in IN_COMPONENTS:
        return Markup("")
    lines = [
        sympy_equation_mathml(left, right, {})
        for claim in step.claims
        for left, right in zip(*(Matrix([components(side)]) for side in claim), strict=True)
    ]
    return Markup("\n".join(lines))  # noqa: S704 (MathML of checked names)


def _introduction(chapter: Chapter) -> Markup:
    """Return what a chapter is about, without the title it begins with."""
    text = re.sub(r"\s+", " ", chapter.says).strip()
    first, colon, rest = text.partition(": ")
    if not colon or "." in first:
        return prose(text)
    return prose(rest[:1].upper() + rest[1:])


def _letter_row(letter: Letter) -> dict[str, object]:
    """Return a symbol and its names: what builds it in Python, what carries it in C and CasADi."""
    c, casadi = _CARRIED.get(letter.name, ("", ""))
    return {
        "mathml": Markup(mathml(letter.symbol)),  # noqa: S704 (MathML of a checked name)
        "python": _BUILT[letter.symbol.operator, letter.symbol.shape].format(letter.name),
        "c": c,
        "casadi": casadi or c,
        "says": prose(letter.says),
        "unit": letter.si_unit.replace("^2", "²"),
    }
