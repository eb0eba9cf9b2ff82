"""Nothing in, out the lecture: a derivation whose every step is checked by its reasons alone."""
