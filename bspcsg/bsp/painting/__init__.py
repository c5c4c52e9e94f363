"""Pictures of facets by the painter's algorithm, which paints far polygons before near ones."""
