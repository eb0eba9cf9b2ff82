"""Programs in, C99 out."""
