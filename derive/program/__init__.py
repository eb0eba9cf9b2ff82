"""Operations in, values out: programs over numbers, in floats, pairs of floats or anything else."""
