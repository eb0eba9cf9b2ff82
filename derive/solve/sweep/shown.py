"""A sweep with its page: what its files say, beside the error of the step, as plots and lines."""

import json
import shlex
from collections.abc import Mapping
from math import isfinite
from pathlib import Path
from typing import Any

from markupsafe import Markup

from derive.emit.files import write
from derive.emit.templates import TEMPLATES
from derive.scene import argument
from derive.solve.instrument import Instrument
from derive.solve.simulation import STEP
from derive.solve.sweep.course import STOPPED
from derive.solve.sweep.drawing import bars, fan_drawn, histogram
from derive.solve.sweep.ensemble import Ensemble, ToldOfSweep, swept
from derive.solve.sweep.job import ENDED_AT
from derive.solve.sweep.keep import COURSE, WORDS
from derive.solve.sweep.request import Request
from derive.solve.sweep.store import MANIFEST
from derive.solve.sweep.summary import MOST_COURSES, MOST_READ, summary


def swept_and_shown(
    found: Instrument,
    source: str,
    values: Mapping[str, float],
    asked: Request,
    folder: Path,
    tell: ToldOfSweep,
) -> Ensemble:
    """Return a sweep that is done, its page beside its folder."""
    made = swept(found, values, asked, folder, tell)
    tell("drawing the page", made.members, made.members)
    write(made.page.parent, {made.page.name: page_of(found, source, made)})
    return made


def page_of(found: Instrument, source: str, of: Ensemble) -> str:
    """Return the page of a sweep."""
    told = json.loads((of.folder / MANIFEST).read_text(encoding="utf-8"))
    asked = told["asked"]
    varied = list(asked["vary"])
    stops = ENDED_AT if of.ended.get(STOPPED) else None
    begun = {name: f"{name}@0" for name in told["moved"]}
    apart = {*begun.values()}
    numbers = [c for c in asked["keep"] if c not in apart and not c.endswith(f"@{COURSE}")]
    numbers = [*([stops] if stops else []), *numbers]
    times = [asked["until"] * k / asked["instants"] for k in range(asked["instants"] + 1)]
    courses = {c: times for c in asked["keep"] if c.endswith(f"@{COURSE}")}
    says = summary(of.folder, of.plain, varied, begun, asked["set"], numbers, courses)
    units = {**told["units"], ENDED_AT: "s"}
    wide = {c: float(q.ends[1] - q.ends[0])
            for q in found.library.vocabulary.states for c in q.components}  # fmt: skip
    off = [(name, by, by / wide[name]) for name, by in says.off.items()]
    return TEMPLATES.get_template("sweep.html.jinja").render(
        of=of,
        told=told,
        asked=asked,
        scene=found.library.scene,
        argument=argument(found.library.scene),
        says=says,
        fans=[(f, drawn(fan_drawn(f, units[f.column]))) for f in says.fans],
        histograms=[(s, drawn(histogram(s, units[s.column]))) for s in says.scatters if s.count],
        influences=[(i, drawn(bars(i))) for i in says.influences],
        scatters={s.column: s for s in says.scatters},
        replay=lambda inputs, column="": replayed(source, told, inputs, column),
        units=units,
        off=off,
        ways=told["asked"]["vary"],
        in_words=in_words,
        most=min(MOST_READ, of.plain),
        most_courses=min(MOST_COURSES, of.plain),
    )


def drawn(text: str) -> Markup:
    """Return a drawing as a page takes it."""
    return Markup(text)  # noqa: S704 (our own SVG, its words escaped)


def in_words(way: list[Any]) -> str:
    """Return how a component scatters, as it is typed.

    >>> in_words(["uniform", 1.0, 2.0, 0]), in_words(["grid", 0.0, 1.0, 11])
    ('uniform(1, 2)', '0..1:11')
    """
    kind, *ends, count = way
    if kind == "grid":
        return f"{ends[0]:.12g}..{ends[1]:.12g}:{count}"
    return f"{kind}({', '.join(f'{end:.12g}' for end in ends)})"


def replayed(source: str, told: Mapping[str, Any], inputs: Mapping[str, float], column: str) -> str:
    """Return the command that moves one member again, from where it began if it did.

    column : that it is looked at for: of an instant, the motion is until then
    """
    asked = told["asked"]
    own = {name: x for name, x in inputs.items() if isfinite(x)}
    values = [f"{name}={x!r}" for name, x in {**asked["set"], **own}.items()]
    word = column.partition("@")[2]
    until = asked["until"] if word in ("", *WORDS) else float(word)
    command = ["derive", "solve", source, "--set", *values, "--until", f"{until!r}"]
    command += ["--step", f"{asked['until'] / told['steps']!r}"]
    command += ["--by", told["step"]] if told["step"] != STEP else []
    command += ["--stop", asked["stop"]] if asked["stop"] else []
    return shlex.join(command)
