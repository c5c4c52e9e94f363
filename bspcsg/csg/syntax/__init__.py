"""Scripts as text, as a tree of nodes, and as JSON."""
