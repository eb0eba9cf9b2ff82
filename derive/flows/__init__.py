"""Motion in time: formulas that move a state from one instant to another."""
