"""Steps by the Taylor series of the solution."""
