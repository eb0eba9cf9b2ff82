"""SVG of matplotlib without what a page of many plots does not need: a tenth of its bytes.

Groups without attributes, empty names, clipping and metadata go; numbers keep one decimal. Styles
become classes and markers stand apart, under names made of what they say, so that a page has them
once for all plots; colours become variables, which the page gives by its scheme.
"""

import hashlib
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from xml.etree import ElementTree as ET

SVG, XLINK = "http://www.w3.org/2000/svg", "http://www.w3.org/1999/xlink"
COUNTED = re.compile(r"[a-z0-9.]+_\d+")
LONG = re.compile(r"(\d+\.\d)\d*")
FONT = re.compile(r" ?font-family: [^;]*;?")
STILL = re.compile(r"rotate\(-?0 ")
COLOUR = re.compile(r"#[0-9a-f]{6}")
NAMED = re.compile(r"\b(?:s[0-9a-f]{5}|m[0-9a-f]{10})\b")
STYLES, SHAPES = "/* styles of plots */", "<!-- markers of plots -->"
DROPPED = ("metadata", "clipPath", "style")
SvgElement = ET.Element


@dataclass(frozen=True)
class Slim:
    """A plot for a page: its svg element, and what the page must have once for all of them.

    styles : by class      shapes : markers as elements, by their id
    """

    text: str
    styles: Mapping[str, str]
    shapes: Mapping[str, str]


def slim(text: str, says: str, paint: Mapping[str, str]) -> Slim:
    """Return the svg element of a figure, made small.

    says : its alternative text      paint : the variable that each colour of the figure becomes
    """
    ET.register_namespace("", SVG)
    root = ET.fromstring(text)  # noqa: S314 (made by us)
    styles: dict[str, str] = {}
    shapes: dict[str, str] = {}
    for element in root.iter():
        _clean(element)
        _name(element, styles, paint)
    for defs in root.iter(f"{{{SVG}}}defs"):
        for shape in defs.findall(f"{{{SVG}}}path"):
            shapes[shape.attrib["id"]] = _written(shape)
    _flatten(root)
    for name in ("width", "height", "version"):
        root.attrib.pop(name, None)
    root.attrib |= {"role": "img", "aria-label": says}
    return Slim(_written(root), {name: style for style, name in styles.items()}, shapes)


def _written(element: SvgElement) -> str:
    text = ET.tostring(element, encoding="unicode")
    return text.replace(f' xmlns="{SVG}"', "").replace(" />", "/>")


def _clean(element: SvgElement) -> None:
    """Drop an element's needless attributes and digits."""
    element.text = element.text.strip() if element.text and element.text.strip() else None
    element.tail = None
    found = element.attrib
    found.pop("clip-path", None)
    if COUNTED.fullmatch(found.get("id", "")):
        del found["id"]
    if STILL.match(found.get("transform", "")):
        del found["transform"]
    if f"{{{XLINK}}}href" in found:
        found["href"] = found.pop(f"{{{XLINK}}}href")
    for name in ("x", "y", "transform"):
        if name in found:
            found[name] = _short(found[name])
    if "d" in found:
        found["d"] = re.sub(r"\s*([A-Za-z])\s*", r"\1", _short(found["d"])).strip()


def _short(numbers: str) -> str:
    return LONG.sub(lambda found: found[1].removesuffix(".0"), numbers)


def _name(element: SvgElement, styles: dict[str, str], paint: Mapping[str, str]) -> None:
    """Replace an element's style by a class, and its colours by variables."""
    style = FONT.sub("", element.attrib.pop("style", "")).strip("; ")
    style = COLOUR.sub(lambda found: f"var({paint[found.group()]})", style)
    if style:
        name = "s" + hashlib.sha256(style.encode()).hexdigest()[:5]
        element.set("class", styles.setdefault(style, name))


def _flatten(element: SvgElement) -> None:
    """Put the children of groups that say nothing where the group stood."""
    children = list(_kept(element))
    for child in list(element):
        element.remove(child)
    element.extend(children)
    if element.tag == f"{{{SVG}}}g" and len(children) > 1:
        _style_once(element)


def _kept(element: SvgElement) -> Iterator[SvgElement]:
    for child in list(element):
        _flatten(child)
        if child.tag in {f"{{{SVG}}}{name}" for name in (*DROPPED, "defs")}:
            continue
        if child.tag == f"{{{SVG}}}g" and not len(child):
            continue
        if child.tag == f"{{{SVG}}}g" and not child.attrib:
            yield from child
        else:
            yield child


def _style_once(group: SvgElement) -> None:
    """Move the class of markers that are all alike to their group."""
    names = {child.get("class") for child in group}
    if len(names) == 1 and all(child.tag == f"{{{SVG}}}use" for child in group):
        group.set("class", names.pop() or "")
        for child in group:
            child.attrib.pop("class", None)


def shared(page: str, plots: Iterable[Slim]) -> str:
    """Return a page with short names for what its plots share, and that put where it belongs.

    The styles take the place of ``STYLES``, the markers that of ``SHAPES``.
    """
    styles: dict[str, str] = {}
    shapes: dict[str, str] = {}
    for plot in plots:
        styles |= plot.styles
        shapes |= plot.shapes
    sheet = "\n".join(f".{name}{{{text}}}" for name, text in sorted(styles.items()))
    markers = "".join(text for _, text in sorted(shapes.items()))
    page = page.replace(STYLES, sheet).replace(SHAPES, markers)
    short = {name: f"p{n}" for n, name in enumerate(sorted([*styles, *shapes]))}
    return NAMED.sub(lambda found: short.get(found[0], found[0]), page)
