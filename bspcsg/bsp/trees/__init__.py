"""Partition trees over facets: the order they give, their cost, their text."""
