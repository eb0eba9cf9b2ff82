"""A scene in, problems out: which equations its answers need, of which unknowns."""
