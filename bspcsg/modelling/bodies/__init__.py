"""Operations on solids: hulls, sums, cuts, gaps, refinement, level sets."""
