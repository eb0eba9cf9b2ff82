"""Euler's equations of motion, from the particle sum to checked C and CasADi functions."""

__version__ = "0.1.0"
