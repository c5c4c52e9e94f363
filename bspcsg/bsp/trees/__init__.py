"""Partition trees over facets: traversal orders, costs, serialization."""
