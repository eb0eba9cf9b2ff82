"""Motions by our steppers and by peers: end states, their errors, instructions and time."""
