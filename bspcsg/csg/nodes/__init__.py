"""The nodes of a script, each with what it evaluates to."""
