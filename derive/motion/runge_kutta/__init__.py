"""Steps by stages: the classic one, on the Lie group, adaptive, and their derivatives."""
