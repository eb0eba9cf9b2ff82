"""A scene in, a drawing of its machine out: bodies, axes, loads and springs, as SVG."""
