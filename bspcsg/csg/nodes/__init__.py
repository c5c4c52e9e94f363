"""The evaluation of each kind of node."""
