"""Formulas for attitudes: quaternions, rotation vectors, Rodrigues parameters, Euler angles."""
