"""Ray casting: exact hits of rays with facets, and trees that adapt to the rays."""
