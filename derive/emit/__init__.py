"""A library and its figures in, out texts: C99, CasADi, JSON, HTML."""
