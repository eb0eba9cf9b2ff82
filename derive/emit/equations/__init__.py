"""A scene's equations to take away: text for a terminal, a LaTeX document, a module of SymPy."""

from collections.abc import Callable, Mapping

from derive.emit.equations.account import Account, account
from derive.emit.equations.latex import latex_document
from derive.emit.equations.sympy_module import sympy_module
from derive.emit.equations.text import ascii_text, unicode_text
from derive.library.library import Library
from derive.scene import SceneError

FORMS: Mapping[str, Callable[[Account], str]] = {
    "text": unicode_text,
    "ascii": ascii_text,
    "latex": latex_document,
    "sympy": sympy_module,
}
"""What writes each form."""


def equations(library: Library, form: str) -> str:
    """Return the equations of a scene: of each function the lecture's law, what it becomes in the
    scene, and its solution.

    form : "text" (Unicode) or "ascii", for a terminal; "latex", a document that needs amsmath;
           "sympy", a module of Python that needs SymPy only
    Raises SceneError for any other form.
    """
    if form not in FORMS:
        raise SceneError(f"form must be one of {', '.join(FORMS)}, not {form!r}")
    return FORMS[form](account(library))
