"""A scene in, a library out: all programs of the scene, those of motion among them, one set-up."""
