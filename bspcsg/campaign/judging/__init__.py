"""Judge a case: evaluate it, ask other engines, and decide on a verdict."""
