"""The motion of a free body in closed form."""
