"""A scene's C of one precision as a single header, of which one source file makes the functions."""

import re

from derive.emit.c.columns import within_columns
from derive.emit.c.signature import CNames
from derive.emit.templates import TEMPLATES
from derive.program.precision import Precision


def single_header(scene: str, precision: Precision, header: str, source: str) -> str:
    """Return the text of the single header, from those of the header and the source."""
    file = CNames(scene).file(precision, "h")
    body = source.partition(f'#include "{file}"\n')[2]
    text = TEMPLATES.get_template("package/single.h.jinja").render(
        header=header.rstrip("\n"),
        body=body.strip("\n").replace(f"{file}: ", f"{single_name(scene, precision)}: "),
        own=f"{scene}_{precision.name}".upper(),
        aside=re.findall(r"^#undef (\w+)$", body, re.MULTILINE),
        apart="#define DERIVE_APART" in body,
    )
    return within_columns(text)


def single_name(scene: str, precision: Precision) -> str:
    """Return how the single header of a precision is called."""
    return f"{scene}_{precision.name}_single.h"
