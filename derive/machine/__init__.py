"""Machines: from declared frames, bodies and loads to the equations that the answers need."""
