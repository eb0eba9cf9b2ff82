"""A problem in, an arrangement out: in which order to compute it, with what named in between."""
