"""SVG of matplotlib without what a page of many plots does not need: a third of its bytes.

Groups without attributes, empty names, clipping and metadata go; numbers keep one decimal; equal
styles become classes, whose names are made of what they say, so that plots may share them.
"""

import hashlib
import re
from collections.abc import Iterator
from xml.etree import ElementTree as ET

SVG, XLINK = "http://www.w3.org/2000/svg", "http://www.w3.org/1999/xlink"
COUNTED = re.compile(r"[a-z0-9.]+_\d+")
LONG = re.compile(r"(\d+\.\d)\d+")
FONT = re.compile(r" ?font-family: [^;]*;?")
STILL = re.compile(r"rotate\(-?0 ")
Element = ET.Element


def slim(text: str) -> str:
    """Return the svg element of a figure, made small."""
    ET.register_namespace("", SVG)
    ET.register_namespace("xlink", XLINK)
    root = ET.fromstring(text)  # noqa: S314 (made by us)
    styles: dict[str, str] = {}
    for element in root.iter():
        _clean(element)
        _name(element, styles)
    _flatten(root)
    sheet = "".join(f".{name}{{{style}}}" for style, name in sorted(styles.items()))
    written = ET.tostring(root, encoding="unicode")
    first = written.index(">") + 1
    return f"{written[:first]}<style>{sheet}</style>{written[first:]}"


def _clean(element: Element) -> None:
    """Drop an element's needless attributes and digits."""
    element.text = element.text.strip() if element.text and element.text.strip() else None
    element.tail = None
    found = element.attrib
    found.pop("clip-path", None)
    if COUNTED.fullmatch(found.get("id", "")):
        del found["id"]
    if STILL.match(found.get("transform", "")):
        del found["transform"]
    for name in ("x", "y", "d", "transform", "width", "height"):
        if name in found:
            found[name] = re.sub(r"\s+", " ", LONG.sub(r"\1", found[name])).strip()


def _name(element: Element, styles: dict[str, str]) -> None:
    """Replace an element's style by a class."""
    style = FONT.sub("", element.attrib.pop("style", "")).strip("; ")
    if style:
        name = "s" + hashlib.sha256(style.encode()).hexdigest()[:5]
        element.set("class", styles.setdefault(style, name))


def _flatten(element: Element) -> None:
    """Put the children of groups that say nothing where the group stood."""
    children = list(_kept(element))
    for child in list(element):
        element.remove(child)
    element.extend(children)
    if element.tag == f"{{{SVG}}}g" and len(children) > 1:
        _style_once(element)


def _kept(element: Element) -> Iterator[Element]:
    for child in list(element):
        _flatten(child)
        if child.tag in {f"{{{SVG}}}metadata", f"{{{SVG}}}clipPath", f"{{{SVG}}}style"}:
            continue
        if child.tag in {f"{{{SVG}}}g", f"{{{SVG}}}defs"} and not len(child):
            continue
        if child.tag == f"{{{SVG}}}g" and not child.attrib:
            yield from child
        else:
            yield child


def _style_once(group: Element) -> None:
    """Move the class of markers that are all alike to their group."""
    names = {child.get("class") for child in group}
    if len(names) == 1 and all(child.tag == f"{{{SVG}}}use" for child in group):
        group.set("class", names.pop() or "")
        for child in group:
            child.attrib.pop("class", None)
